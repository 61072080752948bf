"""The tables that `pendax sweep` prints."""

import math
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from .._critical import CriticalLaw, CriticalSide, critical_law, frequency_at
from .._exact import frequency
from .._pendulum import Pendulum
from ..fit import Cycles, Fit

# Distances at which the law is compared with the exact ω, in units of √ε.
_DECADES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15)

_SIDES = ("lower", "upper")


def law_report(law: CriticalLaw, epsilon: float, low: float, high: float) -> str:
    """A and B against theory, then where the law stops holding."""
    root = math.sqrt(epsilon)
    scale = 4 * math.sqrt(root)
    lines = [
        f"\ncritical law ω = A / ln(B/√t), t = |v0 − 2√ε|, fitted on {low:g} ≤ t/√ε ≤ {high:g}",
        f"{'':9}{'A fitted':>15}{'A theory':>15}{'A/theory−1':>12}"
        f"{'B fitted':>15}{'B theory':>15}{'B/theory−1':>12}{'residual':>10}{'points':>8}",
        _side("below", law.lower, math.pi * root / 2, scale),
        _side("above", law.upper, math.pi * root, scale),
        f"A above / A below = {float(law.ratio):.9f} (theory 2)   "
        "residual: rms of ω_law/ω − 1   A in rad/s, B in (rad/s)^½",
    ]
    return "\n".join([*lines, "", *_deviations(epsilon)])


def _side(name: str, side: CriticalSide, amplitude: float, scale: float) -> str:
    a, b = float(side.amplitude), float(side.scale)
    return (
        f"{name:9}{a:15.10g}{amplitude:15.10g}{a / amplitude - 1:12.1e}"
        f"{b:15.10g}{scale:15.10g}{b / scale - 1:12.1e}"
        f"{float(side.residual):10.1e}{int(side.count):8d}"
    )


def _deviations(epsilon: float) -> list[str]:
    lines = [
        "where the law holds: law/exact − 1, leading and with the next order in t",
        f"{'':9}{'ω below':>15}{'ω above':>15}{'above/below':>13}"
        f"{'leading: below':>16}{'above':>10}{'next: below':>13}{'above':>10}",
    ]
    t = jnp.array(_DECADES) * math.sqrt(epsilon)
    low, high = (frequency_at(t, jnp.full_like(t, epsilon), side) for side in _SIDES)
    off = [
        critical_law(t, side, epsilon, order) / exact - 1
        for order in (0, 1)
        for side, exact in zip(_SIDES, (low, high), strict=True)
    ]
    columns = (np.asarray(x).tolist() for x in (t, low, high, high / low, *off))
    return lines + [
        f"t ={at:7.1e}{below:15.10g}{above:15.10g}{ratio:13.9f}{a:16.1e}{b:10.1e}{c:13.1e}{d:10.1e}"
        for at, below, above, ratio, a, b, c, d in zip(*columns, strict=True)
    ]


def swing_report(path: Path, cycles: Cycles, fit: Fit[Pendulum], unit: str) -> str:
    """Cycle by cycle, then the small-angle period."""
    epsilon, error = float(fit.model.epsilon), float(fit.errors["epsilon"])
    t0 = 2 * math.pi / math.sqrt(epsilon)
    inverse = f"1/({unit})" if " " in unit else f"1/{unit}"
    single = cycles.period * np.asarray(frequency(Pendulum(), 0.0, cycles.amplitude))
    lines = [
        f"\n{path}: {cycles.period.size} cycles",
        f"{'start':>12}{'amplitude/°':>14}{'±':>7}{'period':>12}{'±':>10}"
        f"{'2π/√ε of the cycle':>21}   (times in {unit})",
    ]
    for start, a, period, da, dp, t in zip(*cycles, single, strict=True):
        lines.append(
            f"{start:12.4f}{math.degrees(a):14.3f}{math.degrees(da):7.2f}"
            f"{period:12.6f}{dp:10.1e}{t:21.5f}"
        )
    lines += [
        f"small-angle period 2π/√ε = {t0:.6g} ± {0.5 * t0 * error / epsilon:.2g} {unit}, "
        f"ε = {epsilon:.7g} ± {error:.2g} {inverse}²"
    ]
    return "\n".join(lines)
