"""Motions to be drawn, in few shapes, so that few programs are compiled."""

import jax.numpy as jnp
import numpy as np

from .._pendulum import Pendulum
from .._simulate import simulate

TIMES = 2001
_LANES = 12


def swings(v0: np.ndarray | list[float], end: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """t, and θ and v of each v0 from the bottom at ε = 1, by the closed form."""
    ts = np.linspace(0, end, TIMES)
    run = simulate(Pendulum(), jnp.asarray(ts), jnp.asarray(_padded(v0)))
    return ts, np.asarray(run.theta)[: len(v0)], np.asarray(run.v)[: len(v0)]


def damped(
    v0: float, beta: np.ndarray | list[float] | float, tau: np.ndarray | list[float] | float,
    end: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """t, and θ and v of each β or τ, from the bottom at ε = 1."""
    ts = np.linspace(0, end, TIMES)
    beta, tau = np.broadcast_arrays(np.atleast_1d(beta), tau)
    pendulum = Pendulum(1.0, jnp.asarray(_padded(beta)), jnp.asarray(_padded(tau)))
    run = simulate(pendulum, jnp.asarray(ts), jnp.full(-(-beta.size // _LANES) * _LANES, v0))
    return ts, np.asarray(run.theta)[: beta.size], np.asarray(run.v)[: beta.size]


def _padded(x) -> np.ndarray:
    """As floats, the last repeated up to a multiple of `_LANES`."""
    x = np.asarray(x, float)
    return np.pad(x, (0, -x.size % _LANES), mode="edge")
