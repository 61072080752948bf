"""Arguments of the elliptic integrals, by what is special about them."""

import numpy as np

QUARTER = np.pi / 2


def amplitudes(rng, size, wide) -> np.ndarray:
    """Any, many turns, tiny, and at and beside quarter turns."""
    beside = 10.0 ** rng.uniform(-15, -1, size) * rng.choice([-1, 0, 1], size)
    return np.concatenate(
        [
            rng.uniform(-10, 10, size),
            rng.choice([-1, 1], size) * 10 ** rng.uniform(1, 6 if wide else 4, size),
            10 ** rng.uniform(-100 if wide else -30, -1, size),
            rng.integers(-9, 10, size) * QUARTER * (1 + beside),
        ]
    )


def parameters(rng, size, wide) -> np.ndarray:
    """m from −1e10 to 1, and the special ones with their neighbours."""
    special = [
        0.0,
        0.5,
        np.nextafter(0.5, 1),
        1 - 2**-53 if wide else 1 - 2**-24,
        1e-30,
        -1e-17,
        -1,
    ]
    return rng.permutation(
        np.concatenate(
            [
                rng.uniform(0, 1, 2 * size),
                -(10 ** rng.uniform(-3, 10, size)),
                rng.choice(special, size),
            ]
        )
    )


def characteristics(rng, m) -> np.ndarray:
    """n from −1e10 to 1e10, close to its pole at 1, n = m, n = 0, n = −1 and beside."""
    size = m.size
    choice = rng.integers(0, 6, size)
    kinds = [
        rng.uniform(0, 1, size),
        -(10 ** rng.uniform(-6, 10, size)),
        1 - 10 ** rng.uniform(-6, -1, size),
        1 + 10 ** rng.uniform(-5, 10, size),
        rng.choice([0.0, -1.0, 1e-30, -1e-17, np.nextafter(-1.0, -2)], size),
        m,
    ]
    return np.choose(choice, kinds)
