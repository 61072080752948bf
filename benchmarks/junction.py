"""I–V curves: errors against 30 digits, and run times beside time stepping."""

import time
from functools import partial
from pathlib import Path

import fate_references
import jax
import junction_references as references
import numpy as np
from scipy.integrate import solve_ivp

from pendax import FLUX_QUANTUM, JosephsonJunction, iv_curve, retrapping_torque

from .timing import side_by_side

FOLDER = Path(__file__).parent / "results"
IC, R = 112.5e-6, 8.0
BETA_C = np.array([0.1, 1.0, 10.0, 100.0])
CURRENTS = 50  # of the curve that peers draw as well


def of_beta_c(beta_c):
    return JosephsonJunction(IC, R, beta_c * FLUX_QUANTUM / (2 * np.pi * IC * R**2))


def report(seed: int, scenes: int, rounds: int, check: bool) -> int:
    missed = still(seed, scenes)
    missed += shapiro(seed, scenes)
    missed += times(rounds)
    front(rounds)
    return 1 if check and missed else 0


def still(seed: int, scenes: int) -> int:
    """Voltages of the down branch from 0.1 % above Ir to 10 Ir, against a turn in Arb."""
    rng = np.random.default_rng(seed)
    off = []
    for _ in range(scenes):
        beta_c = 10 ** rng.uniform(-1, 3)
        beta = beta_c**-0.5
        tau = float(retrapping_torque(beta)) * (1 + 10 ** rng.uniform(-3, 1))
        volts = float(iv_curve(of_beta_c(beta_c), tau * IC).voltage_down)
        true = IC * R * beta * float(fate_references.mean_velocity(beta, tau))
        off.append(abs(volts / true - 1))
    print(f"{scenes} voltages without a drive, seed {seed}: relative {max(off):.1e} (bar 1e-9)")
    return int(max(off) > 1e-9)


def shapiro(seed: int, scenes: int) -> int:
    """Of first-order junctions: true error over the stated one, and over the height of a step."""
    rng = np.random.default_rng(seed)
    share, off = [], []
    for _ in range(scenes):
        i0, i1, omega = rng.uniform(-3, 3), rng.uniform(0, 3), 10 ** rng.uniform(-0.6, 1.5)
        drive = i1 * IC, omega * IC * R / FLUX_QUANTUM
        curve = iv_curve(JosephsonJunction(IC, R), i0 * IC, drive=drive)
        exact = i0 * IC / IC, drive[0] / IC, FLUX_QUANTUM * drive[1] / (IC * R)
        step = FLUX_QUANTUM * drive[1]
        true = float(references.rotation_number(*exact)) * step
        error = abs(float(curve.voltage_up) - true)
        off.append(error / step)
        share.append(error / (float(curve.error_up) + 4e-16 * abs(true) + 1e-30))
    print(
        f"{scenes} voltages under a drive, first order: {max(off):.1e} of a step (bar 1e-6), "
        f"at most {max(share):.2f} of what is stated"
    )
    return int(max(off) > 1e-6 or max(share) > 1)


def times(rounds: int) -> int:
    current = np.linspace(0, 3, 200) * IC
    four = side_by_side({"": partial(iv_curve, of_beta_c(BETA_C), current)}, rounds)[""]
    drive = IC, 0.5 * IC * R / FLUX_QUANTUM
    first, second = JosephsonJunction(IC, R), of_beta_c(1.0)
    driven = side_by_side(
        {
            "first order": partial(iv_curve, first, current, drive=drive),
            "β_c = 1": partial(iv_curve, second, current, drive=drive),
        },
        min(rounds, 3),
    )
    print(f"200 currents up and down at β_c = 0.1, 1, 10, 100: {four:.2f} s (bar 1 s)")
    for name, seconds in driven.items():
        print(f"200 currents under a drive, {name}: {seconds:.3g} s")
    return int(four > 1)


def by_scipy(beta, tau, span, method, rtol):
    """A plain script: one current after the other, downwards, averaged over the last half."""
    found, state = [], [0.0, tau[-1] / beta]

    def force(_, y, i):
        return y[1], i - beta * y[1] - np.sin(y[0])

    for i in tau[::-1]:
        options = {"method": method, "rtol": rtol, "atol": rtol, "args": (i,)}
        run = solve_ivp(force, (0, span), state, t_eval=[span / 2, span], **options)
        found.append((run.y[0, 1] - run.y[0, 0]) / (span / 2))
        state = [run.y[0, 1] % (2 * np.pi), run.y[1, 1]]
    return beta * np.array(found[::-1])


def by_pyjjasim(beta, tau, span, dt):
    """All currents side by side, each coming down from 2.5 Ic."""
    np.asscalar = lambda x: x.item()  # its release of 2022 still asks for it
    import pyjjasim

    graph = pyjjasim.EmbeddedGraph([0.0, 1.0], [0.0, 0.0], [0], [1])
    circuit = pyjjasim.Circuit(graph, 1.0, 1.0, beta**-2)
    count = round(span / beta / dt)  # in units of ħ/2eIcR
    ramp = np.minimum(np.arange(count) * dt / (25 / beta), 1)
    current = 2.5 + (tau[None, :, None] - 2.5) * ramp
    run = pyjjasim.TimeEvolutionProblem(
        circuit, dt, count, current_sources=current, store_current=False, store_voltage=False
    ).compute()
    theta = run.get_theta()[0]
    half = count // 2
    return (theta[:, -1] - theta[:, half]) / (dt * (count - 1 - half))


def front(rounds: int) -> None:
    """Largest error against run time, of the down branch at β_c = 10."""
    beta = 10**-0.5
    tau = np.linspace(1.01 * float(retrapping_torque(beta)), 2, CURRENTS)
    true = np.array([float(fate_references.mean_velocity(beta, x)) * beta for x in tau])
    points = {}

    def note(name, call, seconds=None):
        start = time.perf_counter()
        found = np.asarray(call())
        seconds = time.perf_counter() - start if seconds is None else seconds
        points.setdefault(name, []).append((seconds, float(np.max(np.abs(found - true)))))

    def ours(dtype):
        junction = jax.tree.map(lambda x: jax.numpy.asarray(x, dtype), of_beta_c(10.0))
        current = jax.numpy.asarray(tau * IC, dtype)
        return lambda: iv_curve(junction, current).voltage_down / (IC * R)

    for dtype in ("float64", "float32"):
        seconds = side_by_side({"": ours(dtype)}, rounds)[""]
        note(f"pendax, {dtype}", ours(dtype), seconds)
    for span, method, rtol in (
        (200, "RK45", 1e-3),
        (200, "DOP853", 1e-6),
        (1000, "DOP853", 1e-8),
        (5000, "DOP853", 1e-10),
    ):
        note("SciPy, a script", partial(by_scipy, beta, tau, span, method, rtol))
    for span, dt in ((200, 0.1), (1000, 0.05), (5000, 0.05), (5000, 0.02)):
        note("pyjjasim", partial(by_pyjjasim, beta, tau, span, dt))
    for name, rows in points.items():
        for seconds, off in rows:
            print(f"{name:18} {seconds:9.3g} s   error {off:.1e} Ic R")
    _draw(points)


def _draw(points) -> None:

    from pendax import plot

    with plot.style():
        figure = plot.new_figure(11.0, 4.5)
        left, right = figure.subplots(1, 2)
        current = np.linspace(-2, 2, 801) * IC
        plot.iv_curve(left, iv_curve(of_beta_c(10.0), current))
        drive = 1.5 * IC, 0.37 * IC * R / FLUX_QUANTUM
        steps = iv_curve(JosephsonJunction(IC, R), current, drive=drive)
        left.plot(1e6 * current, 1e3 * steps.voltage_up, color=plot.colour_of("next"), lw=1,
                  label="first order, under a drive")  # fmt: skip
        left.set_title(r"$\beta_c = 10$, and Shapiro's steps")
        left.legend(loc="upper left")
        methods = {name: tuple(zip(*rows, strict=True))[::-1] for name, rows in points.items()}
        plot.work_precision(right, methods, error=r"largest error / $I_c R$")
        right.set_title(f"{CURRENTS} currents of the falling branch")
        figure.savefig(FOLDER / "junction.png")
