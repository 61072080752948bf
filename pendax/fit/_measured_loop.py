"""What a measured I–V loop shows before anything is fitted to it."""

import math
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from .._arrays import concrete
from ..josephson import REDUCED
from ._loop import LEVEL, Crossings, crossings
from ._loop import rising as rising_of
from ._loop_search import Edges, Points

NEAR = 0.2  # of the retrapping current, within which leakage and noise bend the curve
ROUNDED = 0.6  # of the current with a twentieth of the voltage, where noise rounds it
DESCRIBED = 0.05  # of the largest voltage, that a point which the model describes may be off
FINE = 0.003  # of the largest voltage, zero where there is no noise
JUMP = 0.15  # of the largest voltage, that only a junction with hysteresis switches by
GUESSED = 0.5  # of Ic, a retrapping current to start from where none was measured
HYSTERESIS = 0.02  # of the switching current, between it and the retrapping one

NAMES = ("critical_current", "resistance", "capacitance", "current_offset")


class Loop(NamedTuple):
    current: np.ndarray
    voltage: np.ndarray  # without the offset
    rising: np.ndarray
    there: np.ndarray


def loop_of(current, voltage, rising, mask) -> Loop:
    arrays = {"current": current, "voltage": voltage}
    seen = {name: concrete(x) for name, x in arrays.items()}
    for name, x in seen.items():
        if x is None:
            raise ValueError(
                f"Argument `{name}` must be numbers, but got {type(arrays[name]).__name__}: what "
                "is fitted depends on the data, which no transformation may hide."
            )
    i, v = (np.asarray(x, float) for x in seen.values())
    if i.ndim != 1 or i.shape != v.shape:
        raise ValueError(
            "Arguments `current` and `voltage` must have one axis of equal length, "
            f"but got shapes {i.shape} and {v.shape}."
        )
    there = np.ones(i.shape, bool) if mask is None else np.asarray(mask)
    if there.dtype != bool or there.shape != i.shape:
        raise ValueError(
            f"Argument `mask` must be booleans of shape {i.shape}, "
            f"but got {there.dtype} {there.shape}."
        )
    if there.sum() < 16:
        raise ValueError(
            f"Argument `current` must have 16 or more points that are fitted, got {there.sum()}."
        )
    for name, x in (("current", i), ("voltage", v)):
        bad = there & ~np.isfinite(x)
        if bad.any():
            raise ValueError(
                f"Argument `{name}` must be finite, but got {x[bad][0]} at "
                f"{int(np.flatnonzero(bad)[0])}; leave such points out, or give a `mask`."
            )
        if np.ptp(x[there]) == 0:
            raise ValueError(f"Argument `{name}` must vary, but it is {x[there][0]:.6g} always.")
    for name, x, most, unit in (("current", i, 10.0, "A"), ("voltage", v, 1.0, "V")):
        if np.abs(x[there]).max() > most:
            raise ValueError(
                f"Argument `{name}` must be in {unit}, {most:g} at most, "
                f"but it reaches {np.abs(x[there]).max():.6g}."
            )
    up = rising_of(np.where(there, i, np.nanmedian(i))) if rising is None else np.asarray(rising)
    if up.dtype != bool or up.shape != i.shape:
        raise ValueError(
            f"Argument `rising` must be booleans of shape {i.shape}, but got {up.dtype} {up.shape}."
        )
    return Loop(i, v, up, there)


def centred(loop: Loop) -> tuple[Loop, float]:
    """Without the voltage's offset: what is most frequent among the smallest third of currents."""
    size = np.abs(loop.current)
    small = loop.there & (size <= np.max(size[loop.there]) / 3)
    v = loop.voltage[small if small.sum() > 8 else loop.there]
    counts, edges = np.histogram(v, bins=100)
    k = int(np.argmax(counts))
    shift = float(np.median(v[(v >= edges[k]) & (v <= edges[k + 1])]))
    return loop._replace(voltage=loop.voltage - shift), shift


def transitions(loop: Loop) -> tuple[Crossings, bool]:
    """Where zero voltage ends, and whether there is hysteresis.

    With hysteresis zero is what noise, by third differences, does not leave: a retrapping current
    far below the largest has a voltage far below it, too.  Without, where noise rounds the curve,
    a twentieth of the largest.
    """
    i, v, up = (x[loop.there] for x in loop[:3])
    largest = float(np.max(np.abs(v)))
    noise = np.median(np.abs(np.diff(v, 3))) / (0.6745 * np.sqrt(20))
    fine = crossings(i, v, up, float(np.clip(10 * noise / largest, FINE, LEVEL)))
    if not np.isfinite(fine.switching).any():
        raise ValueError(
            "Arguments `current` and `voltage` must show where the junction leaves zero voltage, "
            "with a current that grows from small to large: no such transition was found."
        )
    out, back = means(fine)
    if math.isnan(back):  # the jump alone can tell
        return fine, fine.jump > JUMP * largest
    if out - back > HYSTERESIS * out:
        return fine, True
    return crossings(i, v, up), False


def edges_of(found: Crossings) -> Edges:
    """What was measured on each side; 1 stands where it wasn't."""
    both = np.abs([found.switching, found.retrapping])
    there = np.isfinite(both)
    values = (*np.where(there, both, 1.0), *there, found.gap)
    return Edges(*(jnp.asarray(x, float) for x in values))


def points_of(loop: Loop, largest: float, most: int) -> Points:
    """Running points in the order of their currents, and means of them."""
    runs = loop.there & (np.abs(loop.voltage) >= LEVEL * largest)
    i, v = loop.current[runs], loop.voltage[runs]
    order = np.argsort(i, kind="stable")
    # No mean reaches from negative currents to positive ones.
    sides = [side for side in (order[i[order] < 0], order[i[order] > 0]) if side.size]
    parts = [p for side in sides for p in np.array_split(side, min(most // 2, side.size))]
    sizes = np.array([p.size for p in parts], float)
    means = (np.array([x[p].mean() for p in parts]) for x in (i, v))
    return Points(*(jnp.asarray(x) for x in (*means, sizes / sizes.mean())))


def start_of(
    points: Points, found: Crossings, edge: float, guess, capacitive: bool
) -> dict[str, float]:
    """Read off the loop: Ic where it switches, C from where it retraps, R where most points are."""
    i, v = np.abs(points.current), np.abs(points.voltage)
    out, back = means(found)
    back = GUESSED * out if math.isnan(back) else back
    beyond = i > edge
    ohms = v[beyond] / np.sqrt(i[beyond] ** 2 - (back if capacitive else out) ** 2)
    agree = np.abs(ohms[:, None] - ohms) < 2 * DESCRIBED * ohms
    resistance = float(np.median(ohms[agree[np.argmax(agree.sum(1))]]))
    start = {"critical_current": out, "resistance": resistance}
    if capacitive:
        beta_c = (4 * out / (math.pi * back)) ** 2
        start["capacitance"] = beta_c * REDUCED / (out * resistance**2)
    if guess is not None:
        leaves = guess.critical_current, guess.resistance, guess.capacitance
        given: dict[str, Any] = dict(zip(NAMES, leaves, strict=False))
        start = {name: float(given[name]) for name in start}
    start["current_offset"] = 0.0
    return start


def transition(found: Crossings, hysteretic: bool) -> float:
    """The current from which on the curve is that of the model."""
    out, back = means(found)
    back = GUESSED * out if math.isnan(back) else back
    return (1 + NEAR) * back if hysteretic else (1 + ROUNDED) * out


def means(found: Crossings) -> tuple[float, float]:
    """Of both sides, where the voltage appears and where it vanishes; NaN if none was measured."""
    sizes = (np.abs(x)[np.isfinite(x)] for x in (found.switching, found.retrapping))
    out, back = (float(x.mean()) if x.size else math.nan for x in sizes)
    return out, back
