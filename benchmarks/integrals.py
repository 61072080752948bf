"""The incomplete integrals and Carlson's forms: errors by region, and error against run time."""

from collections.abc import Callable, Iterator
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special
from elliptic_points import amplitudes, characteristics, parameters
from elliptic_references import carlson, error, legendre, truth
from flint import arb

from pendax import special

from . import results
from .compared import Point, an_element
from .peers import compiled
from .timing import side_by_side

SAMPLE = 200  # elements whose error is looked at
REFERENCES = {
    "ellipkinc": legendre("f", "m"),
    "ellipeinc": legendre("e", "m"),
    "ellippi": legendre("pi_complete", "m"),
    "ellippiinc": legendre("pi", "m"),
    **{f"ellip{name}": carlson(name) for name in ("rf", "rc", "rd", "rg", "rj")},
}


def errors(name: str, columns: list[np.ndarray], got: np.ndarray) -> list[float]:
    """Of a value, in eps of |f| + Σ |x ∂f/∂x|; without the points whose value is no float."""
    found = []
    for value, *at in zip(got, *columns, strict=True):
        smallest = min(abs(x) for x in (*at, 1.0) if x != 0)
        bits = 600 + int(-3 * np.log2(smallest)) + int(3 * np.log2(max(map(abs, at)) + 1))
        true = truth(REFERENCES[name], at, bits, order=1)
        if 1e-300 < abs(true.value) < 1e300:
            found.append(error(value, true.value, true.scale([arb(float(x)) for x in at])))
    return found


def accuracy(points: int, seed: int, quick: bool) -> Iterator[tuple]:
    """(function, region, errors, SciPy's or None); quick: without those that take longer to
    compile."""
    rng = np.random.default_rng(seed)
    phi = amplitudes(rng, points // 4, True)
    m = parameters(rng, points // 4, True)
    n = characteristics(rng, m)
    for name, columns in (
        ("ellipkinc", [phi, m]),
        ("ellipeinc", [phi, m]),
        ("ellippi", [n, m]),
        ("ellippiinc", [n, phi, m]),
    )[: 2 if quick else None]:
        yield (*both(name, columns, "any"),)
    for exponent in (1, 300):
        for name, count in (("rf", 3), ("rc", 2), ("rd", 3), ("rg", 3), ("rj", 4))[
            : 2 if quick else None
        ]:
            columns = [10 ** rng.uniform(-exponent, exponent, points // 2) for _ in range(count)]
            yield (*both(f"ellip{name}", columns, f"1e±{exponent}"),)
            if name in ("rc", "rj") and exponent == 1:
                columns[-1] = -columns[-1]
                yield (*both(f"ellip{name}", columns, "principal value"),)


def both(name: str, columns: list[np.ndarray], region: str) -> tuple:
    ours = errors(name, columns, np.asarray(getattr(special, name)(*columns)))
    peer = getattr(scipy.special, name, None)
    return name, region, ours, None if peer is None else errors(name, columns, peer(*columns))


def speed(size: int, rounds: int, seed: int, quick: bool) -> list[Point]:
    """|φ| < 10, and n, m and Carlson's arguments between 0 and 1."""
    rng = np.random.default_rng(seed)
    phi = rng.uniform(-10, 10, size)
    unit = [rng.uniform(0, 1, size) for _ in range(4)]
    points = []
    for name, columns in (
        ("ellipkinc", [phi, unit[0]]),
        ("ellipeinc", [phi, unit[0]]),
        ("elliprf", unit[:3]),
        ("elliprd", unit[:3]),
        ("elliprj", unit),
        ("ellippi", unit[:2]),
        ("ellippiinc", [unit[0], phi, unit[1]]),
    ):
        if quick and name not in ("ellipkinc", "elliprf"):  # others take longer to compile
            continue
        points += timed(name, columns, rounds, quick)
    return points


def timed(name: str, columns: list[np.ndarray], rounds: int, quick: bool) -> Iterator[Point]:
    function, on_device = getattr(special, name), [jnp.asarray(x) for x in columns]
    both_at_once = f"{name}, value and gradient"
    calls = {
        "pendax": partial(jax.jit(function), *on_device),
        "pendax float32": partial(jax.jit(function), *(x.astype(jnp.float32) for x in on_device)),
        both_at_once: partial(jax.jit(value_and_gradient(function)), *on_device),
    }
    if (peer := getattr(scipy.special, name, None)) is not None:
        calls["SciPy"] = partial(peer, *columns)
    calls |= compiled(name, columns)
    timings = side_by_side(calls, rounds)
    picked = slice(None, None, max(1, columns[0].size // (40 if quick else SAMPLE)))
    few = [x[picked] for x in columns]
    for library, call in calls.items():
        timing, error = an_element(timings[library], columns[0].size), None
        if library == both_at_once:
            yield Point(both_at_once, "pendax", timing, None)
            continue
        if library != "pendax float32":
            error = float(np.max(errors(name, few, np.asarray(call())[picked])))
        yield Point(name, library, timing, error)


def value_and_gradient(function: Callable) -> Callable:
    def call(*arguments):
        value, pullback = jax.vjp(function, *arguments)
        return value, pullback(jnp.ones_like(value))

    return call


def ratios(points: list[Point]) -> list[results.Row]:
    """Times as fast, at least."""
    timing = {(point.work, point.method): point.timing for point in points}
    bars = []
    for name in dict.fromkeys(work for work, _ in timing if "gradient" not in work):
        ours = timing[name, "pendax"]
        for peer, limit in (("SciPy", 5), ("Boost", 1)):
            if (name, peer) in timing:
                ratio = timing[name, peer].over(ours)
                bars.append(results.bar(f"{name} against {peer}", ratio, at_least=limit))
        ratio = ours.over(timing[f"{name}, value and gradient", "pendax"])
        bars.append(results.bar(f"{name}, value against value and gradient", ratio, at_least=1 / 4))
    return bars
