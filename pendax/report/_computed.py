"""How claims are computed: functions of numbers, and solutions by a solver, compiled once for
arrays of one size."""

from collections.abc import Callable, Sequence
from functools import cache, partial

import jax
import numpy as np

from .. import Pendulum, potential, power_spectrum, simulate, time_to
from .. import amplitude as largest_angle
from .. import frequency as exact_frequency
from ..special import ellipj, ellipk, ellipkinc

Numbers = np.ndarray | float | Sequence[float]  # numpy's ArrayLike has no float at run time
SIZE, _LANES, TIMES = 1024, 12, 61


def elementwise(function: Callable) -> Callable:
    """`function` of numbers as one of arrays that broadcast."""
    compiled = jax.jit(jax.vmap(function))

    def whole(shape, size, *parts):
        joined = np.concatenate(parts)[:size]
        return joined.reshape(shape + joined.shape[1:])

    def over(*arrays):
        given = np.broadcast_arrays(*(np.asarray(x, float) for x in arrays))
        shape, size = given[0].shape, given[0].size
        rows = [np.resize(x, (-(-size // SIZE), SIZE)) for x in given]
        pieces = [compiled(*row) for row in zip(*rows, strict=True)]
        return jax.tree.map(partial(whole, shape, size), *pieces)

    return over


@elementwise
def _motion(v0, t, theta0, epsilon):
    run = simulate(Pendulum(epsilon), t, v0, theta0)
    return run.theta, run.v


@elementwise
def _frequency(v0, epsilon):
    return exact_frequency(Pendulum(epsilon), v0)


@elementwise
def _amplitude(v0, epsilon):
    return largest_angle(Pendulum(epsilon), v0)


def motion(v0: Numbers, t: Numbers, theta0: Numbers = 0.0, epsilon: Numbers = 1.0):
    """θ and θ̇ in closed form."""
    return _motion(v0, t, theta0, epsilon)


def frequency(v0: Numbers, epsilon: Numbers = 1.0):
    """ω by the AGM, without K."""
    return _frequency(v0, epsilon)


def amplitude(v0: Numbers, epsilon: Numbers = 1.0):
    """θ_max."""
    return _amplitude(v0, epsilon)


jacobi, complete = elementwise(ellipj), elementwise(ellipk)
incomplete = elementwise(ellipkinc)
arrival = elementwise(lambda theta, v0: time_to(Pendulum(), theta, v0))
height = elementwise(lambda theta, epsilon: potential(Pendulum(epsilon), theta))
spectrum = jax.jit(power_spectrum)


@cache
def _dopri8():
    import diffrax

    def one(v0, theta0, epsilon, ts):
        options = {"solver": diffrax.Dopri8(), "rtol": 1e-12, "atol": 1e-12, "throw": False}
        run = simulate(Pendulum(epsilon), ts, v0, theta0, **options)
        return run.theta, run.v

    return jax.jit(jax.vmap(one))


def solved(v0: Numbers, ts: Numbers, theta0: Numbers = 0.0, epsilon: Numbers = 1.0):
    """θ and θ̇ by Dopri8, rtol = atol = 1e-12; a row of at most 61 times for each start."""
    lanes = np.broadcast_arrays(*(np.asarray(x, float) for x in (v0, theta0, epsilon)))
    size, count = lanes[0].size, np.shape(ts)[-1]
    rows = -(-size // _LANES)
    ts = np.broadcast_to(ts, (size, count))
    ts = np.pad(ts, ((0, rows * _LANES - size), (0, TIMES - count)), "edge")
    lanes = [np.resize(x, (rows, _LANES)) for x in lanes]
    given = zip(*lanes, ts.reshape(rows, _LANES, TIMES), strict=True)
    theta, v = zip(*(_dopri8()(*row) for row in given), strict=True)
    return np.concatenate(theta)[:size, :count], np.concatenate(v)[:size, :count]


def solver_error(v0, end):
    """What the solver may be off by at `end`, rad, as a column: an error in v0 grows like t, and
    beside the separatrix like 1/|v0 − 2| as well; measured over 100 s and down to 1e-6."""
    return (2e-11 * end * (1 + 0.1 / np.abs(np.asarray(v0) - 2)))[:, None]


def solved_period(v0: Numbers, guess, turn: Numbers = 0.0, epsilon: Numbers = 1.0):
    """The first time after the start at which the solver's motion passes θ = `turn` upwards as it
    does at the start; NaN if that is not within 1¼ of `guess`, which is used for nothing else."""
    turn = np.broadcast_to(turn, np.shape(guess))[:, None]
    high = 1.25 * np.asarray(guess, float)[:, None]
    low, rows = 0 * high, np.arange(high.size)[:, None]
    for _ in range(3):  # each pass narrows it to a 60th
        ts = low + (high - low) * np.linspace(0, 1, TIMES)
        theta = solved(v0, ts, 0.0, epsilon)[0]
        passes = (theta[:, :-1] < turn) & (theta[:, 1:] >= turn)
        first, found = np.argmax(passes, -1)[:, None], np.any(passes, -1, keepdims=True)
        grain = 0.01 * (ts[:, 1:2] - ts[:, :1])
        low = np.where(found, ts[rows, first] - grain, np.nan)
        high = np.where(found, ts[rows, first + 1] + grain, np.nan)  # not at the crossing itself
    at = np.where(np.isnan(high), 0.0, high)
    theta, v = solved(v0, at, 0.0, epsilon)
    return np.where(np.isnan(high), np.nan, high - (theta - turn) / v)[:, 0]


def integral(integrand: Callable, upper) -> np.ndarray:
    """∫ from 0 to `upper`, elementwise, by Gauss's rule; to rounding where it is smooth."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    half = 0.5 * np.asarray(upper, float)
    return half * np.sum(integrand(half[..., None] * (nodes + 1)) * weights, -1)


def lines(v0, omega):
    """Amplitudes, rad, of the harmonics n = 1 … 30 of θ (of θ − ωt above v0 = 2): those of a
    discrete Fourier transform over one period, in which nothing leaks."""
    v0, omega = np.atleast_1d(v0), np.atleast_1d(omega)[:, None]
    share = np.arange(SIZE) / SIZE
    theta = motion(v0[:, None], 2 * np.pi / omega * share)[0]
    theta = theta - np.where(v0[:, None] > 2, 2 * np.pi * share, 0)
    power = np.stack([spectrum(share, row)[1] for row in theta])
    return 2 * np.sqrt(power[:, 1:31] / SIZE)
