"""K and E against mpmath, in eps, values and derivatives."""

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
from references import exact

from pendax.special import ellipe, ellipk, ellipkm1

BAR = 3  # eps, relative


def reference_k(m1):
    return mp.pi / (2 * mp.agm(1, mp.sqrt(m1)))


def reference_e(m1):
    with mp.workdps(mp.mp.dps + 2 * max(0, int(-mp.log10(m1)))):
        return mp.ellipe(1 - m1)


def worst(got, reference, points):
    with mp.workdps(60):
        errors = [abs(exact(g) / reference(p) - 1) for g, p in zip(got, points, strict=True)]
        return float(max(errors)) / np.finfo(got.dtype).eps


def parameters(dtype, seed=1):
    """m by region, as floats of the dtype."""
    rng = np.random.default_rng(seed)
    tiny, huge = np.finfo(dtype).tiny, np.finfo(dtype).max / 4
    one = dtype.type(1)
    yield "tiny", np.geomspace(tiny, 1e-3, 100)
    yield "mid", rng.uniform(0, 1, 300)
    yield "near one", 1 - 10.0 ** rng.uniform(np.log10(np.finfo(dtype).eps), -1, 200)
    yield "below one", np.array([np.nextafter(one, one - one), 1 - np.finfo(dtype).eps])
    yield "negative", -np.geomspace(1e-6, huge, 400)
    yield (
        "edges",
        np.array([-1.0, np.nextafter(-one, 0 * one), 0.0, 0.5, 0.5 + np.finfo(dtype).eps]),
    )


def test_k_and_e(dtype):
    for region, m in parameters(dtype):
        m = m.astype(dtype)
        m = m[m < 1]
        k, e = np.asarray(ellipk(m)), np.asarray(ellipe(m))
        assert k.dtype == e.dtype == dtype
        assert worst(k, lambda x: reference_k(1 - exact(x)), m) <= BAR, region
        assert worst(e, lambda x: reference_e(1 - exact(x)), m) <= BAR, region


def test_km1(dtype):
    p = np.geomspace(np.finfo(dtype).tiny, np.finfo(dtype).max / 4, 1500).astype(dtype)
    assert worst(np.asarray(ellipkm1(p)), lambda x: reference_k(exact(x)), p) <= BAR


@pytest.mark.parametrize("m", [-1e6, -3.0, -1.0, -0.3, 1e-8, 0.3, 0.5, 0.9, 1 - 1e-12])
def test_derivatives(m):
    """dK/dm = (E − m1 K)/(2 m m1), dE/dm = (E − K)/(2 m) (DLMF 19.4.1-2), all modes."""
    with mp.workdps(60):
        x = exact(m)
        k, e = reference_k(1 - x), reference_e(1 - x)
        dk, de = (e - (1 - x) * k) / (2 * x * (1 - x)), (e - k) / (2 * x)
    for function, slope in ((ellipk, dk), (ellipe, de)):
        for mode in (jax.grad, jax.jacfwd, lambda f: jax.jit(jax.jacrev(f))):
            assert float(mode(function)(m)) == pytest.approx(float(slope), rel=50 * 2**-52)
    second = mp.diff(lambda x: reference_k(1 - x), exact(m), 2)
    assert float(jax.hessian(ellipk)(m)) == pytest.approx(float(second), rel=1e-12)


def test_edges_of_the_domain(dtype):
    m = jnp.array([0.0, 1.0, 1.5, jnp.inf, jnp.nan, 0.25], dtype)
    k, dk = jax.vmap(jax.value_and_grad(ellipk))(m)
    e, de = jax.vmap(jax.value_and_grad(ellipe))(m)
    assert k[0] == e[0] == jnp.asarray(np.pi / 2, dtype)
    np.testing.assert_allclose(dk[0], np.pi / 8, rtol=4 * jnp.finfo(dtype).eps)
    np.testing.assert_allclose(de[0], -np.pi / 8, rtol=4 * jnp.finfo(dtype).eps)
    assert (k[1], dk[1], e[1], de[1]) == (jnp.inf, jnp.inf, 1, -jnp.inf)
    for x in (k, dk, e, de):
        assert jnp.isnan(x[2:5]).all()
        assert jnp.isfinite(x[5])
    assert jnp.isinf(ellipkm1(jnp.zeros((), dtype)))
    assert jnp.isnan(ellipkm1(jnp.asarray(-1.0, dtype)))


def test_half_precision_rounds_float32():
    m = jnp.linspace(-2, 0.99, 50)
    for half in (jnp.float16, jnp.bfloat16):
        k = ellipk(m.astype(half))
        assert k.dtype == half
        assert (k == ellipk(m.astype(half).astype(jnp.float32)).astype(half)).all()


def test_legendres_relation():
    """E K' + E' K − K K' = π/2 (DLMF 19.7.1), across the classes of m."""
    m = jnp.linspace(0.001, 0.999, 999)
    k, e, k1, e1 = ellipk(m), ellipe(m), ellipk(1 - m), ellipe(1 - m)
    np.testing.assert_allclose(e * k1 + e1 * k - k * k1, np.pi / 2, rtol=3e-15)


def test_slopes_far_out_and_beyond_the_ends():
    """Where 1 / m1^2 is no float any more, and where there is no value."""
    for value, true in (
        (jax.grad(ellipk)(-1e154), 8.884267326083069e-230),
        (jax.grad(ellipkm1)(1e154), -8.884267326083069e-230),
        (jax.grad(ellipe)(-1e154), -5e-78),
    ):
        np.testing.assert_allclose(value, true, rtol=1e-12)
    second = [jax.grad(jax.grad(f))(1.0) for f in (ellipk, ellipe)]
    np.testing.assert_array_equal(second, [np.inf, -np.inf])
    for f in (ellipk, ellipe):
        for m in (2.0, np.inf, np.nan):
            assert np.isnan(jax.grad(jax.grad(f))(m))


def test_at_infinity(dtype):
    infinity = jnp.asarray(jnp.inf, dtype)
    assert ellipk(-infinity) == 0
    assert ellipkm1(infinity) == 0
    assert ellipe(-infinity) == infinity
