from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax._arrays import common, concrete, difference_of_products, require, whole


@pytest.mark.parametrize("compiled", [False, True])
def test_difference_of_products_keeps_its_digits(dtype, compiled):
    """Products that agree to the last bit or two, and products that do not."""
    rng = np.random.default_rng(0)
    a, b = rng.uniform(1, 2, (2, 3000)).astype(dtype)
    c = (a * (1 + 10 ** rng.uniform(-9, 0, 3000))).astype(dtype)
    d = (a.astype(float) * b / c * (1 + rng.integers(-3, 4, 3000) * jnp.finfo(dtype).eps)).astype(
        dtype
    )
    function = jax.jit(difference_of_products) if compiled else difference_of_products
    got = np.asarray(function(*map(jnp.asarray, (a, b, c, d))))
    assert got.dtype == dtype
    for w, x, y, z, g in zip(*(np.asarray(v, float) for v in (a, b, c, d, got)), strict=True):
        true = Fraction(w) * Fraction(x) - Fraction(y) * Fraction(z)
        eps = Fraction(float(np.finfo(dtype).eps))
        assert abs(Fraction(g) - true) <= 2 * eps * abs(true) + 4 * eps**2 * Fraction(w * x)


def test_common_broadcasts_to_one_dtype(dtype):
    x, y, z = common(x=jnp.ones((3, 1), dtype), y=2.0, z=jnp.zeros(4, dtype))
    assert x.shape == y.shape == z.shape == (3, 4)
    assert x.dtype == y.dtype == z.dtype == dtype
    assert common(n=3)[0].dtype == dtype
    assert common(h=jnp.float16(1.0), x=2.0)[0].dtype == jnp.float16


def test_mixed_precision_gives_the_wider(standard_promotion):
    assert common(x=jnp.float32(1), y=jnp.float64(1))[0].dtype == jnp.float64


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"x": 1j}, "Argument `x` must be real numbers, but got complex128."),
        ({"x": True}, "Argument `x` must be real numbers, but got bool."),
        ({"x": "one"}, "Argument `x` must be a number or an array, but got str."),
        ({"x": [1.0]}, "Argument `x` must be a number or an array, but got list."),
        (
            {"x": np.ones(2), "y": np.ones(3)},
            r"Arguments must broadcast together, but got shapes `x` \(2,\), `y` \(3,\).",
        ),
    ],
)
def test_common_names_what_is_wrong(arguments, message):
    with pytest.raises(ValueError, match=message):
        common(**arguments)


def test_require_sees_values_but_not_tracers_or_nan():
    def positive(x):
        return x > 0

    message = "Argument `x` must be positive, but got -1.0."
    with pytest.raises(ValueError, match=message):
        require("x", -1.0, "positive", positive)
    with pytest.raises(ValueError, match=message):
        require("x", jnp.array([2.0, -1.0, -3.0]), "positive", positive)
    require("x", np.nan, "positive", positive)
    require("x", None, "positive", positive)

    @jax.jit
    def traced(x):
        require("x", x, "positive", positive)
        assert concrete(x) is None
        return x

    traced(-1.0)


@pytest.mark.parametrize("x", [0, 2.5, "3", None])
def test_whole_numbers(x):
    assert whole("count", np.int64(3), 1) == 3
    with pytest.raises(ValueError, match="`count` must be 1 or more, a whole number, but got"):
        whole("count", x, 1)
