"""A recorded motion: what is wrong with it, and the state that it seems to start in."""

from itertools import pairwise
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from .._arrays import aligned, common, concrete, floating, require
from .._pendulum import Pendulum
from ._thin_qr import reduced, substituted
from ._turns import turning_points

Samples = Float[Array, "runs samples"]


class Recording(NamedTuple):
    """Runs side by side; where `there` is False, neither times nor values mean anything.

    `weight` and `velocity_weight` are 1 over the standard errors, or 1; 0 where nothing is there.
    """

    ts: Samples
    theta: Samples
    weight: Samples
    there: Bool[Array, "runs samples"]
    velocity: Samples | None
    velocity_weight: Samples | None


def recording_of(ts, theta, velocity, sigma, mask, guess: Pendulum, unwrap: bool) -> Recording:
    """Checked where its values can be seen, one run a row."""
    of_theta, of_velocity = sigma if isinstance(sigma, tuple) else (sigma, None)
    if sigma is None and velocity is not None:
        of_velocity = jnp.sqrt(guess.epsilon)
    for x in (of_theta, of_velocity):
        require("sigma", x, "positive", lambda x: x > 0)
    if (velocity is None) != (of_velocity is None):
        raise ValueError(
            "Argument `sigma` must be a pair, of `theta` and of `velocity`, where both are fitted, "
            "and one where `theta` is alone."
        )
    given = {"ts": ts, "theta": theta, "velocity": velocity}
    given = {name: x for name, x in given.items() if x is not None}
    for name, x in given.items():
        aligned(**{name: x})  # an array of real numbers
    shape = jnp.shape(theta)
    if len(shape) not in (1, 2) or 0 in shape:
        raise ValueError(
            f"Argument `theta` must have one axis of samples, or two, runs first, but got {shape}."
        )
    for name, x in given.items():
        if jnp.shape(x) not in (shape, shape[-1:]):
            raise ValueError(
                f"Argument `{name}` must have shape {shape}, that of `theta` (runs first, samples "
                f"last), but got {jnp.shape(x)}."
            )
    there = jnp.ones(shape, bool) if mask is None else jnp.asarray(mask)
    if there.dtype != bool or there.shape != shape:
        raise ValueError(
            f"Argument `mask` must be booleans of shape {shape}, but got {there.dtype} of shape "
            f"{there.shape}."
        )

    def rows(x):
        x = jnp.asarray(common(sigma=x)[0], floating(1.0))
        return jnp.broadcast_to(x, shape).reshape(-1, shape[-1])

    ts, theta = rows(ts), rows(theta)
    velocity = None if velocity is None else rows(velocity)
    there = there.reshape(theta.shape)
    times, angles, known = (concrete(x) for x in (ts, theta, there))
    if times is not None and angles is not None and known is not None:
        speeds = None if velocity is None else concrete(velocity)
        epsilon = concrete(guess.epsilon)
        rate = 0.0 if epsilon is None else float(np.sqrt(epsilon))
        _require_recording(times, angles, speeds, known, guess.tau, unwrap, rate)
    if unwrap:
        theta = _unwrapped(theta, there)
    one = jnp.ones_like(theta)
    weight, speed_weight = (
        jnp.where(there, one if x is None else 1 / rows(x), 0) for x in (of_theta, of_velocity)
    )
    if velocity is None:
        speed_weight = None
    return Recording(_filled(ts, there), theta, weight, there, velocity, speed_weight)


def _filled(ts, there):
    """Times that stand still where nothing was measured: the next is no earlier."""
    first = jnp.min(jnp.where(there, ts, jnp.inf), axis=1, keepdims=True)
    known = jnp.where(there, ts, -jnp.inf)
    return jnp.maximum(jax.lax.cummax(known, axis=1), first)


def _unwrapped(theta, there):
    """Along the samples that are there."""
    order = jnp.argsort(~there, axis=1, stable=True)
    dense = jnp.take_along_axis(jnp.where(there, theta, 0), order, 1)
    back = jnp.argsort(order, axis=1, stable=True)
    return jnp.where(there, jnp.take_along_axis(jnp.unwrap(dense, axis=1), back, 1), theta)


def start_of(
    recording: Recording, epsilon: Float[Array, ""]
) -> tuple[Float[Array, " runs"], Float[Array, " runs"]]:
    """θ0 and v0 of each run: a parabola through its first samples, a radian of √ε t of them."""
    first = recording.ts[:, :1]
    elapsed = recording.ts - first
    fifth = elapsed[:, min(4, elapsed.shape[1] - 1)]
    reach = jnp.maximum(1 / jnp.sqrt(epsilon), fifth)[:, None]
    t = elapsed / reach
    weight = jnp.where(recording.there & (t <= 1), recording.weight, 0)
    powers = jnp.stack([jnp.ones_like(t), t, t * t], -1) * weight[..., None]
    # A trace of a prior, for runs of fewer than three samples.
    prior = jnp.broadcast_to(1e-6 * jnp.eye(3, dtype=t.dtype), (t.shape[0], 3, 3))
    values = jnp.where(weight > 0, recording.theta, 0) * weight
    rows = jnp.concatenate([powers, prior * jnp.max(weight)], 1)
    right = jnp.pad(values, ((0, 0), (0, 3)))
    found = jax.vmap(lambda a, b: substituted(*reduced(a, b)))(rows, right)
    v0 = found[:, 1] / reach[:, 0]
    if recording.velocity is not None:
        first = jnp.argmax(recording.there, axis=1)[:, None]
        v0 = jnp.take_along_axis(recording.velocity, first, 1)[:, 0]
    return found[:, 0], v0


def _require_recording(
    ts: np.ndarray,
    theta: np.ndarray,
    velocity: np.ndarray | None,
    mask: np.ndarray,
    tau: object,
    unwrap: bool,
    rate: float,
) -> None:
    """ValueError for what can't be fitted, or is not what it is taken for."""
    for name, x in (("ts", ts), ("theta", theta), ("velocity", velocity)):
        if x is None:
            continue
        bad = mask & ~np.isfinite(x)
        if (bad == mask).all():
            raise ValueError(f"Argument `{name}` must be finite, but none of its samples is.")
        if bad.any():
            where = tuple(int(i[0]) for i in np.nonzero(bad))
            where = where[1] if bad.shape[0] == 1 else where
            raise ValueError(
                f"Argument `{name}` must be finite, but got {x[bad][0]} at {where}; "
                "leave such samples out, or give a `mask` that is False there."
            )
    for t, x, there in zip(ts, theta, mask, strict=True):
        t, x = t[there], x[there]
        if t.size < 2:
            raise ValueError(
                "Argument `mask` must leave two or more samples of each run, "
                f"but got {t.size} of one."
            )
        back = np.flatnonzero(np.diff(t) <= 0)
        if back.size:
            i = back[0]
            raise ValueError(f"Argument `ts` must increase, but got {t[i + 1]} after {t[i]}.")
        if np.ptp(x) == 0:
            raise ValueError(
                f"Argument `theta` must move, but it is {x[0]:.6g} at all times of a run."
            )
        _require_resolved(t, rate)
        _require_radians(x, tau)
        if not unwrap:
            _require_unwrapped(t, x)


def _require_resolved(t: np.ndarray, rate: float) -> None:
    """Samples a small-angle period apart tell nothing of a phase."""
    turns = float(np.median(np.diff(t))) * rate / (2 * np.pi)
    if turns > 1:
        raise ValueError(
            f"Argument `ts` must be in the unit of the `guess`, seconds if ε is in 1/s², but its "
            f"steps are {turns:.3g} small-angle periods 2π/√ε long."
        )


def _require_radians(x: np.ndarray, tau: object) -> None:
    """No pendulum swings to and fro through more than 2π; half a turn more is for noise.

    A constant torque turns back once what is thrown against it, and a torque that varies may do
    anything, but not ten turns at a time.
    """
    swings = np.diff(x[turning_points(x, 0.1)])
    least = (20 if callable(tau) else 3) * np.pi
    big = np.abs(swings) > least
    several = 1 if tau is None or callable(tau) else 2
    together = (
        np.convolve(big, np.ones(several + 1), "valid") if big.size > several else np.zeros(1)
    )
    if together.max() > several:
        raise ValueError(
            "Argument `theta` must be in radians, but it swings through "
            f"{swings.max():.4g} and back through {-swings.min():.4g}, which no pendulum does: "
            "degrees? Pass numpy.radians(theta)."
        )


def _require_unwrapped(t: np.ndarray, x: np.ndarray) -> None:
    """A jump by a turn that its neighbours know nothing of, or two in the same direction."""
    steps = np.diff(x)
    quiet = np.diff(t) < 2.5 * np.median(np.diff(t))
    for turn, unit in ((2 * np.pi, "radians"), (360.0, "degrees")):
        if np.ptp(x) > 1.05 * turn:
            continue
        jumps = np.flatnonzero((np.abs(np.abs(steps) - turn) < 0.25 * turn) & quiet)
        inner = jumps[(jumps > 0) & (jumps < steps.size - 1)]
        beside = np.stack([steps[inner - 1], steps[inner + 1]]) * np.sign(steps[inner])
        # Against the motion before and after it.
        alone = inner[(np.abs(beside).max(0, initial=0) < 0.1 * turn) & (beside.sum(0) < 0)]
        onwards = [i for i, j in pairwise(jumps) if steps[i] * steps[j] > 0 and j > i + 1]
        if alone.size or onwards:
            i = int([*alone, *onwards][0])
            raise ValueError(
                f"Argument `theta` must not be wrapped, but it jumps from {x[i]:.4g} to "
                f"{x[i + 1]:.4g} in {unit} between two samples: pass `unwrap=True` if these are "
                "rotations." + (" Convert it to radians first." if unit == "degrees" else "")
            )
