"""One door to a trajectory: the closed form where there is one, a method for the rest."""

from functools import partial
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import aligned, common, concrete, require, tolerance, whole, widened
from ._method import choose
from ._motion import motion
from ._pendulum import Pendulum, require_free
from ._recorded import with_record
from ._results import Result, raise_if, where
from ._torque import SampledTorque


class Trajectory(eqx.Module):
    """θ(t) and θ̇(t) at given times.

    `ts` has the times, of any shape; `theta` and `v` have the shape of the lanes
    followed by that of `ts`; `result` has the shape of the lanes.  θ is unwrapped.
    `method` names what answered; `stats` has its `steps`, `accepted` and `rejected`, lane by
    lane, or, of averaging, the `error` that θ and v/√ε may have at all times, rad, estimated
    from above; the closed form has none.
    """

    ts: Float[Array, "*times"]
    theta: Float[Array, "*lanes_and_times"]
    v: Float[Array, "*lanes_and_times"]
    result: Result
    stats: dict[str, Array]
    method: str = eqx.field(static=True)


def simulate(
    pendulum: Pendulum,
    ts: ArrayLike,
    v0: ArrayLike,
    theta0: ArrayLike = 0.0,
    *,
    t0: ArrayLike = 0.0,
    solver: Any = None,
    stepsize_controller: Any = None,
    dt0: ArrayLike | None = None,
    adjoint: Any = None,
    rtol: float | None = None,
    atol: float | None = None,
    max_steps: int | None = None,
    throw: bool = True,
) -> Trajectory:
    """The motion through (θ0, v0) at time `t0`, by the method that its scene asks for.

    - Neither damping nor torque: the closed form.
    - τ constant or a [`SampledTorque`][]: Taylor's method for this equation; where τ is constant
      and β² > 4000 (ε + |τ|), on the slow curve v(θ) once v has relaxed to it, so that the steps
      don't grow with β.
    - Dry friction: the same from one turning point to the next, each at its own time to rounding,
      forward in time; derivatives go through the turning points.
    - No torque, no dry friction, 0 < β ≤ 3e-4 √ε in all lanes and more than 10⁴/√ε to follow, in
      float64 and with neither `rtol`, `atol` nor `max_steps`: averaging over turns, some 0.2 s
      however long.
    - τ a function of t made by sums and products, to the third power of t, of sin, cos and exp of
      what is linear in t: Taylor's method as well, unless β is as large as above, or an exponent
      changes by more than 300, after which nothing is left of it.  `simulate` reads that off the
      function; its steps are as short as its quickest part asks for, however small that is.
    - τ another function of t, or with such a β: diffrax's `Dopri8`, or its `Kvaerno5`.  A pulse
      shorter than their steps may be stepped over: a saved time within it, or `dtmax` of a
      `PIDController`, prevents that.

    Under a transformation β may be hidden: the program then has both of the second line's, and
    never the third's.

    **Arguments:**

    - `pendulum`: the scene, ε in 1/s², β in 1/s, τ in 1/s², a number or a function of t that JAX
      can trace, and differentiate by what it closes over.  A function is read at every call: what
      it holds may have changed, and functions that read alike share a compiled program, which a
      Python number is part of: `jnp.asarray` makes one that may change without compiling anew.
      (JAX itself goes on with what it once read in a `jax.jit` of your own inside, and in a named
      function given to `lax.cond`, a loop of `lax` or `jax.checkpoint`.)  By the time of a jump,
      `a` in `jnp.where(t > a, …)`, JAX's derivative is 0.
    - `ts`: times, s; for the closed form in any order and of either sign, else one axis,
      monotone away from `t0`.
    - `v0`, `theta0`: angular velocity, rad/s, and angle, rad, at `t0`, s.
    - `solver`: a diffrax solver (an instance) instead.  One that takes a single
      term, or for scenes without damping a pair, (θ̇(v), v̇(θ)), such as
      `diffrax.SemiImplicitEuler()` or [`pendax.solvers.Symplectic`][]`(4)`.
    - `stepsize_controller`, `dt0`, `adjoint`: diffrax's, and its `Dopri8` without a
      `solver`.  By default a `PIDController` of
      `rtol` and `atol`, or, with `dt0` or a solver without error estimate, constant steps
      of |dt0| at most.  Without `adjoint`, derivatives are those of the variational
      equations, solved along: every mode and order, memory independent of the number of
      steps; for a pair of terms, diffrax's `RecursiveCheckpointAdjoint` (reverse mode).
    - `rtol`, `atol`: tolerances of a step, by default 8e-15 for Taylor's method and 2e-12 for
      diffrax's (in float32 6e-7 and 6e-6); `atol` as `rtol`.
    - `max_steps`: at most so many steps (between saved times, where they are constant); by
      default many times what the scene and the span can need.
    - `throw`: whether a solver that fails raises, or says so in `result`.

    The leaves of the scene, `v0`, `theta0` and `t0` broadcast: they are the lanes, each
    followed through all of `ts`.  Times that differ from lane to lane come through `jax.vmap`.

    **Returns:** a [`Trajectory`][], libration, rotation and the separatrix alike.  In the
    closed form there is no solver in the compiled program, and no kink anywhere: θ and v
    are analytic functions of all arguments, and so are their derivatives of every order.
    Saved times of a solver are ends of its steps; those that it did not reach are NaN.  So
    are derivatives of what is NaN, and, in reverse mode, of a sum over other lanes by what they
    share with it, even where it is masked: put another start in its place instead.

    **Raises:** `ValueError` for a solver's options where the closed form answers, for a τ(t) that
    is not one real number, and for times that are not monotone where a solver does; `RuntimeError`
    where a solver fails: too many steps, steps held small by the damping, a number that is not
    finite.  NaN, infinities, and under a transformation ε ≤ 0, β < 0 and c < 0, give NaN in their
    own lane, and its `result` says so.  Traced times can't be checked to be monotone: by Taylor's
    method they are followed in the order given; diffrax checks several of them by a callback, which
    keeps the program out of JAX's persistent cache but for `EQX_ON_ERROR=nan` in the environment:
    NaN instead of an error.

    **Accuracy** of the closed form: 16 eps of |f| + Σ |x ∂f/∂x| over ε, t, v0, θ0 for f = θ
    and of that + |t ε sin θ| for v, for |v0| up to 1e8, |θ0| to 1e3, 1e6 periods, ε from
    1e-12 to 1e12.  From the bottom |v0 − 2√ε| counts to its last digit; from elsewhere a
    rounding of θ0 may decide between a swing and a turn, where the floats as given are as
    near to the separatrix as that.  First derivatives g = ∂f/∂x are within 1e-11, second
    ones within 1e-8, of |g| + Σ |y ∂g/∂y| + that of f over |x| (or 1, if larger; for ε over
    ε): ∂/∂ε has the fewest digits where ε matters least, in fast rotations.  On the
    separatrix derivatives grow like e^(√ε t); where they leave the range of the floats a
    large number stands for them.

    Of a solver: within 50 × tolerance × (1 + max|y|) (1 + κ), κ what perturbations grow by
    ([`condition`][]) and the tolerance the larger of the two; 14 instead of 50 was the most in
    random scenes by Taylor's method, 4.0 at the default.  That is from the torque that τ(t) gives:
    at a late t a rounding of t may count for more.  Its first derivatives came within 0.92
    × tolerance × the same two factors × (1 + their size), second ones within 6.5 of that × (1 +
    κ).  Of averaging: below the error that it states, wherever that was checked, for β down to
    1e-8: at t = 5/β some 1e-9 to 1e-7 rad where 1e-8 to 6e-6 are stated, and both large for a
    start at the top, which magnifies a rounding of θ0.

    With dry friction derivatives jump where the number of turning points changes: where the
    pendulum comes to rest just below, or just above, the edge of what friction holds.  For v0 = 0
    those in v0 are of the motion that begins; on the other side of 0 they are others.

    Suzuki & Suzuki §2.3, §3.1; with a solver §5, §7, §8.
    """
    options = {
        "stepsize_controller": stepsize_controller,
        "dt0": dt0,
        "adjoint": adjoint,
        "rtol": rtol,
        "atol": atol,
        "max_steps": max_steps,
    }
    if solver is not None or (isinstance(pendulum, Pendulum) and not pendulum.is_free):
        return _integrated(pendulum, ts, v0, theta0, t0, solver, throw, options)
    require_free(pendulum, "its motion in closed form")
    for name, option in options.items():
        if option is not None:
            raise ValueError(
                f"Argument `{name}` must come with a `solver`: the closed form has no use for it."
            )
    (ts,) = common(ts=ts)
    times, epsilon, v0, theta0, t0 = _lanes(ts, pendulum.epsilon, v0, theta0, t0)
    theta, v = widened(motion)(epsilon, times - t0, v0, theta0)
    lanes = tuple(range(theta.ndim - ts.ndim, theta.ndim))
    bad = ~jnp.all(jnp.isfinite(theta) & jnp.isfinite(v), axis=lanes)
    return Trajectory(
        ts, theta, v, where(bad, Result.not_a_number, Result.successful), {}, "closed form"
    )


def _lanes(ts: Float[Array, "..."], *lanes: ArrayLike) -> list[Float[Array, "..."]]:
    """`ts` behind the axes of the lanes, all of one rank and dtype.

    They are not broadcast: what depends on the lane alone is computed once for all times.
    """
    names = ("epsilon", "v0", "theta0", "t0")
    lane = common(**dict(zip(names, lanes, strict=True)))
    shape = lane[0].shape + (1,) * ts.ndim
    behind = [jnp.reshape(x, shape) for x in lane]
    times = jnp.reshape(ts, (1,) * lane[0].ndim + ts.shape)
    return aligned(ts=times, **dict(zip(names, behind, strict=True)))


def _integrated(pendulum, ts, v0, theta0, t0, solver, throw, options) -> Trajectory:
    for name in ("rtol", "atol"):
        options[name] = tolerance(name, options[name])
    require("dt0", options["dt0"], "a step other than zero", lambda x: x != 0)
    if options["max_steps"] is not None:
        options["max_steps"] = whole("max_steps", options["max_steps"], 1)
    given = ts, t0, v0
    (ts,) = common(ts=ts)
    if ts.ndim > 1:
        raise ValueError(f"Argument `ts` must have one axis at most, but got shape {ts.shape}.")
    numbers = {"v0": v0, "theta0": theta0, "t0": t0, "epsilon": pendulum.epsilon}
    for name in ("beta", "tau", "dry"):
        leaf = getattr(pendulum, name)
        if leaf is not None and not callable(leaf):
            numbers[name] = leaf
    lanes = dict(zip(numbers, common(**numbers), strict=True))
    dtype = jnp.result_type(ts, lanes["v0"])
    if dtype in (jnp.float16, jnp.bfloat16):
        raise ValueError(f"Arguments must be float32 or float64 for a solver, but got {dtype}.")
    require_monotone(ts, t0)
    if isinstance(pendulum.tau, SampledTorque):
        pendulum.tau.require_within(ts, t0)
    pendulum = with_record(pendulum, dtype)
    if options["dt0"] is not None:
        options["dt0"] = jnp.asarray(options["dt0"], dtype)
    shape = lanes["v0"].shape
    if 0 in shape:  # no lane asks for anything
        pendulum, given = Pendulum(), (0.0, 0.0, 0.0)
    method = choose(pendulum, *given, dtype, solver, options)
    if 0 in shape + ts.shape:
        empty, none = jnp.zeros(shape + ts.shape, dtype), jnp.zeros(shape, bool)
        return Trajectory(
            ts, empty, empty, where(none, Result.successful, Result.successful), {}, method.name
        )

    times, theta, v, result, stats = _solved(pendulum, ts, lanes, method)
    if throw:
        for how, cure in _CURES:
            theta = raise_if(theta, result == how, f"{Result[how]} {cure}")
    return Trajectory(times, theta, v, result, stats, method.name)


_CURES = (
    (Result.too_many_steps, "Raise `max_steps`, or `rtol`; `throw=False` says in which lane."),
    (Result.too_stiff, "Use `solver=diffrax.Kvaerno5()`; `throw=False` says in which lane."),
    (Result.solver_failed, "`throw=False` says in which lane, and has NaN from there on."),
)


@eqx.filter_jit
def _solved(pendulum, ts, lanes, method):
    """One program, compiled once for all calls alike: of many small ones each takes its time."""
    shape, dtype = lanes["v0"].shape, jnp.result_type(ts, lanes["v0"])
    # A lane without an answer must not keep the others waiting.
    bad = ~jnp.all(jnp.stack([jnp.isfinite(x) for x in lanes.values()]), 0)
    bad = bad | ~jnp.all(jnp.isfinite(ts)) | (lanes["epsilon"] <= 0)
    for name in ("beta", "dry"):
        if name in lanes:
            bad = bad | (lanes[name] < 0)
    # At rest, without forces: a single step.
    rest = dict.fromkeys(lanes, 0.0) | {"epsilon": 1e-30}
    # Their derivatives, 0 · NaN in every argument and every mode.
    wrong = jnp.reshape(sum(jnp.where(bad, x, 0) for x in lanes.values()), (-1, 1))
    wrong = (wrong + ts.astype(dtype).reshape(1, -1)) * jnp.where(bad, jnp.nan, 0).reshape(-1, 1)
    lanes = {name: jnp.where(bad, rest[name], x) for name, x in lanes.items()}
    times = jnp.where(jnp.all(jnp.isfinite(ts)), ts, 0).astype(dtype)

    def one(lane):
        terms = {name: lane[name] for name in ("epsilon", "beta", "tau", "dry") if name in lane}
        scene = eqx.tree_at(
            lambda p: [getattr(p, name) for name in terms], pendulum, list(terms.values())
        )
        at = jnp.atleast_1d(times), lane["v0"], lane["theta0"], lane["t0"]
        return method(scene, *at)

    flat = {name: x.astype(dtype).reshape(-1) for name, x in lanes.items()}
    theta, v, result, stats = jax.vmap(one)(flat)
    # A factor, that derivatives are NaN as well; each its own, or v alone would need all of θ.
    lost = (jnp.where(jnp.isinf(x), jnp.nan, jnp.ones_like(x)) for x in (theta, v))
    theta, v = (
        jnp.reshape(x * factor + wrong, shape + ts.shape)
        for x, factor in zip((theta, v), lost, strict=True)
    )
    select = jax.vmap(Result.where, in_axes=(0, None, 0))
    result = select(bad.reshape(-1), Result.not_a_number, result)
    by_lane = partial(jax.tree.map, lambda x: x.reshape(shape))
    return times, theta, v, by_lane(result), by_lane(stats)


def require_monotone(ts, t0) -> None:
    seen, start = concrete(ts), concrete(t0)
    if seen is None or start is None or 0 in (seen.size, start.size):
        return
    if np.isnan(seen).any() or np.isnan(start).any():
        return  # no order is wrong, and no answer a number
    steps = np.diff(np.atleast_1d(seen))
    first, last = np.min(np.atleast_1d(seen)), np.max(np.atleast_1d(seen))
    onwards = np.all(steps >= 0) and np.all(first >= start)
    backwards = np.all(steps <= 0) and np.all(last <= start)
    if not (onwards or backwards):
        raise ValueError(
            "Argument `ts` must be monotone and away from `t0` for a solver, as 0, 1, 2 or "
            f"0, −1, −2 from t0 = 0 on, but got {seen} and t0 = {start}."
        )
