"""The Josephson junction in SI units: its pendulum, its voltage over time, its I–V curve."""

from ._iv_curve import IVCurve as IVCurve
from ._iv_curve import iv_curve as iv_curve
from ._junction import FLUX_QUANTUM as FLUX_QUANTUM
from ._junction import REDUCED as REDUCED
from ._junction import Evolution as Evolution
from ._junction import JosephsonJunction as JosephsonJunction
