"""Elliptic integrals and Jacobi functions in pure JAX.

Names and meanings are SciPy's where SciPy has the function.  The parameter is
m = k^2 throughout, never the modulus k; m1 = 1 - m is its complement, for m so near
to 1 that 1 - m has lost its digits.
"""

from ._arcsn import arcsn as arcsn
from ._carlson import elliprc as elliprc
from ._carlson import elliprd as elliprd
from ._carlson import elliprf as elliprf
from ._carlson import elliprg as elliprg
from ._complete import ellipe as ellipe
from ._complete import ellipk as ellipk
from ._complete import ellipkm1 as ellipkm1
from ._incomplete import ellipeinc as ellipeinc
from ._incomplete import ellipkinc as ellipkinc
from ._jacobi import ellipj as ellipj
from ._nome import ellipnome as ellipnome
from ._series import Approximation as Approximation
from ._series import ellipe_series as ellipe_series
from ._series import ellipk_series as ellipk_series
from ._third import ellippi as ellippi
from ._third import ellippiinc as ellippiinc
from ._third import elliprj as elliprj
