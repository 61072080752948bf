"""Constant torque: random scenes, derivatives and overdamped ones against 30 digits."""

from functools import cache, partial

import damped_references as references
import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, Result, condition, simulate

NAMES = ("epsilon", "beta", "tau", "theta0", "v0")


def draw(seed, count):
    """Rows ε, β, τ, θ0, v0, which float32 holds as well."""
    rng = np.random.default_rng(seed)
    rows = [
        np.ones(count),
        10 ** rng.uniform(-3, 1, count),
        rng.uniform(-2, 2, count),
        rng.uniform(-np.pi, np.pi, count),
        rng.uniform(-4, 4, count),
    ]
    return np.stack(rows, 1).astype(np.float32).astype(float)


@cache
def true_states(seed, count):
    """At t = 10, 20 … 100."""
    ts = np.arange(10.0, 101.0, 10.0)
    return np.array([references.trajectory(*row, ts) for row in draw(seed, count)])


@pytest.mark.parametrize(("seed", "count"), [(1, 12), pytest.param(2, 300, marks=pytest.mark.full)])
def test_random_scenes(seed, count, dtype):
    """Within 50 × tolerance × (1 + max|y|) (1 + κ), for every tolerance."""
    ts, true = np.arange(1, 101, dtype=dtype), true_states(seed, count)
    epsilon, beta, tau, theta0, v0 = jnp.asarray(draw(seed, count).T, dtype)
    scene = Pendulum(epsilon, beta, tau)
    kappa = np.asarray(condition(scene, ts, v0, theta0))[:, 9::10]
    tolerances = (1e-4, 1e-8, 1e-13) if dtype == np.float64 else (1e-6,)
    for rtol in tolerances:
        run = simulate(scene, ts, v0, theta0, rtol=rtol)
        assert run.method == "Taylor series"
        states = np.stack([run.theta, run.v], -1).astype(float)
        largest = np.maximum.accumulate(np.abs(states).max(-1), 1)[:, 9::10]
        error = np.abs(states[:, 9::10] - true).max(-1)
        assert (error / (rtol * (1 + largest) * (1 + kappa))).max() < 50


def test_derivatives():
    """Gradients within 1e-8, Hessians within 1e-6 of their scales, in every mode."""
    rows = draw(5, 4)
    ts, step = [20.0], 1e-7

    def last(x):
        return simulate(Pendulum(x[0], x[1], x[2]), ts[0], x[4], x[3]).theta

    gradients = {mode: jax.jit(mode(last)) for mode in (jax.jacfwd, jax.grad)}
    hessian = jax.jit(jax.hessian(last))
    for row in rows:
        true = np.array(references.trajectory(*row, ts, NAMES)[0])
        slopes = true[2::2]
        moved = []
        for unit in np.eye(5) * step:
            ends = row + unit, row - unit
            far, near = (references.trajectory(*x, ts, NAMES)[0][2::2] for x in ends)
            moved.append(np.subtract(far, near) / (ends[0] - ends[1]).sum())
        curvature = np.array(moved)
        size = np.abs(row)
        scale = np.abs(slopes) + np.abs(curvature) @ size
        scale = scale + (np.abs(true[0]) + np.abs(slopes) @ size) / np.maximum(size, 1)
        for gradient in gradients.values():
            assert (np.abs(gradient(row) - slopes) < 1e-8 * scale).all()
        assert np.abs(hessian(row) - curvature).max() < 1e-6 * np.abs(curvature).max()


@cache
def true_slope(epsilon, beta, tau, v0):
    """θ(10), and by ε."""
    row = references.trajectory(epsilon, beta, tau, 0.0, v0, [10.0], ["epsilon"])[0]
    return row[0], row[2]


@pytest.mark.parametrize("mode", [jax.jacfwd, pytest.param(jax.grad, marks=pytest.mark.full)])
def test_derivatives_of_fast_rotations(mode, dtype):
    """∂θ/∂ε while the motion knows little of ε, whose steps could be longer than a turn."""
    rtol = 1e-10 if dtype == np.float64 else 1e-6
    epsilon = np.array([1.0, 2.0**-7, 2.0**-13, 2.0**-40, 2.0**-100], dtype)
    v0 = np.array([100.0, 2.0, 2.0, 2.0, 2.0], dtype)
    for beta, tau in ((None, 0.25), (0.125, None), (0.125, 0.25)):

        def last(epsilon, v0, beta=beta, tau=tau):
            return simulate(Pendulum(epsilon, beta, tau), 10.0, v0, rtol=rtol).theta

        found = jax.jit(jax.vmap(mode(last)))(epsilon, v0)
        for slope, *row in zip(found, epsilon.tolist(), v0.tolist(), strict=True):
            theta, true = true_slope(row[0], beta or 0.0, tau or 0.0, row[1])
            assert abs(slope - true) < 10 * rtol * (1 + abs(theta)), (beta, tau, row)


RIGHT = np.pi / 2


@cache
def released(epsilon, tau, theta0):
    """θ(4), v(4), and ∂θ/∂ε, from rest."""
    return references.trajectory(epsilon, 0.0, tau, theta0, 0.0, [4.0], ["epsilon"])[0][:3]


def test_releases_from_rest(dtype):
    """Of whose series three powers of four vanish, or nearly: their steps are no longer for it."""
    epsilon = [9.81, 1.0, 1.0, 2.0**-10, 2.0**-10, 2.0**-50]
    tau = [0.0, 0.0, 1.5, 0.0, 1.0, 4.0]
    theta0 = [0.0, RIGHT, RIGHT + 1e-9, RIGHT + 1e-4, 3 * RIGHT]
    scenes = [(e, t, x) for e, t in zip(epsilon, tau, strict=True) for x in theta0]
    scenes = np.array(scenes, dtype)
    true = np.array([released(*scene) for scene in scenes.astype(float).tolist()])
    scale = 1 + np.abs(true[:, :2]).max(1)
    tolerances = (8e-15, 1e-6, 1e-7, 1e-9, 1e-12) if dtype == np.float64 else (6e-7, 1e-5)
    for rtol in tolerances:

        def last(epsilon, tau, theta0, rtol=rtol):
            run = simulate(Pendulum(epsilon, None, tau), 4.0, 0.0, theta0, rtol=rtol)
            return run.theta, run.v

        states = np.stack(jax.jit(jax.vmap(last))(*scenes.T), 1)
        slopes = jax.jit(jax.vmap(jax.grad(lambda *x, f=last: f(*x)[0])))(*scenes.T)
        error = np.abs(states - true[:, :2]).max(1) / scale
        assert error.max() < 100 * rtol, scenes[error.argmax()]
        error = np.abs(slopes - true[:, 2]) / (scale + np.abs(true[:, 2]))
        assert error.max() < 100 * rtol, scenes[error.argmax()]


@pytest.mark.parametrize("mode", [jax.jacfwd, jax.grad])
@pytest.mark.parametrize("solver", [None, dfx.Tsit5()])
def test_a_lane_that_fails_has_no_derivatives(solver, mode):
    def last(beta, most, t=10.0):
        run = simulate(Pendulum(1.0, beta), t, 1.0, solver=solver, max_steps=most, throw=False)
        return run.theta

    assert np.isnan(last(0.1, 5))
    assert np.isnan(mode(partial(last, most=5))(0.1))
    by_time = jax.jit(lambda beta, t: mode(partial(last, beta, 500))(t))
    assert np.isnan(by_time(-0.1, 10.0))


def test_backwards_steps_are_as_many_as_it_needs():
    """Where damping makes v grow like e^(β|t|)."""
    beta, t = jnp.array([1.0, 2.0, 0.5]), jnp.array([-10.0, -5.0, -20.0])

    def last(beta, t, most):
        return simulate(Pendulum(1.0, beta), t, 1.0, max_steps=most, throw=False).theta

    given, enough = (jax.vmap(partial(last, most=most))(beta, t) for most in (None, 10_000))
    assert np.isfinite(enough).all()
    np.testing.assert_array_equal(given, enough)


def test_memory_of_a_gradient_does_not_grow_with_the_steps():
    def memory(t):
        gradient = jax.grad(lambda v0: simulate(Pendulum(1.0, 1e-3, 0.1), t, v0, throw=False).theta)
        return jax.jit(gradient).lower(1.0).compile().memory_analysis().temp_size_in_bytes

    assert memory(1e4) == memory(1.0)


@pytest.mark.parametrize("tau", [0.5, 1.5])
@pytest.mark.parametrize("beta", [1e3, 1e5, 1e8])
def test_overdamped(beta, tau, dtype):
    """Right to the tolerance, in steps that don't grow with β."""
    beta = float(dtype.type(beta))
    ts = [float(dtype.type(x)) for x in (3 / beta, 100 / beta, 0.01 * beta, beta, 10 * beta)]
    true = np.array(references.overdamped(1.0, beta, tau, 0.5, 2.0, ts))
    scene = Pendulum(*(jnp.asarray(x, dtype) for x in (1.0, beta, tau)))
    start = jnp.asarray(2.0, dtype), jnp.asarray(0.5, dtype)
    for rtol, most in ((1e-6, 100), (1e-12, 300)) if dtype == np.float64 else ((1e-6, 100),):
        run = simulate(scene, jnp.asarray(ts, dtype), *start, rtol=rtol)
        assert int(run.stats["steps"]) < most
        error = np.abs(np.stack([run.theta, run.v], 1) - true).max()
        assert error < 50 * rtol * (1 + np.abs(true).max())
    # A velocity is right relatively, where the angle still moves.
    np.testing.assert_allclose(run.v[2], true[2, 1], rtol=1e-4)


def test_overdamped_slopes():
    """∂θ/∂β and ∂θ/∂v0 at β = 1e3, against differences of the reference."""

    def last(x):
        return simulate(Pendulum(1.0, x[0], 0.5), 700.0, x[1], 0.5).theta

    x, step = np.array([1e3, 2.0]), np.array([1e-2, 1e-3])
    got = jax.grad(last)(x)
    for i in range(2):
        ends = [x + sign * step[i] * np.eye(2)[i] for sign in (1, -1)]
        up, down = (references.overdamped(1.0, y[0], 0.5, 0.5, y[1], [700.0])[0] for y in ends)
        np.testing.assert_allclose(got[i], (up[0] - down[0]) / (2 * step[i]), rtol=1e-8)


def test_what_fails_says_so():
    scene, ts = Pendulum(1.0, 0.1, 0.5), jnp.array([1.0, 1e3])
    run = simulate(scene, ts, 1.0, max_steps=20, throw=False)
    assert run.result == Result.too_many_steps
    assert jnp.isnan(run.theta).tolist() == [False, True]
    with pytest.raises(RuntimeError, match="Raise `max_steps`"):
        simulate(scene, ts, 1.0, max_steps=20)
    options = {"solver": dfx.Dopri8(), "max_steps": 1000, "throw": False}
    run = simulate(Pendulum(1.0, 1e5, 0.5), 1e6, 1.0, **options)
    assert run.result == Result.too_stiff
    assert jnp.isnan(run.theta)
    with pytest.raises(ValueError, match="`max_steps` must be 1 or more"):
        simulate(scene, ts, 1.0, max_steps=0)
    for name in ("rtol", "atol"):
        with pytest.raises(ValueError, match=f"`{name}` must be one positive number"):
            simulate(scene, ts, 1.0, **{name: 0.0})


def test_the_scene_chooses():
    def method(*terms, t=10.0, t0=0.0, **options):
        scene = Pendulum(*terms)

        def call():  # traced, not compiled
            return simulate(scene, t, 1.0, t0=t0, throw=False, **options)

        return jax.eval_shape(call).method

    assert method(1.0) == "closed form"
    assert method(1.0, 0.1, 0.2) == method(1.0, None, 0.2) == method(1.0, 1e5) == "Taylor series"
    assert method(1.0, 0.1, jnp.sin) == "Taylor series"
    assert method(1.0, 1e5, jnp.sin) == "Kvaerno5"
    assert method(1.0, 0.1, rtol=1e-3, dt0=0.1) == "Dopri8"
    assert method(1.0, 0.1, solver=dfx.Tsit5(), rtol=1e-3) == "Tsit5"
    averaging = "averaging over turns"
    assert method(1.0, 1e-5, t=1e5) == method(1.0, 1e-5, t=0.0, t0=-1e5) == averaging
    assert method(1.0, np.array([1e-5, np.nan]), t=1e5) == averaging
    assert method(1.0, 1e-5, t=0.0, t0=1e5) == method(1.0, 1e-3, t=1e5) == "Taylor series"


def test_derivatives_at_rest():
    """A pendulum that hangs still says nothing of how perturbations move."""
    beta, t = 0.2, jnp.array([1.0, 50.0])

    def at(x):
        return simulate(Pendulum(1.0, beta, x[0]), t, x[1], x[2]).theta

    omega = np.sqrt(1 - beta**2 / 4)
    decay, phase = np.exp(-beta * np.asarray(t) / 2), omega * np.asarray(t)
    by_v0 = decay * np.sin(phase) / omega
    by_theta0 = decay * np.cos(phase) + beta / 2 * by_v0
    true = np.stack([1 - by_theta0, by_v0, by_theta0], 1)
    np.testing.assert_allclose(jax.jacfwd(at)(jnp.zeros(3)), true, atol=1e-12)
    overdamped = jax.jacfwd(lambda tau: simulate(Pendulum(1.0, 1e4, tau), 2e4, 0.0).theta)
    np.testing.assert_allclose(overdamped(0.0), 1 - np.exp(-2), rtol=1e-7)


def test_a_lane_without_an_answer_takes_no_steps():
    tau = jnp.array([0.1, jnp.nan])

    def lanes(tau):
        run = simulate(Pendulum(1.0, None, tau), jnp.array([100.0]), 1.0, throw=False)
        return run.theta, (run.stats["steps"], run.result)

    back = jax.grad(lambda tau: lanes(tau)[0].sum())(tau)
    assert jnp.isnan(back).tolist() == [False, True]
    theta, slope, (steps, result) = jax.jvp(lanes, (tau,), (jnp.ones(2),), has_aux=True)
    assert jnp.isnan(theta[1]).all()
    assert jnp.isnan(slope[1]).all()
    assert jnp.isfinite(slope[0]).all()
    assert steps[1] == 1
    assert (result == Result.not_a_number).tolist() == [False, True]


def test_no_lanes():
    ts, none = jnp.array([1.0, 2e5]), jnp.zeros(0)
    for scene in (Pendulum(1.0, none), Pendulum(1.0, 1e-5), Pendulum(1.0, 0.1, jnp.sin)):
        assert simulate(scene, ts, none).theta.shape == (0, 2)


def test_at_rest_and_huge():
    """Exactly at the bottom, under a torque of 1e6, at v0 = 1e6, and τ = ε to 1e-12."""
    still = simulate(Pendulum(1.0, 0.1), jnp.array([1.0, 1e3]), 0.0)
    assert (still.theta == 0).all()
    for terms, start, t in (
        ((1.0, 0.5, 1e6), (0.0, 0.0), 0.01),
        ((1.0, 0.5, 0.0), (0.3, 1e6), 1e-4),
        ((1.0, 0.3, 1 + 1e-12), (0.1, 0.0), 30.0),
        ((1e-12, 1e-7, 3e-13), (0.1, 1e-6), 1e7),
        ((1e12, 1e5, 3e11), (0.1, 1e6), 1e-5),
    ):
        run = simulate(Pendulum(*terms), t, start[1], start[0])
        true = np.array(references.trajectory(*terms, *start, [t])[0])
        error = np.abs(np.array([run.theta, run.v]) - true) / (1 + np.abs(true))
        assert error.max() < 1e-11, terms


def test_flights_that_gravity_does_not_bend(dtype):
    """All terms of the series are 0 by underflow: one step is right."""
    small = dtype == np.float32
    for epsilon, speed in ((1e-30, 1e4), (1, 1e20)) if small else ((1e-300, 1e5), (1, 1e160)):
        scene = Pendulum(dtype.type(epsilon), dtype.type(0))
        ts = np.array([1e-3, 1.0], dtype)
        run = simulate(scene, ts, dtype.type(speed), dtype.type(0.3))
        assert run.stats["steps"] == 2
        true = 0.3 + float(dtype.type(speed)) * ts.astype(float)
        np.testing.assert_allclose(run.theta, true, rtol=4 * np.finfo(dtype).eps)
        np.testing.assert_allclose(run.v, dtype.type(speed), rtol=4 * np.finfo(dtype).eps)
