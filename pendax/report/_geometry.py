"""Claims of Suzuki & Suzuki's chapter 4: the geometry of the swing and of the rotation."""

import numpy as np

from .. import Pendulum
from .. import geometry as construction
from ._claim import Check, Claim
from ._computed import arrival, elementwise, jacobi, motion


@elementwise
def _construction(theta, v):
    return construction(Pendulum(), theta, v)._asdict()


_TOP, _THETA = np.radians([120.0, 150.0]), np.radians(70.0)


def _swing():
    """Points and lengths of Figs. 15 and 16, with l = 1, the moduli, and u = √ε t there."""
    modulus = np.sin(_TOP / 2)
    v = 2 * np.sqrt(modulus**2 - np.sin(_THETA / 2) ** 2)
    return _construction(_THETA, v), modulus, arrival(_THETA, 2 * modulus)


def _between(points, names: str):
    return np.linalg.norm(points[names[0]] - points[names[1]], axis=-1)


def _swing_lengths() -> Check:
    points, modulus, u = _swing()
    m = modulus**2
    sn, cn, dn, _ = jacobi(u, m)
    claimed = {
        "AE": 2 + 0 * m, "AB": 2 * modulus, "AD": 2 * m, "BE": 2 * np.sqrt(1 - m), "EP": 2 * dn,
        "AP": 2 * modulus * sn, "AN": 2 * m * sn**2, "ND": 2 * m * cn**2, "EN": 2 * dn**2,
        "NP": 2 * modulus * sn * dn, "AQ": 2 * m * sn, "NQ": 2 * m * sn * cn,
    }  # fmt: skip
    found = [_between(points, name) for name in claimed]
    return Check(np.stack(list(claimed.values())), np.stack(found), 1e-14)


def _angle(points, names: str):
    one, corner, two = (points[name] for name in names)
    cosine = np.sum((one - corner) * (two - corner), -1)
    return np.arccos(cosine / np.linalg.norm(one - corner, axis=-1)
                     / np.linalg.norm(two - corner, axis=-1))  # fmt: skip


def _swing_angles() -> Check:
    points, modulus, u = _swing()
    phi, half = jacobi(u, modulus**2)[3], _THETA / 2 + 0 * u
    right = 0.5 * np.pi + 0 * u
    claimed = {"AEB": _TOP / 2, "ABE": right, "ABD": _TOP / 2, "AEP": half, "APE": right,
               "APN": half, "ADQ": phi, "AQD": right, "AQN": phi}  # fmt: skip
    found = [_angle(points, name) for name in claimed]
    return Check(np.stack(list(claimed.values())), np.stack(found), 1e-13)


def _similar() -> Check:
    points, modulus, u = _swing()
    names = ("AD", "AB", "AE", "EN", "NP", "AN", "ND", "NQ")
    ad, ab, ae, en, np_, an, nd, nq = (_between(points, name) for name in names)
    sine = modulus * np.sin(_angle(points, "ADQ"))
    claimed = np.stack([modulus, modulus, np_ / an, nq / an, np.sin(_THETA / 2) + 0 * u])
    return Check(claimed, np.stack([ad / ab, ab / ae, en / np_, nd / nq, sine]), 1e-13)


def _critical():
    """Fig. 17: points, θ = 50°, and u."""
    theta = np.radians([50.0])
    return _construction(theta, 2 * np.cos(theta / 2)), theta, arrival(theta, 2.0)


def _critical_lengths() -> Check:
    points, theta, u = _critical()
    tanh, sech = np.tanh(u), 1 / np.cosh(u)
    claimed = [tanh, sech, 2 * tanh, 2 * tanh**2, 2 * tanh * sech]
    found = [np.sin(theta / 2), np.cos(theta / 2)]
    found += [_between(points, name) for name in ("AP", "AN", "NP")]
    return Check(np.stack(claimed), np.stack(found), 1e-14)


def _critical_angles() -> Check:
    points, theta, _ = _critical()
    return Check(theta / 2, np.stack([_angle(points, "ADQ"), _angle(points, "APN")]), 1e-13)


def _at_e() -> Check:
    points, _, u = _critical()
    points["O"] = 0 * points["A"]
    phi = jacobi(u, 1.0)[3]
    return Check(phi / 2, _angle(points, "OEP"), 1e-13, phi)


_LENGTH, _ROTATING = 1.3, 2 / 0.9  # of the rod; v0 = 2√ε/κ of Fig. 18


def _rotation():
    """Fig. 18: points, u, and the velocity at E."""
    theta = np.radians([70.0])
    v = np.sqrt(_ROTATING**2 - 4 * np.sin(theta / 2) ** 2)
    up = motion(_ROTATING, arrival(np.pi, _ROTATING))[1]
    return _construction(theta, v), arrival(theta, _ROTATING), up


def _rotation_lengths() -> Check:
    points, u, _ = _rotation()
    m = 0.9**2
    sn, cn, dn, _ = jacobi(u / 0.9, m)
    claimed = {"DE": 2 * (1 / m - 1) + 0 * u, "AD": 2 / m + 0 * u, "AP": 2 * sn, "EP": 2 * cn,
               "AN": 2 * sn**2, "EN": 2 * cn**2, "ND": 2 / m * dn**2, "NP": 2 * sn * cn,
               "AE": 2 + 0 * u}  # fmt: skip
    found = [_between(points, name) for name in claimed]
    return Check(np.stack(list(claimed.values())), np.stack(found), 1e-13)


def _top_speed() -> Check:
    return Check(np.sqrt(_ROTATING**2 - 4), _rotation()[2], 1e-13)


def _free_fall(factor) -> Check:
    points, _, up = _rotation()
    square = (_LENGTH * up) ** 2 / _LENGTH
    return Check(factor * square, _LENGTH * _between(points, "DE"), 1e-13, square / 2)


def _printed_argument() -> Check:
    epsilon, u = 4.0, _rotation()[1]
    t = u / np.sqrt(epsilon)
    printed, right = (jacobi(x, 0.9**2)[0] for x in (np.sqrt(epsilon * t), u / 0.9))
    return Check(printed, np.sin(np.radians([35.0])), 1e-13, right)


CLAIMS = (
    Claim("4.1 Fig15,16", "AB = 2lk, AD = 2lk², EP = 2l dn, AP = 2lk sn, AN, ND, EN, NP, AQ, NQ …",
          "lengths over l, formula / between points, θ_max = 120°, 150°, θ = 70°", _swing_lengths,
          ("15", "16")),
    Claim("4.1 Fig15,16", "∠AEB = ∠ABD = θ_max/2, ∠AEP = ∠APN = θ/2, ∠ADQ = ∠AQN = φ …",
          "angles, rad, by am / between points, θ_max = 120°, 150°, θ = 70°", _swing_angles,
          ("15", "16")),
    Claim("4.1 Fig15,16", "k = AD/AB = AB/AE, EN/NP = NP/AN, DN/NQ = NQ/AN, sin(θ/2) = k sin φ",
          "ratios, formula / between points, θ_max = 120°, 150°, θ = 70°", _similar, ("15", "16")),
    Claim("4.2 Fig17", "k = 1: sin(θ/2) = tanh u, cn = sech u, AP = 2l tanh u, AN, NP",
          "sin, cos and lengths over l, θ = 50°", _critical_lengths, ("17",)),
    Claim("4.2 Fig17", "k = 1: θ/2 = φ, ∠APN = φ", "angles, rad, θ = 50°", _critical_angles,
          ("17",)),
    Claim("4.2 Fig17", "∠OEP = φ/2", "∠OEP, rad, θ = 50°", _at_e, ("17",), ("S2-12",)),
    Claim("4.3 Fig18", "DE = 2l(1/κ² − 1), AD = 2l/κ², AP, EP, AN, EN, DN, NP by sn, cn, dn",
          "lengths over l, formula / between points, κ = 0.90, θ = 70°", _rotation_lengths,
          ("18",)),
    Claim("4.3 Fig18", "At E the angular velocity is √(v0² − 4ε)", "v, rad/s, κ = 0.90",
          _top_speed, ("18",)),
    Claim("4.3 Fig18", "DE = V_ff²/2g, the height of a free fall to V_E", "DE, m, l = 1.3",
          lambda: _free_fall(0.5), ("18",)),
    Claim("4.3 Fig18", "V_ff²/2g = V_ff²/(εl)", "DE, m, l = 1.3", lambda: _free_fall(1.0),
          ("18",), ("S2-13",)),
    Claim("4.3 Fig18", "sin(θ/2) = sn(√(εt), κ)", "sin 35°, κ = 0.90, ε = 4", _printed_argument,
          ("18",), ("S2-14",)),
)  # fmt: skip
