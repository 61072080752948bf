"""The report as Markdown: a row a claim, a row a misprint."""

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._claim import Check, Claim, Erratum, Proof, Verdict, verdict

_SHOWN = 4  # values of an array that are printed
_CLAIM_COLUMNS = (
    "where", "the source says", "compared", "claimed", "found", "digits", "verdict", "figures",
)  # fmt: skip
_ERRATUM_COLUMNS = (
    "", "where", "printed", "correct", "compared", "as printed", "corrected", "truth", "proved",
)  # fmt: skip
_PREFACE = (
    "S2 is M. Suzuki and I. S. Suzuki, *Physics of simple pendulum* (2008), S0 is *Dinámica "
    "Péndulo Simple «solución exacta»* (2021). An entry is a section or figure: Fig6 is the "
    "figure of that number, 6a-i those of chapter 6. The numbers under *claimed* and *found*, and "
    "those beside a misprint, were computed when this file was written.",
    "",
    "*Claimed* is what the source prints, or its formula evaluated; *found* comes another way; of "
    "more than ten values those farthest apart are shown. *Digits*: how many of the largest value "
    "are the same; it is the source that says how many it means (*around*, *almost*), so few can "
    "be enough, and where a 0 is claimed there are none. *Corrected*: the statement does not hold; "
    "*misprint*: the formula does not, as printed; *n of N hold*: for that many of the values "
    "compared. A claim that is reproduced may still cite a misprint beside it, or a remark.",
)
_MISPRINTS = (
    "Each printed value is wrong, and each corrected one right, beside a truth that comes from "
    "neither. A *remark* is about what is right as its source uses it, or incomplete: there the "
    "numbers are of a case that it leaves out.",
)


def report(
    sections: Mapping[str, Sequence[Claim]],
    errata: Sequence[Erratum],
    link: Callable[[str], str | None],
    progress: Callable[[str], object] = lambda name: None,
) -> str:
    """Claims section by section, and the misprints.  `link` gives a figure's file, or `None`
    where there is none; `progress` hears of each id before it is checked."""
    by_id = {erratum.id: erratum for erratum in errata}
    proofs: dict[str, Proof] = {}
    for erratum in errata:
        progress(erratum.id)
        if erratum.proof:
            proofs[erratum.id] = erratum.proof()
    proved = {name: proof.holds() for name, proof in proofs.items()}
    tables, words = [], []
    for title, claims in sections.items():
        tables += ["", f"## {title}", "", *_head(_CLAIM_COLUMNS)]
        for claim in claims:
            progress(claim.id)
            check = claim.check()
            found = verdict(claim, check, by_id, proved)
            words.append(found.word)
            tables.append(_row(claim, check, found, link))
    counts = ", ".join(f"{words.count(word)} {word}" for word in sorted(set(words)))
    entries = ids(claim for claims in sections.values() for claim in claims)
    return "\n".join(
        [
            "# What the sources claim, and what is found",
            "",
            f"{len(entries)} entries, {len(words)} claims: {counts}. {len(errata)} misprints and "
            f"remarks: {sum(proved.values())} proved by numbers, {len(errata) - len(proofs)} of "
            "wording.",
            "",
            *_PREFACE,
            *tables,
            "",
            "## Misprints and remarks",
            "",
            *_MISPRINTS,
            "",
            *_head(_ERRATUM_COLUMNS),
            *(_erratum(erratum, proofs.get(erratum.id)) for erratum in errata),
            "",
        ]
    )


def _row(claim: Claim, check: Check, found: Verdict, link: Callable[[str], str | None]) -> str:
    claimed, value = _worst(check)
    word = found.word
    if 0 < found.agreeing < found.compared:
        word += f" ({found.agreeing} of {found.compared} hold)"
    if claim.errata:
        word += "; " + ", ".join(f"[{e}](#{e.lower()})" for e in claim.errata)
    figures = ((name, link(name)) for name in claim.figures)
    return _line(
        claim.id,
        claim.says,
        claim.quantity,
        _numbers(claimed),
        _numbers(value),
        _digits(found),
        word,
        ", ".join(f"[{name}]({file})" if file else name for name, file in figures),
    )


def _digits(found: Verdict) -> str:
    if found.word != "reproduced":
        return ""
    return "exact" if found.digits >= 15.95 else f"{found.digits:.1f}"


def _worst(check: Check) -> tuple[np.ndarray, np.ndarray]:
    """Both sides as they are where they are few, else where they are farthest apart."""
    claimed, found = np.broadcast_arrays(
        np.asarray(check.claimed, float), np.asarray(check.found, float)
    )
    if claimed.size <= 2 * _SHOWN + 2:
        return claimed, found
    off = np.nan_to_num(np.abs(claimed - found), nan=np.inf).ravel()
    at = int(np.argmax(off))
    return claimed.ravel()[at : at + 1], found.ravel()[at : at + 1]


def _erratum(erratum: Erratum, proof: Proof | None) -> str:
    if proof is None:
        values = ["", "", "", "wording"]
    else:
        shape = np.broadcast_shapes(*(np.shape(x) for x in proof))
        shown = [np.ravel(np.broadcast_to(x, shape)) for x in proof[:3]]
        values = [_numbers(x[:_SHOWN], x.size > _SHOWN) for x in shown]
        yes = "remark" if erratum.kind == "remark" else "yes"
        values.append(yes if proof.holds() else "**no**")
    name = f'<a id="{erratum.id.lower()}"></a>{erratum.id}'
    texts = (erratum.where, erratum.printed, erratum.correct, erratum.compared)
    return _line(name, *texts, *values)


def _head(columns: Sequence[str]) -> tuple[str, str]:
    return _line(*columns), _line(*["---"] * len(columns))


def _numbers(values: ArrayLike, more: bool = False) -> str:
    flat = np.ravel(np.asarray(values, float))
    return ", ".join(_number(x) for x in flat) + (", …" if more else "")


def _number(x: float) -> str:
    if x == np.round(x) and abs(x) < 1e6:
        return f"{x:.0f}"
    return f"{x:.9g}" if abs(x) >= 1e-12 else f"{x:.1e}"


def _line(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def ids(claims: Iterable[Claim]) -> list[str]:
    """The entries answered, each once, in order."""
    return list(dict.fromkeys(claim.id for claim in claims))
