"""I–V curves: errors against 30 digits, and run times beside time stepping."""

import warnings
from functools import partial

import fate_references
import jax
import junction_references as references
import numpy as np
from scipy.integrate import solve_ivp

from pendax import FLUX_QUANTUM, JosephsonJunction, iv_curve, retrapping_torque

from . import cores, results
from .compared import Point, losses, once, seconds, spent
from .peers import library
from .timing import side_by_side

IC, R = 112.5e-6, 8.0
BETA_C = np.array([0.1, 1.0, 10.0, 100.0])
WHY = {}  # of losses, which there were none


def measure(seed: int, quick: bool) -> results.Tables:
    scenes, rounds = (3, 3) if quick else (40, 5)
    voltages = [still(seed, scenes), *shapiro(seed, scenes)]
    four, curves = times(rounds, quick)
    points = front(rounds, quick)
    if not quick:
        _draw(points)
    return {
        "voltages of random junctions": [
            {"voltages": name, "scenes": scenes, "largest error": error}
            for name, error, _ in voltages
        ],
        "I–V curves": curves,
        f"falling branch at β_c = 10, {points[0].work}": [
            {
                "method": point.method,
                "setting": point.setting,
                **spent(point.timing, "s"),
                "error / Ic R": point.error,
            }
            for point in points
        ],
        "losses": losses(points, WHY),
        "bars": [
            *(results.bar(name, error, at_most=limit) for name, error, limit in voltages),
            results.bar("currents up and down at four β_c, s", seconds(four), at_most=1),
        ],
    }


def of_beta_c(beta_c):
    return JosephsonJunction(IC, R, beta_c * FLUX_QUANTUM / (2 * np.pi * IC * R**2))


def still(seed: int, scenes: int) -> tuple[str, float, float]:
    """Of the down branch from 0.1 % above Ir to 10 Ir, against a turn in Arb."""
    rng = np.random.default_rng(seed)
    volts, rows = [], []
    for _ in range(scenes):
        beta_c = 10 ** rng.uniform(-1, 3)
        beta = beta_c**-0.5
        tau = float(retrapping_torque(beta)) * (1 + 10 ** rng.uniform(-3, 1))
        volts.append(float(iv_curve(of_beta_c(beta_c), tau * IC).voltage_down))
        rows.append((beta, tau))
    true = IC * R * np.array(cores.each(_voltage, rows, worth=10))
    off = np.abs(volts / true - 1)
    return "without a drive, relative", float(off.max()), 1e-9


def _voltage(row) -> float:
    beta, tau = row
    return beta * float(fate_references.mean_velocity(beta, tau))


def shapiro(seed: int, scenes: int) -> list[tuple[str, float, float]]:
    """Of first-order junctions: true error over the height of a step, and over the stated one."""
    rng = np.random.default_rng(seed)
    curves, rows = [], []
    for _ in range(scenes):
        i0, i1, omega = rng.uniform(-3, 3), rng.uniform(0, 3), 10 ** rng.uniform(-0.6, 1.5)
        drive = i1 * IC, omega * IC * R / FLUX_QUANTUM
        curve = iv_curve(JosephsonJunction(IC, R), i0 * IC, drive=drive)
        rows.append((i0 * IC / IC, drive[0] / IC, FLUX_QUANTUM * drive[1] / (IC * R)))
        curves.append((curve, FLUX_QUANTUM * drive[1]))
    share, off = [], []
    turning = cores.each(_turning, rows, worth=10)
    for (curve, step), turns in zip(curves, turning, strict=True):
        true = turns * step
        error = abs(float(curve.voltage_up) - true)
        off.append(error / step)
        share.append(error / (float(curve.error_up) + 4e-16 * abs(true) + 1e-30))
    return [
        ("under a drive, first order, over a step", max(off), 1e-6),
        ("under a drive, over the error that is stated", max(share), 1),
    ]


def _turning(row) -> float:
    return float(references.rotation_number(*row))


def times(rounds: int, quick: bool):
    """Of four curves at once, and the rows of all."""
    count = 20 if quick else 200
    current = np.linspace(0, 3, count) * IC
    drive = IC, 0.5 * IC * R / FLUX_QUANTUM
    still = {"β_c = 0.1, 1, 10, 100": partial(iv_curve, of_beta_c(BETA_C), current)}
    first, second = JosephsonJunction(IC, R), of_beta_c(1.0)
    driven = {"first order, under a drive": partial(iv_curve, first, current, drive=drive)}
    if not quick:  # it takes longest to compile
        driven["β_c = 1, under a drive"] = partial(iv_curve, second, current, drive=drive)
    taken = side_by_side(still, rounds) | side_by_side(driven, 3)
    rows = [
        {"junction": name, "currents": count, **spent(timing, "s")}
        for name, timing in taken.items()
    ]
    return next(iter(taken.values())), rows


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


def by_pyjjasim(pyjjasim, beta, tau, span, dt):
    """All currents side by side, each coming down from 2.5 Ic."""
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


def front(rounds: int, quick: bool) -> list[Point]:
    """Largest error and run time of the down branch at β_c = 10."""
    beta, count = 10**-0.5, 6 if quick else 50
    tau = np.linspace(1.01 * float(retrapping_torque(beta)), 2, count)
    true = np.array(cores.each(_voltage, [(beta, x) for x in tau], worth=10))
    points = []

    def note(method, timing, found, setting=""):
        error = float(np.max(np.abs(np.asarray(found) - true)))
        points.append(Point(f"{count} currents", method, timing, error, setting))

    def ours(dtype):
        junction = jax.tree.map(lambda x: jax.numpy.asarray(x, dtype), of_beta_c(10.0))
        current = jax.numpy.asarray(tau * IC, dtype)
        return lambda: iv_curve(junction, current).voltage_down / (IC * R)

    calls = {dtype: ours(dtype) for dtype in ("float64", "float32")[: 1 if quick else 2]}
    for dtype, timing in side_by_side(calls, rounds).items():
        note("pendax", timing, calls[dtype](), dtype)
    scripts = [
        (200, "RK45", 1e-3),
        (200, "DOP853", 1e-6),
        (1000, "DOP853", 1e-8),
    ]
    for span, method, rtol in scripts[: 2 if quick else None]:
        run = once(partial(by_scipy, beta, tau, span, method, rtol))
        note("SciPy, a script", *run, f"{method}, rtol {rtol:.0e}, to t = {span}")
    if (pyjjasim := _pyjjasim()) is not None:
        for span, dt in [(200, 0.1), (1000, 0.05), (5000, 0.05), (5000, 0.02)][: 1 if quick else 4]:
            run = once(partial(by_pyjjasim, pyjjasim, beta, tau, span, dt))
            note("pyjjasim", *run, f"dt {dt:g}, to t = {span}")
    return points


def _pyjjasim():
    np.asscalar = lambda x: x.item()  # its release of 2022 still asks for it
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return library("pyjjasim")


def _draw(points: list[Point]) -> None:
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
        methods = {}
        for point in points:
            name = f"pendax, {point.setting}" if point.ours else point.method
            methods.setdefault(name, []).append((point.error, point.timing.median))
        methods = {name: tuple(zip(*rows, strict=True)) for name, rows in methods.items()}
        plot.work_precision(right, methods, error=r"largest error / $I_c R$")
        right.set_title(f"{points[0].work} of the falling branch")
        figure.savefig(results.folder() / "junction.png")
