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

# In the order of the sources.
CLAIMS: tuple[Claim, ...] = (
    *FORMULATION, *SWINGING, *ROTATING, *GEOMETRY, *NUMERICAL, *RESISTIVE, *DRIVEN, *APPENDIX,
    *SPANISH, *NOTES,
)  # fmt: skip
ERRATA: tuple[Erratum, ...] = (*FORMULAS, *STATEMENTS, *SPANISH_ERRATA, *TEXT)
