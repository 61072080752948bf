"""arcsn and ellipnome against mpmath, in eps × scale, values and first derivatives."""

from functools import partial

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
from references import exact

from pendax.special import arcsn, ellipj, ellipk, ellipkm1, ellipnome


def slopes(f, x, y, hx, hy):
    """f and its derivatives in both arguments, by differences in the caller's precision."""
    fx = (f(x + hx, y) - f(x - hx, y)) / (2 * hx)
    return f(x, y), fx, (f(x, y + hy) - f(x, y - hy)) / (2 * hy)


def slope_of(f, hx, hy, which, x, y):
    return slopes(f, x, y, hx, hy)[which]


def pairs(region, dtype, size=16):
    rng = np.random.default_rng(6)
    lowest = -300 if dtype == np.float64 else -36
    tight = -15 if dtype == np.float64 else -6
    x, m = rng.uniform(-1, 1, size), rng.uniform(0, 1, size)
    tiny = 10 ** rng.uniform(lowest, 0, size)
    name, x, parameter = {
        "mid": ("m", x, m),
        "x near one": ("m", 1 - 10 ** rng.uniform(tight, -1, size), m),
        "both near one": ("m1", 1 - 10 ** rng.uniform(tight, -1, size), tiny),
        "near one": ("m1", x, tiny),
        "negative": ("m", x, -(10 ** rng.uniform(-3, 8, size))),
        "tiny x": ("m", tiny, rng.uniform(-3, 1, size)),
        "above one": ("m", 0.999 * x / np.sqrt(1 + 8 * m), 1 + 8 * m),
    }[region]
    return name, x.astype(dtype), parameter.astype(dtype)


REGIONS = [
    "mid", "x near one", "both near one", "near one", "negative", "tiny x", "above one",
]  # fmt: skip


@pytest.mark.parametrize("region", REGIONS)
def test_arcsn(region, dtype):
    name, x, parameter = pairs(region, dtype)
    eps = float(np.finfo(dtype).eps)
    values = np.asarray(arcsn(x, **{name: parameter}))

    def of_pair(x, p):
        return arcsn(x, **{name: p})

    forward = jax.vmap(jax.jacfwd(of_pair, (0, 1)))(x, parameter)
    reverse = jax.vmap(jax.grad(of_pair, (0, 1)))(x, parameter)
    for i in range(x.size):
        p = exact(parameter[i])
        with mp.workdps(100 + (int(-mp.log10(p)) if name == "m1" else 0)):

            def inverse(x, p):
                return mp.re(mp.ellipf(mp.asin(x), p if name == "m" else 1 - p))

            at = exact(x[i])
            step = mp.mpf(10) ** -30
            room = 1 - abs(at) if name == "m" and p <= 1 else min(1 - abs(at), abs(at))
            hx, hp = step * min(room, abs(at)), step * min(abs(p), 1)
            true, by_x, by_p = slopes(inverse, at, p, hx, hp)
            scale = abs(true) + abs(at * by_x) + abs(p * by_p)
            assert abs(exact(values[i]) - true) <= 8 * eps * scale, (x[i], parameter[i])
            _, xx, xp = slopes(partial(slope_of, inverse, hx, hp, 1), at, p, hx, hp)
            _, _, pp = slopes(partial(slope_of, inverse, hx, hp, 2), at, p, hx, hp)
            for k, (slope, across) in enumerate(((by_x, (xx, xp)), (by_p, (xp, pp)))):
                size = abs(slope) + abs(at * across[0]) + abs(p * across[1])
                size += scale / max(abs((at, p)[k]), 1)
                assert abs(exact(forward[k][i]) - slope) <= 50 * eps * size, (x[i], parameter[i])
                assert abs(exact(forward[k][i]) - exact(reverse[k][i])) <= 10 * eps * size


def test_arcsn_at_the_ends():
    np.testing.assert_allclose(arcsn(1.0, 0.5), ellipk(0.5), rtol=1e-15)
    np.testing.assert_allclose(arcsn(-1.0, m1=1e-200), -ellipkm1(1e-200), rtol=1e-15)
    np.testing.assert_allclose(arcsn(0.5, 4.0), ellipk(0.25) / 2, rtol=1e-15)
    np.testing.assert_array_equal(arcsn(jnp.array([-1.0, 1.0]), 1.0), [-jnp.inf, jnp.inf])
    assert arcsn(0.0, 0.3) == 0
    assert jnp.isinf(jax.grad(arcsn)(1.0, 0.5))
    outside = jnp.array([1.5, -1.1, 0.8, jnp.nan])
    m = jnp.array([0.5, 1.0, 2.0, 0.5])
    assert jnp.isnan(arcsn(outside, m)).all()
    for slope in jax.vmap(jax.grad(arcsn, (0, 1)))(outside, m):
        assert jnp.isnan(slope).all()


def test_sn_undoes_it(dtype):
    rng = np.random.default_rng(7)
    x = rng.uniform(-1, 1, (40, 1)).astype(dtype)
    m = rng.uniform(-5, 1, (1, 30)).astype(dtype)
    np.testing.assert_allclose(
        ellipj(arcsn(x, m), m)[0], np.broadcast_to(x, (40, 30)), atol=20 * jnp.finfo(dtype).eps
    )


@pytest.mark.parametrize("name", ["m", "m1"])
def test_nome(name, dtype):
    rng = np.random.default_rng(8)
    lowest, eps = (-300 if dtype == np.float64 else -36), float(np.finfo(dtype).eps)
    parameter = np.concatenate(
        [rng.uniform(0, 1, 30), 10 ** rng.uniform(lowest, 0, 30), [0.5, 0.5 + 2 * eps]]
    ).astype(dtype)
    values = np.asarray(ellipnome(**{name: parameter}))
    slope = jax.vmap(jax.grad(lambda p: ellipnome(**{name: p})))(parameter)
    also = jax.vmap(jax.jacfwd(lambda p: ellipnome(**{name: p})))(parameter)
    np.testing.assert_allclose(slope, also, rtol=10 * eps)
    with mp.workdps(400):
        for p, got, by_p in zip(map(exact, parameter), values, slope, strict=True):

            def nome(p):
                m, m1 = (p, 1 - p) if name == "m" else (1 - p, p)
                return mp.exp(-mp.pi * mp.ellipk(m1) / mp.ellipk(m))

            h = p * mp.mpf(10) ** -60
            q, up, down = nome(p), nome(p + h), nome(p - h)
            first, second = (up - down) / (2 * h), (up + down - 2 * q) / h**2
            assert abs(exact(got) - q) <= 8 * eps * (q + abs(p * first))
            assert abs(exact(by_p) - first) <= 50 * eps * (abs(first) + abs(p * second) + q)


def test_nome_at_the_ends():
    np.testing.assert_array_equal(ellipnome(jnp.array([0.0, 1.0])), [0.0, 1.0])
    assert ellipnome(m1=0.0) == 1
    m = jnp.array([0.0, 1.0, -0.1, 1.1, jnp.nan])
    assert jnp.isnan(ellipnome(m)[2:]).all()
    slope = jax.vmap(jax.grad(ellipnome))(m)
    np.testing.assert_array_equal(slope[:2], [0.0625, jnp.inf])
    assert jnp.isnan(slope[2:]).all()
    with pytest.raises(ValueError, match="one without the other"):
        ellipnome()
