"""Every figure of the sources by its number there, in the package's own look."""

from ._animation import ANIMATIONS as ANIMATIONS
from ._animation import Animation as Animation
from ._critical import CRITICAL
from ._critical import critical_entries as critical_entries
from ._driven import DRIVEN
from ._elliptic import ELLIPTIC
from ._entry import Entry as Entry
from ._formulation import FORMULATION
from ._geometry import GEOMETRY
from ._junction import JUNCTION
from ._motion import MOTION
from ._phase import PHASE
from ._resistive import RESISTIVE
from ._spectra import SPECTRA

_ALL = (
    *FORMULATION, *MOTION, *SPECTRA, *PHASE, *CRITICAL, *GEOMETRY, *RESISTIVE, *DRIVEN, *JUNCTION,
    *ELLIPTIC,
)  # fmt: skip
FIGURES: dict[str, Entry] = {entry.name: entry for entry in _ALL}
