"""Junctions under i0 + i1 sin Ωs to some 30 digits: steps of Taylor series in Arb."""

import damped_references as steps
import flint
from flint import acb, arb

TERMS = 40


def _current(i0, i1, omega, s):
    """Coefficients of the current around s."""
    sine, cosine = (omega * s).sin(), (omega * s).cos()
    waves, growth, terms = (sine, cosine, -sine, -cosine), i1, []
    for n in range(TERMS + 1):
        terms.append(growth * waves[n % 4])
        growth = growth * omega / (n + 1)
    return [terms[0] + i0, *terms[1:]]


def phase(i0, i1, omega, phi, s_end, beta=None, v=0.0):
    """φ and φ' at `s_end`, of φ' = i − sin φ or, with β, of φ'' + β φ' + sin φ = i."""
    with flint.ctx.workprec(steps.BITS):
        i0, i1, omega, phi, s_end, v = map(arb, (i0, i1, omega, phi, s_end, v))
        s = arb(0)
        while s < s_end:
            current = _current(i0, i1, omega, s)
            phis, vs = [phi], [v]
            sines, cosines = [phi.sin()], [phi.cos()]
            for n in range(TERMS):
                if beta is None:
                    vs[n:] = [current[n] - sines[n]]
                else:
                    vs.append((current[n] - sines[n] - arb(beta) * vs[n]) / (n + 1))
                phis.append(vs[n] / (n + 1))
                sine = steps.folded(vs, cosines)
                cosine = -steps.folded(vs, sines)
                sines.append(sine / (n + 1))
                cosines.append(cosine / (n + 1))
            h = min(steps._step(phis), steps._step(current), 1.5 / max(1, beta or 0))
            last = not arb(h) < s_end - s
            h = s_end - s if last else arb(h)
            phi, v = steps._sum(phis, h).mid(), steps._sum(vs, h).mid()
            s = s_end if last else (s + h).mid()
        if beta is None:
            v = _current(i0, i1, omega, s_end)[0] - phi.sin()
        return phi, v


def half_trace(i0, i1, omega):
    """Re a of the map of e^{iφ} in a period."""
    with flint.ctx.workprec(steps.BITS):
        i0, i1, omega = map(arb, (i0, i1, omega))
        period, s = 2 * arb.pi() / omega, arb(0)
        a, b = acb(1), acb(0)
        while s < period:
            current = _current(i0, i1, omega, s)
            of_a, of_b = [a], [b]
            for n in range(TERMS):
                turned = [
                    acb(0, 1) * sum((current[k] * x[n - k] for k in range(n + 1)), acb(0))
                    for x in (of_a, of_b)
                ]
                of_a.append((turned[0] + of_b[n]) / (2 * (n + 1)))
                of_b.append((of_a[n] - turned[1]) / (2 * (n + 1)))
            h = min(arb(1) / (1 + abs(i0) + abs(i1) + omega), period - s)
            a, b = (sum((x * h**n for n, x in enumerate(c)), acb(0)).mid() for c in (of_a, of_b))
            s = (s + h).mid() if h < period - s else period
        return a.real


def rotation_number(i0, i1, omega):
    """Turns a period: the whole ones from φ itself, followed for 20 periods, the rest from Re a."""
    with flint.ctx.workprec(steps.BITS):
        count = 20
        period = 2 * arb.pi() / arb(omega)
        after, _ = phase(i0, i1, omega, 0.0, count * period)
        rough, half = float(after / (2 * arb.pi() * count)), half_trace(i0, i1, omega)
        if abs(half) >= 1:
            near = [n for n in range(-40, 41) if n % 2 == (half < 0)]
            values = [arb(n) for n in near]
        else:
            angle = half.acos() / arb.pi()
            values = [2 * n + sign * angle for n in range(-20, 21) for sign in (1, -1)]
        return min(values, key=lambda x: abs(float(x) - rough))
