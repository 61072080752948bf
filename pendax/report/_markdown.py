"""The report as Markdown: a row a claim, a row a misprint."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._claim import Check, Claim, Erratum, Proof, Verdict, verdict

_SHOWN = 4  # values of an array that are printed


def report(
    claims: Sequence[Claim],
    errata: Sequence[Erratum],
    link: Callable[[str], str | None],
    progress: Callable[[str], object] = lambda name: None,
) -> str:
    """Both sections.  `link` gives a figure's file, or `None` where there is none; `progress`
    hears of each id before it is checked."""
    by_id = {erratum.id: erratum for erratum in errata}
    rows: list[tuple[Claim, Check, Verdict]] = []
    for claim in claims:
        progress(claim.id)
        check = claim.check()
        rows.append((claim, check, verdict(claim, check, by_id)))
    proofs: list[tuple[Erratum, Proof | None]] = []
    for erratum in errata:
        progress(erratum.id)
        proofs.append((erratum, erratum.proof and erratum.proof()))
    words = [v.word for _, _, v in rows]
    counts = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(sorted(words)))
    proved = sum(proof is not None and proof.holds() for _, proof in proofs)
    wording = sum(proof is None for _, proof in proofs)
    return "\n".join(
        [
            "# What the sources claim, and what is found",
            "",
            "S2 is M. Suzuki and I. S. Suzuki, *Physics of simple pendulum* (2008), whose sections "
            "are given; S0 is *Dinámica Péndulo Simple «solución exacta»* (2021). Every number "
            "here was computed when this file was written.",
            "",
            f"{len({claim.id for claim, _, _ in rows})} entries, {len(rows)} claims: {counts}. "
            f"{len(proofs)} misprints: {proved} proved by numbers, {wording} of wording.",
            "",
            "*Claimed* is what the source prints, or its formula evaluated; *found* comes another "
            "way; of more than ten values those farthest apart are shown. *Digits* are those to "
            "which the two agree, of the largest value compared. *Corrected*: the statement is "
            "wrong; *misprint*: it is printed wrong. What is right is below, under the name given.",
            "",
            _line("where", "the source says", "compared", "claimed", "found", "digits",
                  "verdict", "figures"),
            _line(*["---"] * 8),
            *(_row(*row, link) for row in rows),
            "",
            "## Misprints",
            "",
            "Each printed value is wrong, and each corrected one right, beside a truth that "
            "comes from neither.",
            "",
            _line("", "where", "printed", "correct", "as printed", "corrected", "truth", "proved"),
            _line(*["---"] * 8),
            *(_erratum(*row) for row in proofs),
            "",
        ]
    )  # fmt: skip


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
        shown = [np.ravel(np.broadcast_to(x, np.broadcast_shapes(*map(np.shape, proof))))
                 for x in proof[:3]]  # fmt: skip
        values = [_numbers(x[:_SHOWN], x.size > _SHOWN) for x in shown]
        values.append("yes" if proof.holds() else "**no**")
    return _line(f'<a id="{erratum.id.lower()}"></a>{erratum.id}', erratum.where, erratum.printed,
                 erratum.correct, *values)  # fmt: skip


def _numbers(values: ArrayLike, more: bool = False) -> str:
    flat = np.ravel(np.asarray(values, float))
    return ", ".join(_number(x) for x in flat) + (", …" if more else "")


def _number(x: float) -> str:
    return f"{x:.0f}" if x == np.round(x) and abs(x) < 1e6 else f"{x:.9g}"


def _line(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def ids(claims: Iterable[Claim]) -> list[str]:
    """The entries answered, each once, in order."""
    return list(dict.fromkeys(claim.id for claim in claims))
