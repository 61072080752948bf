"""The scenes and the questions that are asked of them, compiled.

A scene without a solver is one pendulum at many times; the others are many pendulums, followed
side by side.  All numbers are arguments of the program: a constant would be folded into it.  The
method is that which `simulate` chooses by the values of the scene, where it can see them.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from unittest import mock

import jax
import jax.numpy as jnp
import numpy as np

import pendax
from pendax import Pendulum, _simulate

from .lean_hlo import Program
from .timing import Timing, compile_time

SIZE = 1021  # times, or pendulums: one block; a prime, as no other size in a program is
TIMES = 16  # that those with a solver are asked for
_VALUES = {"epsilon": 1.0, "v0": 1.3, "theta0": 0.2}
Numbers = dict[str, float]


@dataclass(frozen=True)
class Question:
    """`ask(numbers, times)` gives what is asked for; `gradient`: and its derivatives, in all
    the numbers, of the sum over times or pendulums."""

    scene: str
    name: str
    ask: Callable
    numbers: Numbers
    times: np.ndarray | None = None
    gradient: bool = False
    many: bool = True  # pendulums
    lanes: int = SIZE

    def arguments(self):
        shape = (self.lanes,) if self.many else ()
        numbers = {name: jnp.full(shape, x) for name, x in self.numbers.items()}
        return numbers, None if self.times is None else jnp.asarray(self.times)

    def function(self) -> Callable:
        if not self.gradient:
            return self.ask

        def total(numbers, times):
            return sum(jnp.sum(x) for x in jax.tree.leaves(self.ask(numbers, times)))

        return jax.value_and_grad(total)


def compiled(question: Question):
    """The program and its memory.  Without LLVM's optimisations, which come after what is read."""
    lowered = jax.jit(question.function()).lower(*question.arguments())
    program = lowered.compile(compiler_options={"xla_backend_optimization_level": 0})
    return Program(program.as_text(), question.lanes), program.memory_analysis()


def seconds(question: Question) -> Timing:
    """To trace and compile it, optimised."""
    return Timing(tuple(compile_time(question.function(), *question.arguments()) for _ in range(3)))


def _motion(parts: tuple[str, ...], method, tau, numbers: dict, ts):
    numbers = dict(numbers)
    v0, theta0 = numbers.pop("v0"), numbers.pop("theta0")
    scene = Pendulum(**numbers, **({} if tau is None else {"tau": tau}))
    with mock.patch.object(_simulate, "choose", return_value=method):
        run = pendax.simulate(scene, ts, v0, theta0, throw=False)
    return tuple(getattr(run, part) for part in parts)


def _method(scene: Pendulum, ts):
    """What `simulate` chooses."""

    class Chosen(Exception):
        pass

    def note(*arguments):
        raise Chosen(choose(*arguments))

    choose = _simulate.choose
    with mock.patch.object(_simulate, "choose", note):
        try:
            pendax.simulate(scene, ts, _VALUES["v0"], _VALUES["theta0"])
        except Chosen as chosen:
            return chosen.args[0]
    raise ValueError("A closed form answers.")


_ASKED = {"θ": ("theta",), "v": ("v",), "θ and v": ("theta", "v")}


def motions(
    name: str, span: float, torque: Callable | None = None, *, lanes: int = SIZE, **terms: float
) -> list[Question]:
    """Of a scene with a solver: θ and v at TIMES, either alone, θ at the last one; and settle."""
    numbers = _VALUES | terms
    scene = Pendulum(1.0, **terms, **({} if torque is None else {"tau": torque}))
    ts = np.linspace(0, span, TIMES + 1)[1:]

    def one(question: str, parts, ts) -> Question:
        ask = partial(_motion, parts, _method(scene, ts), torque)
        return Question(name, question, ask, numbers, ts, lanes=lanes)

    asked = [one(question, parts, ts) for question, parts in _ASKED.items()]
    final = one("final θ", ("theta",), np.asarray(span))
    return [*asked, final, replace(final, gradient=True)]


def free() -> list[Question]:
    ts = np.linspace(0.0, 10.0, SIZE)
    asked = [
        Question("free", name, partial(_motion, parts, None, None), _VALUES, ts, many=False)
        for name, parts in _ASKED.items()
    ]
    period = Question("free", "period", _period, _VALUES)
    final = replace(asked[0], name="final θ", times=np.asarray(10.0), many=True)
    both = [*asked, final, period]
    return [replace(x, gradient=gradient) for x in both for gradient in (False, True)]


def _period(numbers, _):
    scene = Pendulum(numbers["epsilon"])
    return pendax.period(scene, numbers["v0"], numbers["theta0"])


def settled(name: str, part: str = "well", gradient: bool = False, **terms: float) -> Question:
    def ask(numbers, _):
        numbers = dict(numbers)
        v0, theta0 = numbers.pop("v0"), numbers.pop("theta0")
        return getattr(pendax.settle(Pendulum(**numbers), v0, theta0, throw=False), part)

    what = "well" if part == "well" else "angle of rest"
    return Question(name, what, ask, _VALUES | terms, gradient=gradient)


def junction() -> list[Question]:
    """First order, I a number: one junction at many times."""
    numbers = {"critical_current": 1e-4, "resistance": 1.0, "current": 1.5e-4, "phase0": 0.2}
    ts = np.linspace(0.0, 1e-10, SIZE)

    def ask(parts, numbers, ts):
        known = {x: numbers[x] for x in ("critical_current", "resistance")}
        run = pendax.JosephsonJunction(**known).evolve(ts, numbers["current"], numbers["phase0"])
        return tuple(getattr(run, part) for part in parts)

    parts = {"θ": ("phase",), "v": ("voltage",), "θ and v": ("phase", "voltage")}
    asked = [
        Question("first-order junction", name, partial(ask, of), numbers, ts, many=False)
        for name, of in parts.items()
    ]
    return [replace(x, gradient=gradient) for x in asked for gradient in (False, True)]
