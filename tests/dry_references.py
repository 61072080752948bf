"""θ̈ + β θ̇ + c sign θ̇ + ε sin θ = τ to 30 digits: Arb's series from one turning point to the next.

τ is a number, or a list of (t, τ) that straight lines join.
"""

import flint
from damped_references import BITS, ORDER, SMALL, _sum, folded

SHORT = 0.25  # of the quickest rate: a step that no motion turns twice in


def trajectory(epsilon, beta, tau, dry, theta0, v0, ts):
    """Rows (θ, v) at increasing `ts` from t = 0 on, the turning points (t, θ) before the last, and
    whether it rests there."""
    with flint.ctx.workprec(BITS):
        table = isinstance(tau, list)
        knots = [(flint.arb(t), flint.arb(x)) for t, x in tau] if table else None
        epsilon, beta, dry, theta, v = map(flint.arb, (epsilon, beta, dry, theta0, v0))
        t, rows, turns = flint.arb(0), [], []

        def torque(line):
            if knots is None:
                return flint.arb(tau), flint.arb(0), None
            (t0, x0), (t1, x1) = knots[line : line + 2]
            slope = (x1 - x0) / (t1 - t0)
            return x0 + slope * (t - t0), slope, t1

        line = 0
        way = _way(epsilon, dry, torque(line)[0], theta, v)
        for target in map(flint.arb, ts):
            while t < target:
                value, slope, knot = torque(line)
                end = target if knot is None or target < knot else knot
                if way == 0:
                    force = value - epsilon * theta.sin()
                    after = end
                    if slope != 0:
                        onwards = 1 if slope > 0 else -1
                        wait = (onwards * dry - force) / slope
                        if wait < end - t:
                            after, way = (t + wait).mid(), onwards
                    t = after
                else:
                    thetas, vs = _series(epsilon, beta, value - way * dry, slope, theta, v)
                    # The last two terms say nothing where they vanish.
                    force = epsilon + abs(value) + abs(slope) + dry
                    short = SHORT / max(float(force) ** 0.5, float(abs(v)), float(beta))
                    h = min(_size(thetas), _size(vs), short)
                    left = end - t
                    last = not flint.arb(h) < left
                    h = left if last else flint.arb(h)
                    begins = vs[0] == 0
                    q = vs[1:] if begins else vs
                    if way * _sum(q, h) <= 0:
                        h = _zero(q, h)
                        theta, v, t = _sum(thetas, h), flint.arb(0), (t + h).mid()
                        turns.append((float(t), float(theta)))
                        force = (value + slope * h) - epsilon * theta.sin()
                        way = 0 if way * force >= -dry else -way
                    else:
                        theta, v = _sum(thetas, h), _sum(vs, h)
                        t = end if last else (t + h).mid()
                if knot is not None and t >= knot and line + 2 < len(knots):
                    line += 1
            rows.append((theta, v))
        return rows, turns, way == 0


def _way(epsilon, dry, tau, theta, v):
    if v != 0:
        return 1 if v > 0 else -1
    force = tau - epsilon * theta.sin()
    if abs(force) <= dry:
        return 0
    return 1 if force > 0 else -1


def _series(epsilon, beta, tau, slope, theta, v):
    thetas, vs, sines, cosines = [theta], [v], [theta.sin()], [theta.cos()]
    zero = flint.arb(0)
    for n in range(ORDER):
        push = tau if n == 0 else slope if n == 1 else zero
        vs.append((push - epsilon * sines[n] - beta * vs[n]) / (n + 1))
        thetas.append(vs[n] / (n + 1))
        sine = folded(vs, cosines)
        cosine = folded(vs, sines)
        sines.append(sine / (n + 1))
        cosines.append(-cosine / (n + 1))
    return thetas, vs


def _size(coefficients):
    sizes = [1e3]
    for n in (ORDER - 1, ORDER):
        size = abs(coefficients[n].mid())
        if size > 0:
            log = float(size.log()) / 2.302585092994046
            sizes.append(10 ** ((SMALL - log) / n))
    return min(sizes)


def _zero(q, h):
    """Of a polynomial that changes its sign between 0 and h: halved, then Newton's."""
    low, high = flint.arb(0), h
    sign = q[0] > 0 if q[0] != 0 else q[1] > 0
    for _ in range(12):
        middle = ((low + high) / 2).mid()
        if (_sum(q, middle) > 0) == sign:
            low = middle
        else:
            high = middle
    x = ((low + high) / 2).mid()
    slopes = [n * a for n, a in enumerate(q)][1:]
    for _ in range(7):
        x = (x - _sum(q, x) / _sum(slopes, x)).mid()
    return x


def slopes(names, scene, ts, by=1e-16):
    """∂(θ, v) by each name at every time: central differences of the same piecewise motion."""
    with flint.ctx.workprec(BITS):
        h = flint.arb(by)
        columns = []
        for name in names:
            ends = []
            for sign in (1, -1):
                moved = scene | {name: flint.arb(scene[name]) + sign * h}
                ends.append(trajectory(**moved, ts=ts)[0])
            columns.append(
                [[float((b - a) / (2 * h)) for a, b in zip(low, high, strict=True)]
                 for high, low in zip(*ends, strict=True)]
            )  # fmt: skip
        return columns
