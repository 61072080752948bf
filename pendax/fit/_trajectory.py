"""The terms of a scene, and how its motion began, from a recording of it."""

from collections.abc import Callable, Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, concrete, floating, whole
from .._method import Method, TaylorSeries, choose
from .._pendulum import Pendulum
from .._recorded import with_record
from .._torque import SampledTorque
from ..taylor import Scene, State, budget, is_overdamped
from ._fit import Fit
from ._judgement import ended
from ._parameters import Parameters
from ._recording import Recording, recording_of, start_of
from ._search import Search
from ._terms import MAY_VANISH, OF_SCENE, POSITIVE, begun, numbers_of, scales, widened, with_numbers

FIRST = 2.0  # radians of √ε t that the first stretch has


def fit_trajectory(
    ts: ArrayLike,
    theta: ArrayLike,
    guess: Pendulum,
    *,
    v0: ArrayLike | None = None,
    theta0: ArrayLike | None = None,
    fixed: Sequence[str] = (),
    velocity: ArrayLike | None = None,
    sigma: ArrayLike | tuple[ArrayLike, ArrayLike] | None = None,
    mask: ArrayLike | None = None,
    offset: ArrayLike | None = None,
    loss: Callable | None = None,
    optimiser: Any = None,
    starts: int = 1,
    steps: int | None = None,
    unwrap: bool = False,
    progress: Callable[[float], Any] | None = None,
) -> Fit[Pendulum]:
    """The terms of a scene and its initial state, from a recording of its motion.

    Weighted least squares by Levenberg–Marquardt, on a stretch of two radians of √ε t first, then
    on stretches that double up to all of the recording: over many turns a phase has a minimum at
    every one of them, and what is known from one stretch tells the right one of the next.  The
    motion is that of [`simulate`][]: the closed form without friction and torque, Taylor's method
    for constant ones and recorded torques, diffrax for a torque that is another function of time.

    **Arguments:**

    - `ts`, `theta`: times, s, increasing, and angles, rad, not wrapped, one axis of samples; the
      initial state holds at the first time.  Several runs of one pendulum are a leading axis of
      `theta` (and of `ts`, unless they share it): v0, θ0 and offset are then each run's own.
    - `guess`: the scene to start from.  Terms that it has are fitted, those that are `None` stay
      out, and a τ that is a function of time is held; of a [`SampledTorque`][] its inertia and
      bias are terms.  ε, and friction, may be some tens of percent off; a β of 0 starts from
      1e-3 √ε, a dry friction of 0 from 1e-3 ε.
    - `v0`, `theta0`: where the initial state starts from, rad/s and rad, one number or one a run.
      `None`: a parabola through the first samples.
    - `fixed`: names among epsilon, beta, tau, dry, inertia, bias, v0, theta0, offset that are held
      where they start.
    - `velocity`: measured θ̇, rad/s, fitted together with `theta`.
    - `sigma`: standard errors of the angles, rad, a number or one a sample; with `velocity` a pair,
      that of angles and that of velocities.  Their ratios are the weights, and `reduced_chi2` is
      with respect to them.  `None`: equal weights, velocities in units of √ε.
    - `mask`: `False` where nothing was measured, of the shape of `theta`.  Neither angles nor times
      count there.  Gaps in time need none.
    - `offset`: of the angle, rad, to start from: `theta` is then fitted by θ(t) + offset.
      `None`: no such parameter.
    - `loss`: ρ(r) of a standardised residual, a smooth function like r²/2 near 0, such as
      `lambda r: jnp.log1p(r * r / 2)` against outliers; in units of `sigma`, so give it.
    - `optimiser`: one of optax's, which takes `steps` of Σ ρ from where Levenberg–Marquardt
      ended.
    - `starts`: so many starts side by side, the guess and others around it, some 30 % off; the best
      one is returned.
    - `steps`: at most, by default 100 (2000 of an `optimiser`), 40 on a stretch before the last.
    - `unwrap`: whether jumps of more than π between samples are whole turns.
    - `progress`: called with the share of the work that has been done since the last call.

    **Returns:** a [`Fit`][], scalars, or one value a run, in `v0`, `theta0` and `offset`.  Under
    `jax.vmap` many fits are one program.

    **Raises:** `ValueError` for samples that are not finite, constant angles, times that don't
    increase, no more samples than parameters, angles that can only be degrees, wrapped ones, and
    names that are not fitted.  Under a transformation data are not looked at; NaN among them
    gives a `result` other than *successful*.

    **Accuracy:** the minimum to 1e-4 of the standard errors, or to rounding where there is no
    noise; `result` is *not converged* where it may be 1e-3 of them off.
    """
    given = numbers_of(guess)
    terms = {name: jnp.asarray(x, floating(1.0)) for name, x in given.items()}
    guess = widened(guess)
    fixed = (fixed,) if isinstance(fixed, str) else tuple(fixed)
    starts = whole("starts", starts, 1)
    steps = whole("steps", (100 if optimiser is None else 2000) if steps is None else steps, 1)
    recording = recording_of(ts, theta, velocity, sigma, mask, guess, unwrap)
    if isinstance(guess.tau, SampledTorque):
        guess.tau.require_within(recording.ts)
    dtype, shape = floating(ts, theta, *given.values()), jnp.shape(theta)
    held, parameters = _parameters(
        terms, recording, {"v0": v0, "theta0": theta0, "offset": offset}, fixed
    )
    _require_enough(mask, recording, parameters)
    scene = with_record(guess, recording.ts.dtype)
    search = Search(
        recording,
        scene,
        held,
        parameters,
        _ends(recording, terms["epsilon"]),
        _method(scene, recording, held | parameters.start),
        loss,
        optimiser,
        starts,
        steps,
        sigma is not None,
        progress,
    )
    found = search.run()

    def shaped(name, x):
        x = jnp.asarray(x, dtype)
        return x[0] if name in ("v0", "theta0", "offset") and len(shape) == 1 else x

    values = held | parameters.split(found.values)
    values = {name: shaped(name, x) for name, x in values.items()}
    errors = parameters.split(found.judgement.errors)
    model = with_numbers(guess, {name: values[name] for name in terms})
    residuals = recording.theta - found.theta
    speed = None if recording.velocity is None else recording.velocity - found.velocity
    return Fit(
        model=model,
        v0=values["v0"],
        theta0=values["theta0"],
        offset=values.get("offset"),
        errors={name: shaped(name, x) for name, x in errors.items()},
        covariance=found.judgement.covariance.astype(dtype),
        residuals=residuals.reshape(shape).astype(dtype),
        history=found.history.astype(dtype),
        result=ended(found.judgement, found.loss, found.goodness.runs, found.unexplained),
        reduced_chi2=found.goodness.reduced_chi2.astype(dtype),
        runs=found.goodness.runs.astype(dtype),
        velocity_residuals=None if speed is None else speed.reshape(shape).astype(dtype),
    )


def _parameters(terms, recording: Recording, states, fixed) -> tuple[dict, Parameters]:
    """What is held, and what is fitted, with the numbers it starts from."""
    runs, dtype = recording.theta.shape[0], recording.theta.dtype
    theta0, v0 = start_of(recording, terms["epsilon"])
    guessed = {"v0": v0, "theta0": theta0}
    if states["offset"] is not None and states["theta0"] is None:
        guessed["theta0"] = theta0 - jnp.asarray(states["offset"], dtype)
    start = dict(terms)
    for name, x in states.items():
        if x is None and name == "offset":
            continue
        if x is not None and jnp.shape(x) not in ((), (runs,)):
            raise ValueError(
                f"Argument `{name}` must be one number, or one a run, but got {jnp.shape(x)}."
            )
        x = guessed[name] if x is None else jnp.asarray(common(x=x)[0], dtype)
        start[name] = jnp.broadcast_to(x, (runs,))
    for name in fixed:
        if name not in start:
            raise ValueError(
                f"Argument `fixed` must name some of {', '.join(start)}, but got {name!r}."
            )
    held = {name: start.pop(name) for name in tuple(start) if name in fixed}
    if not start:
        raise ValueError("Argument `fixed` must leave something to fit.")
    one, units = jnp.ones((), dtype), scales(terms, terms["epsilon"])
    start = begun(start, terms["epsilon"])
    scale = {name: units.get(name, one) for name in start}
    names = frozenset(start)
    return held, Parameters(start, scale, POSITIVE & names, MAY_VANISH & names, tuple(start))


def _require_enough(mask, recording: Recording, parameters: Parameters) -> None:
    seen = None if mask is None else concrete(mask)
    if mask is not None and seen is None:
        return
    channels = 1 if recording.velocity is None else 2
    samples = channels * (recording.theta.size if seen is None else int(np.sum(seen)))
    if samples <= parameters.size:
        raise ValueError(
            f"Argument `theta` must have more samples than parameters, {parameters.size} "
            f"({', '.join(parameters.names)}), but got {samples}."
        )


def _ends(recording: Recording, epsilon) -> Float[Array, " stages"]:
    """Of stretches from each run's first time on, each twice as long as the one before, up to all.

    A phase known over one of them is known well enough over the next to find the right turn.
    """
    span = jnp.max(recording.ts[:, -1] - recording.ts[:, 0])
    radians = concrete(span * jnp.sqrt(epsilon))
    if radians is None:
        stages = int(np.ceil(np.log2(max(2, recording.ts.shape[1] / 5))))
    else:
        stages = 1 + int(np.ceil(np.log2(np.clip(float(radians) / FIRST, 1, 2.0**20))))
    shares = jnp.exp2(jnp.arange(1 - stages, 1, dtype=span.dtype))
    return jnp.where(shares < 1, span * shares, jnp.inf)


def _method(guess: Pendulum, recording: Recording, start: dict[str, Array]) -> Method | None:
    """None: the closed form.

    What the search tries on its way may turn over a million times: no more steps are taken than
    some times those of the guess.
    """
    if guess.is_free:
        return None
    dtype, ts = recording.ts.dtype, recording.ts[0]
    numbers = {name: start.get(name) for name in OF_SCENE}
    torque = guess.tau if isinstance(guess.tau, SampledTorque) else None
    terms = Scene(**numbers if torque is None else numbers | {"tau": torque})
    fastest = State(jnp.max(jnp.abs(start["theta0"])), jnp.max(jnp.abs(start["v0"])))
    most = ts.size + budget(terms, fastest, ts - ts[0]) // 8
    if callable(guess.tau) and torque is None:
        names = ("stepsize_controller", "dt0", "adjoint", "rtol", "atol", "max_steps")
        seen = concrete(most)
        options = dict.fromkeys(names) | {"max_steps": 2**17 if seen is None else int(seen)}
        return choose(guess, ts, ts[0], 0.0, dtype, None, options)
    rtol = float(jnp.finfo(dtype).eps) ** 0.85
    # Hidden from sight it is not: of such a scene only the ratios of ε, β and τ can be found.
    seen = [0.0 if x is None else concrete(x) for x in numbers.values()]
    shown = guess.beta is not None and all(x is not None for x in seen)
    stiff = torque is None and shown and bool(is_overdamped(Scene(*seen)))
    return TaylorSeries(rtol=rtol, atol=rtol, max_steps=most, stiff=stiff, moving_times=False)
