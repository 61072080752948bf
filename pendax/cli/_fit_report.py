"""What `pendax fit` and `pendax iv --fit` print and write about a fit."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from .._pendulum import Pendulum
from .._results import Result
from ..fate import settle
from ..fit import Fit
from ..fit._judgement import KEPT
from ..josephson import JosephsonJunction
from ._recording import Recording

_NOISE = "and the standard errors, which take them for noise, are too small"
_FEWER = "for which the standard errors allow"


def fit_report(path: Path, recording: Recording, fit: Fit[Pendulum]) -> str:
    """The parameters, then how well they describe the recording."""
    ts, unit = recording.ts, recording.time_unit
    per = f"({unit})" if " " in unit else unit
    inverse = f"1/{per}"
    units = {
        "epsilon": f"{inverse}²",
        "beta": inverse,
        "tau": f"{inverse}²",
        "dry": f"{inverse}²",
        "v0": f"rad/{per}",
        "theta0": "rad",
        "offset": "rad",
    }
    letters = {"epsilon": "ε", "beta": "β", "tau": "τ", "dry": "c", "v0": "v0", "theta0": "θ0"}
    lines = [
        f"{path}: {ts.size} samples from {ts[0]:g} to {ts[-1]:g} {unit}",
        f"{_equation(fit)}, θ0 and v0 at t = {ts[0]:g}",
        "",
        *table(
            (letters.get(name, name), _value(fit, name), float(error), units[name])
            for name, error in fit.errors.items()
        ),
        "",
        _period(fit, unit),
        *_stop(fit, unit),
        *quality(fit, math.degrees(_rms(fit.residuals)), "°", _NOISE),
    ]
    if fit.velocity_residuals is not None:
        lines.append(f"velocities: rms {_rms(fit.velocity_residuals):.4g} {units['v0']}")
    return "\n".join(lines)


def junction_report(fit: Fit[JosephsonJunction]) -> str:
    """Ic, R, C and what follows from them, then how well they describe the loop."""
    junction = fit.model
    values, errors = _junction_values(fit), fit.errors
    units = {
        "critical_current": ("Ic", 1e6, "µA"),
        "resistance": ("R", 1.0, "Ω"),
        "capacitance": ("C", 1e12, "pF"),
        "current_offset": ("I offset", 1e6, "µA"),
    }
    rows = []
    for name, error in errors.items():
        letter, scale, unit = units[name]
        rows.append((letter, scale * values[name], scale * float(error), unit))
    lines = ["", *table(rows)]
    if junction.capacitance is not None:
        beta_c = float(junction.stewart_mccumber)
        lines.append(
            f"β_c = 2e Ic R² C/ħ = {beta_c:.4g} ± {beta_c * _share(fit):.2g}, retrapping at "
            f"{1e6 * float(junction.retrapping_current):.5g} µA"
        )
    return "\n".join([*lines, *quality(fit, 1e6 * _rms(fit.residuals), "µV", _FEWER), ""])


def junction_numbers(fit: Fit[JosephsonJunction]) -> dict[str, Any]:
    """For machines: the same in A, Ω, F and V."""
    current, voltage = (float(x) for x in np.asarray(fit.offset))
    return {
        **_shared(fit, _junction_values(fit)),
        "beta_c": float(fit.model.stewart_mccumber),
        "retrapping_current": float(fit.model.retrapping_current),
        "offset": {"current": current, "voltage": voltage},
        "rms_V": _rms(fit.residuals),
    }


def _junction_values(fit: Fit) -> dict[str, float]:
    offset = float(np.asarray(fit.offset)[0])
    return {
        name: offset if name == "current_offset" else float(getattr(fit.model, name))
        for name in fit.errors
    }


def _share(fit: Fit) -> float:
    """The relative error of β_c ∝ Ic R² C, its parameters' correlations counted."""
    powers = {"critical_current": 1, "resistance": 2, "capacitance": 1}
    values = _junction_values(fit)
    slope = np.array([powers.get(name, 0) / values[name] for name in fit.errors])
    return float(np.sqrt(slope @ np.asarray(fit.covariance) @ slope))


def table(rows: Any) -> list[str]:
    """name, value, standard error, unit; as many digits as the error allows, and two more."""
    lines = [f"{'parameter':18}{'value':>20}{'standard error':>18}   unit"]
    for name, value, error, unit in rows:
        lines.append(f"{name:18}{_rounded(value, error):>20}{error:>18.2g}   {unit}")
    return lines


def quality(fit: Fit, rms: float, unit: str, beware: str) -> list[str]:
    """Reduced χ² and run test, in words where they are bad."""
    runs = float(fit.runs)
    lines = [
        f"residuals: rms {rms:.4g} {unit}, reduced χ² {float(fit.reduced_chi2):.4g}, "
        f"run test {runs:+.1f} standard deviations",
        _ending(fit),
    ]
    if runs < KEPT:
        lines.append(
            f"The residuals keep their signs for long: the model lacks something, {beware}."
        )
    return lines + [str(note) for note in fit.notes]


def numbers(recording: Recording, fit: Fit) -> dict[str, Any]:
    """For machines: the same, in rad and the recording's unit of time."""
    return {
        "samples": recording.ts.size,
        "start": float(recording.ts[0]),
        "time_unit": recording.time_unit,
        **_shared(fit, {name: _value(fit, name) for name in fit.errors}),
        "rms_rad": _rms(fit.residuals),
    }


def _shared(fit: Fit, values: dict[str, float]) -> dict[str, Any]:
    return {
        "parameters": {
            name: {"value": value, "error": float(fit.errors[name])}
            for name, value in values.items()
        },
        "covariance": np.asarray(fit.covariance).tolist(),
        "reduced_chi2": float(fit.reduced_chi2),
        "runs": float(fit.runs),
        "result": _said(fit),
        "notes": list(fit.notes),
    }


def _ending(fit: Fit) -> str:
    """A fit that has converged may still be a bad one."""
    return "The iteration converged." if fit.result == Result.successful else _said(fit)


def _said(fit: Fit) -> str:
    return str(fit.result).partition("<")[2].rstrip(">")


def _value(fit: Fit, name: str) -> float:
    found = getattr(fit if name in ("v0", "theta0", "offset") else fit.model, name)
    return float(found)


def _rms(x: Any) -> float:
    return float(np.sqrt(np.mean(np.asarray(x) ** 2)))


def _equation(fit: Fit[Pendulum]) -> str:
    viscous = ["β θ̇"] if fit.model.beta is not None else []
    dry = ["c sign θ̇"] if fit.model.dry is not None else []
    terms = ["θ̈", *viscous, *dry, "ε sin θ"]
    right = "τ" if fit.model.tau is not None else "0"
    return f"{' + '.join(terms)} = {right}"


def _period(fit: Fit[Pendulum], unit: str) -> str:
    epsilon = float(fit.model.epsilon)
    period = 2 * math.pi / math.sqrt(epsilon)
    error = 0.5 * period * float(fit.errors.get("epsilon", 0.0)) / epsilon
    return f"small-angle period 2π/√ε = {_rounded(period, error)} ± {error:.2g} {unit}"


def _stop(fit: Fit[Pendulum], unit: str) -> list[str]:
    """Where dry friction will hold it, and when."""
    if fit.model.dry is None or fit.v0 is None or fit.theta0 is None:
        return []
    end = settle(fit.model, fit.v0, fit.theta0, throw=False)
    if end.result != Result.successful or end.running != 0:
        return []
    angle = float(end.theta) + (0.0 if fit.offset is None else float(fit.offset))
    return [f"it comes to rest at {math.degrees(angle):.4g}°, {float(end.time):.4g} {unit} later"]


def _rounded(value: float, error: float) -> str:
    if not (0 < error < math.inf) or value == 0:
        return f"{value:.10g}"
    digits = math.ceil(math.log10(max(abs(value) / error, 1.0))) + 2
    return f"{value:#.{min(digits, 15)}g}".rstrip(".")
