"""Physical parameters from measurements."""

from ._cycles import Cycles as Cycles
from ._cycles import cycles as cycles
from ._fit import Fit as Fit
from ._frequency import fit_frequency as fit_frequency
from ._junction import fit_junction as fit_junction
from ._loop import Crossings as Crossings
from ._loop import crossings as crossings
from ._loop import rising as rising
from ._trajectory import fit_trajectory as fit_trajectory
