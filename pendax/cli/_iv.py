"""`pendax iv`: a measured I–V loop, its branches, and a model's over it."""

import argparse
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..fit import Crossings, crossings
from ._error import UserError
from ._loop import Loop, read_loop
from ._output import output_folder
from ._quantity import AMPERE, FARAD, OHM, positive

if TYPE_CHECKING:
    from ..josephson import JosephsonJunction

SUMMARY = "a junction's measured I–V loop, and a model's over it"
DESCRIPTION = """\
Read a measured I–V loop, separate its branches, current rising and falling, and print
where they leave zero voltage and return to it; write both with a figure.

With --fit, Ic, R and, of a loop with hysteresis, C are fitted and printed with their standard
errors, and with what the model does not describe.

With --critical-current and --resistance, and --capacitance for a junction with hysteresis,
that model's curve is drawn instead.  Values are in A, ohm and F, or with a unit of their
own: --critical-current 112.5uA --resistance 8 --capacitance 0.4pF."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("loop", type=Path, metavar="LOOP.csv",
        help="a header line, a current and a voltage column")  # fmt: skip
    add("--current", metavar="NAME", help="current column (default: I…, current…)")
    add("--voltage", metavar="NAME", help="voltage column (default: V…, U…, voltage…)")
    add("--current-unit", metavar="UNIT", help="as uA (default: the ending of the column's name)")
    add("--voltage-unit", metavar="UNIT", help="as mV (default: the ending of the column's name)")
    add("--out", type=Path, default=Path("pendax-out"), metavar="FOLDER",
        help="where the files go (default pendax-out)")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing but errors")
    add("--fit", action="store_true", help="fit the model to the loop")
    model = parser.add_argument_group("the model")
    add = model.add_argument
    add("--critical-current", type=positive(AMPERE), metavar="IC", help="Ic, A")
    add("--resistance", type=positive(OHM), metavar="R", help="R, ohm")
    add("--capacitance", type=positive(FARAD), metavar="C",
        help="C, F (default: none, the first-order junction)")  # fmt: skip


def run(arguments: argparse.Namespace) -> None:
    """Everything is computed and drawn before the first file reaches the output folder."""
    import jax

    jax.config.update("jax_enable_x64", True)
    say = (lambda *lines, **how: None) if arguments.quiet else print
    junction = _junction(arguments)
    loop = read_loop(
        arguments.loop,
        arguments.current,
        arguments.voltage,
        arguments.current_unit,
        arguments.voltage_unit,
    )
    if arguments.fit and junction is not None:
        raise UserError("--fit: expected it without a model of your own")
    names = ["iv.csv", "iv.png"]
    with output_folder(arguments.out) as folder:
        say(_report(arguments.loop, loop))
        if arguments.fit:
            names.append("iv.json")
            junction, model = _fitted(loop, arguments, say, folder / names[-1])
        else:
            model = None if junction is None else _voltages(junction, loop)
        if junction is not None and model is not None and not arguments.fit:
            say(_comparison(loop, junction, model))
        _write(loop, model, folder / "iv.csv")
        _draw(loop, junction, model, folder / "iv.png")
    say("\nwrote", *(arguments.out / name for name in names), sep="\n  ")


def _fitted(loop: Loop, arguments: argparse.Namespace, say: Callable, path: Path):
    """The junction and its voltages, offsets included; what is known of them goes to `path`."""
    from tqdm import tqdm

    from ..fit import fit_junction
    from ._fit_report import junction_numbers, junction_report

    hidden = True if arguments.quiet else None  # None: hidden unless on a terminal
    try:
        with tqdm(total=None, desc="fit", unit=" steps", delay=0.5, disable=hidden) as bar:
            fit = fit_junction(
                loop.current, loop.voltage, rising=loop.rising, progress=lambda _: bar.update()
            )
    except ValueError as error:
        raise UserError(f"{arguments.loop}: {error}") from None
    say(junction_report(fit))
    path.write_text(json.dumps(junction_numbers(fit), indent=2) + "\n")
    return fit.model, loop.voltage - np.asarray(fit.residuals)


def _junction(arguments: argparse.Namespace) -> "JosephsonJunction | None":
    from ..josephson import JosephsonJunction

    given = arguments.critical_current, arguments.resistance
    if given == (None, None) and arguments.capacitance is None:
        return None
    if None in given:
        raise UserError("the model: expected --critical-current and --resistance together")
    try:
        return JosephsonJunction(*given, arguments.capacitance)
    except ValueError as error:
        raise UserError(f"the model: {error}") from None


def _voltages(junction: "JosephsonJunction", loop: Loop) -> np.ndarray:
    """The model's at each current, of the branch it was measured on."""
    from ..josephson import iv_curve

    order = np.argsort(loop.current)
    try:
        curve = iv_curve(junction, loop.current[order])
    except ValueError as error:
        raise UserError(f"the model: {error}") from None
    voltages = np.empty((2, loop.current.size))
    voltages[:, order] = curve.voltage_down, curve.voltage_up
    return np.where(loop.rising, voltages[1], voltages[0])


def _report(path: Path, loop: Loop) -> str:
    return (
        f"{path}: {loop.current.size} points, {loop.rising.sum()} with rising current, "
        f"I from {_amperes(loop.current.min())} to {_amperes(loop.current.max())}\n"
        + _branches(crossings(*loop))
    )


def _comparison(loop: Loop, junction: "JosephsonJunction", model: np.ndarray) -> str:
    unit, ir = float(junction.critical_current), float(junction.retrapping_current)
    beta_c, volts = float(junction.stewart_mccumber), float(junction.characteristic_voltage)
    off = np.abs(loop.voltage - model)
    return (
        f"model: Ic = {_amperes(unit)}, Ir = {_amperes(ir)}, β_c = {beta_c:.5g}, "
        f"Ic R = {1e3 * volts:.5g} mV\n"
        f"measured − model: rms {1e6 * math.sqrt(np.mean(off**2)):.4g} µV, "
        f"half of the points within {1e6 * np.median(off):.4g} µV"
    )


def _branches(found: Crossings) -> str:
    both = _both(found.switching), _both(found.retrapping)
    near = np.abs(np.subtract(found.switching, found.retrapping))
    if np.all(near < 0.02 * np.abs(found.switching)):
        return (
            f"no hysteresis: |V| passes a twentieth of its largest value at {both[0]}, "
            "and the critical current is below that"
        )
    return f"leaves zero voltage at {both[0]}, returns to it at {both[1]}"


def _amperes(x: float) -> str:
    return "–" if math.isnan(x) else f"{1e6 * x:.5g} µA"


def _both(pair: tuple[float, float]) -> str:
    return " and ".join(_amperes(x) for x in pair)


def _write(loop: Loop, model: np.ndarray | None, path: Path) -> None:
    columns = {"current_A": loop.current, "voltage_V": loop.voltage, "rising": loop.rising}
    if model is not None:
        columns["model_V"] = model
    table = np.column_stack([np.asarray(x, float) for x in columns.values()])
    np.savetxt(path, table, "%.12g", ",", header=",".join(columns), comments="")


def _draw(loop: Loop, junction, model: np.ndarray | None, path: Path) -> None:

    from .. import plot
    from ..josephson import iv_curve

    with plot.style():
        figure = plot.new_figure(7.5, 5.0 if model is None else 6.5)
        rows = 1 if model is None else 2
        axes = figure.subplots(rows, 1, sharex=True, height_ratios=(3, 1)[:rows], squeeze=False)
        ax = plot.measured_loop(axes[0, 0], loop.current, loop.voltage, loop.rising)
        if junction is not None:
            ends = np.min(loop.current), np.max(loop.current)
            plot.iv_curve(ax, iv_curve(junction, np.linspace(*ends, 2001)), label="model")
        ax.legend(loc="upper left")
        if model is not None:
            below = axes[1, 0]
            plot.measured_loop(below, loop.current, loop.voltage - model, loop.rising)
            below.set_ylabel("measured − model\n" + below.get_ylabel().partition(" ")[2])
            ax.set_xlabel("")
        figure.savefig(path)
