"""The undamped, untorqued motion in closed form, and its derivatives.

With S = sin(θ/2), C = cos(θ/2), W = θ̇/(2√ε), the motion that passes the bottom at t = 0
is (k sn, dn, k cn)(√ε t | m) at every energy, m = k² = S² + W², m1 = 1 − m = C² − W².  The
addition theorem (DLMF 22.8.1) composes it with the initial state,

    S = (s W0 C0 + S0 c d) / D,   C = (d C0 − s c S0 W0) / D,   W = (c W0 − s d S0 C0) / D,

s, c, d = sn, cn, dn and D = c² + s² C0², which is 1 − s² S0² without its subtraction: no
incomplete integral, no k, no branch, and an analytic function of everything.

The rejected forms: 2 arcsin(k sn) loses half the digits near θ = ±π; the textbook's second
formula above v0 = 2√ε is 0/0 at it in every derivative.
"""

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ._gap import gap_of, half_angle, turned_by
from .special._cpu import DOZENS, in_blocks
from .special._elementary import angle
from .special._jacobi import Functions, functions, jacobi_and_slopes, slopes_at

FloatArray = Float[Array, "..."]


class Motion(NamedTuple):
    theta: FloatArray
    v: FloatArray


class Start(NamedTuple):
    """The initial state, and what else depends on the lane alone."""

    root: FloatArray  # √ε
    m: FloatArray
    m1: FloatArray
    s: FloatArray
    c: FloatArray  # >= 0: the angle is counted from the bottom of the well it starts in
    w: FloatArray
    well: FloatArray


@jax.custom_jvp
def motion(epsilon: FloatArray, t: FloatArray, v0: FloatArray, theta0: FloatArray) -> Motion:
    """θ (unwrapped) and θ̇ a time t after (θ0, v0); arguments of one rank and dtype."""
    return Motion(*_values(epsilon, t, v0, theta0))


@partial(motion.defjvp, symbolic_zeros=True)
def _motion_jvp(primals, tangents):
    epsilon, _, v0, theta0 = (isinstance(x, SymbolicZero) for x in tangents)
    if epsilon and v0 and theta0:
        first = motion(*primals)
        return first, _along(primals, tangents, *first)
    theta, v, *columns = motion_and_columns(not theta0, *primals)
    return Motion(theta, v), _along(primals, tangents, theta, v, *columns)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def motion_and_columns(
    both: bool, epsilon: FloatArray, t: FloatArray, v0: FloatArray, theta0: FloatArray
) -> tuple[FloatArray, ...]:
    """θ, v, ∂θ/∂v0, ∂v/∂v0 and, if `both`, ∂θ/∂θ0, ∂v/∂θ0."""
    return (_values_and_both if both else _values_and_one)(epsilon, t, v0, theta0)


@partial(motion_and_columns.defjvp, symbolic_zeros=True)
def _motion_and_columns_jvp(both, primals, tangents):
    needed = both or not isinstance(tangents[3], SymbolicZero)
    theta, v, *columns = motion_and_columns(needed, *primals)
    first = _along(primals, tangents, theta, v, *columns)
    kept = columns if both else columns[:2]
    second = _columns_along(primals, tangents, theta, *kept)
    return (theta, v, *kept), (*first, *second)


def _along(primals, tangents, theta, v, *columns) -> Motion:
    """The tangent of the motion, from its `columns`.

    Those in t are the equation of motion; those in ε follow, since θ depends on √ε t,
    v0/√ε and θ0.
    """
    epsilon, t, v0, _ = primals
    sin, cos, _ = half_angle(theta)
    force = -2 * epsilon * sin * cos
    slopes: dict[int, Sequence[FloatArray]] = {1: (v, force)}
    if columns:
        columns = [_saturated(x, theta) for x in columns]
        theta_v0, v_v0 = slopes[2] = columns[:2]
        slopes[0] = (
            (t * v - v0 * theta_v0) / (2 * epsilon),
            (v + t * force - v0 * v_v0) / (2 * epsilon),
        )
        slopes[3] = columns[2:]
    return Motion(*_combined((theta, v), slopes, tangents))


def _columns_along(primals, tangents, theta, *columns) -> list[FloatArray]:
    """The same for the columns: those in t are the variational equation."""
    epsilon, t, v0, theta0 = primals
    sin, cos, _ = half_angle(theta)
    stiffness = epsilon * (cos * cos - sin * sin)
    pairs = [columns[i : i + 2] for i in range(0, len(columns), 2)]
    by_t = [x for of_theta, of_v in pairs for x in (of_v, -stiffness * of_theta)]
    _, along = jax.linearize(lambda v0, theta0: _columns(epsilon, t, v0, theta0), v0, theta0)
    by_v0 = along(jnp.ones_like(v0), jnp.zeros_like(theta0))
    # ∂θ/∂v0 has the dimension of 1/√ε, ∂v/∂θ0 that of √ε, the others none.
    by_epsilon = [
        (power * x + t * x_t - v0 * x_v0) / (2 * epsilon)
        for power, x, x_t, x_v0 in zip((-1, 0, 0, 1), columns, by_t, by_v0, strict=False)
    ]
    by_theta0 = along(jnp.zeros_like(v0), jnp.ones_like(theta0))
    slopes = (by_epsilon, by_t, by_v0, by_theta0)
    return _combined(columns, [[_saturated(x, theta) for x in of] for of in slopes], tangents)


def _combined(values, slopes, tangents) -> list[FloatArray]:
    """Σ slope · tangent for each of the values, of the tangents that are not zero."""
    totals = [jnp.zeros_like(x) for x in values]
    for i, dx in enumerate(tangents):
        if not isinstance(dx, SymbolicZero):
            totals = [x + slope * dx for x, slope in zip(totals, slopes[i], strict=False)]
    return totals


def _saturated(slope, theta):
    """On the separatrix derivatives grow like e^(√ε t), and leave the range of the floats,
    the second ones halfway on the way to their value: a large number then, with which
    products by t, ε and v0 are finite yet, for inf times 0 is NaN."""
    largest = 2.0**-40 * jnp.finfo(theta.dtype).max
    within = jnp.where(jnp.isfinite(slope), jnp.clip(slope, -largest, largest), largest)
    return jnp.where(jnp.isnan(theta), theta, within)


@jax.jit
@in_blocks
def _values(epsilon, t, v0, theta0):
    start = _start(epsilon, v0, theta0)
    at = functions(start.root * t, start.m, start.m1)
    return _theta_and_v(at, v0, start)


def _values_and_columns(count):
    @jax.jit
    @partial(in_blocks, most=DOZENS)
    def values(epsilon, t, v0, theta0):
        start = _start(epsilon, v0, theta0)
        argument = start.root * t, start.m, start.m1
        at = functions(*argument)
        columns = _matrix(start, *at.sn_cn_dn, *slopes_at(at, *argument))
        return *_theta_and_v(at, v0, start), *columns[:count]

    return values


_values_and_one, _values_and_both = _values_and_columns(2), _values_and_columns(4)


def _columns(epsilon, t, v0, theta0):
    """The matrix in a form to be differentiated."""
    start = _start(epsilon, v0, theta0)
    s, c, d, _, *slopes = jacobi_and_slopes(start.root * t, start.m, start.m1)
    return _matrix(start, s, c, d, *slopes)


def _start(epsilon, v0, theta0) -> Start:
    epsilon = jnp.where(epsilon > 0, epsilon, jnp.nan)
    root = jnp.sqrt(epsilon)
    s, c, well = half_angle(theta0)
    m1 = gap_of(4 * epsilon, v0, s, c) / (4 * epsilon)
    return Start(root, 1 - m1, m1, s, c, v0 / (2 * root), well)


def _compose(s, c, d, s0, c0, w0):
    """S, C, W: the motion from the bottom after the initial state."""
    unit = 1 / (c * c + (s * c0) * (s * c0))
    return (
        (s * w0 * c0 + s0 * c * d) * unit,
        (d * c0 - s * c * s0 * w0) * unit,
        (c * w0 - s * d * s0 * c0) * unit,
    )


def _theta_and_v(at: Functions, v0, start: Start) -> tuple[FloatArray, FloatArray]:
    sin, cos, w = _compose(*at.sn_cn_dn, start.s, start.c, start.w)
    near = angle(sin, jnp.abs(cos))
    half = jnp.where(cos < 0, jnp.where(sin < 0, -jnp.pi, jnp.pi) - near, near)
    # A rotation turns once in each half period of sn, and in the rest of the time by less
    # than once: half of that rest is less than half a turn off.
    turned = jnp.where(v0 < 0, -0.5, 0.5) * (at.turns + jnp.where(at.w < 0, -0.5, 0.5))
    whole = jnp.round(turned + (angle(start.s, start.c) - half) / (2 * jnp.pi))
    whole = jnp.where(start.m1 < 0, 2 * whole, 0)
    return 2 * turned_by(start.well + whole, half), 2 * start.root * w


def _matrix(start: Start, s, c, d, of_ph, of_dn):
    """∂θ/∂v0, ∂v/∂v0, ∂θ/∂θ0, ∂v/∂θ0; `of_ph`, `of_dn` are ∂ph/∂m, (∂dn/∂m)/sn.

    The derivatives of S, C, W by m, W0 and θ0/2, times D; that of D falls out of θ's.
    """
    root, s0, c0, w0 = start.root, start.s, start.c, start.w
    sin, cos, w = _compose(s, c, d, s0, c0, w0)
    unit = 1 / (c * c + (s * c0) * (s * c0))
    s_m, c_m, d_m = c * of_ph, -s * of_ph, s * of_dn
    sin_m = s_m * w0 * c0 + s0 * (c_m * d + c * d_m)
    cos_m = d_m * c0 - (s_m * c + s * c_m) * s0 * w0
    w_m = c_m * w0 - (s_m * d + s * d_m) * s0 * c0 - 2 * w * (c * c_m + s * s_m * c0 * c0)
    theta_m = cos * sin_m - sin * cos_m
    theta_w = s * (cos * c0 + sin * c * s0)
    theta_0 = cos * (c0 * c * d - s * w0 * s0) + sin * (d * s0 + s * c * c0 * w0)
    w_0 = s * (d * (s0 * s0 - c0 * c0) + 2 * w * s * s0 * c0)
    return (
        (theta_w + 2 * w0 * theta_m) * (unit / root),
        (c + 2 * w0 * w_m) * unit,
        (theta_0 + 2 * s0 * c0 * theta_m) * unit,
        (w_0 + 2 * s0 * c0 * w_m) * (root * unit),
    )
