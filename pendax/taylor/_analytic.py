"""A torque that is a function of time, followed through its operations as JAX records them.

What sums and products of powers of t make with sin, cos and exp of what is linear in t is entire,
of an exponential type σ that is read off: after order N what is left of its series at h is below
its size times (σh)^N/N!.  All else has kinks, poles or changes of its own that no series shows
from afar (a pulse exp(−t²), a step, a table): of that `analytic` says `None`.

JAX's own `jet` was rejected: it takes kinks for smooth, knows no type, and of sin(ωt), whose
coefficients are powers of ω, makes a recurrence with n terms for the n-th.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.extend.core import Jaxpr, Literal
from jaxtyping import Array, Float

from ..special._elementary import sin_cos_of_any

_STEEPEST = 3  # the power of t up to which a step's last terms are known to show a motion from rest


class Analytic(eqx.Module):
    """τ(t), whose series are those from `clock` on."""

    numbers: list[Any]
    clock: Float[Array, ""]
    written: Jaxpr = eqx.field(static=True)

    def since(self, clock: Float[Array, ""]) -> "Analytic":
        return Analytic(self.numbers, clock, self.written)

    def __call__(self, t: Float[Array, ""]) -> Float[Array, ""]:
        return self._along([t], 0).terms[0]

    def series(self, unit: Any, order: int) -> list[Any]:
        """τ_0, τ_1, … of time counted in `unit`, as far as they are not 0."""
        return self._along([self.clock, unit], order).terms

    def quickness(self) -> Float[Array, ""]:
        """The exponential type, 1/s."""
        return jnp.asarray(self._seen().quickness, self.clock.dtype)

    def growth(self) -> Any:
        """The part of it that is due to exp, 1/s; the number 0.0 where there is none."""
        return self._seen().growth

    def power(self) -> int:
        """The highest power of t."""
        return self._seen().power

    def _seen(self) -> "_Entire":
        # As many terms as tell what is linear.
        return self._along([self.clock, jnp.ones_like(self.clock)], 2)

    def _along(self, time: list[Any], order: int) -> "_Entire":
        (tau,) = _followed(self.written, self.numbers, [_Entire(time, power=1)], order)
        return tau


def analytic(tau: Callable, dtype: Any) -> Analytic | None:
    """`tau` as one, or `None` where it is not known to be."""
    t = jnp.zeros((), dtype)
    closed, result = jax.make_jaxpr(tau, return_shape=True)(t)
    if not isinstance(result, jax.ShapeDtypeStruct) or (result.shape, result.dtype) != ((), dtype):
        return None
    found = Analytic(closed.consts, t, closed.jaxpr)
    powers = []
    try:
        jax.eval_shape(lambda: powers.append(found.power()))
    except _Unknown:
        return None
    return found if powers[0] <= _STEEPEST else None


class _Unknown(Exception):
    """An operation that may leave the functions of a known type."""


class _Entire(NamedTuple):
    """The coefficients as far as they are not 0, the type, the highest power of t, and the type
    without what oscillates."""

    terms: list[Any]
    quickness: Any = 0.0
    power: int = 0
    growth: Any = 0.0


def _followed(jaxpr: Jaxpr, numbers: list[Any], inputs: list[_Entire], order: int):
    known: dict[Any, _Entire] = dict(zip(jaxpr.invars, inputs, strict=True))
    known |= {var: _Entire([x]) for var, x in zip(jaxpr.constvars, numbers, strict=True)}

    def read(atom: Any):
        if isinstance(atom, Literal):
            return _Entire([jnp.asarray(atom.val, _dtype(atom))])
        return known[atom]

    for equation in jaxpr.eqns:
        found = _outputs(equation, [read(x) for x in equation.invars], order)
        known |= dict(zip(equation.outvars, found, strict=True))
    return [read(x) for x in jaxpr.outvars]


def _outputs(equation, inputs: list[_Entire], order: int) -> list[_Entire]:
    name = equation.primitive.name
    if name in ("jit", "pjit"):
        inner = equation.params["jaxpr"]
        return _followed(inner.jaxpr, inner.consts, inputs, order)
    if name.startswith("custom_"):  # derivatives of its own, which are not in its parts
        raise _Unknown(name)
    bound = partial(equation.primitive.bind, **equation.params)
    if all(len(x.terms) == 1 for x in inputs):
        # What does not depend on time, whatever it is.
        found = bound(*(x.terms[0] for x in inputs))
        return [_Entire([y]) for y in (found if equation.primitive.multiple_results else [found])]
    if not equation.outvars:  # what prints
        raise _Unknown(name)
    kept = _dtype(equation.outvars[0]) == _dtype(equation.invars[0])
    if name in _LINEAR and kept:
        (x,) = inputs
        return [x._replace(terms=[bound(term) for term in x.terms])]
    if name in _RULES and kept:
        return [_RULES[name](inputs, equation.params, bound, order)]
    raise _Unknown(name)


def _dtype(atom: Any) -> Any:
    return atom.aval.dtype


def _sum(inputs, _, __, ___):
    x, y = inputs
    both = [a + b for a, b in zip(x.terms, y.terms, strict=False)]
    alone = [*x.terms[len(both) :], *y.terms[len(both) :]]
    # Where one is a number among arrays.
    terms = [*both, *(jnp.broadcast_to(a, both[0].shape) for a in alone)]
    quickness = jnp.maximum(x.quickness, y.quickness)
    return _Entire(terms, quickness, max(x.power, y.power), _either(x.growth, y.growth))


def _either(a: Any, b: Any) -> Any:
    """The larger, a number where both are."""
    return max(a, b) if isinstance(a, float) and isinstance(b, float) else jnp.maximum(a, b)


def _difference(inputs, parameters, bound, order: int):
    x, y = inputs
    return _sum([x, y._replace(terms=[-b for b in y.terms])], parameters, bound, order)


def _times(inputs, parameters, _, order: int):
    return _product(inputs, parameters, jnp.multiply, order)


def _product(inputs, _, bound, order: int):
    x, y = inputs
    terms = []
    for n in range(min(len(x.terms) + len(y.terms) - 1, order + 1)):
        pairs = range(max(0, n + 1 - len(y.terms)), min(n + 1, len(x.terms)))
        terms.append(sum(bound(x.terms[k], y.terms[n - k]) for k in pairs))
    quickness, growth = x.quickness + y.quickness, x.growth + y.growth
    return _Entire(terms, quickness, x.power + y.power, growth)


def _quotient(inputs, _, __, ___):
    x, y = inputs
    if len(y.terms) > 1:
        raise _Unknown("a pole, perhaps")
    return x._replace(terms=[term / y.terms[0] for term in x.terms])


def _power(inputs, parameters, _, order: int):
    (x,), exponent = inputs, parameters.get("y", 2)
    if not 0 < exponent <= 8:
        raise _Unknown("a pole, or a power as if of a pulse")
    found = x
    for _ in range(exponent - 1):
        found = _times((found, x), None, None, order)
    return found


def _of_linear(first: Callable, factor: Callable, grows: bool = False):
    """f(c + s t): of c and s its `first` coefficients, as many as the `factor` goes back by."""

    def rule(inputs, _, __, order: int):
        (x,) = inputs
        if len(x.terms) > 2 or x.power > 1:
            raise _Unknown("a change that is not seen from afar")
        middle, slope = x.terms
        terms = first(middle, slope)
        back = len(terms)
        for n in range(back, order + 1):
            terms.append(terms[n - back] * factor(slope, n))
        quickness = jnp.max(jnp.abs(slope), initial=0)
        return _Entire(terms[: order + 1], quickness, 0, quickness if grows else 0.0)

    return rule


def _sine(middle, slope):
    sin, cos = sin_cos_of_any(middle)
    return [sin, cos * slope]


def _cosine(middle, slope):
    sin, cos = sin_cos_of_any(middle)
    return [cos, -sin * slope]


def _curved(slope, n: int):
    return -slope * slope * (1 / (n * (n - 1)))


_LINEAR = (
    *("neg", "copy", "convert_element_type", "reduce_sum"),
    *("reshape", "squeeze", "expand_dims", "broadcast_in_dim", "transpose"),
)
_RULES = {
    "add": _sum,
    "add_any": _sum,
    "sub": _difference,
    "mul": _times,
    "dot_general": _product,
    "div": _quotient,
    "integer_pow": _power,
    "square": _power,
    "sin": _of_linear(_sine, _curved),
    "cos": _of_linear(_cosine, _curved),
    "exp": _of_linear(lambda c, s: [jnp.exp(c)], lambda s, n: s * (1 / n), grows=True),
}
