"""sin and cos, sinh, ln, the angle and RC, mostly on the short intervals where they are needed.

XLA's own sin, cos, log and atan2 call a scalar library for float64 on the CPU, 8 to
25 ns a value; these polynomials vectorise and take about 1.  Each is Chebyshev
interpolation of the tail of the Taylor series, computed in 60 digits (borrowed from
nowhere); the error quoted is that of the polynomial, relative to the function's first
term.  The same coefficients serve float32.
"""

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

FloatArray = Float[Array, "..."]

# (sin w / w − 1) / w², w² <= 2.5: 0.10 eps
_SIN = (
    -0.16666666666666666, 0.008333333333333314, -0.0001984126984125376,
    2.7557319218837673e-06, -2.505210757580932e-08, 1.605897465969838e-10,
    -7.643886158204389e-13, 2.730402537561207e-15,
)  # fmt: skip
# (cos w − 1 + w²/2) / w⁴, w² <= 2.5: 0.06 eps
_COS = (
    0.041666666666666664, -0.0013888888888888879, 2.4801587301579245e-05,
    -2.755731922140637e-07, 2.0876756582230035e-09, -1.1470710942998504e-11,
    4.777835748610937e-14, -1.5213413871961346e-16,
)  # fmt: skip
# (sinh w / w − 1) / w², w² <= 0.13: 0.006 eps
_SINH = (
    0.16666666666666666, 0.008333333333333335, 0.0001984126984126087,
    2.7557319253426212e-06, 2.5052064716167898e-08, 1.6088894517149212e-10,
)  # fmt: skip
# (2 artanh s / s − 2) / s², s² <= 0.0295: 0.02 eps
_LOG = (
    0.666666666666667, 0.3999999999989819, 0.28571428626570206, 0.2222221103781659,
    0.18182896183483085, 0.15331487235865734, 0.14619343453512615,
)  # fmt: skip
# (2 arctan x / x − 2) / x², x² <= 0.1716: 0.03 eps
_ANGLE = (
    -0.6666666666666666, 0.39999999999991026, -0.2857142856933036, 0.2222222203029343,
    -0.1818180914733812, 0.15384366174684053, -0.1332901997963609, 0.11716272503812293,
    -0.10170766977685662, 0.07845948907322446, -0.038349087144042664,
)  # fmt: skip
# (2 (1 − √(1 − x)) / x − 1) / x, x <= 0.02945: 0.008 eps
_HALF_ROOT = (
    0.25000000000000006, 0.12499999999981398, 0.0781250001009262, 0.0546874794914367,
    0.04101760555237452, 0.03212874347216268, 0.028558124459520454,
)  # fmt: skip
# (RC(1, 1 + e) − 1) / e, |e| <= 0.1716: 0.08 eps
_RC = (
    -0.3333333333333334, 0.20000000000000007, -0.14285714285686704, 0.11111111111085184,
    -0.09090909105875784, 0.07692307706376199, -0.0666666362535714, 0.05882350082436502,
    -0.052634515780280854, 0.04762180806347612, -0.043333244665510036, 0.03986370168335579,
    -0.040554400356205084, 0.03778825757799395,
)  # fmt: skip


def _polynomial(x: FloatArray, coefficients: tuple[float, ...]) -> FloatArray:
    total = jnp.full_like(x, coefficients[-1])
    for c in coefficients[-2::-1]:
        total = total * x + c
    return total


@jax.custom_jvp
def sin_cos(w: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(sin w, cos w) for |w| up to π/2 and a little beyond."""
    x = w * w
    return (
        w + w * (x * _polynomial(x, _SIN)),
        (1 - 0.5 * x) + x * x * _polynomial(x, _COS),
    )


@sin_cos.defjvp
def _sin_cos_jvp(primals, tangents):
    sin, cos = sin_cos(*primals)
    return (sin, cos), (cos * tangents[0], -sin * tangents[0])


# π/2: the first part has 33 digits (float32: 8), the second the next 33 (11, the third 12).
QUARTER = {
    "float64": (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21),
    "float32": (1.5703125, 0.0004837512969970703, 7.549533620476723e-08, 2.563344151594519e-12),
}


def less_quarters(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n, x − n π/2): the first part of π/2 times n is exact up to n of 10⁶ (float32: 10³)."""
    quarters = jnp.round(x * (2 / jnp.pi))
    rest = x
    for part in QUARTER[jnp.dtype(x.dtype).name]:
        rest = rest - quarters * part
    # The number of them is off by one far out, and where numbers are turns apart by anything.
    return quarters, jnp.clip(rest, -1.5, 1.5)


@jax.custom_jvp
def sin_cos_of_any(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(sin x, cos x) within 1.3 eps of each, for |x| up to 10⁶ (float32: 10³); further out as of
    an x that is off by less than its last digit."""
    quarters, rest = less_quarters(x)
    sin, cos = sin_cos(rest)
    quarters = quarters - 4 * jnp.floor(0.25 * quarters)
    odd = (quarters == 1) | (quarters == 3)
    sin, cos = jnp.where(odd, cos, sin), jnp.where(odd, sin, cos)
    return (
        jnp.where(quarters >= 2, -sin, sin),
        jnp.where((quarters == 1) | (quarters == 2), -cos, cos),
    )


@sin_cos_of_any.defjvp
def _sin_cos_of_any_jvp(primals, tangents):
    sin, cos = sin_cos_of_any(*primals)
    return (sin, cos), (cos * tangents[0], -sin * tangents[0])


@jax.custom_jvp
def sinh_cosh(w: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(sinh w, cosh w), with the digits of a small w."""
    size = jnp.abs(w)
    y = jnp.exp(size)
    e = 1 / y
    x = w * w
    near = w + w * (x * _polynomial(x, _SINH))
    far = 0.5 * (y - e)
    return jnp.where(size < 0.36, near, jnp.where(w < 0, -far, far)), 0.5 * (y + e)


@sinh_cosh.defjvp
def _sinh_cosh_jvp(primals, tangents):
    sinh, cosh = sinh_cosh(*primals)
    return (sinh, cosh), (cosh * tangents[0], sinh * tangents[0])


@jax.custom_jvp
def log(x: FloatArray) -> FloatArray:
    """ln x for normal x > 0; anything elsewhere."""
    if x.dtype != jnp.float64:
        return jnp.log(x)
    # x = 2^k f with f in [√½, √2); 2^k is kept biased, so that no signed shift is needed.
    bits = lax.bitcast_convert_type(x, jnp.uint64)
    shifted = bits + jnp.uint64(0x3FF0000000000000 - 0x3FE6A09E667F3BCD)
    biased = shifted >> jnp.uint64(52)
    mantissa = (shifted & jnp.uint64(0x000FFFFFFFFFFFFF)) + jnp.uint64(0x3FE6A09E667F3BCD)
    f = lax.bitcast_convert_type(mantissa, jnp.float64)
    # The integer k as a float: its bits below those of 2^52.
    k = lax.bitcast_convert_type(biased | jnp.uint64(0x4330000000000000), jnp.float64)
    k = k - (4503599627370496.0 + 1023.0)
    s = (f - 1) / (f + 1)
    y = s * s
    # ln 2 in two parts, the first with 21 digits to spare for k (fdlibm's).
    tail = s * (y * _polynomial(y, _LOG)) + k * 1.90821492927058770002e-10
    return k * 6.93147180369123816490e-01 + (2 * s + tail)


@log.defjvp
def _log_jvp(primals, tangents):
    return log(*primals), tangents[0] / primals[0]


@jax.custom_jvp
def angle(sin: FloatArray, cos: FloatArray) -> FloatArray:
    """The angle in [−π/2, π/2] of a sine and a cosine >= 0: twice the arctangent of the
    smaller of tan(φ/2) and tan((π/2 − φ)/2), which is at most √2 − 1."""
    size = jnp.abs(sin)
    x = jnp.minimum(size, cos) / (1 + jnp.maximum(size, cos))
    y = x * x
    near = 2 * x + x * (y * _polynomial(y, _ANGLE))
    phi = jnp.where(size > cos, 0.5 * jnp.pi - near, near)
    return jnp.where(sin < 0, -phi, phi)


@angle.defjvp
def _angle_jvp(primals, tangents):
    sin, cos = primals
    return angle(sin, cos), cos * tangents[0] - sin * tangents[1]


@jax.custom_jvp
def reciprocal(x: FloatArray) -> FloatArray:
    """1 / x, whose derivative does not form 1 / x², and is 0 where 1 / x is."""
    return 1 / x


@reciprocal.defjvp
def _reciprocal_jvp(primals, tangents):
    r = reciprocal(*primals)
    return r, -r * jnp.where(r == 0, 0, r * tangents[0])


def half_root(x: FloatArray) -> FloatArray:
    """2 (1 − √(1 − x)) / x for 0 <= x <= 0.02945, without the root."""
    return 1 + x * _polynomial(x, _HALF_ROOT)


def rc_near(e: FloatArray) -> FloatArray:
    """RC(1, 1 + e) = arctan √e / √e for |e| <= 0.17."""
    return 1 + e * _polynomial(e, _RC)


def rc_middle(e: FloatArray, y: FloatArray) -> FloatArray:
    """RC(1, y), y = 1 + e, for 0.5 <= y <= 2: one duplication brings it near."""
    r = 1 + jnp.sqrt(y)
    return 2 / r * rc_near(e / (r * r))


def rc_any(e: FloatArray, y: FloatArray) -> FloatArray:
    """RC(1, y) = artanh √(1 − y) / √(1 − y), y = 1 + e, for 0 < y <= 2."""
    low = y < 0.5
    middle = rc_middle(jnp.where(low, -0.5, e), jnp.where(low, 0.5, y))
    below = jnp.where(low, y, 0.25)
    s = jnp.sqrt(1 - below)
    return jnp.where(low, 0.5 * log((1 + s) * (1 + s) * reciprocal(below)) / s, middle)


def power_of_two(exponent: Int[Array, "..."], dtype) -> FloatArray:
    """A normal number, by its bits: `jnp.ldexp` calls a power function."""
    bits = jnp.finfo(dtype)
    whole = jnp.int64 if bits.bits == 64 else jnp.int32
    biased = exponent.astype(whole) + (bits.maxexp - 1)
    return lax.bitcast_convert_type(biased << bits.nmant, dtype)
