"""`pendax sweep`: ω(v0) across the separatrix, its critical law, and a measured swing."""

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ._error import UserError

if TYPE_CHECKING:
    from .._critical import CriticalLaw
    from .._sweep import Sweep
    from ..fit import Cycles, Fit

SUMMARY = "ω(v0) across the separatrix, its critical law, and a measured swing"
DESCRIPTION = """\
Sweep the initial velocity v0 of a pendulum that starts at the bottom, across the
separatrix v0 = 2√ε between swinging and turning over; fit the critical law
ω = A / ln(B/√t), t = |v0 − 2√ε|, on both sides; write the figures and the sweep.

With --data, cut a recorded swing into cycles, fit ε to their periods through the exact
T(amplitude), and draw the measured points over the exact curve."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--epsilon", type=_positive, default=1.0, metavar="E",
        help="ε = g/l of the sweep, 1/s² (default 1)")  # fmt: skip
    add("--count", type=_count, default=200_000, metavar="N",
        help="initial velocities, before equal ones are dropped (default 200000)")  # fmt: skip
    add("--window", type=_positive, nargs=2, default=(1e-12, 1e-6), metavar=("LOW", "HIGH"),
        help="distances t, rad/s, on which the law is fitted (default 1e-12 1e-6)")  # fmt: skip
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
    add("--start", type=_number, default=-math.inf, metavar="T",
        help="use the recording from this time on, in its unit")  # fmt: skip


def run(arguments: argparse.Namespace) -> None:
    """Everything is computed and drawn before the first file reaches the output folder."""
    import jax

    jax.config.update("jax_enable_x64", True)
    low, high = arguments.window
    if not low < high:
        raise UserError(f"--window: expected LOW < HIGH, but got {low:g} {high:g}")
    say = (lambda *lines, **how: None) if arguments.quiet else print

    measured = _measure(arguments) if arguments.data else None
    swept = _sweep(arguments, say)
    law = _fit(swept, low, high)

    # Drawing comes last: matplotlib takes longer to load than all of the above.
    from .. import figures
    from .._sweep import write
    from ._output import output_folder
    from ._report import law_report, swing_report

    say(law_report(law, swept.epsilon, low, high))
    if measured:
        say(swing_report(arguments.data, *measured))
    names = [f"sweep.{arguments.format}", *(f"figure-{n}.png" for n in figures.CRITICAL)]
    with output_folder(arguments.out) as folder:
        write(swept, folder / names[0])
        for name, draw in zip(names[1:], figures.CRITICAL.values(), strict=True):
            draw(swept, measured[:2] if measured else None).savefig(folder / name)
    say("\nwrote", *(arguments.out / name for name in names), sep="\n  ")


def _measure(arguments: argparse.Namespace) -> "tuple[Cycles, Fit, str]":
    from ..fit import cycles, fit_frequency
    from ..fit._frequency import period_sigma
    from ._recording import read_recording

    path = arguments.data
    recording = read_recording(
        path, arguments.time, arguments.angle, arguments.unit, arguments.start
    )
    found = cycles(recording.ts, recording.theta)
    if found.period.size < 2:
        raise UserError(
            f"{path}: expected a swing of two or more cycles, but found {found.period.size}"
        )
    if not (found.amplitude < math.pi).all():
        raise UserError(f"{path}: expected swings below 180°, but the recording turns over")
    fit = fit_frequency(found.amplitude, found.period, sigma=period_sigma(found))
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

    window = (swept.t >= low) & (swept.t <= high)
    below = int((window & swept.below).sum())
    if min(below, int(window.sum()) - below) < 2:
        raise UserError(
            f"--window: expected two or more velocities of the sweep on each side, but "
            f"{low:g} … {high:g} rad/s holds {below} below and {int(window.sum()) - below} above"
        )
    law = fit_critical_law(swept.v0[window], swept.omega[window], swept.epsilon)
    if not law.result == Result.successful:
        raise UserError(f"--window: the law could not be fitted on {low:g} … {high:g} rad/s")
    return law


def _positive(text: str) -> float:
    value = _number(text)
    if not (0 < value < math.inf):
        raise argparse.ArgumentTypeError(f"expected a positive number, but got {text}")
    return value


def _count(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 100:
        raise argparse.ArgumentTypeError(f"expected a whole number from 100 on, but got {text}")
    return value


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected a number, but got {text!r}") from None
