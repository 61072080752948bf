"""Dry friction and recorded torques against Arb, from one switching to the next."""

from functools import cache

import diffrax
import dry_references as references
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from conftest import float32_in_full

from pendax import (
    Pendulum,
    Result,
    SampledTorque,
    fit_trajectory,
    fixed_points,
    mean_velocity,
    period,
    settle,
    simulate,
)

NAMES = ("epsilon", "beta", "tau", "dry", "theta0", "v0")
TS = np.linspace(3.0, 60.0, 20)
# Swings of many turning points; one that comes to rest; one that turns over first.
SCENES = [
    (4.0, 0.0, 0.0, 0.012, 2.5, 0.0),
    (1.5, 0.0, -0.07, 0.027, -0.76, -0.18),
    (2.2, 0.05, 0.3, 0.04, 1.1, 0.7),
    (1.0, 1e-3, 0.1, 0.06, 0.3, -3.4),
    (1.0, 0.0, 0.2, 0.05, 0.1, 2.0),
]
KNOTS = np.linspace(0.0, 30.0, 41)
TORQUES = np.random.default_rng(4).normal(size=41).round(6) * 2.5


def scene_of(x):
    return dict(zip(NAMES, x, strict=True))


def state(x, ts=TS):
    epsilon, beta, tau, dry, theta0, v0 = x
    run = simulate(Pendulum(epsilon, beta, tau, dry), ts, v0, theta0)
    return jnp.stack([run.theta, run.v], -1)


def floats(rows):
    return np.array([[float(x) for x in row] for row in rows])


motion, forward, reverse = jax.jit(state), jax.jit(jax.jacfwd(state)), jax.jit(jax.jacrev(state))


@pytest.mark.parametrize("scene", SCENES)
def test_motion(scene):
    """θ and v at 20 times, through dozens of turning points, and on at rest."""
    rows, turns, held = references.trajectory(**scene_of(scene), ts=TS)
    true, found = floats(rows), np.asarray(motion(jnp.array(scene)))
    kappa = 1 + np.abs(np.asarray(forward(jnp.array(scene)))[..., 4:]).max()
    assert np.abs(found - true).max() < 1e-14 * kappa * (1 + np.abs(true).max())
    assert held == (found[-1, 1] == 0)
    assert len(turns) > 3 or abs(true[-1, 0]) > 20


RISING = [(0.0, 0.0), (2.0, 2.0), (4.0, 4.0), (6.0, 1.0)]
FALLING = [(t, 2.0 - x) for t, x in RISING]


@pytest.mark.parametrize("rtol", [None, 1e-6, 1e-9])
@pytest.mark.parametrize("theta0", [0.0, np.pi / 2, np.pi / 2 + 1e-9])
def test_releases_from_rest(theta0, rtol):
    """Of whose series three powers of four vanish, five of six where the torque is a ramp."""
    scenes = [(9.81, 0.0, 0.05), (2.0**-10, 1.0, 0.125), (2.0, RISING, 0.1), (2.0, FALLING, 0.0),
              (2.0**-10, RISING, 0.0), (2.0**-30, RISING, 0.125)]  # fmt: skip
    ts = np.array([1.5, 5.0])
    for epsilon, tau, dry in scenes:
        torque = SampledTorque(*np.transpose(tau)) if isinstance(tau, list) else tau
        run = simulate(Pendulum(epsilon, None, torque, dry), ts, 0.0, theta0, rtol=rtol)
        rows = references.trajectory(epsilon, 0.0, tau, dry, theta0, 0.0, ts.tolist())[0]
        error = np.abs(np.stack([run.theta, run.v], 1) - floats(rows)).max()
        assert error < 100 * (rtol or 8e-15) * (1 + np.abs(floats(rows)).max()), (epsilon, tau)


@cache
def long_swing(ts):
    """Angles, the number of turning points, and κ."""
    rows, turns, _ = references.trajectory(**scene_of(SCENES[0]), ts=ts)
    with jax.enable_x64(True):
        slopes = forward(jnp.array(SCENES[0]), np.array(ts))
    return floats(rows)[:, 0], len(turns), np.abs(np.asarray(slopes)[..., 4:]).max()


@float32_in_full
def test_fifty_turning_points(dtype):
    """100 × tolerance × (1 + κ), the tolerance being that of `rtol`."""
    ts = np.linspace(12.0, 120.0, 10)
    true, turns, kappa = long_swing(tuple(ts))
    assert turns > 50
    for rtol in [1e-5] if dtype == np.float32 else [1e-6, 1e-9, 1e-12]:
        pendulum = Pendulum(dtype.type(4.0), None, None, dtype.type(0.012))
        run = simulate(pendulum, ts.astype(dtype), dtype.type(0), dtype.type(2.5), rtol=rtol)
        assert run.theta.dtype == dtype
        close = 100 * rtol * (1 + kappa)
        np.testing.assert_allclose(run.theta, true, rtol=0, atol=close)


@pytest.mark.parametrize("scene", SCENES[1:])
def test_gradients(scene):
    """In all parameters, through the turning points, forward and reverse."""
    true = np.moveaxis(references.slopes(NAMES, scene_of(scene), TS), 0, -1)
    x = jnp.array(scene)
    one, other = np.asarray(forward(x)), np.asarray(reverse(x))
    scale = np.abs(true).max((0, 1)) + 1
    assert (np.abs(one - true) / scale).max() < 1e-11
    np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)


@pytest.mark.full  # compiles for most of a minute
def test_second_derivatives():
    """By differences of first ones, of a scene that swings."""
    x, h = jnp.array(SCENES[2]), 1e-5

    def last(y):
        return state(jnp.concatenate([x[:3], y, x[5:]]), TS[:4])[-1, 0]

    y = x[3:5]  # c and θ0
    slope, found = jax.jit(jax.grad(last)), np.asarray(jax.jit(jax.hessian(last))(y))
    columns = [(slope(y.at[i].add(h)) - slope(y.at[i].add(-h))) / (2 * h) for i in range(2)]
    np.testing.assert_allclose(found, np.stack(columns), rtol=1e-6, atol=1e-6 * np.abs(found).max())


def test_a_start_at_rest_has_the_derivatives_of_the_motion_that_begins():
    """On the other side of v0 = 0 they are others; at a turning point a shift in time, −1/f."""
    push = 4.0 * np.sin(2.5) - 0.3
    slope = jax.jacfwd(lambda v: simulate(Pendulum(4.0, dry=0.3), TS[:2], v, 2.5).theta)(0.0)
    run = simulate(Pendulum(4.0, dry=0.3), TS[:2], 0.0, 2.5)
    np.testing.assert_allclose(slope, -run.v / push, rtol=1e-12)


def test_held_from_the_start_and_at_the_edge():
    ts = np.array([0.0, 1.0, 1.0, 50.0])
    held = simulate(Pendulum(1.0, dry=0.5), ts, 0.0, np.arcsin(0.4999))
    assert (held.theta == np.arcsin(0.4999)).all()
    assert (held.v == 0).all()
    assert simulate(Pendulum(1.0, dry=0.5), ts, 0.0, np.arcsin(0.5001)).theta[-1] < np.pi / 6
    # On the edge to a rounding, above or below.
    for tau, dry in ((0.3, 0.1), (0.4, 0.2), (0.26, 0.15), (0.35, 0.2)):
        edge = np.arcsin(tau + dry)
        for start in [*np.nextafter(edge, [-9, 9]).tolist(), edge]:
            run = simulate(Pendulum(1.0, 0.1, tau, dry), ts, 0.0, start)
            np.testing.assert_allclose(run.theta, edge, rtol=1e-15)
            assert abs(settle(Pendulum(1.0, 0.1, tau, dry), 0.0, start).theta - edge) < 1e-15
    top = simulate(Pendulum(1.0, dry=1e-3), ts, 0.0, np.pi)
    assert (top.theta == np.pi).all()
    # All parameters have derivatives there: those of a pendulum that stays where it is.
    slopes = jax.jacfwd(lambda x: simulate(Pendulum(1.0, dry=0.5), ts, 0.0, x).theta)(0.2)
    assert (slopes == 1).all()


def test_nothing_is_the_scene_without_it():
    """c = 0, hidden from sight by jit."""
    for beta, tau in ((None, None), (0.1, 0.3), (1e4, 0.2)):
        run = jax.jit(lambda c, b=beta, t=tau: simulate(Pendulum(1.0, b, t, c), TS, 0.5, 2.0).theta)
        plain = simulate(Pendulum(1.0, beta, tau), TS, 0.5, 2.0).theta
        np.testing.assert_allclose(run(0.0), plain, rtol=0, atol=1e-12)


def test_overdamped():
    """It creeps to the edge of the band, in few steps however large β is."""
    for beta in (1e3, 1e6):
        run = simulate(Pendulum(1.0, beta, 0.1, 0.2), np.array([30 * beta]), -5.0, 2.0)
        np.testing.assert_allclose(run.theta, np.arcsin(0.3), rtol=1e-10)
        assert run.stats["steps"] < 500


@pytest.mark.parametrize(
    ("beta", "dry", "v0"),
    [(0.2, 0.8, 1.3), (0.0, 1.4, 0.5), pytest.param(0.2, 0.3, 0.2, marks=pytest.mark.full)],
)
def test_recorded_torque(beta, dry, v0):
    """Stick and slip under lines between samples, with inertia and bias."""
    ts = np.linspace(1.3, 30.0, 20)

    def state(x, torque, bias):
        beta, dry, theta0, v0, inertia = x
        torque = SampledTorque(KNOTS, torque, inertia, bias)
        run = simulate(Pendulum(4.0, beta, torque, dry), ts, v0, theta0)
        return jnp.stack([run.theta, run.v], -1)

    x = jnp.array([beta, dry, 0.4, v0, 2.0])
    found = jax.jit(state)(x, TORQUES, 0.25)
    lines = [(t, (y + 0.25) / 2) for t, y in zip(KNOTS.tolist(), TORQUES.tolist(), strict=True)]
    given = {"epsilon": 4.0, "beta": beta, "tau": lines, "dry": dry, "theta0": 0.4, "v0": v0}
    rows, turns, _ = references.trajectory(**given, ts=ts)
    assert len(turns) > 5
    np.testing.assert_allclose(found, floats(rows), rtol=0, atol=1e-12)
    slopes = np.asarray(jax.jit(jax.jacrev(state))(x, TORQUES, 0.25))
    true = np.moveaxis(references.slopes(("beta", "dry", "theta0", "v0"), given, ts), 0, -1)
    np.testing.assert_allclose(slopes[..., :4], true, rtol=0, atol=1e-10 * (1 + np.abs(true).max()))
    # The inertia and the bias by differences of what has just been found right.
    h, run = 1e-6, jax.jit(state)
    moved = jnp.array([0, 0, 0, 0, h])
    by_inertia = (run(x + moved, TORQUES, 0.25) - run(x - moved, TORQUES, 0.25)) / (2 * h)
    np.testing.assert_allclose(slopes[..., 4], by_inertia, rtol=0, atol=1e-6)
    by_bias = (run(x, TORQUES, 0.25 + h) - run(x, TORQUES, 0.25 - h)) / (2 * h)
    found = jax.jit(jax.jacfwd(state, 2))(x, TORQUES, 0.25)
    np.testing.assert_allclose(found, by_bias, rtol=0, atol=1e-6)


def test_recorded_torque_without_friction_is_what_a_solver_finds():
    tau = SampledTorque(KNOTS, TORQUES)
    ts = np.linspace(0.0, 12.0, 41)
    ours = simulate(Pendulum(4.0, 0.2, tau), ts, 0.0)
    theirs = simulate(Pendulum(4.0, 0.2, tau), ts, 0.0, solver=diffrax.Dopri8())
    assert ours.method == "Taylor series"
    np.testing.assert_allclose(ours.theta, theirs.theta, rtol=0, atol=1e-8)
    backwards = simulate(Pendulum(4.0, 0.2, tau), ts[::-1], ours.v[-1], ours.theta[-1], t0=12.0)
    assert backwards.method == "Dopri8"
    np.testing.assert_allclose(backwards.theta[-1], 0.0, atol=1e-6)


@float32_in_full
def test_derivatives_in_the_times(dtype):
    """θ̇ in the saved time, and of the torque's clock: t0 and all times shifted change nothing."""
    tau = SampledTorque(KNOTS.astype(dtype), TORQUES.astype(dtype))
    pendulum = Pendulum(dtype.type(4), dtype.type(0.2), tau, dtype.type(0.5))

    def theta(t, t0):
        return simulate(pendulum, t[None], dtype.type(0.3), dtype.type(0.4), t0=t0).theta[0]

    of_t, of_start = jax.grad(theta, (0, 1))(dtype.type(7.7), dtype.type(1.1))
    v = simulate(pendulum, np.array([7.7], dtype), dtype.type(0.3), dtype.type(0.4), t0=1.1).v[0]
    np.testing.assert_allclose(of_t, v, rtol=1e-4 if dtype == np.float32 else 1e-11)
    h = 1e-2 if dtype == np.float32 else 1e-6
    ends = [theta(dtype.type(7.7), dtype.type(1.1 + x)) for x in (h, -h)]
    np.testing.assert_allclose(of_start, (ends[0] - ends[1]) / (2 * h), rtol=1e-2, atol=1e-3)


@pytest.mark.parametrize(
    ("dry", "outer"), [pytest.param(None, jax.jacrev, marks=pytest.mark.full), (0.5, jax.jacfwd)]
)
def test_second_derivatives_in_the_times(dry, outer):
    """v̈ is the equation of motion's derivative, with the slope of the line that t is on."""
    pendulum = Pendulum(4.0, 0.2, SampledTorque(KNOTS, TORQUES), dry=dry)
    t, inner = 7.7, jax.jacrev

    def moved(t):
        run = simulate(pendulum, t, 0.3, 0.4)
        return run.v, run.theta

    (v, theta), first, second = moved(t), inner(moved)(t)[0], outer(inner(moved))(t)[0]
    line = np.searchsorted(KNOTS, t) - 1
    slope = np.diff(TORQUES)[line] / np.diff(KNOTS)[line]
    true = slope - 0.2 * first - 4 * jnp.cos(theta) * v
    np.testing.assert_allclose(second, true, rtol=1e-13)


STARTS = [
    (4.0, 0.0, 0.0, 0.05, 2.5, 0.3),
    (1.5, 0.05, -0.2, 0.03, 1.0, -0.4),
    (2.0, 1e-3, 0.04, 0.05, -2.0, 4.0),
    (1.0, 3.0, 0.1, 0.05, -1.2, 2.0),
]


@pytest.mark.parametrize(
    "scene", [*STARTS[:2], *(pytest.param(x, marks=pytest.mark.full) for x in STARTS[2:])]
)
def test_where_it_sticks(scene):
    def stop(x):
        epsilon, beta, tau, dry, theta0, v0 = x
        end = settle(Pendulum(epsilon, beta, tau, dry), v0, theta0)
        return jnp.stack([end.theta, end.time]), end

    x = jnp.array(scene)
    (slopes, of_time), end = jax.jit(jax.jacrev(stop, has_aux=True))(x)
    until = [100.0 if scene[1] > 1 else float(end.time) + 1]
    rows, turns, held = references.trajectory(**scene_of(scene), ts=until)
    assert abs(float(end.theta) - float(rows[0][0])) < 1e-11
    true = np.array(references.slopes(NAMES, scene_of(scene), until))[:, 0, 0]
    np.testing.assert_allclose(slopes, true, rtol=0, atol=1e-9 * (1 + np.abs(true).max()))
    epsilon, _, tau, dry, *_ = scene
    assert abs(epsilon * np.sin(end.theta) - tau) <= dry * (1 + 1e-12)
    assert end.well == round((float(end.theta) - np.arcsin(tau / epsilon)) / (2 * np.pi))
    if held:
        np.testing.assert_allclose(end.time, turns[-1][0], rtol=0, atol=1e-9)
        h = 1e-9
        ends = [
            references.trajectory(**scene_of(scene) | {"dry": dry + x}, ts=until)[1][-1][0]
            for x in (h, -h)
        ]
        np.testing.assert_allclose(of_time[3], (ends[0] - ends[1]) / (2 * h), rtol=1e-4)


def test_mirrored_running_and_lost():
    one = settle(Pendulum(1.0, 0.1, 0.1, 0.03), 3.0, 0.4)
    other = settle(Pendulum(1.0, 0.1, -0.1, 0.03), -3.0, -0.4)
    assert one.theta == -other.theta
    assert one.well == -other.well
    running = settle(Pendulum(1.0, 0.1, np.array([0.5, -0.5]), 0.2), np.array([3.0, -3.0]))
    assert running.running.tolist() == [1, -1]
    assert np.isnan(running.theta).all()
    # Without friction after all: caught by the damping, or never.
    caught = jax.jit(lambda c: settle(Pendulum(1.0, 0.1, 0.3, c), 0.5, throw=False).theta)(0.0)
    np.testing.assert_allclose(caught, np.arcsin(0.3), rtol=1e-12)
    lost = jax.jit(lambda c: settle(Pendulum(1.0, dry=c), 0.5, throw=False, max_steps=50).result)
    assert lost(0.0) == Result.unsettled
    # Bad lanes are alone.
    found = jax.vmap(lambda c: settle(Pendulum(1.0, 0.1, None, c), 0.5, throw=False))(
        jnp.array([0.1, -0.1, jnp.nan])
    )
    assert (found.result == Result.successful).tolist() == [True, False, False]
    assert np.isfinite(found.theta).tolist() == [True, False, False]


def test_lanes():
    dry = jnp.array([0.1, -0.1, 0.02])
    run = jax.vmap(lambda c: simulate(Pendulum(1.0, dry=c), TS, 0.5, 2.0, throw=False))(dry)
    assert np.isfinite(run.theta).all(1).tolist() == [True, False, True]
    alone = simulate(Pendulum(1.0, dry=0.02), TS, 0.5, 2.0)
    np.testing.assert_allclose(run.theta[2], alone.theta, rtol=0, atol=1e-13)
    side = simulate(Pendulum(1.0, dry=np.array([0.1, 0.02])), TS, 0.5, 2.0)
    np.testing.assert_allclose(side.theta[1], alone.theta, rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Pendulum(1.0, dry=-0.1), "`dry` must be zero or positive, but got -0.1"),
        (lambda: Pendulum.from_si(1.0, dry=0.1), "`mass` must be given"),
        (lambda: simulate(Pendulum(1.0, dry=0.1), -TS, 1.0), "must be `t0` or later"),
        (
            lambda: simulate(Pendulum(1.0, dry=0.1), TS, 1.0, solver=diffrax.Dopri8()),
            "without dry friction",
        ),
        (lambda: simulate(Pendulum(1.0, None, jnp.sin, 0.1), TS, 1.0), "SampledTorque"),
        (lambda: period(Pendulum(1.0, dry=0.1), 1.0), "neither friction nor torque"),
        (lambda: fixed_points(Pendulum(1.0, dry=0.1)), "without dry friction"),
        (lambda: mean_velocity(Pendulum(1.0, 0.1, 0.5, 0.1)), "without dry friction"),
        (lambda: SampledTorque(KNOTS, TORQUES[:-1]), "must have one axis"),
        (lambda: SampledTorque(-KNOTS, TORQUES), "`ts` must increase"),
        (lambda: SampledTorque(KNOTS, TORQUES, -1.0), "`inertia` must be positive"),
        (lambda: SampledTorque(KNOTS, TORQUES * np.nan), "`torque` must be finite"),
        (
            lambda: simulate(Pendulum(1.0, 0.1, SampledTorque(KNOTS, TORQUES)), TS, 1.0),
            "within the times of the torque, 0 to 30",
        ),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_torque_is_unknown_outside_its_samples():
    tau = SampledTorque(KNOTS, TORQUES, 2.0, 0.5)
    assert np.isnan(tau(np.array([-0.1, 30.1]))).all()
    np.testing.assert_allclose(tau(KNOTS), (TORQUES + 0.5) / 2, rtol=1e-15)
    late = jax.jit(lambda ts: simulate(Pendulum(1.0, 0.1, tau), ts, 1.0, throw=False))(TS)
    assert np.isfinite(late.theta).tolist() == (TS <= 30).tolist()
    assert late.result == Result.solver_failed


FIT_TS = np.linspace(0.0, 12.0, 300)


@pytest.mark.full
def test_fit_of_both_frictions():
    """From 30 % off, to rounding; and the motion at rest at the end among the data."""
    run = simulate(Pendulum(40.0, 0.15, None, 1.3), FIT_TS, 1.0, 1.7)
    assert run.v[-1] == 0
    fit = fit_trajectory(FIT_TS, run.theta, Pendulum(50.0, 0.2, None, 0.9))
    found = [fit.model.epsilon, fit.model.beta, fit.model.dry, fit.v0, fit.theta0]
    np.testing.assert_allclose(found, [40.0, 0.15, 1.3, 1.0, 1.7], rtol=1e-8)
    assert list(fit.errors) == ["epsilon", "beta", "dry", "v0", "theta0"]
    assert fit.result == Result.successful


@pytest.mark.full  # two fits; the one of both frictions is there for every change
def test_fit_of_dry_friction_alone_and_of_none():
    rng = np.random.default_rng(1)
    noise = 0.01 * rng.normal(size=FIT_TS.size)
    run = simulate(Pendulum(40.0, None, None, 0.8), FIT_TS, 1.0, 1.7)
    fit = fit_trajectory(FIT_TS, run.theta + noise, Pendulum(50.0, dry=0.0))
    assert fit.result == Result.successful
    assert abs(fit.model.dry - 0.8) < 4 * fit.errors["dry"] < 0.1
    run = simulate(Pendulum(40.0, 0.15), FIT_TS, 1.0, 1.7)
    fit = fit_trajectory(FIT_TS, run.theta + noise, Pendulum(50.0, 0.1, dry=0.5))
    assert 0 <= fit.model.dry < 4 * fit.errors["dry"]


@pytest.mark.full  # compiles long
def test_fit_of_inertia_and_bias():
    ts = np.linspace(0.0, 12.0, 400)
    torque = 1.5 * np.sin(2.1 * ts) + 0.8 * np.sin(5.3 * ts)
    true = Pendulum(16.0, 0.5, SampledTorque(ts, torque, 0.06, -0.07), 2.0)
    run = simulate(true, ts, 0.0, 0.3)
    guess = Pendulum(18.0, 0.4, SampledTorque(ts, torque, 0.07, 0.0), 1.5)
    fit = fit_trajectory(ts, run.theta, guess, v0=0.0, theta0=0.3)
    model = fit.model
    found = [model.epsilon, model.beta, model.dry, model.tau.inertia, model.tau.bias]
    np.testing.assert_allclose(found, [16.0, 0.5, 2.0, 0.06, -0.07], rtol=1e-7)
    assert {"inertia", "bias"} <= set(fit.errors)


@pytest.mark.parametrize(
    ("name", "first"), [pytest.param("45", 0.129, marks=pytest.mark.full), ("135", 0.232)]
)
def test_benard(shared, name, first):
    """Each by itself: ε to 0.3 % of the other's, residuals under a degree, misfit said."""
    path = shared / "data" / "pendulum" / f"benard_free_swing_{name}deg.csv"
    t, degrees = np.loadtxt(path, delimiter=",", skiprows=1).T
    keep = t >= first
    guess = Pendulum(110.0, 0.1, dry=1.0)
    fit = fit_trajectory(t[keep], np.radians(degrees[keep]), guess, offset=0.0)
    assert abs(fit.model.epsilon / 120.29 - 1) < 1.5e-3
    assert np.degrees(np.std(fit.residuals)) < 1
    assert fit.runs < -10
    if name == "45":
        assert 1.9 < fit.model.dry < 2.2
        assert abs(np.degrees(settle(fit.model, fit.v0, fit.theta0).theta + fit.offset)) < 1
