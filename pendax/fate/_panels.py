"""Panels of Radau's nodes along an angle, as fine everywhere as a function of it needs.

Within a panel the angle is exponential in a coordinate from 0 to 1, so that panels may grow by
large factors from one to the next and w, which is smooth on the scale of its distance to a
zero, still looks like a polynomial.
"""

from functools import cache
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float
from numpy.polynomial import legendre

Scalar = Float[Array, ""]
Nodes = Float[Array, "panels nodes"]

PANELS, NODES = 40, 10


class Panels(NamedTuple):
    edges: Float[Array, " edges"]
    growth: Float[Array, " panels"]  # ln of dx/ds at the end of a panel over that at its beginning


def graded(a: Scalar, first: float, last: float) -> Panels:
    """Around 0 with the scale a, and geometric beyond it."""
    ends = jnp.arcsinh(jnp.array([first, last], a.dtype) / a)
    s = ends[0] + (ends[1] - ends[0]) * jnp.linspace(0, 1, PANELS + 1, dtype=a.dtype)
    edges = (a * jnp.sinh(s)).at[0].set(first).at[-1].set(last)
    return Panels(edges, jnp.diff(jnp.log(jnp.cosh(s))))


def refined(panels: Panels, rate: Nodes) -> Panels:
    """The same interval, with panels of equal ∫ rate dx; `rate` is that at the nodes."""
    x, weight = angles(panels), weights(panels)
    at = jnp.append(panels.edges[:1], x.ravel())
    every = jnp.append(rate[0, :1], rate.ravel())
    total = jnp.append(0 * rate[0, :1], jnp.cumsum((weight * rate).ravel()))
    wanted = total[-1] * jnp.linspace(0, 1, PANELS + 1, dtype=x.dtype)
    edges = jnp.interp(wanted, total, at).at[0].set(panels.edges[0]).at[-1].set(panels.edges[-1])
    return Panels(edges, -jnp.diff(jnp.interp(edges, at, jnp.log(every))))


def angles(panels: Panels) -> Nodes:
    nodes, *_ = radau(panels.edges.dtype)
    growth = _growth(panels)[:, None]
    share = jnp.expm1(growth * nodes[None]) / jnp.expm1(growth)
    return panels.edges[:-1, None] + jnp.diff(panels.edges)[:, None] * share


def evaluated(panels: Panels, w: Nodes, x: Nodes) -> Nodes:
    """A periodic w at other angles, by the polynomial of each panel."""
    nodes, *_ = radau(w.dtype)
    every = jnp.append(0 * nodes[:1], nodes)
    panel = jnp.clip(jnp.searchsorted(panels.edges, x, side="right") - 1, 0, PANELS - 1)
    growth = _growth(panels)[panel]
    share = (x - panels.edges[panel]) / jnp.diff(panels.edges)[panel]
    s = jnp.log1p(share * jnp.expm1(growth)) / growth
    known = jnp.concatenate([jnp.roll(w[:, -1:], 1, axis=0), w], 1)[panel]
    off = s[..., None] - every[None, None]
    off = jnp.where(off == 0, jnp.finfo(w.dtype).tiny ** 0.5, off)
    part = jnp.asarray(_barycentric(), w.dtype)[None, None] / off
    return jnp.sum(part * known, -1) / jnp.sum(part, -1)


def slopes(panels: Panels) -> Nodes:
    """dx/ds, s from 0 to 1 in each panel."""
    nodes, *_ = radau(panels.edges.dtype)
    growth = _growth(panels)[:, None]
    steepness = growth * jnp.exp(growth * nodes[None]) / jnp.expm1(growth)
    return jnp.diff(panels.edges)[:, None] * steepness


def weights(panels: Panels) -> Nodes:
    """dx of each node in an integral."""
    return slopes(panels) * radau(panels.edges.dtype)[2][None]


def by_s(w: Nodes) -> Nodes:
    """dw/ds of a periodic w: on the left of a panel it is what it is on the right of the last."""
    _, derivative, _ = radau(w.dtype)
    left = jnp.roll(w[:, -1:], 1, axis=0)
    return left * derivative[None, :, 0] + w @ derivative[:, 1:].T


def _growth(panels: Panels) -> Float[Array, " panels"]:
    return jnp.where(jnp.abs(panels.growth) < 1e-2, 1e-2, panels.growth)


def radau(dtype) -> tuple[Array, ...]:
    """Nodes in (0, 1], d/ds there of what is given at 0 and at the nodes, weights of ∫_0^1."""
    nodes, derivative, weights = (jnp.asarray(x, dtype) for x in _radau())
    return nodes, derivative, weights


@cache
def _radau() -> tuple[np.ndarray, ...]:
    n = NODES
    polynomial = legendre.Legendre.basis(n - 1) + legendre.Legendre.basis(n)
    roots = np.sort(polynomial.roots().real)
    roots = roots - np.append(0, polynomial(roots[1:]) / polynomial.deriv()(roots[1:]))
    roots[0] = -1
    nodes = 0.5 * (1 - roots[::-1])
    every = np.append(0, nodes)
    weight = 1 / np.prod(_apart(every), axis=1)
    derivative = weight[None] / weight[:, None] / _apart(every)
    np.fill_diagonal(derivative, 0)
    np.fill_diagonal(derivative, -derivative.sum(1))
    exact = np.append(1, np.zeros(n - 1))
    weights = np.linalg.solve(legendre.legvander(2 * nodes - 1, n - 1).T, exact)
    return nodes, derivative[1:], weights


def _apart(x: np.ndarray) -> np.ndarray:
    return x[:, None] - x[None] + np.eye(len(x))


def _barycentric() -> np.ndarray:
    return 1 / np.prod(_apart(np.append(0, _radau()[0])), axis=1)
