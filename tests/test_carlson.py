"""Carlson's five against Arb, in eps × scale: values, derivatives of both orders."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from elliptic_references import carlson, error, truth
from flint import arb
from test_incomplete import check

from pendax.special import elliprc, elliprd, elliprf, elliprg, elliprj

FUNCTIONS = {
    "rf": (elliprf, 3),
    "rc": (elliprc, 2),
    "rd": (elliprd, 3),
    "rg": (elliprg, 3),
    "rj": (elliprj, 4),
}
BARS = {"rf": 6, "rc": 6, "rd": 6, "rg": 6, "rj": 20}


def arguments(rng, count, size, exponent, dtype):
    """Of any size, the first three often alike or equal, the last ones sometimes next to them."""
    columns = [10 ** rng.uniform(-exponent, exponent, size) for _ in range(count)]
    alike = rng.integers(0, 4, (count, size))
    nearly = columns[0] * (1 + 10 ** rng.uniform(-15, -2, size))
    return [
        np.where(a == 0, columns[0], np.where(a == 1, nearly, c)).astype(dtype)
        for a, c in zip(alike, columns, strict=True)
    ]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_values_and_derivatives(name, dtype):
    function, count = FUNCTIONS[name]
    rng = np.random.default_rng(21)
    columns = arguments(rng, count, 24, 1, dtype)
    check(function, carlson(name), columns, dtype, second=name != "rj", value=BARS[name])
    columns = arguments(rng, count, 24, 30 if dtype == np.float64 else 5, dtype)
    check(function, carlson(name), columns, dtype, second=False, value=BARS[name])


@pytest.mark.full  # compiles for most of a minute
def test_second_derivatives_of_the_third_kind():
    columns = arguments(np.random.default_rng(24), 4, 24, 1, np.float64)
    check(elliprj, carlson("rj"), columns, np.float64, second=True, value=BARS["rj"])


@pytest.mark.parametrize("name", ["rc", "rj"])
def test_principal_values(name, dtype):
    function, count = FUNCTIONS[name]
    columns = arguments(np.random.default_rng(22), count, 24, 2, dtype)
    columns[-1] = -columns[-1]
    check(function, carlson(name), columns, dtype, second=False, value=BARS[name])


# Of RJ, which compiles longest, where it is the same code as for the others.
SOME = [pytest.param(n, marks=pytest.mark.full) if n == "rj" else n for n in FUNCTIONS]


@pytest.mark.parametrize("name", SOME)
def test_at_the_ends_of_the_floats(name):
    function, count = FUNCTIONS[name]
    rng = np.random.default_rng(23)
    columns = [10 ** rng.uniform(-300, 300, 30) for _ in range(count)]
    if name != "rd":
        columns[0] = np.where(rng.uniform(size=30) < 0.2, 0, columns[0])
    for at, got in zip(zip(*columns, strict=True), np.asarray(function(*columns)), strict=True):
        true = truth(carlson(name), [float(x) for x in at], 9000)
        if 1e-303 < abs(true.value) < 1e303:
            scale = abs(true.value) if at[0] == 0 else true.scale([arb(float(x)) for x in at])
            assert error(got, true.value, scale) <= BARS[name], at


def test_values_of_carlson():
    """His own of 1995, section 3, those that are real."""
    rows = [
        (elliprf, (1.0, 2.0, 0.0), 1.3110287771461),
        (elliprf, (0.5, 1.0, 0.0), 1.8540746773014),
        (elliprf, (2.0, 3.0, 4.0), 0.58408284167715),
        (elliprc, (0.0, 0.25), np.pi),
        (elliprc, (2.25, 2.0), np.log(2.0)),
        (elliprc, (0.25, -2.0), np.log(2.0) / 3),
        (elliprj, (0.0, 1.0, 2.0, 3.0), 0.77688623778582),
        (elliprj, (2.0, 3.0, 4.0, 5.0), 0.14297579667157),
        (elliprj, (2.0, 3.0, 4.0, -0.5), 0.24723819703052),
        (elliprj, (2.0, 3.0, 4.0, -5.0), -0.12711230042964),
        (elliprd, (0.0, 2.0, 1.0), 1.7972103521034),
        (elliprd, (2.0, 3.0, 4.0), 0.16510527294261),
        (elliprg, (0.0, 16.0, 16.0), np.pi),
        (elliprg, (2.0, 3.0, 4.0), 1.7255030280692),
        (elliprg, (0.0, 0.0796, 4.0), 1.0284758090288),
    ]
    for function, at, value in rows:
        np.testing.assert_allclose(function(*at), value, rtol=5e-14)


def test_edges():
    inf = jnp.inf
    assert elliprf(0.0, 1.0, 0.0) == inf
    assert elliprf(1.0, inf, 1.0) == 0
    assert elliprc(1.0, inf) == 0
    assert elliprc(0.0, -1.0) == 0
    assert jnp.isnan(elliprc(1.0, 0.0))
    assert elliprd(1.0, 1.0, 0.0) == inf
    assert elliprd(0.0, 0.0, 1.0) == inf
    assert elliprg(0.0, 0.0, 1.0) == 0.5
    assert elliprg(0.0, 0.0, 0.0) == 0
    assert jax.grad(lambda p: elliprg(0.0, 0 * p, 0.0625 * p))(1.0) == 0.0625
    assert elliprg(1.0, inf, 1.0) == inf
    assert elliprj(0.0, 0.0, 1.0, 1.0) == inf
    assert elliprj(0.0, 0.0, 1.0, -1.0) == -inf
    assert elliprj(1.0, 1.0, 1.0, inf) == 0
    assert jnp.isnan(elliprj(1.0, 1.0, 1.0, 0.0))


def test_the_largest_arguments(dtype):
    """Whose sum is no float, though RG and its slopes are."""
    most, one = jnp.finfo(dtype).max, jnp.ones((), dtype)
    few = 4 * float(jnp.finfo(dtype).eps)
    root = np.sqrt(float(most))
    value, slopes = jax.value_and_grad(elliprg, (0, 1, 2))(most, most, most)
    np.testing.assert_allclose(value / root, 1, rtol=few)
    np.testing.assert_allclose(np.array(slopes) * root, 1 / 6, rtol=few)
    np.testing.assert_allclose(elliprg(one, most, most) / root, np.pi / 4, rtol=few)


def test_far_from_each_other(dtype):
    """Where one derivative is beyond the floats, the others are what they are."""
    cases = [
        ((1e-200, 1e-200, 1e-10, 2.0), (1, 2, 3)),
        ((1e-150, 2e-150, 3e-150, 1e-100), (3,)),
        ((0.0, 1e-300, 1e-200, 1e-100), (3,)),
    ]
    if dtype == np.float32:
        cases = [((1e-18, 1e-18, 1e-18, 1e-12), (3,))]
    for at, of in cases:
        at = [float(np.asarray(x, dtype)) for x in at]
        got = jax.grad(elliprj, (0, 1, 2, 3))(*(jnp.asarray(x, dtype) for x in at))
        function = carlson("rj") if at[0] else lambda *x: carlson("rj")(arb(0), *x)
        true = truth(function, at if at[0] else at[1:], 5000)
        for i in of:
            slope = true.slopes[i if at[0] else i - 1]
            assert error(got[i], slope, abs(slope), dtype) <= 100, (at, i)


@pytest.mark.parametrize("name", SOME)
def test_bad_arguments_stay_in_their_lane(name):
    function, count = FUNCTIONS[name]
    columns = [jnp.array([1.0, -1.0, jnp.nan, 2.0])] + [jnp.array([1.0, 2.0, 3.0, 4.0])] * (
        count - 1
    )
    assert jnp.isnan(function(*columns)[1:3]).all()
    slopes = jax.vmap(jax.grad(function, tuple(range(count))))(*columns)
    for slope in slopes:
        assert jnp.isnan(slope[1:3]).all()
        assert jnp.isfinite(slope[jnp.array([0, 3])]).all()
    with pytest.raises(ValueError, match="real numbers"):
        function(*[1j] * count)


@pytest.mark.parametrize("name", [name for name in SOME if name != "rc"])
def test_derivatives_beside_an_argument_that_is_zero(name):
    """That in it is infinite (RG: finite), as about the largest float; the others are right."""
    function, count = FUNCTIONS[name]
    at = [0.0, 2.0, 3.0, 0.7][:count]
    of = tuple(range(1, count))
    for gradient in (
        jax.grad(function, tuple(range(count))),
        jax.jacfwd(function, tuple(range(count))),
    ):
        first, *others = gradient(*at)
        true = truth(lambda *rest: carlson(name)(arb(0), *rest), at[1:], 500)
        for i, got in enumerate(others):
            assert error(got, true.slopes[i], abs(true.slopes[i])) <= 20
        if name == "rg":
            np.testing.assert_allclose(first, 0.25 * elliprf(*at), rtol=1e-15)
        else:
            assert first < -1e300
    if name == "rj":  # slow to compile, and made of the others
        return
    hessian = jax.jacfwd(jax.grad(function, of), of)(*at)
    for i in range(count - 1):
        for j in range(count - 1):
            h = true.curvatures[i][j]
            assert error(hessian[i][j], h, abs(h)) <= 100, (i, j)


@pytest.mark.full
def test_third_derivatives():
    def along(t):
        return elliprd(0.7 * (1 + 0.1 * t), 1.1 + t, 2.0 - t)

    second = jax.grad(jax.grad(along))
    h = 1e-3
    by_differences = (second(0.3 + h) - second(0.3 - h)) / (2 * h)
    np.testing.assert_allclose(jax.grad(second)(0.3), by_differences, rtol=1e-5)
