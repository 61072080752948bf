"""Measured I–V loops: reading, branches, and `pendax iv`."""

import csv

import numpy as np
import pytest
from test_junction import IC, R, of_beta_c

from pendax import iv_curve, retrapping_torque
from pendax.cli import main
from pendax.cli._error import UserError
from pendax.cli._loop import read_loop
from pendax.cli._quantity import AMPERE, factor, positive
from pendax.fit import crossings, rising


def loop_file(folder, header="I_uA,V_mV", scales=(1e6, 1e3), beta_c=9.0):
    """From +2 Ic down to −2 Ic and back, with noise on the current."""
    sweep = 2 * IC * np.cos(np.linspace(0, 2 * np.pi, 1201))
    order = np.argsort(sweep)
    curve = iv_curve(of_beta_c(beta_c), sweep[order])
    up, down = np.empty(sweep.size), np.empty(sweep.size)
    up[order], down[order] = curve.voltage_up, curve.voltage_down
    voltage = np.where(np.arange(sweep.size) < 601, down, up)
    noisy = sweep + 0.002 * IC * np.random.default_rng(1).normal(size=sweep.size)
    rows = (f"{i * scales[0]:.9g},{v * scales[1]:.9g}" for i, v in zip(noisy, voltage, strict=True))
    path = folder / "loop.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_branches_of_a_noisy_sweep():
    x = np.concatenate([np.linspace(3, -2, 300), np.linspace(-2, 3, 200), np.linspace(3, 0, 90)])
    truth = np.repeat([False, True, False], [300, 200, 90])
    found = rising(x + 0.01 * np.random.default_rng(0).normal(size=x.size))
    assert (found != truth).sum() < 12  # next to the turning points
    assert rising(np.array([0.0, 1.0, 2.0])).all()
    assert not rising(np.array([2.0, 1.0, 0.0])).any()


@pytest.mark.parametrize(
    ("header", "scales"),
    [
        ("I_uA,V_mV", (1e6, 1e3)),
        ("I (A),U (V)", (1, 1)),
        ("current_µA,voltage_uV", (1e6, 1e6)),
        ("I/mA,V/mV", (1e3, 1e3)),
        ("I_amp,V_volt", (1, 1)),
    ],
)
def test_reading(tmp_path, header, scales):
    loop = read_loop(loop_file(tmp_path, header, scales))
    assert np.max(loop.current) == pytest.approx(2 * IC, rel=0.01)
    assert np.max(loop.voltage) == pytest.approx(2 * IC * R, rel=0.1)
    assert 570 < loop.rising.sum() < 630
    found = crossings(*loop)
    ir = float(retrapping_torque(1 / 3)) * IC
    np.testing.assert_allclose(found.switching, (IC, -IC), rtol=0.03)
    np.testing.assert_allclose(found.retrapping, (ir, -ir), rtol=0.05)


def test_columns_and_units_by_name(tmp_path):
    path = loop_file(tmp_path, "drive,response", (1e3, 1e6))
    loop = read_loop(path, "drive", "response", "mA", "uV")
    assert np.max(loop.current) == pytest.approx(2 * IC, rel=0.01)
    with pytest.raises(UserError, match=r"expected a column like I_A .or --current NAME., but the"):
        read_loop(path)
    with pytest.raises(UserError, match="expected column drive to end in a unit such as _mA"):
        read_loop(path, "drive", "response")
    with pytest.raises(UserError, match="--voltage-unit: expected a unit such as mV, but got 'kg'"):
        read_loop(path, "drive", "response", "mA", "kg")


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("", "it is empty"),
        ("I_A,V_V\n1,2\n3,4", "three or more rows, but found 2"),
        ("I_A,V_V\n1,2\n1,3\n1,4", "a current that is swept, but it is 1 A always"),
        ("I_A,V_V\n1,2\n2,x\n1,4", "line 3: expected a number in column V_V, but got 'x'"),
        ("I_A,V_V\n1,2\n2,nan\n1,4", "line 3: expected a number in column V_V, but got 'nan'"),
    ],
)
def test_unreadable(tmp_path, lines, message):
    path = tmp_path / "loop.csv"
    path.write_text(lines)
    with pytest.raises(UserError, match=message):
        read_loop(path)


def test_quantities():
    parse = positive(AMPERE)
    np.testing.assert_allclose([parse(x) for x in ("112.5uA", "1e-4", "3 mA", "2A")],
                               [112.5e-6, 1e-4, 3e-3, 2])  # fmt: skip
    assert factor("GA", AMPERE) == 1e9
    for wrong in ("-1", "0", "1V", "x", "1e999", "1.2.3"):
        with pytest.raises(Exception, match="expected a positive number in A"):
            parse(wrong)


def test_command(tmp_path, capsys, standard_promotion):
    path = loop_file(tmp_path)
    capacitance = f"{float(of_beta_c(9.0).capacitance):.17g}"
    model = ["--critical-current", "112.5uA", "--resistance", "8", "--capacitance", capacitance]
    assert main(["iv", str(path), "--out", str(tmp_path / "out"), *model]) == 0
    printed = capsys.readouterr().out
    assert "β_c = 9" in printed
    assert "1201 points" in printed
    with (tmp_path / "out" / "iv.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 1201
    off = np.array([float(row["voltage_V"]) - float(row["model_V"]) for row in rows])
    # But for noise where the branches begin.
    assert np.median(np.abs(off)) < 0.005 * IC * R
    assert (tmp_path / "out" / "iv.png").read_bytes().startswith(b"\x89PNG")
    assert main(["iv", str(path), "--out", str(tmp_path / "bare"), "--quiet"]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--resistance", "8"], "--critical-current and --resistance together"),
        (["--critical-current", "112.5", "--resistance", "8"], "must be in A, 10 at most"),
        (["--critical-current", "2", "--resistance", "0.1"], "stays below"),
        (["--current", "none"], "expected a column none"),
    ],
)
def test_command_refuses(tmp_path, capsys, standard_promotion, options, message):
    path = loop_file(tmp_path)
    assert main(["iv", str(path), "--out", str(tmp_path / "out"), *options]) == 2
    printed = capsys.readouterr().err
    assert message in printed
    assert printed.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_measured_loops(shared, tmp_path, capsys, standard_promotion):
    """Of an underdamped and of an overdamped junction, against what their makers read off."""
    folder = shared / "data" / "josephson"
    loop = read_loop(folder / "kit_fprakt_JJ2_iv.csv")
    assert loop.rising.sum() == 2048
    found = crossings(*loop)
    np.testing.assert_allclose(found.switching, (112.5e-6, -113.5e-6), rtol=0.01)
    np.testing.assert_allclose(found.retrapping, (48.7e-6, -49.6e-6), rtol=0.01)
    overdamped = str(folder / "kit_fprakt_JJ3_iv.csv")
    model = ["--critical-current", "116uA", "--resistance", "0.647"]
    assert main(["iv", overdamped, "--out", str(tmp_path / "out"), *model]) == 0
    printed = capsys.readouterr().out
    assert "rms 2.0" in printed
    assert "no hysteresis" in printed
