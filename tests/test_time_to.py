"""The time to an angle is the inverse of the motion, against Arb."""

import jax
import jax.numpy as jnp
import numpy as np
import pendulum_references as references
import pytest
from flint import arb, ctx

from pendax import Pendulum, amplitude, period, time_to, velocity


@pytest.mark.parametrize("kind", ["swing", "rotation", "near", "rest", "small"])
def test_angle_is_reached_then_and_not_before(kind, dtype):
    rng = np.random.default_rng(8)
    size = 60
    epsilon = 10 ** rng.uniform(-3, 3, size)
    v0, theta0 = rng.uniform(-1.9, 1.9, size), rng.uniform(-30, 30, size)
    if kind == "rotation":
        v0 = rng.choice([-1, 1], size) * rng.uniform(2.1, 9, size)
    if kind == "near":
        last = -15 if dtype == np.float64 else -6
        epsilon, theta0 = np.ones(size), np.zeros(size)
        v0 = 2 + rng.choice([-1, 1], size) * 10 ** rng.uniform(last, -1, size)
    if kind == "rest":
        v0 = np.zeros(size)
    if kind == "small":
        v0, theta0 = 1e-9 * v0, 1e-9 * theta0
    v0 = v0 * np.sqrt(epsilon)
    row = [jnp.asarray(x, dtype) for x in (epsilon, v0, theta0)]
    pendulum = Pendulum(row[0])
    span = np.minimum(np.asarray(period(pendulum, *row[1:])), 30 / np.sqrt(epsilon))
    t = rng.uniform(0, 1, size) * span
    eps = float(jnp.finfo(dtype).eps)
    with ctx.workprec(300):
        for i in range(size):
            at = [arb(float(x[i])) for x in row]
            theta = dtype.type(float(references.motion(at[0], arb(float(t[i])), *at[1:])[0]))
            found = time_to(Pendulum(row[0][i]), jnp.asarray(theta), row[1][i], row[2][i])
            assert 0 <= float(found) <= float(t[i]) * (1 + 1e-4) + 1e-2 / np.sqrt(epsilon[i])
            there, v = references.motion(at[0], arb(float(found)), *at[1:])
            scale = abs(float(theta)) + abs(float(row[2][i])) + abs(float(v) * float(found))
            # At a turning point an angle is known to the square of the time.
            force = float(row[0][i]) * abs(np.sin(float(theta)))
            scale += force * (eps / force if force else 0)
            assert abs(float(there) - float(theta)) <= 32 * eps * scale


def test_turning_points_and_turns():
    pendulum = Pendulum(2.0)
    quarter = period(pendulum, 1.2) / 4
    top = amplitude(pendulum, 1.2)
    np.testing.assert_allclose(time_to(pendulum, top, 1.2), quarter, rtol=1e-7)
    np.testing.assert_allclose(time_to(pendulum, -top, 1.2), 3 * quarter, rtol=1e-7)
    np.testing.assert_allclose(time_to(pendulum, 0.0, 0.0, top), quarter, rtol=1e-14)
    turns = 2 * np.pi * jnp.arange(4.0)
    np.testing.assert_allclose(
        time_to(pendulum, -turns, -5.0), period(pendulum, 5.0) * jnp.arange(4.0), rtol=1e-14
    )


def test_never_is_nan_there_alone():
    theta = jnp.array([0.5, 3.0, 2 * np.pi, 0.0])
    never = jnp.isnan(time_to(Pendulum(), theta, 1.0))
    assert never.tolist() == [False, True, True, False]
    assert jnp.isnan(time_to(Pendulum(), jnp.array([-0.1, 4.0]), 3.0)).tolist() == [True, False]
    assert jnp.isnan(time_to(Pendulum(), jnp.array([3.1, 4.0, -1.0]), 2.0)).tolist() == [0, 1, 1]
    assert jnp.isnan(time_to(Pendulum(), 0.1, 0.0))
    assert time_to(Pendulum(), 0.0, 0.0) == 0
    with pytest.raises(ValueError, match="neither friction nor torque"):
        time_to(Pendulum(1.0, 0.1), 0.1, 1.0)


def test_derivatives():
    """∂t/∂θ = 1/v, and the rest by differences of Arb's F."""

    def t(x):
        return time_to(Pendulum(x[0]), x[1], x[2], x[3])

    x = jnp.array([1.3, 0.5, 1.0, -0.2])
    by_theta = jax.grad(t)(x)[1]
    e = 0.5 + 1.3 * (1 - np.cos(0.2))
    np.testing.assert_allclose(by_theta, 1 / velocity(Pendulum(1.3), 0.5, e), rtol=1e-14)
    for mode in (jax.grad, jax.jacfwd):
        got = mode(t)(x)
        for i in range(4):
            h = 1e-5
            step = np.eye(4)[i] * h
            difference = (t(x + step) - t(x - step)) / (2 * h)
            np.testing.assert_allclose(got[i], difference, rtol=1e-8)
    assert jnp.isfinite(jax.hessian(t)(x)).all()
