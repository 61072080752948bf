"""Initial states and times of the undamped pendulum, by what is special about them."""

import numpy as np


def starts(dtype, size, seed=3) -> dict[str, np.ndarray]:
    """Tag -> `size` rows (ε, t, v0, θ0), floats of the dtype as float64."""
    rng = np.random.default_rng(seed)
    dtype = np.dtype(dtype)
    wide = dtype == np.float64
    last = -15 if wide else -6
    one, none = np.ones(size), np.zeros(size)

    def signed(x):
        return x * rng.choice([-1, 1], size)

    def log(low, high):
        return 10 ** rng.uniform(low, high, size)

    epsilon = log(-12, 12).astype(dtype).astype(float)
    root = np.sqrt(epsilon)
    time, far = rng.uniform(-50, 50, size) / root, rng.uniform(-4, 4, size) * root

    def separatrix(epsilon):
        """2√ε (1 ∓ …), with itself and its neighbours among them."""
        v0 = (2 * np.sqrt(epsilon)).astype(dtype)
        moved = v0 * (1 - signed(log(last, -1)))
        moved[1:3] = np.nextafter(v0[1:3], np.array([0, 1e30], dtype))
        moved[0] = v0[0]
        return signed(moved)

    at = rng.uniform(-3.1, 3.1, size)
    top = np.array([np.pi, -np.pi, 3 * np.pi], dtype)
    top = np.concatenate([top, np.nextafter(top, dtype.type(0)), np.nextafter(top, top * 2)])
    tiny = log(-300 if wide else -36, -3)
    turns = log(2, 6 if wide else 3)
    rows = {
        "separatrix": (one, rng.uniform(-30, 30, size), separatrix(one), none),
        "separatrix, long": (one, signed(log(1, 3 if wide else 2)), separatrix(one), none),
        "separatrix, any ε": (epsilon, time, separatrix(epsilon), none),
        "separatrix, from anywhere": (
            one,
            rng.uniform(-40, 40, size),
            2 * np.cos(at / 2) * (1 + signed(log(last, -2))),
            at,
        ),
        "anywhere": (epsilon, time, far, rng.uniform(-np.pi, np.pi, size)),
        "other wells": (epsilon, time, far, rng.uniform(-1000, 1000, size)),
        "any speed": (one, time * root, signed(log(-300 if wide else -36, 8)), at),
        "from the top": (
            epsilon,
            time,
            signed(log(-20, 1)) * root * rng.choice([0, 1], size),
            rng.choice(top, size),
        ),
        "near the top": (one, time * root, none, np.pi - signed(log(last, 0))),
        "tiny": (epsilon, time, signed(tiny) * root, tiny * rng.uniform(-1, 1, size)),
        "short": (epsilon, signed(tiny) / root, far, at),
        "long": (one, signed(2 * np.pi * turns), far / root, at * rng.choice([0, 1], size)),
    }
    return {tag: np.stack(row, 1).astype(dtype).astype(float) for tag, row in rows.items()}


TAGS = list(starts("float64", 9))
