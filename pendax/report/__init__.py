"""Every claim of the sources beside what is found, and every misprint with its proof."""

from ._appendix import CLAIMS as APPENDIX
from ._claim import Check as Check
from ._claim import Claim as Claim
from ._claim import Erratum as Erratum
from ._claim import Proof as Proof
from ._claim import verdict as verdict
from ._driven import CLAIMS as DRIVEN
from ._errata_formulas import ERRATA as FORMULAS
from ._errata_spanish import ERRATA as SPANISH_ERRATA
from ._errata_statements import ERRATA as STATEMENTS
from ._errata_text import ERRATA as TEXT
from ._formulation import CLAIMS as FORMULATION
from ._geometry import CLAIMS as GEOMETRY
from ._markdown import ids as ids
from ._markdown import report as report
from ._numerical import CLAIMS as NUMERICAL
from ._resistive import CLAIMS as RESISTIVE
from ._rotating import CLAIMS as ROTATING
from ._spanish import CLAIMS as SPANISH
from ._spanish_notes import CLAIMS as NOTES
from ._swinging import CLAIMS as SWINGING

SECTIONS: dict[str, tuple[Claim, ...]] = {
    "S2, chapters 1 and 2: formulation": FORMULATION,
    "S2, chapter 2: swinging": SWINGING,
    "S2, chapter 3: turning over": ROTATING,
    "S2, chapter 4: geometry": GEOMETRY,
    "S2, chapters 5, 6 and 9: by a solver, and Fourier's way": NUMERICAL,
    "S2, chapter 7: resistance": RESISTIVE,
    "S2, chapter 8: a constant torque, and the Josephson junction": DRIVEN,
    "S2, appendices": APPENDIX,
    "S0, sections 1 to 4": SPANISH,
    "S0, section 5": NOTES,
}
CLAIMS: tuple[Claim, ...] = tuple(claim for claims in SECTIONS.values() for claim in claims)
ERRATA: tuple[Erratum, ...] = (*FORMULAS, *STATEMENTS, *SPANISH_ERRATA, *TEXT)
