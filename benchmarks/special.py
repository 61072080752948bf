"""Error against run time of the elliptic functions, and the bars they are held to."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import scipy.special

from pendax import special

from . import integrals
from .accuracy import EPS, complete_errors, jacobi_error
from .peers import compiled, library
from .timing import Row, compile_time, side_by_side

SAMPLE = 2000  # elements whose error is looked at


def report(seed: int, size: int, rounds: int, check: bool) -> int:
    rng = np.random.default_rng(seed)
    u, m = rng.uniform(-20, 20, size), rng.uniform(0, 1, size)
    device = jax.devices()[0]
    print(f"{size} random elements, |u| < 20, 0 < m < 1, medians of {rounds}; {device.device_kind}")
    rows = [
        *jacobi(u, m, rounds),
        *shared_parameter(u, rounds),
        *complete(m, rounds),
        *gradients(u, m, rounds),
    ]
    more = integrals.speed(size, max(3, rounds // 3), seed)
    print("\n| work | library | ns an element | max error, eps × scale |\n|---|---|---|---|")
    for row in rows + more:
        error = "" if row.error is None else f"{row.error:.2g}"
        print(f"| {row.work} | {row.library} | {row.seconds * 1e9:.1f} | {error} |")
    missed = bars(rows, integrals.ratios(more)) + compiling(u, m) + small_arrays()
    return 1 if check and missed else 0


def worst(u, m, values) -> float:
    """The largest error of sn, cn, dn on a sample."""
    picked = slice(None, None, max(1, u.size // SAMPLE))
    columns = np.stack([np.asarray(x, float)[picked] for x in values[:3]], 1)
    return max(
        jacobi_error("m", *row)[0] for row in zip(u[picked], m[picked], columns, strict=True)
    )


def jacobi(u, m, rounds) -> list[Row]:
    on_device = jnp.asarray(u), jnp.asarray(m)
    narrow = tuple(x.astype(jnp.float32) for x in on_device)
    ours, sines = jax.jit(special.ellipj), jax.jit(lambda x: (jnp.sin(x), jnp.cos(x)))
    calls = {
        "pendax": partial(ours, *on_device),
        "pendax float32": partial(ours, *narrow),
        "SciPy": partial(scipy.special.ellipj, u, m),
        "jnp.sin, jnp.cos": partial(sines, on_device[0]),
    }
    if (elliptic := library("elliptic")) is not None:
        calls["elliptic-functions"] = partial(jax.jit(elliptic.ellipj), *on_device)
    spent = side_by_side(calls, rounds)
    rows = []
    for name, call in calls.items():
        error = None
        if name == "pendax float32":
            exact = (np.asarray(x, float) for x in narrow)
            error = worst(*exact, call()) * EPS / np.finfo(np.float32).eps
        elif "jnp" not in name:
            error = worst(u, m, call())
        rows.append(Row("ellipj", name, spent[name] / u.size, error))
    for peer in ("GSL", "Boost"):
        if (result := compiled(peer, u, m)) is not None:
            rows.append(Row("ellipj", f"{peer}, one core", result[0], worst(u, m, result[1])))
    if (mpmath := library("mpmath")) is not None:
        few = [(x, y) for x, y in zip(u[:50].tolist(), m[:50].tolist(), strict=True)]

        def by_mpmath():
            return [[float(mpmath.ellipfun(f, x, m=y)) for f in ("sn", "cn", "dn")] for x, y in few]

        seconds = side_by_side({"mpmath": by_mpmath}, 1)["mpmath"] / len(few)
        values = np.array(by_mpmath()).T
        rows.append(Row("ellipj", "mpmath", seconds, worst(u[:50], m[:50], values)))
    return rows


def shared_parameter(u, rounds) -> list[Row]:
    m = 0.7
    on_device = jnp.asarray(u)
    calls = {
        "pendax": partial(jax.jit(special.ellipj), on_device, m),
        "SciPy": partial(scipy.special.ellipj, u, m),
    }
    spent = side_by_side(calls, rounds)
    shape = np.full(u.size, m)
    return [
        Row("ellipj, one m", name, spent[name] / u.size, worst(u, shape, call()))
        for name, call in calls.items()
    ]


def complete(m, rounds) -> list[Row]:
    on_device = jnp.asarray(m)
    calls = {
        "pendax": partial(jax.jit(special.ellipk), on_device),
        "SciPy": partial(scipy.special.ellipk, m),
    }
    if (jaxellip := library("jaxellip")) is not None:
        calls["jaxellip"] = partial(jax.jit(jaxellip.ellipk), on_device)
    spent = side_by_side(calls, rounds)
    picked = slice(None, None, max(1, m.size // 200))
    return [
        Row(
            "ellipk",
            name,
            spent[name] / m.size,
            max(complete_errors("ellipk", m[picked], np.asarray(call())[picked])),
        )
        for name, call in calls.items()
    ]


def value_and_gradient(u, m):
    """sn, cn, dn, ph and the gradient of their sum."""
    values, pullback = jax.vjp(special.ellipj, u, m)
    return values, pullback(jax.tree.map(jnp.ones_like, values))


def gradients(u, m, rounds) -> list[Row]:
    on_device = jnp.asarray(u), jnp.asarray(m)
    calls = {
        "value": partial(jax.jit(special.ellipj), *on_device),
        "value and gradient": partial(jax.jit(value_and_gradient), *on_device),
    }
    spent = side_by_side(calls, rounds)
    return [Row(f"ellipj, {name}", "pendax", spent[name] / u.size, None) for name in calls]


def bars(rows: list[Row], more: list[tuple[str, float, float]]) -> int:
    """Prints each ratio beside its bar; the number that are missed."""
    time = {(row.work, row.library): row.seconds for row in rows}
    ours = time["ellipj", "pendax"]
    ratios = [
        ("ellipj against SciPy", time["ellipj", "SciPy"] / ours, 10),
        ("ellipj against GSL", time.get(("ellipj", "GSL, one core"), np.nan) / ours, 2.5),
        (
            "ellipj, one m, against SciPy",
            time["ellipj, one m", "SciPy"] / time["ellipj, one m", "pendax"],
            20,
        ),
        ("ellipj against jnp.sin, jnp.cos", time["ellipj", "jnp.sin, jnp.cos"] / ours, 1),
        ("ellipk against SciPy", time["ellipk", "SciPy"] / time["ellipk", "pendax"], 2.5),
        (
            "value against value and gradient",
            time["ellipj, value", "pendax"] / time["ellipj, value and gradient", "pendax"],
            1 / 3,
        ),
        (
            "ellipj against elliptic-functions",
            time.get(("ellipj", "elliptic-functions"), np.nan) / ours,
            30,
        ),
        *more,
    ]
    print("\n| times as fast | measured | bar | |\n|---|---|---|---|")
    missed = 0
    for name, ratio, bar in ratios:
        verdict = "met" if ratio >= bar else "skipped" if np.isnan(ratio) else "missed"
        missed += verdict == "missed"
        print(f"| {name} | {ratio:.2f} | {bar:.2g} | {verdict} |")
    return missed


def compiling(u, m) -> int:
    print("\n| compiling | seconds | bar | |\n|---|---|---|---|")
    missed = 0
    for name, function, bar in (
        ("ellipj", special.ellipj, 1),
        ("ellipj, value and gradient", value_and_gradient, 3),
    ):
        seconds = compile_time(function, jnp.asarray(u), jnp.asarray(m))
        missed += seconds > bar
        print(f"| {name} | {seconds:.2f} | {bar} | {'met' if seconds <= bar else 'missed'} |")
    return missed


def small_arrays() -> int:
    print("\n| elements | ellipj, µs | jnp.sin, µs | at most 20 µs more |\n|---|---|---|---|")
    missed = 0
    for size in (1, 100, 1000):
        u = jnp.linspace(0.0, 5.0, size)
        calls = {
            "ellipj": partial(jax.jit(special.ellipj), u, 0.5 * jnp.ones(size)),
            "sin": partial(jax.jit(jnp.sin), u),
        }
        spent = side_by_side(calls, 1000)
        more = (spent["ellipj"] - spent["sin"]) * 1e6
        missed += more > 20
        ours, sine = spent["ellipj"] * 1e6, spent["sin"] * 1e6
        print(f"| {size} | {ours:.0f} | {sine:.0f} | {'met' if more <= 20 else 'missed'} |")
    return missed
