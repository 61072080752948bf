"""Matplotlib, one function a plot: each takes an `ax` and returns it."""

from ._critical import critical_approach as critical_approach
from ._critical import law_deviation as law_deviation
from ._fates import fate_map as fate_map
from ._fit import recorded_motion as recorded_motion
from ._fit import residuals as residuals
from ._frequency import frequency_curve as frequency_curve
from ._frequency import measured_cycles as measured_cycles
from ._geometry import construction as construction
from ._iv_curve import iv_curve as iv_curve
from ._iv_curve import measured_loop as measured_loop
from ._motion import energy_levels as energy_levels
from ._motion import phase_portrait as phase_portrait
from ._motion import separatrix as separatrix
from ._motion import time_series as time_series
from ._potential import potential_energy as potential_energy
from ._spectrum import spectrum as spectrum
from ._style import COLOURS as COLOURS
from ._style import DARK_COLOURS as DARK_COLOURS
from ._style import DARK_STYLE as DARK_STYLE
from ._style import STYLE as STYLE
from ._style import Look as Look
from ._style import colour_of as colour_of
from ._style import new_figure as new_figure
from ._style import shades as shades
from ._style import style as style
from ._work_precision import work_precision as work_precision
