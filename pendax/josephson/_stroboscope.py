"""A junction with capacitance under an alternating current, seen once a period.

    φ̈ + β φ̇ + sin φ = i0 + i1 sin Ωt

The current i0 is swept, and the junction goes on from where it was, so that it stays on a
branch until that ends; from one value to the next the current goes in steps, as a jump would
kick it.  Where a period, or a few, return it to the same state a whole number of turns on, it is
locked, and that number is the answer.  Elsewhere turns are averaged with a weight that is smooth to
every order, exp(−1/x(1 − x)), and so, where the motion is quasi-periodic, with an error that
falls faster than any power of their number (Das, Saiki, Sander & Yorke, Nonlinearity 30 (2017)
4111), where a plain average's goes like 1/number.

How much the average is in doubt is how far the farthest of its four quarters, averaged alike, is
off it: of random quasi-periodic sequences that covers 97 in 100 at 128 periods and 98 or 99 at
512; of chaotic ones 97.  Where it turns so nearly a multiple of 1, ½, ⅓, ¼ in a period that it
slips off it less than thrice in all of this time, beside a step say, it may be by one slip.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float

from ..taylor import Method, Scene, Sine, State, order_for, overdamped, strength, taylor

Scalar = Float[Array, ""]

_TOLERANCE = 2000.0  # of a step, in eps
_MOST = 1_000_000  # steps in a period
_LIMIT, MOST_SWEEPS, _ORDER = 0.02, 10, 12  # of the slow curve
_LEFT = 20.0  # e-folds of a perturbation that are waited for
_RAMP = 8  # periods in which the current comes to its next value
_MULTIPLES = np.arange(1, 5)  # periods after which it may repeat itself


class Junction(NamedTuple):
    """Time in 1/ω_p, currents in Ic; lanes only for [`glides`][]."""

    beta: Float[Array, "..."]
    amplitude: Float[Array, "..."]
    frequency: Float[Array, "..."]


def glides(junction: Junction, most: Float[Array, "..."]) -> Bool[Array, "..."]:
    """Whether v is a function of φ and the clock, at currents up to `most`."""
    return smallness(junction, most) < _LIMIT


def smallness(junction: Junction, most: Float[Array, "..."]) -> Float[Array, "..."]:
    """δ, by which the slow curve is a series; n sweeps leave less than (4δ)^n."""
    torque = Sine(most, junction.amplitude, junction.frequency, 0.0)
    return strength(Scene(1.0, junction.beta, torque)) / (junction.beta * junction.beta)


class Methods(NamedTuple):
    """Which a program has in it: Taylor's own, and that of the slow curve v(θ)."""

    full: bool
    sweeps: int  # of the latter, if any


class Turns(NamedTuple):
    """Of φ in a period, at each current, and the uncertainty of their mean."""

    mean: Float[Array, " currents"]
    error: Float[Array, " currents"]
    locked: Bool[Array, " currents"]


def swept(junction: Junction, currents: Float[Array, " currents"], periods: int, methods: Methods):
    """Turns in a period while i0 goes through `currents`, from the first on.

    It starts at rest if it can, else with the voltage of the resistance alone.
    """
    first = currents[jnp.argmax(~jnp.isnan(currents))]
    most = jnp.nanmax(jnp.abs(currents))
    period = partial(_period, junction, glides(junction, most), methods)
    resting = jnp.abs(first) <= 1
    start = State(
        jnp.where(resting, jnp.arcsin(jnp.where(resting, first, 0)), 0),
        jnp.where(resting, 0, first / junction.beta),
    )

    def at_current(before, i0):
        def ramped(number, state):
            share = jnp.minimum((number + 1) / _RAMP, 1)
            return period(before[0] + share * (i0 - before[0]), state)

        end, *turns = _watched(junction, ramped, before[1], periods)
        fine = jnp.isfinite(end.theta) & jnp.isfinite(end.v)
        kept = jax.tree.map(lambda x, y: jnp.where(fine, x, y), (i0, end), before)
        return kept, turns

    return Turns(*lax.scan(at_current, (first, start), currents)[1])


class Watch(NamedTuple):
    period: Scalar  # how many have gone
    state: State
    total: Float[Array, "5"]  # of weight · turns: the whole, and its quarters
    turns: Float[Array, "4"]  # of the last period, the last two, …
    v: Float[Array, "4"]  # before the last period, the last two, …
    moved: Float[Array, "4"]  # by these, beyond whole turns
    before: Float[Array, "4"]  # and a period earlier


def _watched(junction: Junction, period: Callable, start: State, periods: int):
    """The state in the end, the mean turns in a period, their uncertainty, and whether locked."""
    dtype = start.v.dtype
    eps = jnp.finfo(dtype).eps
    still = 1e4 * eps  # 2e-12
    relaxing = 2 / junction.beta + 2 * junction.beta
    wait = _RAMP + jnp.ceil(_LEFT * relaxing * junction.frequency / (2 * np.pi))
    wait = jnp.where(wait < _MOST, wait, jnp.nan)

    def is_locked(at: Watch):
        return (at.moved < still) & (at.before < still)

    def unfinished(at: Watch):
        locked = jnp.any(is_locked(at)) & (at.period > _RAMP + _MULTIPLES.size)
        return ~locked & (at.period < wait + periods) & jnp.isfinite(at.state.v)

    def one(at: Watch):
        end = period(at.period, at.state)
        turns = (end.theta - at.state.theta) / (2 * np.pi)
        back = State(end.theta - 2 * np.pi * jnp.round(turns), end.v)
        since = turns + jnp.append(jnp.zeros_like(at.turns[:1]), at.turns[:-1])
        v = jnp.append(at.state.v[None], at.v[:-1])
        moved = 2 * np.pi * jnp.abs(since - jnp.round(since)) + jnp.abs(end.v - v)
        x = (at.period - wait + 0.5) / periods
        weights = jnp.stack([_bump(x), *(_bump(4 * x - k) for k in range(4))])
        total = at.total + weights * turns
        return Watch(at.period + 1, back, total, since, v, moved, at.moved)

    zeros, far = jnp.zeros(_MULTIPLES.size, dtype), jnp.full(_MULTIPLES.size, jnp.inf, dtype)
    begin = Watch(zeros[0], start, jnp.zeros(5, dtype), zeros, far, far, far)
    end = lax.while_loop(unfinished, one, begin)

    # Of the periods after which it repeats itself the first, if any.
    multiples = jnp.asarray(_MULTIPLES, dtype)
    locked, first = jnp.any(is_locked(end)), jnp.argmax(is_locked(end))
    exact = jnp.round(end.turns[first]) / multiples[first]
    # If it was but slow, as it is beside a step, this is how fast it may have passed.
    bent = jnp.maximum(np.pi / (junction.frequency * junction.beta), 1)
    passing = jnp.sqrt(end.moved[first] * bent / multiples[first]) / np.pi

    x = (jnp.arange(periods, dtype=dtype) + 0.5) / periods
    weight = jnp.sum(_bump(x))
    quarter = jnp.stack([jnp.sum(_bump(4 * x - k)) for k in range(4)])
    mean, parts = end.total[0] / weight, end.total[1:] / quarter
    spread = jnp.max(jnp.abs(parts - mean)) + 2 * _TOLERANCE * eps * (1 + jnp.abs(mean))
    # A few slips beside a multiple, or none, say little about how many there are in the long run.
    slips = jnp.abs(multiples * mean - jnp.round(multiples * mean)) * periods
    unseen = jnp.max(jnp.where(slips < 3, 1 / (multiples * periods), 0))

    bad = jnp.where(jnp.isfinite(end.state.v) & (wait > 0), 1, jnp.nan)
    mean = bad * jnp.where(locked, exact, mean)
    error = bad * jnp.where(locked, passing, jnp.maximum(spread, unseen))
    return end.state, mean, error, locked


def _bump(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """exp(−1/x(1 − x)) from 0 to 1."""
    inside = (x > 0) & (x < 1)
    y = jnp.where(inside, x, 0.5)
    return jnp.where(inside, jnp.exp(4 - 1 / (y * (1 - y))), 0)


def _period(
    junction: Junction, slowly: Bool[Array, ""], methods: Methods, i0: Scalar, start: State
) -> State:
    """A period on; NaN where that takes too many steps."""
    rtol = _TOLERANCE * float(jnp.finfo(i0.dtype).eps)
    full = taylor(order_for(rtol, rtol, 16), rtol, rtol)
    slow = overdamped(_ORDER, rtol, rtol, sweeps=methods.sweeps)
    duration = 2 * np.pi / junction.frequency

    def step(at):
        t, state, steps = at
        clock = junction.frequency * t
        torque = Sine(i0, junction.amplitude, junction.frequency, clock)
        now = Scene(jnp.ones_like(i0), junction.beta, torque)
        chosen = [how for how, asked in zip((full, slow), methods, strict=True) if asked]
        left = duration - t
        moves = [_within(how, now, state, left) for how in chosen]
        if len(moves) == 2:
            moves = [jax.tree.map(lambda x, y: jnp.where(slowly, y, x), *moves)]
        h, after = moves[0]
        return jnp.where(h == left, duration, t + h), after, steps + 1

    def unfinished(at):
        t, state, steps = at
        return (t < duration) & (steps < _MOST) & jnp.isfinite(state.v)

    begin = jnp.zeros_like(i0), start, jnp.zeros((), jnp.int32)
    t, end, _ = lax.while_loop(unfinished, step, begin)
    return State(*(jnp.where(t == duration, x, jnp.nan) for x in end))


def _within(how: Method, scene: Scene, state: State, left: Scalar) -> tuple[Scalar, State]:
    """A step of what is left at most, and the last two alike."""
    known = how.series(scene, state)
    h = how.size(scene, state, known)
    h = jnp.where(h < left, jnp.minimum(h, jnp.maximum(0.5 * left, left - h)), left)
    return h, how.step(scene, state, h, known)
