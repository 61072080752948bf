"""Ends of θ̈ + β θ̇ + sin θ = τ to some 30 digits: steps of Taylor series and events in Arb."""

import damped_references as steps
import flint
from flint import arb

TERMS = 40


def in_arb(function):
    def call(*arguments):
        with flint.ctx.workprec(steps.BITS):
            return function(*(arb(x) for x in arguments))

    return call


@in_arb
def fate(beta, tau, theta0, v0):
    """("captured", n) or ("running", ±1): by the energy of the lower neighbouring saddle, or by
    passing a saddle where even the slowest that passes comes to pass the next."""
    turn = 2 * arb.pi()
    if abs(tau) > 1:
        return "running", 1 if tau > 0 else -1
    downhill = -1 if tau < 0 else 1
    angle = tau.asin()

    def well(theta):
        return int(((theta + arb.pi() + angle) / turn).floor().unique_fmpz())

    theta, v, runs = theta0, v0, None
    while True:
        n = well(theta)
        saddle = turn * n + downhill * arb.pi() - angle
        energy = v * v / 2 - theta.cos() - tau * theta
        if energy < -saddle.cos() - tau * saddle:
            return "captured", n
        series = steps._series(arb(1), beta, [tau], theta, v, [], [], [])
        h = arb(min(steps._step(series[0]), steps._step(series[1]), 1.5 / max(1, float(beta))))
        after, moving = (steps._sum(x, h) for x in series)
        if well(after) == n + downhill and downhill * v > 0:
            if runs is None:
                x, speed = _leaving(beta, abs(tau))
                start = -arb.pi() - abs(tau).asin()
                runs = _onwards(beta, abs(tau), start + x, speed, start + turn) is not None
            if runs:
                return "running", downhill
        theta, v = after, moving


def _crossing(series, angle, h):
    """When a step passes that angle, and its velocity there."""
    theta, v = series
    t = h * (angle - theta[0]) / (steps._sum(theta, h) - theta[0])
    for _ in range(60):
        miss = steps._sum(theta, t) - angle
        if abs(miss) < arb("1e-40"):
            break
        t = (t - miss / steps._sum(v, t)).mid()
    return t, steps._sum(v, t)


def _onwards(beta, tau, theta, v, angle):
    """The time to `angle`, passed with v > 0, and the velocity there; or None if it turns back."""
    t = arb(0)
    while True:
        series = steps._series(arb(1), beta, [tau], theta, v, [], [], [])
        h = arb(min(steps._step(series[0]), steps._step(series[1]), 1.5 / max(1, float(abs(beta)))))
        after = steps._sum(series[0], h)
        if after > angle:
            passed, v = _crossing(series[:2], angle, h)
            return t + passed, v
        theta, v, t = after, steps._sum(series[1], h), t + h
        # Backwards, damping drives, and nothing stays.
        low = beta > 0 and v * v / 2 - theta.cos() - tau * theta < -angle.cos() - tau * angle
        if v < 0 or low:
            return None


@in_arb
def mean_velocity(beta, tau):
    """2π/T of the turn from the bottom that comes back with its own v²: by Newton's method, the
    slope of that map being exp(−βT), by which areas shrink."""
    turn, square = 2 * arb.pi(), ((tau / beta + 3) ** 2).mid()
    round_at = square
    for i in range(300):
        gone = _onwards(beta, tau, arb(0), square.sqrt(), turn)
        if gone is None:
            square = ((square + round_at) / 2).mid()
            continue
        round_at, (t, after) = square, gone
        after = after * after
        if abs(after - square) < arb("1e-31") * square:
            return turn / t
        # Turn by turn first: it comes down to the orbit from above, and doesn't overshoot.
        rate = 0 if i < 10 and beta > 0.05 else (-beta * t).exp()
        new = square + (after - square) / (1 - rate)
        square = (new if new > 0 else square / 2).mid()
    raise RuntimeError("the turn was not found")


def mean_velocity_overdamped(beta, tau):
    """By the slow curve β w = τ − sin θ − w w', iterated: errors are (1/β²)^6."""
    import mpmath as mp

    with mp.workdps(40):
        beta, tau = mp.mpf(beta), mp.mpf(tau)
        # Coefficients of exp(i k θ), k from −n to n.
        force = {0: mp.mpc(tau), 1: mp.mpc(0, 0.5), -1: mp.mpc(0, -0.5)}
        w = {k: x / beta for k, x in force.items()}
        for _ in range(5):
            product = {}
            for j, x in w.items():
                for k, y in w.items():
                    product[j + k] = product.get(j + k, 0) + x * y * mp.mpc(0, k)
            keys = set(force) | set(product)
            w = {k: (force.get(k, 0) - product.get(k, 0)) / beta for k in keys if abs(k) < 12}
        count = 400
        angles = [2 * mp.pi * i / count for i in range(count)]
        values = (sum(x * mp.expj(k * angle) for k, x in w.items()).real for angle in angles)
        return 1 / (sum(1 / x for x in values) / count)


@in_arb
def retrapping(beta):
    """τ at which what leaves one saddle reaches the next: velocities at the bottom, by secants."""

    def gap(tau):
        # Forwards from the one, and backwards from the other, where damping drives.
        return _at_bottom(beta, tau) - _at_bottom(-beta, -tau)

    guess = (4 / arb.pi() * beta - arb("0.3151") * beta**3 + arb("0.0044") * beta**5).mid()
    t0, t1 = guess, guess * arb("0.999")
    g0 = gap(t0)
    for _ in range(40):
        g1 = gap(t1)
        if abs(g1) < arb("1e-32"):
            break
        t0, g0, t1 = t1, g1, (t1 - g1 * (t1 - t0) / (g1 - g0)).mid()
    return t1


def _at_bottom(beta, tau):
    x, v = _leaving(beta, tau)
    return _onwards(beta, tau, -arb.pi() - tau.asin() + x, v, arb(0))[1]


def _leaving(beta, tau):
    """A point shortly after a saddle, and the velocity of what comes from that saddle."""
    kappa = ((1 - tau) * (1 + tau)).sqrt()
    a = [arb(0), (-beta + (beta * beta + 4 * kappa).sqrt()) / 2]
    for k in range(2, TERMS):
        force = (tau if k % 2 == 0 else kappa) * (-1) ** ((k - 1) // 2) / arb.fac_ui(k)
        known = sum((a[i] * a[k + 1 - i] for i in range(2, k)), arb(0))
        a.append((force - known * (k + 1) / 2) / ((k + 1) * a[1] + beta))
    # Well within the series' radius, some a₁/a₂.
    x = arb(min(0.05, 0.05 * float(abs(a[1] / a[2])))) if tau != 0 else arb("0.05")
    return x, sum((c * x**k for k, c in enumerate(a)), arb(0)).mid()
