"""A junction under an alternating current: which method, and whether it is asked for sensibly."""

import math
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from .._arrays import aligned, common, concrete, require
from ._junction import FLUX_QUANTUM, JosephsonJunction, positive
from ._rotation_number import rotation_number
from ._stroboscope import MOST_SWEEPS, Junction, Methods, glides, smallness, swept

FloatArray = Float[Array, "..."]

# h f/2e in units of Ic R.
_SLOWEST, _FASTEST = 1e-4, 1e4


def driven(
    junction: JosephsonJunction, current: FloatArray, drive: Any, periods: int
) -> list[FloatArray]:
    """Voltages on the way up and down, and their uncertainties; currents behind the lanes."""
    amplitude, frequency = _checked(drive, junction)
    lanes = common(amplitude=amplitude, frequency=frequency, **junction.parameters())
    shape, dtype = lanes[0].shape + current.shape, jnp.result_type(current, lanes[0])
    if dtype in (jnp.float16, jnp.bfloat16):
        raise ValueError(f"Arguments must be float32 or float64 for a drive, but got {dtype}.")
    if 0 in shape:
        return [jnp.zeros(shape, dtype)] * 4
    methods = _needed(junction, current, amplitude, frequency)
    return _driven(junction, current, amplitude, frequency, periods, methods)


@partial(jax.jit, static_argnames=("periods", "methods"))
def _driven(
    junction: JosephsonJunction,
    current: FloatArray,
    amplitude: FloatArray,
    frequency: FloatArray,
    periods: int,
    methods: Methods,
) -> list[FloatArray]:
    lanes = common(amplitude=amplitude, frequency=frequency, **junction.parameters())
    dtype = jnp.result_type(current, lanes[0])
    currents = jnp.atleast_1d(current).astype(dtype)

    def one(amplitude, frequency, critical, resistance, *beta):
        fine = positive(frequency, critical, resistance, *beta)
        # Ω of the first-order junction, h f/2e in units of Ic R.
        omega = fine * (FLUX_QUANTUM * frequency) / (critical * resistance)
        omega = jnp.where((omega >= _SLOWEST) & (omega <= _FASTEST), omega, jnp.nan)
        i0, i1 = currents / critical, amplitude / critical
        if beta:
            junction = Junction(beta[0], i1, omega / beta[0])
            turns = _up_and_down(junction, i0, periods, methods)
        else:
            rho, error = jax.vmap(rotation_number, (0, None, None))(i0, i1, omega)
            turns = rho, rho, error, error
        return [x * (FLUX_QUANTUM * frequency) for x in turns]

    flat = tuple(x.astype(dtype).ravel() for x in lanes)
    if junction.capacitance is None:
        each = jax.vmap(one)(*flat)
    else:
        # One after the other: a step of one lane takes a fifth of the time of a step of two.
        each = jax.lax.map(lambda lane: one(*lane), flat)
    return [x.reshape(lanes[0].shape + current.shape) for x in each]


def _up_and_down(junction: Junction, i0: FloatArray, periods: int, methods: Methods):
    known = ~jnp.isnan(i0)
    falling = i0[jnp.argmax(known)] > i0[::-1][jnp.argmax(known[::-1])]
    rising = jnp.where(falling, i0[::-1], i0)
    ways = jnp.stack([rising, rising[::-1]])
    mean, error, _ = _without_slopes(junction, ways, periods, methods)
    (up, down), (up_error, down_error) = mean, error

    def given(x):
        return jnp.where(falling, x[::-1], x)

    return given(up), given(down[::-1]), given(up_error), given(down_error[::-1])


@partial(jax.custom_jvp, nondiff_argnums=(2, 3))
def _without_slopes(junction: Junction, ways: FloatArray, periods: int, methods: Methods):
    """Turns, their uncertainty, and 1 where locked: there they don't move with anything."""
    turns = jax.lax.map(lambda currents: swept(junction, currents, periods, methods), ways)
    return turns.mean, turns.error, turns.locked.astype(ways.dtype)


@_without_slopes.defjvp
def _(periods, methods, primals, tangents):
    mean, error, locked = _without_slopes(*primals, periods, methods)
    moving, ways = tangents
    slope = jnp.where(locked > 0, 0, jnp.nan) * (ways + sum(moving))
    return (mean, error, locked), (slope, jnp.zeros_like(error), jnp.zeros_like(locked))


# h f/2e in units of Ic R.
_SLOWEST, _FASTEST = 1e-4, 1e4


def _checked(drive: Any, junction: JosephsonJunction) -> tuple[FloatArray, FloatArray]:
    """Amplitude and frequency."""
    if not isinstance(drive, tuple | list) or len(drive) != 2:
        raise ValueError(f"Argument `drive` must be (amplitude, frequency), but got {drive!r}.")
    amplitude, frequency = aligned(amplitude=drive[0], frequency=drive[1])
    require("drive", amplitude, "a finite amplitude, in A", np.isfinite)
    require("drive", frequency, "a positive frequency, in Hz", lambda x: (x > 0) & np.isfinite(x))
    unit, volts = concrete(junction.critical_current), concrete(junction.characteristic_voltage)
    size, hertz = concrete(amplitude), concrete(frequency)
    if unit is not None and size is not None and size.size and unit.size:
        share = np.max(np.abs(size)) / np.max(unit)
        if share > 1000:
            raise ValueError(
                "Argument `drive` must have its amplitude in A, as the junction's "
                f"`critical_current`, but it is {share:.3g} times that."
            )
    if volts is not None and hertz is not None and volts.size and hertz.size:
        for step in (np.min(hertz) / np.max(volts), np.max(hertz) / np.min(volts)):
            if not (_SLOWEST <= FLUX_QUANTUM * step <= _FASTEST):
                raise ValueError(
                    "Argument `drive` must have its frequency in Hz, with steps h f/2e between "
                    f"1e-4 and 1e4 of Ic R, but they are {FLUX_QUANTUM * step:.3g} of it."
                )
    return amplitude, frequency


def _needed(
    junction: JosephsonJunction, current: FloatArray, amplitude: FloatArray, frequency: FloatArray
) -> Methods:
    """Which methods its lanes take, as far as can be seen."""
    if junction.capacitance is None:
        return Methods(full=False, sweeps=0)
    given = {"amplitude": amplitude, "frequency": frequency, **junction.parameters()}
    if any(concrete(x) is None for x in (current, *given.values())):
        return Methods(full=True, sweeps=MOST_SWEEPS)
    amplitude, frequency, critical, resistance, beta = common(**given)
    omega = FLUX_QUANTUM * frequency / (critical * resistance * beta)
    most = jnp.nanmax(jnp.abs(current)) / critical
    lanes = Junction(beta, amplitude / critical, omega)
    slow, delta = glides(lanes, most), smallness(lanes, most)
    largest = float(jnp.max(jnp.where(slow, delta, 0)))
    # Down to 1e-14.
    sweeps = 0 if largest == 0 else math.ceil(min(-32.2 / math.log(4 * largest), MOST_SWEEPS))
    return Methods(full=not bool(jnp.all(slow)), sweeps=sweeps)
