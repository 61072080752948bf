"""The free pendulum: closed form, diffrax, SciPy and heyoka, and SciML's comparison."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pendulum_references as references
import scipy.special

from pendax import Pendulum, energy, period, simulate, special
from pendax.solvers import Symplectic

from . import front, results
from .problems import Problem
from .timing import side_by_side

WHY: dict[tuple[str, str], str] = {}


def measure(seed: int, quick: bool) -> results.Tables:
    points, best, lost, titles = [], [], [], {}
    for problem in problems(seed, quick):
        titles[problem.name] = f"{problem.name} ({len(problem.v0)} lanes)"
        rows, peers, losses = front.measure(problem, quick)
        points, best, lost = points + rows, best + peers, lost + losses
    front.draw(points, "free", quick, titles)
    cost, bars = ([], []) if quick else costs(seed, 2**20, 11)
    tables = {
        "error against run time": points,
        "at each peer's least error": best,
        "losses": front.explained(lost, WHY),
        "what the closed form costs": cost,
        "SciML's single pendulum": sciml(quick),
        "on the separatrix": [] if quick else falling(),
    }
    return {**tables, "bars": bars + front.reasons(lost, WHY, quick)}


def problems(seed: int, quick: bool) -> list[Problem]:
    rng = np.random.default_rng(seed)
    turn = float(period(Pendulum(), 1.5))
    near = 2 - 10 ** rng.uniform(-9, -6, 1024)
    some = rng.uniform(1.4, 1.6, 1024)
    if quick:
        return [Problem("near the separatrix", near[:64], 60.0)]
    return [
        Problem("1 period", some, turn),
        Problem("100 periods", some[:128], 100 * turn),
        Problem("10,000 periods", some[:16], 10_000 * turn),
        Problem("near the separatrix", near[:128], 60.0),
    ]


def costs(seed: int, size: int, rounds: int) -> tuple[list[results.Row], list[results.Row]]:
    """What the closed form costs, beside one `ellipj` of the same size."""
    rng = np.random.default_rng(seed)
    t, v0, theta0, epsilon, m = (
        jnp.asarray(rng.uniform(*ends, size))
        for ends in ((-20, 20), (-4, 4), (-3, 3), (0.5, 2), (0, 1))
    )

    def trajectory(t, v0, theta0):
        run = simulate(Pendulum(), t, v0, theta0)
        return run.theta, run.v

    def pendulums(epsilon, v0, theta0):
        run = simulate(Pendulum(epsilon), 7.0, v0, theta0)
        return run.theta, run.v

    def with_gradient(function, *arguments):
        values, pullback = jax.vjp(function, *arguments)
        return values, pullback(jax.tree.map(jnp.ones_like, values))

    def of_v0(t, v0, theta0):
        return with_gradient(lambda v0: trajectory(t, v0, theta0), v0)

    one = jnp.asarray(1.3), jnp.asarray(0.4)
    calls = {
        "ellipj, one m": partial(jax.jit(special.ellipj), t, 0.7),
        "one pendulum, many times": partial(jax.jit(trajectory), t, *one),
        "one pendulum, many times, θ alone": partial(
            jax.jit(lambda *x: trajectory(*x)[0]), t, *one
        ),
        "one pendulum, many times, with the gradient in v0": partial(jax.jit(of_v0), t, *one),
        "ellipj, u and m": partial(jax.jit(special.ellipj), t, m),
        "many pendulums, one time": partial(jax.jit(pendulums), epsilon, v0, theta0),
        "many pendulums, with the gradient in ε, v0, θ0": partial(
            jax.jit(partial(with_gradient, pendulums)), epsilon, v0, theta0
        ),
    }
    spent = side_by_side(calls, rounds)
    rows = [
        {"work": name, "ns": time.median / size * 1e9, "spread": time.spread}
        for name, time in spent.items()
    ]
    names, bars = list(spent), []
    for work, unit, limit in ((1, 0, 1.3), (3, 1, 3), (5, 4, 2), (6, 5, 3)):
        ratio = spent[names[work]].over(spent[names[unit]])
        bars.append(results.bar(f"{names[work]} / {names[unit]}", ratio, at_most=limit))
    return rows, bars


def sciml(quick: bool) -> list[results.Row]:
    """q = 2 arcsin(k sn(t, k)), p = 2 k cn(t, k) over 25 small periods, as SciML compares its
    symplectic methods: largest error of q, and of the energy relative to 2 k²."""
    import flint

    ts = np.linspace(0, 50 * np.pi, 201)[1:]
    times, rows = jnp.asarray(ts), []
    calls = {("closed form", ""): jax.jit(lambda v0: _both(simulate(Pendulum(), times, v0)))}
    for degree in (2,) if quick else (2, 4, 6):
        for step in (0.1, 0.02):
            options = {"solver": Symplectic(degree), "dt0": step, "throw": False}
            calls[f"Symplectic({degree})", f"dt = {step}"] = jax.jit(
                lambda v0, options=options: _both(simulate(Pendulum(), times, v0, **options))
            )
    calls["SciPy ellipj", "2 arcsin(k sn)"] = lambda v0: (
        2 * np.arcsin(v0 / 2 * scipy.special.ellipj(ts, v0**2 / 4)[0]),
        v0 * scipy.special.ellipj(ts, v0**2 / 4)[1],
    )
    for k in (0.99,) if quick else (0.1, 0.5, 0.9, 0.99, 0.999, 0.999999):
        v0 = 2 * k
        with flint.ctx.workprec(200):
            at = [flint.arb(x) for x in (1.0, v0, 0.0)]
            true = np.array(
                [float(references.motion(at[0], flint.arb(float(t)), *at[1:])[0]) for t in ts]
            )
        bound = {key: partial(call, v0) for key, call in calls.items()}
        spent = side_by_side(bound, 3)
        for (method, setting), call in bound.items():
            q, p = (np.asarray(x) for x in call())
            drift = np.asarray(energy(Pendulum(), q, p)) / (2 * k * k) - 1
            time = spent[method, setting]
            rows.append({
                "k": f"{k:g}", "method": method, "setting": setting, "ms": time.median * 1e3,
                "spread": time.spread, "error of q": float(np.max(np.abs(q - true))),
                "of the energy": float(np.max(np.abs(drift))),
            })  # fmt: skip
    return rows


def _both(run):
    return run.theta, run.v


def falling() -> list[results.Row]:
    """v0 = 2√ε: θ → π and stays; how long each method holds."""
    import diffrax as dfx

    ts = jnp.linspace(0.0, 100.0, 201)  # a solver steps no further than from one to the next
    exact = simulate(Pendulum(), ts, 2.0)
    cases = [(None, "closed form", {})]
    solvers = [(dfx.Tsit5(), (1e-4, 1e-8, 1e-12)), (dfx.Dopri8(), (1e-4, 1e-8, 1e-12, 1e-14))]
    solvers += [(dfx.Kvaerno5(), (1e-4, 1e-8))]
    for solver, rtols in solvers:
        cases += [(solver, type(solver).__name__, {"rtol": rtol}) for rtol in rtols]
    for degree in (2, 4, 6):
        cases.append((Symplectic(degree), f"Symplectic({degree})", {"dt0": 0.05}))
    rows = []
    for solver, name, options in cases:
        if solver is not None:
            options = {"solver": solver, "throw": False, "max_steps": 2**22, **options}
        run = simulate(Pendulum(), ts, 2.0, **options)
        off = jnp.abs(run.theta - exact.theta) > 0.1
        fell = bool(off.any())
        shown = {"rtol", "dt0"} & options.keys()
        rows.append({
            "method": name, "setting": ", ".join(f"{key} = {options[key]:g}" for key in shown),
            "off by 0.1 rad at t": float(ts[jnp.argmax(off)]) if fell else None,
            "which way": ("over" if float(run.theta[-1]) > 3.3 else "back") if fell else None,
        })  # fmt: skip
    return rows
