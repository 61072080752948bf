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

from .peers import third_kind
from .timing import Row, side_by_side

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
        true = truth(REFERENCES[name], at, bits)
        if 1e-300 < abs(true.value) < 1e300:
            found.append(error(value, true.value, true.scale([arb(float(x)) for x in at])))
    return found


def accuracy(points: int, seed: int) -> Iterator[tuple]:
    """(function, region, errors, SciPy's or None)."""
    rng = np.random.default_rng(seed)
    phi = amplitudes(rng, points // 4, True)
    m = parameters(rng, points // 4, True)
    n = characteristics(rng, m)
    for name, columns in (
        ("ellipkinc", [phi, m]),
        ("ellipeinc", [phi, m]),
        ("ellippi", [n, m]),
        ("ellippiinc", [n, phi, m]),
    ):
        yield (*both(name, columns, "any"),)
    for exponent in (1, 300):
        for name, count in (("rf", 3), ("rc", 2), ("rd", 3), ("rg", 3), ("rj", 4)):
            columns = [10 ** rng.uniform(-exponent, exponent, points // 2) for _ in range(count)]
            yield (*both(f"ellip{name}", columns, f"1e±{exponent}"),)
            if name in ("rc", "rj") and exponent == 1:
                columns[-1] = -columns[-1]
                yield (*both(f"ellip{name}", columns, "principal value"),)


def both(name: str, columns: list[np.ndarray], region: str) -> tuple:
    ours = errors(name, columns, np.asarray(getattr(special, name)(*columns)))
    peer = getattr(scipy.special, name, None)
    return name, region, ours, None if peer is None else errors(name, columns, peer(*columns))


def speed(size: int, rounds: int, seed: int) -> list[Row]:
    """|φ| < 10, and n, m and Carlson's arguments between 0 and 1."""
    rng = np.random.default_rng(seed)
    phi = rng.uniform(-10, 10, size)
    unit = [rng.uniform(0, 1, size) for _ in range(4)]
    rows = []
    for name, columns in (
        ("ellipkinc", [phi, unit[0]]),
        ("ellipeinc", [phi, unit[0]]),
        ("elliprf", unit[:3]),
        ("elliprd", unit[:3]),
        ("elliprj", unit),
        ("ellippi", unit[:2]),
        ("ellippiinc", [unit[0], phi, unit[1]]),
    ):
        rows += timed(name, columns, rounds)
    return rows


def timed(name: str, columns: list[np.ndarray], rounds: int) -> Iterator[Row]:
    function, on_device = getattr(special, name), [jnp.asarray(x) for x in columns]
    calls = {
        "pendax": partial(jax.jit(function), *on_device),
        "pendax float32": partial(jax.jit(function), *(x.astype(jnp.float32) for x in on_device)),
        "pendax, value and gradient": partial(jax.jit(value_and_gradient(function)), *on_device),
    }
    if (peer := getattr(scipy.special, name, None)) is not None:
        calls["SciPy"] = partial(peer, *columns)
    spent = side_by_side(calls, rounds)
    picked = slice(None, None, max(1, columns[0].size // SAMPLE))
    few = [x[picked] for x in columns]
    for library, call in calls.items():
        looked_at = library in ("pendax", "SciPy")
        largest = max(errors(name, few, np.asarray(call())[picked])) if looked_at else None
        yield Row(name, library, spent[library] / columns[0].size, largest)
    if "ellippi" in name and (boost := third_kind(columns)) is not None:
        largest = max(errors(name, few, boost[1][0][picked]))
        yield Row(name, "Boost, one core", boost[0], largest)


def value_and_gradient(function: Callable) -> Callable:
    def call(*arguments):
        value, pullback = jax.vjp(function, *arguments)
        return value, pullback(jnp.ones_like(value))

    return call


def ratios(rows: list[Row]) -> list[tuple[str, float, float]]:
    """(what, how many times as fast, bar)."""
    time = {(row.work, row.library): row.seconds for row in rows}
    compared = []
    for name in dict.fromkeys(row.work for row in rows):
        ours = time[name, "pendax"]
        for peer, bar in (("SciPy", 5), ("Boost, one core", 1)):
            if (name, peer) in time:
                compared.append((f"{name} against {peer}", time[name, peer] / ours, bar))
        both_at_once = time[name, "pendax, value and gradient"]
        compared.append((f"{name}, value against value and gradient", ours / both_at_once, 1 / 4))
    return compared
