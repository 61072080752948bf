"""Random scenes to be recorded and fitted, and starts beside them."""

import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, simulate

KINDS = ("libration", "rotation", "separatrix", "damped", "driven")
SAMPLES = 200
COLUMNS = ("epsilon", "beta", "tau", "v0", "theta0", "span")


def scenes(kind: str, count: int, seed: int) -> np.ndarray:
    """`count` rows of COLUMNS, NaN where the kind has no such term.

    ε log-uniform in 0.1 … 100 1/s²; 3 … 10 small-angle periods; of the undamped ones the energy is
    0.1 … 1.8 ε (libration), 2.2 … 12 ε (rotation), 2ε (1 ± 1e-6 … 3e-2) (separatrix), from any
    angle that it reaches within 2.5 rad; β is 0.003 … 0.5 √ε (damped) or 0.05 … 0.5 √ε (driven),
    |τ| < 0.8 ε, |v0| < 3 √ε.
    """
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    epsilon = 10 ** rng.uniform(-1, 2, count)
    root = np.sqrt(epsilon)
    span = rng.uniform(3, 10, count) * 2 * np.pi / root
    theta0, sign = rng.uniform(-2.5, 2.5, count), rng.choice([-1, 1], count)
    beta = tau = np.full(count, np.nan)
    if kind in ("damped", "driven"):
        low = -2.5 if kind == "damped" else -1.3
        beta = root * 10 ** rng.uniform(low, -0.3, count)
        tau = epsilon * rng.uniform(-0.8, 0.8, count) if kind == "driven" else tau
        v0 = root * rng.uniform(-3, 3, count)
    else:
        energy = {
            "libration": rng.uniform(0.1, 1.8, count),
            "rotation": rng.uniform(2.2, 12, count),
            "separatrix": 2 * (1 + rng.choice([-1, 1], count) * 10 ** rng.uniform(-6, -1.5, count)),
        }[kind]
        most = 0.9 * np.arccos(np.clip(1 - energy, -1, 1))
        theta0 = np.clip(theta0, -most, most)
        v0 = sign * root * np.sqrt(2 * (energy - 1 + np.cos(theta0)))
    return np.stack([epsilon, beta, tau, v0, theta0, span], 1)


def beside(rows: np.ndarray, seed: int) -> np.ndarray:
    """Every parameter 30 % too large or too small."""
    signs = np.random.default_rng([seed, 99]).choice([-1, 1], (len(rows), 5))
    return rows[:, :5] * (1 + 0.3 * signs)


def pendulum_of(kind: str, row) -> Pendulum:
    damped, driven = kind in ("damped", "driven"), kind == "driven"
    return Pendulum(row[0], row[1] if damped else None, row[2] if driven else None)


def recorded(kind: str, row, samples: int = SAMPLES):
    """Times and angles of one row."""
    ts = row[5] * jnp.linspace(0, 1, samples, dtype=row.dtype)
    return ts, simulate(pendulum_of(kind, row), ts, row[3], row[4], throw=False).theta


def noise_of(theta):
    """1 % of the angles' own spread, or of a radian where they turn over."""
    return 0.01 * jnp.minimum(jnp.std(theta), jnp.ones((), theta.dtype))
