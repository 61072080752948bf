"""Maximal and mean errors by region, pendax and SciPy side by side.

In eps = 2^-52, of |f| + |u df/du| for the Jacobi functions (the error that a rounding of
u makes, and of the value itself), of |f| for K and E, and of |f| + the sum of |x df/dx|
over all arguments elsewhere.
"""

from collections.abc import Callable, Iterator

import flint
import jax.numpy as jnp
import numpy as np
import references
import scipy.special
from cases import cases

from pendax import special

from . import integrals, results
from .compared import error_loss

EPS = 2.0**-52
PROMISED = {  # by the docstrings
    "sn, cn, dn": 8,
    **dict.fromkeys(("ellipk", "ellipe", "ellipkm1"), 3),
    **dict.fromkeys(("ellipnome", "arcsn"), 8),
    **dict.fromkeys(("ellipkinc", "ellipeinc", "ellippi", "ellippiinc"), 10),
    "elliprc": 6,
    "elliprf": 3.5,
    "elliprd": 4.5,
    "elliprg": 5.5,
    "elliprj": 20,
}
POLYNOMIAL = "Cephes: two polynomials and a logarithm; ours: the ladder, each rung of which rounds"
COMPENSATED = "SciPy's sums carry their rounding errors along; ours don't"
HALF_PERIODS = "half periods, which are rounded, are taken off u; Cephes leaves that to sin"
CHANCE = "chance: both are below one eps"
WHY = {
    "sn, cn, dn, at zero (m)": HALF_PERIODS,
    "sn, cn, dn, at one (m)": "Cephes goes on with tanh; ours come from sinh and cosh",
    "sn, cn, dn, quarter periods (m)": HALF_PERIODS,
    "sn, cn, dn, huge u (m)": HALF_PERIODS,
    "ellipk": POLYNOMIAL,
    "ellipe": POLYNOMIAL,
    "ellipkinc": "Carlson's form and a sine; Cephes descends to an arctangent",
    "ellipeinc": "two of Carlson's forms are added; Cephes descends to an arctangent",
    **dict.fromkeys(("elliprf", "elliprc", "elliprd", "elliprg", "elliprj"), COMPENSATED),
}


def measure(seed: int, quick: bool) -> results.Tables:
    points = 24 if quick else 300
    rows, behind, largest = [], [], {}
    for function, region, ours, theirs in errors(points, seed, quick):
        ours, theirs = _max_and_mean(ours), _max_and_mean(theirs)
        columns = {"max": ours[0], "mean": ours[1], "SciPy max": theirs[0], "SciPy mean": theirs[1]}
        rows.append({"function": function, "region": region, **columns})
        largest[function] = max(largest.get(function, 0.0), ours[0])
        where = f"{function}, {region}"
        if theirs[0] is not None and theirs[0] < ours[0]:
            why = WHY.get(function, CHANCE if ours[0] < 1 else "unexplained")
            why = WHY.get(where, why)
            behind.append(error_loss(where, "SciPy", ours[0], theirs[0], why))
    return {
        f"errors in eps of their scale, {points} random points a region": rows,
        "losses": behind,
        "bars": [
            results.bar(f"{function}, eps × scale", error, at_most=PROMISED[function])
            for function, error in largest.items()
        ],
    }


def _max_and_mean(errors) -> tuple[float | None, float | None]:
    if errors is None or not np.isfinite(errors).all():
        return None, None
    return float(np.max(errors)), float(np.mean(errors))


def errors(points: int, seed: int, quick: bool) -> Iterator[tuple]:
    """(function, region, errors of pendax, of SciPy or None)."""
    for tag, case in cases("float64", points, seed).items():
        yield "sn, cn, dn", f"{tag} ({case.name})", *jacobi_errors(case)
    for name, region, x in complete_cases(points, seed):
        ours = complete_errors(name, x, np.asarray(getattr(special, name)(x)))
        yield name, region, ours, complete_errors(name, x, getattr(scipy.special, name)(x))
    for name, region, ours in inverse_errors(points, seed):
        yield name, region, ours, None
    yield from integrals.accuracy(points, seed, quick)


def jacobi_errors(case) -> tuple[np.ndarray, np.ndarray | None]:
    """The largest of the three functions' at each point; None where SciPy has no value."""
    u, p = case.u, case.parameter
    m = p if case.name == "m" else 1 - p
    ours = np.stack(special.ellipj(u, **{case.name: p})[:3])
    theirs = np.stack(scipy.special.ellipj(u, m)[:3])
    errors = [jacobi_error(case.name, *at) for at in zip(u, p, ours.T, theirs.T, strict=True)]
    mine, scipys = np.array(errors).T
    return mine, None if np.isnan(theirs).any() else scipys


def jacobi_error(name, u, parameter, *rows) -> list[float]:
    tiny = abs(parameter) if name == "m1" else 1.0
    bits = 300 + int(-2 * np.log2(tiny)) + int(2 * abs(np.log2(abs(u) + 1e-300)))
    with flint.ctx.workprec(bits):
        p = flint.arb(float(parameter))
        m, m1 = (p, 1 - p) if name == "m" else (1 - p, p)
        s, c, d = references.ball_jacobi(flint.arb(float(u)), m, m1)
        slopes = (c * d, s * d, m * s * c)
        worst = []
        for row in rows:
            parts = [
                float(abs(flint.arb(float(got)) - f) / (abs(f) + abs(float(u) * slope)))
                for got, f, slope in zip(row, (s, c, d), slopes, strict=True)
            ]
            worst.append(max(parts) / EPS)
        return worst


def complete_cases(points: int, seed: int):
    rng = np.random.default_rng(seed)
    inside, tiny = rng.uniform(0, 1, points), 10 ** rng.uniform(-307, 0, points)
    huge = 10 ** rng.uniform(0, 300, points)
    for name in ("ellipk", "ellipe"):
        yield name, "0 < m < 1", inside
        yield name, "m near 1", 1 - 10 ** rng.uniform(-16, -1, points)
        yield name, "m < 0", -huge
    yield "ellipkm1", "tiny m1", tiny
    yield "ellipkm1", "m1 > 1", huge


def complete_errors(name: str, x: np.ndarray, got: np.ndarray) -> list[float]:
    with flint.ctx.workprec(2300):
        errors = []
        for value, at in zip(got, map(float, x), strict=True):
            m = 1 - flint.arb(at) if name == "ellipkm1" else flint.arb(at)
            complete = flint.acb.elliptic_e if name == "ellipe" else flint.acb.elliptic_k
            true = complete(flint.acb(m)).real
            errors.append(float(abs(flint.arb(float(value)) / true - 1)) / EPS)
        return errors


def inverse_errors(points: int, seed: int):
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1, 1, points)
    for name, parameter in (
        ("m", rng.uniform(0, 1, points)),
        ("m1", 10 ** rng.uniform(-300, 0, points)),
    ):
        region = "0 < m < 1" if name == "m" else "m1 from 1e-300"
        got = np.asarray(special.ellipnome(**{name: jnp.asarray(parameter)}))
        yield "ellipnome", region, scaled(name, nome, [parameter], got)
        got = np.asarray(special.arcsn(x, **{name: jnp.asarray(parameter)}))
        yield "arcsn", region, scaled(name, inverse_sn, [x, parameter], got)


def scaled(name: str, function: Callable, columns: list, got: np.ndarray) -> list[float]:
    """Errors in eps × scale, the derivatives by differences."""
    with flint.ctx.workprec(2600):
        errors = []
        for value, *row in zip(got, *columns, strict=True):
            at = [flint.arb(float(x)) for x in row]
            true = function(name, *at)
            scale = abs(true)
            for k in range(len(at)):
                moved = list(at)
                moved[k] = at[k] * (1 + flint.arb(2) ** -200)
                scale += abs(function(name, *moved) - true) * flint.arb(2) ** 200
            errors.append(float(abs(flint.arb(float(value)) - true) / scale) / EPS)
        return errors


def nome(name: str, p: flint.arb) -> flint.arb:
    m, m1 = (p, 1 - p) if name == "m" else (1 - p, p)
    one = flint.arb(1)
    return (-flint.arb.pi() * one.agm(m1.sqrt()) / one.agm(m.sqrt())).exp()


def inverse_sn(name: str, x: flint.arb, p: flint.arb) -> flint.arb:
    m = p if name == "m" else 1 - p
    return flint.acb.elliptic_f(flint.acb(x.asin()), flint.acb(m)).real
