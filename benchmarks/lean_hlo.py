"""What a compiled program does, read from its text: operations, loops, what must not be there.

The text is walked from its entry, through fusions, calls, branches and loops, and every value
gets a number: two operations alike on values alike get the same one.  So it is known how many
operations there are and how many of them are distinct.  XLA's CPU backend computes again what
several results share, in each of them, rather than keep it; the difference says how much.
"""

import math
import re
from collections import Counter
from dataclasses import dataclass, field

ROOTS = {"sqrt", "rsqrt", "cbrt"}
TRANSCENDENTAL = {
    "atan2", "cosine", "exponential", "exponential-minus-one", "log", "log-plus-one", "logistic",
    "power", "sine", "tan", "tanh",
}  # fmt: skip
# Not comparisons, selections and the bits of a sign.
ARITHMETIC = ROOTS | TRANSCENDENTAL | {
    "abs", "add", "ceil", "clamp", "divide", "floor", "maximum", "minimum", "multiply", "negate",
    "remainder", "round-nearest-even", "subtract",
}  # fmt: skip
_SAME = {"bitcast", "copy", "opt-barrier", "optimization-barrier", "reshape"}
_HEAD = re.compile(r"^(ENTRY )?%(\S+) \(.*\{$")
_LINE = re.compile(r"^\s+(?:ROOT )?%(\S+) = (.*?) ([\w-]+)\((.*)$")
_CALLED = re.compile(r"(?:calls|to_apply|true_computation|false_computation)=%([\w.\-]+)")
_TRIPS = re.compile(r'known_trip_count[^}]*?"n":"(\d+)"')
_NOISE = re.compile(r", (?:metadata|backend_config|frontend_attributes|sharding)=.*")


@dataclass
class Loop:
    """One `while`, and what is done outside of all of them.

    `trips`: how often, `None` where the data decide; operations are of one time, those of the
    loops within that have a known number of trips included, per element.
    """

    trips: int | None = 1
    computed: Counter = field(default_factory=Counter)
    distinct: Counter = field(default_factory=Counter)

    def total(self, which: str = "distinct", names=ARITHMETIC) -> int:
        return round(sum(n for name, n in getattr(self, which).items() if name in names))


@dataclass
class Program:
    """`size`: the number of elements, times or pendulums; what has fewer is not counted."""

    text: str
    size: int
    outside: Loop = field(default_factory=Loop)
    loops: list[Loop] = field(default_factory=list)  # in the order of the text, the inner first
    trips: list[int | None] = field(default_factory=list)

    def __post_init__(self):
        self._computations, entry = _parsed(self.text)
        self._numbers: dict = {}
        self._walk(entry, None, self.outside, 1)
        self.trips.sort(key=lambda n: -1 if n is None else n)

    @property
    def largest(self) -> int:
        """Elements of the largest array of floating numbers."""
        return max(_elements(shape) for shape in re.findall(r"f(?:64|32)\[[\d,]*\]", self.text))

    @property
    def sources(self) -> list[str]:
        """The files whose operations are in it."""
        return re.findall(r'^\d+ "([^"]*\.py)"$', self.text, re.MULTILINE)

    def carried(self, elements: int) -> int:
        """How many arrays of so many floating numbers a loop carries along, at most."""
        loops = re.findall(r" = (\(.*?\)) while\(", self.text)
        arrays = (re.findall(r"f(?:64|32)\[[\d,]*\]", shapes) for shapes in loops)
        return max((sum(_elements(x) == elements for x in of) for of in arrays), default=0)

    @property
    def custom_calls(self) -> int:
        return self.text.count(" custom-call(")

    def _number(self, key, *, fresh: bool = False) -> tuple[int, bool]:
        new = fresh or key not in self._numbers
        if new:
            self._numbers[key] = len(self._numbers)
        return self._numbers[key], new

    def _walk(self, name: str, arguments, loop: Loop, times: int):
        """The value of a computation, its operations counted into `loop`."""
        values: dict = {}
        value = None
        for name_, shape, kind, rest in self._computations[name]:
            inside = rest.split(")")[0]
            given = [values[x] for x in re.findall(r"%([\w.\-]+)", inside)]
            if kind == "parameter":
                i = int(inside)
                outer = arguments is None
                value = _leaf(self, shape, (name, i)) if outer else arguments[i]
            elif kind == "tuple":
                value = tuple(given)
            elif kind == "get-tuple-element":
                at = int(re.search(r"index=(\d+)", rest).group(1))
                value = (
                    given[0][at] if isinstance(given[0], tuple) else self._number((given[0], at))[0]
                )
            elif kind in ("fusion", "call"):
                value = self._walk(_CALLED.search(rest).group(1), given, loop, times)
            elif kind == "conditional":
                value = self._branches(rest, given, loop, times)
            elif kind == "while":
                value = self._loop(rest, given[0], loop, times)
            elif kind in _SAME:
                value = given[0]
            else:
                value = self._operation(name_, shape, kind, inside, rest, given, loop, times)
            values[name_] = value
        return value

    def _operation(self, name, shape, kind, inside, rest, given, loop, times):
        numbers = sorted(map(str, given)) if kind in ("add", "multiply") else map(str, given)
        literal = inside if kind == "constant" and "..." not in inside else ""
        unknown = name if kind == "constant" and not literal else ""
        after = _NOISE.sub("", rest[len(inside) + 1 :])
        key = (kind, *numbers, literal, unknown, "" if kind in ARITHMETIC else after)
        number, new = self._number(key)
        share = _elements(shape) / self.size
        if kind in ARITHMETIC and share >= 1 and shape.startswith("f"):
            loop.computed[kind] += share * times
            if new:
                loop.distinct[kind] += share * times
        return _leaf(self, shape, ("of", number)) if shape.startswith("(") else number

    def _branches(self, rest, given, loop, times):
        listed = re.search(r"branch_computations=\{([^}]*)\}", rest)
        names = re.findall(r"%([\w.\-]+)", listed.group(1)) if listed else _CALLED.findall(rest)
        ends = [self._walk(x, [one], loop, times) for x, one in zip(names, given[1:], strict=True)]
        return _joined(self, ends, ("branch", given[0]))

    def _loop(self, rest, begin, loop, times):
        body = re.search(r"body=%([\w.\-]+)", rest).group(1)
        found = _TRIPS.search(rest)
        trips = int(found.group(1)) if found else None
        self.trips.append(trips)
        inner, factor = (loop, times * trips) if trips else (Loop(None), 1)
        kept = _passed_on(self._computations[body])
        carried = tuple(
            x if i in kept else _leaf(self, "(" if isinstance(x, tuple) else "f", (body, i), x)
            for i, x in enumerate(begin)
        )
        value = self._walk(body, [carried], inner, factor)
        if not trips:
            self.loops.append(inner)
        return value


def _parsed(text: str) -> tuple[dict[str, list], str]:
    computations: dict[str, list] = {}
    entry, into = "", None
    for line in text.splitlines():
        head = _HEAD.match(line)
        if head:
            into = computations[head.group(2)] = []
            entry = head.group(2) if head.group(1) else entry
        elif into is not None and (found := _LINE.match(line)):
            into.append(found.groups())
    return computations, entry


def _passed_on(body: list) -> set[int]:
    """Which of the values that a loop carries it leaves as they are."""
    taken = {
        name: int(re.search(r"index=(\d+)", rest).group(1))
        for name, _, kind, rest in body
        if kind == "get-tuple-element"
    }
    last = re.findall(r"%([\w.\-]+)", body[-1][3].split(")")[0])
    return {i for i, name in enumerate(last) if taken.get(name) == i}


def _leaf(program: Program, shape: str, key, like=None):
    """A value of which nothing is known; of a tuple, its parts."""
    if not shape.startswith("("):
        return program._number(key)[0]
    count = len(like) if like is not None else len(re.findall(r"\w+\[[\d,]*\]", shape))
    return tuple(program._number((*key, i))[0] for i in range(count))


def _joined(program: Program, ends: list, key):
    if isinstance(ends[0], tuple):
        parts = zip(*ends, strict=True)
        return tuple(_joined(program, list(part), key) for part in parts)
    return program._number((*key, *ends))[0]


def _elements(shape: str) -> int:
    found = re.search(r"\[([\d,]*)\]", shape)
    return math.prod(int(n) for n in found.group(1).split(",") if n) if found else 0
