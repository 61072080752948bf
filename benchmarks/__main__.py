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
from tempfile import TemporaryDirectory

from . import TOPICS, results

# The references and the tagged cases are those of the tests.
sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))


def main() -> int:
    options = _parser().parse_args()
    if options.list:
        print("\n".join(f"{name:10} {about}" for name, about in TOPICS.items()))
        return 0
    names = options.topics or list(TOPICS)
    if unknown := [name for name in names if name not in TOPICS]:
        _parser().error(f"no topic {', '.join(unknown)}; there are {', '.join(TOPICS)}")
    worst = 0
    if options.quick or len(names) == 1:
        worst = max([_one(name, options) for name in names])
    else:  # each in a process of its own: programs, memory and settings are not shared
        for name in names:
            done = subprocess.run([sys.executable, "-m", "benchmarks", name, *_flags(options)])
            worst = max(worst, done.returncode)
    if not (options.quick or options.verify or options.seed != results.SEED):
        worst = max(worst, _renew())
    return worst


def _renew() -> int:
    from . import readme

    try:
        readme.renew()
    except (LookupError, StopIteration) as error:
        print(f"The README is not renewed: a results file of an older form, without {error}.")
        return 1
    return 0


def _one(name: str, options: argparse.Namespace) -> int:
    import jax

    jax.clear_caches()
    jax.config.update("jax_enable_x64", True)
    settings = {"seed": options.seed, "quick": options.quick}
    if options.seed != results.SEED:
        results.elsewhere(results.FOLDER / "other" / ("quick" if options.quick else ""))
    if options.verify and not (kept := results.kept(name, settings)):
        return 2
    started = time.perf_counter()
    print(f"\n# {name}: {TOPICS[name]}", flush=True)
    module = import_module(f".{name}", __package__)
    if options.verify:
        with TemporaryDirectory() as folder:  # for figures
            results.elsewhere(Path(folder))
            tables = module.measure(**settings)
    else:
        tables = module.measure(**settings)
        path = results.write(name, tables, **settings)
    for title, rows in tables.items():
        if rows:
            print(f"\n{title}\n\n{results.markdown(rows)}")
    missed = results.missed(tables)
    print(f"\n{name}: {time.perf_counter() - started:.0f} s; missed: {'; '.join(missed) or 'none'}")
    if options.verify:
        for line in results.moved(kept):
            print(f"not the machine and versions of what is kept: {line}")
        wrong, ratios, slow = results.differ(kept["tables"], tables)
        print(
            f"{name}: {'FAILED' if wrong + ratios else 'verified'}; errors differ in {wrong} rows, "
            f"ratios leave their range in {ratios}, times alone their spread in {slow}"
        )
        return int(wrong + ratios > 0)
    print(f"written: {path}", flush=True)
    return int(options.check and bool(missed))


def _flags(options: argparse.Namespace) -> list[str]:
    flags = [f"--{name}" for name in ("quick", "check", "verify") if getattr(options, name)]
    return [*flags, "--seed", str(options.seed)]


def _parser() -> argparse.ArgumentParser:
    text = (
        "All take half an hour on two cores, and are written topic by topic.  "
        "Peers that are not installed are left out."
    )
    parser = argparse.ArgumentParser("python -m benchmarks", description=__doc__, epilog=text)
    add = parser.add_argument
    add("topics", nargs="*", metavar="TOPIC", help="all, if none is named; see --list")
    add("--list", action="store_true", help="the topics, a line each")
    add("--quick", action="store_true", help="fewer points and rounds, into results/quick")
    add("--seed", type=_seed, default=results.SEED, help="other points, into results/other")
    judged = parser.add_mutually_exclusive_group().add_argument
    judged("--check", action="store_true",
        help="measure, and exit 1 where a bar, what is aimed at, is missed")  # fmt: skip
    judged("--verify", action="store_true",
        help="measure and compare with the results that are there, which stay; exit 1 if errors "
        "differ or ratios leave their range, 2 if there are none; times are reported")  # fmt: skip
    return parser


def _seed(text: str) -> int:
    if (seed := int(text)) < 0:
        raise argparse.ArgumentTypeError(f"must be 0 or more, but got {seed}")
    return seed


if __name__ == "__main__":
    sys.exit(main())
