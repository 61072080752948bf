"""Error against run time of the elliptic functions, and the bars they are held to."""

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special

from pendax import special

from . import cores, integrals, results, special_regions
from .accuracy import EPS, complete_errors, jacobi_error
from .compared import Point, an_element, losses, seconds, spent
from .peers import compiled, library
from .timing import Timing, compile_time, side_by_side

SAMPLE = 2000  # elements whose error is looked at
CEPHES = "Cephes: two polynomials and a logarithm; ours: a ladder of roots and divisions besides"
WHY = {
    f"{work}, SciPy": CEPHES for work in ("ellipk", "ellipk, random", "ellipk, near the separatrix")
}


def measure(seed: int, quick: bool) -> results.Tables:
    size, rounds = (2**14, 3) if quick else (2**20, 5)
    rng = np.random.default_rng(seed)
    u, m = rng.uniform(-20, 20, size), rng.uniform(0, 1, size)
    points = [
        *jacobi(u, m, rounds),
        *shared_parameter(u, rounds),
        *complete(m, rounds),
        *gradients(u, m, rounds),
    ]
    more = integrals.speed(size // 4, rounds, seed, quick)
    regions = [] if quick else special_regions.regions(seed)
    if regions:
        special_regions.draw(regions)
    small, of_small = small_arrays(quick)
    compiling, of_compiling = compile_times(u, m, quick)  # forgets all programs: the last
    return {
        f"{size:,} elements of K and sn, cn, dn, {size // 4:,} of the others: u in ±20, φ in ±10, "
        "all others in 0 … 1": [
            {
                "work": point.work,
                "library": point.method,
                **spent(point.timing, "ns"),
                "error": point.error,
            }
            for point in points + more
        ],
        **special_regions.tables(regions),
        "small arrays": small,
        "compiling": compiling,
        "losses": losses([*points, *more, *regions], WHY),
        "bars": [
            *ratios(points),
            *integrals.ratios(more),
            *of_small,
            *of_compiling,
            *special_regions.bars(regions),
        ],
    }


def worst(u, m, values) -> float:
    """The largest error of sn, cn, dn on a sample; NaN if one is."""
    picked = slice(None, None, max(1, u.size // SAMPLE))
    columns = np.stack([np.asarray(x, float)[picked] for x in values[:3]], 1)
    rows = zip(u[picked], m[picked], columns, strict=True)
    return float(np.max([jacobi_error("m", *row)[0] for row in rows]))


def jacobi(u, m, rounds) -> list[Point]:
    on_device = jnp.asarray(u), jnp.asarray(m)
    narrow = tuple(x.astype(jnp.float32) for x in on_device)
    ours, sines = jax.jit(special.ellipj), jax.jit(lambda x: (jnp.sin(x), jnp.cos(x)))
    calls = {
        "pendax": partial(ours, *on_device),
        "pendax float32": partial(ours, *narrow),
        **wide(special.ellipj, on_device),
        "SciPy": partial(scipy.special.ellipj, u, m),
        "jnp.sin, jnp.cos": partial(sines, on_device[0]),
        **compiled("ellipj", [u, m]),
    }
    if (elliptic := library("elliptic")) is not None:
        calls["elliptic-functions"] = partial(jax.jit(elliptic.ellipj), *on_device)
    timings = side_by_side(calls, rounds)
    points = []
    for name, call in calls.items():
        error = None
        if name == "pendax float32":
            exact = (np.asarray(x, float) for x in narrow)
            error = worst(*exact, call()) * EPS / float(np.finfo(np.float32).eps)
        elif "jnp" not in name:
            error = worst(u, m, call())
        points.append(Point("ellipj", name, an_element(timings[name], u.size), error))
    if (mpmath := library("mpmath")) is not None:
        few = [(x, y) for x, y in zip(u[:50].tolist(), m[:50].tolist(), strict=True)]

        def by_mpmath():
            return [[float(mpmath.ellipfun(f, x, m=y)) for f in ("sn", "cn", "dn")] for x, y in few]

        timing = an_element(side_by_side({"": by_mpmath}, 3)[""], len(few))
        error = worst(u[:50], m[:50], np.array(by_mpmath()).T)
        points.append(Point("ellipj", "mpmath", timing, error))
    return points


def wide(function, arguments) -> dict[str, Callable]:
    """The call with vectors of 512 bits, where there are any."""
    if not (options := cores.widest()):
        return {}
    program = jax.jit(function, compiler_options=options)
    return {f"pendax, {results.WIDE}": partial(program, *arguments)}


def shared_parameter(u, rounds) -> list[Point]:
    m = 0.7
    calls = {
        "pendax": partial(jax.jit(special.ellipj), jnp.asarray(u), m),
        "SciPy": partial(scipy.special.ellipj, u, m),
    }
    timings = side_by_side(calls, rounds)
    every = np.full(u.size, m)
    return [
        Point("ellipj, one m", name, an_element(timings[name], u.size), worst(u, every, call()))
        for name, call in calls.items()
    ]


def complete(m, rounds) -> list[Point]:
    on_device = jnp.asarray(m)
    calls = {
        "pendax": partial(jax.jit(special.ellipk), on_device),
        **wide(special.ellipk, (on_device,)),
        "SciPy": partial(scipy.special.ellipk, m),
        **compiled("ellipk", [m]),
    }
    if (jaxellip := library("jaxellip")) is not None:
        calls["jaxellip"] = partial(jax.jit(jaxellip.ellipk), on_device)
    timings = side_by_side(calls, rounds)
    picked = slice(None, None, max(1, m.size // 200))
    points = []
    for name, call in calls.items():
        error = float(np.max(complete_errors("ellipk", m[picked], np.asarray(call())[picked])))
        points.append(Point("ellipk", name, an_element(timings[name], m.size), error))
    return points


def value_and_gradient(u, m):
    """sn, cn, dn, ph and the gradient of their sum."""
    values, pullback = jax.vjp(special.ellipj, u, m)
    return values, pullback(jax.tree.map(jnp.ones_like, values))


def gradients(u, m, rounds) -> list[Point]:
    on_device = jnp.asarray(u), jnp.asarray(m)
    calls = {
        "value": partial(jax.jit(special.ellipj), *on_device),
        "value and gradient": partial(jax.jit(value_and_gradient), *on_device),
    }
    timings = side_by_side(calls, rounds)
    return [
        Point(f"ellipj, {name}", "pendax", an_element(timings[name], u.size), None)
        for name in calls
    ]


def ratios(points: list[Point]) -> list[results.Row]:
    """Times as fast, at least."""
    timing = {(point.work, point.method): point.timing for point in points}

    def over(peer, ours):
        return timing[peer].over(timing[ours]) if peer in timing else np.nan

    ours, both = ("ellipj", "pendax"), ("ellipj, value and gradient", "pendax")
    rows = [
        ("ellipj against SciPy", over(("ellipj", "SciPy"), ours), 10),
        ("ellipj against GSL", over(("ellipj", "GSL"), ours), 2.5),
        ("ellipj against elliptic-functions", over(("ellipj", "elliptic-functions"), ours), 30),
        ("ellipj against jnp.sin, jnp.cos", over(("ellipj", "jnp.sin, jnp.cos"), ours), 1),
        (
            "ellipj, one m, against SciPy",
            over(("ellipj, one m", "SciPy"), ("ellipj, one m", "pendax")),
            20,
        ),
        ("ellipk against SciPy", over(("ellipk", "SciPy"), ("ellipk", "pendax")), 2.5),
        ("value against value and gradient", over(("ellipj, value", "pendax"), both), 1 / 3),
    ]
    return [results.bar(name, ratio, at_least=limit) for name, ratio, limit in rows]


def compile_times(u, m, quick: bool) -> tuple[list[results.Row], list[results.Row]]:
    rows, bars = [], []
    for name, function, limit in (
        ("ellipj", special.ellipj, 1),
        ("ellipj, value and gradient", value_and_gradient, 3),
    ):
        arguments = jnp.asarray(u), jnp.asarray(m)
        timing = Timing(tuple(compile_time(function, *arguments) for _ in range(1 if quick else 3)))
        rows.append({"work": name, **spent(timing, "s")})
        bars.append(results.bar(f"compiling {name}, s", seconds(timing), at_most=limit))
    return rows, bars


def small_arrays(quick: bool) -> tuple[list[results.Row], list[results.Row]]:
    rows, bars = [], []
    for size in (1, 100, 1000):
        u = jnp.linspace(0.0, 5.0, size)
        calls = {
            "ellipj": partial(jax.jit(special.ellipj), u, 0.5 * jnp.ones(size)),
            "jnp.sin": partial(jax.jit(jnp.sin), u),
        }
        timings = side_by_side(calls, 200 if quick else 1000)
        for name, timing in timings.items():
            rows.append({"elements": size, "work": name, **spent(timing, "µs")})
        more = 1e6 * np.subtract(timings["ellipj"].samples, timings["jnp.sin"].samples)
        low, middle, high = np.percentile(more, [5, 50, 95]).tolist()  # else the machine's pauses
        more = {"ratio": middle, "from": low, "to": high}
        bars.append(results.bar(f"ellipj of {size} over jnp.sin, µs more", more, at_most=20))
    return rows, bars
