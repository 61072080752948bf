"""The README's tables and the numbers in its sentences, out of the results files.

A block of the README begins with `<!-- TOPIC -->` and ends with `<!-- end TOPIC -->`; what is
between is written here and nowhere else.
"""

import re
from collections.abc import Callable
from pathlib import Path

from . import results

README = Path(__file__).parent.parent / "README.md"
Tables = results.Tables


def renew() -> None:
    """Writes the blocks of all topics that have results."""
    README.write_text(renewed(README.read_text(encoding="utf-8")), encoding="utf-8")


def renewed(text: str) -> str:
    """The README's text with its blocks written again."""

    def block(found: re.Match) -> str:
        name = found[1]
        content = results.read(name)
        return f"<!-- {name} -->\n{BLOCKS[name](content['tables'])}\n<!-- end {name} -->"

    return re.sub(r"<!-- (\w+) -->.*?<!-- end \1 -->", block, text, flags=re.DOTALL)


def machine(name: str) -> str:
    content = results.read(name)
    on, versions = content["machine"], content["versions"]
    return f"{on['cores']} cores of {on['processor']}, JAX {versions['jax']}"


def free(tables: Tables) -> str:
    return front("free", tables, "the closed form")


def damped(tables: Tables) -> str:
    bars = {row["bar"]: row for row in tables["bars"]}
    random = next(row for name, row in bars.items() if name.startswith("random scenes: largest"))
    slopes = next(row for name, row in bars.items() if name.startswith("gradients"))
    scenes = tables["random scenes"]
    return (
        f"{front('damped', tables, '`simulate`')}\n\n"
        f"Of {scenes[0]['scenes']} random scenes at {len(scenes)} tolerances none was off by more "
        f"than {number(random['measured'])} times tolerance × (1 + max|y|) (1 + κ), and no "
        f"gradient by more than {number(slopes['measured'])} of its scale."
    )


def gradients(tables: Tables) -> str:
    return front("gradients", tables, "pendax")


def front(name: str, tables: Tables, ours: str) -> str:
    """What each peer reaches, at which run time, and what we take to be as exact; the diagram."""
    lines = [
        {
            "problem": row["problem"],
            "peer": row["peer"],
            "its least error": row["its least error"],
            "in µs a lane": row["µs"],
            f"{ours}, no less exact, in µs": row["pendax there"],
        }
        for row in tables["at each peer's least error"]
    ]
    return "\n\n".join([
        results.markdown(lines),
        f"![Error against run time](benchmarks/results/{name}.png)",
        losses(tables),
    ])  # fmt: skip


def losses(tables: Tables) -> str:
    """Where a peer is ahead, in words."""
    rows = tables.get("losses", [])
    if not rows:
        return "No peer was ahead anywhere."
    return "\n".join(["Where a peer is ahead:", "", *(f"- {_loss(row)}" for row in rows)])


def _loss(row: results.Row) -> str:
    where = row.get("problem") or row.get("where")
    if row["ratio"]:
        spread = f" ({row['from']:.2g} to {row['to']:.2g})" if row.get("from") is not None else ""
        how = f"takes {row['ratio']:.2g}{spread} of our time"
    else:
        how = f"reaches {row['error']:.1g}, which we do not"
    return f"{where}: {row['peer']} {how}. {row['why']}"


def number(value: float) -> str:
    return results.shown(float(value))


BLOCKS: dict[str, Callable[[Tables], str]] = {
    "free": free,
    "damped": damped,
    "gradients": gradients,
}
