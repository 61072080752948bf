"""Claims of Suzuki & Suzuki's chapter 7, damping; and how damped motions are computed."""

from functools import cache

import numpy as np

from .. import FixedPointKind, Pendulum, fixed_points, settle, simulate
from ._claim import Check, Claim
from ._computed import Numbers

_LANES, _TIMES = 40, 9


def followed(beta, tau, v0, ts, theta0: Numbers = 0.0, epsilon: Numbers = 1.0):
    """θ and θ̇ by Taylor's method, of at most 40 starts, at 9 times or fewer."""
    lanes = np.broadcast_arrays(*(np.asarray(x, float) for x in (beta, tau, v0, theta0, epsilon)))
    size, count = lanes[0].size, np.size(ts)
    beta, tau, v0, theta0, epsilon = (np.resize(x, _LANES) for x in lanes)
    ts = np.pad(np.asarray(ts, float), (0, _TIMES - count), "edge")
    run = simulate(Pendulum(epsilon, beta, tau), ts, v0, theta0)
    return np.asarray(run.theta)[:size, :count], np.asarray(run.v)[:size, :count]


def ended(beta, tau, v0):
    """Running, well and angle at the end of at most 400 starts."""
    lanes = np.broadcast_arrays(*(np.asarray(x, float) for x in (beta, tau, v0)))
    shape, size = lanes[0].shape, lanes[0].size
    beta, tau, v0 = (np.resize(x, 400) for x in lanes)
    end = settle(Pendulum(1.0, beta, tau), v0)
    return tuple(np.asarray(x)[:size].reshape(shape) for x in (end.running, end.well, end.theta))


@cache
def _eigenvalues():
    """Of the motion around θ = 0, π, 2π, 3π, β = 0.1, from small starts: rows of two."""
    step, angles = 1e-4, np.pi * np.arange(4)
    theta0 = angles[:, None] + step * np.array([1, -1, 0, 0])
    v0 = 0 * theta0 + step * np.array([0, 0, 1, -1])
    after = np.stack(followed(0.1, 0.0, v0.ravel(), [1.0], theta0.ravel()))
    after = after.reshape(2, 4, 2, 2)  # of θ or v, at which point, from which, from where
    matrices = np.moveaxis(np.diff(after, axis=-1)[..., 0] / (-2 * step), 0, 1)
    return np.sort_complex(np.log(np.linalg.eigvals(matrices) + 0j))


def _linearised() -> Check:
    found = _eigenvalues()
    claimed = np.array([np.roots([1, 0.1, 1 if n % 2 == 0 else -1]) for n in range(4)])
    claimed = np.sort_complex(claimed.astype(complex))
    claimed, found = (np.stack([np.real(x), np.imag(x)]) for x in (claimed, found))
    return Check(claimed, found, 1e-7)  # the starts' distance, squared


def _spirals() -> Check:
    found = fixed_points(Pendulum(1.0, np.array([0.01, 0.16, 1.0, 1.9]))).kind
    return Check(np.ones(4), np.asarray(found == FixedPointKind.spiral)[:, 0], 0)


def _saddles() -> Check:
    product = _eigenvalues()[1::2].prod(-1)  # one positive, one negative, both real
    return Check(-np.ones(2), np.where(np.abs(product.imag) < 1e-9, np.sign(product.real), 0), 0)


_BETA = np.array([0.010, 0.012, 0.014, 0.016, 0.018, 0.020, 0.04, 0.08, 0.12, 0.16])


def _turns() -> Check:
    _, found, _ = ended(_BETA, 0.0, 2.3)
    return Check([7, 6, 5, 4, 4, 3, 1, 1, 1, 0], found, 0, [7, 6, 5, 4, 4, 3, 2, 1, 1, 0])


def _at_rest() -> Check:
    theta = followed(_BETA, 0.0, 2.3, [5000.0])[0][:, 0] / (2 * np.pi)
    return Check(np.round(theta), theta, 1e-9)  # e^(−βt/2) is 1e-11 at most


def _mean() -> Check:
    theta, v = followed(_BETA[6:], 0.0, 2.3, [1500.0, 3000.0])
    return Check(0.0, np.stack([np.diff(theta)[:, 0] / 1500, v[:, 1]]) / 2.3, 1e-12)


def _undamped() -> Check:
    theta = followed(0.0, 0.0, [1.9, 2.3], [50.0, 100.0])[0]
    return Check([0, 1], theta[:, 1] - theta[:, 0] > 4 * np.pi, 0)


def _farther() -> Check:
    beta = np.arange(1, 11) / 50
    _, well, _ = ended(beta, 0.0, 2.3)
    return Check(np.ones(10), np.append(np.diff(well) <= 0, well[0] > well[-1]), 0)


def _terminal() -> Check:
    theta = followed(np.arange(11) / 50, 0.0, 2.3, [200.0, 300.0])[0]
    return Check(np.arange(11) == 0, theta[:, 1] - theta[:, 0] > 4 * np.pi, 0)


def _spiral_in() -> Check:
    beta = np.arange(1, 11) / 50
    theta, v = followed(beta, 0.0, 2.3, [3000.0])
    turns = theta[:, 0] / (2 * np.pi)
    return Check(np.stack([np.round(turns), 0 * turns]), np.stack([turns, v[:, 0] / 2.3]), 1e-9)


CLAIMS = (
    Claim("7.1", "Linearised at θ = nπ: λ² + βλ + ε = 0 for even n, λ² + βλ − ε = 0 for odd n",
          "λ, 1/s, roots / of small motions, n = 0 … 3, β = 0.1", _linearised, ("7.1",)),
    Claim("7.1", "Even n, β < 2√ε: stable spiral points", "1 for a spiral, β = 0.01, 0.16, 1, 1.9",
          _spirals, ("7.1",)),
    Claim("7.1", "Odd n: one root is real positive, the other real negative, a saddle",
          "sign of the product of real roots, n = 1, 3, β = 0.1", _saddles, ("7.1",)),
    Claim("7.2a", "v0 = 2.3: n = 7, 6, 5, 4, 4, 3, 1, 1, 1, 0 for β = 0.010, 0.012 … 0.16",
          "n, as claimed / where the motion ends", _turns, ("7.2a",), ("S2-21",)),
    Claim("7.2a", "θ(t) tends to 2nπ with an integer n", "θ/2π after 5000 s, the ten β", _at_rest,
          ("7.2a",)),
    Claim("7.2a", "For β = 0 the pendulum continues to rotate if v0 > 2",
          "1 for another two turns after 50 s, v0 = 1.9, 2.3", _undamped),
    Claim("7.2b", "v decays, and its average is zero, for any β but 0",
          "mean of v from 1500 s to 3000 s, and v there, over v0 = 2.3, β = 0.04 … 0.16", _mean,
          ("7.2b",)),
    Claim("7.2c", "Each trajectory for β ≠ 0 converges to a spiral point, θ = 2nπ and v = 0",
          "θ/2π and v/v0 after 3000 s, β = 0.02 … 0.20", _spiral_in, ("7.2c",)),
    Claim("7.2c", "The spiral points become far away from the origin with decreasing β",
          "1 where n does not grow with β, and 1 if that of 0.02 is above that of 0.20", _farther,
          ("7.2c",)),
    Claim("7.2c", "The terminal v is zero except for β = 0, which rotates",
          "1 for another two turns from 200 s to 300 s, β = 0, 0.02 … 0.20", _terminal,
          ("7.2c",)),
)  # fmt: skip
