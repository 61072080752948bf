"""Barely damped scenes against benchmarks/barely_damped.c, 80-bit steps through every turn."""

import jax
import numpy as np
import pytest

from pendax import Pendulum, simulate

# β, θ0, v0: rows of t, θ within its turn, v, turns.
TRUE = {
    (1e-4, -1.0, -2.5): [
        (12500.0, 1.6458880757215557, -0.448031666454575003, -1413),
        (25000.0, -0.740873916582471559, -0.444376997688159388, -1413),
        (50000.0, -0.233958420158843707, -0.0779511918143709273, -1413),
    ],
    (1e-4, 0.0, 2.3): [
        (25000.0, 0.518171885912899682, 0.554095040617693813, 669),
        (50000.0, 0.20247766187563492, 0.0818888948791802506, 669),
    ],
    (1e-5, 2.5, 0.0): [
        (124999.99999999999, -0.0516382796807135932, -1.08830104147362814, 0),
        (249999.99999999997, -0.52447289234608369, 0.285648420326201564, 0),
        (499999.99999999994, 0.00612057429689323264, 0.17036990779399204, 0),
    ],
    (1e-6, 0.0, 2.3): [
        (1250000.0, -0.149716950581118959, 1.36576165668859866, 66900),
        (5000000.0, -0.140915525382843786, 0.166564529392604676, 66900),
    ],
    (1e-7, 0.0, 2.3): [
        (6250000.0, 0.257001438641671119, 1.78625231605157175, 668997),
        (50000000.0, 0.213568531568535128, 0.0461482130818081594, 668997),
    ],
    (1e-7, 0.0, 1.5): [
        (6250000.0, 1.17872120011020220, 0.150908981441250783, 0),
        (50000000.0, 0.117968595056624349, 0.0514347586056620299, 0),
    ],
}


@pytest.mark.parametrize("scene", TRUE)
def test_against_every_turn(scene):
    """Within 1e-6, and within the error that is stated."""
    beta, theta0, v0 = scene
    ts, theta, v, turns = np.array(TRUE[scene]).T
    run = simulate(Pendulum(1.0, beta), ts, v0, theta0)
    assert run.method == "averaging over turns"
    error = np.hypot(np.asarray(run.theta) - 2 * np.pi * turns - theta, np.asarray(run.v) - v)
    # The stated error is of all times together, those of the rotation included.
    assert error.max() < 1e-6
    assert error.max() < float(run.stats["error"]) < 3e-5


def test_against_steps():
    """Where both can: the same scenes with other ε and a start of every kind."""
    epsilon, beta = 4.0, 4e-4
    v0 = np.array([3.0, 0.0, -6.0, 0.0, 1e-3, 4.0])
    theta0 = np.array([1.0, 3.1, 20.0, 0.0, 0.0, 0.0])
    ts = np.array([0.5, 900.0, 6000.0])
    run = simulate(Pendulum(epsilon, beta), ts, v0, theta0)
    assert run.method == "averaging over turns"
    steps = simulate(Pendulum(epsilon, beta, 0.0), ts, v0, theta0, rtol=1e-15)
    assert steps.method == "Taylor series"
    error = np.hypot(run.theta - steps.theta, (run.v - steps.v) / 2).max(1)
    assert (error <= run.stats["error"] + 1e-9).all()
    assert error.max() < 1e-6
    np.testing.assert_array_equal(run.theta[3], 0)


@pytest.mark.full  # a derivative of this compiles for minutes
def test_slopes():
    scene, ts, step = Pendulum(1.0, 2e-4), np.array([3e3, 2e4]), 1e-6

    def at(v0):
        return simulate(scene, ts, v0, 0.2).theta

    change = (at(1.5 + step) - at(1.5 - step)) / (2 * step)
    for mode in (jax.jacfwd, jax.jacrev):
        np.testing.assert_allclose(mode(at)(1.5), change, rtol=1e-4)
