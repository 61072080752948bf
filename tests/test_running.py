"""Retrapping torque and mean velocity, against the truth and against Arb."""

import csv
import json

import fate_references as references
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, mean_velocity, retrapping_torque

BETA_STAR = 1.19304591882263494


def running(beta, tau, epsilon=1.0):
    return mean_velocity(Pendulum(epsilon, beta, tau))


def test_retrapping_of_the_table(shared):
    truth = json.loads((shared / "truth" / "retrapping_tau_r.json").read_text())
    beta = np.array([float(row["beta"]) for row in truth["rows"]])
    tau = np.array([float(row["tau_r"]) for row in truth["rows"]])
    np.testing.assert_allclose(retrapping_torque(beta), tau, rtol=1e-15)
    np.testing.assert_allclose(BETA_STAR, float(truth["beta_star"]["value"]), rtol=1e-15)


def test_retrapping_at_fresh_dampings():
    """Another route, velocities at the bottom, at dampings that no table has."""
    beta = 10 ** np.random.default_rng(7).uniform(-3, 0.06, 8)
    true = [float(references.retrapping(x)) for x in beta]
    np.testing.assert_allclose(retrapping_torque(beta), true, rtol=2e-15)


def test_retrapping_of_weak_damping():
    beta = np.array([1e-300, 1e-9, 1e-6, 1e-4])
    series = 4 / np.pi * beta - 0.3151392887 * beta**3
    np.testing.assert_allclose(retrapping_torque(beta), series, rtol=1e-15)
    assert retrapping_torque(0.0) == 0


def test_where_retrapping_ends():
    """From β* on it is ε; what the polynomial says there is the angle α = π/2."""
    at = np.array([np.nextafter(BETA_STAR, 0), BETA_STAR, np.nextafter(BETA_STAR, 2), 10.0, 1e9])
    np.testing.assert_array_equal(retrapping_torque(1.5 * at[1:], 2.25), 2.25)
    np.testing.assert_allclose(retrapping_torque(at), 1, atol=1e-15)
    below = retrapping_torque(BETA_STAR - 1e-4)
    # 1 − τ_r is quadratic: κ = √(1 − τ²) goes to 0 linearly.
    assert 1e-9 < 1 - below < 1e-7
    for mode in (jax.grad, jax.jacfwd):
        slopes = jax.vmap(mode(retrapping_torque))(at)
        np.testing.assert_allclose(slopes, 0, atol=1e-14)


def test_slopes_of_retrapping(shared):
    truth = json.loads((shared / "truth" / "gradients_derived.json").read_text())
    for row in truth["dtau_r"]:
        for mode in (jax.grad, jax.jacfwd):
            slope = mode(retrapping_torque)(float(row["beta"]))
            np.testing.assert_allclose(slope, float(row["dtau_r_dbeta"]), rtol=1e-13)
    # ε sets the unit of time: τ_r(β, ε) = ε τ_r(β/√ε, 1), so β ∂β + 2 ε ∂ε of it is 2 τ_r.
    by_beta, by_epsilon = jax.grad(retrapping_torque, (0, 1))(0.7, 3.0)
    total = 0.7 * by_beta + 2 * 3.0 * by_epsilon
    np.testing.assert_allclose(total, 2 * retrapping_torque(0.7, 3.0), rtol=1e-14)
    curvature = jax.hessian(retrapping_torque)(0.3)
    near = [retrapping_torque(0.3 + x) for x in (-1e-3, 0, 1e-3)]
    np.testing.assert_allclose(curvature, (near[0] - 2 * near[1] + near[2]) / 1e-6, rtol=1e-5)


def test_mean_velocity_of_the_table(shared):
    with (shared / "truth" / "mean_velocity.csv").open() as file:
        rows = list(csv.DictReader(file))
    beta, tau, v = (
        np.array([float(row[name]) for row in rows]) for name in ("beta", "tau", "mean_v")
    )
    np.testing.assert_allclose(running(beta, tau), v, rtol=2e-12)
    np.testing.assert_allclose(running(beta, -tau), -v, rtol=2e-12)
    with jax.enable_x64(False):
        single = running(*(jnp.asarray(x, np.float32) for x in (beta, tau)))
        assert single.dtype == np.float32
    slopes = jax.vmap(jax.grad(running, (0, 1)))(beta, tau)
    scale = np.abs(v) + np.abs(beta * slopes[0]) + np.abs(tau * slopes[1])
    assert (np.abs(single.astype(float) - v) < 4e-6 * scale).all()


def scenes():
    """Weak to strong damping, barely above τ_r and far above ε."""
    rng = np.random.default_rng(11)
    found = [(1e-6, 2e-6), (1e-6, 1.0), (1e-3, 0.5), (1.19, 1.0), (2.0, 1.01)]
    for _ in range(8):
        beta = 10 ** rng.uniform(-3, 0)
        found.append((beta, float(retrapping_torque(beta)) * (1 + 10 ** rng.uniform(-3, 1))))
    return found


@pytest.mark.parametrize(
    ("beta", "tau"),
    [x if i % 2 else pytest.param(*x, marks=pytest.mark.full) for i, x in enumerate(scenes())],
)
def test_mean_velocity(beta, tau):
    """1e-10 relative, and derivatives 1e-7, against differences of 30 digits."""
    true = float(references.mean_velocity(beta, tau))
    np.testing.assert_allclose(running(beta, tau), true, rtol=1e-10)
    forward = jax.jacfwd(running, (0, 1))(beta, tau)
    reverse = jax.grad(running, (0, 1))(beta, tau)
    np.testing.assert_allclose(forward, reverse, rtol=1e-9)
    for i, x in enumerate((beta, tau)):
        # Steps that are floats, and short beside the distance to τ_r.
        step = x * 2.0**-24 * min(1, (tau / float(retrapping_torque(beta)) - 1))
        ends = []
        for k in (2, 1, -1, -2):
            at = [beta, tau]
            at[i] = x + k * step
            ends.append((at[i], references.mean_velocity(*at)))
        (a2, f2), (a1, f1), (b1, g1), (b2, g2) = ends
        far, near = (f2 - g2) / (a2 - b2), (f1 - g1) / (a1 - b1)
        np.testing.assert_allclose(forward[i], float((4 * near - far) / 3), rtol=1e-7)


def test_beside_retrapping():
    """Within 1e-9 of τ_r, 1e-10 of |v̄| + |τ ∂v̄/∂τ| + |β ∂v̄/∂β|."""
    for beta in (1e-6, 0.16, 1.0):
        tau = float(retrapping_torque(beta)) * (1 + 1e-9)
        true = float(references.mean_velocity(beta, tau))
        by_beta, by_tau = jax.grad(running, (0, 1))(beta, tau)
        scale = abs(true) + abs(tau * by_tau) + abs(beta * by_beta)
        assert abs(running(beta, tau) - true) < 4e-14 * scale
        np.testing.assert_allclose(running(beta, tau), true, rtol=1e-6)


def test_overdamped():
    """√(τ² − 1)/β and what is left of it."""
    for beta, tau in ((1e2, 1.2), (1e3, 1.5), (1e4, 1.2), (1e4, 3.0)):
        true = float(references.mean_velocity_overdamped(beta, tau))
        np.testing.assert_allclose(running(beta, tau), true, rtol=1e-12)
    for beta in (1e5, 1e9, 1e16, 1e100):
        np.testing.assert_allclose(running(beta, 2.0), np.sqrt(3) / beta, rtol=1e-14)
        slopes = jax.grad(running, (0, 1))(beta, 2.0)
        true = -np.sqrt(3) / beta / beta, 2 / np.sqrt(3) / beta
        np.testing.assert_allclose(slopes, true, rtol=1e-12)
    np.testing.assert_allclose(running(1e4, 1 + 1e-9), np.sqrt(2e-9 + 1e-18) / 1e4, rtol=2e-7)


def test_fast():
    """τ/β and what is left of it, on both sides of where the series takes over."""
    for beta, tau in ((1.0, 5e3), (1.0, 6e3), (0.1, 7.0), (0.1, 9.0), (30.0, 9e4)):
        true = float(references.mean_velocity(beta, tau))
        np.testing.assert_allclose(running(beta, tau), true, rtol=1e-14)
    for beta, tau in ((1e-14, 1.0), (1.0, 1e13), (1.0, 1e160), (1e6, 1e300)):
        np.testing.assert_allclose(running(beta, tau), tau / beta, rtol=1e-14)
        slopes = jax.grad(running, (0, 1))(beta, tau)
        np.testing.assert_allclose(slopes, (-tau / beta / beta, 1 / beta), rtol=1e-9)
    with jax.enable_x64(False):
        for beta, tau in ((1.0, 1e5), (1e-5, 1.0), (1e8, 2.0), (1.0, 30.0), (50.0, 2.0)):
            true = float(references.mean_velocity(beta, tau)) if beta < 1e8 else np.sqrt(3) / beta
            np.testing.assert_allclose(running(np.float32(beta), tau), true, rtol=2e-6)


def test_what_does_not_run():
    tau = jnp.array([0.0, 0.1, -0.2, 0.2024, 0.2025])
    assert (running(0.16, tau) == 0).tolist() == [True] * 4 + [False]
    assert (running(2.0, jnp.array([0.9999, -1.0])) == 0).all()
    assert mean_velocity(Pendulum(1.0, 0.16)) == 0
    np.testing.assert_array_equal(jax.grad(running, (0, 1))(0.16, 0.1), 0)
    undamped = jax.vmap(running)(jnp.zeros(3), jnp.array([0.5, -0.5, 0.0]))
    np.testing.assert_array_equal(undamped, [np.inf, -np.inf, 0])


def test_lanes():
    beta = jnp.array([0.1, jnp.nan, -1.0, 0.2])
    for function in (running, lambda beta, _: retrapping_torque(beta)):
        value = jax.jit(jax.vmap(lambda x, f=function: f(x, 0.9)))(beta)
        slope = jax.jit(jax.vmap(jax.grad(lambda x, f=function: f(x, 0.9))))(beta)
        for x in (value, slope):
            assert jnp.isnan(x).tolist() == [False, True, True, False]
    assert retrapping_torque(np.ones((3, 1)), np.ones(4)).shape == (3, 4)
    assert retrapping_torque(np.float32(0.5)).dtype == np.float32
    np.testing.assert_allclose(running(0.32, 1.0, 4.0), 2 * running(0.16, 0.25), rtol=1e-14)
    with pytest.raises(ValueError, match="`beta` must be zero or positive, but got -1"):
        retrapping_torque(-1.0)


@pytest.mark.full
def test_curvature():
    """Second derivatives, against differences of first ones."""
    hessian = jax.hessian(running, (0, 1))(0.5, 0.8)
    step = 1e-4
    for i in range(2):
        ends = []
        for k in (2, 1, -1, -2):
            at = [0.5, 0.8]
            at[i] += k * step
            ends.append(np.array(jax.jacfwd(running, (0, 1))(*at)))
        change = (8 * (ends[1] - ends[2]) - (ends[0] - ends[3])) / (12 * step)
        np.testing.assert_allclose(hessian[i], change, rtol=1e-6)
