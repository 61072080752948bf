"""sn, cn, dn and the amplitude against mpmath, in eps × scale, values and derivatives."""

from functools import cache, partial

import flint
import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
import references
from cases import TAGS, cases
from references import exact

from pendax.special import ellipj, ellipk

BAR = 8  # eps × (|f| + |u df/du|)


@cache
def table(dtype, size):
    return cases(dtype, size)


@pytest.mark.parametrize("tag", TAGS)
def test_the_table_is_what_it_says(tag, dtype):
    _, name, u, parameter = table(dtype, 120)[tag]
    m1 = 1 - parameter if name == "m" else parameter
    quarters = [
        abs(float(exact(x) / references.quarter_period(**{name: p}))) if p != 1 else 0
        for x, p in zip(u, parameter, strict=True)
    ]
    quarters = np.array(quarters)
    lowest, largest = (1e-300, 1e6) if dtype == np.float64 else (1e-36, 1e4)
    beside = np.abs(quarters / np.maximum(np.round(quarters), 1) - 1)
    holds = {
        "mid": (np.abs(u) <= 20) & (m1 > 0) & (m1 < 1),
        "tiny u": (np.abs(u) >= lowest) & (np.abs(u) < 1e-8),
        "small u": (np.abs(u) > 0.9e-8) & (np.abs(u) <= 0.1),
        "negative": parameter < 0,
        "above one": m1 < 0,
        "around the classes": (parameter >= -1.2) & (parameter <= 2.3),
        "at zero": parameter == 0,
        "at one": parameter == 1,
        "near one": (np.abs(m1) >= 0.9 * lowest) & (np.abs(m1) <= 1) & (np.abs(u) <= 10),
        "near one, three quarters": (np.abs(m1) <= 1) & (quarters <= 3.01),
        "near one, quarter periods": (np.abs(m1) <= 1) & (quarters > 0.8) & (beside <= 0.11),
        "quarter periods": (quarters > 0.8) & (beside <= 0.11),
        "huge u": (quarters >= 990) & (quarters <= 1.01 * largest),
    }
    assert np.isfinite(u).all()
    assert holds[tag].all()
    if tag not in ("at zero", "at one"):
        assert np.unique(parameter).size > 60
    if tag.startswith(("near one", "around")):
        assert (m1 < 0).any()
        assert (m1 > 0).any()


@pytest.mark.parametrize("tag", TAGS)
def test_values(tag, dtype):
    _, name, u, parameter = table(dtype, 120)[tag]
    u, parameter = u.astype(dtype), parameter.astype(dtype)
    sn, cn, dn, ph = (np.asarray(x, float) for x in ellipj(u, **{name: parameter}))
    eps = np.finfo(dtype).eps
    for i in range(u.size):
        true = references.ellipj(u[i], **{name: parameter[i]})
        m = exact(parameter[i]) if name == "m" else 1 - exact(parameter[i])
        s, c, d = true
        # The last is the second order of the same, where the first vanishes: a float32 u of
        # ten thousand quarter periods is a hundredth of one off for a rounding in its last bits.
        second = (s * (d * d + m * c * c), c * (d * d - m * s * s), m * d * (c * c - s * s))
        for got, f, slope, bend in zip(
            (sn[i], cn[i], dn[i]), true, (c * d, s * d, m * s * c), second, strict=True
        ):
            scale = abs(f) + abs(exact(u[i]) * slope)
            if dtype == np.float32:
                scale += abs(exact(u[i]) ** 2 * bend) * BAR * float(eps) / 2
            assert abs(exact(got) - f) <= BAR * eps * scale, (u[i], parameter[i])
        scale = abs(ph[i]) + abs(exact(u[i]) * d)
        turned = exact(ph[i]) - mp.atan2(s, c)
        turned -= 2 * mp.pi * mp.nint(turned / (2 * mp.pi))
        assert abs(turned) <= BAR * eps * scale, (u[i], parameter[i])
    m = parameter.astype(float) if name == "m" else 1 - parameter.astype(float)
    assert (np.abs(sn) <= 1).all()
    assert (np.abs(cn) <= 1).all()
    assert np.abs(sn**2 + cn**2 - 1).max() <= 8 * eps
    assert (np.abs(dn**2 + m * sn**2 - 1) <= 8 * eps * (1 + np.abs(m) * sn**2)).all()


@pytest.mark.parametrize("m", [-50.0, -1.0, 0.0, 0.3, 0.999999, 1.0, 1.000001, 3.0])
def test_amplitude_is_continuous(m):
    """No step of `ph` exceeds max(dn) du: nothing is folded, for any m."""
    u = 0.004 * jnp.arange(-10000.0, 10001.0)
    _, _, dn, ph = ellipj(u, m)
    step = float(u[1] - u[0]) * float(jnp.abs(dn).max())
    assert float(jnp.abs(jnp.diff(ph)).max()) <= step * (1 + 1e-9)
    assert ph[10000] == 0


SPECIAL = [
    (0.0, 0.0), (0.0, 1.0), (1.5, 0.0), (1.5, 1.0), (-7.0, 1.0), (30.0, 1.0), (0.3, 0.5),
    (5.0, -3.0), (-2.0, 2.0), (4.0, 2.5), (1e-6, 0.7), (9.0, 0.99), (3.0, -1.0), (2.0, 1e-12),
    (3.0, 0.5), (3.0, 0.5 + 2**-53), (3.0, 1 - 2**-53), (3.0, 1 + 2**-52), (3.0, -1 - 2**-52),
    (3.0, 2 + 2**-51), (3.0, 2**-1000), (3.0, -(2.0**-1000)),
]  # fmt: skip
SECONDS = {(2, 0): (0, 0), (1, 1): (0, 1), (0, 2): (1, 1)}


@cache
def derivative(name, mode):
    """Of the four functions in (u, parameter), compiled and mapped over pairs."""

    def functions(x):
        return jnp.stack(ellipj(x[0], **{name: x[1]}))

    return jax.jit(jax.vmap(mode(functions)))


def twice_forward(f):
    return jax.jacfwd(jax.jacfwd(f))


@cache
def references_of(tag, dtype, size=10):
    """(name, pairs, derivatives, scales of the second derivatives)."""
    if tag == "special":
        name, u, p = "m", *np.array(SPECIAL, dtype).astype(float).T
    else:
        _, name, u, p = table(dtype, size)[tag]
    balls = [references.derivatives(x, name, y) for x, y in zip(u, p, strict=True)]
    return name, np.stack([u, p], 1), balls


@pytest.mark.parametrize("tag", ["special", *TAGS])
def test_first_derivatives(tag, dtype):
    """50 eps × (|g| + Σ |y dg/dy| + scale of the value / max(|x|, 1)); forward is reverse."""
    name, pairs, balls = references_of(tag, dtype)
    x = jnp.asarray(pairs, dtype)
    forward, reverse = (
        np.asarray(derivative(name, mode)(x), float) for mode in (jax.jacfwd, jax.jacrev)
    )
    ph = np.asarray(ellipj(x[:, 0], **{name: x[:, 1]})[3], float)
    eps = np.finfo(dtype).eps
    for i, (pair, d) in enumerate(zip(np.abs(pairs), balls, strict=True)):
        for f in range(4):
            value = abs(d[0, 0][f]) if f < 3 else abs(float(ph[i]))
            value += pair[0] * abs(d[1, 0][f]) + pair[1] * abs(d[0, 1][f])
            for k, (first, others) in enumerate(
                (((1, 0), ((2, 0), (1, 1))), ((0, 1), ((1, 1), (0, 2))))
            ):
                true = d[first][f]
                scale = abs(true) + value / max(pair[k], 1)
                scale += pair[0] * abs(d[others[0]][f]) + pair[1] * abs(d[others[1]][f])
                assert abs(flint.arb(forward[i, f, k]) - true) <= 50 * eps * scale, (pair, f, k)
                assert abs(flint.arb(forward[i, f, k] - reverse[i, f, k])) <= 10 * eps * scale


@pytest.mark.parametrize("tag", ["special", *TAGS])
@pytest.mark.parametrize("mode", [jax.hessian, pytest.param(twice_forward, marks=pytest.mark.full)])
def test_second_derivatives(tag, mode):
    """1e-12 × scale in uu, and in um and mm for |m1| >= 1e-3, |u| >= 0.1; elsewhere 1e-11
    of the largest of the four outputs'.  Where |m1| < 1e-140, past half a period, second
    derivatives by m leave the range of the floats on the way or for good."""
    name, pairs, balls = references_of(tag, np.dtype("float64"))
    if name == "m1":
        keep = np.abs(pairs[:, 1]) > 1e-140
        pairs, balls = pairs[keep], [d for d, kept in zip(balls, keep, strict=True) if kept]
    hessian = np.asarray(derivative(name, mode)(jnp.asarray(pairs)))
    for i, ((u, p), d) in enumerate(zip(pairs, balls, strict=True)):
        m1 = p if name == "m1" else 1 - p
        for order, (row, column) in SECONDS.items():
            largest = max(abs(float(x)) for x in d[order])
            # What a rounding of the arguments does, in units of it.
            moved = [
                references.derivatives(u * (1 + k * 2**-30), name, p * (1 + (1 - k) * 2**-30))[
                    order
                ]
                for k in (0, 1)
            ]
            for f in range(4):
                true = float(d[order][f])
                sharp = order == (2, 0) or (abs(m1) >= 1e-3 and abs(u) >= 0.1)
                bar = 1e-11 * largest + 1e-150  # the references are differences
                if sharp:
                    condition = sum(abs(float(x[f] - d[order][f])) for x in moved) * 2**30
                    firsts = abs(float(d[1, 0][f])) + abs(float(d[0, 1][f])) * (order != (2, 0))
                    bar = 1e-12 * (abs(true) + condition + firsts + 1e-150)
                assert abs(hessian[i, f, row, column] - true) <= bar, (u, p, order, f)
                assert abs(hessian[i, f, column, row] - true) <= bar, (u, p, order, f)


@pytest.mark.parametrize("tag", [tag for tag in TAGS if tag.startswith("near one")])
def test_second_derivatives_by_u_alone(tag):
    """1e-12 × scale down to |m1| = 1e-300: nothing that overflows in m is in the way."""
    name, pairs, balls = references_of(tag, np.dtype("float64"))

    def functions(u, m1):
        return jnp.stack(ellipj(u, m1=m1))

    assert name == "m1"
    assert (np.abs(pairs[:, 1]) < 1e-140).any()
    for mode in (jax.hessian, twice_forward):
        got = np.asarray(jax.vmap(mode(functions))(*jnp.asarray(pairs).T))
        for i, ((u, p), d) in enumerate(zip(pairs, balls, strict=True)):
            moved = references.derivatives(u * (1 + 2.0**-30), name, p)[2, 0]
            for f in range(4):
                true = float(d[2, 0][f])
                condition = abs(float(moved[f] - d[2, 0][f])) * 2**30
                bar = 1e-12 * (abs(true) + condition + abs(float(d[1, 0][f])))
                assert abs(got[i, f] - true) <= bar, (u, p, f)


@pytest.mark.parametrize("mode", [jax.jacfwd, jax.jacrev, jax.hessian])
@pytest.mark.parametrize("compiled", [False, True])
def test_derivatives_at_whole_half_periods(mode, compiled):
    """Where the reduced argument is rounding noise its sign is, too; no derivative hangs on it."""
    rng = np.random.default_rng(11)
    m = np.concatenate([rng.uniform(-3, 0.99, 30), rng.uniform(1.01, 40, 10)])
    u = np.array([float(2 * references.quarter_period(m=x)) for x in m]) * rng.integers(-6, 7, 40)

    def functions(u, m):
        return jnp.stack(ellipj(u, m)[:3])

    sn, cn, dn = functions(u, m)
    derivative = jax.vmap(mode(functions))
    got = (jax.jit(derivative) if compiled else derivative)(u, m)
    if mode is jax.hessian:
        true = [-sn * (dn**2 + m * cn**2), -cn * (dn**2 - m * sn**2), -m * dn * (cn**2 - sn**2)]
    else:
        true = [cn * dn, -sn * dn, -m * sn * cn]
    np.testing.assert_allclose(got, jnp.stack(true, 1), rtol=1e-9, atol=1e-9)


def test_period_at_the_separatrix_is_differentiable():
    """m1 tiny and u past the half period: the derivative in m1 is that of the period."""
    u, m1 = 100.0, 1e-30
    slope = jax.grad(lambda p: ellipj(u, m1=p)[1])(m1)
    with mp.workdps(120):
        true = mp.diff(
            lambda p: references.jacobi(mp.mpf(u), 1 - p)[1], exact(m1), h=mp.mpf(10) ** -70
        )
    assert float(slope) == pytest.approx(float(true), rel=1e-10)


def test_shapes_dtypes_and_modes(dtype):
    u, m = jnp.linspace(-3, 3, 7, dtype=dtype)[:, None], jnp.linspace(-2, 3, 5, dtype=dtype)
    values = ellipj(u, m)
    assert all(x.shape == (7, 5) and x.dtype == dtype for x in values)
    mapped = jax.vmap(lambda v: jnp.stack(ellipj(v, m)))(u[:, 0])
    for x, y in zip(values, jnp.moveaxis(mapped, 1, 0), strict=True):
        np.testing.assert_allclose(x, y, rtol=0, atol=4 * jnp.finfo(dtype).eps)
    assert all(x.dtype == jnp.bfloat16 for x in ellipj(jnp.bfloat16(1), 0.5))


def test_at_one_beyond_the_range_of_cosh(dtype):
    """m = 1 and cosh u out of range: a slope that overflows spoils no other derivative."""
    u = 100.0 if dtype == np.float32 else 800.0
    x = jnp.array([u, 1.0], dtype)
    for mode in (jax.jacfwd, jax.jacrev):
        jacobian = mode(lambda x: jnp.stack(ellipj(x[0], x[1])))(x)
        np.testing.assert_array_equal(jacobian[:, 0], 0)
        assert jacobian[0, 1] == -0.25
        assert jnp.isfinite(jacobian).all()
    hessian = jax.hessian(lambda x: jnp.stack(ellipj(x[0], x[1])))(x)
    np.testing.assert_array_equal(hessian[:, 0, 0], 0)


def test_blocks_are_the_whole():
    """Arrays that the CPU works through in blocks, the last of them overlapping."""
    from pendax.special import _cpu

    rng = np.random.default_rng(12)
    for size in (2 * _cpu._FEW - 1, 2 * _cpu._FEW, 2 * _cpu._FEW + 1000):
        u, m = rng.uniform(-9, 9, size), rng.uniform(-3, 3, size)
        for parameter in (m, m[:1]):
            whole = jnp.stack(ellipj(u, parameter))
            some = slice(size - 2000, size)
            part = jnp.stack(ellipj(u[some], parameter[some] if parameter is m else parameter))
            np.testing.assert_allclose(whole[:, some], part, rtol=0, atol=1e-13)
            np.testing.assert_allclose(
                whole[:, :50], jnp.stack(ellipj(u[:50], parameter[:50])), rtol=0, atol=1e-13
            )


def test_nan_stays_in_its_lane():
    u = jnp.array([1.0, jnp.nan, 1.0, jnp.inf, 1.0])
    m = jnp.array([0.5, 0.5, jnp.nan, 0.5, jnp.inf])

    def total(u, m):
        return sum(x.sum() for x in ellipj(u, m))

    values = jnp.stack(ellipj(u, m))
    assert jnp.isfinite(values[:, 0]).all()
    assert jnp.isnan(values[:, 1:]).all()
    for slope in jax.vmap(jax.grad(total, (0, 1)))(u, m):
        assert jnp.isfinite(slope[0])
        assert jnp.isnan(slope[1:]).all()


@pytest.mark.parametrize("parameters", [{}, {"m": 0.5, "m1": 0.5}])
def test_exactly_one_parameter(parameters):
    with pytest.raises(ValueError, match="Arguments `m` and `m1` must be given one without the"):
        ellipj(1.0, **parameters)


IDENTITIES = {
    # sn(u + 2 K) = −sn u, DLMF 22.4.3
    "quasi-period": lambda u, m: (
        ellipj(u + 2 * ellipk(m), m)[:2],
        [-x for x in ellipj(u, m)[:2]],
    ),
    # negative parameter, DLMF 22.17.8
    "m to m/(m−1)": lambda u, m: (
        ellipj(u, -m / (1 - m))[:2],
        [
            jnp.sqrt(1 - m) * ellipj(u / jnp.sqrt(1 - m), m)[0] / ellipj(u / jnp.sqrt(1 - m), m)[2],
            ellipj(u / jnp.sqrt(1 - m), m)[1] / ellipj(u / jnp.sqrt(1 - m), m)[2],
        ],
    ),
    "m to 1/m": lambda u, m: (
        ellipj(u, 1 / m)[:2],
        [jnp.sqrt(m) * ellipj(u / jnp.sqrt(m), m)[0], ellipj(u / jnp.sqrt(m), m)[2]],
    ),
    "m to m1": lambda u, m: (ellipj(u, m), ellipj(u, m1=1 - m)),
}


@pytest.mark.parametrize("identity", IDENTITIES)
def test_identities(identity):
    rng = np.random.default_rng(3)
    u, m = jnp.asarray(rng.uniform(-5, 5, 500)), jnp.asarray(rng.uniform(0.01, 0.99, 500))
    for left, right in zip(*IDENTITIES[identity](u, m), strict=True):
        np.testing.assert_allclose(left, right, rtol=0, atol=3e-14)


def test_addition_theorem():
    """sn(u + v), DLMF 22.8.1."""
    rng = np.random.default_rng(4)
    u, v = jnp.asarray(rng.uniform(-5, 5, (2, 500)))
    m = jnp.asarray(rng.uniform(-3, 0.99, 500))
    (s, c, d, _), (t, e, f, _) = map(partial(ellipj, m=m), (u, v))
    np.testing.assert_allclose(
        ellipj(u + v, m)[0], (s * e * f + t * c * d) / (1 - m * (s * t) ** 2), atol=3e-14, rtol=0
    )


def test_against_the_sources_table(shared):
    rows = np.genfromtxt(
        shared / "truth" / "jacobi_table.csv",
        delimiter=",",
        names=True,
        dtype=None,
        encoding="utf-8",
    )
    rows = rows[rows["m"] < 0.999]  # the decimal m, beyond that not its float, is the argument
    values = ellipj(rows["u"], rows["m"])
    for x, name in zip(values, ("sn", "cn", "dn", "am"), strict=True):
        np.testing.assert_allclose(x, rows[name], rtol=1e-14, atol=1e-14)
