"""Equilibria, their kinds and eigenvalues."""

import jax
import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest
from references import exact

from pendax import FixedPointKind, Pendulum, fixed_points


@pytest.mark.parametrize("beta", [None, 0.0, 1e-8, 0.16, 1.99, 2.0, 2.5, 1e4, 1e9])
@pytest.mark.parametrize("tau", [None, 0.5, -0.9, 1 - 1e-12, -1.0])
def test_angles_and_eigenvalues(beta, tau, dtype):
    epsilon = 1.0
    b, t = (None if x is None else jnp.asarray(x, dtype) for x in (beta, tau))
    got = fixed_points(Pendulum(jnp.asarray(epsilon, dtype), b, t))
    eps = float(jnp.finfo(dtype).eps)
    with mp.workdps(60):
        half = exact(b or 0) / 2
        kappa = mp.sqrt((1 - exact(t or 0)) * (1 + exact(t or 0)))
        angle = mp.asin(exact(t or 0))
        for i, (theta, stiffness) in enumerate(((angle, kappa), (mp.pi - angle, -kappa))):
            assert abs(float(got.angle[i]) - theta) <= 4 * eps * mp.pi
            root = mp.sqrt(half * half - stiffness)
            far, near = -half - root, -half + root
            # A double root is known to √eps alone.
            loose = 4 * eps + (2 * np.sqrt(eps) if abs(half * half - stiffness) < eps else 0)
            found = [complex(x) for x in got.eigenvalues[i]]
            for true in (far, near):
                true = complex(true)
                error = min(abs(x - true) for x in found)
                assert error <= loose * abs(true) + float(jnp.finfo(dtype).tiny)


def test_kinds():
    k = FixedPointKind
    for beta, tau, kind in (
        (None, None, k.centre),
        (0.0, 0.3, k.centre),
        (0.16, None, k.spiral),
        (2.0, None, k.node),
        (1.9, 0.6, k.node),
        (0.16, 1.0, k.saddle_node),
        (0.16, 1.1, k.none),
    ):
        found = fixed_points(Pendulum(1.0, beta, tau)).kind
        upper = k.saddle if kind not in (k.saddle_node, k.none) else kind
        assert (found == kind)[0]
        assert (found == upper)[1]


def test_lanes_and_derivatives():
    pendulum = Pendulum(1.0, jnp.array([[0.1], [3.0]]), jnp.array([0.0, 0.5, 2.0]))
    got = fixed_points(pendulum)
    assert got.angle.shape == (2, 3, 2)
    assert got.eigenvalues.shape == (2, 3, 2, 2)
    assert (got.kind == FixedPointKind.none)[:, 2].all()
    assert jnp.isnan(got.angle[:, 2]).all()
    assert jnp.isfinite(got.angle[:, :2]).all()
    slope = jax.jacfwd(lambda tau: fixed_points(Pendulum(1.0, 0.1, tau)).angle)(0.5)
    np.testing.assert_allclose(slope, [1 / np.sqrt(0.75), -1 / np.sqrt(0.75)], rtol=1e-14)
    lane = jax.vmap(jax.grad(lambda tau: fixed_points(Pendulum(1.0, 0.1, tau)).angle[0]))
    assert jnp.isnan(lane(jnp.array([0.1, 2.0]))).tolist() == [False, True]
    by_beta = jax.grad(lambda b: fixed_points(Pendulum(1.0, b)).eigenvalues[0, 1].real)(1e4)
    np.testing.assert_allclose(by_beta, 1e-8, rtol=1e-7)


def test_a_torque_of_time_is_refused():
    with pytest.raises(ValueError, match="constant torque"):
        fixed_points(Pendulum(1.0, 0.1, lambda t: t))
