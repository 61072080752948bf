"""θ̈ + β θ̇ + ε sin θ = τ to 30 digits: Taylor series of order 40 in Arb, with derivatives."""

import math
from operator import mul

import flint

ORDER, BITS, SMALL = 40, 160, -36  # the last terms are below 1e-36


def trajectory(epsilon, beta, tau, theta0, v0, ts, slopes=()):
    """Rows (θ, v) at increasing `ts`, for parameters that are floats (or 0 for none).

    With `slopes`, names out of "epsilon", "beta", "tau", "theta0", "v0", each row goes on with
    (∂θ, ∂v) by each of them.

    τ may be a function of `flint.arb_series`, whose changes within 1/4 s are seen; a slope is then
    another, how it changes with a parameter of its own.
    """
    with flint.ctx.workprec(BITS):
        epsilon, beta, theta, v = map(flint.arb, (epsilon, beta, theta0, v0))
        wave = tau if callable(tau) else lambda t: flint.arb_series([tau])
        bends = [
            x if callable(x) else lambda t, x=x: flint.arb_series([x == "tau"]) for x in slopes
        ]
        zero, one = flint.arb(0), flint.arb(1)
        # Per direction: θ's and v's changes, and those of ε, β; later those of τ's series.
        moved = [
            [one if name == x else zero for x in ("theta0", "v0", "epsilon", "beta")]
            for name in slopes
        ]
        t, rows = zero, []
        for target in ts:
            target = flint.arb(target)
            while t < target:
                push = _torque(wave, t)
                rates = [(*m[2:], _torque(x, t)) for m, x in zip(moved, bends, strict=True)]
                scene = (epsilon, beta, push)
                series = _series(*scene, theta, v, [m[0] for m in moved], [m[1] for m in moved],
                                 rates)  # fmt: skip
                # The last two terms say nothing where they vanish: from rest at 90° v has every
                # fourth alone.
                fast = max(float(epsilon) ** 0.5, beta, abs(v), float(abs(push[0])) ** 0.5)
                short = 0.5 / (max(fast, 2) if callable(tau) else fast)
                h = min(*(_step(x) for x in series), float(short))
                left = target - t
                last = not flint.arb(h) < left
                h = left if last else flint.arb(h)
                after = [_sum(x, h) for x in series]
                theta, v = after[:2]
                for i, row in enumerate(moved):
                    row[:2] = after[2 + 2 * i : 4 + 2 * i]
                t = target if last else (t + h).mid()
            rows.append([float(theta), float(v), *(float(x) for m in moved for x in m[:2])])
    return rows


def _torque(wave, t):
    flint.ctx.cap = ORDER + 1
    series = wave(flint.arb_series([t, 1]))
    return [series[n] for n in range(ORDER + 1)]


def _series(epsilon, beta, tau, theta, v, dthetas, dvs, rates):
    """Coefficients of θ, v and of every direction's two; those of `tau` as far as not 0."""
    thetas, vs = [theta], [v]
    sines, cosines = [theta.sin()], [theta.cos()]
    moved = [([a], [b]) for a, b in zip(dthetas, dvs, strict=True)]
    for n in range(ORDER):
        force = sum(tau[n : n + 1], -epsilon * sines[n] - beta * vs[n])
        vs.append(force / (n + 1))
        thetas.append(vs[n] / (n + 1))
        for (dtheta, dv), (of_epsilon, of_beta, of_tau) in zip(moved, rates, strict=True):
            bent = folded(dtheta, cosines)
            change = -epsilon * bent - beta * dv[n] - of_epsilon * sines[n] - of_beta * vs[n]
            dv.append((change + of_tau[n]) / (n + 1))
            dtheta.append(dv[n] / (n + 1))
        sine = folded(vs, cosines)
        cosine = folded(vs, sines)
        sines.append(sine / (n + 1))
        cosines.append(-cosine / (n + 1))
    return [thetas, vs, *(x for pair in moved for x in pair)]


def folded(a, b):
    """The last coefficient of b's of the product of the two, of which `a` may be the longer."""
    return sum(map(mul, a, reversed(b)), flint.arb(0))


def _step(coefficients) -> float:
    """From the logarithm of the last ones: they may be far below the range of floats."""
    sizes = []
    for n in (ORDER - 1, ORDER):
        size = abs(coefficients[n].mid())
        if size > 0:
            log = float(size.log()) / 2.302585092994046
            sizes.append(10 ** ((SMALL - log) / n))
    return min(sizes, default=math.inf)


def _sum(coefficients, h):
    total = coefficients[-1]
    for x in coefficients[-2::-1]:
        total = total * h + x
    return total.mid()


_STAGES = 10


def overdamped(epsilon, beta, tau, theta0, v0, ts):
    """Rows (θ, v) for large β: Gauss's collocation of order 20, A-stable, in Arb.

    Steps are 1/β until what relaxes is below 1e-30, then grow to a quarter of β/ε.
    """
    with flint.ctx.workprec(BITS):
        nodes, weights = _collocation()
        epsilon, beta, tau, theta, v = map(flint.arb, (epsilon, beta, tau, theta0, v0))
        t, rows, h = flint.arb(0), [], 1 / beta
        for target in map(flint.arb, ts):
            while t < target:
                if t > 70 / beta:
                    h = min(1.4 * h, beta / (4 * (epsilon + abs(tau))), key=float)
                step = h if h < target - t else target - t
                theta, v = _collocated(epsilon, beta, tau, theta, v, step, nodes, weights)
                t = target if step is not h else (t + h).mid()
            rows.append([float(theta), float(v)])
    return rows


def _collocation():
    """A, of ∫_0^{c_i}, and b, of ∫_0^1, at Gauss's nodes."""
    x = [(1 + flint.arb.legendre_p_root(_STAGES, k)) / 2 for k in range(_STAGES)]
    powers = flint.arb_mat([[c**j for j in range(_STAGES)] for c in x])
    inverse = powers.inv()
    ends = [*x, flint.arb(1)]
    moments = flint.arb_mat([[c ** (j + 1) / (j + 1) for j in range(_STAGES)] for c in ends])
    rule = (moments * inverse).tolist()
    return rule[:-1], rule[-1]


def _collocated(epsilon, beta, tau, theta, v, h, rule, weights):
    """Stages θ_i of θ = θ0 + h Σ a v, with v = v0 + h Σ a (τ − ε sin θ − β v), by Newton."""
    count = range(_STAGES)
    a = flint.arb_mat(rule)
    one = flint.arb_mat(_STAGES, _STAGES, [int(i == j) for i in count for j in count])
    ones = flint.arb_mat(_STAGES, 1, [1] * _STAGES)
    # v = (1 + h β A)⁻¹ (v0 + h A f), so that θ alone is left.
    relax = (one + a * (h * beta)).inv().mid()
    to_v = relax * a * h
    free = relax * ones * v
    to_theta = a * h
    stages = ones * theta
    for _ in range(40):
        force = flint.arb_mat(_STAGES, 1, [tau - epsilon * x[0].sin() for x in stages.tolist()])
        miss = stages - ones * theta - to_theta * (free + to_v * force)
        slope = flint.arb_mat(_STAGES, _STAGES)
        for i, x in enumerate(stages.tolist()):
            slope[i, i] = -epsilon * x[0].cos()
        stages = (stages - (one - to_theta * to_v * slope).solve(miss)).mid()
        if all(abs(x[0].mid()) < 1e-34 for x in miss.tolist()):
            break
    force = flint.arb_mat(_STAGES, 1, [tau - epsilon * x[0].sin() for x in stages.tolist()])
    vs = (free + to_v * force).tolist()
    forces = force.tolist()
    dtheta = sum((w * x[0] for w, x in zip(weights, vs, strict=True)), flint.arb(0))
    dv = sum(
        (w * (f[0] - beta * x[0]) for w, f, x in zip(weights, forces, vs, strict=True)),
        flint.arb(0),
    )
    return (theta + h * dtheta).mid(), (v + h * dv).mid()
