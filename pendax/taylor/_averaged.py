"""Barely damped: a hundred million turns, of which a thousand are looked at.

From one passage of the bottom to the next the energy E falls by D(E) = β ∫v² dt, in a time T(E)
(`_passage`).  Both are smooth on the scale of one passage, but near the separatrix, so that
counting passages by a continuous n,

    dE/dn = −(D₀ + ½ΔD + ⅓Δ²D …),    the logarithm of the map, Δ of passages in a row,
    n = ∫ dE / (dE/dn),   t = ∫T dn − ½[T] + 1/12 [dT/dn] − 1/720 [d³T/dn³],

the latter Euler and Maclaurin's sum of T.  What is left out is of relative order β⁴.  A time
is given by the whole number of passages before it and the rest, followed by steps.  Around
the separatrix, where T has a logarithm, passages are taken one by one.

Rejected: the formulas of averaging in action and angle to second order, which would need the
same care at the separatrix and more algebra; differences of energies, which have no digits.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from ._march import March, until
from ._passage import Passage, passage
from ._series import Scene, State
from ._step import taylor
from ._table import Table, integrals, tabulated, where_integral

Scalar = Float[Array, ""]

# Passages nearer to the separatrix than this many are taken one by one.
_NEAR = 64
# The energy is followed to e^−48 of the separatrix's, 1e-10 rad.
_LOWEST = 48.0


class Bottom(NamedTuple):
    """A passage of the bottom: when, with what energy, after how many turns, which way."""

    t: Scalar
    energy: Scalar
    turns: Scalar
    direction: Scalar


class Orders(NamedTuple):
    """What is changed to see what it matters."""

    last: Scalar  # a factor of the last terms that are kept
    rounded: Scalar  # a relative change of the first energy, and of θ0 with its turns


def averaged(
    scene: Scene, start: State, ts: Float[Array, " times"]
) -> tuple[State, Float[Array, " times"]]:
    """The states at `ts` > 0, in any order, and how far off they may be: rad, and rad/s over √ε.

    The error is the change without the last terms, that by some roundings of the start, both
    twice, and the rounding of a phase √ε t, and of a panel's part of it in the tables.
    """
    eps = jnp.finfo(ts.dtype).eps
    orders = Orders(jnp.array([1, 0, 1], ts.dtype), jnp.array([0, 0, 8], ts.dtype) * eps)
    states = jax.vmap(partial(_at, scene, start, ts))(orders)
    best, *others = (State(states.theta[i], states.v[i]) for i in range(3))
    root = jnp.sqrt(scene.epsilon)
    moved = [jnp.hypot(x.theta - best.theta, (x.v - best.v) / root) for x in others]
    swing = jnp.minimum(jnp.hypot(jnp.sin(0.5 * best.theta), 0.5 * best.v / root), 1)
    phase = root * (ts + 0.25 / scene.beta) * (swing + jnp.abs(best.v) / root)
    rounded = 32 * eps * phase + 256 * eps * jnp.abs(best.theta)
    error = 2 * (moved[0] + moved[1]) + rounded + 2 * jnp.exp(-0.5 * _LOWEST)
    return best, lax.stop_gradient(error)


def _at(scene: Scene, start: State, ts, orders: Orders) -> State:
    method = taylor(10, 1e-14, 1e-14)

    theta = start.theta + orders.rounded * (jnp.abs(start.theta) + jnp.pi)
    start = State(theta, start.v)
    first = _first(scene, start)
    first = first._replace(energy=first.energy * (1 + orders.rounded))

    def rest(at: Bottom, t):
        v = at.direction * jnp.sqrt(2 * at.energy)
        bottom = March(at.t, State(jnp.zeros_like(v), v))
        # Before the first passage from the start: backwards from there the top magnifies.
        early = t < first.t
        begin = March(jnp.zeros_like(t), start)
        begin = jax.tree.map(lambda x, y: jnp.where(early, x, y), begin, bottom)
        still = ~early & (at.energy <= 0)
        end = until(method, scene, begin, jnp.where(still, at.t, t), 10_000)
        # The turns come last: a large angle has few digits for what is in a turn.
        turns = jnp.where(early, 0, at.turns)
        return State(2 * jnp.pi * turns + end.state.theta, end.state.v)

    return jax.vmap(rest)(sections(scene, first, ts, orders), ts)


def sections(scene: Scene, first: Bottom, ts, orders: Orders) -> Bottom:
    """For every time the last passage of the bottom, or nearly the last, before it."""
    # Turning over, down to the neighbourhood of the separatrix.
    near = _near(scene)
    top = 2 * scene.epsilon
    far_up = first.energy > top + near
    s0 = jnp.where(far_up, -jnp.log(jnp.where(far_up, first.energy - top, near) / top), 0.0)
    s1 = jnp.where(far_up, -jnp.log(near / top), 0.0)
    rotation = _segment(scene, _energy_up, s0, s1, orders)
    whole = lax.stop_gradient(jnp.floor(rotation.table.total[0]))
    after_rotation = _along(scene, rotation, first, whole, whole >= 0, orders)

    # Across it, with what the energy loses by rounding: the same, passage after passage.
    def cross(carry, _):
        at, low = carry
        after, left = _next(scene, at, low)
        done = at.energy < top - near
        return jax.tree.map(lambda x, y: jnp.where(done, x, y), carry, (after, left)), at

    begin = after_rotation, jnp.zeros_like(top)
    (last, _), crossing = lax.scan(cross, begin, length=3 * _NEAR)

    # Swinging.
    e = last.energy / top
    s0 = jnp.log((1 - e) / e)
    span = jnp.max(ts) - last.t
    lowest = e * jnp.exp(-2 * scene.beta * jnp.maximum(span, 0))
    s1 = jnp.minimum(jnp.log((1 - lowest) / jnp.maximum(lowest, jnp.exp(-2 * _LOWEST))), _LOWEST)
    s1 = jnp.maximum(s1, s0 + 1e-3)
    swinging = _segment(scene, _energy_down, s0, s1, orders)

    def at(t):
        row = jnp.maximum(jnp.sum(crossing.t <= t) - 1, 0)
        passing = jax.tree.map(lambda x: x[row], crossing)
        turning, swung = t < after_rotation.t, t >= last.t
        segment = jax.tree.map(lambda x, y: jnp.where(turning, x, y), rotation, swinging)
        begin = jax.tree.map(lambda x, y: jnp.where(turning, x, y), first, last)
        n = _count(segment, t - begin.t)
        along = _along(scene, segment, begin, n, turning, orders)
        # Beyond the table there is no motion left.
        ended = ~turning & (t - last.t > swinging.table.total[1])
        along = along._replace(energy=jnp.where(ended, 0.0, along.energy))
        return jax.tree.map(lambda x, y: jnp.where(turning | swung, x, y), along, passing)

    return jax.vmap(at)(ts)


def _near(scene: Scene) -> Scalar:
    """The energy that `_NEAR` passages take beside the separatrix, 8 β √ε each."""
    return _NEAR * 8 * scene.beta * jnp.sqrt(scene.epsilon)


def _first(scene: Scene, start: State) -> Bottom:
    """The first passage, from anywhere; counted from the start where that is one."""
    well = jnp.round(start.theta / (2 * jnp.pi))
    direction = jnp.where(start.v < 0, -1.0, 1.0).astype(start.v.dtype)
    theta = direction * (start.theta - 2 * jnp.pi * well)
    v = jnp.abs(start.v)
    energy = 0.5 * v * v + 2 * scene.epsilon * jnp.sin(0.5 * theta) ** 2
    here = (theta == 0) & (v > 0)
    before = theta < 0
    # From the bottom itself a dummy, not to be kept.
    place = jnp.where(here, 1.0, jnp.where(before, theta + 2 * jnp.pi, theta))
    to = passage(scene, energy, State(place, v))
    turned = jnp.where(before, 0, jnp.where(to.over, direction, 0))
    after = Bottom(
        to.time,
        energy - scene.beta * to.action,
        well + turned,
        jnp.where(to.over, direction, -direction),
    )
    now = Bottom(jnp.zeros_like(v), energy, well, direction)
    return jax.tree.map(lambda x, y: jnp.where(here, x, y), now, after)


def _next(scene: Scene, at: Bottom, low: Scalar) -> tuple[Bottom, Scalar]:
    """The next passage; `low` is what the energy has below its last digit."""
    to = _from_bottom(scene, at.energy)
    change = low - scene.beta * to.action
    energy = at.energy + change
    after = Bottom(
        at.t + to.time,
        energy,
        at.turns + jnp.where(to.over, at.direction, 0),
        jnp.where(to.over, at.direction, -at.direction),
    )
    return after, change - (energy - at.energy)


def _from_bottom(scene: Scene, energy: Scalar) -> Passage:
    return passage(scene, energy, State(jnp.zeros_like(energy), jnp.sqrt(2 * energy)))


class Segment(NamedTuple):
    """n and ∫T dn along s, and what Euler and Maclaurin's sum has at its beginning."""

    table: Table
    begin: Scalar


def _energy_up(scene: Scene, s: Scalar) -> Scalar:
    return 2 * scene.epsilon * (1 + jnp.exp(-s))


def _energy_down(scene: Scene, s: Scalar) -> Scalar:
    return 2 * scene.epsilon / (1 + jnp.exp(s))


def _segment(scene: Scene, energy, s0: Scalar, s1: Scalar, orders: Orders) -> Segment:
    def rates(s):
        value, slope = jax.jvp(partial(energy, scene), (s,), (jnp.ones_like(s),))
        loss, time, end = _smooth(scene, value, orders)
        dn = -slope / loss
        return jnp.stack([dn, time * dn, end])

    return Segment(*tabulated(rates, s0, s1, integrands=2))


def _smooth(scene: Scene, energy: Scalar, orders: Orders):
    """−dE/dn, T, and an end's part of Euler and Maclaurin's sum."""

    def one(energy, _):
        to = _from_bottom(scene, energy)
        return energy - scene.beta * to.action, (scene.beta * to.action, to.time)

    _, rows = lax.scan(one, energy, length=4)
    (loss, d1, d2, d3), (time, t1, t2, t3) = map(_differences, rows)
    smooth = loss - d1 / 2 + d2 / 3 - orders.last * d3 / 4
    end = -time / 2 + (t1 - t2 / 2 + orders.last * t3 / 3) / 12 - orders.last * t3 / 720
    return smooth, time, end


def _differences(row: Float[Array, " 4"]) -> list[Scalar]:
    """Forward differences of order 0 to 3."""
    found = [row[0]]
    for _ in range(3):
        row = row[1:] - row[:-1]
        found.append(row[0])
    return found


def _count(segment: Segment, since: Scalar) -> Scalar:
    """Passages before a time, one or two too few rather than one too many."""
    s = where_integral(segment.table, 1, since)
    n = jnp.floor(integrals(segment.table, s)[0]) - 1
    return lax.stop_gradient(jnp.maximum(n, 0))


def _along(scene, segment: Segment, start: Bottom, n: Scalar, turning, orders) -> Bottom:
    """`n` passages after `start`."""
    s = where_integral(segment.table, 0, n)
    energy = jnp.where(turning, _energy_up(scene, s), _energy_down(scene, s))
    energy = jnp.where(n > 0, energy, start.energy)
    t = integrals(segment.table, s)[1] + _smooth(scene, energy, orders)[2] - segment.begin
    flips = ~turning & (n % 2 == 1)
    return Bottom(
        start.t + jnp.where(n > 0, t, 0.0),
        energy,
        start.turns + jnp.where(turning, start.direction * n, 0.0),
        jnp.where(flips, -start.direction, start.direction),
    )
