"""sn, cn, dn and the amplitude against mpmath, in eps × scale, values and derivatives."""

from functools import lru_cache, partial

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
import references
from references import exact

from pendax.special import ellipj, ellipk

BAR = 8  # eps × (|f| + |u df/du|)


def cases(dtype, seed=2, size=120):
    """(region, keyword of the parameter, u, parameter), as floats of the dtype."""
    rng = np.random.default_rng(seed)
    wide = dtype == np.float64
    lowest = -300 if wide else -36

    def signed(x):
        return x * rng.choice([-1, 1], x.shape)

    def quarters(name, parameter, count):
        periods = [references.quarter_period(**{name: p}) for p in parameter]
        return np.array([float(k * exact(n)) for k, n in zip(periods, count, strict=True)])

    m = rng.uniform(0, 1, size)
    m1 = signed(10 ** rng.uniform(lowest, 0, size)).astype(dtype)
    beside = rng.integers(-9, 10, size) * (1 + signed(10 ** rng.uniform(-15, -1, size)))
    yield "mid", "m", rng.uniform(-20, 20, size), m
    yield "tiny u", "m", signed(10 ** rng.uniform(lowest, -1, size)), m
    yield "negative", "m", rng.uniform(-20, 20, size), -(10 ** rng.uniform(-3, 10, size))
    yield "above one", "m", rng.uniform(-20, 20, size), 1 + 10 ** rng.uniform(-6, 10, size)
    yield "around the classes", "m", rng.uniform(-9, 9, size), rng.uniform(-1.1, 2.2, size)
    yield "at zero", "m", rng.uniform(-30, 30, size), np.zeros(size)
    yield "at one", "m", rng.uniform(-80, 80, size), np.ones(size)
    yield "near one", "m1", rng.uniform(-10, 10, size), m1
    yield "near one, three quarters", "m1", quarters("m1", m1, rng.uniform(-3, 3, size)), m1
    yield "near one, quarter periods", "m1", quarters("m1", m1, beside), m1
    yield "quarter periods", "m", quarters("m", m.astype(dtype), beside), m
    many = 10 ** rng.uniform(0, 6 if wide else 4, size)
    yield "huge u", "m", quarters("m", m.astype(dtype), np.floor(many)), m


REGIONS = [case[0] for case in cases(np.dtype("float64"), size=1)]


@pytest.mark.parametrize("region", REGIONS)
def test_values(region, dtype):
    name, u, parameter = next(case[1:] for case in cases(dtype) if case[0] == region)
    u, parameter = u.astype(dtype), parameter.astype(dtype)
    sn, cn, dn, ph = (np.asarray(x, float) for x in ellipj(u, **{name: parameter}))
    eps = np.finfo(dtype).eps
    for i in range(u.size):
        true = references.ellipj(u[i], **{name: parameter[i]})
        m = exact(parameter[i]) if name == "m" else 1 - exact(parameter[i])
        s, c, d = true
        for got, f, slope in zip(
            (sn[i], cn[i], dn[i]), true, (c * d, s * d, m * s * c), strict=True
        ):
            scale = abs(f) + abs(exact(u[i]) * slope)
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


POINTS = [
    (0.0, 0.0), (0.0, 1.0), (1.5, 0.0), (1.5, 1.0), (-7.0, 1.0), (0.3, 0.5), (5.0, -3.0),
    (-2.0, 2.0), (4.0, 2.5), (1e-6, 0.7), (9.0, 0.99), (3.0, -1.0), (20.0, 0.9), (2.0, 1e-12),
]  # fmt: skip


@lru_cache
def reference_derivatives(u, m, order_u, order_m):
    """By differences of step 1e-20 in 80 digits."""
    with mp.workdps(100):
        return [
            mp.diff(
                lambda x, y, i=i: references.jacobi(x, y)[i],
                (exact(u), exact(m)),
                (order_u, order_m),
                h=mp.mpf(10) ** -25,
            )
            for i in range(3)
        ]


MODES = {
    "forward": jax.jacfwd,
    "reverse": jax.jacrev,
    "compiled": lambda f: jax.jit(jax.jacrev(f)),
}


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("u", "m"), POINTS)
def test_first_derivatives(mode, u, m):
    def functions(x):
        return jnp.stack(ellipj(x[0], x[1]))

    jacobian = np.asarray(MODES[mode](functions)(jnp.array([u, m])))
    s, c, d = (float(x) for x in references.ellipj(u, m))
    second = {key: reference_derivatives(u, m, *key) for key in ((2, 0), (1, 1), (0, 2))}
    for column, orders in enumerate(((1, 0), (0, 1))):
        true = reference_derivatives(u, m, *orders)
        for row, slope in enumerate(((c * d), (s * d), (m * s * c))):
            by_u = second[(2, 0)] if column == 0 else second[(1, 1)]
            by_m = second[(1, 1)] if column == 0 else second[(0, 2)]
            value = abs((s, c, d)[row]) + abs(u * slope)
            scale = abs(true[row]) + abs(u * by_u[row]) + abs(m * by_m[row])
            scale += value / max(abs((u, m)[column]), 1)
            assert abs(exact(jacobian[row, column]) - true[row]) <= 50 * 2**-52 * scale
    np.testing.assert_allclose(jacobian[3, 0], d, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("mode", ["hessian", "forward over forward"])
@pytest.mark.parametrize(("u", "m"), POINTS)
def test_second_derivatives(mode, u, m):
    def functions(x):
        return jnp.stack(ellipj(x[0], x[1]))

    twice = jax.hessian if mode == "hessian" else (lambda f: jax.jacfwd(jax.jacfwd(f)))
    hessian = np.asarray(twice(functions)(jnp.array([u, m])))
    assert np.isfinite(hessian).all()
    for i, j, orders in ((0, 0, (2, 0)), (0, 1, (1, 1)), (1, 1, (0, 2))):
        true = [float(x) for x in reference_derivatives(u, m, *orders)]
        # In u, and in m away from u = 0: to rounding.  With respect to m at small u the
        # terms of order u cancel down to u^3: 1e-8 of the largest of the four is left in
        # um, and in mm, where all four are that small, the rounding of order eps u.
        if j == 0 or abs(u) >= 0.1:
            relative, absolute = 1e-11, 1e-14  # of a first derivative of the size of 1
        else:
            relative, absolute = 0, 1e-8 * max(map(abs, true)) if i != j else 1e-15 * abs(u)
        np.testing.assert_allclose(hessian[:3, i, j], true, rtol=relative, atol=absolute + 1e-20)


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
