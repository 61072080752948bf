"""The main computation: ω over initial velocities on both sides of the separatrix."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from ._critical import distance
from ._exact import frequency
from ._pendulum import Pendulum

# Values in one call of the compiled sweep: enough for both cores, small enough that a
# progress bar moves.
BLOCK = 65536


class Sweep(NamedTuple):
    """Columns of equal length: `t` = |v0 − 2√ε|, `below` where v0 < 2√ε.

    v0, t and omega in rad/s; on the separatrix itself t = omega = 0.
    """

    epsilon: float
    v0: np.ndarray
    t: np.ndarray
    omega: np.ndarray
    below: np.ndarray


def velocities(epsilon: float, count: int) -> np.ndarray:
    """About `count` floats from 0 to 4√ε, ascending and distinct.

    A third is even in v0, two thirds are even in ln t on either side of 2√ε down to
    the neighbouring floats, where they run out of distinct values.
    """
    separatrix = 2 * np.sqrt(epsilon)
    ulp = np.spacing(separatrix)
    near = np.geomspace(0.5 * ulp, separatrix, max(count // 3, 2))
    even = np.linspace(0, 2 * separatrix, max(count - 2 * near.size, 2))
    beside = separatrix + ulp * np.arange(-2, 3)
    return np.unique(np.concatenate([even, separatrix - near, separatrix + near, beside]))


@jax.jit
def _evaluate(epsilon, v0):
    def one(v0):
        pendulum = Pendulum(epsilon)
        return (*distance(v0, epsilon), frequency(pendulum, v0))

    return jax.vmap(one)(v0)


def sweep(
    epsilon: float, v0: np.ndarray, progress: Callable[[int], object] = lambda done: None
) -> Sweep:
    """ω and t for every `v0`, ≥ 0, block by block; `progress` hears of each block's size."""
    v0 = np.asarray(v0)
    parts = []
    for start in range(0, v0.size, BLOCK):
        block = v0[start : start + BLOCK]
        padded = np.pad(block, (0, min(BLOCK, v0.size) - block.size), mode="edge")
        epsilon_ = jnp.asarray(epsilon, v0.dtype)
        parts.append([np.asarray(x)[: block.size] for x in _evaluate(epsilon_, padded)])
        progress(block.size)
    t, below, omega = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Sweep(epsilon, v0, t, omega, below)


def write(swept: Sweep, path: Path) -> None:
    """The sweep as a table, all digits: CSV or NumPy's npz, by the ending of `path`."""
    names = ("v0_rad_per_s", "t_rad_per_s", "omega_rad_per_s")
    columns = (swept.v0, swept.t, swept.omega)
    if path.suffix == ".npz":
        np.savez(path, epsilon=swept.epsilon, **dict(zip(names, columns, strict=True)))
        return
    with path.open("w", encoding="utf-8") as file:
        file.write(",".join(names) + "\n")
        rows = zip(*(column.tolist() for column in columns), strict=True)
        file.writelines(f"{v0!r},{t!r},{omega!r}\n" for v0, t, omega in rows)
