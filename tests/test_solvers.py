"""The same scene by diffrax, for comparison with the closed form."""

import csv

import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, Result, energy, simulate
from pendax.solvers import Symplectic

TS = jnp.linspace(0.0, 20.0, 41)


@pytest.mark.parametrize(
    ("solver", "options", "bar"),
    [
        (dfx.Dopri8(), {}, 1e-10),
        (dfx.Tsit5(), {"rtol": 1e-8}, 1e-6),
        (dfx.Kvaerno5(), {"rtol": 1e-6, "atol": 1e-8}, 1e-3),
        (dfx.Dopri5(), {"dt0": 0.05}, 1e-6),
        (dfx.SemiImplicitEuler(), {"dt0": 0.01}, 0.1),
        (Symplectic(2), {"dt0": 0.01}, 2e-4),
        (Symplectic(4), {"dt0": 0.05}, 2e-5),
        (Symplectic(6), {"dt0": 0.05}, 1e-8),
    ],
)
def test_solvers_agree_with_the_closed_form(solver, options, bar):
    exact = simulate(Pendulum(2.0), TS, 1.9, 0.3)
    run = simulate(Pendulum(2.0), TS, 1.9, 0.3, solver=solver, **options)
    assert run.result == Result.successful
    assert run.stats["steps"] >= 20
    # Interpolated between the steps, Dopri8's would be 100 times less accurate.
    assert jnp.abs(run.theta - exact.theta).max() < bar
    assert jnp.abs(run.v - exact.v).max() < 2 * bar


@pytest.mark.parametrize("degree", [2, 4, 6])
def test_order_and_energy_of_the_symplectic_method(degree):
    step = 0.25

    def error(dt0):
        run = simulate(Pendulum(), TS, 1.0, solver=Symplectic(degree), dt0=dt0)
        return float(jnp.abs(run.theta - simulate(Pendulum(), TS, 1.0).theta).max()), run

    (first, run), (second, _) = error(step), error(step / 2)
    assert 0.8 * 2**degree < first / second < 1.25 * 2**degree
    off = jnp.abs(energy(Pendulum(), run.theta, run.v) - 0.5)
    assert off[21:].max() < 1.2 * off[:21].max()  # it does not drift


def test_lanes_directions_and_dtype(dtype):
    epsilon, v0 = jnp.asarray([1.0, 2.0], dtype), jnp.asarray([[0.1], [1.0], [2.5]], dtype)
    ts = -TS.astype(dtype)
    run = simulate(Pendulum(epsilon), ts, v0, solver=dfx.Dopri8())
    exact = simulate(Pendulum(epsilon), ts, v0)
    assert run.theta.shape == (3, 2, 41)
    assert run.theta.dtype == dtype
    assert run.stats["steps"].shape == (run.result == Result.successful).shape == (3, 2)
    bar = 1e-8 if dtype == np.float64 else 2e-2
    assert jnp.abs(run.theta - exact.theta).max() < bar
    single = simulate(Pendulum(epsilon[0]), ts[5], v0[1, 0], solver=dfx.Dopri8())
    np.testing.assert_allclose(single.theta, run.theta[1, 0, 5], rtol=1e-3)


def test_gradient_in_reverse():
    def last(v0, **options):
        return simulate(Pendulum(), TS, v0, **options).theta[-1]

    by_solver = jax.grad(lambda v0: last(v0, solver=dfx.Dopri8()))(1.0)
    np.testing.assert_allclose(by_solver, jax.grad(last)(1.0), rtol=1e-8)
    forward = jax.jacfwd(lambda v0: last(v0, solver=dfx.Dopri8(), adjoint=dfx.ForwardMode()))(1.0)
    np.testing.assert_allclose(forward, by_solver, rtol=1e-8)


def test_damping_and_torque_by_a_solver(shared):
    with (shared / "truth" / "dissipative_trajectories.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if float(row["t"]) <= 20]
    for row in rows[:20]:
        v0, beta, tau, t = (float(row[name]) for name in ("v0", "beta", "tau", "t"))
        run = simulate(Pendulum(1.0, beta, tau), t, v0, solver=dfx.Dopri8())
        np.testing.assert_allclose(run.theta, float(row["theta"]), atol=1e-8)


def test_failures_are_reported():
    options = {"solver": dfx.Dopri8(), "max_steps": 80}
    v0 = jnp.array([0.01, 3.0])
    run = simulate(Pendulum(), TS, v0, **options, rtol=1e-8, throw=False)
    assert (run.result == Result.successful).tolist() == [True, False]
    assert (run.result == Result.too_many_steps).tolist() == [False, True]
    assert jnp.isfinite(run.theta[0]).all()
    with pytest.raises(RuntimeError, match="took `max_steps` steps"):
        simulate(Pendulum(), TS, 3.0, **options)
    run = simulate(Pendulum(), TS, 1.0, solver=Symplectic(4), dt0=1e-3, max_steps=5, throw=False)
    assert run.result == Result.too_many_steps


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dt0": 0.1}, "`dt0` must come with a `solver`"),
        ({"rtol": 1e-3}, "`rtol` must come with a `solver`"),
        ({"solver": dfx.SemiImplicitEuler()}, "`dt0` must be given with SemiImplicitEuler"),
        ({"solver": dfx.Dopri8(), "rtol": -1.0}, "`rtol` must be one positive number"),
        ({"solver": dfx.Dopri8(), "dt0": 0.0}, "`dt0` must be a step other than zero"),
        ({"solver": dfx.Dopri8(), "t0": 5.0}, "`ts` must be monotone and away from `t0`"),
        ({"solver": dfx.Dopri8}, "`solver` must be a solver of diffrax"),
        ({"solver": "Dopri8"}, "`solver` must be a solver of diffrax"),
        (
            {"solver": dfx.Dopri8(), "stepsize_controller": dfx.ConstantStepSize()},
            "`dt0` must be given with constant steps",
        ),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(ValueError, match=message):
        simulate(Pendulum(), TS, 1.0, **options)


def test_split_terms_have_no_damping():
    with pytest.raises(ValueError, match="must take one term for a damped scene"):
        simulate(Pendulum(1.0, 0.1), TS, 1.0, solver=Symplectic(), dt0=0.1)
    with pytest.raises(ValueError, match="`degree` must be 2, 4 or 6"):
        Symplectic(3)


def test_on_the_separatrix_every_solver_falls_off():
    """θ → π and stays; a solver leaves the saddle like e^t times its error (§5.2 g)."""
    ts = jnp.linspace(0.0, 60.0, 601)
    exact = simulate(Pendulum(), ts, 2.0)
    assert (jnp.diff(exact.theta) >= 0).all()
    np.testing.assert_allclose(exact.theta[-1], np.pi, rtol=1e-15)
    run = simulate(Pendulum(), ts, 2.0, solver=dfx.Dopri8())
    fallen = ts[jnp.argmax(jnp.abs(run.theta - exact.theta) > 0.1)]
    assert 20 < fallen < 45
