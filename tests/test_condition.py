"""κ against products of 30-digit fundamental matrices."""

import damped_references as references
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, condition


def test_against_products():
    ts = np.linspace(0.5, 12, 24)
    rows = [(1.0, 0.04, 0.1, 0.3, 2.1), (1.0, 0.5, -1.2, -2.0, 1.0)]
    epsilon, beta, tau, theta0, v0 = jnp.asarray(np.array(rows).T)
    got = condition(Pendulum(epsilon, beta, tau), ts, v0, theta0)
    for row, kappa in zip(rows, got, strict=True):
        slopes = np.array(references.trajectory(*row, ts, ("theta0", "v0")))[:, 2:]
        matrices = [np.eye(2), *slopes.reshape(-1, 2, 2).swapaxes(1, 2)]
        for i in range(1, len(ts) + 1):
            norms = [np.linalg.norm(matrices[i] @ np.linalg.inv(m), 2) for m in matrices[: i + 1]]
            np.testing.assert_allclose(kappa[i - 1], max(norms), rtol=1e-9)


def test_small_swings_and_the_separatrix(dtype):
    ts = jnp.linspace(0.1, 12.0, 60, dtype=dtype)
    four = jnp.asarray(4.0, dtype)
    swing = condition(Pendulum(four), ts, jnp.asarray(1e-3, dtype))
    np.testing.assert_allclose(swing, 1, rtol=1e-4)
    grazing = condition(Pendulum(four), ts, jnp.asarray(4 - 1e-5, dtype))
    assert grazing[-1] > 1e3
    assert condition(Pendulum(four), ts[3], jnp.asarray(1e-3, dtype)).shape == ()


def test_bad_input():
    with pytest.raises(ValueError, match="one axis"):
        condition(Pendulum(), jnp.ones((2, 2)), 1.0)
    with pytest.raises(ValueError, match="monotone"):
        condition(Pendulum(1.0, 0.1), jnp.array([2.0, 1.0]), 1.0)
    assert jnp.isnan(condition(Pendulum(), jnp.ones(1), jnp.nan)).all()
