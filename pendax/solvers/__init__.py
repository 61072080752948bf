"""`Symplectic(degree)`, for `simulate(…, solver=…, dt0=…)`; all of diffrax's do as well."""

from ._integrate import integrate as integrate
from ._symplectic import Symplectic as Symplectic
