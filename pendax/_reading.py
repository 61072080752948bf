"""Whether two records of JAX do the same: all that they say is read, numbers to the last bit."""

from collections.abc import Hashable, Iterator
from functools import partial
from types import FunctionType, MethodType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jax.extend.core import ClosedJaxpr, Jaxpr, Literal
from jax.sharding import Mesh

from ._arrays import NUMBERS


class Operations:
    """A record, equal to others that read the same.

    What JAX doesn't show, rules of derivatives that someone wrote and calls of Python, is the same
    where it comes of the same `function` and holds the same numbers.
    """

    def __init__(self, jaxpr: Jaxpr, function: Any):
        self.jaxpr = jaxpr
        self._read = tuple(_reading(jaxpr, _Same(function)))
        self._hash = hash(self._read)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Operations) and self._read == other._read


class _Same:
    """What of a pytree says itself that it is equal, else these very objects."""

    def __init__(self, value: Any):
        leaves, treedef = jax.tree.flatten(value)
        self._kept = leaves  # or others could have their places in memory
        self._key: Any = [_hash_or_place(x) for x in (*leaves, treedef)]
        self._hash = hash(tuple(number for _, number in self._key))

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        try:
            return isinstance(other, _Same) and bool(self._key == other._key)
        except Exception:  # of what someone wrote, arrays of answers for one
            return False


def _hash_or_place(x: Any) -> tuple[Any, int]:
    try:
        return x, hash(x)
    except Exception:
        return None, id(x)


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
        yield repr(equation.ctx)
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
    if isinstance(value, NUMBERS):
        return _bits(value)
    # A mesh may be called as well, to decorate.
    if not isinstance(value, Mesh) and (callable(value) or hasattr(value, "call_wrapped")):
        return function, tuple(_held(value, set()))
    return value if isinstance(value, Hashable) else _Same(value)


def _bits(value: Any) -> Any:
    if isinstance(value, jax.Array) and jnp.issubdtype(value.dtype, jax.dtypes.prng_key):
        return value.dtype, _bits(jax.random.key_data(value))
    if isinstance(value, int):  # Python's, of any length
        return type(value), value
    x = np.asarray(value)
    return type(value), x.dtype, x.shape, x.tobytes()  # 0.0 and −0.0 are equal, and not the same


_PARTS = str, np.ufunc, list, tuple, dict


def _held(value: Any, seen: set[int]) -> Iterator[Any]:
    """The code of a function, and numbers and words that it has in closures, defaults, globals of
    its own and its object."""
    if isinstance(value, NUMBERS):
        if not isinstance(value, Tracer):
            yield _bits(value)
        return
    if id(value) in seen:
        return
    seen.add(id(value))
    parts: list[Any] = []
    if isinstance(value, str | np.ufunc):
        yield value
    elif isinstance(value, list | tuple | dict):
        yield type(value), len(value)
        parts = [*value.items()] if isinstance(value, dict) else [*value]
    elif isinstance(value, partial):
        parts = [value.func, value.args, value.keywords]
    elif isinstance(value, MethodType):
        parts = [value.__func__, getattr(value.__self__, "__dict__", None)]
    elif isinstance(value, FunctionType):
        cells = (cell.cell_contents for cell in value.__closure__ or () if not _is_empty(cell))
        known = (value.__globals__.get(name) for name in value.__code__.co_names)
        read = [x for x in known if isinstance(x, (*NUMBERS, *_PARTS))]
        yield value.__code__
        parts = [*cells, value.__defaults__, value.__kwdefaults__, *read]
    elif hasattr(value, "call_wrapped"):
        parts = [value.f]
    elif callable(value) and not isinstance(value, type):
        names = (*getattr(value, "__dict__", ()), *getattr(type(value), "__slots__", ()))
        parts = [getattr(value, name, None) for name in names]
    for part in parts:
        yield from _held(part, seen)


def _is_empty(cell: Any) -> bool:
    try:
        return cell.cell_contents is None
    except ValueError:  # not filled yet
        return True
