"""Initial value problems with lanes of v0, and what their last angles truly are."""

import subprocess
import tempfile
from functools import partial
from pathlib import Path

import damped_references
import flint
import numpy as np
import pendulum_references

from pendax import Pendulum

from . import cores

KNOWN = 4  # lanes whose errors are looked at, the first ones
_DRIVER = Path(__file__).parent / "barely_damped.c"


class Problem:
    """θ̈ + β θ̇ + ε sin θ = τ from (θ0, v0) at 0, θ at t; ε = 1 and a lane for each v0."""

    def __init__(self, name, v0, t, *, beta=None, tau=None, wave=None, theta0=0.0, by="free"):
        self.name, self.v0, self.t, self.theta0 = name, np.asarray(v0), float(t), theta0
        self.beta, self.tau = beta, tau
        self.wave = wave  # (amplitude, angular frequency) of a cosine that τ has as well
        self.by = by  # which reference
        self._known = {}

    @property
    def stiff(self) -> bool:
        return (self.beta or 0) > 50

    @property
    def turns(self) -> float:
        """As long as that many small swings."""
        return self.t / (2 * np.pi) / max(1.0, self.beta or 0)

    @property
    def pendulum(self) -> Pendulum:
        import jax.numpy as jnp

        if self.wave is None:
            return Pendulum(1.0, self.beta, self.tau)
        amplitude, rate = self.wave
        return Pendulum(1.0, self.beta, lambda t: self.tau + amplitude * jnp.cos(rate * t))

    def true(self, dtype=np.float64) -> np.ndarray | None:
        """Of the first `KNOWN` lanes, all numbers rounded to `dtype`; `None` where the reference
        can't be had."""
        if dtype not in self._known:
            numbers = (self.beta, self.tau, self.theta0, self.t)
            beta, tau, theta0, t = (x if x is None else float(dtype(x)) for x in numbers)
            rows = [float(dtype(v0)) for v0 in self.v0[:KNOWN]]
            if self.by == "barely damped":
                self._known[dtype] = _barely_damped(beta, theta0, rows)
            else:
                one = partial(_true, self.by, beta, tau, self.wave, theta0, t)
                self._known[dtype] = np.array(cores.each(one, [[v0] for v0 in rows], worth=1))
        return self._known[dtype]


def _true(by, beta, tau, wave, theta0, t, row) -> float:
    (v0,) = row
    if by == "free":
        with flint.ctx.workprec(300):
            at = [flint.arb(x) for x in (1.0, t, v0, theta0)]
            return float(pendulum_references.motion(*at)[0])
    if by == "waved":
        return _waved(beta, tau, wave, theta0, v0, t)
    solve = {
        "damped": damped_references.trajectory,
        "overdamped": damped_references.overdamped,
    }[by]
    return solve(1.0, beta or 0.0, tau or 0.0, theta0, v0, [t])[0][0]


def _waved(beta, tau, wave, theta0, v0, t) -> float:
    """Under τ + a cos ωt, in 30 digits."""
    import mpmath

    amplitude, rate = map(mpmath.mpf, wave)
    with mpmath.workdps(30):

        def force(time, y):
            push = tau + amplitude * mpmath.cos(rate * time)
            return [y[1], push - beta * y[1] - mpmath.sin(y[0])]

        # An extrapolated midpoint rule of order 16 needs no derivatives of the force.
        return float(_extrapolated(force, mpmath.mpf(t), [mpmath.mpf(theta0), mpmath.mpf(v0)])[0])


def _extrapolated(force, t, y, order=12, step=0.25):
    """Gragg, Bulirsch and Stoer: the midpoint rule's error is even in the step."""
    count = int(np.ceil(float(t) / step))
    h, counts = t / count, [2 * (j + 1) for j in range(order)]
    for k in range(count):
        table = []
        for j, n in enumerate(counts):
            small, time = h / n, k * h
            before, now = y, [a + small * b for a, b in zip(y, force(time, y), strict=True)]
            for i in range(1, n):
                slopes = force(time + i * small, now)
                before, now = now, [a + 2 * small * b for a, b in zip(before, slopes, strict=True)]
            last = force(time + h, now)
            row = [[(a + b + small * c) / 2 for a, b, c in zip(now, before, last, strict=True)]]
            for i in range(1, j + 1):
                ratio = (n / counts[j - i]) ** 2 - 1
                row.append(
                    [a + (a - b) / ratio for a, b in zip(row[-1], table[-1][i - 1], strict=True)]
                )
            table.append(row)
        y = table[-1][-1]
    return y


def _barely_damped(beta, theta0, rows) -> np.ndarray | None:
    """Through every turn in 80 bits, to t = 5/β."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "barely_damped"
        command = ["cc", "-O3", "-march=native", str(_DRIVER), "-o", str(program), "-lm"]
        try:
            subprocess.run(command, check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"skipped: the driver of barely damped motions does not build ({error})")
            return None
        found = []
        for v0 in rows:
            words = [str(program), repr(beta), repr(theta0), repr(v0), "1"]
            done = subprocess.run(words, check=True, capture_output=True, text=True)
            _, theta, _, turns = done.stdout.split()
            found.append(float(theta) + 2 * np.pi * int(turns))
        return np.array(found)
