"""θ̈ + β θ̇ + ε sin θ = τ to 30 digits: Taylor series of order 40 in Arb, with derivatives."""

import flint

ORDER, BITS, SMALL = 40, 160, -36  # the last terms are below 1e-36


def trajectory(epsilon, beta, tau, theta0, v0, ts, slopes=()):
    """Rows (θ, v) at increasing `ts`, for parameters that are floats (or 0 for none).

    With `slopes`, names out of "epsilon", "beta", "tau", "theta0", "v0", each row goes on with
    (∂θ, ∂v) by each of them.
    """
    with flint.ctx.workprec(BITS):
        epsilon, beta, tau, theta, v = map(flint.arb, (epsilon, beta, tau, theta0, v0))
        zero, one = flint.arb(0), flint.arb(1)
        # Per direction: θ's and v's changes, and those of ε, β, τ.
        moved = [
            [one if name == x else zero for x in ("theta0", "v0", "epsilon", "beta", "tau")]
            for name in slopes
        ]
        t, rows = zero, []
        for target in ts:
            target = flint.arb(target)
            while t < target:
                scene = (epsilon, beta, tau)
                series = _series(*scene, theta, v, [m[0] for m in moved], [m[1] for m in moved],
                                 [m[2:] for m in moved])  # fmt: skip
                h = min(_step(series[0]), _step(series[1]))
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


def _series(epsilon, beta, tau, theta, v, dthetas, dvs, rates):
    """Coefficients of θ, v and of every direction's two."""
    thetas, vs = [theta], [v]
    sines, cosines = [theta.sin()], [theta.cos()]
    moved = [([a], [b]) for a, b in zip(dthetas, dvs, strict=True)]
    for n in range(ORDER):
        force = -epsilon * sines[n] - beta * vs[n] + (tau if n == 0 else 0)
        vs.append(force / (n + 1))
        thetas.append(vs[n] / (n + 1))
        for (dtheta, dv), (of_epsilon, of_beta, of_tau) in zip(moved, rates, strict=True):
            bent = sum((cosines[k] * dtheta[n - k] for k in range(n + 1)), flint.arb(0))
            change = -epsilon * bent - beta * dv[n] - of_epsilon * sines[n] - of_beta * vs[n]
            dv.append((change + (of_tau if n == 0 else 0)) / (n + 1))
            dtheta.append(dv[n] / (n + 1))
        sine = sum((vs[k] * cosines[n - k] for k in range(n + 1)), flint.arb(0))
        cosine = sum((vs[k] * sines[n - k] for k in range(n + 1)), flint.arb(0))
        sines.append(sine / (n + 1))
        cosines.append(-cosine / (n + 1))
    return [thetas, vs, *(x for pair in moved for x in pair)]


def _step(coefficients) -> float:
    """From the logarithm of the last ones: they may be far below the range of floats."""
    sizes = []
    for n in (ORDER - 1, ORDER):
        size = abs(coefficients[n].mid())
        if size > 0:
            log = float(size.log()) / 2.302585092994046
            sizes.append(10 ** ((SMALL - log) / n))
    return min(sizes, default=1.0)


def _sum(coefficients, h):
    total = coefficients[-1]
    for x in coefficients[-2::-1]:
        total = total * h + x
    return total.mid()
