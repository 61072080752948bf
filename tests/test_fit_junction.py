"""Ic, R and C from I–V loops: made ones, measured ones, and what is no loop."""

import json

import jax.numpy as jnp
import numpy as np
import pytest
from test_junction import IC, R, of_beta_c
from test_loop import loop_file

from pendax import JosephsonJunction, Result, fit_junction, iv_curve
from pendax.cli import main

SWEEP = 3 * IC * np.cos(np.linspace(0, 2 * np.pi, 1200))
FALLS = np.arange(1200) < 600


def loop(junction, current=SWEEP, falls=FALLS):
    order = np.argsort(current)
    curve = iv_curve(junction, current[order])
    voltages = np.empty((2, current.size))
    voltages[:, order] = curve.voltage_up, curve.voltage_down
    return np.where(falls, voltages[1], voltages[0])


def inside(fit, name, true):
    found = getattr(fit.model, name)
    return abs(float(found) - true) < 3 * float(fit.errors[name])


@pytest.mark.full  # half a minute
def test_underdamped():
    """Noise, offsets of both instruments, and the hysteresis that tells C."""
    rng = np.random.default_rng(3)
    true = of_beta_c(9.0)
    measured = SWEEP + 0.03 * IC
    noise = 0.004 * IC * R * rng.normal(size=SWEEP.size)
    fit = fit_junction(measured, loop(true) + 2e-6 + noise)
    assert fit.result == Result.successful
    assert fit.notes == ()
    assert list(fit.errors) == ["critical_current", "resistance", "capacitance", "current_offset"]
    # The loop is sampled in steps of up to 0.016 Ic.
    assert float(fit.model.critical_current) == pytest.approx(IC, rel=0.012)
    assert float(fit.model.resistance) == pytest.approx(R, rel=0.002)
    assert float(fit.model.capacitance) == pytest.approx(float(true.capacitance), rel=0.06)
    for name, value in (("resistance", R), ("capacitance", float(true.capacitance))):
        assert inside(fit, name, value)
    np.testing.assert_allclose(fit.offset, [0.03 * IC, 2e-6], rtol=0.4)
    running = np.abs(np.asarray(fit.residuals)) < 0.02 * IC * R
    assert running.mean() > 0.98


def test_overdamped_has_no_capacitance():
    true = JosephsonJunction(IC, R)
    guess = of_beta_c(0.5)
    fit = fit_junction(SWEEP, loop(true), guess, progress=lambda share: None)
    assert fit.model.capacitance is None
    assert "no hysteresis" in fit.notes[0]
    assert float(fit.model.critical_current) == pytest.approx(IC, rel=1e-4)
    assert float(fit.model.resistance) == pytest.approx(R, rel=1e-5)
    held = fit_junction(SWEEP, loop(true), guess, fixed=("critical_current",))
    assert list(held.errors) == ["resistance", "current_offset"]
    assert held.model.critical_current == guess.critical_current


def test_half_a_loop_has_no_offset():
    true = JosephsonJunction(IC, R)
    upper = SWEEP > 0
    fit = fit_junction(SWEEP[upper], loop(true)[upper])
    assert list(fit.errors) == ["critical_current", "resistance"]
    assert float(fit.model.resistance) == pytest.approx(R, rel=1e-5)


def test_what_the_model_has_not_is_left_out_and_named():
    """A gap: beyond 2 Ic the voltage hardly grows."""
    true = JosephsonJunction(IC, R)
    voltage = loop(true, 1.5 * SWEEP)
    knee = 3.3 * IC * R
    bent = np.clip(voltage, -knee, knee) + 0.1 * (voltage - np.clip(voltage, -knee, knee))
    fit = fit_junction(1.5 * SWEEP, bent)
    # To 5 % of the largest voltage the bend's beginning is described.
    assert float(fit.model.resistance) == pytest.approx(R, rel=0.025)
    assert "more than 5%" in fit.notes[-1]
    assert "fitted without: |I| from" in fit.notes[-1]


def test_a_robust_loss_forgives_outliers():
    voltage = loop(JosephsonJunction(IC, R))
    voltage[::15] *= 0.5
    robust = fit_junction(SWEEP, voltage, loss=lambda r: jnp.log1p(r * r / 2))
    plain = fit_junction(SWEEP, voltage, loss=lambda r: r * r / 2)
    off = [abs(float(fit.model.resistance) / R - 1) for fit in (robust, plain)]
    assert off[0] < 1e-3 < 1e-2 < off[1]


@pytest.mark.full  # fits three quarters of a minute
def test_retrapping_far_below_the_largest_voltage():
    """β_c = 150: the branch retraps at a tenth of Ic; parts of loops, offsets of either kind."""
    true = of_beta_c(150.0)
    noise = 0.001 * IC * R * np.random.default_rng(5).normal(size=SWEEP.size)
    voltage = loop(true) + noise
    rises = ~FALLS
    for current, measured in (
        (SWEEP, voltage + 0.3 * IC * R),
        (SWEEP + 0.2 * IC, voltage),
        (SWEEP[rises], voltage[rises]),
    ):
        fit = fit_junction(current, measured)
        assert fit.result == Result.successful
        assert float(fit.model.critical_current) == pytest.approx(IC, rel=0.02)
        assert float(fit.model.resistance) == pytest.approx(R, rel=0.002)
        assert inside(fit, "capacitance", float(true.capacitance))
        assert 0 < float(fit.errors["capacitance"]) < 0.4 * float(true.capacitance)


BAD = [
    ({"current": SWEEP[:9], "voltage": SWEEP[:9]}, "16 or more points"),
    ({"voltage": np.where(SWEEP > IC, np.nan, SWEEP)}, "`voltage` must be finite, but got nan at"),
    ({"voltage": np.zeros(1200)}, "`voltage` must vary, but it is 0 always"),
    ({"current": 1e6 * SWEEP}, "`current` must be in A, 10 at most"),
    ({"voltage": 1e6 * SWEEP}, "`voltage` must be in V, 1 at most"),
    ({"current": SWEEP[:500]}, "one axis of equal length"),
    ({"fixed": ("voltage",)}, "`fixed` must name some of critical_current, resistance"),
    ({"mask": np.ones(1200)}, "`mask` must be booleans"),
    (
        {"current": SWEEP[:300], "voltage": loop(JosephsonJunction(IC, R))[:300]},
        "must show where the junction leaves zero",
    ),
    ({"rising": np.ones(3, bool)}, "`rising` must be booleans"),
    (
        {"current": 0.4 * SWEEP, "voltage": loop(JosephsonJunction(IC, R), 0.4 * SWEEP)},
        "must reach further beyond",
    ),
]


@pytest.mark.parametrize(("wrong", "message"), BAD, ids=[x[1][:28] for x in BAD])
def test_bad_input(wrong, message):
    given = {"current": SWEEP, "voltage": loop(JosephsonJunction(IC, R))} | wrong
    current, voltage = given.pop("current"), given.pop("voltage")
    with pytest.raises(ValueError, match=message):
        fit_junction(current, voltage, **given)


def test_measured_overdamped_loop(shared, tmp_path, capsys, standard_promotion):
    """A shunted junction, by the command line."""
    path = str(shared / "data" / "josephson" / "kit_fprakt_JJ3_iv.csv")
    assert main(["iv", path, "--fit", "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "first-order junction is fitted" in printed
    found = json.loads((tmp_path / "out" / "iv.json").read_text())
    assert found["parameters"]["critical_current"]["value"] == pytest.approx(116e-6, rel=0.02)
    assert found["parameters"]["resistance"]["value"] == pytest.approx(0.647, rel=0.01)
    rows = np.loadtxt(tmp_path / "out" / "iv.csv", delimiter=",", skiprows=1)
    far = np.abs(rows[:, 0]) > 1.5 * 116e-6
    assert np.sqrt(np.mean((rows[far, 1] - rows[far, 3]) ** 2)) < 2e-6


@pytest.mark.full
def test_measured_underdamped_loop(shared):
    path = shared / "data" / "josephson" / "kit_fprakt_JJ2_iv.csv"
    voltage, current = np.loadtxt(path, delimiter=",", skiprows=1).T
    fit = fit_junction(current, voltage)
    assert float(fit.model.critical_current) == pytest.approx(112.5e-6, rel=0.01)
    assert float(fit.model.resistance) == pytest.approx(8.0, rel=0.02)
    assert float(fit.model.stewart_mccumber) == pytest.approx(8.65, rel=0.1)
    # Its gap is beyond the model.
    below = np.abs(current) < 310e-6
    off = np.abs(np.asarray(fit.residuals)) / np.abs(voltage).max()
    assert np.mean(off[below] < 0.05) > 0.998
    assert "|V| 2.5" in fit.notes[-1]


def test_command_refuses_both(tmp_path, capsys, standard_promotion):
    path = str(loop_file(tmp_path))
    model = ["--critical-current", "112.5uA", "--resistance", "8"]
    assert main(["iv", path, "--fit", *model, "--out", str(tmp_path / "out")]) == 2
    assert "without a model of your own" in capsys.readouterr().err
