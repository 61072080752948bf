"""The power spectrum of a sampled motion, as the source takes it."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, concrete

FloatArray = Float[Array, "..."]

# Σ (−1)^j c_j cos(2π j n/N)
_WINDOWS = {
    "hann": (0.5, 0.5),
    "hamming": (0.54, 0.46),
    "blackman": (0.42, 0.5, 0.08),
    "blackman-harris": (0.35875, 0.48829, 0.14128, 0.01168),
}


def power_spectrum(
    ts: ArrayLike,
    theta: ArrayLike,
    *,
    window: str | ArrayLike | None = None,
    detrend: str | ArrayLike | None = None,
) -> tuple[FloatArray, FloatArray]:
    """(ω, |X|²), X_n = N^(-1/2) Σ θ_j exp(−2πi jn/N), the FFT with the source's factor.

    **Arguments:**

    - `ts`: N ≥ 2 times, s, one axis, uniform to 1e-6 of a step, increasing.
    - `theta`: samples, rad; time is the last axis, of length N.
    - `window`: "hann", "hamming", "blackman", "blackman-harris", or N weights; they are
      scaled to mean 1, so that a line keeps its height.  `None`: no window.
    - `detrend`: "constant" takes off the mean, "linear" the line of least squares, a
      number Ω, rad/s (of the shape of the lanes), Ω t: for a rotation pass its frequency.

    **Returns:** ω = 2πn/(N Δt) for n = 0 … N/2, rad/s, and the power, rad², of each; the
    frequencies above are the mirror image of these.  A line a sin ωt on a bin has the power
    N a²/4.

    **Raises:** `ValueError` for times that are not uniform (NaN instead under a
    transformation), an unknown window or trend, lengths that do not match.

    Suzuki & Suzuki §2.4 and chapter 6, whose plots are shifted up by one bin (Mathematica
    counts from 1), and whose 2πN/T is the sampling frequency, twice the largest ω here.
    """
    (ts,) = common(ts=ts)
    (theta,) = common(theta=theta)
    if ts.ndim != 1 or ts.size < 2:
        raise ValueError(f"Argument `ts` must be one axis of two or more, but got {ts.shape}.")
    if theta.ndim == 0 or theta.shape[-1] != ts.size:
        raise ValueError(
            f"Argument `theta` must end in an axis of {ts.size} samples, but got {theta.shape}."
        )
    ts = ts.astype(theta.dtype)
    step = (ts[-1] - ts[0]) / (ts.size - 1)
    even = ts[0] + step * jnp.arange(ts.size, dtype=ts.dtype)
    rounding = 4 * jnp.finfo(ts.dtype).eps * jnp.max(jnp.abs(ts))
    uniform = (step > 0) & jnp.all(jnp.abs(ts - even) <= 1e-6 * step + rounding)
    if (seen := concrete(uniform)) is not None and not seen:
        raise ValueError("Argument `ts` must be uniform and increasing, but got other times.")
    weights = _weights(window, ts.size, theta.dtype)
    bins = jnp.fft.rfft(_without_trend(ts, theta, detrend) * weights, norm="ortho")
    power = bins.real**2 + bins.imag**2
    omega = 2 * jnp.pi * jnp.arange(power.shape[-1], dtype=ts.dtype) / (ts.size * step)
    return omega, jnp.where(uniform, power, jnp.nan)


def _weights(window: str | ArrayLike | None, size: int, dtype) -> FloatArray | float:
    if window is None:
        return 1.0
    if isinstance(window, str):
        if window not in _WINDOWS:
            names = ", ".join(f'"{name}"' for name in _WINDOWS)
            raise ValueError(f"Argument `window` must be one of {names}, but got {window!r}.")
        phase = 2 * np.pi * np.arange(size) / size
        terms = [(-1) ** j * c * np.cos(j * phase) for j, c in enumerate(_WINDOWS[window])]
        weights = jnp.asarray(np.sum(terms, 0), dtype)
    else:
        weights = jnp.asarray(window, dtype)
        if weights.shape != (size,):
            raise ValueError(
                f"Argument `window` must have {size} weights, but got shape {weights.shape}."
            )
    return weights / jnp.mean(weights)


def _without_trend(ts: FloatArray, theta: FloatArray, detrend) -> FloatArray:
    if detrend is None:
        return theta
    centred = ts - jnp.mean(ts)
    if isinstance(detrend, str):
        if detrend not in ("constant", "linear"):
            raise ValueError(
                'Argument `detrend` must be "constant", "linear" or a frequency, '
                f"but got {detrend!r}."
            )
        theta = theta - jnp.mean(theta, axis=-1, keepdims=True)
        if detrend == "constant":
            return theta
        slope = jnp.sum(theta * centred, axis=-1, keepdims=True) / jnp.sum(centred * centred)
    else:
        slope = jnp.asarray(detrend, ts.dtype)[..., None]
        centred = ts - ts[0]
    return theta - slope * centred
