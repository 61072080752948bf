"""Imports, and the time from the shell to the first number of a sweep of 1,000 lanes.

Each run is a process of its own, by the wall clock: from spawning it to the line that it prints.
Cold is without a cache of compiled programs (files are in the system's cache); warm with JAX's
persistent cache, filled by a run before, all programs kept as `pendax --cache` does.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from . import results
from .compared import seconds
from .timing import Timing

ROUNDS, QUICK_ROUNDS = 3, 1
IMPORTED = 7  # rounds of imports, which are short
HEAVY = ("diffrax", "optax", "optimistix", "lineax", "matplotlib", "scipy")
ALL_KEPT = {
    "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
}

IMPORTS = {
    "import jax": "import jax",
    "import pendax": "import pendax",
    "pendax.Pendulum": "import pendax; pendax.Pendulum",
    "pendax.simulate": "import pendax; pendax.simulate",
    "import equinox": "import equinox",
    "pendax.special.ellipk": "from pendax.special import ellipk",
}

# What is loaded after them; the first three and free motion have no use for what is heavy.
SCENES = {
    "import pendax": "",
    "pendax.Pendulum": "pendax.Pendulum",
    "special.ellipk": "from pendax.special import ellipk; ellipk(0.5)",
    "simulate, free": "pendax.simulate(pendax.Pendulum(), ts, 1.0)",
    "simulate, damped": "pendax.simulate(pendax.Pendulum(1.0, 0.1), ts, 1.0)",
    "simulate, τ(t)": "pendax.simulate(pendax.Pendulum(1.0, 0.1, lambda t: t), ts, 1.0)",
    "simulate, τ(t) with kinks": "pendax.simulate(pendax.Pendulum(1.0, 0.1, abs), ts, 1.0)",
    "settle": "pendax.settle(pendax.Pendulum(1.0, 0.1), 1.0)",
    "fit_trajectory": "pendax.fit_trajectory(ts, 0.1 * np.cos(ts), pendax.Pendulum(1.1))",
    "plot": "pendax.plot.style",
}

_SWEEP = """
import jax, jax.numpy as jnp
import pendax
jax.config.update("jax_enable_x64", True)
v0 = jnp.linspace(0.0, 4.0, 1000)
scene = pendax.Pendulum(1.0, 0.1)
"""
_DRIVEN = "pendax.Pendulum(1.0, 0.1, lambda t: 0.5 * jnp.cos(0.7 * t))"
_KINKED = "pendax.Pendulum(1.0, 0.1, lambda t: 0.5 * jnp.abs(jnp.cos(0.7 * t)))"
_TSIT5 = "import diffrax\n"
CLOSED, TAYLOR, DIFFRAX = "closed form", "Taylor", "diffrax"
# Each: by what, what is run before, and what is printed.
SWEEPS = {
    "frequency": (CLOSED, "", "pendax.frequency(pendax.Pendulum(), v0)[500]"),
    "θ(10)": (CLOSED, "", "pendax.simulate(pendax.Pendulum(), 10.0, v0).theta[500]"),
    "damped, θ(10)": (TAYLOR, "", "pendax.simulate(scene, 10.0, v0).theta[500]"),
    "damped, θ(10), Tsit5": (
        DIFFRAX,
        _TSIT5,
        "pendax.simulate(scene, 10.0, v0, solver=diffrax.Tsit5()).theta[500]",
    ),
    "τ(t), θ(10)": (TAYLOR, "", f"pendax.simulate({_DRIVEN}, 10.0, v0).theta[500]"),
    "τ(t) with kinks, θ(10), Dopri8": (
        DIFFRAX,
        "",
        f"pendax.simulate({_KINKED}, 10.0, v0).theta[500]",
    ),
    "damped, θ at 100 times, Tsit5": (
        DIFFRAX,
        _TSIT5 + "ts = jnp.linspace(0.0, 10.0, 100)\n",
        "pendax.simulate(scene, ts, v0, solver=diffrax.Tsit5()).theta[500, -1]",
    ),
}
UNCHECKED = {"EQX_ON_ERROR": "nan"}  # diffrax's check of the times without its callback
SWEEPS["θ at 100 times, EQX_ON_ERROR=nan"] = SWEEPS["damped, θ at 100 times, Tsit5"]
COMMAND = ["-m", "pendax", "sweep", "--count", "1000"]
LIMITS = {CLOSED: (3, 2), TAYLOR: (3, 2), DIFFRAX: (6, 3)}  # s, without and with the cache


def measure(seed: int, quick: bool) -> results.Tables:
    del seed  # nothing is drawn
    rounds = QUICK_ROUNDS if quick else ROUNDS
    imported = QUICK_ROUNDS if quick else IMPORTED
    with tempfile.TemporaryDirectory() as folder:
        imports, bars = _imports(imported)
        loaded, more = ([], []) if quick else _loaded()
        sweeps, last = ([], []) if quick else _cold_starts(rounds, Path(folder))
    return {"imports": imports, "loaded": loaded, "cold start": sweeps, "bars": bars + more + last}


def _imports(rounds: int):
    cases = {name: (["-c", f"{code}; print(1)"], {}) for name, code in IMPORTS.items()}
    for case in cases.values():  # files into the system's cache
        _run(*case)
    spent = _in_turn(cases, rounds)
    jax, equinox = spent["import jax"], spent["import equinox"]
    rows = [
        {"what": name, "s": timing.median, "spread": timing.spread, **timing.over(jax)}
        for name, timing in spent.items()
    ]
    ellipk = spent["pendax.special.ellipk"].over(equinox)
    packages = [_modules(IMPORTS[name]) for name in ("pendax.special.ellipk", "import equinox")]
    more = {x.split(".")[0] for x in packages[0]} - {x.split(".")[0] for x in packages[1]}
    return rows, [
        results.bar("import pendax over jax", spent["import pendax"].over(jax), at_most=1.5),
        results.bar("import pendax, simulate over jax", spent["pendax.simulate"].over(jax),
                    at_most=1.5),
        results.bar("ellipk over equinox", ellipk, at_most=1.5),
        results.bar("packages ellipk loads, not equinox", len(more - {"pendax"}), at_most=0),
    ]  # fmt: skip


def _loaded():
    rows, bars = [], []
    for name, code in SCENES.items():
        given = "import numpy as np\nimport pendax\nts = np.linspace(0.0, 10.0, 50)\n"
        modules = _modules(f"{given}{code}")
        rows.append({"after": name, **{heavy: heavy in modules for heavy in HEAVY}})
        if name not in ("fit_trajectory", "plot", "simulate, τ(t) with kinks"):
            count = sum(heavy in modules for heavy in HEAVY)
            bars.append(results.bar(f"heavy packages after {name}", count, at_most=0))
    return rows, bars


def _modules(code: str) -> set[str]:
    return set(_run(["-c", f"{code}\nimport sys; print(*sys.modules)"], {})[1].split())


def _cold_starts(rounds: int, folder: Path):
    def cached(name: str) -> dict[str, str]:
        return {"JAX_COMPILATION_CACHE_DIR": str(folder / re.sub(r"\W", "-", name))}

    cases, kinds = {}, {}
    for name, (kind, before, number) in SWEEPS.items():
        kinds[name] = kind
        run = ["-c", f"{_SWEEP}{before}print(float({number}), flush=True)"]
        given = UNCHECKED if "EQX_ON_ERROR" in name else {}
        cases[name, "no"] = run, given
        cases[name, "yes"] = run, cached(name) | ALL_KEPT | given
    name, command = "pendax sweep, its first line", [*COMMAND, "--out", str(folder / "out")]
    kinds[name] = CLOSED
    cases[name, "no"] = command, {}
    cases[name, "yes"] = [*command, "--cache"], cached(name)
    # Fills the caches.
    programs = {name: _programs(*cases[name, "yes"]) for name in kinds}
    spent = _in_turn(cases, rounds)
    rows, bars = [], []
    for (name, cache), timing in spent.items():
        built, unkept = programs[name]
        rows.append({
            "sweep": name, "by": kinds[name], "cache": cache, "s": timing.median,
            "spread": timing.spread, "programs": built, "that no cache keeps": unkept,
        })  # fmt: skip
        limit = LIMITS[kinds[name]][cache == "yes"]
        what = f"{name}, {'a warm' if cache == 'yes' else 'no'} cache: s"
        bars.append(results.bar(what, seconds(timing), at_most=limit))
    return rows, bars


def _programs(arguments, environment) -> tuple[int, int]:
    """How many are compiled, and those of them that no cache keeps."""
    loud = {"JAX_LOG_COMPILES": "1", "JAX_EXPLAIN_CACHE_MISSES": "1"}
    log = _run(arguments, environment | loud)[2]
    return log.count("Finished XLA compilation"), log.count("because it uses host callbacks")


def _in_turn(cases, rounds: int) -> dict:
    """Timings of processes, one of each in turn."""
    spent = {name: [] for name in cases}
    for i in range(rounds):
        for name, case in cases.items():
            spent[name].append(_run(*case)[0])
        print(f"round {i + 1} of {rounds}", flush=True)
    return {name: Timing(tuple(samples)) for name, samples in spent.items()}


def _run(arguments, environment) -> tuple[float, str, str]:
    """Seconds to the first line or, of what prints none, to the end; what it printed."""
    given = {k: v for k, v in os.environ.items() if not k.startswith(("JAX_", "EQX_"))}
    given |= {"PYTHONUNBUFFERED": "1", **environment}
    with tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
        start = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, *arguments], env=given, text=True, encoding="utf-8",
            stdout=subprocess.PIPE, stderr=errors,
        )  # fmt: skip
        assert process.stdout is not None
        first = process.stdout.readline()
        seconds = time.perf_counter() - start
        rest = process.stdout.read()
        errors.seek(0)
        said = errors.read()
        if process.wait() != 0:
            raise RuntimeError(f"{arguments} failed:\n{said}")
    return seconds, first + rest, said
