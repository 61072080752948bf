"""Two integrals of a smooth motion along one coordinate, to be looked up both ways.

Gauss's nodes on equal panels; within a panel the integrand is a sum of Legendre polynomials,
and its integral one as well, P_n = (P'_{n+1} − P'_{n−1}) / (2n + 1).
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

Scalar = Float[Array, ""]

_PANELS, _POINTS = 40, 10
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_POINTS)
_TO_LEGENDRE = np.stack(
    [
        (n + 0.5) * _WEIGHTS * np.polynomial.legendre.Legendre.basis(n)(_NODES)
        for n in range(_POINTS)
    ]
)


class Table(NamedTuple):
    """∫ f ds from the first s on, for several f > 0: Legendre coefficients of each panel."""

    first: Scalar
    width: Scalar
    coefficients: Float[Array, "functions panels points"]
    before: Float[Array, "functions panels"]

    @property
    def total(self) -> Float[Array, " functions"]:
        return self.before[:, -1] + self.width * self.coefficients[:, -1, 0]


def tabulated(f, first: Scalar, last: Scalar, integrands: int) -> tuple[Table, Scalar]:
    """Of the first values of the array `f(s)`; and its last value at `first`."""
    width = (last - first) / _PANELS
    middles = first + width * (jnp.arange(_PANELS, dtype=first.dtype) + 0.5)
    s = middles[:, None] + 0.5 * width * jnp.asarray(_NODES, first.dtype)[None]
    everything = jax.vmap(f)(jnp.append(s.ravel(), first))
    values = jnp.moveaxis(everything[:-1, :integrands], -1, 0).reshape(integrands, *s.shape)
    coefficients = jnp.einsum("nk,fpk->fpn", jnp.asarray(_TO_LEGENDRE, first.dtype), values)
    each = width * coefficients[:, :, 0]
    before = jnp.cumsum(each, 1) - each
    return Table(first, width, coefficients, before), everything[-1, -1]


def integrals(table: Table, s: Scalar) -> Float[Array, " functions"]:
    panel, x = _place(table, s)
    return _within(table, panel, x)


def where_integral(table: Table, which: int, value: Scalar) -> Scalar:
    """The s at which the integral of f number `which` has this value, within the table."""
    panel = jnp.sum(table.before[which] <= value) - 1
    panel = jnp.clip(panel, 0, _PANELS - 1)
    x = jnp.zeros_like(value)
    for _ in range(8):
        slope = 0.5 * table.width * _values(table.coefficients[which, panel], x)
        miss = _within(table, panel, x)[which] - value
        x = jnp.clip(x - jnp.where(slope > 0, miss / jnp.where(slope > 0, slope, 1), 0), -1, 1)
    return table.first + table.width * (panel.astype(x.dtype) + 0.5 * (x + 1))


def _place(table: Table, s: Scalar):
    along = (s - table.first) / jnp.where(table.width > 0, table.width, 1)
    panel = jnp.clip(jnp.floor(along), 0, _PANELS - 1)
    return panel.astype(jnp.int32), 2 * (along - panel) - 1


def _within(table: Table, panel, x: Scalar) -> Float[Array, " functions"]:
    p = _polynomials(x, _POINTS + 1)
    of = table.coefficients[:, panel]
    total = of[:, 0] * (1 + x)
    for n in range(1, _POINTS):
        total = total + of[:, n] * ((p[n + 1] - p[n - 1]) / (2 * n + 1))
    return table.before[:, panel] + 0.5 * table.width * total


def _values(coefficients: Float[Array, " points"], x: Scalar) -> Scalar:
    p = _polynomials(x, _POINTS)
    return sum((coefficients[n] * p[n] for n in range(1, _POINTS)), coefficients[0])


def _polynomials(x: Scalar, count: int) -> list[Scalar]:
    p = [jnp.ones_like(x), x]
    for n in range(1, count - 1):
        p.append(((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1))
    return p
