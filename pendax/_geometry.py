"""The construction of the elliptic functions as lengths on a pendulum."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, widened
from ._gap import gap_of, half_angle, hypotenuse
from ._pendulum import Pendulum, require_free

FloatArray = Float[Array, "..."]
Point = Float[Array, "... 2"]


class Geometry(NamedTuple):
    """Points (x, y), pivot O at the origin, and lengths, in units of the rod's length l.

    A bottom and E top of the circle that the bob P is on; B and B1 (the source's B′) its
    turning points (NaN in rotation); N the foot of P on the vertical AE; D where the energy
    would lift the bob to, beyond E in rotation; Q the point of the circle over AD at P's
    height.  With k = sin(θ_max/2), also above 1, AB = 2k, AD = 2k², AN = 2k² sn², ND = 2k² cn²,
    EN = 2 dn², AP = 2k sn, EP = 2 dn, NP = 2k sn dn, AQ = 2k² sn, NQ = 2k² sn cn,
    BE = 2√(1 − k²), DE = 2|1 − k²|.
    """

    A: Point
    B: Point
    B1: Point
    D: Point
    E: Point
    N: Point
    P: Point
    Q: Point
    AB: FloatArray
    AD: FloatArray
    AE: FloatArray
    AN: FloatArray
    AP: FloatArray
    AQ: FloatArray
    BE: FloatArray
    DE: FloatArray
    EN: FloatArray
    EP: FloatArray
    ND: FloatArray
    NP: FloatArray
    NQ: FloatArray


def geometry(pendulum: Pendulum, theta: ArrayLike, v: ArrayLike) -> Geometry:
    """Points and lengths of Suzuki & Suzuki's chapter 4 for a pendulum at (θ, v).

    **Arguments:** the undamped, untorqued `pendulum`; `theta`, rad; `v`, rad/s.  Shapes
    broadcast; points have one more axis, (x, y).  For a given θ_max, the speed at θ is
    `velocity(pendulum, theta, energy(pendulum, theta_max, 0.0))`.

    **Returns:** a [`Geometry`][], for k < 1, k = 1 and k > 1.  Lengths are not negative; Q
    is to the right of the vertical where θ and v have the same sign, and goes round its
    circle once while the pendulum swings up and back on one side.

    **Raises:** `ValueError` for a scene with damping or torque.

    In S = sin(θ/2) = k sn, C = cos(θ/2) = dn and W = v/(2√ε) = k cn every length is a
    product: nothing is divided by k, and nothing cancels at θ = 0 or π.
    """
    require_free(pendulum, "its geometry")
    arrays = common(epsilon=pendulum.epsilon, v=v, theta=theta)
    return widened(_geometry)(*arrays)


def _geometry(epsilon: FloatArray, v: FloatArray, theta: FloatArray) -> Geometry:
    sin, cos, _ = half_angle(theta)
    w = v / (2 * jnp.sqrt(epsilon))
    k = hypotenuse(sin, w)
    m1 = gap_of(4 * epsilon, v, sin, cos) / (4 * epsilon)
    k1 = jnp.sqrt(jnp.where(m1 >= 0, m1, jnp.nan))
    zero, one = jnp.zeros_like(sin), jnp.ones_like(sin)

    def at(x, height):
        return jnp.stack([x, height - 1], -1)

    square = jnp.where(m1 >= 0, k * k, jnp.nan)
    return Geometry(
        A=at(zero, zero),
        B=at(2 * k * k1, 2 * square),
        B1=at(-2 * k * k1, 2 * square),
        D=at(zero, 2 * k * k),
        E=at(zero, 2 * one),
        N=at(zero, 2 * sin * sin),
        P=at(2 * sin * cos, 2 * sin * sin),
        Q=at(2 * sin * w, 2 * sin * sin),
        AB=jnp.where(m1 >= 0, 2 * k, jnp.nan),
        AD=2 * k * k,
        AE=2 * one,
        AN=2 * sin * sin,
        AP=2 * jnp.abs(sin),
        AQ=2 * k * jnp.abs(sin),
        BE=2 * k1,
        DE=2 * jnp.abs(m1),
        EN=2 * cos * cos,
        EP=2 * cos,
        ND=2 * w * w,
        NP=2 * jnp.abs(sin) * cos,
        NQ=2 * jnp.abs(sin * w),
    )
