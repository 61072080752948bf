"""The running state: a periodic orbit θ̇ = w(θ), whose mean velocity is a junction's voltage.

    w w' = τ − ε sin θ − β w,    w(θ + 2π) = w(θ),    T = ∫ dθ / w.

It is solved for in the angle, where it has the same smooth shape at every damping: in time an
overdamped orbit is stiff, and one near a saddle lasts for ever.  Radau's collocation on
panels that follow it into its corners, a saddle's neighbourhood say; Newton's method, its
linear equations eliminated panel by panel.  What closes them is, of two conditions that say
the same, the one that has digits: w(2π) = w(0) where a turn forgets how it began,
∫ w dθ = 2π τ/β where it does not.

Rejected: shooting in time, for the above; Fourier series, which need 1/w of terms; panels
fixed beforehand: beside a saddle w is smallest by (τ − τ_r) to a power between ½ and 1, and
not at the saddle where two fixed points are about to merge.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from .._arrays import common, widened
from .._pendulum import Pendulum
from ._implicit import implicit
from ._limits import far_above, overdamped, ripple
from ._panels import (
    NODES,
    Nodes,
    Panels,
    angles,
    by_s,
    evaluated,
    graded,
    radau,
    refined,
    slopes,
    weights,
)
from ._retrapping import retrapping
from ._scene import require_damped

FloatArray = Float[Array, "..."]
Scalar = Float[Array, ""]

_MOST = 150  # of Newton's steps: 6 to 12 are usual, 70 within 1e-9 of τ_r
_BLOCK = 32  # lanes at once
_RENEWALS = 3  # of the panels at the last torque


def mean_velocity(pendulum: Pendulum) -> FloatArray:
    """The time-averaged θ̇ of the running state, rad/s; 0 at torques that don't sustain one.

    **Arguments:** a `pendulum` with damping and a constant torque, its leaves of shapes that
    broadcast.

    **Returns:** 2π/T, T the time of a turn; odd in τ; 0 for |τ| ≤ τ_r
    ([`retrapping_torque`][]); √(τ² − ε²)/β in the overdamped limit, τ/β far above ε; infinite
    for β = 0 with a torque.

    **Raises:** `ValueError` for β = `None` and for τ a function of time.  Where the iteration
    doesn't converge, NaN: one or two roundings above τ_r, or with β and τ/√ε within 1e-7 of
    β* and √ε, where three scales meet.

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
    return root * of_lanes(*flat).reshape(root.shape)


def of_lanes(beta: Float[Array, " lanes"], tau: Float[Array, " lanes"]) -> Float[Array, " lanes"]:
    """That of ε = 1, a block at a time: it stays in the cache, and waits for none but its own."""
    lanes, solve = beta.size, jax.vmap(of_unit)
    if lanes <= _BLOCK:
        return solve(beta, tau)
    missing = -lanes % _BLOCK
    blocks = (jnp.pad(x, (0, missing), mode="edge").reshape(-1, _BLOCK) for x in (beta, tau))
    return lax.map(lambda block: solve(*block), tuple(blocks)).ravel()[:lanes]


def of_unit(beta: Scalar, tau: Scalar) -> Scalar:
    """That of ε = 1, either sign of τ."""
    size, eps = jnp.abs(tau), jnp.finfo(tau.dtype).eps
    running = (size > retrapping(beta) * (1 + 8 * eps)) & (beta > 0) & (size < jnp.inf)
    scene = jnp.where(running, beta, 1), jnp.where(running, size, 2)
    fast = ripple(*lax.stop_gradient(scene)) < 2 * eps**0.5
    slow = ~fast & (scene[0] > eps**-0.25)
    v = jnp.zeros_like(beta)
    # Each with some scene of its own where it is not asked.
    for asked, how, other in (
        (running & fast, far_above, (1, 1e9)),
        (running & slow, overdamped, (1e9, 2)),
        (running & ~fast & ~slow, _running, (1, 2)),
    ):
        safe = (jnp.where(asked, x, y) for x, y in zip(scene, other, strict=True))
        v = jnp.where(asked, how(*safe), v)
    v = jnp.where(running, jnp.sign(tau) * v, 0 * beta * tau)
    return jnp.where((beta == 0) & (size > 0), jnp.inf * jnp.sign(tau), v)


class Force(NamedTuple):
    """τ − sin θ at one torque, over the angle x from the saddle, or from its least for τ ≥ 1."""

    tau: Scalar
    kappa: Scalar  # √(1 − τ²), or 0

    def __call__(self, x: Nodes) -> Nodes:
        """Without the difference of the two."""
        bowl = 2 * jnp.sin(0.5 * x) ** 2
        below = self.kappa * jnp.sin(x) + self.tau * bowl
        return jnp.where(self.tau < 1, below, self.tau - 1 + bowl)


def _running(beta: Scalar, tau: Scalar) -> Scalar:
    fixed = lax.stop_gradient(tau)
    force = Force(fixed, jnp.sqrt(jnp.maximum((1 - fixed) * (1 + fixed), 0)))

    def find(p):
        return _solved(*p)

    def change(found, p, dp):
        (panels, w), (force, beta, tau) = found, p
        _, moved = jax.jvp(partial(_residuals, panels, w, force), (beta, tau), tuple(dp[1:]))
        still = jax.tree.map(jnp.zeros_like, panels)
        return still, _eliminated(panels, w, beta, moved)

    panels, w = implicit(find, change, (force, beta, tau))
    return 2 * jnp.pi / jnp.sum(weights(panels) / w)


class Walk(NamedTuple):
    """Newton's method at torques that come down to the one that is asked for."""

    panels: Panels
    w: Nodes
    gap: Scalar  # what the torque is above τ_r, if that is more than the one asked for
    changed: Scalar  # relatively, by the last step
    before: Scalar  # and by the last but one
    renewed: Scalar  # how often at the last torque
    steps: Scalar


def _solved(force: Force, beta: Scalar, tau: Scalar) -> tuple[Panels, Nodes]:
    """From a guess that is good far above τ_r; at each torque on panels that follow the orbit.

    Near τ_r the orbit's digits end before those of τ: the iteration ends as well where it
    no longer improves.
    """
    edge, eps = retrapping(beta), jnp.finfo(tau.dtype).eps

    def unfinished(at: Walk):
        still = (at.changed < 1e-2) & (at.changed > 0.25 * at.before)
        done = (at.renewed == _RENEWALS) & (still | (at.changed < 0.5 * eps**0.5))
        return ~done & (at.steps < _MOST)

    def step(at: Walk):
        now = jnp.maximum(tau, edge + at.gap)
        w, changed = _improved(at.panels, at.w, force, beta, now)
        near, last = changed < 0.1, now <= tau
        renew = near & (at.renewed < _RENEWALS)
        kept, new = (at.panels, w), _followed(at.panels, w)
        panels, w = jax.tree.map(lambda x, y: jnp.where(renew, x, y), new, kept)
        return Walk(
            panels,
            w,
            jnp.where(near, at.gap / 4, at.gap),
            jnp.where(renew, jnp.inf, changed),
            at.changed,
            at.renewed + jnp.where(renew & last, 1, 0),
            at.steps + 1,
        )

    far = 0.3 * jnp.minimum(beta, 1)
    high = jnp.maximum(tau, edge + far)
    a = jnp.minimum(jnp.sqrt((high - edge) / jnp.minimum(beta, 1)), 1)
    panels = graded(a, -np.pi, np.pi)
    guess = _guess(angles(panels), a, force, beta, high)
    inf, zero = jnp.full_like(tau, jnp.inf), jnp.zeros_like(tau)
    end = lax.while_loop(unfinished, step, Walk(panels, guess, far, inf, inf, zero, zero))
    return end.panels, jnp.where(end.changed < 1e-2, end.w, jnp.nan)


def _improved(panels: Panels, w: Nodes, force: Force, beta: Scalar, tau: Scalar):
    share = _eliminated(panels, w, beta, _residuals(panels, w, force, beta, tau)) / w
    # w stays positive.
    return w * jnp.clip(1 + share, 0.1, 5), jnp.max(jnp.abs(share))


def _followed(panels: Panels, w: Nodes) -> tuple[Panels, Nodes]:
    """Panels as short as the scale of w, w/√(w'² + |w w''|), and w on them, roughly."""
    x, dx = angles(panels), slopes(panels)
    slope = by_s(w) / dx
    # Not by the equation of motion, whose terms cancel where β is large.
    bend = w * by_s(slope) / dx
    after = refined(panels, 1 + jnp.sqrt(slope * slope + jnp.abs(bend)) / w)
    new = angles(after)
    at, known = (jnp.append(*pair) for pair in ((panels.edges[:1], x), (w[-1, -1:], w)))
    rough = jnp.interp(new.ravel(), at, known).reshape(w.shape)
    # Energies have to be kept to the last digit, but for a polynomial that is none yet.
    fine = evaluated(panels, w, new)
    return after, jnp.where((fine > 0.3 * rough) & (fine < 3 * rough), fine, rough)


def _guess(x: Nodes, a: Scalar, force: Force, beta: Scalar, tau: Scalar) -> Nodes:
    """The free pendulum's separatrix lifted or lowered to the mean τ/β, or the overdamped w."""
    mean, separatrix = tau / beta, 2 * jnp.abs(jnp.sin(0.5 * x))
    lowered = mean * (np.pi / 4 * separatrix + a / 2)
    lifted = jnp.hypot(separatrix, jnp.hypot(a, jnp.sqrt(jnp.maximum(mean * mean - 1.62, 0))))
    weak = jnp.where(mean < 4 / np.pi, lowered, lifted)
    strong = jnp.maximum(force(x) + (tau - force.tau), 0) / beta + 1e-3 * mean
    return jnp.where(beta < 1, weak, strong)


class Residuals(NamedTuple):
    orbit: Nodes  # of w w' = τ − sin θ − β w, by s
    mean: Scalar  # of ∫ w dθ = 2π τ/β


def _residuals(panels: Panels, w: Nodes, force: Force, beta: Scalar, tau: Scalar) -> Residuals:
    # Linear in τ at a given angle.
    torque = force(angles(panels)) + (tau - force.tau)
    orbit = w * by_s(w) - slopes(panels) * (torque - beta * w)
    return Residuals(orbit, jnp.sum(weights(panels) * w) - 2 * np.pi * tau / beta)


def _eliminated(panels: Panels, w: Nodes, beta: Scalar, residuals: Residuals) -> Nodes:
    """The change of w that cancels the residuals to first order."""
    _, derivative, _ = radau(w.dtype)
    # Each panel by itself: the change in it is own + per_left · (change on its left).
    diagonal = by_s(w) + slopes(panels) * beta
    matrix = diagonal[..., None] * jnp.eye(NODES, dtype=w.dtype)[None]
    inverse = _inverse(matrix + w[..., None] * derivative[None, :, 1:])
    of_left = w * derivative[None, :, 0]
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
    weight = weights(panels)
    total = jnp.sum(weight * free)
    by_mean = -(residuals.mean + jnp.sum(weight * fixed)) / jnp.where(slow, total, 1)
    return fixed + free * jnp.where(slow, by_mean, by_turn)


def _inverse(matrix: Float[Array, "panels n n"]) -> Float[Array, "panels n n"]:
    """By elimination in all panels at once, without pivoting, which Radau's matrix can do without.

    Not LAPACK's: that takes them one by one, and its calls have locked each other out.
    """
    one = jnp.eye(NODES, dtype=matrix.dtype)
    both = jnp.concatenate([matrix, jnp.broadcast_to(one[None], matrix.shape)], -1)
    for k in range(NODES):
        row = both[:, k : k + 1] / both[:, k : k + 1, k : k + 1]
        # Of its own row what is left is `row` itself.
        both = both - (both[:, :, k : k + 1] - one[None, :, k : k + 1]) * row
    return both[..., NODES:]
