"""I–V curves: hysteresis, Shapiro steps and their uncertainty."""

import csv

import fate_references
import jax
import jax.numpy as jnp
import junction_references as references
import numpy as np
import pytest
from scipy.special import jv
from test_junction import IC, REDUCED, R, of_beta_c

from pendax import FLUX_QUANTUM, JosephsonJunction, iv_curve, retrapping_torque

RSJ = JosephsonJunction(IC, R)
# h f/2e at this frequency is 0.37 Ic R.
HERTZ = 0.37 * IC * R / FLUX_QUANTUM


def test_voltages_of_the_table(shared):
    with (shared / "truth" / "mean_velocity.csv").open() as file:
        rows = [[float(row[x]) for x in ("beta", "tau", "mean_v")] for row in csv.DictReader(file)]
    beta, tau, v = np.array(rows).T

    @jax.vmap
    def curves(beta, tau):
        junction = of_beta_c(beta**-2)
        return iv_curve(junction, tau * IC), iv_curve(junction, -tau * IC)

    curve, back = curves(beta, tau)
    true = IC * R * beta * v
    # How much the roundings of τ and β count next to the retrapping current.
    near = tau < 1.01 * retrapping_torque(beta)
    assert (np.abs(curve.voltage_down / true - 1) < np.where(near, 1e-9, 1e-11)).all()
    np.testing.assert_allclose(curve.voltage_up, np.where(tau > 1, true, 0), rtol=1e-9)
    np.testing.assert_allclose(back.voltage_up, -curve.voltage_down, rtol=1e-12)
    np.testing.assert_allclose(back.voltage_down, -curve.voltage_up, rtol=1e-12)


@pytest.mark.parametrize("beta_c", [0.1, 1.0, 10.0, 100.0])
def test_fresh_voltages(beta_c):
    """1e-9 relative, at currents no table has."""
    beta = beta_c**-0.5
    least = float(retrapping_torque(beta))
    tau = np.sort(least * (1 + 10 ** np.random.default_rng(3).uniform(-2, 0.5, 4)))
    curve = iv_curve(of_beta_c(beta_c), tau * IC)
    true = [IC * R * beta * float(fate_references.mean_velocity(beta, x)) for x in tau]
    np.testing.assert_allclose(curve.voltage_down, true, rtol=1e-9)


def test_branches():
    """Switching at Ic, retrapping at Ir, to the last digits; no hysteresis below β_c = 1/β*²."""
    junction = of_beta_c(25.0)
    ir = float(retrapping_torque(junction.damping)) * IC
    assert junction.retrapping_current == ir
    assert RSJ.retrapping_current == IC
    np.testing.assert_allclose(ir, 4 * IC / (np.pi * 5), rtol=0.01)
    current = np.array([-1.01, -1.0, -0.9, -ir / IC * (1 - 1e-12), 0, ir / IC * (1 + 1e-12), 1.0])
    current = np.append(current, [1 + 1e-12, 1.5]) * IC
    curve = iv_curve(junction, current)
    assert np.sign(curve.voltage_up).tolist() == [-1, -1, -1, 0, 0, 0, 0, 1, 1]
    assert np.sign(curve.voltage_down).tolist() == [-1, 0, 0, 0, 0, 1, 1, 1, 1]
    falling = iv_curve(junction, current[::-1])
    np.testing.assert_array_equal(falling.voltage_up, curve.voltage_up[::-1])
    alone = iv_curve(junction, 0.9 * IC)
    assert alone.voltage_up == 0
    assert alone.voltage_down.shape == ()
    assert alone.voltage_down > 0
    for beta_c, hysteresis in ((0.70256, False), (0.7026, True), (0.1, False)):
        current = IC * np.linspace(0.999999, 1, 7)
        curve = iv_curve(of_beta_c(beta_c), current)
        assert (curve.voltage_up == 0).all()
        assert bool((curve.voltage_down > 0).any()) == hysteresis


def test_first_order(dtype):
    junction = JosephsonJunction(jnp.asarray(IC, dtype), jnp.asarray(R, dtype))
    current = jnp.asarray(IC * np.array([-3.0, -1.0, 0.0, 0.5, 1 + 1e-3, 2.0]), dtype)
    curve = iv_curve(junction, current)
    ic, i = float(junction.critical_current), np.asarray(current, float)
    true = np.sign(i) * R * np.sqrt(np.maximum((np.abs(i) - ic) * (np.abs(i) + ic), 0))
    np.testing.assert_allclose(curve.voltage_up, true, rtol=8 * jnp.finfo(dtype).eps)
    np.testing.assert_array_equal(curve.voltage_up, curve.voltage_down)
    assert curve.voltage_up.dtype == dtype


def test_small_capacitance():
    """What it does goes to zero with it."""
    current = IC * np.array([-3.0, 0.5, 1.01, 2.0])
    near, limit = (iv_curve(x, current).voltage_up for x in (of_beta_c(1e-6), RSJ))
    np.testing.assert_allclose(near, limit, rtol=1e-6)


def test_slopes():
    """In Ic, R, C and I, forward and reverse, against another route: V = Ic R β v̄(β, I/Ic)."""

    def volts(critical, resistance, capacitance, current):
        return iv_curve(JosephsonJunction(critical, resistance, capacitance), current).voltage_down

    at = IC, R, 4.0 * REDUCED / (IC * R**2), 0.8 * IC
    forward, reverse = (mode(volts, (0, 1, 2, 3))(*at) for mode in (jax.jacfwd, jax.grad))
    np.testing.assert_allclose(forward, reverse, rtol=1e-12)
    for k, x in enumerate(at):
        ends = []
        for step in (1e-5, -1e-5):
            moved = [*at]
            moved[k] = x * (1 + step)
            beta = (REDUCED / (moved[0] * moved[1] ** 2 * moved[2])) ** 0.5
            v = float(fate_references.mean_velocity(beta, moved[3] / moved[0]))
            ends.append(moved[0] * moved[1] * beta * v)
        np.testing.assert_allclose(forward[k], (ends[0] - ends[1]) / (2e-5 * x), rtol=1e-7)
    # At rest nothing changes.
    assert jax.grad(lambda i: iv_curve(of_beta_c(4.0), i).voltage_up)(0.8 * IC) == 0


@pytest.mark.parametrize("seed", range(6))
def test_turns_of_a_first_order_junction(seed):
    """One period tells all: against φ followed for 20 of them, and Re a in 30 digits."""
    rng = np.random.default_rng(seed)
    i0, i1, omega = rng.uniform(-3, 3), rng.uniform(0, 3), 10 ** rng.uniform(-0.5, 1.3)
    drive = i1 * IC, omega * IC * R / FLUX_QUANTUM
    curve = iv_curve(RSJ, i0 * IC, drive=drive)
    exact = (i0 * IC) / IC, drive[0] / IC, FLUX_QUANTUM * drive[1] / (IC * R)
    true = float(references.rotation_number(*exact)) * FLUX_QUANTUM * drive[1]
    rounding = 4e-16 * abs(true)
    assert abs(curve.voltage_up - true) <= curve.error_up + rounding
    assert curve.error_up < 1e-12 * (abs(true) + FLUX_QUANTUM * drive[1])
    np.testing.assert_array_equal(curve.voltage_up, curve.voltage_down)


def test_steps():
    """V = n h f/2e for n = 0 to 5, first order and with capacitance."""
    drive = 2.5 * IC, HERTZ
    current = np.linspace(0, 2.6, 131) * IC
    for junction in (RSJ, of_beta_c(0.5)):
        curve = iv_curve(junction, current, drive=drive)
        for way in (curve.voltage_up, curve.voltage_down):
            turns = np.asarray(way) / (FLUX_QUANTUM * HERTZ)
            for n in range(6):
                near = turns[np.abs(turns - n) < 1e-6]
                assert near.size >= 2, n
                np.testing.assert_allclose(near, n, atol=1e-12)


def edges(n, i1, omega):
    """Where the n-th step begins and ends, by bisection of the curve."""
    frequency = omega * IC * R / FLUX_QUANTUM
    centre = np.sqrt((n * omega) ** 2 + 1) if n else 0.0
    grid = centre + np.linspace(-1.2, 1.2, 1201)
    turns = iv_curve(RSJ, grid * IC, drive=(i1 * IC, frequency)).voltage_up
    on = np.abs(turns / (FLUX_QUANTUM * frequency) - n) < 1e-9
    found = []
    for k, side in ((np.argmax(on), -1), (len(on) - 1 - np.argmax(on[::-1]), 1)):
        inside, outside = grid[k], grid[k + side]
        for _ in range(30):
            middle = 0.5 * (inside + outside)
            v = iv_curve(RSJ, middle * IC, drive=(i1 * IC, frequency)).voltage_up
            if abs(v / (FLUX_QUANTUM * frequency) - n) < 1e-12:
                inside = middle
            else:
                outside = middle
        found.append(inside)
    return found


@pytest.mark.parametrize(("n", "x"), [(0, 1.0), (1, 1.0), (1, 1.84), (2, 3.0), (3, 2.0), (5, 6.4)])
def test_widths_of_steps(n, x):
    """2 Ic |J_n(x)| with x = i1/Ω at high frequency, to 2 %."""
    omega = 30.0
    low, high = edges(n, x * omega, omega)
    np.testing.assert_allclose(high - low, 2 * abs(jv(n, x)), rtol=0.02)
    # Their ends are where |Re a| = 1, in 30 digits.
    for end in (low, high):
        assert abs(abs(references.half_trace(end, x * omega, omega)) - 1) < 1e-7


def test_slopes_under_a_drive():
    def volts(i, i1, ic):
        drive = i1 * IC, HERTZ
        return iv_curve(JosephsonJunction(ic, R), i * IC, drive=drive).voltage_up / (IC * R)

    at = 1.7, 0.6, IC
    assert 0.1 < float(volts(*at) / 0.37) % 1 < 0.9  # between steps
    forward, reverse = (mode(volts, (0, 1))(*at) for mode in (jax.jacfwd, jax.grad))
    np.testing.assert_allclose(forward, reverse, rtol=1e-12)
    omega, h = FLUX_QUANTUM * HERTZ / (IC * R), 1e-8
    for k in range(2):
        ends = []
        for x in (h, -h):
            moved = [*at[:2]]
            moved[k] += x
            ends.append(references.rotation_number(*moved, omega) * omega)
        np.testing.assert_allclose(forward[k], float(ends[0] - ends[1]) / (2 * h), rtol=1e-7)
    curved = jax.hessian(volts)(*at)
    slopes = [jax.grad(volts)(at[0] + x, *at[1:]) for x in (1e-5, -1e-5)]
    np.testing.assert_allclose(curved, (slopes[0] - slopes[1]) / 2e-5, rtol=1e-6)
    # On a step nothing moves, with a capacitance as well; between them that has no derivative.
    assert jax.grad(volts)(0.9, 1.5, IC) == 0

    def with_capacitance(i):
        return iv_curve(of_beta_c(0.5), i * IC, drive=(1.5 * IC, HERTZ), periods=16).voltage_up

    assert jax.grad(with_capacitance)(0.9) == 0
    assert jnp.isnan(jax.grad(with_capacitance)(3.03))


@pytest.mark.parametrize("beta_c", [1e-4, 1.0, 20.0])
def test_a_drive_of_no_amplitude(beta_c):
    """Averages are those of the autonomous curve, within what they state."""
    junction, current = of_beta_c(beta_c), np.linspace(-1.5, 1.55, 13) * IC
    driven = iv_curve(junction, current, drive=(0.0, HERTZ), periods=128)
    still = iv_curve(junction, current)
    for a, b, error in (
        (driven.voltage_up, still.voltage_up, driven.error_up),
        (driven.voltage_down, still.voltage_down, driven.error_down),
    ):
        assert (np.abs(a - b) <= 3 * error + 1e-13 * IC * R).all()
        assert (error < 2e-2 * HERTZ * FLUX_QUANTUM).all()


def test_beside_a_step():
    """Where no slip is seen, it may be by one; where rounding hides one, by that."""
    for d in (1e-10, 1e-7, 1e-5):
        current = np.array([1.0, 1 + d]) * IC
        still = iv_curve(of_beta_c(0.5), current).voltage_up[1]
        driven = iv_curve(of_beta_c(0.5), current, drive=(0.0, HERTZ))
        assert abs(driven.voltage_up[1] - still) < driven.error_up[1]
    for d, omega in ((1e-9, 9e3), (1e-9, 0.01), (2.3e-16, 1.0), (2.3e-16, 1e-3)):
        current, drive = (1 + d) * IC, (0.0, omega * IC * R / FLUX_QUANTUM)
        still, driven = iv_curve(RSJ, current), iv_curve(RSJ, current, drive=drive)
        assert abs(driven.voltage_up - still.voltage_up) < driven.error_up


def test_fractional_steps():
    """An underdamped junction locks at halves as well."""
    current = np.linspace(1.48, 1.55, 36) * IC
    curve = iv_curve(of_beta_c(1.0), current, drive=(1.5 * IC, 0.8 * IC * R / FLUX_QUANTUM))
    turns = curve.voltage_up / (0.8 * IC * R)
    half = np.abs(turns - 1.5) < 1e-14
    assert half.sum() > 1
    assert (curve.error_up[half] < 1e-6 * IC * R).all()


def test_vanishing_capacitance_under_a_drive():
    """The other method, many turns for one, comes to the first-order junction's voltage."""
    current, drive = np.array([0.9, 1.234, 1.9]) * IC, (0.8 * IC, HERTZ)
    limit = iv_curve(RSJ, current, drive=drive).voltage_up
    off = []
    for beta_c in (4e-4, 1e-4):
        curve = iv_curve(of_beta_c(beta_c), current, drive=drive)
        off.append(np.abs(curve.voltage_up - limit))
        assert (curve.error_up < 1e-4 * IC * R).all()
    assert (off[1] < 1e-4 * IC * R).all()


def test_float32_under_a_drive():
    with jax.enable_x64(False):
        current = jnp.linspace(0, 2, 9) * IC
        curve = iv_curve(RSJ, current, drive=(IC, HERTZ))
        slow = iv_curve(of_beta_c(1.0), current, drive=(IC, HERTZ), periods=32)
    assert curve.voltage_up.dtype == slow.voltage_up.dtype == np.float32
    exact = iv_curve(RSJ, np.asarray(current, float), drive=(IC, HERTZ))
    off = np.abs(np.asarray(curve.voltage_up, float) - exact.voltage_up)
    assert (off <= np.asarray(curve.error_up, float) + 1e-10).all()
    exact = iv_curve(of_beta_c(1.0), np.asarray(current, float), drive=(IC, HERTZ))
    off = np.abs(np.asarray(slow.voltage_up, float) - exact.voltage_up) / (IC * R)
    assert np.median(off) < 1e-4


def test_lanes():
    junction = JosephsonJunction(jnp.array([[1.0], [2.0]]) * IC, jnp.full((1, 3), R))
    current = np.linspace(-3, 3, 5) * IC
    assert iv_curve(junction, current).voltage_up.shape == (2, 3, 5)
    assert iv_curve(junction, 2.0 * IC).voltage_up.shape == (2, 3)
    assert iv_curve(junction, np.zeros(0)).voltage_up.shape == (2, 3, 0)
    driven = iv_curve(junction, current, drive=(IC, HERTZ))
    assert driven.voltage_up.shape == driven.error_down.shape == (2, 3, 5)
    assert iv_curve(junction, np.zeros(0), drive=(IC, HERTZ)).error_up.shape == (2, 3, 0)
    one = iv_curve(RSJ, 2.0 * IC, drive=(IC, jnp.array([1.0, 2.0]) * HERTZ))
    assert one.voltage_up.shape == (2,)

    critical = jnp.array([1.0, -1.0, jnp.nan, 2.0]) * IC
    for drive in (None, (IC, HERTZ)):

        def volts(ic, drive=drive):
            return iv_curve(JosephsonJunction(ic, R), 3 * IC, drive=drive).voltage_up

        for call in (volts, jax.grad(volts)):
            bad = jnp.isnan(jax.jit(jax.vmap(call))(critical))
            assert bad.tolist() == [False, True, True, False]
    with_nan = iv_curve(of_beta_c(4.0), np.array([0.5, np.nan, 1.5]) * IC)
    assert jnp.isnan(with_nan.voltage_up).tolist() == [False, True, False]
    with_nan = np.array([np.nan, 0.5, np.nan, 1.5]) * IC
    with_nan = iv_curve(of_beta_c(1.0), with_nan, drive=(IC, HERTZ), periods=16)
    assert jnp.isnan(with_nan.voltage_up).tolist() == [True, False, True, False]
    none = JosephsonJunction(np.zeros(0), np.ones(1), np.ones(1) * 1e-12)
    assert iv_curve(none, current, drive=(IC, HERTZ)).voltage_up.shape == (0, 5)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: iv_curve(RSJ, IC * np.array([0.0, 2.0, 1.0])), "must rise or fall throughout"),
        (lambda: iv_curve(RSJ, np.linspace(0, 300, 9)), "in A.*it reaches 2.67e.06 times"),
        (lambda: iv_curve(RSJ, np.linspace(0, 300e-9, 9)), "stays below 0.00267 of"),
        (lambda: iv_curve(RSJ, np.ones((2, 2)) * IC), "one axis at most"),
        (lambda: iv_curve(RSJ, IC, drive=(IC,)), r"\(amplitude, frequency\)"),
        (lambda: RSJ.evolve(1e-12, 120.0), "in A.*it reaches 1.07e.06 times"),
        (lambda: of_beta_c(1.0).pendulum(1.2), "in A.*it reaches"),
        (lambda: iv_curve(RSJ, IC, drive=(IC, 0.0)), "a positive frequency, in Hz"),
        (lambda: iv_curve(RSJ, IC, drive=(IC, 10.0)), "frequency in Hz, with steps"),
        (lambda: iv_curve(RSJ, IC, drive=(100.0, 1e10)), "amplitude in A"),
        (lambda: iv_curve(RSJ, IC, drive=(IC, 1e10), periods=3), "`periods` must be 16 or more"),
    ],
)
def test_wrong_arguments(call, message):
    with pytest.raises(ValueError, match=message):
        call()
