"""A claim of a source, what is found, and the verdict; a misprint, and its proof."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Check(NamedTuple):
    """What a source claims and what is found, numbers or arrays that broadcast, and how far
    apart they may be, absolutely: the precision to which the source states it.  `corrected`:
    what the erratum puts in the place of a claim that does not hold, where it is a number."""

    claimed: ArrayLike
    found: ArrayLike
    tolerance: ArrayLike
    corrected: ArrayLike | None = None

    def agrees(self) -> np.ndarray:
        """Whether each claimed value is the one found."""
        claimed, found = np.asarray(self.claimed, float), np.asarray(self.found, float)
        return np.asarray((claimed == found) | (np.abs(claimed - found) <= self.tolerance))


@dataclass(frozen=True)
class Claim:
    """One claim: the `id` of the list of claims that it answers (several may share one), the
    section or figure, what the source `says`, the `quantity` compared, and the function that
    compares it; the `figures` that show it, the `errata` that correct it."""

    id: str
    says: str
    quantity: str
    check: Callable[[], Check]
    figures: tuple[str, ...] = ()
    errata: tuple[str, ...] = ()


class Proof(NamedTuple):
    """The printed value, the corrected one, and the truth found by another way, with the
    distance below which two of them are the same."""

    printed: ArrayLike
    corrected: ArrayLike
    truth: ArrayLike
    tolerance: ArrayLike

    def holds(self) -> bool:
        """Whether the printed value is wrong and the corrected one right, everywhere."""
        wrong = Check(self.printed, self.truth, self.tolerance).agrees()
        right = Check(self.corrected, self.truth, self.tolerance).agrees()
        return bool(not wrong.any() and right.all())


# A remark: right as the source uses it, or incomplete; its proof shows where it ends.
Kind = Literal["formula", "statement", "program", "remark", "text"]


@dataclass(frozen=True)
class Erratum:
    """What is `printed` where, what is `correct`, the quantity `compared` and the proof; `None`
    for a slip of wording or numbering, which no number can prove."""

    id: str
    kind: Kind
    where: str
    printed: str
    correct: str
    proof: Callable[[], Proof] | None
    compared: str = ""


class Verdict(NamedTuple):
    """The outcome of a claim: in a word, how many of its values agree, and to how many digits
    the worst of those that do."""

    word: Literal["reproduced", "corrected", "misprint", "unexplained"]
    agreeing: int
    compared: int
    digits: float


def verdict(
    claim: Claim, check: Check, errata: Mapping[str, Erratum], proved: Mapping[str, bool]
) -> Verdict:
    """Reproduced where every value agrees; else by the kind of the errata cited, if their proofs
    hold and, where a corrected value is given, it is the one found."""
    agrees = check.agrees()
    claimed, found = np.broadcast_arrays(
        np.asarray(check.claimed, float), np.asarray(check.found, float)
    )
    agrees = np.broadcast_to(agrees, claimed.shape)
    explained = check.corrected is None or check._replace(claimed=check.corrected).agrees().all()
    kinds = {errata[name].kind for name in claim.errata}
    if agrees.all():
        word = "reproduced"
    elif not kinds or not explained or not all(proved.get(name, True) for name in claim.errata):
        word = "unexplained"
    else:
        word = "corrected" if kinds & {"statement", "program", "remark"} else "misprint"
    off = np.abs(claimed - found)[agrees & (claimed != found)]
    size = max(np.max(np.abs(x[np.isfinite(x)]), initial=0.0) for x in (claimed, found)) or 1.0
    digits = -np.log10(np.max(off, initial=0.0) / size) if off.size else np.inf
    return Verdict(word, int(agrees.sum()), int(agrees.size), float(min(digits, 16.0)))
