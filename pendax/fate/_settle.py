"""Where a trajectory ends: in which well, or running for ever."""

from functools import partial, reduce

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Float, Int

from .._arrays import common, tolerance, whole
from .._pendulum import Pendulum
from .._results import Result, raise_if
from ..taylor import Scene, State
from ._follow import CAPTURED, GOING, RUNNING, follow, is_captured
from ._rest import rest as at_rest
from ._retrapping import retrapping
from ._saddle import saddle, well_of
from ._scene import require_constant, require_damped

Scalar = Float[Array, ""]

_MOST = 2**22
_BLOCK = 2048


class Settled(eqx.Module):
    """The end of a motion, lane by lane.

    `running`: 0 for captured, +1 or −1 for running that way for ever; `well`: n, the number of
    turns of the bottom, 2πn + arcsin(τ/ε), whose well it is in, and 0 without a meaning where it
    runs; `theta`, rad: where it comes to rest, that bottom, or where dry friction holds it, NaN
    where it runs; `time`, s: when it has come to rest by dry friction, else when all that was
    certain, without derivatives.  Only where `result` is `Result.successful` do they say anything:
    else both integers are 0 and `theta` is NaN.
    """

    running: Int[Array, "*lanes"]
    well: Int[Array, "*lanes"]
    theta: Float[Array, "*lanes"]
    time: Float[Array, "*lanes"]
    result: Result


def settle(
    pendulum: Pendulum,
    v0: ArrayLike,
    theta0: ArrayLike = 0.0,
    *,
    rtol: float | None = None,
    atol: float | None = None,
    max_steps: int | None = None,
    throw: bool = True,
) -> Settled:
    """The end of the motion from (θ0, v0): captured in a well, or running.

    It is followed by Taylor's method no longer than until its fate is sealed: its energy is
    below the saddle that it would have to pass, it creeps where nothing can lift it over that
    saddle, or it has passed a saddle downhill under a torque above τ_r
    ([`retrapping_torque`][]), from where all that passes runs for ever.

    With dry friction it is followed until it is at rest, anywhere in the band
    |ε sin θ − τ| ≤ c, around the top as well; or until it creeps, so damped that it never turns
    again, towards the edge of that band.  Angle and time have derivatives of every mode and order
    in all parameters, but where the number of swings changes (there the angle has a kink, and the
    time jumps), or whether they are enough for one more turn (there both jump).

    **Arguments:**

    - `pendulum`: with damping, dry friction or both, and a constant torque (or none).
    - `v0`, `theta0`: angular velocity, rad/s, and angle, rad.  Shapes broadcast, with the
      leaves of the pendulum.
    - `rtol`, `atol`: tolerances of a step, of which the smaller counts; by default 1e-12, in
      float32 6e-7.
    - `max_steps`: by default many times what it takes, 4 million at most.
    - `throw`: whether a lane without an end raises, or says *unsettled* in `result`.

    **Returns:** a [`Settled`][].  At |τ| > ε nothing is captured, whatever the start.  Wells
    are numbered as angles are: a motion towards negative angles ends in negative wells.

    **Raises:** `ValueError` for β and c `None` and for a τ that is a function of time;
    `RuntimeError` for lanes without an end: no friction, a start that is exactly on a saddle, which
    float(π) is not, `max_steps` reached.  NaN, parameters outside their domain and |θ0| above
    0.1/eps, which has no digits of a turn left, say so in their `result`.

    A start is right whose boundary is farther away than the error of the steps, 1e-10 or so;
    the boundaries themselves are [`critical_torque`][] and [`well_boundaries`][].
    The angle of dry friction is within 1e3 tolerances times κ ([`condition`][]).
    Suzuki & Suzuki §7.2, §8.2.
    """
    if isinstance(pendulum, Pendulum) and pendulum.dry is not None:
        require_constant(pendulum, "its end")
    else:
        require_damped(pendulum, "its end without dry friction `dry`")
    rtol, atol = tolerance("rtol", rtol), tolerance("atol", atol)
    most = None if max_steps is None else whole("max_steps", max_steps, 1)
    terms = {"beta": pendulum.beta, "tau": pendulum.tau, "dry": pendulum.dry}
    given = {"epsilon": pendulum.epsilon, "v0": v0, "theta0": theta0}
    given |= {name: x for name, x in terms.items() if x is not None}
    lanes = dict(zip(given, common(**given), strict=True))
    dtype = lanes["epsilon"].dtype
    if dtype in (jnp.float16, jnp.bfloat16):
        raise ValueError(f"Arguments must be float32 or float64 to be followed, but got {dtype}.")
    rtol = rtol or max(1e-12, float(jnp.finfo(dtype).eps) ** 0.9)
    found = _settle(min(rtol, atol or rtol), most, lanes)
    if throw:
        unsettled = found.result == Result.unsettled
        message = f"{Result[Result.unsettled]} `throw=False` says in which lane."
        found = eqx.tree_at(lambda x: x.time, found, raise_if(found.time, unsettled, message))
    return found


@partial(jax.jit, static_argnums=(0, 1))
def _settle(rtol: float, most: int | None, lanes: dict[str, Float[Array, "..."]]) -> Settled:
    def one(lane):
        return _one(rtol, most, **lane)

    shape = lanes["epsilon"].shape
    flat = {name: x.ravel() for name, x in lanes.items()}
    # In blocks: the slowest lane holds up its neighbours alone.
    few = flat["epsilon"].size <= _BLOCK
    found = jax.vmap(one)(flat) if few else lax.map(one, flat, batch_size=_BLOCK)
    return jax.tree.map(lambda x: x.reshape(shape), found)


def _one(
    rtol: float, most: int | None, epsilon, v0, theta0, beta=None, tau=None, dry=None
) -> Settled:
    good = (epsilon > 0) & (epsilon < jnp.inf) & jnp.isfinite(v0)
    for friction in (beta, dry):
        if friction is not None:
            good = good & (friction >= 0) & (friction < jnp.inf)
    if tau is not None:
        good = good & jnp.isfinite(tau)
    # An angle that has lost its turn has no well.
    good = good & (jnp.abs(theta0) < 0.1 / jnp.finfo(theta0.dtype).eps)
    root = jnp.sqrt(jnp.where(good, epsilon, 1))
    mirror = jnp.ones_like(root)

    def known(x, otherwise):
        # A lane without an answer hangs at rest.
        return None if x is None else jnp.where(good, x, otherwise)

    if tau is not None:
        mirror = jnp.where(tau < 0, -1, 1).astype(root.dtype)
        tau = known(mirror * tau / (root * root), 0)
    beta = known(None if beta is None else beta / root, 1)
    dry = known(None if dry is None else dry / (root * root), 1)
    start = State(known(mirror * theta0, 0), known(mirror * v0 / root, 0))
    speed = lax.stop_gradient(jnp.abs(start.v))
    slowing = reduce(jnp.maximum, [x for x in (beta, dry) if x is not None], 1e-12)
    if dry is None:
        enough = 2000 + 20 * (speed + 4) / slowing
    else:
        enough = 2000 + 50 * (speed * speed + 4) / slowing
    limit = jnp.minimum(enough, _MOST).astype(jnp.int32) if most is None else most
    if dry is None:
        still = lax.stop_gradient((beta, tau, start))
        end, state, t = fate(*still, limit, rtol)
        at = saddle(jnp.zeros_like(root) if tau is None else lax.stop_gradient(tau))
        theta = 2 * jnp.pi * (well := well_of(at, state.theta))
        if tau is not None:
            theta = theta + jnp.arcsin(jnp.where(end == CAPTURED, tau, 0))
    else:
        limit = lax.stop_gradient(limit)
        (theta, t), (end, well) = at_rest(beta, tau, dry, start, limit, rtol)
    captured = end == CAPTURED
    result = Result.where(end == GOING, Result.unsettled, Result.successful)
    return Settled(
        jnp.where(end == RUNNING, mirror, 0).astype(int),
        jnp.where(captured, mirror * well, 0).astype(int),
        jnp.where(captured & good, mirror, jnp.nan) * theta,
        jnp.where(good, 1, jnp.nan) * (t / (lax.stop_gradient(root) if dry is None else root)),
        Result.where(good, result, Result.not_a_number),
    )


def fate(beta, tau, start: State, most, rtol: float):
    """Of ε = 1 and τ ≥ 0 or `None`: how it ends, in which state that was certain, and when."""
    scene = Scene(1 + 0 * beta, beta, tau)
    at = saddle(jnp.zeros_like(beta) if tau is None else tau)
    running = None if tau is None else tau > retrapping(beta)

    def end_of(before: State, after: State):
        captured = jnp.where(is_captured(scene, at, after), CAPTURED, GOING)
        if running is None:
            return captured
        passed = well_of(at, after.theta) > well_of(at, before.theta)
        return jnp.where(passed & running, RUNNING, captured)

    first = jnp.where(is_captured(scene, at, start), CAPTURED, GOING)
    if tau is not None:
        first = jnp.where(tau > 1, RUNNING, first)
    # Nothing ends without damping.
    first, most = jnp.where(beta > 0, first, GOING), jnp.where(beta > 0, most, 0)
    found = follow(scene, start, end_of, first, most, rtol)
    return found.end, found.state, found.t
