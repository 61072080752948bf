"""F, E and Π of Legendre against Arb, in eps × scale: values, derivatives of both orders."""

import csv
from decimal import Decimal
from functools import partial

import elliptic_points as points
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.special
from conftest import float32_in_full
from elliptic_references import error, legendre, truth
from flint import arb

from pendax.special import (
    _cpu,
    arcsn,
    ellipeinc,
    ellipj,
    ellipkinc,
    ellipkm1,
    ellippi,
    ellippiinc,
    elliprj,
)


def check(function, reference, columns, dtype, second, value=10, first=50):
    """Every point's value, gradient (both modes) and, if `second`, Hessian."""
    columns = [np.asarray(c, dtype) for c in columns]
    of = tuple(range(len(columns)))
    got = np.asarray(function(*columns))
    reverse = jax.vmap(jax.grad(function, of))(*columns)
    forward = jax.vmap(jax.jacfwd(function, of))(*columns)
    hessian = jax.vmap(jax.jacfwd(jax.grad(function, of), of))(*columns) if second else None
    eps, largest = float(np.finfo(dtype).eps), float(np.finfo(dtype).max)
    for k, row in enumerate(zip(*columns, strict=True)):
        at = [float(x) for x in row]
        smallest = min(abs(x) for x in (*at, 1.0) if x != 0)
        true = truth(reference, at, 600 + int(-3 * np.log2(smallest)))
        x = [arb(t) for t in at]
        assert error(got[k], true.value, true.scale(x), dtype) <= value, at
        for i in of:
            if abs(true.slopes[i]) > 0.1 * largest:
                continue
            scale = true.scale_of_slope(x, i)
            assert error(reverse[i][k], true.slopes[i], scale, dtype) <= first, (at, i)
            apart = abs(float(forward[i][k]) - float(reverse[i][k]))
            assert apart <= first * eps * float(scale), (at, i)
            for j in of if second else ():
                h = true.curvatures[i][j]
                if abs(h) > 0.01 * largest or 0 in at:  # differences at 0 are no reference
                    continue
                scale2 = abs(h) + scale / max(abs(at[j]), 1)
                assert error(hessian[i][j][k], h, scale2, dtype) <= 1e-12 / 2.0**-52, (at, i, j)


def legendre_points(dtype, size, seed):
    rng = np.random.default_rng(seed)
    wide = dtype == np.float64
    phi = points.amplitudes(rng, size, wide)
    m = points.parameters(rng, size, wide)
    return [points.characteristics(rng, m).astype(dtype), phi.astype(dtype), m.astype(dtype)]


@pytest.mark.parametrize(("function", "name"), [(ellipkinc, "f"), (ellipeinc, "e")])
@float32_in_full
def test_first_and_second_kind(function, name, dtype):
    _, phi, m = legendre_points(dtype, 20, 11)
    check(function, legendre(name, "m"), [phi, m], dtype, second=True)


@pytest.mark.parametrize(("function", "name"), [(ellipkinc, "f"), (ellipeinc, "e")])
def test_close_to_one(function, name, dtype):
    wide = dtype == np.float64
    rng = np.random.default_rng(12)
    phi = points.amplitudes(rng, 8, wide)
    m1 = 10 ** rng.uniform(-300 if wide else -36, 0, phi.size)

    def of(phi, m1):
        return function(phi, m1=m1)

    check(of, legendre(name, "m1"), [phi, m1], dtype, second=False)


@float32_in_full
def test_third_kind(dtype):
    columns = legendre_points(dtype, 12, 13)
    check(ellippiinc, legendre("pi", "m"), columns, dtype, second=False)


def test_complete_third_kind(dtype):
    n, _, m = legendre_points(dtype, 16, 14)
    check(ellippi, legendre("pi_complete", "m"), [n, m], dtype, second=False)


@pytest.mark.full
def test_second_derivatives_of_the_third_kind():
    dtype = np.dtype("float64")
    n, phi, m = legendre_points(dtype, 12, 14)
    check(ellippi, legendre("pi_complete", "m"), [n, m], dtype, second=True)
    check(ellippiinc, legendre("pi", "m"), [n, phi, m], dtype, second=True)


@pytest.mark.full
def test_third_kind_close_to_one():
    rng = np.random.default_rng(15)
    m1 = 10 ** rng.uniform(-250, 0, 48)
    n = points.characteristics(rng, 1 - m1)
    n = np.where(n == 1, 0.5, n)

    def of(n, m1):
        return ellippi(n, m1=m1)

    check(of, legendre("pi_complete", "m1"), [n, m1], np.dtype("float64"), second=False)
    phi = points.amplitudes(rng, 12, True)

    def of_phi(n, phi, m1):
        return ellippiinc(n, phi, m1=m1)

    check(of_phi, legendre("pi", "m1"), [n, phi, m1], np.dtype("float64"), second=False)


def test_table_of_the_spanish_source(shared):
    """Its table 5.2.1, Legendre's and Jacobi's forms; its Π has the opposite sign of n."""
    rows = table(shared / "truth" / "seed000_elliptic_incomplete.csv")
    m1, phi = rows["m1"], rows["phi"]
    np.testing.assert_allclose(ellipkinc(phi, m1=m1), rows["F"], rtol=2e-15)
    np.testing.assert_allclose(ellipeinc(phi, m1=m1), rows["E"], rtol=2e-15)
    np.testing.assert_allclose(ellippiinc(0.3, phi, m1=m1), rows["Pi_dlmf_n_0p3"], rtol=2e-15)
    np.testing.assert_allclose(ellippiinc(-0.3, phi, m1=m1), rows["Pi_seed_n_0p3"], rtol=2e-15)
    inside = np.abs(phi) < points.QUARTER
    jacobis = arcsn(np.sin(phi[inside]), m1=m1[inside])
    np.testing.assert_allclose(jacobis, rows["F"][inside], rtol=2e-14)
    rows = table(shared / "truth" / "seed000_elliptic_complete.csv")
    m1, n = rows["m1"], rows["n"]
    np.testing.assert_allclose(ellipkm1(m1), rows["K"], rtol=2e-15)
    np.testing.assert_allclose(ellippi(n, m1=m1), rows["Pi_dlmf_1_minus_n_sin2"], rtol=2e-14)
    np.testing.assert_allclose(ellippi(-n, m1=m1), rows["Pi_seed_1_plus_n_sin2"], rtol=2e-14)


def table(path) -> dict[str, np.ndarray]:
    """Its columns, and m1 = 1 − k² of the k that are exact decimals."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    columns = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    return columns | {"m1": np.array([float(1 - Decimal(row["k"]) ** 2) for row in rows])}


def test_f_is_the_inverse_of_the_amplitude(dtype):
    rng = np.random.default_rng(16)
    phi, m = rng.uniform(-30, 30, (2, 300)).astype(dtype) / np.array([[1], [31]], dtype)
    *_, ph = ellipj(ellipkinc(phi, m), m)
    np.testing.assert_allclose(ph, phi, rtol=300 * float(np.finfo(dtype).eps))


def test_no_jumps():
    """SciPy's issue 19498: its E jumps where its two ways of computing it meet."""
    for phi in (np.arctan(0.1), 1.2, np.nextafter(points.QUARTER, 2)):
        for m in (0.7, -3.0, 1 - 1e-9):
            beside = [phi]
            for _ in range(20):
                beside.append(np.nextafter(beside[-1], 9))
            for function in (ellipeinc, ellipkinc):
                steps = np.diff(np.asarray(function(jnp.asarray(beside), m)))
                slope = float(jax.grad(function)(phi, m))
                expected = slope * np.diff(beside)
                room = 4 * np.finfo(float).eps * abs(float(function(phi, m)))
                assert (np.abs(steps - expected) <= room).all(), (phi, m, function)


def test_edges():
    assert jnp.isnan(ellipkinc(1.0, 2.0))
    assert jnp.isnan(jax.grad(ellipkinc, 1)(1.0, 2.0))
    # Beyond m = 1 as far as the integrand is real, where SciPy has NaN.
    np.testing.assert_allclose(ellipkinc(0.3, 4.0), arcsn(np.sin(0.3), 4.0), rtol=2e-15)
    assert jnp.isinf(ellippi(1.0, 0.5))
    assert ellippi(0.5, 1.0) == jnp.inf
    assert ellippi(2.0, 1.0) == -jnp.inf
    assert jnp.isnan(ellippi(0.5, 1.5))
    assert ellipkinc(-points.QUARTER, 1.0) == -jnp.inf
    assert ellippiinc(0.2, -points.QUARTER, 1.0) == -jnp.inf
    np.testing.assert_allclose(ellipkinc(1.2, 1.0), np.arctanh(np.sin(1.2)), rtol=1e-15)
    for function in (ellipkinc, ellipeinc, partial(ellippiinc, 0.3)):
        assert function(0.0, 0.7) == 0
        with pytest.raises(ValueError, match="one without the other"):
            function(0.3, 0.7, m1=0.3)
    # Where a value is infinite, there is no derivative to follow.
    assert jnp.isnan(jnp.stack(jax.grad(ellipkinc, (0, 1))(points.QUARTER, 1.0))).all()
    assert ellippiinc(1.0, 2.0, 0.5) == jnp.inf
    assert jnp.isnan(jnp.stack(jax.grad(ellippiinc, (0, 1, 2))(1.0, 2.0, 0.5))).all()
    assert ellippiinc(1.0, 2.0, 1.0) == jnp.inf
    assert ellippiinc(jnp.inf, 0.3, 0.5) == 0
    assert jnp.isnan(jax.grad(ellipkinc)(3.2, 1.5))
    for gradient in (jax.grad(ellipeinc, 1), jax.jacfwd(ellipeinc, 1)):
        assert gradient(2.0, 1.0) < -1e300
    bad = jax.vmap(jax.grad(ellipeinc, (0, 1)))(jnp.array([1.0, 1.0]), jnp.array([2.0, 0.5]))
    assert all(jnp.isnan(x[0]) and jnp.isfinite(x[1]) for x in bad)


def test_lanes_far_from_each_other():
    """One lane that needs many steps changes no other, whether they are mapped or not."""
    phi = jnp.array([0.3, np.pi / 2, 1.0, 5.0])
    m = jnp.array([0.3, 1 - 1e-16, -1e10, 0.5])
    one_by_one = [ellipkinc(p, q) for p, q in zip(phi, m, strict=True)]
    np.testing.assert_allclose(ellipkinc(phi, m), jnp.stack(one_by_one), rtol=1e-15)
    np.testing.assert_allclose(jax.vmap(ellipkinc)(phi, m), jnp.stack(one_by_one), rtol=1e-15)
    table = jax.vmap(jax.vmap(ellipeinc, (None, 0)), (0, None))(phi, m)
    np.testing.assert_allclose(table, ellipeinc(phi[:, None], m[None, :]), rtol=1e-15)


def test_large_arrays_go_in_blocks():
    rng = np.random.default_rng(17)
    phi, m = rng.uniform(-9, 9, 600_001), rng.uniform(-1, 1, 600_001)
    np.testing.assert_allclose(ellipkinc(phi, m), scipy.special.ellipkinc(phi, m), rtol=2e-14)
    np.testing.assert_allclose(ellipeinc(phi, m), scipy.special.ellipeinc(phi, m), rtol=2e-14)


def test_blocks_of_the_third_kind_are_the_whole():
    """One element short of two blocks, two, and past the last whole one."""
    rng = np.random.default_rng(18)
    for size in (2 * _cpu.DOZENS - 1, 2 * _cpu.DOZENS, 2 * _cpu.DOZENS + 77):
        arguments = rng.uniform(0.1, 9, (4, size))
        exact = scipy.special.elliprj(*arguments)
        np.testing.assert_allclose(elliprj(*arguments), exact, rtol=3e-15)
