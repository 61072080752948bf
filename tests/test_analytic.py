"""Torques that are functions of time, by their own series: against 30 digits."""

from functools import partial

import damped_references as references
import diffrax as dfx
import equinox as eqx
import flint
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, SampledTorque, fit_trajectory, simulate
from pendax.taylor import order_for


def precisely(tau):
    """The same function of Arb's series."""

    class Arb:
        sin = staticmethod(lambda x: x.sin())
        cos = staticmethod(lambda x: x.cos())
        exp = staticmethod(lambda x: x.exp())

    return lambda t: tau(Arb, t)


TORQUES = {
    "a wave": lambda np, t: 0.875 + 0.375 * np.cos(0.625 * t),
    "a beat": lambda np, t: np.sin(1.5 * t) * np.sin(0.25 * t + 0.5) / 2,
    "its square": lambda np, t: np.sin(2 * t) ** 2 - 0.5,
    "fading": lambda np, t: 2 * np.exp(-0.25 * t) * np.cos(t) - 0.125,
    "from nothing": lambda np, t: 0.125 * t * np.sin(t),
    "a cubic": lambda np, t: 0.015625 * t**3 - 0.25 * t**2 + t,
    "a ramp": lambda np, t: 0.125 * t,
    "a square": lambda np, t: 0.0625 * t * t,
    "slow and fast": lambda np, t: np.sin(0.0078125 * t) + 0.0625 * np.cos(4.0 * t),
    "vanishing to the fifth": lambda np, t: (np.sin(t) - t + t**3 / 6) / 64,
}
# From rest at the bottom and at 90°, where powers of t are left out; at the top; a swing, a turn.
STARTS = ((0.0, 0.0), (np.pi / 2, 0.0), (-np.pi / 2, 0.0), (np.pi, 0.0), (0.25, 1.0), (0.0, 4.0))
TS = np.array([0.5, 2.0, 6.0, 12.0])


# In float32 some of them: the references are other ones, and take most of the time.
CASES = [(name, "float64") for name in TORQUES]
CASES += [pytest.param(n, "float32", marks=pytest.mark.full) for n in ("a wave", "a cubic")]
CASES += [("fading", "float32")]


@pytest.mark.parametrize(("name", "dtype"), CASES, indirect=["dtype"])
def test_against_thirty_digits(name, dtype):
    written = TORQUES[name]
    starts = np.array(STARTS, dtype)
    rtols = (1e-13, 1e-9, 1e-5) if dtype == np.float64 else (1e-6,)
    for beta in (None, 0.125):
        scene = Pendulum(jnp.ones((), dtype), beta, lambda t: written(jnp, t))
        true = np.array([
            references.trajectory(
                1.0, beta or 0.0, precisely(written), float(theta), float(v), TS, ("theta0", "v0")
            )
            for theta, v in starts
        ])  # fmt: skip
        true, grown = true[..., :2], np.abs(true[..., 2:]).max((1, 2))
        scale = (1 + np.abs(true).max((1, 2))) * (1 + grown)
        for rtol in rtols:
            run = simulate(scene, jnp.asarray(TS, dtype), *starts.T[::-1], rtol=rtol)
            assert run.method == "Taylor series"
            error = np.abs(np.stack([run.theta, run.v], -1) - true).max((1, 2))
            assert (error <= 50 * rtol * scale).all(), (beta, rtol, error / rtol / scale)


def every_eighth(np, t):
    """1 + Σ (4t)^(8n)/(8n)!, n > 0, as the sum over eighth roots of 1."""
    t, part = 4 * t, 0.5**0.5
    turning = (np.exp(part * t) + np.exp(-part * t)) * np.cos(part * t)
    return 1 + ((np.exp(t) + np.exp(-t)) / 8 + np.cos(t) / 4 + turning / 4 - 1)


@pytest.mark.parametrize(
    "written",
    [lambda np, t: 1 + 64 * t * t, lambda np, t: 1 + 64 * t**3, every_eighth],
    ids=["square", "cubic", "every eighth"],
)
@pytest.mark.parametrize(
    "order",
    [10, 13, 16, 20, *(pytest.param(n, marks=pytest.mark.full) for n in (12, 14, 15, 17, 18))],
)
def test_a_rest_that_shows_little(written, order):
    """Balanced at 90°, where several of the last terms vanish together; of every order."""
    rtol = float(np.exp(2 * (4 - order)))
    assert order_for(rtol, rtol) == order
    ts = np.array([1.5])
    (true,) = [references.trajectory(1.0, 0.0, precisely(written), np.pi / 2, 0.0, ts)]
    scene = Pendulum(1.0, None, lambda t: written(jnp, t))
    run = simulate(scene, jnp.asarray(ts), 0.0, np.pi / 2, rtol=rtol)
    assert run.method == "Taylor series"
    error = np.abs(np.stack([run.theta, run.v], -1) - np.array(true))
    assert (error <= 50 * rtol * (1 + np.abs(true))).all(), error / rtol


def test_backwards():
    """A motion that is over is the one that began there."""
    scene = Pendulum(1.0, 0.125, lambda t: 0.875 + 0.375 * jnp.cos(0.625 * t))
    end = simulate(scene, 3.0, 1.0, 0.25, t0=-2.0)
    back = simulate(scene, jnp.array([1.0, -2.0]), end.v, end.theta, t0=3.0)
    assert back.method == "Taylor series"
    np.testing.assert_allclose([back.theta[1], back.v[1]], [0.25, 1.0], atol=1e-13)


AT = {"mean": 0.875, "size": 0.375, "rate": 0.625, "phase": 0.25, "epsilon": 1.0, "v0": 1.0}


def angle(x, t=12.0, t0=0.0):
    def torque(t):
        return x["mean"] + x["size"] * jnp.sin(x["rate"] * t + x["phase"])

    return simulate(Pendulum(x["epsilon"], 0.125, torque), t, x["v0"], 0.25, t0=t0).theta


def true_slopes(t):
    def inner(t):
        return AT["rate"] * t + AT["phase"]

    by = {
        "mean": lambda t: 1 + 0 * t,
        "size": lambda t: inner(t).sin(),
        "rate": lambda t: AT["size"] * t * inner(t).cos(),
        "phase": lambda t: AT["size"] * inner(t).cos(),
    }
    (row,) = references.trajectory(
        1.0, 0.125, lambda t: AT["mean"] + AT["size"] * inner(t).sin(), 0.25, AT["v0"], [t],
        [by.get(name, name) for name in AT],
    )  # fmt: skip
    return np.array(row[2::2])


@pytest.mark.parametrize("mode", [jax.grad, jax.jacfwd, lambda f: jax.jit(jax.grad(f))])
def test_gradients(mode):
    """Of numbers that the function was written with, though it was not said which."""
    got = mode(angle)(AT)
    true = true_slopes(12.0)
    np.testing.assert_allclose([got[name] for name in AT], true, rtol=1e-12, atol=1e-12)


def test_second_derivatives_and_lanes():
    size = jnp.array([0.375, 0.5])
    slope = jax.jit(jax.grad(lambda size: angle(AT | {"size": size})))  # to be compiled once
    lanes = jax.vmap(slope)(size)
    np.testing.assert_allclose(lanes, [slope(x) for x in size], rtol=1e-12)
    for mode in (jax.grad, jax.jacfwd):
        h = 1e-4
        difference = (slope(0.375 + h) - slope(0.375 - h)) / (2 * h)
        np.testing.assert_allclose(mode(slope)(0.375), difference, rtol=1e-6)


def test_derivatives_in_the_times():
    """In t that of θ is v, that of v the force; a later start of all is another phase."""
    x, t = AT, 12.0

    def shifted(by):
        return angle(x, t + by, by)

    force = x["mean"] + x["size"] * np.sin(x["rate"] * t + x["phase"])
    scene = Pendulum(1.0, 0.125, lambda t: x["mean"] + x["size"] * jnp.sin(0.625 * t + 0.25))
    run = simulate(scene, t, x["v0"], 0.25)
    slope, bend = jax.grad(partial(angle, x)), jax.grad(jax.grad(partial(angle, x)))
    np.testing.assert_allclose(slope(t), run.v, rtol=1e-13)
    np.testing.assert_allclose(bend(t), force - np.sin(run.theta) - 0.125 * run.v, rtol=1e-12)
    by_phase = true_slopes(t)[list(AT).index("phase")]
    np.testing.assert_allclose(jax.grad(shifted)(0.0), x["rate"] * by_phase, rtol=1e-11)


@pytest.mark.parametrize("sampled", [False, True])
def test_derivatives_in_the_start(sampled):
    """At a saved time that is t0, where no step is taken: by hand, from θ̇ and the equation."""
    if sampled:
        tau, value, slope = SampledTorque(jnp.array([-1.0, 1.0]), jnp.array([-0.5, 1.5])), 0.5, 1.0
    else:
        tau, value, slope = lambda t: 0.5 * jnp.cos(2 * t) + jnp.sin(t), 0.5, 1.0
    beta, theta0, v0 = 0.1, 0.2, 0.3

    def started(t0):
        run = simulate(Pendulum(1.0, beta, tau), 0.0, v0, theta0, t0=t0, rtol=1e-3)
        assert run.method == "Taylor series"
        return jnp.stack([run.theta, run.v])

    force = value - np.sin(theta0) - beta * v0
    jerk = slope - np.cos(theta0) * v0 - beta * force
    for mode in (jax.jacfwd, jax.jacrev):
        np.testing.assert_allclose(mode(started)(0.0), [-v0, -force], rtol=1e-14)
    if not sampled:  # it takes half a minute to compile
        second = jax.jit(jax.jacfwd(jax.jacrev(started)))(0.0)
        np.testing.assert_allclose(second, [force, jerk - 2 * slope], rtol=1e-13)


def test_the_function_decides():
    """What has kinks, poles, or is not seen from afar is left to diffrax, and right there too."""

    def method(tau, **options):
        return jax.eval_shape(
            lambda: simulate(Pendulum(1.0, 0.1, tau), 10.0, 1.0, **options)
        ).method

    rates = jnp.array([1.0, 2.0, 3.0])
    for tau in (
        jnp.sin,
        eqx.filter_jit(lambda t: jnp.sum(jnp.sin(rates * t + 1.0)) / 2),
        lambda t: jnp.dot(rates, jnp.cos(rates * t)),
        lambda t: 0.5 * jnp.where(rates[0] > 0, 1.0, 2.0) * jnp.cos(t - 1) ** 2,
        lambda t: jnp.asarray(0.5),
        Wave(jnp.array(0.5)),
    ):
        assert method(tau) == "Taylor series"
    for tau in (
        lambda t: jnp.where(t > 3, 1.0, 0.0),
        lambda t: jnp.abs(jnp.sin(t)),
        lambda t: jnp.exp(-((t - 5) ** 2)),
        lambda t: jnp.sin(t * t),
        lambda t: jnp.sin(jnp.sin(t)),
        lambda t: 1 / (1 + t * t),
        lambda t: 1e-3 * t**4,
        lambda t: jnp.interp(t, jnp.arange(3.0), jnp.arange(3.0)),
        lambda t: jnp.sin(t).astype(jnp.float32).astype(jnp.float64),
        jnp.tanh,
        jnp.floor,
    ):
        assert method(tau) == "Dopri8"
    assert method(jnp.sin, solver=dfx.Tsit5()) == "Tsit5"
    assert method(jnp.sin, dt0=0.1) == "Dopri8"


class Wave(eqx.Module):
    size: jax.Array

    def __call__(self, t):
        return self.size * jnp.sin(t)


def test_a_late_clock():
    """In float32, of a phase of 4e6 that is known exactly."""
    with jax.enable_x64(False):
        scene = Pendulum(1.0, 1.0, lambda t: 100.0 * jnp.sin(256.0 * t))
        ts = jnp.array([16388.0, 16400.0])
        run = simulate(scene, ts, 0.25, 0.5, t0=16384.0)
    # Time counts from there; what is over are whole turns but for a phase.
    phase = float((flint.arb(256 * 16384) / (2 * flint.arb.pi())).mid())
    phase = 2 * np.pi * (phase - np.round(phase))
    true = references.trajectory(
        1.0, 1.0, lambda t: 100 * (256 * t + phase).sin(), 0.5, 0.25, [4.0, 16.0]
    )
    np.testing.assert_allclose(np.stack([run.theta, run.v], -1), true, atol=2e-5)


class Power(eqx.Module):
    """An exponent that is an array is known where it can be seen, and hidden by `jit`."""

    power: jax.Array | int

    def __call__(self, t):
        return 0.5 * t**self.power


@pytest.mark.parametrize("power", [2, jnp.array(2)])
def test_a_function_that_is_another_under_jit(power):
    (true,) = references.trajectory(1.0, 0.125, lambda t: 0.5 * t * t, 0.0, 0.5, [3.0])
    scene = Pendulum(1.0, 0.125, Power(power))
    for run in (
        simulate(scene, 3.0, 0.5),
        jax.jit(lambda: simulate(scene, 3.0, 0.5))(),
        eqx.filter_jit(lambda scene: simulate(scene, 3.0, 0.5))(scene),
    ):
        np.testing.assert_allclose([run.theta, run.v], true, rtol=1e-9)


def test_what_is_soon_over():
    """Whose type would hold steps short to the end; where it can be seen."""
    scene = Pendulum(1.0, 0.1, lambda t: 0.5 * jnp.sin(t) + jnp.exp(-1e4 * t))
    run = simulate(scene, 20.0, 0.0)
    assert run.method == "Dopri8"
    near = simulate(scene, 0.01, 0.0)
    assert near.method == "Taylor series"
    rest = simulate(
        Pendulum(1.0, 0.1, lambda t: 0.5 * jnp.sin(t)), 20.0, near.v, near.theta, t0=0.01
    )
    np.testing.assert_allclose(run.theta, rest.theta, rtol=1e-9)


def test_a_function_of_no_numbers():
    """An empty sum, and what is no number at all."""
    none = jnp.zeros(0)
    scene = Pendulum(1.0, 0.1, lambda t: jnp.sum(none * jnp.sin(none * t)) + jnp.sin(t))
    run = simulate(scene, 3.0, 0.5)
    assert run.method == "Taylor series"
    np.testing.assert_allclose(
        run.theta, simulate(Pendulum(1.0, 0.1, jnp.sin), 3.0, 0.5).theta, rtol=1e-14
    )
    with pytest.raises(ValueError, match="one real number"):
        simulate(Pendulum(1.0, 0.1, lambda t: [jnp.sin(t)]), 3.0, 0.5)


@pytest.mark.full
def test_a_fit_under_a_wave():
    """A torque that is known and held, and what it moves."""
    true = Pendulum(1.5, 0.2, Wave(jnp.array(0.5)))
    ts = jnp.linspace(0.0, 20.0, 101)
    theta = simulate(true, ts, 0.5, 0.3).theta
    fit = fit_trajectory(ts, theta, Pendulum(1.3, 0.1, Wave(jnp.array(0.5))))
    np.testing.assert_allclose([fit.model.epsilon, fit.model.beta], [1.5, 0.2], rtol=1e-8)


def test_budgets():
    """A torque that comes late, or grows, is in the number of steps that are allowed."""
    late = Pendulum(1.0, None, lambda t: 2.0 * t)
    run = simulate(late, 60.0, 0.0)  # v = t² in the end
    assert jnp.isfinite(run.theta)
    strong = Pendulum(1.0, 0.1, lambda t: 1e4 * jnp.sin(jnp.pi * t))  # 0 at 16 equal steps
    assert jnp.isfinite(simulate(strong, 16.0, 0.0, rtol=1e-8).theta)
    wild = Pendulum(1.0, None, lambda t: jnp.exp(t))
    run = simulate(wild, 40.0, 0.0, throw=False, max_steps=50)
    assert jnp.isnan(run.theta)
