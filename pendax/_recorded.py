"""A torque that is a function of time, as JAX records it: operations, and numbers as leaves.

What a function reads from closures, globals and attributes may be another number at the next call,
or may be traced.  Programs that are kept for the function itself would go on with the old number,
and derivatives by what it hides would be lost, both without a word.  So it is recorded at each
call, and records that read alike are equal: they share a program, though the functions be new.
"""

from collections.abc import Callable, Hashable, Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.core import Tracer
from jax.extend.core import ClosedJaxpr, Jaxpr, Literal, jaxpr_as_fun
from jaxtyping import Array, Float, Shaped

from ._pendulum import Pendulum
from ._torque import SampledTorque


class Recorded(eqx.Module):
    """τ(t) of one time."""

    numbers: list[Shaped[Array, "..."]]  # real, complex ones in two: derivatives are by numbers
    operations: "_Operations" = eqx.field(static=True)

    def __call__(self, t: Float[Array, ""]) -> Float[Array, ""]:
        jaxpr, numbers = self.operations.jaxpr, iter(self.numbers)
        given = [
            lax.complex(next(numbers), next(numbers)) if _is_complex(_dtype(var)) else next(numbers)
            for var in (*jaxpr.constvars, *jaxpr.invars[:-1])
        ]
        count = len(jaxpr.constvars)
        run = jaxpr_as_fun(ClosedJaxpr(jaxpr, given[:count]))
        (tau,) = run(*given[count:], jnp.asarray(t, self.dtype))
        return tau

    @property
    def dtype(self) -> Any:
        (result,) = self.operations.jaxpr.outvars
        return _dtype(result)


def with_record(pendulum: Pendulum, dtype: Any) -> Pendulum:
    """The scene with its τ(t), if it has one, recorded: before any program that is kept."""
    tau = pendulum.tau
    if not callable(tau) or isinstance(tau, SampledTorque):
        return pendulum
    return eqx.tree_at(lambda p: p.tau, pendulum, recorded(tau, dtype))


def recorded(tau: Callable, dtype: Any) -> Recorded:
    """`tau` of a time of this `dtype`.

    **Raises:** `ValueError` where it isn't one real number as a function of one time.
    """
    if isinstance(tau, Recorded) and tau.dtype == dtype:
        return tau
    leaves, rest = eqx.partition(tau, eqx.is_array)
    leaves, treedef = jax.tree.flatten(leaves)

    def number(leaves, t):
        return _number(eqx.combine(jax.tree.unflatten(treedef, leaves), rest)(t), dtype)

    try:
        closed = jax.make_jaxpr(number)(leaves, jnp.zeros((), dtype))
    except jax.errors.JAXTypeError as error:
        raise ValueError(
            "Argument `tau` must be a function that JAX can trace: of jnp.sin, jnp.where and the "
            "like, not of NumPy's or math's functions, nor of an `if` on t."
        ) from error
    numbers = [part for x in (*closed.consts, *leaves) for part in _real(jnp.asarray(x))]
    return Recorded(numbers, _Operations(closed.jaxpr, rest))


def _number(found: Any, dtype: Any) -> Array:
    if not isinstance(found, jax.Array | np.ndarray | np.generic | bool | int | float | complex):
        raise ValueError(f"Argument `tau` must return one real number, but got {_named(found)}.")
    found = jnp.asarray(found)
    if found.shape:
        raise ValueError(
            f"Argument `tau` must return one real number, but got shape {found.shape}. Lanes, each "
            "with a torque of its own, come through `jax.vmap`."
        )
    if _is_complex(found.dtype):
        raise ValueError(
            f"Argument `tau` must return one real number, but got {found.dtype}; jnp.real(…) is."
        )
    return found.astype(dtype)


def _named(found: Any) -> str:
    return "None" if found is None else f"a {type(found).__name__}"


def _dtype(atom: Any) -> Any:
    return atom.aval.dtype


def _is_complex(dtype: Any) -> bool:
    return jnp.issubdtype(dtype, jnp.complexfloating)


def _real(x: Array) -> list[Array]:
    return [lax.real(x), lax.imag(x)] if _is_complex(x.dtype) else [x]


class _Operations:
    """Equal to others that read the same, numbers among them included.

    Where JAX doesn't show what it will do (rules of derivatives that someone wrote), the function
    stands for it.
    """

    def __init__(self, jaxpr: Jaxpr, function: Any):
        self.jaxpr = jaxpr
        self._read = tuple(_reading(jaxpr, _Same(function)))
        self._hash = hash(self._read)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Operations) and self._read == other._read


class _Same:
    """A value by what it says of itself where it does, else this very object."""

    def __init__(self, value: Any):
        self.value = value
        leaves, treedef = jax.tree.flatten(value)
        try:
            self._key: Any = (*leaves, treedef)
            self._hash = hash(self._key)
        except TypeError:
            self._key = self._hash = id(value)  # which is kept, and so no other's

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self._key == other._key


def _reading(jaxpr: Jaxpr, function: _Same) -> Iterator[Any]:
    """All of it, one thing after the other, variables by their order."""
    names: dict[Any, int] = {}

    def read(atom: Any) -> Any:
        if isinstance(atom, Literal):
            return atom.aval, _bits(atom.val)
        return names.setdefault(atom, len(names)), atom.aval

    for var in (*jaxpr.constvars, *jaxpr.invars):
        yield read(var)
    for equation in jaxpr.eqns:
        yield equation.primitive
        yield tuple(read(x) for x in equation.invars)
        for name in sorted(equation.params):
            yield name
            yield _setting(equation.params[name], function)
        yield tuple(read(x) for x in equation.outvars)
    yield tuple(read(x) for x in jaxpr.outvars)


def _setting(value: Any, function: _Same) -> Any:
    if isinstance(value, ClosedJaxpr):
        inner = tuple(_reading(value.jaxpr, function))
        return inner, tuple(_setting(x, function) for x in value.consts)
    if isinstance(value, Jaxpr):
        return tuple(_reading(value, function))
    if isinstance(value, list | tuple):
        return tuple(_setting(x, function) for x in value)
    if isinstance(value, dict):
        return tuple((name, _setting(value[name], function)) for name in sorted(value))
    if isinstance(value, Tracer):
        return _Same(value)
    if isinstance(value, np.ndarray | jax.Array):
        return _bits(value)
    if callable(value) or hasattr(value, "call_wrapped"):
        return function
    return value if isinstance(value, Hashable) else _Same(value)


def _bits(value: Any) -> Any:
    x = np.asarray(value)
    return x.dtype, x.shape, x.tobytes()  # 0.0 and −0.0 are equal, and not the same
