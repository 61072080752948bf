"""sin and cos of any angle, as the series of a motion begin, against mpmath."""

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest

from pendax.special._elementary import sin_cos_of_any


def around(x):
    """Floats, and those to either side."""
    return np.concatenate([np.nextafter(x, x.dtype.type(s)) for s in (-np.inf, np.inf)] + [x])


def angles(dtype, quarters):
    """Of either sign, small and large, and the floats at and beside multiples of π/2."""
    rng = np.random.default_rng(0)
    smallest = float(np.finfo(dtype).minexp) + 1
    small = 2.0 ** rng.uniform(smallest, 0, 1000)
    large = 2.0 ** rng.uniform(0, np.log2(quarters), 2000)
    count = np.concatenate([np.arange(100), rng.integers(1, quarters, 1000)])
    beside = around((count * (np.pi / 2)).astype(dtype))
    x = np.concatenate([small.astype(dtype), large.astype(dtype), beside])
    # Subnormal numbers count as 0 here.
    return np.concatenate([x, -x])[np.abs(np.concatenate([x, x])) >= np.finfo(dtype).tiny]


@pytest.mark.parametrize("how", ["compiled", "as it is"])
def test_sine_and_cosine(how, dtype):
    """1.3 eps of each, of any size and at its zeros."""
    x = angles(dtype, 600_000 if dtype == np.float64 else 600)
    function = jax.jit(sin_cos_of_any) if how == "compiled" else sin_cos_of_any
    sine, cosine = function(jnp.asarray(x))
    assert sine.dtype == cosine.dtype == dtype
    with mp.workprec(200):
        for got, true in ((sine, mp.sin), (cosine, mp.cos)):
            for angle, value in zip(x, np.asarray(got), strict=True):
                exact = true(mp.mpf(float(angle)))
                error = abs(mp.mpf(float(value)) - exact) / abs(exact)
                assert error <= 1.3 * float(np.finfo(dtype).eps), (angle, float(error))


def test_far_out(dtype):
    """As of an angle off by less than its last digit; what is not finite has none."""
    rng = np.random.default_rng(1)
    low, high = (20, 52) if dtype == np.float64 else (10, 23)
    x = (2.0 ** rng.uniform(low, high, 1000)).astype(dtype)
    got = np.stack(jax.jit(sin_cos_of_any)(jnp.asarray(x)))
    with mp.workprec(200):
        true = np.array([[float(f(float(a))) for a in x] for f in (mp.sin, mp.cos)])
    assert (np.abs(got - true) <= np.spacing(x)).all()
    largest = np.finfo(dtype).max
    sine, cosine = sin_cos_of_any(jnp.array([largest, -largest, np.inf, -np.inf, np.nan]))
    np.testing.assert_allclose((sine**2 + cosine**2)[:2], 1, rtol=4 * np.finfo(dtype).eps)
    assert np.isnan(np.stack([sine, cosine])[:, 2:]).all()
    np.testing.assert_array_equal(sin_cos_of_any(jnp.zeros(1, dtype)), [[0], [1]])


def test_derivatives_of_sine_and_cosine(dtype):
    """In every mode, at multiples of π/2 as well."""
    x = jnp.asarray(angles(dtype, 1000)[::400])
    sine, cosine = sin_cos_of_any(x)

    def both(x):
        return jnp.stack(sin_cos_of_any(x))

    for mode in (jax.jacfwd, jax.jacrev):
        np.testing.assert_array_equal(jax.vmap(mode(both))(x), np.stack([cosine, -sine], 1))
        for outer in (jax.jacfwd, jax.jacrev):
            second = jax.jit(jax.vmap(outer(mode(both))))(x)
            np.testing.assert_allclose(second, -np.stack([sine, cosine], 1), rtol=1e-6)
