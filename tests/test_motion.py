"""The motion and its derivatives against Arb, from every kind of start."""

from functools import lru_cache

import jax
import jax.numpy as jnp
import numpy as np
import pendulum_references as references
import pytest
from flint import arb
from pendulum_references import ARGUMENTS, magnitude, units
from starts import TAGS, starts

from pendax import Pendulum, simulate
from pendax.special import _cpu

SIZE = 12


def state(x):
    run = simulate(Pendulum(x[0]), x[1], x[2], x[3])
    return jnp.stack([run.theta, run.v])


def twice_forward(f):
    return jax.jacfwd(jax.jacfwd(f))


@lru_cache
def compiled(mode=None):
    """Of many rows at once; compiled once for all tags."""
    return jax.jit(jax.vmap(mode(state) if mode else state))


@lru_cache
def references_of(tag, dtype, order):
    rows = starts(dtype, SIZE)[tag]
    return rows, [references.derivatives(row, order) for row in rows]


@pytest.mark.parametrize("tag", TAGS)
def test_values(tag, dtype):
    """16 eps × scale; on the separatrix at ε = 1 from the bottom that of |v0| − 2, not v0."""
    rows, true = references_of(tag, dtype.name, 1)
    got = np.asarray(compiled()(jnp.asarray(rows, dtype)), float)
    for row, values, d in zip(rows, got, true, strict=True):
        for f in range(2):
            scale = magnitude(row, d, f)
            if tag in ("separatrix", "separatrix, long"):
                slope = (abs(row[2]) - 2) * float(d[2,][f])
                scale = abs(float(d[()][f])) + abs(row[1] * float(d[1,][f])) + abs(slope)
            error = abs(float(arb(values[f]) - d[()][f]))
            assert error <= 16 * np.finfo(dtype).eps * scale + np.finfo(dtype).tiny, (row, f)


@pytest.mark.parametrize("tag", TAGS)
def test_first_derivatives(tag, dtype):
    """1e-11 × scale, forward and reverse within 1e-13 of each other (float32: 2e-4, 2e-6)."""
    rows, true = references_of(tag, dtype.name, 2)
    x = jnp.asarray(rows, dtype)
    forward, reverse = (np.asarray(compiled(mode)(x), float) for mode in (jax.jacfwd, jax.jacrev))
    loose = np.finfo(dtype).eps / np.finfo("float64").eps
    loose = 1 if loose == 1 else loose / 27  # 1e-11 is 45,000 eps of float64, 2e-4 1,700
    for k, (row, d) in enumerate(zip(rows, true, strict=True)):
        for f in range(2):
            for i in ARGUMENTS:
                scale = magnitude(row, d, f, (i,)) + magnitude(row, d, f) / units(row)[i]
                got = forward[k, f, i]
                bar = 1e-11 * loose * scale + float(np.finfo(dtype).tiny)
                assert abs(float(arb(got) - d[i,][f])) <= bar, (row, f, i)
                assert abs(got - reverse[k, f, i]) <= bar / 100, (row, f, i)


@pytest.mark.parametrize("tag", TAGS)
def test_second_derivatives(tag):
    """1e-8 × scale, that of a derivative h being |h| + Σ |x ∂h/∂x| + scale(θ)/|x y|."""
    rows, true = references_of(tag, "float64", 2)
    modes = (twice_forward, jax.hessian) if tag == "anywhere" else (jax.hessian,)
    both = [np.asarray(compiled(mode)(jnp.asarray(rows))) for mode in modes]
    for k, (row, d) in enumerate(zip(rows, true, strict=True)):
        # In t alone the equation of motion says it all.
        moved = [references.derivatives(moved_by(row, i), 2) for i in (0, 2, 3)]
        for i in ARGUMENTS:
            for j in range(i + 1):
                for f in range(2):
                    h = d[j, i][f]
                    change = sum(abs(float(x[j, i][f] - h)) for x in moved) * 2**30
                    scale = abs(float(h)) + change
                    scale += magnitude(row, d, f) / (units(row)[i] * units(row)[j])
                    for got in both:
                        for hessian in (got[k, f, i, j], got[k, f, j, i]):
                            error = abs(float(arb(hessian) - h))
                            assert error <= 1e-8 * scale + 1e-290, (row, f, i, j)


def moved_by(row, i):
    return [x * (1 + 2.0**-30) if i == j else x for j, x in enumerate(row)]


@pytest.mark.parametrize("epsilon", [1.0, pytest.param(4.0, marks=pytest.mark.full), 9.81])
def test_nowhere_nan(epsilon, dtype):
    """Equilibria, the separatrix and times beyond every exponential included."""
    x = [
        (epsilon, t, v0 * np.sqrt(epsilon), theta0)
        for t in (0.0, 1e-30, 1.0, 50.0, 300.0, 800.0, 1e7)
        for v0 in (0.0, 1.0, 2.0, 3.0)
        for theta0 in (0.0, np.pi, -1.0)
    ]
    x = jnp.asarray(x, dtype)
    for mode in (None, jax.jacfwd, jax.jacrev, jax.hessian):
        assert jnp.isfinite(compiled(mode)(x)).all(), mode


def test_gradients_in_blocks_are_the_whole(dtype):
    """Of so many pendulums that the CPU works through blocks of them, the last overlapping."""
    rng = np.random.default_rng(5)
    size = 2 * _cpu.DOZENS + 77
    rows = rng.uniform((0.5, 0.0, 0.1, -1.0), (2.0, 20.0, 1.9, 1.0), (size, 4)).astype(dtype)
    some = np.r_[0:50, _cpu.DOZENS - 50 : _cpu.DOZENS + 50, size - 100 : size]

    few, all_ = (np.asarray(compiled(jax.jacrev)(jnp.asarray(x))) for x in (rows[some], rows))
    off = np.abs(all_[some] - few) / (1 + np.abs(few))
    assert off.max() < 1e4 * np.finfo(dtype).eps
