"""A symplectic method of even order for θ̇ = v, v̇ = f(θ)."""

from collections.abc import Callable
from typing import Any, ClassVar

import diffrax as dfx
import jax

# Yoshida's triple jump for order 4, and his solution A for order 6: steps of Störmer and
# Verlet's method of these lengths and, mirrored, back again.
_OUTER = {
    2: (),
    4: (1.3512071919596578,),
    6: (0.784513610477560, 0.235573213359357, -1.17767998417887),
}


class Symplectic(dfx.AbstractSolver):
    """Störmer and Verlet's method composed to order 2, 4 or 6, in constant steps.

    Of order `degree`; `simulate` wants a `dt0` with it.  Takes a pair of terms, of θ̇(v) and
    v̇(θ), as diffrax's `SemiImplicitEuler` does.  The
    energy error stays bounded for exponentially long times; the phase error grows like t.

    Hairer, Lubich, Wanner, *Geometric Numerical Integration*, §II.4, §V.3.2.
    """

    degree: int = 4

    term_structure: ClassVar = (dfx.AbstractTerm, dfx.AbstractTerm)
    interpolation_cls: ClassVar[Callable] = dfx.LocalLinearInterpolation

    def __check_init__(self):
        if self.degree not in _OUTER:
            raise ValueError(f"Argument `degree` must be 2, 4 or 6, but got {self.degree}.")

    def order(self, terms: Any) -> int:
        return self.degree

    def init(self, terms, t0, t1, y0, args):
        return None

    def step(self, terms, t0, t1, y0, args, solver_state, made_jump):
        del solver_state, made_jump
        drift, kick = terms
        theta, v = y0
        outer = _OUTER[self.degree]
        stages = (*outer, 1 - 2 * sum(outer), *outer[::-1])
        # Stages are fractions of the step: differences of rounded times would add up.
        of_drift, of_kick = drift.contr(t0, t1), kick.contr(t0, t1)
        t = t0
        for stage in stages:
            after = t + stage * (t1 - t0)
            v = _moved(v, kick.vf_prod(t, theta, args, 0.5 * stage * of_kick))
            theta = _moved(theta, drift.vf_prod(t, v, args, stage * of_drift))
            v = _moved(v, kick.vf_prod(after, theta, args, 0.5 * stage * of_kick))
            t = after
        y1 = theta, v
        return y1, None, {"y0": y0, "y1": y1}, None, dfx.RESULTS.successful

    def func(self, terms, t0, y0, args):
        drift, kick = terms
        theta, v = y0
        return drift.vf(t0, v, args), kick.vf(t0, theta, args)


def _moved(y, change):
    return jax.tree.map(lambda y, change: y + change, y, change)
