"""Diffrax's solvers for the pendulum, and a symplectic one; loads diffrax."""

from ._integrate import integrate as integrate
from ._symplectic import Symplectic as Symplectic
