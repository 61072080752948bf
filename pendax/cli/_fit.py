"""`pendax fit`: the terms of a pendulum's scene from a recording of its motion."""

import argparse
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._error import UserError
from ._numbers import finite, positive, whole
from ._output import output_folder
from ._recording import Recording, read_recording

if TYPE_CHECKING:
    from .._pendulum import Pendulum
    from ..fit import Fit

SUMMARY = "ε, friction, torque and initial state from a recorded motion"
DESCRIPTION = """\
Fit θ̈ + β θ̇ + ε sin θ = τ to a recorded motion: ε, β and the initial state, by least
squares; with --dry the dry friction c of a bearing, against the motion however slow, with
--torque a constant τ and with --offset an offset of the angle as well, without damping with
--no-damping.  Print them with their standard errors and say how well the model
describes the data; write a figure of data, model and residuals, and both as numbers.

Numbers are in rad and in the file's own unit of time."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("swing", type=Path, metavar="SWING.csv",
        help="a header line, a time and an angle column")  # fmt: skip
    add("--time", metavar="NAME", help="time column (default: t…, time…)")
    add("--angle", metavar="NAME", help="angle column (default: theta…_deg, theta…_rad)")
    add("--velocity", metavar="NAME", help="angular velocity column, fitted too (default: none)")
    add("--unit", choices=("deg", "rad"), help="of the angle (default: its name's ending)")
    add("--start", type=finite, default=-math.inf, metavar="T", help="use it from this time on")
    add("--stop", type=finite, default=math.inf, metavar="T", help="use it up to this time")
    add("--unwrap", action="store_true", help="jumps by whole turns are none: it turned over")
    add("--out", type=Path, default=Path("pendax-out"), metavar="FOLDER",
        help="where the files go (default pendax-out)")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing but errors")
    model = parser.add_argument_group("the model")
    add = model.add_argument
    add("--epsilon", type=positive, metavar="E",
        help="ε to start from (default: from the periods of the recording's cycles)")  # fmt: skip
    add("--beta", type=positive, metavar="B", help="β to start from (default: 0.001 √ε)")
    add("--no-damping", action="store_true", help="no β")
    add("--dry", action="store_true", help="dry friction c")
    add("--torque", action="store_true", help="a constant torque τ")
    add("--offset", action="store_true", help="an offset of the angle")
    add("--sigma", type=positive, metavar="S",
        help="standard error of the angles, in their unit (default: by their scatter)")  # fmt: skip
    add("--starts", type=whole(1), default=1, metavar="N",
        help="starts around the first, the best of which is taken (default 1)")  # fmt: skip


def run(arguments: argparse.Namespace) -> None:
    """Everything is computed and drawn before the first file reaches the output folder."""
    import jax

    jax.config.update("jax_enable_x64", True)
    from ._fit_report import fit_report, numbers

    say = (lambda *lines, **how: None) if arguments.quiet else print
    if arguments.no_damping and arguments.beta is not None:
        raise UserError("--beta: expected it without --no-damping")
    path = arguments.swing
    with output_folder(arguments.out) as folder:
        recording = read_recording(
            path,
            arguments.time,
            arguments.angle,
            arguments.unit,
            arguments.start,
            arguments.stop,
            arguments.velocity,
        )
        fit = _fitted(recording, arguments)
        say(fit_report(path, recording, fit))
        model = recording.theta - np.asarray(fit.residuals)
        columns = [recording.ts, recording.theta, model, np.asarray(fit.residuals)]
        names = "t,theta_rad,model_rad,residual_rad"
        if recording.velocity is not None:
            left = np.asarray(fit.velocity_residuals)
            columns += [recording.velocity, recording.velocity - left, left]
            names += ",velocity,velocity_model,velocity_residual"
        np.savetxt(
            folder / "fit.csv", np.column_stack(columns), "%.17g", ",", header=names, comments=""
        )
        (folder / "fit.json").write_text(json.dumps(numbers(recording, fit), indent=2) + "\n")
        _draw(recording, model, folder / "fit.png", path.name)
    names = ("fit.csv", "fit.json", "fit.png")
    say("\nwrote", *(arguments.out / name for name in names), sep="\n  ")


def _fitted(recording: Recording, arguments: argparse.Namespace) -> "Fit[Pendulum]":
    from tqdm import tqdm

    from ..fit import fit_trajectory

    if recording.ts.size == 0:
        raise UserError(f"{arguments.swing}: expected rows between --start and --stop, found none")
    options: dict[str, Any] = {"starts": arguments.starts, "unwrap": arguments.unwrap}
    if arguments.offset:
        options["offset"] = 0.0
    # None: hidden unless on a terminal.  What calls back to a bar is in no cache.
    hidden = True if arguments.quiet or arguments.cache else None
    try:
        guess = _guess(recording, arguments)
        if arguments.sigma is not None:
            sigma = arguments.sigma * recording.radians
            rate = math.sqrt(float(guess.epsilon))
            options["sigma"] = sigma if recording.velocity is None else (sigma, sigma * rate)
        bars = "{l_bar}{bar}| {elapsed}"
        with tqdm(total=1.0, desc="fit", bar_format=bars, delay=0.5, disable=hidden) as bar:
            return fit_trajectory(
                recording.ts,
                recording.theta,
                guess,
                velocity=recording.velocity,
                progress=None if bar.disable else bar.update,
                **options,
            )
    except ValueError as error:
        raise UserError(f"{arguments.swing}: {_plain(str(error))}") from None


def _plain(message: str) -> str:
    """The library's words in those of the command line."""
    for theirs, ours in (
        ("Argument `theta`", "the angle"),
        ("Argument `ts`", "the time"),
        ("Argument `velocity`", "the velocity"),
        ("pass `unwrap=True`", "give --unwrap"),
        ("Pass numpy.radians(theta)", "Give --unit deg"),
    ):
        message = message.replace(theirs, ours)
    return message


def _guess(recording: Recording, arguments: argparse.Namespace) -> "Pendulum":
    from .. import Pendulum
    from ..fit import cycles, fit_frequency

    epsilon = arguments.epsilon
    if epsilon is None:
        found = cycles(recording.ts, recording.theta)
        swings = found.amplitude < 0.95 * math.pi
        if swings.sum() < 2:
            raise UserError(
                f"{arguments.swing}: expected two or more cycles of swinging to guess ε from, "
                f"but found {swings.sum()}; give --epsilon"
            )
        epsilon = float(fit_frequency(found.amplitude[swings], found.period[swings]).model.epsilon)
    beta = None if arguments.no_damping else arguments.beta or 0.0
    # Some tenths of a degree of amplitude a swing.
    dry = 0.01 * epsilon if arguments.dry else None
    return Pendulum(epsilon, beta, 0.0 if arguments.torque else None, dry)


def _draw(recording: Recording, model: np.ndarray, path: Path, name: str) -> None:

    from .. import plot

    with plot.style():
        figure = plot.new_figure(8.0, 6.0)
        above, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
        unit = recording.time_unit
        plot.recorded_motion(above, recording.ts, recording.theta, model, unit=unit)
        above.set(title=name, xlabel="")
        above.legend(loc="upper right", markerscale=3)
        plot.residuals(below, recording.ts, np.degrees(recording.theta - model), unit=unit)
        figure.savefig(path)
