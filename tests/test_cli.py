"""The command line as a user meets it: one process a run, real files."""

import csv
import os
import subprocess
import sys

import jax
import numpy as np
import pytest

from pendax.cli import main
from pendax.cli._cache import keep_programs
from pendax.cli._error import UserError
from pendax.cli._output import output_folder
from pendax.cli._recording import read_recording

FIGURES = [f"figure-{n}.png" for n in (8, 9, 11, 12, 13)]


def swing_file(folder, header="t_s,theta_deg", rows=None):
    if rows is None:
        ts = np.arange(0, 12, 0.01)
        rows = [f"{t:.3f},{40 * np.cos(6 * t):.4f}" for t in ts]
    path = folder / "swing.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


@pytest.fixture(scope="module")
def main_job(tmp_path_factory):
    """`python -m pendax` in a process of its own, without this suite's settings."""
    folder = tmp_path_factory.mktemp("job")
    data = swing_file(folder)
    command = [sys.executable, "-m", "pendax", "--out", "result", "--data", str(data)]
    return folder, subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_main_job_writes_and_says_what(main_job):
    folder, run = main_job
    assert run.returncode == 0, run.stderr
    written = sorted(path.name for path in (folder / "result").iterdir())
    assert written == sorted([*FIGURES, "cycles.csv", "sweep.csv"])
    assert sorted(path.name for path in folder.iterdir()) == ["result", "swing.csv"]
    for name in written:
        assert f"result/{name}" in run.stdout
    for name in FIGURES:
        assert (folder / "result" / name).read_bytes().startswith(b"\x89PNG")


def test_main_job_prints_the_law_and_the_swing(main_job):
    lines = main_job[1].stdout.splitlines()
    below, above = (next(x.split() for x in lines if x.startswith(s)) for s in ("below", "above "))
    for row, amplitude in ((below, np.pi / 2), (above, np.pi)):
        fitted, theory, off = (float(x) for x in row[1:4])
        assert theory == pytest.approx(amplitude, abs=1e-9)
        assert fitted == pytest.approx(amplitude, rel=1e-6)
        assert off == pytest.approx(fitted / theory - 1, abs=1e-8)
        assert float(row[4]) == pytest.approx(4, rel=1e-5)
    ratio = next(x for x in lines if x.startswith("A above / A below"))
    assert float(ratio.split()[6]) == pytest.approx(2, abs=1e-6)
    small = next(x for x in lines if x.startswith("small-angle period"))
    period = float(small.split("=")[1].split("±")[0])
    assert period == pytest.approx(2 * np.pi / 6 / 1.0313, rel=2e-3)  # T(40°)/T0 = 1.0313


def test_table_of_the_sweep(main_job):
    with (main_job[0] / "result" / "sweep.csv").open() as file:
        reader = csv.reader(file)
        assert next(reader) == ["v0_rad_per_s", "t_rad_per_s", "omega_rad_per_s"]
        v0, t, omega = np.array([[float(x) for x in row] for row in reader]).T
    assert v0.size >= 100_000
    assert t[omega == 0].tolist() == [0.0]
    np.testing.assert_allclose(t, np.abs(v0 - 2), rtol=5e-16)


def test_npz_and_quiet(tmp_path, capsys):
    out = tmp_path / "deep" / "er"
    arguments = ["sweep", "--out", str(out), "--format", "npz", "--quiet", "--count", "5000"]
    assert main([*arguments, "--window", "1e-9", "1e-4", "--epsilon", "9.81"]) == 0
    assert capsys.readouterr().out == ""
    with np.load(out / "sweep.npz") as table:
        assert table["epsilon"] == 9.81
        omega = table["omega_rad_per_s"]
    assert omega.size > 3000
    np.testing.assert_allclose(omega[0], np.sqrt(9.81), rtol=1e-15)


ROWS = [f"{0.01 * i:.2f},{np.cos(0.06 * i):.5f}" for i in range(400)]
BAD = {
    "epsilon": (["--epsilon", "-1"], "expected a positive number, but got -1"),
    "epsilon text": (["--epsilon", "one"], "expected a number, but got 'one'"),
    "count": (["--count", "3"], "expected a whole number from 100 on, but got 3"),
    "window": (["--window", "1", "0.1"], "--window: expected LOW < HIGH, but got 1 0.1"),
    "narrow window": (["--window", "1e-18", "1e-17", "--count", "999"], "--window: expected two"),
    "start without data": (["--start", "1"], "--start: expected --data FILE.csv with it"),
    "command": (["swep"], "invalid choice: 'swep'"),
}
BAD_FILES = {
    "empty": ("", [], "it is empty"),
    "header only": ("t_s,theta_deg", [], "expected a recording from the start on, but it has no rows"),
    "no time": ("x,theta_deg", ROWS, "expected a column like t_s (or --time NAME), but the columns are x, theta_deg"),
    "no angle": ("t_s,y", ROWS, "expected a column like theta_deg or theta_rad (or --angle NAME)"),
    "text": ("t_s,theta_deg", [*ROWS[:7], "0.07,high"], "line 9: expected a number in column theta_deg, but got 'high'"),
    "nan": ("t_s,theta_deg", [*ROWS[:7], "0.07,nan"], "line 9: expected a number in column theta_deg, but got 'nan'"),
    "short row": ("t_s,theta_deg", [*ROWS[:7], "0.07"], "line 9: expected a number in column theta_deg, but got ''"),
    "backwards": ("t_s,theta_deg", [*ROWS[:7], ROWS[2]], "line 9: expected t_s to increase, but 0.02 follows 0.06"),
    "one cycle": ("t_s,theta_deg", ROWS[:130], "expected a swing of two or more cycles, but found"),
    "rotation": ("t_s,theta_rad", [f"{i},{4 * np.cos(0.2 * i)}" for i in range(400)], "the pendulum turns over"),
    "wrapped": ("t_s,theta_deg", [f"{i},{(170 + 20 * i) % 360 - 180}" for i in range(400)], "expected an angle without jumps, but it jumps by -340° before 1"),
    "late start": ("t_s,theta_deg", ROWS, "expected a recording from 1000 on, but it has no rows"),
}  # fmt: skip
# ruff: noqa: E501


def fails(arguments, message, folder, capsys):
    """Exit status 2, one line on stderr that says `message`, no output folder."""
    before = sorted(folder.iterdir())
    try:
        status = main([*arguments, "--out", str(folder / "out")])
    except SystemExit as exit:
        status = exit.code
    error = capsys.readouterr().err
    assert status == 2
    assert message in error
    assert "Traceback" not in error
    assert error.startswith("pendax: error: ")
    assert error.count("\n") == 1
    assert sorted(folder.iterdir()) == before
    return error


@pytest.mark.parametrize("case", BAD)
def test_bad_options(case, tmp_path, capsys):
    fails(*BAD[case], tmp_path, capsys)


@pytest.mark.parametrize("case", BAD_FILES)
def test_bad_files(case, tmp_path, capsys):
    header, rows, message = BAD_FILES[case]
    path = swing_file(tmp_path, header, rows)
    late = ["--start", "1000"] if case == "late start" else []
    error = fails(["--data", str(path), *late], message, tmp_path, capsys)
    assert str(path) in error
    assert len(error.splitlines()) == 1


def test_missing_file(tmp_path, capsys):
    fails(
        ["--data", str(tmp_path / "no.csv")], "no.csv: no such file or directory", tmp_path, capsys
    )
    fails(["--data", str(tmp_path)], "is a directory", tmp_path, capsys)


def test_reader_that_stops_early(tmp_path):
    command = f"{sys.executable} -m pendax --count 500 --window 1e-9 1e-3 --out o | head -n 1"
    run = subprocess.run(
        command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert "ω of" in run.stdout
    assert run.stderr == ""


def test_output_into_a_file_or_after_a_failure(tmp_path, capsys):
    (tmp_path / "out").write_text("mine")
    fails(["--count", "500", "--window", "1e-9", "1"], "but it is a file", tmp_path, capsys)
    assert (tmp_path / "out").read_text() == "mine"

    folder = tmp_path / "kept"
    folder.mkdir()
    (folder / "a").write_text("old")

    def fail():
        with output_folder(folder) as scratch:
            (scratch / "a").write_text("half")
            raise UserError("late")

    with pytest.raises(UserError, match="late"):
        fail()
    assert [(path.name, path.read_text()) for path in folder.iterdir()] == [("a", "old")]


def test_recording_columns_units_and_start(tmp_path):
    path = swing_file(tmp_path, "n,clock,phi", ["0,1.0,90", "1,2.0,180", "", "2,3.5,-90"])
    ts, theta, unit, *_ = read_recording(path, "clock", "phi", "deg", start=1.5)
    assert ts.tolist() == [2.0, 3.5]
    np.testing.assert_allclose(theta, [np.pi, -np.pi / 2])
    assert unit == "time units"
    with pytest.raises(UserError, match="expected column phi to end in _deg or _rad, or --unit"):
        read_recording(path, "clock", "phi")
    with pytest.raises(UserError, match="expected a column omega, but the columns are n, clock"):
        read_recording(path, "clock", "omega")
    path = swing_file(tmp_path, "\ufefftime_ms, theta_rad", ["0, 1", "1, 2"])
    assert read_recording(path).time_unit == "ms"
    assert read_recording(path).theta.tolist() == [1, 2]


@pytest.mark.parametrize("arguments", [["--help"], ["sweep", "--help"], ["--version"]])
def test_help(arguments, capsys):
    with pytest.raises(SystemExit) as exit:
        main(arguments)
    assert exit.value.code == 0
    assert "pendax" in capsys.readouterr().out


def test_measured_swing_of_the_record(shared, tmp_path, capsys):
    path = shared / "data" / "pendulum" / "benard_free_swing_45deg.csv"
    arguments = ["--data", str(path), "--start", "0.129", "--count", "3000"]
    assert main([*arguments, "--window", "1e-9", "1e-5", "--out", str(tmp_path / "o")]) == 0
    small = next(x for x in capsys.readouterr().out.splitlines() if x.startswith("small-angle"))
    assert 0.5731 < float(small.split("=")[1].split("±")[0]) < 0.5746


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="other places for caches")
def test_cache_is_filled_and_used(tmp_path):
    command = [sys.executable, "-m", "pendax", "sweep", "--cache", "--quiet", "--count", "200"]
    command += ["--window", "1e-9", "1", "--out", str(tmp_path / "out")]
    plain = {k: v for k, v in os.environ.items() if not k.startswith("JAX_")}
    plain["XDG_CACHE_HOME"] = str(tmp_path / "home")
    folder = tmp_path / "home" / "pendax"

    def run(**environment):
        environment = plain | environment
        run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
        return run.stderr, sorted(path.name for path in folder.iterdir())

    said, kept = run()
    assert said == ""
    assert any(name.startswith("jit__evaluate") for name in kept)
    said, still = run(JAX_EXPLAIN_CACHE_MISSES="1")
    assert "PERSISTENT COMPILATION CACHE MISS" not in said
    assert "Not writing" not in said  # what calls back to Python
    assert still == kept


@pytest.fixture
def settings(monkeypatch):
    """JAX's, as they were before."""
    names = ("compilation_cache_dir", *(f"persistent_cache_min_{x}" for x in CACHE_LIMITS))
    before = {f"jax_{name}": getattr(jax.config, f"jax_{name}") for name in names}
    for name in before:
        monkeypatch.delenv(name.upper(), raising=False)
    yield monkeypatch
    for name, value in before.items():
        jax.config.update(name, value)


CACHE_LIMITS = ("compile_time_secs", "entry_size_bytes")


def test_cache_where_jax_has_its_own(settings, tmp_path):
    settings.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path / "mine"))
    settings.setenv("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "100")
    before = jax.config.jax_persistent_cache_min_entry_size_bytes
    keep_programs()
    assert jax.config.jax_compilation_cache_dir == str(tmp_path / "mine")
    assert jax.config.jax_persistent_cache_min_compile_time_secs == 0
    assert jax.config.jax_persistent_cache_min_entry_size_bytes == before


def test_cache_that_can_not_be_written(settings, tmp_path, capsys):
    (tmp_path / "file").write_text("mine")
    settings.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path / "file" / "sub"))
    keep_programs()
    said = capsys.readouterr().err
    assert said.startswith("pendax: no cache: ")
    assert str(tmp_path / "file" / "sub") in said
    assert said.count("\n") == 1
    assert jax.config.jax_compilation_cache_dir is None
