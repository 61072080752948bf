"""Critical torques and boundaries of wells, against the truth, and beside them against Arb."""

import json

import fate_references as references
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, critical_torque, retrapping_torque, settle, well_boundaries


def test_critical_torques(shared):
    truth = json.loads((shared / "truth" / "driven_critical_tau.json").read_text())
    v0 = np.array([float(row["v0"]) for row in truth["summary"]])
    tau = np.array([float(row["tau_c"]) for row in truth["summary"]])
    np.testing.assert_allclose(critical_torque(Pendulum(1.0, 0.16), v0), tau, rtol=1e-14)


def test_torques_between_wells(shared):
    """132 of them, some below 0, most closer to τ_r than the one before by a constant factor."""
    truth = json.loads((shared / "truth" / "driven_critical_tau.json").read_text())
    table = np.full((len(truth["thresholds"]), 13), np.nan)
    for i, row in enumerate(truth["thresholds"].values()):
        table[i, [int(n) for n in row]] = [float(x) for x in row.values()]
    v0 = np.array([float(x) for x in truth["thresholds"]])
    found = well_boundaries(Pendulum(1.0, 0.16), v0, over="tau", count=13)
    np.testing.assert_allclose(found, table, atol=2e-14)
    # Twelve are told apart, where the motion needs so many.
    assert (np.diff(found[-1, :12]) > 0).all()


def test_dampings_between_wells(shared):
    truth = json.loads((shared / "truth" / "damped_beta_thresholds.json").read_text())
    beta = [float(truth["beta_n"][str(n)]) for n in range(41)]
    found = well_boundaries(Pendulum(1.0, 1.0), 2.3, over="beta", count=41)
    np.testing.assert_allclose(found, beta, rtol=2e-12)


@pytest.mark.parametrize("over", ["tau", "beta"])
def test_fresh_boundaries(over):
    """1e-9 to either side Arb finds the two wells, or the last well and running."""
    rng = np.random.default_rng(5)
    for _ in range(3):
        beta, tau = 10 ** rng.uniform(-1.3, -0.2), rng.uniform(0, 0.05)
        v0, theta0 = rng.choice([-1, 1]) * rng.uniform(2, 6), rng.uniform(-9, 9)
        scene = Pendulum(1.0, beta, tau)
        found = np.asarray(well_boundaries(scene, v0, theta0, over=over, count=3))
        first, forward = round(theta0 / (2 * np.pi)), int(np.sign(v0))
        for k in np.flatnonzero(~np.isnan(found)):
            value = found[k]
            ends = []
            for side in (-1e-9, 1e-9):
                at = (beta, value + side) if over == "tau" else (value + side, tau)
                ends.append(references.fate(*at, theta0, v0))
            stays, passes = ends if (over == "tau") == (forward > 0) else ends[::-1]
            if over == "beta":
                stays, passes = ends[::-1]
            # Thrown against a torque above τ_r, what stays falls back and runs.
            assert stays[0] == "running" or stays == ("captured", first + k * forward)
            assert passes[0] == "running" or passes == ("captured", first + (k + 1) * forward)
            assert stays != passes


@pytest.mark.full
def test_fresh_critical_torques():
    starts = [
        (0.3, 1.0, 0.5),
        (0.05, 0.3, -1.0),
        (0.8, 2.0, 0.0),
        (0.2, -1.0, 0.4),
        (1.0, 0.0, 0.1),
    ]
    for beta, v0, theta0 in starts:
        tau = float(critical_torque(Pendulum(1.0, beta), v0, theta0))
        assert references.fate(beta, tau - 1e-9, theta0, v0)[0] == "captured"
        assert references.fate(beta, tau + 1e-9, theta0, v0) == ("running", 1)


def test_limits():
    """Fast starts leave τ_r, overdamped ones ε; between them the units are those of ε."""
    assert critical_torque(Pendulum(1.0, 0.16), 5.0) == retrapping_torque(0.16)
    np.testing.assert_allclose(critical_torque(Pendulum(4.0, 3.0), jnp.array([0.0, 9.0])), 4.0)
    one, nine = (critical_torque(Pendulum(e * e, 0.3 * e), 0.5 * e) for e in (1.0, 3.0))
    np.testing.assert_allclose(nine, 9 * one, rtol=1e-12)
    one, nine = (
        well_boundaries(Pendulum(e * e, 1.0, 0.02 * e * e), 2.4 * e, over="beta", count=3)
        for e in (1.0, 3.0)
    )
    np.testing.assert_allclose(nine, 3 * one, rtol=1e-11)
    # Mirrored, and a turn further on.
    ahead = well_boundaries(Pendulum(1.0, 0.16), 2.4, 0.3, over="tau", count=3)
    back = well_boundaries(Pendulum(1.0, 0.16), -2.4, -0.3 - 2 * np.pi, over="tau", count=3)
    np.testing.assert_allclose(back, -ahead, atol=1e-13)


def test_none():
    """No boundary: passing the first saddle is running; too slow; NaN in its own lane."""
    found = well_boundaries(Pendulum(1.0, 0.16), 1.98, over="tau", count=3)
    assert jnp.isnan(found).tolist() == [False, True, True]
    assert jnp.isnan(well_boundaries(Pendulum(1.0, 0.1), 1.9, over="beta", count=2)).all()
    over = well_boundaries(
        Pendulum(1.0, 1.0, 1.5), jnp.array([0.0, 30.0, -30.0]), over="beta", count=2
    )
    assert jnp.isnan(over).all()
    lanes = jnp.array([0.16, jnp.nan, -1.0, 0.0])

    def both(beta):
        scene = Pendulum(1.0, beta)
        return critical_torque(scene, 1.9), well_boundaries(scene, 2.3, over="tau", count=2)[1]

    for values in jax.jit(jax.vmap(both))(lanes):
        assert jnp.isnan(values).tolist() == [False, True, True, True]


def slopes(function, x):
    """Differences of order 4."""
    found = []
    for i in range(len(x)):
        f = [function(*(x + k * 1e-3 * np.eye(len(x))[i])) for k in (2, 1, -1, -2)]
        found.append((8 * (f[1] - f[2]) - (f[0] - f[3])) / 12e-3)
    return np.stack(found, -1)


@pytest.mark.full  # compiles for most of a minute
def test_derivatives():
    """In every argument and mode; the values are Arb's to 1e-12."""

    def critical(epsilon, beta, v0, theta0):
        return critical_torque(Pendulum(epsilon, beta), v0, theta0)

    def wells(over):
        def call(epsilon, other, v0, theta0):
            scene = Pendulum(epsilon, 1.0, other) if over == "beta" else Pendulum(epsilon, other)
            return well_boundaries(scene, v0, theta0, over=over, count=3)

        return call

    every = (0, 1, 2, 3)
    for mode, function, x in (
        (jax.jacfwd, critical, [1.2, 0.2, 1.9, 0.1]),
        (jax.jacrev, critical, [1.2, 0.2, -1.0, 0.1]),
        (jax.jacfwd, wells("tau"), [1.2, 0.2, 2.7, 0.1]),
        (jax.jacrev, wells("beta"), [1.2, 0.03, -2.7, 0.1]),
    ):
        true = slopes(function, np.array(x))
        np.testing.assert_allclose(np.stack(mode(function, every)(*x), -1), true, atol=2e-8)
    # Where every start runs from τ_r on, only β and ε matter.
    gradient = jax.grad(critical, every)(1.0, 0.16, 3.0, 0.2)
    np.testing.assert_allclose(gradient[1], jax.grad(retrapping_torque)(0.16), rtol=1e-14)
    assert gradient[2] == gradient[3] == 0


@pytest.mark.full  # compiles for half a minute
def test_curvature():
    def critical(beta, v0):
        return critical_torque(Pendulum(1.0, beta), v0)

    hessian = np.array(jax.hessian(critical, (0, 1))(0.2, 1.9))
    gradient = slopes(lambda *x: np.array(jax.jacfwd(critical, (0, 1))(*x)), np.array([0.2, 1.9]))
    np.testing.assert_allclose(hessian, gradient, rtol=1e-6)


def test_bad_input():
    scene = Pendulum(1.0, 0.16)
    with pytest.raises(ValueError, match='`over` must be "tau" or "beta", but got \'epsilon\''):
        well_boundaries(scene, 1.0, over="epsilon", count=1)
    with pytest.raises(ValueError, match="`count` must be 1 or more"):
        well_boundaries(scene, 1.0, over="tau", count=0)
    for call in (
        lambda p: critical_torque(p, 1.0),
        lambda p: well_boundaries(p, 1.0, over="tau", count=1),
    ):
        with pytest.raises(ValueError, match="`pendulum` must have damping"):
            call(Pendulum(1.0))
        with pytest.raises(ValueError, match="`beta` must be positive, but got 0"):
            call(Pendulum(1.0, 0.0))
        with pytest.raises(ValueError, match="must have a constant torque"):
            call(Pendulum(1.0, 0.1, jnp.sin))


def test_single_precision():
    with jax.enable_x64(False):
        tau = critical_torque(Pendulum(1.0, 0.16), 1.98)
        assert tau.dtype == np.float32
        np.testing.assert_allclose(tau, 0.20587027786245401, rtol=1e-5)
        wells = well_boundaries(Pendulum(1.0, 0.16), 2.01, over="tau", count=2)
        np.testing.assert_allclose(wells, [0.18906882668688475, 0.20070093589621338], rtol=1e-5)
        assert settle(Pendulum(1.0, 0.16), 2.3).well.dtype == np.int32
