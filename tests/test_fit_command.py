"""`pendax fit` as a user meets it."""

import json

import numpy as np
import pytest

from pendax import Pendulum, simulate
from pendax.cli import main

TS = np.linspace(0, 20, 400)


def recording(folder, rows, header="t_s,theta_deg,omega_deg"):
    path = folder / "swing.csv"
    lines = (",".join(f"{x:.9g}" for x in row) for row in rows)
    path.write_text("\n".join([header, *lines]) + "\n")
    return str(path)


@pytest.fixture(scope="module")
def swing():
    run = simulate(Pendulum(6.0, 0.1), TS, 0.0, 1.5)
    noise = 0.2 * np.random.default_rng(2).normal(size=TS.size)
    speed = np.degrees(run.v) + 0.5 * np.random.default_rng(3).normal(size=TS.size)
    return np.column_stack([TS, np.degrees(run.theta) + noise, speed])


def test_table_figure_and_numbers(tmp_path, capsys, standard_promotion, swing):
    path, out = recording(tmp_path, swing), tmp_path / "out"
    assert main(["fit", path, "--velocity", "omega_deg", "--start", "1", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "381 samples from 1.00250627 to 20 s" in printed or "from 1.00251 to 20 s" in printed
    assert "θ̈ + β θ̇ + ε sin θ = 0" in printed
    found = json.loads((out / "fit.json").read_text())
    for name, true in (("epsilon", 6.0), ("beta", 0.1)):
        value, error = found["parameters"][name]["value"], found["parameters"][name]["error"]
        assert abs(value - true) < 4 * error < 0.02 * true
    assert abs(found["runs"]) < 4
    rows = np.loadtxt(out / "fit.csv", delimiter=",", skiprows=1)
    assert np.std(np.degrees(rows[:, 3])) == pytest.approx(0.2, rel=0.15)
    np.testing.assert_allclose(rows[:, 1] - rows[:, 2], rows[:, 3], atol=1e-14)
    assert (out / "fit.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        (lambda x: x * [1, 0, 1], [], "the angle must move|cycles of swinging"),
        (lambda x: x * [1, 0, 1], ["--epsilon", "6"], "the angle must move"),
        (lambda x: x[:3], ["--epsilon", "6"], "more samples than parameters"),
        (lambda x: x, ["--unit", "rad"], "cycles of swinging"),
        (lambda x: x, ["--unit", "rad", "--epsilon", "6"], "degrees? Give --unit deg"),
        (lambda x: x, ["--start", "99"], "found none"),
        (lambda x: x, ["--beta", "0.1", "--no-damping"], "expected it without --no-damping"),
        (lambda x: x, ["--epsilon", "-6"], "expected a positive number"),
        (lambda x: x * [1, 9, 1] % [99, 360, 360], ["--epsilon", "6"], "give --unwrap"),
    ],
)
def test_refuses(tmp_path, capsys, standard_promotion, swing, change, options, message):
    path = recording(tmp_path, change(swing))
    arguments = ["fit", path, "--out", str(tmp_path / "out"), *options]
    try:
        code = main(arguments)
    except SystemExit as stop:
        code = stop.code
    assert code == 2
    printed = capsys.readouterr().err
    assert any(part in printed for part in message.split("|")), printed
    assert printed.count("\n") == 1
    assert not (tmp_path / "out").exists()
