"""`pendax sweep`: ω(v0) across the separatrix, its critical law, and a measured swing."""

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ._error import UserError
from ._numbers import finite, positive, whole
from ._output import output_folder
from ._recording import write_cycles

if TYPE_CHECKING:
    from .._critical import CriticalLaw
    from .._pendulum import Pendulum
    from .._sweep import Sweep
    from ..fit import Cycles, Fit

    Measured = tuple[Cycles, Fit[Pendulum], str] | None

SUMMARY = "ω(v0) across the separatrix, its critical law, and a measured swing"
DESCRIPTION = """\
Sweep the initial velocity v0 of a pendulum that starts at the bottom, across the
separatrix v0 = 2√ε between swinging and turning over; fit the critical law
ω = A / ln(B/√t), t = |v0 − 2√ε|, on both sides; write the figures and the sweep.

With --data, cut a recorded swing into cycles, fit ε to their periods through the exact
T(amplitude), and draw the measured points over the exact curve."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--epsilon", type=positive, default=1.0, metavar="E",
        help="ε = g/l of the sweep, 1/s² (default 1)")  # fmt: skip
    add("--count", type=whole(100), default=200_000, metavar="N",
        help="initial velocities, before equal ones are dropped (default 200000)")  # fmt: skip
    add("--window", type=positive, nargs=2, default=(1e-12, 1e-6), metavar=("LOW", "HIGH"),
        help="distances t/√ε on which the law is fitted (default 1e-12 1e-6)")  # fmt: skip
    add("--out", type=Path, default=Path("pendax-out"), metavar="FOLDER",
        help="where the files go (default pendax-out)")  # fmt: skip
    add("--format", choices=("csv", "npz"), default="csv",
        help="of the sweep's table (default csv)")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing but errors")

    data = parser.add_argument_group("a measured swing")
    add = data.add_argument
    add("--data", type=Path, metavar="FILE.csv",
        help="a recording: a header line, a time and an angle column")  # fmt: skip
    add("--time", metavar="NAME", help="time column (default: t…, time…)")
    add("--angle", metavar="NAME", help="angle column (default: theta…_deg, theta…_rad)")
    add("--unit", choices=("deg", "rad"), help="of the angle (default: its name's ending)")
    add("--start", type=finite, default=-math.inf, metavar="T",
        help="use the recording from this time on, in its unit")  # fmt: skip


def run(arguments: argparse.Namespace) -> None:
    """Everything is computed and drawn before the first file reaches the output folder."""
    import jax

    jax.config.update("jax_enable_x64", True)
    from ._report import law_report, swing_report

    say = (lambda *lines, **how: None) if arguments.quiet else print
    with output_folder(arguments.out) as folder:
        measured = _measure(arguments)
        swept = _sweep(arguments, say)
        law = _fit(swept, *arguments.window)
        say(law_report(law, swept.epsilon, *arguments.window))
        if measured:
            say(swing_report(arguments.data, *measured))
        names = _write(swept, measured, folder, arguments.format)
    say("\nwrote", *(arguments.out / name for name in names), sep="\n  ")


def _write(swept: "Sweep", measured: "Measured", folder: Path, form: str) -> list[str]:
    """The tables and the figures; their names."""
    # Drawing comes last: matplotlib takes longer to load than all that went before.
    from .. import figures, plot
    from .._sweep import write

    names = [f"sweep.{form}"]
    write(swept, folder / names[0])
    if measured:
        names.append("cycles.csv")
        write_cycles(measured[0], folder / names[-1])
    with plot.style():
        for entry in figures.critical_entries(lambda: swept, measured[:2] if measured else None):
            names.append(f"figure-{entry.name}.png")
            entry.figure().savefig(folder / names[-1])
    return names


def _measure(arguments: argparse.Namespace) -> "Measured":
    if arguments.data is None:
        for option, unset in (
            ("time", None),
            ("angle", None),
            ("unit", None),
            ("start", -math.inf),
        ):
            if getattr(arguments, option) != unset:
                raise UserError(f"--{option}: expected --data FILE.csv with it")
        return None
    from .. import Result
    from ..fit import cycles, fit_frequency
    from ..fit._frequency import period_sigma
    from ._recording import read_recording

    path = arguments.data
    recording = read_recording(
        path, arguments.time, arguments.angle, arguments.unit, arguments.start
    )
    ts, theta = recording.ts, recording.theta
    if ts.size == 0:
        begin = "the start" if arguments.start == -math.inf else f"{arguments.start:g}"
        raise UserError(f"{path}: expected a recording from {begin} on, but it has no rows")
    jump = np.argmax(np.abs(np.diff(theta, prepend=theta[0])))
    if abs(theta[jump] - theta[jump - 1]) > math.pi:
        raise UserError(
            f"{path}: expected an angle without jumps, but it jumps by "
            f"{math.degrees(theta[jump] - theta[jump - 1]):.0f}° before {ts[jump]:g}; unwrap it, "
            "or give its --unit"
        )
    if np.ptp(theta) >= 2 * math.pi:
        raise UserError(
            f"{path}: expected swings below 180°, but the pendulum turns over; "
            "--start takes the part after that"
        )
    found = cycles(ts, theta)
    if found.period.size < 2:
        raise UserError(
            f"{path}: expected a swing of two or more cycles, but found {found.period.size}"
        )
    fit = fit_frequency(found.amplitude, found.period, sigma=period_sigma(found))
    if not fit.result == Result.successful:
        raise UserError(f"{path}: the cycles are out of range for a fit")
    return found, fit, recording.time_unit


def _sweep(arguments: argparse.Namespace, say: Callable) -> "Sweep":
    from tqdm import tqdm

    from .._sweep import sweep, velocities

    v0 = velocities(arguments.epsilon, arguments.count)
    started = time.perf_counter()
    hidden = True if arguments.quiet else None  # None: hidden unless on a terminal
    with tqdm(total=v0.size, desc="sweep", unit="v0", delay=1, disable=hidden) as bar:
        swept = sweep(arguments.epsilon, v0, bar.update)
    seconds = time.perf_counter() - started
    say(
        f"ω of {v0.size} initial velocities v0 from 0 to {v0[-1]:.4g} rad/s at "
        f"ε = {arguments.epsilon:g} 1/s², in {seconds:.2f} s with compiling"
    )
    return swept


def _fit(swept: "Sweep", low: float, high: float) -> "CriticalLaw":
    from .. import Result, fit_critical_law

    if not low < high:
        raise UserError(f"--window: expected LOW < HIGH, but got {low:g} {high:g}")
    x = swept.t / math.sqrt(swept.epsilon)
    window = (x >= low) & (x <= high)
    below = int((window & swept.below).sum())
    above = int(window.sum()) - below
    if min(below, above) < 2:
        raise UserError(
            f"--window: expected two or more velocities of the sweep on each side, but "
            f"{low:g} … {high:g} √ε holds {below} below and {above} above"
        )
    law = fit_critical_law(swept.v0[window], swept.omega[window], swept.epsilon)
    if not law.result == Result.successful:
        raise UserError(f"--window: the law could not be fitted on {low:g} … {high:g} √ε")
    return law
