"""Matplotlib, one function a plot: each takes an `ax` and returns it."""

from ._critical import critical_approach as critical_approach
from ._critical import law_deviation as law_deviation
from ._fit import recorded_motion as recorded_motion
from ._fit import residuals as residuals
from ._frequency import frequency_curve as frequency_curve
from ._frequency import measured_cycles as measured_cycles
from ._iv_curve import iv_curve as iv_curve
from ._iv_curve import measured_loop as measured_loop
from ._style import COLOURS as COLOURS
from ._style import STYLE as STYLE
from ._style import new_figure as new_figure
