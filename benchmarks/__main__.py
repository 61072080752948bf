"""Error against run time, stability, and what a scene costs: measured, written, compared.

`python -m benchmarks` measures everything, topic after topic, into benchmarks/results (JSON and
figures) and renews the tables of the README; `python -m benchmarks free gradients` measures two.
"""

import argparse
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path

from . import TOPICS, results

# The references and the tagged cases are those of the tests.
sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))


def main() -> int:
    options = _parser().parse_args()
    if options.list:
        print("\n".join(f"{name:10} {about}" for name, about in TOPICS.items()))
        return 0
    names = options.topics or list(TOPICS)
    worst = 0
    if len(names) == 1:
        worst = _one(names[0], options)
    else:  # each in a process of its own: programs, memory and settings are not shared
        for name in names:
            done = subprocess.run([sys.executable, "-m", "benchmarks", name, *_flags(options)])
            worst = max(worst, done.returncode)
    if not options.quick:
        from . import readme

        readme.renew()
    return worst


def _one(name: str, options: argparse.Namespace) -> int:
    import jax

    jax.config.update("jax_enable_x64", True)
    started = time.perf_counter()
    print(f"\n# {name}: {TOPICS[name]}", flush=True)
    module = import_module(f".{name}", __package__)
    tables = module.measure(options.seed, options.quick)
    if not options.verify:
        path = results.write(name, tables, seed=options.seed, quick=options.quick)
    for title, rows in tables.items():
        if rows:
            print(f"\n{title}\n\n{results.markdown(rows)}")
    missed = results.missed(tables)
    print(f"\n{name}: {time.perf_counter() - started:.0f} s; missed: {'; '.join(missed) or 'none'}")
    if options.verify:
        folder = results.QUICK if options.quick else results.FOLDER
        return int(results.differ(results.read(name, folder)["tables"], tables) > 0)
    print(f"written: {path}", flush=True)
    return int(options.check and bool(missed))


def _flags(options: argparse.Namespace) -> list[str]:
    flags = [f"--{name}" for name in ("quick", "check", "verify") if getattr(options, name)]
    return [*flags, "--seed", str(options.seed)]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    add = parser.add_argument
    add("topics", nargs="*", metavar="TOPIC", choices=[*TOPICS, []], help="all, if none is named")
    add("--list", action="store_true", help="the topics, a line each")
    add("--quick", action="store_true", help="fewer points and rounds, into results/quick")
    add("--seed", type=int, default=1, help="draws other points")
    add("--check", action="store_true", help="exit 1 where a bar is missed")
    add("--verify", action="store_true", help="compare with the results kept, and keep those")
    return parser


if __name__ == "__main__":
    sys.exit(main())
