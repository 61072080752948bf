"""Recordings cut into cycles, and ε from them."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pendax import Pendulum, Result, cycles, fit_frequency, period, simulate


def swing(theta_max, epsilon=4.0, times=None, theta_offset=0.0):
    ts = np.arange(0, 30, 0.01) if times is None else times
    return ts, np.asarray(simulate(Pendulum(epsilon), ts, 0.0, theta_max).theta) + theta_offset


@pytest.mark.parametrize("theta_max", [0.05, 1.0, 2.5, 3.1])
@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_undamped_swing(theta_max, offset):
    ts, theta = swing(theta_max, theta_offset=offset)
    found = cycles(ts, theta)
    true = float(period(Pendulum(4.0), 0.0, theta_max))
    assert found.period.size >= 30 / true - 2
    np.testing.assert_allclose(found.amplitude, theta_max, rtol=1e-5)
    np.testing.assert_allclose(found.period, true, rtol=3e-6)
    assert (np.diff(found.start) >= found.period[:-1] * (1 - 1e-6)).all()
    fit = fit_frequency(found.amplitude, found.period)
    assert float(fit.model.epsilon) == pytest.approx(4.0, rel=1e-3)


def test_errors_are_those_of_the_noise():
    """Deviations of 300 noisy cycles from the truth, in their own standard errors."""
    rng = np.random.default_rng(7)
    ts, theta = swing(1.2, times=np.arange(0, 1200, 0.02))
    found = cycles(ts, theta + 0.01 * rng.standard_normal(theta.size))
    true = float(period(Pendulum(4.0), 0.0, 1.2))
    assert found.period.size > 300
    for value, error, truth in (
        (found.period, found.period_error, true),
        (found.amplitude, found.amplitude_error, 1.2),
    ):
        pull = (value - truth) / error
        assert 0.7 < pull.std() < 1.4
        assert abs(pull.mean()) < 0.5


def test_coarse_noisy_and_gapped():
    """Twelve samples a swing with gaps at the turning points: no cycle is made up."""
    rng = np.random.default_rng(8)
    ts, theta = swing(1.0, times=np.arange(0, 100, 0.27))
    keep = rng.random(ts.size) > 0.1
    found = cycles(ts[keep], theta[keep] + 2e-3 * rng.standard_normal(keep.sum()))
    true = float(period(Pendulum(4.0), 0.0, 1.0))
    assert found.period.size > 10
    np.testing.assert_allclose(found.period, true, rtol=0.02)
    fit = fit_frequency(found.amplitude, found.period, sigma=found.period_error)
    assert abs(float(fit.model.epsilon) - 4) < 5 * float(fit.errors["epsilon"]) + 0.005


@pytest.mark.parametrize(("beta", "dry"), [(0.1, 0.0), (0.0, 0.05), (0.05, 0.03)])
def test_friction_does_not_bias_epsilon(beta, dry):
    """Viscous and dry friction, integrated by SciPy: ε to 0.2 % from swings below 100°."""

    def field(_, y):
        return y[1], -4 * np.sin(y[0]) - beta * y[1] - dry * np.tanh(y[1] / 1e-3)

    ts = np.arange(0, 25, 0.01)
    run = solve_ivp(field, (0, 25), (1.7, 0.0), t_eval=ts, rtol=1e-8, atol=1e-10, max_step=0.02)
    found = cycles(ts, run.y[0])
    assert found.period.size >= 5
    assert (np.diff(found.amplitude) < 0).all()
    fit = fit_frequency(found.amplitude, found.period)
    assert float(fit.model.epsilon) == pytest.approx(4.0, rel=2e-3)


@pytest.mark.parametrize(
    ("ts", "theta", "message"),
    [
        ([0, 1, 1, 2], [0, 1, 0, 1], "Argument `ts` must increase, but got 1.0 after 1.0."),
        ([0, 1, np.nan, 2], [0, 1, 0, 1], "Argument `ts` must be finite, but got nan."),
        ([0, 1, 2], [0, 1], r"must have one axis of equal length, but got shapes \(3,\) and"),
    ],
)
def test_bad_recordings(ts, theta, message):
    with pytest.raises(ValueError, match=message):
        cycles(np.array(ts, float), np.array(theta, float))


@pytest.mark.parametrize("theta", [np.zeros(50), np.linspace(0, 30, 50), np.zeros(2), np.zeros(0)])
def test_no_swing_no_cycles(theta):
    assert cycles(np.arange(theta.size, dtype=float), theta).period.size == 0


def test_fit_of_exact_periods_is_exact(dtype):
    amplitude = jnp.asarray([0.1, -1.0, 3.0], dtype)
    times = period(Pendulum(jnp.asarray(9.81, dtype)), jnp.zeros((), dtype), amplitude)
    fit = fit_frequency(amplitude, times)
    assert fit.result == Result.successful
    assert fit.model.epsilon.dtype == dtype
    np.testing.assert_allclose(fit.model.epsilon, 9.81, rtol=8 * jnp.finfo(dtype).eps)
    assert float(fit.errors["epsilon"]) < 100 * 9.81 * float(jnp.finfo(dtype).eps)


def test_fit_is_the_weighted_least_squares_value_with_its_error():
    rng = np.random.default_rng(9)
    amplitude = rng.uniform(0.1, 2, 4000)
    sigma = rng.uniform(0.001, 0.01, 4000)
    times = np.asarray(period(Pendulum(4.0), 0.0, amplitude)) + sigma * rng.standard_normal(4000)
    fit = fit_frequency(amplitude, times, sigma=sigma)
    error = float(fit.errors["epsilon"])
    assert abs(float(fit.model.epsilon) - 4) < 4 * error
    ratio = np.asarray(period(Pendulum(4.0), 0.0, amplitude)) / np.pi
    known = 2 * 4 / np.pi / np.sqrt(np.sum((ratio / sigma) ** 2))
    assert error == pytest.approx(known, rel=0.05)
    doubled = fit_frequency(amplitude, times, sigma=2 * sigma)
    np.testing.assert_allclose(doubled.errors["epsilon"], error, rtol=1e-12)
    assert fit.covariance.shape == (1, 1)
    slope = jax.jit(jax.grad(lambda t: fit_frequency(amplitude, t).model.epsilon))(times)
    assert jnp.isfinite(slope).all()


@pytest.mark.parametrize(
    ("amplitude", "times", "message"),
    [
        ([1.0, 3.2], [1.0, 1.0], "Argument `amplitude` must be below π in size, but got 3.2."),
        ([1.0, 1.0], [1.0, -1.0], "Argument `period` must be positive, but got -1.0."),
        ([1.0], [1.0], r"must have one axis of two or more cycles, but got shape \(1,\)."),
    ],
)
def test_bad_cycles(amplitude, times, message):
    with pytest.raises(ValueError, match=message):
        fit_frequency(np.array(amplitude), np.array(times))


@pytest.mark.parametrize(
    ("name", "start"), [("benard_free_swing_135deg", 0.232), ("benard_free_swing_45deg", 0.129)]
)
def test_measured_swings(shared, name, start):
    """2π/√ε within 0.5731 … 0.5746 s, cycle by cycle between 12° and 99°, and fitted."""
    data = np.genfromtxt(shared / "data" / "pendulum" / f"{name}.csv", delimiter=",", names=True)
    used = data["t_s"] >= start
    found = cycles(data["t_s"][used], np.radians(data["theta_deg"][used]))
    degrees = np.degrees(found.amplitude)
    single = found.period / np.asarray(period(Pendulum(4 * np.pi**2), 0.0, found.amplitude))
    between = (degrees > 12) & (degrees < 100)
    assert between.sum() >= 5
    assert ((single[between] > 0.5731) & (single[between] < 0.5746)).all()
    fit = fit_frequency(found.amplitude[between], found.period[between])
    assert 0.5731 < 2 * np.pi / np.sqrt(float(fit.model.epsilon)) < 0.5746


def test_measured_swing_with_gaps(shared):
    path = shared / "data" / "pendulum" / "schmidt_lipson_real_pend_h_1.csv"
    data = np.genfromtxt(path, delimiter=",", names=True)
    found = cycles(data["t"], data["theta_rad"])
    assert found.period.size >= 13
    fit = fit_frequency(found.amplitude, found.period)
    assert 5.385 < 2 * np.pi / np.sqrt(float(fit.model.epsilon)) < 5.417
