"""Taylor series for θ̈ + β θ̇ + ε sin θ = τ with constant parameters, or τ a sine or a ramp.

The series of θ, v = θ̇, s = sin θ and c = cos θ in t follow from each other,

    (n+1) v_{n+1} = τ_n − ε s_n − β v_n,    (n+1) θ_{n+1} = v_n,
    (n+1) s_{n+1} = Σ_k v_k c_{n−k},              (n+1) c_{n+1} = − Σ_k v_k s_{n−k},

with time counted in 1/rate of the moment, so that coefficients of any scene are of order one.
The rate is a power of two: v in its unit has the digits of v.

Jorba & Zou, Exp. Math. 14 (2005) 99.
"""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from .._torque import SampledTorque
from ..special._elementary import sin_cos_of_any
from ._analytic import Analytic

Scalar = Float[Array, ""]


class Scene(NamedTuple):
    """The parameters, a term that is `None` being absent; τ a number, `Analytic`, or as below.

    Series know nothing of `dry`: see `_switched`, which makes it a part of τ.
    """

    epsilon: Any
    beta: Any
    tau: Any
    dry: Any = None


class Sine(NamedTuple):
    """The torque mean + amplitude sin(clock + frequency t)."""

    mean: Any
    amplitude: Any
    frequency: Any
    clock: Any


class Ramp(NamedTuple):
    """The torque value + slope t."""

    value: Any
    slope: Any


def largest(tau: Any) -> Any:
    """The most that |τ| can be, or what it is now; of numbers a number, to choose a method by."""
    if isinstance(tau, Analytic):
        return jnp.abs(tau(tau.clock))
    if isinstance(tau, Ramp):
        return abs(tau.value)
    if isinstance(tau, SampledTorque):
        return tau.largest()
    return abs(tau.mean) + abs(tau.amplitude) if isinstance(tau, Sine) else abs(tau)


def torque_series(tau: Any, unit: Any, order: int) -> list[Any]:
    """τ_0, τ_1, … of time counted in `unit`, as far as they are not 0."""
    if tau is None:
        return []
    if isinstance(tau, Analytic):
        return tau.series(unit, order)
    if isinstance(tau, Ramp):
        return [tau.value, tau.slope * unit]
    if not isinstance(tau, Sine):
        return [tau]
    sine, cosine = sin_cos_of_any(tau.clock)
    wave = [sine, cosine, -sine, -cosine]
    growth, coefficients = tau.amplitude, []
    for n in range(order + 1):
        coefficients.append(growth * wave[n % 4])
        growth = growth * (tau.frequency * unit / (n + 1))
    coefficients[0] = tau.mean + coefficients[0]
    return coefficients


def since(scene: Scene, clock: Scalar) -> Scene:
    """The scene whose time begins at `clock`."""
    return scene._replace(tau=scene.tau.since(clock)) if isinstance(scene.tau, Analytic) else scene


class State(NamedTuple):
    theta: Any
    v: Any


@partial(jax.jit, static_argnums=0)  # traced once
def scaled_series(order: int, scene: Scene, state: State):
    """A rate, and the coefficients of v / rate and of sin θ in rate · t."""
    rate = jnp.sqrt(scene.epsilon)
    for other in (jnp.abs(state.v), scene.beta):
        rate = rate if other is None else jnp.maximum(rate, other)
    if scene.tau is not None:
        rate = jnp.maximum(rate, jnp.sqrt(largest(scene.tau)))
    if isinstance(scene.tau, Sine):
        rate = jnp.maximum(rate, scene.tau.frequency)
    if isinstance(scene.tau, Analytic):
        rate = jnp.maximum(rate, scene.tau.quickness())
    rate = _power_of_two_above(lax.stop_gradient(rate))
    unit = 1 / rate
    scaled = Scene(
        scene.epsilon * unit * unit,
        None if scene.beta is None else scene.beta * unit,
        [x * unit * unit for x in torque_series(scene.tau, unit, order)],
    )
    theta: list[Any] = [state.theta]
    v: list[Any] = [state.v * unit]
    sine, cosine = sin_cos_of_any(state.theta)
    sines: list[Any] = [sine]
    cosines: list[Any] = [cosine]
    for n in range(order):
        v.append(force(scaled, sines, v, n) / (n + 1))
        theta.append(v[n] / (n + 1))
        sine, cosine = sine_and_cosine(theta, sines, cosines)
        sines.append(sine)
        cosines.append(cosine)
    return rate, v, sines


def _power_of_two_above(x: Scalar) -> Scalar:
    """Of a positive number, by its bits: one below would take range from derivatives."""
    whole = jnp.int64 if x.dtype == jnp.float64 else jnp.int32
    exponent = lax.bitcast_convert_type(jnp.asarray(jnp.inf, x.dtype), whole)
    below = lax.bitcast_convert_type(lax.bitcast_convert_type(x, whole) & exponent, x.dtype)
    return jnp.minimum(2 * below, 1 / jnp.finfo(x.dtype).tiny)  # of which 1/rate is a number


def force(scene: Scene, sines, v, n: int) -> Scalar:
    """The n-th coefficient of v̇, τ being its series."""
    total = -scene.epsilon * sines[n]
    if scene.beta is not None:
        total = total - scene.beta * v[n]
    if n < len(scene.tau):
        total = total + scene.tau[n]
    return total


@jax.custom_jvp
def sine_and_cosine(theta, sines, cosines):
    """The next coefficients of sin θ and cos θ, from all up to that of θ."""
    n = len(theta) - 1
    slopes = [k * theta[k] for k in range(1, n + 1)]
    sine = _added([slope * cosines[n - k] for k, slope in enumerate(slopes, 1)]) / n
    cosine = _added([slope * sines[n - k] for k, slope in enumerate(slopes, 1)]) / -n
    return sine, cosine


@sine_and_cosine.defjvp
def _(primals, tangents):
    """δ sin θ = cos θ δθ: one product, and of θ alone, where the recurrence's tangent has four."""
    theta, sines, cosines = primals
    moved = tangents[0]
    first = sine_and_cosine(theta, sines, cosines)
    sines, cosines = [*sines, first[0]], [*cosines, first[1]]
    n = len(theta) - 1
    of_sine = _added([cosines[n - k] * moved[k] for k in range(n + 1)])
    of_cosine = -_added([sines[n - k] * moved[k] for k in range(n + 1)])
    return first, (of_sine, of_cosine)


def _added(terms):
    """The sum, every other term by itself: additions of a chain wait for each other."""
    first, second = sum(terms[::2]), sum(terms[1::2])
    return first + second if len(terms) > 1 else first
