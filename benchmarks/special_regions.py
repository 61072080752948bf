"""The elliptic functions region by region: errors and run times beside the peers'."""

from collections.abc import Callable
from functools import cache, partial

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special

from pendax import special

from . import integrals, results
from .accuracy import EPS, PROMISED, complete_errors, jacobi_error
from .compared import Point, an_element, spent
from .peers import compiled, library
from .timing import side_by_side

REGIONS = {
    "ellipj": ("small u", "random", "near the separatrix", "huge u"),
    "ellipk": ("random", "near the separatrix"),
    "ellipkinc": ("random", "near the separatrix"),
    "ellipeinc": ("random", "near the separatrix"),
}
LOOKED_AT = {"ellipj": 1000, "ellipk": 1000, "ellipkinc": 150, "ellipeinc": 150}


def columns(function: str, region: str, rng, size: int, dtype) -> list[np.ndarray]:
    """u or φ, and m: random, |u| < 20, |φ| < 10 and 0 < m < 1; small u, 1e-12 … 1e-3; near the
    separatrix, 1 − m of 1e-16 … 1e-3 (float32: 1e-7); huge u, 1e3 … 1e12 (float32: 1e6)."""
    wide = dtype == np.float64
    m = rng.uniform(0, 1, size)
    if region == "near the separatrix":
        m = 1 - 10 ** rng.uniform(-16 if wide else -7, -3, size)
    size_of_u = {"small u": (-12, -3), "huge u": (3, 12 if wide else 6)}.get(region)
    most = 20 if function == "ellipj" else 10
    u = rng.uniform(-most, most, size)
    if size_of_u is not None:
        u = np.sign(u) * 10 ** rng.uniform(*size_of_u, size)
    found = [m] if function == "ellipk" else [u, m]
    return [x.astype(dtype) for x in found]


def calls_of(function: str, wide: list[np.ndarray], narrow: list[np.ndarray]) -> dict:
    """By the name of the library."""
    program = _program(function)
    on_device = [jnp.asarray(x) for x in wide]
    calls = {
        "pendax": partial(program, *on_device),
        "pendax float32": partial(program, *map(jnp.asarray, narrow)),
        "SciPy": partial(getattr(scipy.special, function), *wide),
        **compiled(function, wide),
    }
    if library("elliptic") is not None:
        calls["elliptic-functions"] = partial(_by_elliptic(function), *on_device)
    if function == "ellipk" and (jaxellip := library("jaxellip")) is not None:
        calls["jaxellip"] = partial(jax.jit(jaxellip.ellipk), *on_device)
    return calls


@cache
def _program(function: str) -> Callable:
    return jax.jit(getattr(special, function))


@cache
def _by_elliptic(function: str) -> Callable:
    import elliptic

    return jax.jit(
        {
            "ellipj": elliptic.ellipj,
            "ellipk": lambda m: elliptic.cel1(jnp.sqrt(1 - m)),
            "ellipkinc": lambda phi, m: elliptic.elliptic12(phi, m)[0],
            "ellipeinc": lambda phi, m: elliptic.elliptic12(phi, m)[1],
        }[function]
    )


def regions(seed: int) -> list[Point]:
    """The work of a point is "function, region"."""
    size, rounds, points = 2**16, 5, []
    for function, names in REGIONS.items():
        for region in names:
            draws = [
                columns(function, region, np.random.default_rng(seed), size, dtype)
                for dtype in (np.float64, np.float32)
            ]
            calls = calls_of(function, *draws)
            timings = side_by_side(calls, rounds)
            for library_, call in calls.items():
                narrow = "float32" in library_
                error = largest(function, draws[narrow], call())
                error *= EPS / float(np.finfo(np.float32).eps) if narrow else 1
                timing = an_element(timings[library_], size)
                points.append(Point(f"{function}, {region}", library_, timing, error))
    return points


def largest(function: str, at: list[np.ndarray], got) -> float:
    """The largest error on a sample, in eps × scale; NaN if one is."""
    picked = slice(None, None, max(1, at[0].size // LOOKED_AT[function]))
    few = [np.asarray(x, float)[picked] for x in at]
    if function == "ellipj":
        values = np.stack([np.asarray(x, float)[picked] for x in got[:3]], 1)
        return float(np.max([jacobi_error("m", *row)[0] for row in zip(*few, values, strict=True)]))
    values = np.asarray(got, float)[picked]
    if function == "ellipk":
        return float(np.max(complete_errors(function, *few, values)))
    return float(np.max(integrals.errors(function, few, values)))


def tables(points: list[Point]) -> results.Tables:
    found = {}
    for point in points:
        function, region = point.work.split(", ")
        found.setdefault(f"{function} by region, eps × scale", []).append(
            {
                "region": region,
                "library": point.method,
                **spent(point.timing, "ns"),
                "error": point.error,
            }
        )
    return found


def bars(points: list[Point]) -> list[results.Row]:
    worst = {}
    for point in points:
        if point.ours:
            key = point.work.split(", ")[0], point.method
            worst[key] = max(worst.get(key, 0.0), point.error)
    return [
        results.bar(
            f"{function} in all regions, {name}, eps × scale",
            error,
            at_most=PROMISED["sn, cn, dn" if function == "ellipj" else function],
        )
        for (function, name), error in worst.items()
    ]


def draw(points: list[Point]) -> None:
    """A panel a function: a mark a library, a colour a region; NaN at the upper edge."""
    from pendax import plot

    with plot.style():
        figure = plot.new_figure(11.0, 8.5)
        marks = dict(zip(dict.fromkeys(p.method for p in points), "oosv^DP", strict=False))
        filled = {name: "none" if "float32" in name else "full" for name in marks}
        names = dict.fromkeys(name for names in REGIONS.values() for name in names)
        colours = dict(zip(names, plot.shades(len(names)), strict=True))
        for ax, function in zip(figure.subplots(2, 2, sharex=True).flat, REGIONS, strict=True):
            for point in points:
                of, region = point.work.split(", ")
                if of == function:
                    error = min(point.error, 1e19) if np.isfinite(point.error) else 1e19
                    ax.loglog(1e9 * point.timing.median, error, marks[point.method], ms=8,
                              color=colours[region], fillstyle=filled[point.method])  # fmt: skip
            ax.set_ylim(0.1, max(100.0, ax.get_ylim()[1]))
            ax.set(xlabel="run time of an element / ns", ylabel="largest error / eps × scale")
            ax.tick_params(labelbottom=True)
            ax.set_title(function)
        ax = figure.axes[0]
        handles = [
            ax.plot([], [], "_", color=x, ms=14, mew=5, label=name)[0]
            for name, x in colours.items()
        ]
        handles += [
            ax.plot([], [], mark, color="gray", ms=8, fillstyle=filled[name], label=name)[0]
            for name, mark in marks.items()
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=4)
        figure.savefig(results.folder() / "special.png")
