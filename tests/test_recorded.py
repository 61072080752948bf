"""Torques that are functions of time: what they hold is seen, at every call, and differentiated."""

import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pendax import Pendulum, condition, fit_trajectory, simulate
from pendax._recorded import recorded

TORQUES = {  # a τ(t) of each kind, by what it closes over, and its derivative by that
    "kink": (lambda a, t: a * abs(t - 2.0), lambda a, t: abs(t - 2.0)),
    "wave": (lambda a, t: jnp.cos(a * t), lambda a, t: -t * np.sin(a * t)),
    "decay": (lambda a, t: a * jnp.exp(-a * t), lambda a, t: (1 - a * t) * np.exp(-a * t)),
}


@pytest.mark.parametrize("kind", TORQUES)
@pytest.mark.parametrize("carried", [False, True])
def test_a_torque_with_a_parameter(kind, carried):
    """What a function closes over is seen, as what a `Partial` carries is."""
    torque, slope = TORQUES[kind]

    def last(a):
        tau = jax.tree_util.Partial(torque, a) if carried else lambda t: torque(a, t)
        return simulate(Pendulum(1.0, 0.2, tau), 6.0, 0.3).theta

    def by_scipy(t, y):
        bent = -0.2 * y[3] - np.cos(y[0]) * y[2] + slope(0.7, t)
        return y[1], -0.2 * y[1] - np.sin(y[0]) + float(torque(0.7, t)), y[3], bent

    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12, "max_step": 0.5}
    true = solve_ivp(by_scipy, (0, 6.0), [0, 0.3, 0, 0], **options).y[:, -1]
    value, first = jax.jit(jax.value_and_grad(last))(0.7)
    np.testing.assert_allclose([value, first], true[[0, 2]], rtol=1e-8)
    if not carried:
        one = jnp.arange(1, 3)[0]  # a whole number moves nothing

        def both(a):  # which is closed over and carried
            half = lambda b, t: torque(0.5 * (a + b), t) * one.astype(float)  # noqa: E731
            scene = Pendulum(1.0, 0.2, jax.tree_util.Partial(half, a))
            return simulate(scene, 6.0, 0.3).theta

        np.testing.assert_allclose(jax.grad(both)(0.7), true[2], rtol=1e-8)
        lane = jnp.array([0.7])
        np.testing.assert_allclose(jax.vmap(jax.jacfwd(last))(lane), true[2:3], rtol=1e-8)


def by_scipy(tau):
    def field(t, y):
        return y[1], tau(t) - 0.2 * y[1] - np.sin(y[0])

    return solve_ivp(field, (0, 6.0), [0, 0.3], "DOP853", rtol=1e-11, atol=1e-12).y[0, -1]


class Motor:
    def __init__(self, amplitude):
        self.amplitude = amplitude

    def torque(self, t):
        return self.amplitude * jnp.sin(0.9 * t)

    def lurch(self, t):
        return self.amplitude * jnp.tanh(t)


def in_a_list(value):
    held = [value]
    return lambda t: held[0] * jnp.sin(0.9 * t), lambda x: held.__setitem__(0, x)


def in_numpys_array(value):
    held = np.array([value])
    return lambda t: held[0] * jnp.sin(0.9 * t), lambda x: held.__setitem__(0, x)


def in_an_attribute(value):
    motor = Motor(value)
    return motor.torque, lambda x: setattr(motor, "amplitude", x)


def in_an_array_of_jax(value):
    motor = Motor(jnp.asarray(value))
    return motor.torque, lambda x: setattr(motor, "amplitude", jnp.asarray(x))


@pytest.mark.parametrize("held", [in_a_list, in_numpys_array, in_an_attribute, in_an_array_of_jax])
def test_what_has_changed_since_the_last_call(held):
    """No program is kept for the function that has its old numbers."""
    tau, change = held(0.3)
    scene = Pendulum(1.0, 0.2, tau)
    for value in (0.3, 0.8, 0.3):
        change(value)
        true = by_scipy(lambda t, a=value: a * np.sin(0.9 * t))
        np.testing.assert_allclose(simulate(scene, 6.0, 0.3).theta, true, rtol=1e-9)


def test_what_has_changed_since_kappa():
    tau, change = in_a_list(0.3)
    before = condition(Pendulum(1.0, 0.2, tau), jnp.array([3.0, 6.0]), 0.3)
    change(1.8)
    after = condition(Pendulum(1.0, 0.2, tau), jnp.array([3.0, 6.0]), 0.3)
    assert (abs(after - before) > 1e-3).all()


@pytest.mark.full
def test_what_has_changed_since_the_last_fit():
    ts = np.linspace(0.0, 12.0, 121)
    motor = Motor(0.3)
    guess = Pendulum(1.1, 0.1, motor.torque)
    for value in (0.3, 0.5):
        motor.amplitude = value
        theta = simulate(Pendulum(1.0, 0.2, motor.torque), ts, 0.3).theta
        fit = fit_trajectory(ts, theta, guess)
        np.testing.assert_allclose([fit.model.epsilon, fit.model.beta], [1.0, 0.2], rtol=1e-8)
        assert fit.model.tau(2.0) == motor.torque(2.0)  # the function as it was given


def test_by_diffrax_too():
    motor = Motor(0.3)
    scene = Pendulum(1.0, 0.2, motor.lurch)
    for value in (0.3, 0.8):
        motor.amplitude = value
        run, true = simulate(scene, 6.0, 0.3), by_scipy(lambda t, a=value: a * np.tanh(t))
        assert run.method == "Dopri8"
        np.testing.assert_allclose(run.theta, true, rtol=1e-9)


def wave(amplitude, mean=0.0):
    return lambda t: mean + amplitude * jnp.cos(0.7 * t)


@jax.custom_jvp
def held_fixed(x):
    return x


@held_fixed.defjvp
def _(primals, tangents):
    (x,), (dx,) = primals, tangents
    return x, 0 * dx


def alike(one, other, dtype=jnp.float64):
    one, other = (recorded(tau, dtype).operations for tau in (one, other))
    assert (one == other) == (other == one)
    assert one != other or hash(one) == hash(other)
    return one == other


def test_functions_that_read_alike_share_a_program():
    assert alike(wave(0.5), wave(0.5))
    assert alike(wave(0.5), lambda t: 0.0 + 0.5 * jnp.cos(0.7 * t))
    assert alike(wave(jnp.array([0.5])[0]), wave(jnp.array([0.5])[0]))
    for function in (
        jnp.mod,
        jnp.hypot,
        lambda t, a: jnp.interp(a, jnp.arange(2.0), t * jnp.ones(2)),
    ):
        one, other = (lambda t, f=function: f(t, jnp.asarray(0.5)) for _ in range(2))
        assert alike(one, other)
    twice = lambda t: held_fixed(t) * 0.5  # noqa: E731
    assert alike(twice, twice)  # with a rule that JAX doesn't show
    assert recorded(wave(0.5), jnp.float64)(jnp.asarray(2.0)) == wave(0.5)(2.0)


def test_functions_that_read_differently_do_not():
    half = 0.5
    assert not alike(wave(half), wave(np.nextafter(half, 1)))
    assert not alike(wave(half, 0.0), wave(half, -0.0))
    assert not alike(wave(half), lambda t: half * jnp.sin(0.7 * t))
    assert not alike(wave(half), lambda t: jnp.cos(0.7 * t) * half)
    assert not alike(lambda t: t**2, lambda t: t**3)
    assert not alike(lambda t: half * t, lambda t: jax.lax.stop_gradient(half) * t)
    assert not alike(lambda t: half * t, lambda t: jax.lax.stop_gradient(half * t))
    assert not alike(lambda t: half * t, lambda t: half * held_fixed(t))
    assert not alike(lambda t: jnp.where(t > 1, t, half), lambda t: jnp.where(t > 2, t, half))
    branches = [lambda t: t, lambda t: half * t]
    there, back = (
        lambda t, order=order: jax.lax.cond(t > 1, *order, t)
        for order in (branches, branches[::-1])
    )
    assert not alike(there, back)
    tables = np.arange(4.0), np.arange(4.0) ** 2
    one, other = (recorded(lambda t, x=x: jnp.interp(t, tables[0], x), float) for x in tables)
    assert (one(jnp.asarray(2.5)), other(jnp.asarray(2.5))) == (2.5, 6.5)
    assert recorded(wave(half), jnp.float32).operations != recorded(wave(half), float).operations


def test_what_jax_does_not_show():
    """Rules of derivatives and calls of Python: by their function and the numbers that it holds."""
    held = [1.0]

    @jax.custom_jvp
    def scaled(x):
        return x

    @scaled.defjvp
    def _(primals, tangents):
        return primals[0], held[0] * tangents[0]

    def by_python(t):
        factor = held[0]
        shape = jax.ShapeDtypeStruct((), t.dtype)
        return jax.pure_callback(lambda t: factor * t, shape, t, vmap_method="sequential")

    for tau in (scaled, by_python, jax.jit(scaled)):
        held[0] = 1.0
        before, again = (recorded(tau, jnp.float64).operations for _ in range(2))
        assert before == again
        held[0] = 2.0
        assert recorded(tau, jnp.float64).operations != before


@pytest.mark.parametrize("held", [
    [np.sin, np.cos],
    [lambda t: np.tanh(t), lambda t: np.cos(t)],
    ["sin", "cos"],
    [{"amplitude": 0.3, "rate": 2.0}, {"rate": 0.3, "amplitude": 2.0}],
    [[[0.3], [1.0, 2.0]], [[0.3, 1.0], [2.0]]],
])  # fmt: skip
def test_what_else_a_call_of_python_holds(held):
    """Functions, words, and how its numbers are put together."""

    def by_python(t):
        one = held[0]
        shape = jax.ShapeDtypeStruct((), t.dtype)
        return jax.pure_callback(lambda t: (one, t)[1], shape, t, vmap_method="sequential")

    before, again = (recorded(by_python, jnp.float64).operations for _ in range(2))
    assert before == again
    held.reverse()
    assert recorded(by_python, jnp.float64).operations != before


def test_a_torque_that_prints(capfd):
    def printing(t):
        jax.debug.print("at {}", t)
        return 0.3 * jnp.sin(t)

    run = simulate(Pendulum(1.0, 0.2, printing), 0.1, 0.3)
    silent = simulate(Pendulum(1.0, 0.2, lambda t: 0.3 * jnp.sin(t)), 0.1, 0.3)
    jax.effects_barrier()
    assert "at 0.1" in capfd.readouterr().out
    np.testing.assert_allclose(run.theta, silent.theta, rtol=1e-9)


def test_the_sign_of_nan():
    assert alike(lambda t: jnp.copysign(jnp.nan, t), lambda t: jnp.copysign(jnp.nan, t))
    held = [math.nan]
    tau = lambda t: t * held[0]  # noqa: E731
    before = recorded(tau, jnp.float64).operations
    held[0] = -math.nan
    assert recorded(tau, jnp.float64).operations != before


def test_what_no_equality_is_made_for():
    """A key, a context, an object that can't be hashed: neither an error nor an old answer."""
    keys = jax.random.key(1), jax.random.key(2)
    one, other = (jax.jit(lambda t, key=key: t * jax.random.normal(key)) for key in keys)
    assert alike(one, one)
    assert not alike(one, other)

    def random(t, parted):
        with jax.threefry_partitionable(parted):
            return t * jax.random.normal(jax.random.PRNGKey(3), (5,))[1]

    assert not alike(lambda t: random(t, True), lambda t: random(t, False))

    class Answers:
        __hash__ = None

        def __eq__(self, other):
            return np.ones(2) == np.zeros(2)

        def __call__(self, t):
            return jax.nn.relu(t)

    tau = jax.tree_util.Partial(lambda answers, t: answers(t), Answers())
    assert alike(tau, tau)
    assert not alike(tau, jax.tree_util.Partial(tau.func, Answers()))


def by_parts(x, t):
    return x.real * jnp.cos(t) - x.imag * jnp.sin(t)


def rotating(x, t):
    return jnp.real(x * jnp.exp(jax.lax.complex(0 * t, t)))


def under_a_phasor(p, torque):
    x = p[0] * jnp.exp(jax.lax.complex(0 * p[1], p[1]))
    return simulate(Pendulum(1.0, 0.2, lambda t: torque(x, t)), 6.0, 0.3).theta


@pytest.mark.parametrize(("torque", "mode"), [(by_parts, jax.jacfwd), (rotating, jax.grad)])
def test_phasors(torque, mode, standard_promotion):
    """Complex numbers inside, a real torque: derivatives by their real and imaginary parts."""

    def moved(size, phase):
        return by_scipy(lambda t: (0.8 + size) * np.cos(t + 0.3 + phase))

    h = 1e-4
    true = [moved(h, 0) - moved(-h, 0), moved(0, h) - moved(0, -h)] / np.array(2 * h)
    slope = jax.jit(mode(lambda p: under_a_phasor(p, torque)))(jnp.array([0.8, 0.3]))
    np.testing.assert_allclose(slope, true, rtol=1e-6)


@pytest.mark.full
def test_second_derivatives_by_phasors(standard_promotion):
    def plain(p):
        return simulate(Pendulum(1.0, 0.2, lambda t: p[0] * jnp.cos(t + p[1])), 6.0, 0.3).theta

    both = plain, lambda p: under_a_phasor(p, by_parts)
    hessians = [jax.jit(jax.hessian(f))(jnp.array([0.8, 0.3])) for f in both]
    np.testing.assert_allclose(*hessians, rtol=1e-7)


def test_numbers_of_another_precision(standard_promotion):
    def torque(a, t):
        return a * jnp.sin(t)

    def last(a, scalar, carried):
        tau = jax.tree_util.Partial(torque, a) if carried else lambda t: torque(a, t)
        return simulate(Pendulum(scalar(1.0), scalar(0.2), tau), scalar(6.0), scalar(0.3)).theta

    true = (by_scipy(lambda t: 0.8001 * np.sin(t)) - by_scipy(lambda t: 0.7999 * np.sin(t))) / 2e-4
    for inside, outside in ((jnp.float32, jnp.float64), (jnp.float64, jnp.float32)):
        slope = jax.grad(last)(inside(0.8), outside, inside == jnp.float32)
        assert slope.dtype == inside
        np.testing.assert_allclose(slope, true, rtol=2e-5)


def test_torques_that_are_no_numbers():
    for tau, what in (
        (lambda t: jnp.array([1.0, 2.0]) * t, r"got shape \(2,\). Lanes"),
        (lambda t: jax.lax.complex(t, t), "one real number, but got complex128"),
        (lambda t: None, "one real number, but got None"),
        (lambda t: "1", "one real number, but got a str"),
        (lambda t: (t, t), "one real number, but got a tuple"),
        (np.sin, "that JAX can trace"),
        (lambda t: 1.0 if t > 2 else 0.0, "that JAX can trace"),
    ):
        with pytest.raises(ValueError, match=what):
            simulate(Pendulum(1.0, 0.2, tau), 6.0, 0.3)
