"""The search for the parameters of a recorded motion, over longer and longer stretches of it."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from .._method import Method, TaylorSeries
from .._motion import motion
from .._pendulum import Pendulum
from ._judgement import Goodness, Judgement, goodness, judged
from ._minimise import by_optimiser, least_squares
from ._parameters import Parameters
from ._recording import Recording
from ._terms import with_numbers

Vector = Float[Array, " parameters"]
SPREAD = 0.3  # of further starts
RESERVE = 0.02  # of the data's spread, as one more sample that says x = 0
ROUGH = 40  # steps on a stretch that is not the last
SMOOTH = 1e-3  # standardised residuals below which a loss is its parabola


class Found(NamedTuple):
    values: Vector
    history: Float[Array, " steps"]
    judgement: Judgement
    goodness: Goodness
    theta: Float[Array, "runs samples"]
    velocity: Float[Array, "runs samples"]
    loss: Float[Array, ""]
    unexplained: Float[Array, ""]


class Search(eqx.Module):
    """A recording and what is to be found in it; `held` has what is not fitted, by name."""

    recording: Recording
    scene: Pendulum
    held: dict[str, Array]
    parameters: Parameters
    ends: Float[Array, " stages"]
    method: Method | None
    loss: Callable | None = eqx.field(static=True)
    optimiser: Any = eqx.field(static=True)
    starts: int = eqx.field(static=True)
    steps: int = eqx.field(static=True)
    weighted: bool = eqx.field(static=True)
    progress: Callable | None = eqx.field(static=True)

    @eqx.filter_jit
    def run(self) -> Found:
        x = jnp.zeros(self.parameters.size, self.recording.ts.dtype)
        if self.starts == 1:
            return self._one(x)
        key = jax.random.key(0)
        others = SPREAD * jax.random.normal(key, (self.starts - 1, x.size), x.dtype)
        found = jax.vmap(self._one)(jnp.concatenate([x[None], others]))
        best = jnp.argmin(jnp.where(jnp.isfinite(found.loss), found.loss, jnp.inf))
        return jax.tree.map(lambda leaf: leaf[best], found)

    def _one(self, x: Vector) -> Found:
        data, full = self.recording, self.ends[-1]
        spread = _detrended(data)
        samples = jnp.sum(data.there).astype(x.dtype)
        reserve = RESERVE * jnp.sqrt(jnp.sum(spread**2) / samples)

        def stage(x, at):
            end, reserve = at

            def residuals(x):
                r, _ = self._residuals(self.parameters.at(x), end)
                r = r if self.loss is None else rooted(self.loss, r)
                # A short stretch may say nothing of a parameter: it then stays where it is.
                return jnp.concatenate([r, reserve * x])

            most = jnp.where(end < full, min(ROUGH, self.steps), self.steps)
            minimum = least_squares(residuals, x, self.steps, most)
            if self.progress is not None:
                jax.debug.callback(self.progress, 1 / (self.ends.size * self.starts))
            return jnp.where(jnp.isfinite(minimum.x), minimum.x, x), minimum.history

        # Less and less of it: where the fit ends up it would pull it off.
        reserves = jnp.where(
            self.ends < full, reserve * 0.1 ** jnp.arange(self.ends.size, dtype=x.dtype), 0
        )
        x, history = lax.scan(stage, x, (self.ends, reserves))
        history = history[-1]

        if self.optimiser is not None:

            def loss(x):
                return total(self.loss, self._residuals(self.parameters.at(x), full)[0])

            x, history = by_optimiser(loss, x, self.optimiser, self.steps)
        values = self.parameters.at(x)

        def of_values(values):
            r, motion = self._residuals(values, full)
            return r, (r, motion)

        jacobian, (r, (theta, velocity)) = jax.jacfwd(of_values, has_aux=True)(values)
        channels = 1 if data.velocity is None else 2
        there = jnp.tile(data.there, (channels, 1))
        count = jnp.sum(there).astype(r.dtype)
        of_theta = r[: data.theta.size]
        return Found(
            values,
            history,
            judged(r, jacobian, count, values, self.parameters.has_sign, self.loss),
            goodness(r.reshape(there.shape), there, values.size, self.weighted),
            theta,
            velocity,
            total(self.loss, r),
            jnp.sqrt(jnp.sum(of_theta**2) / jnp.sum(spread**2)),
        )

    def _model(self, values: Vector, end: Float[Array, ""]):
        """θ, with the offset, and v at the times up to `end`, and there at all later ones."""
        at = self.held | self.parameters.split(values)
        scene = with_numbers(self.scene, at)
        ts = self.recording.ts

        def one(ts, v0, theta0):
            if self.method is None:
                t = ts - ts[0]
                alike = (jnp.broadcast_to(x, t.shape) for x in (scene.epsilon, v0, theta0))
                epsilon, v0, theta0 = alike
                return tuple(motion(epsilon, t, v0, theta0))
            # Steps that no stretch asks for are not taken.
            short = isinstance(self.method, TaylorSeries)
            times = jnp.minimum(ts, ts[0] + end) if short else ts
            return self.method(scene, times, v0, theta0, ts[0])[:2]

        theta, v = jax.vmap(one)(ts, at["v0"], at["theta0"])
        return (theta + at["offset"][:, None] if "offset" in at else theta), v

    def _residuals(self, values: Vector, end):
        """Weighted; 0 beyond `end` and where nothing was measured.  And the motion."""
        data = self.recording
        theta, v = self._model(values, end)
        used = data.there & (data.ts - data.ts[:, :1] <= end)
        parts = [jnp.where(used, (data.theta - theta) * data.weight, 0)]
        if data.velocity is not None and data.velocity_weight is not None:
            parts.append(jnp.where(used, (data.velocity - v) * data.velocity_weight, 0))
        return jnp.concatenate([jnp.ravel(x) for x in parts]), (theta, v)


def _detrended(data: Recording):
    """Weighted angles less the straight line through them: what there is to describe."""

    def centred(x):
        x = jnp.where(data.there, x, 0)
        mean = jnp.sum(x * data.weight**2, 1, keepdims=True) / total
        return jnp.where(data.there, x - mean, 0) * data.weight

    total = jnp.sum(data.weight**2, 1, keepdims=True)
    t, theta = centred(data.ts), centred(data.theta)
    slope = jnp.sum(t * theta, 1, keepdims=True) / jnp.sum(t * t, 1, keepdims=True)
    return theta - slope * t


def rooted(loss: Callable, r: Float[Array, " residuals"]) -> Float[Array, " residuals"]:
    """r' whose r'²/2 is the loss of r."""
    small = jnp.abs(r) < SMOOTH
    far = jnp.where(small, 1, r)
    stiffness = jax.grad(jax.grad(loss))(jnp.zeros((), r.dtype))
    share = jnp.where(small, stiffness, 2 * jax.vmap(loss)(far) / (far * far))
    return r * jnp.sqrt(share)


def total(loss: Callable | None, r: Float[Array, " residuals"]) -> Float[Array, ""]:
    return jnp.sum(0.5 * r * r if loss is None else jax.vmap(loss)(r))
