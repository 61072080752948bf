"""Arguments of the Jacobi functions, by what is special about them."""

from typing import NamedTuple

import numpy as np
import references
from references import exact


class Case(NamedTuple):
    tag: str
    name: str  # of the parameter: "m" or "m1"
    u: np.ndarray
    parameter: np.ndarray

    def tuple(self):
        return self.name, self.u, self.parameter


def cases(dtype, size, seed=2) -> dict[str, Case]:
    """`size` random pairs for every tag, floats of the dtype as float64."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(dtype)
    wide = dtype == np.float64
    lowest = -300 if wide else -36

    def signed(x):
        return x * rng.choice([-1, 1], x.shape)

    def rounded(x):
        return np.asarray(x, dtype).astype(float)

    def quarters(name, parameter, count):
        periods = [references.quarter_period(**{name: p}) for p in parameter]
        return np.array([float(k * exact(n)) for k, n in zip(periods, count, strict=True)])

    m = rounded(rng.uniform(0, 1, size))
    m1 = rounded(signed(10 ** rng.uniform(lowest, 0, size)))
    beside = rng.integers(1, 10, size) * (1 + signed(10 ** rng.uniform(-15, -1, size)))
    beside = signed(beside)
    many = 10 ** rng.uniform(3, 6 if wide else 4, size)
    table = [
        ("mid", "m", rng.uniform(-20, 20, size), m),
        ("tiny u", "m", signed(10 ** rng.uniform(lowest, -8, size)), m),
        ("small u", "m", signed(10 ** rng.uniform(-8, -1, size)), rng.uniform(-1, 2, size)),
        ("negative", "m", rng.uniform(-20, 20, size), -(10 ** rng.uniform(-3, 10, size))),
        ("above one", "m", rng.uniform(-20, 20, size), 1 + 10 ** rng.uniform(-6, 10, size)),
        ("around the classes", "m", rng.uniform(-9, 9, size), rng.uniform(-1.1, 2.2, size)),
        ("at zero", "m", rng.uniform(-30, 30, size), np.zeros(size)),
        ("at one", "m", rng.uniform(-80, 80, size), np.ones(size)),
        ("near one", "m1", rng.uniform(-10, 10, size), m1),
        ("near one, three quarters", "m1", quarters("m1", m1, rng.uniform(-3, 3, size)), m1),
        ("near one, quarter periods", "m1", quarters("m1", m1, beside), m1),
        ("quarter periods", "m", quarters("m", m, beside), m),
        ("huge u", "m", quarters("m", m, np.floor(many)), m),
    ]
    return {row[0]: Case(*row[:2], *map(rounded, row[2:])) for row in table}


TAGS = list(cases("float64", 1))
