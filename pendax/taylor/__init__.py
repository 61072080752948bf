"""Taylor series of the motion itself, for terms that don't depend on time, or simply.

τ may be a sine, a function that shows its series, or samples that straight lines join; dry friction
is a torque that is switched.
"""

from ._analytic import Analytic as Analytic
from ._analytic import analytic as analytic
from ._averaged import averaged as averaged
from ._columns import by_columns as by_columns
from ._columns import no_tangent as no_tangent
from ._march import March as March
from ._march import budget as budget
from ._march import marched as marched
from ._march import with_derivatives as with_derivatives
from ._overdamped import is_overdamped as is_overdamped
from ._overdamped import overdamped as overdamped
from ._overdamped import strength as strength
from ._series import Scene as Scene
from ._series import Sine as Sine
from ._series import State as State
from ._series import since as since
from ._step import Method as Method
from ._step import order_for as order_for
from ._step import polynomial as polynomial
from ._step import taylor as taylor
from ._switched import advanced as advanced
from ._switched import begun as begun
