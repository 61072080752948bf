"""The running state: a periodic orbit θ̇ = w(θ), whose mean velocity is a junction's voltage.

    w w' = τ − ε sin θ − β w,    w(θ + 2π) = w(θ),    T = ∫ dθ / w.

It is solved for in the angle, where it has the same smooth shape at every damping: in time an
overdamped orbit is stiff, and one near a saddle lasts for ever.  Radau's collocation on
panels that are graded towards the angle where w is smallest; Newton's method, its linear
equations eliminated panel by panel.  What closes them is, of two conditions that say the
same, the one that has digits: w(2π) = w(0) where a turn forgets how it began, ∫ w dθ = 2π τ/β
where it does not.

Rejected: shooting in time, for the above; Fourier series, which need 1/w of terms.
"""

from functools import cache, partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float
from numpy.polynomial import legendre

from .._arrays import common, widened
from .._pendulum import Pendulum
from ._implicit import implicit
from ._retrapping import retrapping
from ._scene import require_damped

FloatArray = Float[Array, "..."]
Scalar = Float[Array, ""]
Nodes = Float[Array, "panels nodes"]

_PANELS, _NODES = 32, 10
_MOST = 100  # of Newton's steps: 4 to 12 are usual, 40 where τ and β touch τ_r and β*


class Grid(NamedTuple):
    """Where w is known: at angles x(s) from its smallest; fixed when w is differentiated."""

    tau: Scalar  # that it was made for
    force: Nodes  # τ − sin θ
    separatrix: Nodes  # 2 |sin(x/2)|, w of the free pendulum's
    finest: Scalar  # the smallest scale of x
    slope: Nodes  # dx/ds
    width: Scalar  # of a panel in s
    weight: Nodes  # dx of a node


def mean_velocity(pendulum: Pendulum) -> FloatArray:
    """The time-averaged θ̇ of the running state, rad/s; 0 at torques that don't sustain one.

    **Arguments:** a `pendulum` with damping and a constant torque, its leaves of shapes that
    broadcast.

    **Returns:** 2π/T, T the time of a turn; odd in τ; 0 for |τ| ≤ τ_r
    ([`retrapping_torque`][]); √(τ² − ε²)/β in the overdamped limit, τ/β far above ε; infinite
    for β = 0 (a traced one) with a torque.

    **Raises:** `ValueError` for β = `None` and for τ a function of time.  Where the iteration
    doesn't converge, NaN.

    **Accuracy:** 1e-13 of |v̄| + |τ ∂v̄/∂τ| + |β ∂v̄/∂β|, which is 1e-13 relative but near τ_r, where
    v̄ falls to 0 like 1/ln(τ − τ_r) and ∂v̄/∂τ grows without bound.  Derivatives of every mode
    and order by the implicit function theorem.  Suzuki & Suzuki §8.2, §8.3.
    """
    require_damped(pendulum, "its mean velocity")
    tau = 0.0 if pendulum.tau is None else pendulum.tau
    arrays = common(epsilon=pendulum.epsilon, beta=pendulum.beta, tau=tau)
    return widened(_mean_velocity)(*arrays)


@jax.jit
def _mean_velocity(epsilon: FloatArray, beta: FloatArray, tau: FloatArray) -> FloatArray:
    fine = (epsilon > 0) & (beta >= 0)
    root = jnp.sqrt(jnp.where(fine, epsilon, jnp.nan))
    arrays = (beta / root, tau / root / root)
    flat = (x.ravel() for x in jnp.broadcast_arrays(*arrays))
    return root * jax.vmap(of_unit)(*flat).reshape(root.shape)


def of_unit(beta: Scalar, tau: Scalar) -> Scalar:
    """That of ε = 1, either sign of τ."""
    size = jnp.abs(tau)
    running = (size > retrapping(beta)) & (beta > 0) & (size < jnp.inf)
    # Some other scene's where there is none.
    safe = jnp.where(running, beta, 1), jnp.where(running, size, 2)
    v = jnp.sign(tau) * _running(*safe)
    v = jnp.where(running, v, 0 * beta * tau)
    return jnp.where((beta == 0) & (size > 0), jnp.inf * jnp.sign(tau), v)


def _running(beta: Scalar, tau: Scalar) -> Scalar:
    grid = _grid(*lax.stop_gradient((beta, tau)))

    def find(p):
        return _solved(*p)

    def change(w, p, dp):
        grid, beta, tau = p
        _, moved = jax.jvp(partial(_residuals, grid, w), (beta, tau), dp[1:])
        return _eliminated(grid, w, beta, moved)

    w = implicit(find, change, (grid, beta, tau))
    return 2 * jnp.pi / jnp.sum(grid.weight / w)


def _grid(beta: Scalar, tau: Scalar) -> Grid:
    """Angles x = a sinh s around the saddle, or where τ ≥ 1 around the least force."""
    below = tau < 1
    gap = tau - retrapping(beta)
    # w is smallest, √gap or so, where it has least to fall from.
    a = jnp.clip(jnp.sqrt(gap / jnp.minimum(beta, 1)), 10 * jnp.finfo(tau.dtype).eps ** 0.5, 1)
    last = jnp.arcsinh(jnp.pi / a)
    width = 2 * last / _PANELS
    nodes, _, weights = (jnp.asarray(x, tau.dtype) for x in _radau())
    s = width * (jnp.arange(_PANELS, dtype=tau.dtype)[:, None] + nodes[None]) - last
    x, slope = a * jnp.sinh(s), a * jnp.cosh(s)
    kappa = jnp.sqrt(jnp.where(below, (1 - tau) * (1 + tau), 0))
    # τ − sin θ, without the difference of the two.
    bowl = 2 * jnp.sin(0.5 * x) ** 2
    force = jnp.where(below, kappa * jnp.sin(x) + tau * bowl, tau - 1 + bowl)
    weight = width * weights[None] * slope
    return Grid(tau, force, jnp.sqrt(2 * bowl), a, slope, width, weight)


def _solved(grid: Grid, beta: Scalar, tau: Scalar) -> Nodes:
    """Newton's method at torques that come down to `tau` from where it converges from a guess.

    Near τ_r the orbit shrinks towards the saddle with τ − τ_r, and its digits end before those
    of τ: the iteration ends as well where it no longer improves.
    """
    edge, enough = retrapping(beta), 0.5 * jnp.finfo(tau.dtype).eps ** 0.5

    def unfinished(carry):
        _, _, changed, before, steps = carry
        settled = (changed < enough) | ((changed < 1e-2) & (changed > 0.25 * before))
        return ~settled & (steps < _MOST)

    def step(carry):
        w, gap, before, _, steps = carry
        now = jnp.maximum(tau, edge + gap)
        change = _eliminated(grid, w, beta, _residuals(grid, w, beta, now))
        share = change / w
        # w stays positive.
        w = w * jnp.clip(1 + share, 0.1, 5)
        changed = jnp.max(jnp.abs(share))
        gap = jnp.where(changed < 0.6, gap / 100, gap)
        return w, gap, jnp.where(now > tau, jnp.inf, changed), before, steps + 1

    far = 0.3 * jnp.minimum(beta, 1)
    begin = _guess(grid, beta, jnp.maximum(tau, edge + far))
    inf = jnp.full_like(tau, jnp.inf)
    w, _, changed, *_ = lax.while_loop(unfinished, step, (begin, far, inf, inf, 0))
    return jnp.where(changed < 1e-2, w, jnp.nan)


def _guess(grid: Grid, beta: Scalar, tau: Scalar) -> Nodes:
    """The free pendulum's separatrix lifted or lowered to the mean τ/β, or the overdamped w."""
    mean, lift = tau / beta, grid.finest
    lowered = mean * (np.pi / 4 * grid.separatrix + lift / 2)
    lifted = jnp.hypot(lift, jnp.sqrt(jnp.maximum(mean * mean - 1.62, 0)))
    weak = jnp.where(mean < 4 / np.pi, lowered, jnp.hypot(grid.separatrix, lifted))
    strong = jnp.maximum(grid.force + (tau - grid.tau), 0) / beta + 1e-3 * mean
    return jnp.where(beta < 1, weak, strong)


class Residuals(NamedTuple):
    orbit: Nodes  # of w w' = τ − sin θ − β w, by s
    mean: Scalar  # of ∫ w dθ = 2π τ/β


def _residuals(grid: Grid, w: Nodes, beta: Scalar, tau: Scalar) -> Residuals:
    # Linear in τ at a given angle, whatever the grid was made for.
    force = grid.force + (tau - grid.tau)
    orbit = w * _by_s(grid, w) - grid.slope * (force - beta * w)
    return Residuals(orbit, jnp.sum(grid.weight * w) - 2 * np.pi * tau / beta)


def _by_s(grid: Grid, w: Nodes) -> Nodes:
    """dw/ds; w on the left of a panel is w on the right of the one before."""
    _, slopes, _ = (jnp.asarray(x, w.dtype) for x in _radau())
    left = jnp.roll(w[:, -1:], 1, axis=0)
    return (left * slopes[None, :, 0] + w @ slopes[:, 1:].T) / grid.width


def _eliminated(grid: Grid, w: Nodes, beta: Scalar, residuals: Residuals) -> Nodes:
    """The change of w that cancels the residuals to first order."""
    _, slopes, _ = (jnp.asarray(x, w.dtype) for x in _radau())
    # Each panel by itself: the change in it is own + per_left · (change on its left).
    diagonal = _by_s(grid, w) + grid.slope * beta
    matrix = diagonal[..., None] * jnp.eye(_NODES, dtype=w.dtype)[None]
    matrix = matrix + w[..., None] * slopes[None, :, 1:] / grid.width
    of_left = w * slopes[None, :, 0] / grid.width
    inverse = _inverse(matrix)
    own, per_left = (-(inverse @ x[..., None])[..., 0] for x in (residuals.orbit, of_left))

    # The same from the first panel's left on, a + b · (change there), panel after panel.
    def along(carry, panel):
        a, b = carry
        own, per_left = panel
        return (own + per_left * a, per_left * b), carry

    zero, one = jnp.zeros_like(beta), jnp.ones_like(beta)
    (a, b), (before_a, before_b) = lax.scan(along, (zero, one), (own[:, -1], per_left[:, -1]))
    fixed = own + per_left * before_a[:, None]
    free = per_left * before_b[:, None]
    # Forgotten within a turn, or not.
    slow = b > 0.5
    by_turn = a / jnp.where(slow, 1, 1 - b)
    total = jnp.sum(grid.weight * free)
    by_mean = -(residuals.mean + jnp.sum(grid.weight * fixed)) / jnp.where(slow, total, 1)
    return fixed + free * jnp.where(slow, by_mean, by_turn)


def _inverse(matrix: Float[Array, "panels n n"]) -> Float[Array, "panels n n"]:
    """By elimination in all panels at once, without pivoting, which Radau's matrix can do without.

    Not LAPACK's: that takes them one by one, and its calls have locked each other out.
    """
    one = jnp.eye(_NODES, dtype=matrix.dtype)
    both = jnp.concatenate([matrix, jnp.broadcast_to(one[None], matrix.shape)], -1)
    for k in range(_NODES):
        row = both[:, k : k + 1] / both[:, k : k + 1, k : k + 1]
        # Of its own row what is left is `row` itself.
        both = both - (both[:, :, k : k + 1] - one[None, :, k : k + 1]) * row
    return both[..., _NODES:]


@cache
def _radau() -> tuple[np.ndarray, ...]:
    """Nodes in (0, 1], dw/ds there from w at 0 and at the nodes, and weights of ∫_0^1."""
    n = _NODES
    polynomial = legendre.Legendre.basis(n - 1) + legendre.Legendre.basis(n)
    roots = np.sort(polynomial.roots().real)
    roots = roots - np.append(0, polynomial(roots[1:]) / polynomial.deriv()(roots[1:]))
    roots[0] = -1
    nodes = 0.5 * (1 - roots[::-1])
    every = np.append(0, nodes)
    apart = every[:, None] - every[None] + np.eye(n + 1)
    weight = 1 / np.prod(apart, axis=1)
    slopes = weight[None] / weight[:, None] / apart
    np.fill_diagonal(slopes, 0)
    np.fill_diagonal(slopes, -slopes.sum(1))
    exact = np.append(1, np.zeros(n - 1))
    weights = np.linalg.solve(legendre.legvander(2 * nodes - 1, n - 1).T, exact)
    return nodes, slopes[1:], weights
