"""Elliptic integrals and Jacobi functions in pure JAX.

Names and meanings are SciPy's where SciPy has the function.  The parameter is
m = k^2 throughout, never the modulus k; m1 = 1 - m is its complement, for m so near
to 1 that 1 - m has lost its digits.
"""

from ._arcsn import arcsn as arcsn
from ._complete import ellipe as ellipe
from ._complete import ellipk as ellipk
from ._complete import ellipkm1 as ellipkm1
from ._jacobi import ellipj as ellipj
from ._nome import ellipnome as ellipnome
from ._series import Approximation as Approximation
from ._series import ellipe_series as ellipe_series
from ._series import ellipk_series as ellipk_series
