"""The junction in SI units, its pendulum, and its phase over time."""

import jax
import jax.numpy as jnp
import junction_references as references
import numpy as np
import pytest

from pendax import FLUX_QUANTUM, JosephsonJunction, Pendulum, mean_velocity, simulate

REDUCED = FLUX_QUANTUM / (2 * np.pi)
IC, R = 112.5e-6, 8.0


def of_beta_c(beta_c, critical=IC, resistance=R):
    return JosephsonJunction(critical, resistance, beta_c * REDUCED / (critical * resistance**2))


def test_constants_and_units(dtype):
    assert FLUX_QUANTUM == 6.62607015e-34 / (2 * 1.602176634e-19)
    arrays = (jnp.asarray(x, dtype) for x in (IC, R, 0.4e-12))
    junction = JosephsonJunction(*arrays)
    rtol = 8 * jnp.finfo(dtype).eps
    plasma = np.sqrt(IC / (REDUCED * 0.4e-12))
    np.testing.assert_allclose(junction.plasma_frequency, plasma, rtol=rtol)
    np.testing.assert_allclose(junction.stewart_mccumber, (plasma * R * 0.4e-12) ** 2, rtol=rtol)
    np.testing.assert_allclose(junction.damping, 1 / (plasma * R * 0.4e-12), rtol=rtol)
    np.testing.assert_allclose(junction.voltage(1.5), REDUCED * plasma * 1.5, rtol=rtol)
    np.testing.assert_allclose(junction.velocity(junction.voltage(1.5)), 1.5, rtol=rtol)
    assert junction.stewart_mccumber.dtype == dtype
    # Derivatives stay within the range of float32.
    for by in range(3):
        slope = jax.grad(
            lambda *x: JosephsonJunction(*x).stewart_mccumber / 10, by
        )(junction.critical_current, junction.resistance, junction.capacitance)  # fmt: skip
        assert jnp.isfinite(slope)
        slope = jax.grad(lambda *x: JosephsonJunction(*x).plasma_frequency / 1e12, by)(
            junction.critical_current, junction.resistance, junction.capacitance
        )
        assert jnp.isfinite(slope)


def test_its_pendulum():
    junction = of_beta_c(4.0)
    pendulum = junction.pendulum(1.5 * IC)
    assert isinstance(pendulum, Pendulum)
    np.testing.assert_allclose([pendulum.beta, pendulum.tau], [0.5, 1.5], rtol=1e-14)
    # The equation in SI units: I = ħC/2e φ̈ + ħ/2eR φ̇ + Ic sin φ.
    capacitance, plasma = float(junction.capacitance), float(junction.plasma_frequency)
    phi, v = 0.7, 0.3
    acceleration = 1.5 - np.sin(phi) - 0.5 * v
    current = REDUCED * capacitance * plasma**2 * acceleration
    current += REDUCED / R * plasma * v + IC * np.sin(phi)
    np.testing.assert_allclose(current, 1.5 * IC, rtol=1e-13)


def test_a_current_over_time():
    """A pulse: the pendulum's time is ω_p t."""
    junction = of_beta_c(4.0)
    width = 3 / junction.plasma_frequency
    pulse = junction.pendulum(lambda t: IC * jnp.where(t < width, 0.9, 0.2))
    assert pulse.tau(2.9) == pytest.approx(0.9)
    assert pulse.tau(3.1) == pytest.approx(0.2)


def test_without_capacitance():
    junction = JosephsonJunction(IC, R)
    assert junction.stewart_mccumber == 0
    assert junction.plasma_frequency == jnp.inf
    assert len(jax.tree.leaves(junction)) == 2
    for call in (junction.pendulum, junction.voltage, junction.velocity):
        with pytest.raises(ValueError, match="`capacitance` is no pendulum"):
            call(1.0)
    with pytest.raises(ValueError, match="has no closed form"):
        of_beta_c(1.0).evolve(0.0, IC)


@pytest.mark.parametrize("tau", [0.0, 0.3, 0.999, 1.0, 1 + 1e-12, 1.05, 3.0, -1.7, -0.5])
def test_phase_over_time(tau):
    """Against the equation itself, in Arb."""
    junction = JosephsonJunction(IC, R)
    unit = REDUCED / (IC * R)
    s = np.array([0.0, 0.01, 1.0, 7.0, 40.0])
    for phase0 in (0.0, 2.0, -40.0):
        found = junction.evolve(s * unit, tau * IC, phase0)
        for k, x in enumerate(s):
            exact = float(junction.critical_current * 0 + tau * IC) / IC  # as rounded
            phi, rate = references.phase(exact, 0.0, 1.0, phase0, float(x))
            scale = abs(float(phi)) + 1 + x * abs(tau)
            np.testing.assert_allclose(found.phase[k], float(phi), atol=4e-14 * scale)
            off = 1e-13 * (abs(tau) + 1) * (1 + x * abs(float(rate)))
            np.testing.assert_allclose(found.voltage[k] / (IC * R), float(rate), atol=off)


def test_settling():
    """Without a current tan(φ/2) falls like e^(−s): to the last digits, from and to any time."""
    junction, unit = JosephsonJunction(IC, R), REDUCED / (IC * R)
    for phase0, s in ((1e-20, -40.0), (1e-10, -30.0), (1e-10, 40.0), (3.0, 2.0), (0.0, -1e5)):
        found = junction.evolve(s * unit, 0.0, phase0)
        true = 2 * np.arctan(np.tan(phase0 / 2) * np.exp(min(-s, 700)))
        np.testing.assert_allclose(found.phase, true, rtol=1e-13)
        np.testing.assert_allclose(found.voltage, -IC * R * np.sin(true), rtol=1e-13)
    for tau, phase0 in ((1e-12, np.pi / 2), (0.999, 1.5), (-0.3, 20.0)):
        turns = round((phase0 - np.arcsin(tau)) / (2 * np.pi))
        found = junction.evolve(1e5 * unit, tau * IC, phase0)
        np.testing.assert_allclose(found.phase, np.arcsin(tau) + 2 * np.pi * turns, rtol=1e-14)
        assert abs(found.voltage) < 1e-90


def test_time_goes_backwards():
    junction = JosephsonJunction(IC, R)
    t = 5 * REDUCED / (IC * R)
    for tau in (0.4, 2.5):
        later = junction.evolve(t, tau * IC, 0.3).phase
        np.testing.assert_allclose(junction.evolve(-t, tau * IC, later).phase, 0.3, atol=1e-13)


def test_slopes_of_the_phase(dtype):
    """V is the phase's derivative; at the critical current too every derivative is finite."""
    junction = JosephsonJunction(jnp.asarray(IC, dtype), jnp.asarray(R, dtype))
    unit = REDUCED / (IC * R)
    for tau in (0.2, 1.0, 1.8):
        t = jnp.asarray(3 * unit, dtype)

        def phase(t, tau, phase0):
            return junction.evolve(t, tau * junction.critical_current, phase0).phase

        arguments = t, jnp.asarray(tau, dtype), jnp.asarray(0.3, dtype)
        slopes = jax.grad(phase, (0, 1, 2))(*arguments)
        volts = junction.evolve(t, arguments[1] * junction.critical_current, arguments[2]).voltage
        np.testing.assert_allclose(REDUCED * slopes[0], volts, rtol=4e3 * jnp.finfo(dtype).eps)
        forward = jax.jacfwd(phase, (0, 1, 2))(*arguments)
        np.testing.assert_allclose(forward, slopes, rtol=1e3 * jnp.finfo(dtype).eps)
        if dtype.itemsize == 8:
            curved = jax.hessian(phase, (1, 2))(*arguments)
            assert np.isfinite(np.array(curved)).all()
            h = 1e-5
            ends = [jax.grad(phase, 1)(t, tau + x, 0.3) for x in (h, -h)]
            np.testing.assert_allclose(curved[0][0], (ends[0] - ends[1]) / (2 * h), rtol=1e-7)


def test_shapes_and_lanes():
    junction = JosephsonJunction(jnp.array([1e-6, 2e-6]), 10.0)
    found = junction.evolve(jnp.linspace(0, 1e-9, 5), jnp.ones((3, 1)) * 3e-6)
    assert found.phase.shape == found.voltage.shape == (3, 2, 5)
    assert found.ts.shape == (5,)
    wrong = jax.vmap(lambda ic: JosephsonJunction(ic, 1.0, 1e-12).damping)(jnp.array([1e-6, -1e-6]))
    assert jnp.isnan(wrong).tolist() == [False, True]
    wrong = jax.vmap(lambda r: JosephsonJunction(IC, r).evolve(1e-12, IC).phase)
    assert jnp.isnan(wrong(jnp.array([R, -R, jnp.inf]))).tolist() == [False, True, True]


def test_simulated_voltage():
    """Through `simulate` and back: the mean of V is that of `mean_velocity`."""
    junction = of_beta_c(4.0)
    scene = junction.pendulum(1.5 * IC)
    v = mean_velocity(scene)
    ts = jnp.array([100.0, 100 + 2 * np.pi / v])
    run = simulate(scene, ts, v)
    np.testing.assert_allclose(jnp.diff(run.theta), 2 * np.pi, rtol=1e-9)
    seconds = jnp.diff(ts) / junction.plasma_frequency
    volts = REDUCED * jnp.diff(run.theta) / seconds
    np.testing.assert_allclose(volts, junction.voltage(v), rtol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, 1.0), "`critical_current` must be positive"),
        ((1e-6, -1.0), "`resistance` must be positive"),
        ((1e-6, 1.0, 0.0), "`capacitance` must be positive"),
        ((np.inf, 1.0), "`critical_current` must be positive"),
        ((112.5, 8.0), "`critical_current` must be in A"),
        ((1e-6, 8e9), "must be in A and Ω"),
        ((1e-6, 8.0, 0.4), "`capacitance` must be in F"),
        ((1.0, 10.0), "must be in A and Ω"),
        ((np.ones(2) * 1e-6, np.ones(3)), "broadcast"),
    ],
)
def test_wrong_arguments(arguments, message):
    with pytest.raises(ValueError, match=message):
        JosephsonJunction(*arguments)
