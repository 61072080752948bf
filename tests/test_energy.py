"""Energies, the phase curve and the tension, against mpmath and the table."""

import json
import math

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
from references import exact

import pendax
from pendax import Pendulum, energy, potential, slack_angle, tension, velocity


@pytest.mark.parametrize("theta", [0.0, 1e-150, 1e-9, 0.3, 3.0, np.pi, -7.0, 900.0])
def test_potential_keeps_the_digits_of_small_angles(theta, dtype):
    got = potential(Pendulum(jnp.asarray(2.5, dtype)), jnp.asarray(theta, dtype))
    with mp.workdps(330):
        x = exact(dtype.type(theta))
        true = mp.mpf(2.5) * (1 - mp.cos(x))
        scale = abs(true) + abs(x * mp.mpf(2.5) * mp.sin(x))
    assert abs(exact(got) - true) <= 8 * jnp.finfo(dtype).eps * scale + jnp.finfo(dtype).tiny


def test_velocity_is_the_phase_curve():
    rng = np.random.default_rng(1)
    theta, v = rng.uniform(-9, 9, 200), rng.uniform(0, 4, 200)
    pendulum = Pendulum(1.7)
    found = velocity(pendulum, theta, energy(pendulum, theta, v))
    np.testing.assert_allclose(found**2, v**2, atol=2e-14)
    near = np.pi - 10.0 ** np.arange(-15, 0)
    separatrix = velocity(pendulum, near, 2 * 1.7)
    np.testing.assert_allclose(separatrix, 2 * np.sqrt(1.7) * np.cos(near / 2), rtol=1e-15)


def test_velocity_beyond_the_turning_point_is_nan_there_alone():
    slope = jax.vmap(jax.value_and_grad(lambda x: velocity(Pendulum(), x, 1.0)))
    value, gradient = slope(jnp.array([0.0, 1.5, 2.0]))
    assert jnp.isnan(value).tolist() == jnp.isnan(gradient).tolist() == [False, False, True]


def test_tension_against_the_table(shared):
    table = json.loads((shared / "truth" / "tension.json").read_text())
    pendulum = Pendulum.from_si(2.0, 5.0)
    for row in table["release"]:
        top = math.radians(float(row["theta_max_deg"]))
        v = velocity(pendulum, 0.0, potential(pendulum, top))
        bottom = float(tension(pendulum, 0.0, v, 3.0, 2.0)) / (3.0 * 5.0)
        end = float(tension(pendulum, top, 0.0, 3.0, 2.0)) / (3.0 * 5.0)
        np.testing.assert_allclose(bottom, float(row["tension_bottom_over_mg"]), rtol=1e-14)
        np.testing.assert_allclose(end, float(row["tension_end_over_mg"]), rtol=1e-14, atol=1e-15)
        slack = math.degrees(slack_angle(pendulum, 0.0, top))
        if row["string_slack"] == "True":
            np.testing.assert_allclose(slack, float(row["theta_zero_tension_deg"]), rtol=1e-14)
        else:
            assert math.isnan(slack)
    for row in table["launch"]:
        slack = slack_angle(Pendulum(), float(row["v0"]))
        assert bool(jnp.isfinite(slack)) == (row["slack"] == "yes")


def test_where_no_string_goes_slack_is_nan_with_its_gradient():
    slope = jax.vmap(jax.value_and_grad(lambda v0: slack_angle(Pendulum(), v0)))
    value, gradient = slope(jnp.array([1.0, 2.0, 3.0]))
    assert jnp.isnan(value).tolist() == jnp.isnan(gradient).tolist() == [True, False, True]


def test_release_from_rest_against_the_table(shared):
    import csv

    with (shared / "truth" / "release_from_rest.csv").open() as file:
        for row in csv.DictReader(file):
            top = math.radians(float(row["theta_max_deg"]))
            run = pendax.simulate(Pendulum(), float(row["omega0_t"]), 0.0, top)
            scale = 1 + abs(float(row["omega0_t"]))
            assert abs(float(run.theta) - float(row["theta_release_cd"])) < 1e-14 * scale
            assert abs(float(run.v) - float(row["v_release"])) < 1e-14 * scale


def test_from_si():
    pendulum = Pendulum.from_si(2.0, 8.0, mass=0.5, damping=0.2, torque=3.0)
    assert (pendulum.epsilon, pendulum.beta, pendulum.tau) == (4.0, 0.1, 1.5)
    assert Pendulum.from_si(1.0).epsilon == 9.80665
    assert Pendulum.from_si(1.0).beta is None
    driven = Pendulum.from_si(2.0, mass=0.5, torque=lambda t: 4.0 * t)
    assert jax.jit(lambda pendulum, t: pendulum.tau(t))(driven, 3.0) == 6.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"length": 0.0}, "`length` must be positive, but got 0.0"),
        ({"length": 1.0, "gravity": -9.8}, "`gravity` must be positive"),
        ({"length": 1.0, "mass": 0.0}, "`mass` must be positive"),
        ({"length": 1.0, "mass": 1.0, "damping": -1.0}, "`damping` must be zero or positive"),
        ({"length": 1.0, "torque": 1.0}, "`mass` must be given"),
    ],
)
def test_from_si_refuses(arguments, message):
    with pytest.raises(ValueError, match=message):
        Pendulum.from_si(**arguments)


@pytest.mark.parametrize("v0", [1e-3, 0.5, 1.99, 2 - 1e-13, 2 + 1e-13, 2.5, 30.0])
@pytest.mark.parametrize("theta0", [0.0, 1.0])
def test_energy_does_not_drift(v0, theta0):
    """Over 10⁶ periods, to 1e-13, in rotation plus what half an ulp of θ makes."""
    pendulum = Pendulum(1.3)
    span = min(float(pendax.period(pendulum, v0, theta0)), 100.0) * 1e6
    ts = jnp.asarray(np.random.default_rng(2).uniform(0, span, 4000))
    run = pendax.simulate(pendulum, ts, v0, theta0)
    start = energy(pendulum, theta0, v0)
    half_ulp = 0.5 * np.spacing(np.abs(run.theta)) * 1.3 * np.abs(np.sin(run.theta))
    off = np.abs(energy(pendulum, run.theta, run.v) - start)
    assert (off <= 1e-13 * float(start) + 1.01 * half_ulp).all()
