"""Damped and driven trajectories and their derivatives, against the tables."""

import csv

import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, Result, simulate


def rows_of(shared, name):
    with (shared / "truth" / name).open() as file:
        return list(csv.DictReader(file))


def test_trajectories_against_the_table(shared):
    rows = rows_of(shared, "dissipative_trajectories.csv")
    scenes = {}
    for row in rows:
        scenes.setdefault(tuple(float(row[x]) for x in ("v0", "beta", "tau")), []).append(row)
    assert len(rows) > 200
    for (v0, beta, tau), points in scenes.items():
        ts = jnp.asarray([float(row["t"]) for row in points])
        run = simulate(Pendulum(1.0, beta, tau), ts, v0)
        true = np.array([[float(row[x]) for row in points] for x in ("theta", "v")])
        # 2e-12 of tolerance, grown by at most some 1e4 where a start grazes a saddle.
        assert np.abs(run.theta - true[0]).max() < 1e-8
        assert np.abs(run.v - true[1]).max() < 1e-8


def test_gradients_against_the_table(shared):
    names = ("theta0", "v0", "beta", "tau")

    def state(x, t):
        run = simulate(Pendulum(1.0, x[2], x[3]), t, x[1], x[0])
        return jnp.stack([run.theta, run.v])

    for row in rows_of(shared, "dissipative_gradients.csv"):
        x = jnp.asarray([0.0, *(float(row[name]) for name in names[1:])])
        true = np.array([[float(row[f"d{y}_d{name}"]) for name in names] for y in ("theta", "v")])
        for mode in (jax.jacfwd, jax.jacrev):
            got = mode(state)(x, float(row["t"]))
            assert np.abs(got - true).max() < 1e-8 * np.abs(true).max()


def scene(x, ts, **options):
    """β = 0 and τ = 0 written down, so that a solver is used for what has a closed form."""
    return simulate(Pendulum(x[0], x[1], x[2]), ts, x[3], x[4], **options).theta


X = jnp.array([1.3, 0.0, 0.0, 1.9, 0.3])


@pytest.mark.full  # compiles for a minute; modes and orders of Taylor are in test_taylor.py
def test_every_mode_and_order():
    """Against the closed form's in ε, v0, θ0, each mode against every other."""

    def solved(x):
        return scene(x, 5.0)

    def closed(x):
        return simulate(Pendulum(x[0]), 5.0, x[3], x[4]).theta

    shared = jnp.array([0, 3, 4])
    true = jax.grad(closed)(X)[shared]
    for mode in (jax.grad, jax.jacfwd, jax.jacrev, lambda f: jax.jit(jax.grad(f))):
        np.testing.assert_allclose(mode(solved)(X)[shared], true, rtol=1e-9)
    curvature = jax.hessian(closed)(X)[shared][:, shared]
    for mode in (jax.hessian, lambda f: jax.jacfwd(jax.jacfwd(f))):
        got = jax.jit(mode(solved))(X)
        np.testing.assert_allclose(got[shared][:, shared], curvature, rtol=1e-8)
        np.testing.assert_allclose(got, got.T, rtol=1e-8, atol=1e-8)
    lanes = jnp.stack([X, X + 0.1])
    mapped = jax.vmap(jax.grad(solved))(lanes)
    np.testing.assert_allclose(mapped[1], jax.grad(solved)(lanes[1]), rtol=1e-7)


@pytest.mark.full  # compiles long
def test_derivatives_in_the_times():
    """∂θ/∂t = v; a shift of all times changes nothing but a torque's phase."""
    pendulum = Pendulum(1.0, 0.1, jnp.sin)

    def at(t, t0):
        run = simulate(pendulum, t, 1.0, 0.2, t0=t0)
        return run.theta, run.v

    t = jnp.array([2.0, 3.0])
    slope = jax.jacfwd(lambda t: at(t, 0.5)[0])(t)
    np.testing.assert_allclose(slope, np.diag(at(t, 0.5)[1]), rtol=1e-10)
    h = 1e-4
    difference = (at(t, 0.5 + h)[0] - at(t, 0.5 - h)[0]) / (2 * h)
    np.testing.assert_allclose(jax.jacrev(lambda x: at(t, x)[0])(0.5), difference, rtol=1e-7)


def test_times_none_twice_and_traced():
    pendulum = Pendulum(1.0, 0.1, 0.3)
    assert simulate(pendulum, jnp.zeros(0), jnp.ones(2)).theta.shape == (2, 0)
    twice = simulate(pendulum, jnp.array([0.0, 0.0, 1.0, 1.0, 2.0]), 1.0).theta
    assert (twice[:2] == 0).all()
    assert twice[2] == twice[3]
    rows = jax.vmap(lambda ts: simulate(pendulum, ts, 1.0).theta)(
        jnp.array([[0.0, 1.0], [1.0, 2.0]])
    )
    np.testing.assert_allclose(rows, [[0, twice[2]], [twice[2], twice[4]]], rtol=1e-10)
    with pytest.raises(ValueError, match="monotone"):
        simulate(pendulum, jnp.array([0.0, 2.0, 1.0]), 1.0)


def test_constant_steps_that_are_traced():
    def last(v0, dt0):
        return simulate(Pendulum(1.0, 0.1), 2.0, v0, solver=dfx.Dopri8(), dt0=dt0).theta

    slope = jax.vmap(jax.grad(last), in_axes=(None, 0))(1.0, jnp.array([0.1, 0.2]))
    adaptive = jax.grad(lambda v0: simulate(Pendulum(1.0, 0.1), 2.0, v0).theta)(1.0)
    np.testing.assert_allclose(slope, adaptive, rtol=1e-8)


def test_terms_that_are_none_are_not_in_the_program():
    def text(pendulum):
        ts = jnp.linspace(0.0, 1.0, 3)
        run = jax.jit(lambda p: simulate(p, ts, 1.0, solver=dfx.Dopri8(), throw=False).theta)
        return run.lower(pendulum).as_text()

    free, damped = text(Pendulum(1.0)), text(Pendulum(1.0, 0.1, 0.2))
    assert free.count("stablehlo.multiply") < damped.count("stablehlo.multiply")


def test_bad_lanes_do_not_hold_up_the_others():
    beta = jnp.array([0.1, -0.1, jnp.nan, 0.2])

    def lane(beta, v0):
        run = simulate(Pendulum(1.0, beta), jnp.array([1.0, 2.0]), v0)
        return run.theta, run.result == Result.not_a_number, run.stats["steps"]

    theta, bad, steps = jax.vmap(lane)(beta, jnp.array([1.0, 1.0, 1.0, jnp.inf]))
    assert bad.tolist() == [False, True, True, True]
    assert jnp.isnan(theta).all(-1).tolist() == [False, True, True, True]
    assert steps.max() < 1000
    torque = Pendulum(1.0, 0.1, lambda t: jnp.where(t > 1, jnp.nan, 0.0))
    run = simulate(torque, jnp.array([0.5, 2.0]), 1.0, throw=False)
    assert run.result == Result.solver_failed
    with pytest.raises(RuntimeError, match="number infinite"):
        simulate(torque, jnp.array([0.5, 2.0]), 1.0)


def test_backwards_and_float32(dtype):
    pendulum = Pendulum(jnp.asarray(1.0, dtype), jnp.asarray(0.1, dtype), jnp.asarray(0.3, dtype))
    there = simulate(pendulum, jnp.asarray(4.0, dtype), jnp.asarray(0.5, dtype))
    back = simulate(pendulum, jnp.asarray(0.0, dtype), there.v, there.theta, t0=4.0)
    assert back.theta.dtype == dtype
    bar = 1e-10 if dtype == np.float64 else 1e-4
    assert abs(float(back.theta)) < bar
    assert abs(float(back.v) - 0.5) < bar
