"""ω, T and θ_max against Arb, and the motion against the table of true values."""

import csv

import flint
import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
import references

from pendax import Pendulum, Result, amplitude, energy, frequency, period, simulate
from pendax._sweep import sweep, velocities


@pytest.mark.parametrize("epsilon", [1.0, 9.81, 3e-5])
def test_every_frequency_of_the_sweep(epsilon, dtype):
    """Within 4 eps at each v0 of the main job, the neighbouring floats of 2√ε included."""
    epsilon = float(dtype.type(epsilon))
    v0 = np.unique(velocities(epsilon, 200_000 if dtype == np.float64 else 40_000).astype(dtype))
    separatrix = dtype.type(2 * np.sqrt(epsilon))
    beside = [np.nextafter(separatrix, dtype.type(x)) for x in (0, 1e9)]
    assert np.isin(beside, v0).all()
    swept = sweep(epsilon, v0)
    assert swept.omega.dtype == dtype
    omega, t = references.frequencies(epsilon, v0)
    assert np.abs(references.relative_errors(swept.omega, omega)).max() <= 4
    assert np.abs(references.relative_errors(swept.t, t)).max() <= 4


def test_sweep_reaches_the_last_distances():
    swept = sweep(1.0, velocities(1.0, 200_000))
    assert swept.v0.size >= 100_000
    assert (np.diff(swept.v0) > 0).all()
    assert (swept.t == 0).sum() == (swept.omega == 0).sum() == 1
    assert np.spacing(2.0) in swept.t[~swept.below]
    assert np.spacing(1.0) in swept.t[swept.below]


def test_blocks_do_not_show():
    v0 = velocities(2.0, 150_000)
    heard = []
    swept = sweep(2.0, v0, heard.append)
    assert sum(heard) == v0.size
    assert len(heard) > 1
    np.testing.assert_array_equal(swept.omega[-100:], sweep(2.0, v0[-100:]).omega)


SPEEDS = [0.0, 1e-300, 0.3, 1.0, 1.9999, 2 - 2**-51, 2 + 2**-50, 2.5, 30.0, 1e8]


@pytest.mark.parametrize("v0", SPEEDS)
@pytest.mark.parametrize("epsilon", [1.0, 9.81])
def test_derivatives_of_the_frequency(v0, epsilon):
    """First derivatives in v0 and ε, and the second in v0, by every mode."""
    v0 = v0 * float(np.sqrt(epsilon)) if v0 < 1e7 else v0

    def reference(x, y):
        gap = 4 * y - x * x
        if gap > 0:
            return mp.agm(2 * mp.sqrt(y), mp.sqrt(gap)) / 2
        return mp.agm(abs(x), mp.sqrt(-gap))

    with mp.workdps(120):
        point = (mp.mpf(v0), mp.mpf(epsilon))
        step = mp.mpf(10) ** -40
        true = [float(mp.diff(reference, point, order, h=step)) for order in ((1, 0), (0, 1))]
        curvature = float(mp.diff(reference, point, (2, 0), h=step))

    def omega(x):
        return frequency(Pendulum(x[1]), x[0])

    x = jnp.array([v0, epsilon])
    for mode in (jax.grad, jax.jacfwd, lambda f: jax.jit(jax.grad(f))):
        np.testing.assert_allclose(mode(omega)(x), true, rtol=2e-14, atol=1e-40)
    for mode in (jax.hessian, lambda f: jax.jacfwd(jax.jacfwd(f))):
        scale = abs(curvature) + abs(true[0]) / max(v0, 1)
        assert abs(float(mode(omega)(x)[0, 0]) - curvature) <= 1e-12 * scale


def test_special_points(dtype):
    pendulum = Pendulum(jnp.asarray(4.0, dtype))

    def omega(v0):
        return frequency(pendulum, v0)

    at_rest = jnp.zeros((), dtype)
    assert omega(at_rest) == 2
    assert jax.grad(omega)(at_rest) == 0
    np.testing.assert_allclose(jax.hessian(omega)(at_rest), -1 / 16, rtol=4 * jnp.finfo(dtype).eps)

    separatrix = jnp.asarray(4.0, dtype)
    assert omega(separatrix) == 0
    assert period(pendulum, separatrix) == jnp.inf
    for mode in (jax.grad, jax.jacfwd):
        assert mode(omega)(separatrix) == -jnp.inf
        assert mode(lambda e: frequency(Pendulum(e), separatrix))(pendulum.epsilon) == jnp.inf
    np.testing.assert_allclose(amplitude(pendulum, separatrix), np.pi, rtol=jnp.finfo(dtype).eps)

    tiny = jnp.asarray(1e-300 if dtype == np.float64 else 1e-36, dtype)
    assert amplitude(pendulum, tiny) == tiny / 2
    assert (
        amplitude(pendulum, at_rest) == jax.grad(lambda v0: amplitude(pendulum, v0))(at_rest) == 0
    )

    v0 = jnp.asarray([0.5, 3.0, 4.0, 7.0], dtype)
    assert (omega(v0) == omega(-v0)).all()
    lanes = jax.vmap(omega)(jnp.asarray([1.0, jnp.nan, 5.0], dtype))
    assert jnp.isnan(lanes).tolist() == [False, True, False]


def test_scales_without_overflow():
    for unit in (2.0**-500, 2.0**500):
        for v0 in (0.5, 1.999, 2.5):
            scaled = frequency(Pendulum(unit**2), v0 * unit)
            assert scaled == unit * frequency(Pendulum(), v0)
    assert frequency(Pendulum(), 1e300) == 1e300


def test_general_start_has_the_frequency_of_its_energy():
    """ω(θ0, v0) = ω(0, v) at v² = v0² + 4ε sin²(θ0/2), both sides and the top."""
    rng = np.random.default_rng(5)
    v0, theta0 = rng.uniform(-2, 2, 200), rng.uniform(-10, 10, 200)
    speed = np.sqrt(v0**2 + 4 * 1.7 * np.sin(theta0 / 2) ** 2)
    pendulum = Pendulum(1.7)
    np.testing.assert_allclose(
        frequency(pendulum, v0, theta0), frequency(pendulum, speed), rtol=1e-11
    )
    assert 0 < frequency(pendulum, 0.0, np.pi) < 0.1  # the float π is not at the top
    np.testing.assert_allclose(amplitude(pendulum, 0.0, 3.0), 3.0, rtol=1e-15)


@pytest.mark.parametrize("kind", ["any", "separatrix", "top", "tiny", "fast"])
def test_frequency_from_any_start(kind, dtype):
    """8 eps × scale of the frequency and of the period."""
    rng = np.random.default_rng(12)
    size, last = 60, (-15 if dtype == np.float64 else -6)
    epsilon, theta0 = 10 ** rng.uniform(-12, 12, size), rng.uniform(-1000, 1000, size)
    v0 = rng.uniform(-4, 4, size)
    if kind == "separatrix":
        theta0 = rng.uniform(-3.1, 3.1, size)
        v0 = 2 * np.cos(theta0 / 2) * (1 + 10 ** rng.uniform(last, -1, size))
    if kind == "top":
        v0, theta0 = v0 * 10 ** rng.uniform(-10, 0, size), np.full(size, np.pi)
    if kind == "tiny":
        v0, theta0 = 10 ** rng.uniform(-300 if last == -15 else -36, -8, size), 0 * theta0
    if kind == "fast":
        v0 = 10 ** rng.uniform(0, 8, size)
    rows = np.stack([epsilon, v0 * np.sqrt(epsilon), theta0], 1).astype(dtype)
    columns = [jnp.asarray(x) for x in rows.T]
    omega = frequency(Pendulum(columns[0]), *columns[1:])
    turn = period(Pendulum(columns[0]), *columns[1:])

    def reference(epsilon, v0, theta0):
        gap = 4 * epsilon * (theta0 / 2).cos() ** 2 - v0 * v0
        if gap > 0:
            return (2 * epsilon.sqrt()).agm(gap.sqrt()) / 2
        return (v0 * v0 + 4 * epsilon * (theta0 / 2).sin() ** 2).sqrt().agm((-gap).sqrt())

    eps = float(np.finfo(dtype).eps)
    with flint.ctx.workprec(1500):
        for row, w, t in zip(rows, omega, turn, strict=True):
            at = [flint.arb(float(x)) for x in row]
            true, h = reference(*at), flint.arb(2) ** -300
            scale = float(abs(true))
            for i in range(3):
                moved = [x * (1 + h) if i == j else x for j, x in enumerate(at)]
                scale += abs(float((reference(*moved) - true) / h))
            assert abs(float(flint.arb(float(w)) - true)) <= 8 * eps * scale, row
            inverse = 2 * flint.arb.pi() / true
            bar = 8 * eps * scale * float(inverse / true)
            assert abs(float(flint.arb(float(t)) - inverse)) <= bar, row


def test_against_the_table_of_periods(shared):
    with (shared / "truth" / "conservative_periods.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["v0_kind"] == "float64"]
    v0 = np.array([float(row["v0_exact"]) for row in rows])
    assert len(rows) > 10
    for name, values in (
        ("T", period(Pendulum(), v0)),
        ("omega", frequency(Pendulum(), v0)),
        ("theta_max", amplitude(Pendulum(), v0)),
    ):
        true = np.array([float(row[name] or "inf") for row in rows])
        np.testing.assert_allclose(values, true, rtol=2e-15)


# --- the motion ---------------------------------------------------------------------


@pytest.mark.parametrize("theta0", [0.0, 3.0, -9.0, 40.0])
@pytest.mark.parametrize("v0", [1.5, -2.0001, 2.0001, 2.5, -7.0])
def test_turns_are_counted(theta0, v0):
    """θ is unwrapped: it never steps by more than the largest velocity allows."""
    ts = 0.002 * jnp.arange(-20000.0, 20001.0)
    run = simulate(Pendulum(), ts, v0, theta0)
    fastest = float(jnp.abs(run.v).max())
    assert float(jnp.abs(jnp.diff(run.theta)).max()) <= 1.001 * fastest * 80 / 40000
    np.testing.assert_allclose(run.theta[20000], theta0, atol=2e-15, rtol=1e-15)
    np.testing.assert_allclose(run.v[20000], v0, rtol=1e-14)
    start = energy(Pendulum(), theta0, v0)
    np.testing.assert_allclose(energy(Pendulum(), run.theta, run.v), start, rtol=3e-13)


@pytest.mark.parametrize("v0", [0.0, 1.0, 2.0, 3.0])
def test_motion_satisfies_the_equation_of_motion(v0):
    """∂θ/∂t = v and ∂v/∂t = −ε sin θ by automatic differentiation, v0 = 2√ε included."""
    pendulum = Pendulum(1.0)

    def at(t):
        run = simulate(pendulum, t, v0, 0.5)
        return jnp.stack([run.theta, run.v])

    for t in (-3.0, 0.0, 2.0):
        theta, v = at(t)
        np.testing.assert_allclose(jax.jacfwd(at)(t), [v, -jnp.sin(theta)], atol=2e-14)


def test_gradients_against_the_table(shared):
    with (shared / "truth" / "conservative_gradients.csv").open() as file:
        rows = list(csv.DictReader(file))

    @jax.jit
    @jax.vmap
    def jacobian(t, v0):
        def at(x):
            run = simulate(Pendulum(x[2]), t, x[0], x[1])
            return jnp.stack([run.theta, run.v])

        return jax.jacrev(at)(jnp.stack([v0, 0 * v0, 1 + 0 * v0]))

    t, v0 = (jnp.array([float(row[name]) for row in rows]) for name in ("t", "v0"))
    names = [f"d{y}_d{x}" for y in ("theta", "v") for x in ("v0", "theta0", "eps")]
    true = np.array([[float(row[name]) for name in names] for row in rows])
    got = np.asarray(jacobian(t, v0)).reshape(len(rows), 6)
    # The table's v0 are decimals: nearer to 2 it matters which float stands for them.
    away = np.abs(v0 - 2) > 1e-3
    assert away.sum() > 10
    scale = np.maximum(np.abs(true).max(1, keepdims=True), 1)
    assert np.abs((got - true) / scale)[away].max() < 1e-11


def test_shapes_and_result():
    pendulum = Pendulum(jnp.array([1.0, 2.0, 3.0]))
    ts = jnp.zeros((4, 5))
    run = simulate(pendulum, ts, jnp.zeros((2, 1)))
    assert run.theta.shape == run.v.shape == (2, 3, 4, 5)
    run = simulate(Pendulum(), jnp.arange(3.0), jnp.array([1.0, jnp.nan, 2.0]))
    assert (run.result == Result.successful).tolist() == [True, False, True]
    assert jnp.isfinite(run.theta[::2]).all()
    assert simulate(Pendulum(), 1.0, 1.0).theta.shape == ()
    assert simulate(Pendulum(), 1.5, 1.0, t0=0.5).theta == simulate(Pendulum(), 1.0, 1.0).theta


def test_traced_epsilon_out_of_its_domain_is_nan_in_its_lane():
    out = jax.vmap(lambda e: frequency(Pendulum(e), 1.0))(jnp.array([1.0, -1.0, 0.0, 2.0]))
    assert jnp.isnan(out).tolist() == [False, True, True, False]
    out = jax.vmap(lambda e: simulate(Pendulum(e), 1.0, 1.0).theta)(jnp.array([1.0, -1.0, 0.0]))
    assert jnp.isnan(out).tolist() == [False, True, True]
