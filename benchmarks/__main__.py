"""The command line of the benchmarks."""

import argparse
import sys
from importlib import import_module
from pathlib import Path

# The references and the tagged cases are those of the tests.
sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    accuracy = commands.add_parser("accuracy", help="errors in eps by region, beside SciPy's")
    accuracy.add_argument("--seed", type=int, default=1, help="draws other points")
    accuracy.add_argument("--points", type=int, default=400, help="of each region")
    special = commands.add_parser("special", help="error against run time, beside the peers'")
    special.add_argument("--seed", type=int, default=1, help="draws other arguments")
    special.add_argument("--size", type=int, default=2**20, help="elements of an array")
    special.add_argument("--rounds", type=int, default=15, help="timings of each, interleaved")
    special.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    motion = commands.add_parser("motion", help="the closed form beside diffrax's solvers")
    motion.add_argument("--seed", type=int, default=1, help="draws other arguments")
    motion.add_argument("--size", type=int, default=2**20, help="values of an array")
    motion.add_argument("--rounds", type=int, default=15, help="timings of each, interleaved")
    motion.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    lean = commands.add_parser("lean", help="operations of the compiled scene, against paper")
    lean.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    damped = commands.add_parser("damped", help="damped and driven scenes, against 30 digits")
    damped.add_argument("--seed", type=int, default=1, help="draws other scenes")
    damped.add_argument("--scenes", type=int, default=1000, help="random scenes")
    damped.add_argument("--rounds", type=int, default=15, help="timings of each, interleaved")
    damped.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    dry = commands.add_parser("dry", help="dry friction, against 30 digits and beside events")
    dry.add_argument("--seed", type=int, default=1, help="draws other scenes")
    dry.add_argument("--scenes", type=int, default=60, help="random scenes")
    dry.add_argument("--rounds", type=int, default=7, help="timings of each, interleaved")
    dry.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    fate = commands.add_parser("fate", help="where motions end, against 30 digits")
    fate.add_argument("--seed", type=int, default=1, help="draws other starts")
    fate.add_argument("--pixels", type=int, default=200, help="of each map that are compared")
    fate.add_argument("--rounds", type=int, default=5, help="timings of each, interleaved")
    fate.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    junction = commands.add_parser("junction", help="I–V curves beside time stepping")
    junction.add_argument("--seed", type=int, default=1, help="draws other junctions")
    junction.add_argument("--scenes", type=int, default=40, help="random voltages of either kind")
    junction.add_argument("--rounds", type=int, default=5, help="timings of each, interleaved")
    junction.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    fit = commands.add_parser("fit", help="parameters from random recordings")
    fit.add_argument("--seed", type=int, default=1, help="draws other scenes")
    fit.add_argument("--scenes", type=int, default=1000, help="random scenes")
    fit.add_argument("--rounds", type=int, default=5, help="timings of each, interleaved")
    fit.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    stability = commands.add_parser("stability", help="stiff and extreme cases, beside peers")
    stability.add_argument("--check", action="store_true", help="exit 1 where a bar is missed")
    options = vars(parser.parse_args())

    import jax

    jax.config.update("jax_enable_x64", True)
    report = import_module(f".{options.pop('command')}", __package__).report
    return report(**options)


if __name__ == "__main__":
    sys.exit(main())
