"""Where it ends: wells, retrapping, running."""

from ._boundaries import critical_torque as critical_torque
from ._boundaries import well_boundaries as well_boundaries
from ._mean_velocity import mean_velocity as mean_velocity
from ._retrapping import retrapping_torque as retrapping_torque
from ._settle import Settled as Settled
from ._settle import settle as settle
