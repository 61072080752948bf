"""A junction's critical current, resistance and capacitance from a measured I–V loop."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import ArrayLike

from .._arrays import whole
from .._results import Result
from ..josephson import JosephsonJunction
from ..josephson._iv_curve import autonomous
from ._fit import Fit
from ._judgement import ended, goodness
from ._loop_search import LoopSearch, Outcome, Points
from ._measured_loop import (
    DESCRIBED,
    NAMES,
    Loop,
    centred,
    edges_of,
    loop_of,
    points_of,
    start_of,
    transition,
    transitions,
)
from ._parameters import Parameters

BINS = 64  # of running points, over which the curve of a junction with capacitance is straight
MANY = 2048  # of those of a first-order junction, whose voltages cost nothing
AGAIN = 12  # times at most that points are chosen anew


def fit_junction(
    current: ArrayLike,
    voltage: ArrayLike,
    guess: JosephsonJunction | None = None,
    *,
    rising: ArrayLike | None = None,
    fixed: Sequence[str] = (),
    mask: ArrayLike | None = None,
    loss: Callable | None = None,
    optimiser: Any = None,
    steps: int | None = None,
    progress: Callable[[float], Any] | None = None,
) -> Fit[JosephsonJunction]:
    """Ic, R and C of a junction, and the offset of the current, from a measured I–V loop.

    What a loop has to say comes from three places: where it switches, Ic itself; where it
    retraps, Ir = Ic τ_r(β); and the voltages of the running state, whose slopes in all parameters
    are the implicit derivatives of [`iv_curve`][].  Points near the transitions are left out, where
    noise rounds the curve, and so are those that the fit ends up more than 5 % of the largest
    voltage away from: a gap, which the model does not have.  `notes` say where.

    **Arguments:**

    - `current`, `voltage`: A and V, one axis, in the order in which they were measured: a loop, a
      part of one, or several.
    - `guess`: a junction to start from, read off the loop by default; one without capacitance asks
      for the first-order junction.
    - `rising`: whether the current rises, at each point; by default found from its turning points.
    - `fixed`: names among critical_current, resistance, capacitance, current_offset that are held.
    - `mask`: `False` at points that are not to be fitted.
    - `loss`: ρ(r) of a residual r in hundredths of the largest voltage, a smooth function like r²/2
      near 0, instead of leaving points out that are far away.
    - `optimiser`, `steps`: as in [`fit_trajectory`][].
    - `progress`: called after each round of choosing points.

    **Returns:** a [`Fit`][] whose `model` is a `JosephsonJunction`.  `offset` has those of current
    and voltage: the voltage's is the median of what is measured at rest, the current's, fitted, 0
    where the loop has one sign only.  `residuals`, V, are of all points, each on its own branch.
    Errors count neighbouring residuals that are alike as fewer than they are.
    A loop without hysteresis does not determine C: `model.capacitance` is then `None`, and
    `notes` say so.  Eager only: what is fitted depends on the data.

    **Raises:** `ValueError` for points that are not finite, constant or fewer than 16, for
    currents above 10 A and voltages above 1 V, which only a wrong unit explains, for loops that
    end before the running state, and for names that are not fitted.

    **Accuracy:** Ic is the mean of what was measured once on each side: noise switches a junction
    early.  Without hysteresis points below 1.6 times the current at a twentieth of the largest
    voltage are left out; an Ic fitted from beyond drifts by 1 to 2 % with this factor where noise
    rounds the curve.
    """
    steps = whole("steps", (100 if optimiser is None else 2000) if steps is None else steps, 1)
    fixed = (fixed,) if isinstance(fixed, str) else tuple(fixed)
    loop = loop_of(current, voltage, rising, mask)
    loop, shift = centred(loop)
    largest = float(np.max(np.abs(loop.voltage[loop.there])))
    found, hysteretic = transitions(loop)
    # About what both sides have in common, or the sign of a current may be the wrong one.
    middle = float(np.mean(found.switching)) if np.isfinite(found.switching).all() else 0.0
    if middle:
        loop = loop._replace(current=loop.current - middle)
        found, hysteretic = transitions(loop)
    edge = transition(found, hysteretic)
    if not (np.abs(loop.current[loop.there]) > edge).sum() > 8:
        raise ValueError(
            "Argument `current` must reach further beyond the transition to the running state, "
            f"above {edge:.4g} A."
        )
    notes: list[str] = []
    capacitive = hysteretic if guess is None else guess.capacitance is not None and hysteretic
    if not hysteretic:
        notes.append(
            "The loop has no hysteresis and does not determine a capacitance: the first-order "
            "junction is fitted."
        )
    elif not capacitive:
        notes.append("The loop has hysteresis, which a junction without capacitance has not.")

    points = points_of(loop, largest, BINS if capacitive else MANY)
    start = start_of(points, found, edge, guess, capacitive)
    both = (points.current > 0).any() and (points.current < 0).any()
    held = {name: start.pop(name) for name in tuple(start) if name in fixed}
    if not both and "current_offset" in start:
        held["current_offset"] = start.pop("current_offset")
    parameters = _parameters(start, held, fixed)
    search = LoopSearch(
        points,
        edges_of(found) if hysteretic else None,
        {name: jnp.asarray(x, float) for name, x in held.items()},
        parameters,
        jnp.asarray(largest),
        loss,
        optimiser,
        steps,
    )
    outcome, used = _trimmed(search, edge, loss is None, progress)
    return _fit(search, outcome, used, loop, (middle, shift), largest, notes)


def _parameters(start: dict[str, float], held: dict[str, float], fixed) -> Parameters:
    for name in fixed:
        if name not in held:
            raise ValueError(
                f"Argument `fixed` must name some of {', '.join((*start, *held))}, "
                f"but got {name!r}."
            )
    if not start:
        raise ValueError("Argument `fixed` must leave something to fit.")
    unit = 0.1 * (start | held)["critical_current"]
    scale = {name: jnp.asarray(unit) for name in start}
    arrays = {name: jnp.asarray(x, float) for name, x in start.items()}
    positive = frozenset(NAMES[:3]) & set(start)
    return Parameters(arrays, scale, positive, frozenset(), tuple(start))


def _trimmed(
    search: LoopSearch, edge: float, trim: bool, progress: Callable | None
) -> tuple[Outcome, np.ndarray]:
    """Points that the fit describes are fitted again without the others, until they stay the same.

    Neighbouring residuals that are alike count as fewer than they are (Bartlett 1935): what the
    model lacks must not outweigh the currents of transition.
    """
    base = np.abs(np.asarray(search.points.current)) > edge
    x, share, seen = jnp.zeros(search.parameters.size), 1.0, set()
    used = base
    if trim:  # by what was read off, before anything is fitted to all of it
        off = search.run(x, jnp.asarray(used), jnp.asarray(share), jnp.asarray(0)).off
        near = base & (np.abs(np.asarray(off)) < 2 * DESCRIBED)
        used = near if near.sum() > 8 else base
    steps = jnp.asarray(search.steps)
    outcome = search.run(x, jnp.asarray(used), jnp.asarray(share), steps)
    for _ in range(AGAIN):
        off = np.asarray(outcome.off)
        if progress is not None:
            progress(1 / AGAIN)
        if not np.isfinite(off).all():
            break
        again = base & (np.abs(off) < DESCRIBED) if trim else used
        fewer = _independent(off[used])
        if ((again == used).all() and abs(np.log(fewer / share)) < 0.1) or again.sum() < 4:
            break
        if again.tobytes() in seen and not (again == used).all():  # going to and fro
            again = again & used
        seen.add(again.tobytes())
        used, share = again, fewer
        outcome = search.run(x, jnp.asarray(used), jnp.asarray(share), steps)
    return outcome, used


def _independent(off: np.ndarray) -> float:
    """Of residuals with lag-one correlation ρ: (1 − ρ)/(1 + ρ) of their number, eight at least."""
    r = off - off.mean()
    power = float(r @ r)
    rho = float(r[1:] @ r[:-1]) / power if power > 0 else 0.0
    least = min(1.0, 8 / off.size)
    return float(np.clip((1 - rho) / (1 + rho), least, 1.0))


def _fit(
    search, outcome: Outcome, used, loop: Loop, shifts, largest, notes
) -> Fit[JosephsonJunction]:
    parameters = search.parameters
    values = search.held | parameters.split(parameters.at(outcome.x))
    model = _model(values)
    zero = float(values["current_offset"])
    residuals = loop.voltage - _modelled(model, loop, zero)
    rms = np.sqrt(np.mean(np.asarray(outcome.off)[used] ** 2)) if used.any() else math.nan
    points = search.points
    kept = _kept(loop, points, used)
    found = goodness(jnp.asarray(residuals)[None], jnp.asarray(kept)[None], parameters.size, False)
    judgement = outcome.judgement
    result = ended(judgement, outcome.loss, found.runs, jnp.asarray(rms))
    if np.mean(np.abs(residuals[loop.there]) > DESCRIBED * largest) > 0.5:
        result = Result.misfit
    errors = parameters.split(judgement.errors)
    return Fit(
        model=model,
        v0=None,
        theta0=None,
        offset=jnp.asarray([shifts[0] + zero, shifts[1]]),
        errors=errors,
        covariance=judgement.covariance,
        residuals=jnp.asarray(residuals),
        history=outcome.history,
        result=result,
        reduced_chi2=found.reduced_chi2,
        runs=found.runs,
        notes=(*notes, *_undescribed(loop, residuals, largest, search.loss is None)),
    )


def _model(values) -> JosephsonJunction:
    """Of whatever values: a search that went astray is told by its `result`."""
    leaves = [values[name] for name in NAMES[:3] if name in values]
    some = JosephsonJunction(1e-6, 1.0, 1e-12 if len(leaves) == 3 else None)
    return jax.tree.unflatten(jax.tree.structure(some), leaves)


def _modelled(model: JosephsonJunction, loop: Loop, zero: float) -> np.ndarray:
    """Of the branch that each point was measured on."""
    current = np.where(np.isfinite(loop.current), loop.current, 0) - zero
    order = np.argsort(current, kind="stable")
    curve = autonomous(model, jnp.asarray(current[order]))
    voltages = np.empty((2, current.size))
    voltages[:, order] = curve.voltage_down, curve.voltage_up
    return np.where(loop.rising, voltages[1], voltages[0])


def _kept(loop: Loop, points: Points, used: np.ndarray) -> np.ndarray:
    """The measured points that the fitted means are of."""
    nearest = np.argmin(np.abs(loop.current[:, None] - np.asarray(points.current)), 1)
    return loop.there & used[nearest] & (loop.voltage * loop.current > 0)


def _undescribed(loop: Loop, residuals: np.ndarray, largest: float, trim: bool) -> list[str]:
    """Where more than a few neighbours are off, from … to …, in |I| and |V|."""
    off = loop.there & (np.abs(residuals) > DESCRIBED * largest)
    share = off.sum() / loop.there.sum()
    if share < 0.005:
        return []
    i, v = np.abs(loop.current), np.abs(loop.voltage)
    edges = np.linspace(0, i[loop.there].max(), 65)
    bins = np.clip(np.digitize(i, edges) - 1, 0, 63)
    wrong = np.array([np.mean(off[k & loop.there]) if (k & loop.there).any() else 0.0
                      for k in (bins == b for b in range(64))]) > 0.3  # fmt: skip
    places = []
    for first, last in _stretches(wrong):
        inside = off & (bins >= first) & (bins <= last)
        places.append(
            f"|I| from {1e6 * i[inside].min():.4g} to {1e6 * i[inside].max():.4g} µA "
            f"(|V| {1e3 * v[inside].min():.3g} to {1e3 * v[inside].max():.3g} mV)"
        )
    return [
        f"The model is more than {DESCRIBED:.0%} of the largest voltage off at {share:.0%} of the "
        f"points{', which it was fitted without' if trim else ''}"
        f"{': ' if places else ''}{', '.join(places)}."
    ]


def _stretches(flags: np.ndarray) -> list[tuple[int, int]]:
    ends = np.flatnonzero(np.diff(np.r_[False, flags, False].astype(int)))
    return [(int(a), int(b) - 1) for a, b in zip(ends[::2], ends[1::2], strict=True)]
