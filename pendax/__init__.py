"""The pendulum beyond small angles, exact and differentiable, in JAX.

    the scene        Pendulum, Pendulum.from_si, SampledTorque, energy, potential,
                     velocity, tension, slack_angle, fixed_points
    its motion       simulate, condition, time_to, frequency, period, amplitude
    its end          settle, retrapping_torque, mean_velocity, critical_torque,
                     well_boundaries
    its spectrum     harmonics, power_spectrum
    its expansions   period_series, small_angle, critical_law, fit_critical_law
    its geometry     geometry
    the junction     JosephsonJunction, iv_curve, FLUX_QUANTUM
    data             cycles, fit_frequency, fit_trajectory, fit_junction
    elsewhere        pendax.special, pendax.solvers, pendax.plot, pendax.figures,
                     pendax.report

Angles are in radians; `help` of each name has the rest.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import figures as figures
    from . import plot as plot
    from . import report as report
    from . import solvers as solvers
    from . import special as special
    from ._condition import condition as condition
    from ._critical import CriticalLaw as CriticalLaw
    from ._critical import CriticalSide as CriticalSide
    from ._critical import critical_law as critical_law
    from ._critical import fit_critical_law as fit_critical_law
    from ._energy import energy as energy
    from ._energy import potential as potential
    from ._energy import slack_angle as slack_angle
    from ._energy import tension as tension
    from ._energy import velocity as velocity
    from ._exact import amplitude as amplitude
    from ._exact import frequency as frequency
    from ._exact import period as period
    from ._fixed_points import FixedPointKind as FixedPointKind
    from ._fixed_points import FixedPoints as FixedPoints
    from ._fixed_points import fixed_points as fixed_points
    from ._geometry import Geometry as Geometry
    from ._geometry import geometry as geometry
    from ._harmonics import Harmonics as Harmonics
    from ._harmonics import harmonics as harmonics
    from ._pendulum import Pendulum as Pendulum
    from ._results import Result as Result
    from ._simulate import Trajectory as Trajectory
    from ._simulate import simulate as simulate
    from ._small_angle import SmallAngle as SmallAngle
    from ._small_angle import period_series as period_series
    from ._small_angle import small_angle as small_angle
    from ._spectrum import power_spectrum as power_spectrum
    from ._time_to import time_to as time_to
    from ._torque import SampledTorque as SampledTorque
    from .fate import Settled as Settled
    from .fate import critical_torque as critical_torque
    from .fate import mean_velocity as mean_velocity
    from .fate import retrapping_torque as retrapping_torque
    from .fate import settle as settle
    from .fate import well_boundaries as well_boundaries
    from .fit import Cycles as Cycles
    from .fit import Fit as Fit
    from .fit import cycles as cycles
    from .fit import fit_frequency as fit_frequency
    from .fit import fit_junction as fit_junction
    from .fit import fit_trajectory as fit_trajectory
    from .josephson import FLUX_QUANTUM as FLUX_QUANTUM
    from .josephson import Evolution as Evolution
    from .josephson import IVCurve as IVCurve
    from .josephson import JosephsonJunction as JosephsonJunction
    from .josephson import iv_curve as iv_curve

# Where the public names are.  A room is loaded when the first of its names is asked for: a sweep
# of frequencies has no use for the fates of driven pendulums, nor matplotlib for either.
_ROOMS = {
    "._condition": "condition",
    "._critical": "CriticalLaw CriticalSide critical_law fit_critical_law",
    "._energy": "energy potential slack_angle tension velocity",
    "._exact": "amplitude frequency period",
    "._fixed_points": "FixedPointKind FixedPoints fixed_points",
    "._geometry": "Geometry geometry",
    "._harmonics": "Harmonics harmonics",
    "._pendulum": "Pendulum",
    "._results": "Result",
    "._simulate": "Trajectory simulate",
    "._small_angle": "SmallAngle period_series small_angle",
    "._spectrum": "power_spectrum",
    "._time_to": "time_to",
    "._torque": "SampledTorque",
    ".fate": "Settled critical_torque mean_velocity retrapping_torque settle well_boundaries",
    ".fit": "Cycles Fit cycles fit_frequency fit_junction fit_trajectory",
    ".josephson": "FLUX_QUANTUM Evolution IVCurve JosephsonJunction iv_curve",
}
_HOME = {name: room for room, names in _ROOMS.items() for name in names.split()}
_MODULES = ("figures", "plot", "report", "solvers", "special")


def __getattr__(name: str):
    if name in _MODULES:
        return import_module(f".{name}", __name__)
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOME[name], __name__), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOME, *_MODULES})
