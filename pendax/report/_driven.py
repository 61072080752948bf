"""Claims of Suzuki & Suzuki's chapter 8 and appendix H: torque, the Josephson junction."""

from functools import cache

import numpy as np

from .. import FLUX_QUANTUM, JosephsonJunction, Pendulum, critical_torque, fixed_points, iv_curve
from ._claim import Check, Claim
from ._resistive import ended, followed

_STENCIL = 0.01 * np.arange(-4, 5)  # of eighth order, where rounding is 1e-11 of θ̈
_FIRST = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / (840 * 0.01)
_SECOND = np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / (5040 * 1e-4)


def _torque() -> Check:
    mass, length, damping, torque = 0.3, 0.4, 0.02, np.array([0.1, 0.5, 1.0])
    inertia = mass * length**2
    beta, tau, epsilon = damping / inertia, torque / inertia, 9.81 / length
    theta = followed(beta, tau, 3.0, 1 + _STENCIL / 5, epsilon=epsilon)[0]  # √ε is 5
    weight = mass * 9.81 * length * np.sin(theta[:, 4])
    found = 25 * inertia * theta @ _SECOND + 5 * damping * theta @ _FIRST + weight
    return Check(torque, found, 1e-8)


def _small_units() -> Check:
    scene = Pendulum.from_si(0.4, 9.81, 0.3, 0.02, 0.5)
    inertia = 0.3 * 0.4**2
    given = (np.asarray(x) for x in (scene.epsilon, scene.beta, scene.tau))
    return Check([9.81 / 0.4, 0.02 / inertia, 0.5 / inertia], np.stack(list(given)), 1e-12)


_FIVE = np.array([0, 0.2, 0.4, 0.6, 0.8])


@cache
def _critical():
    return np.asarray(critical_torque(Pendulum(1.0, 0.16), np.array([0.2, 1.98])))


def _runs(tau, v0):
    theta, v = followed(0.16, tau, v0, [400.0, 410.0])
    return theta[:, 1] - theta[:, 0] > 1, theta, v


def _open() -> Check:
    return Check([0, 0, 0, 0, 1], _runs(_FIVE, 0.2)[0], 0)


def _shift() -> Check:
    theta = _runs(_FIVE[:4], 0.2)[1]
    return Check(np.sin(theta[:, 1]), _FIVE[:4], 1e-10)


def _around_01() -> Check:
    return Check(0.7, _critical()[0], 0.1)  # "around 0.6 – 0.8"


def _around_02() -> Check:
    return Check(0.21, _critical()[1], 0.005)  # half the last digit


_SEVEN = np.array([0.19, 0.20, 0.23, 0.24, 0.25])  # 0.21 and 0.22 have a row of their own


def _open_02() -> Check:
    return Check([0, 0, 1, 1, 1], _runs(_SEVEN, 1.98)[0], 0)


def _between() -> Check:
    return Check([0, 0], _runs([0.21, 0.22], 1.98)[0], 0, [1, 1])


def _finite_mean() -> Check:
    running, theta, _ = _runs(_SEVEN, 1.98)
    mean = (theta[:, 1] - theta[:, 0]) / 10
    return Check([0, 0, 1, 1, 1], np.where(running, mean > 0.5, np.abs(mean) > 1e-9), 0)


_WELLS = {
    "8.2.3a": (2.01, (0, 1)),
    "8.2.3b": (2.05, (0, 1, 2)),
    "8.2.3c": (2.10, (0, 1, 3)),
    "8.2.3d": (2.14, (0, 1, 2, 3)),
    "8.2.3e": (2.27, (0, 1, 2, 4)),
    "8.2.3f": (2.40, (0, 1, 2, 3, 4)),
    "8.2.3g": (2.60, (0, 1, 2, 3, 5)),
    "8.2.3h": (2.80, (0, 1, 2, 3, 4, 5)),
    "8.2.3i": (2.95, (0, 1, 2, 3, 4, 6)),
    "8.2.3j": (3.15, (0, 1, 2, 3, 4, 5, 6)),
}
_TAU = np.arange(1, 41) / 100


@cache
def _ends():
    """Of all panels, τ = 0.01 … 0.40: running, well, and angle."""
    v0 = np.array([v0 for v0, _ in _WELLS.values()])[:, None]
    return ended(0.16, _TAU, v0)


def _wells(index: int, claimed, corrected) -> Check:
    running, well, _ = _ends()
    n = np.arange(8)
    found = np.any((well[index] == n[:, None]) & (running[index] == 0), axis=-1)
    return Check(np.isin(n, claimed), found, 0, np.isin(n, corrected))


def _family(index: int, name: str) -> Claim:
    v0, wells = _WELLS[name]
    says = "v0 = {:.2f}: the stable points are around θ = {}".format(
        v0, ", ".join("0" if n == 0 else "2π" if n == 1 else f"{2 * n}π" for n in wells)
    )
    wrong = () if v0 < 2.4 else ("S2-22",) if v0 < 3 else ("S2-23",)
    right = wells if v0 < 2.4 else wells[1:] if v0 < 3 else wells[2:]
    quantity = "1 where well n = 0 … 7 occurs, τ = 0.01 … 0.40"
    return Claim("8.2.3a-j", says, quantity, lambda: _wells(index, wells, right), (name,), wrong)


def _stable_points() -> Check:
    running, theta, _ = _runs(_TAU, 2.01)
    turns, tau = theta[~running, 1] / (2 * np.pi), _TAU[~running]
    # "around": to a hundredth of a turn
    return Check(0.0, 2 * np.pi * (turns - np.round(turns)), 0.02 * np.pi, np.arcsin(tau))


def _from_spiral_to_open() -> Check:
    running, _, _ = _ends()
    return Check(np.stack([np.zeros(10), np.ones(10)]), running[:, [0, -1]].T, 0)


_TAU_H = np.arange(1, 36) / 100


def _program_h() -> Check:
    """Wells at t = 100, where the program stops; −1 for what still goes on."""
    theta = followed(0.16, _TAU_H, 2.1, [95.0, 100.0])[0]
    well = np.round((theta[:, 1] - np.arcsin(_TAU_H)) / (2 * np.pi))
    going = theta[:, 1] - theta[:, 0] > 1
    running, found, _ = (x[2, :35] for x in _ends())
    return Check(np.where(going, -1, well), np.where(running == 1, -1, found), 0)


def _junction():
    """Ic = 0.1 mA, R = 10 Ω, and the capacitance that makes β = 0.16."""
    critical, ohms, reduced = 1e-4, 10.0, FLUX_QUANTUM / (2 * np.pi)
    farads = reduced / (critical * ohms**2 * 0.16**2)
    return critical, ohms, farads, reduced


_CURRENT = np.linspace(0, 1.5, 16)  # of Ic


@cache
def _curve():
    critical, ohms, farads, _ = _junction()
    curve = iv_curve(JosephsonJunction(critical, ohms, farads), _CURRENT * critical)
    return np.asarray(curve.voltage_up), np.asarray(curve.voltage_down)


def _rcsj() -> Check:
    critical, ohms, farads, reduced = _junction()
    model = JosephsonJunction(critical, ohms, farads)
    current = critical * np.array([0.1, 0.5, 1.2])
    scene, unit = model.pendulum(current), float(model.plasma_frequency)
    phase = followed(scene.beta, scene.tau, 2.0, 10 + _STENCIL)[0]
    rate, change = unit * phase @ _FIRST, unit**2 * phase @ _SECOND
    found = reduced * (farads * change + rate / ohms) + critical * np.sin(phase[:, 4])
    return Check(current, found, 1e-8 * critical)


def _supercurrent() -> Check:
    tau = _CURRENT[:8]
    return Check(np.arcsin(tau), _runs(tau, 0.0)[1][:, 1], 1e-12)


def _horizontal() -> Check:
    return Check(0.5 * np.pi, np.asarray(fixed_points(Pendulum(2.0, 0.16, 2.0)).angle)[0], 1e-7)


def _critical_current() -> Check:
    up = _curve()[0]
    return Check(1.0, _CURRENT[up == 0].max(), 0.05)  # half a step of the sweep


def _voltage(down: bool) -> Check:
    lowest = 0.2024279883 if down else 1  # at which running can go on
    return Check(_CURRENT > 1, _curve()[down] != 0, 0, lowest < _CURRENT)


def _one_way() -> Check:
    v = followed(0.16, [1.05, 1.2, 1.5], 0.0, 50 + 0.5 * np.arange(9))[1]
    return Check(np.ones(3), np.all(v > 0, -1), 0)


CLAIMS = (
    Claim("8.1", "I θ̈ = T − mgl sin θ − η θ̇", "T, N m, given / from the motion, 0.1, 0.5, 1",
          _torque, ("8.1",)),
    Claim("8.1", "ε = g/l, β = η/ml², τ = T/ml²", "ε, 1/s², β, 1/s, τ, 1/s²", _small_units,
          ("8.1",)),
    Claim("8.2.1", "v0 = 0.2, β = 0.16: spirals for τ = 0 … 0.6, an open orbit for 0.8",
          "1 where it runs after 400 s, τ = 0, 0.2 … 0.8", _open, ("8.2.1",)),
    Claim("8.2.1", "It changes from spiral to open orbits around τ = 0.6 – 0.8",
          "τ, 1/s², its middle / critical torque", _around_01, ("8.2.1",), ("S2-25",)),
    Claim("8.2.1", "τ = sin θ_s for τ ≤ 0.6",
          "τ, 1/s², sin θ after 410 s / given, 0, 0.2, 0.4, 0.6",
          _shift, ("8.2.1",), ("S2-25",)),
    Claim("8.2.2a,b", "v0 = 1.98, β = 0.16: it changes to open orbits around τ = 0.21",
          "τ, 1/s², claimed / critical torque", _around_02, ("8.2.2a", "8.2.2b"), ("S2-26",)),
    Claim("8.2.2a,b", "Captured for τ = 0.20, running for τ > 0.22",
          "1 where it runs, τ = 0.19, 0.20, 0.23, 0.24, 0.25", _open_02,
          ("8.2.2a", "8.2.2b")),
    Claim("8.2.2a,b", "Running for τ > 0.22 (read as: not yet for τ = 0.21 and 0.22)",
          "1 where it runs, τ = 0.21, 0.22", _between, ("8.2.2a", "8.2.2b"), ("S2-26",)),
    Claim("8.2.2a,b", "v oscillates around 0 for τ = 0.20, around a finite value for τ > 0.22",
          "1 where the mean of v is not 0, τ = 0.19 … 0.25", _finite_mean, ("8.2.2b",)),
    *(_family(index, name) for index, name in enumerate(_WELLS)),
    Claim("8.2.3a-j", "The stable points are around 2πn",
          "θ − 2πn after 410 s, rad, v0 = 2.01, the τ at which it is captured", _stable_points,
          ("8.2.3a",), ("S2-24",)),
    Claim("8.2.3a-j", "From the spiral orbit for small τ to the open orbit for large τ",
          "1 where it runs, τ = 0.01 and 0.40, all panels", _from_spiral_to_open,
          tuple(_WELLS)),
    Claim("C-H", "H, v0 = 2.1, β = 0.16, τ = 0.01 … 0.35: followed to t = 100",
          "well at t = 100 / at the end, −1 for running", _program_h, ("H",)),
    Claim("8.3", "I = (ħC/2e) φ̈ + (ħ/2eR) φ̇ + Ic sin φ is the pendulum's equation",
          "I, A, given / from the pendulum's motion, I/Ic = 0.1, 0.5, 1.2", _rcsj),
    Claim("8.3", "(1) A small torque: at rest at τ = ε sin θ, no voltage",
          "θ, rad, arcsin τ / after 410 s from rest, τ = 0 … 0.7", _supercurrent, ("8.3",)),
    Claim("8.3", "(2) More current passes without voltage; (3) up to the critical one, Tc = mgl",
          "largest I/Ic at V = 0, swept up", _critical_current, ("8.3",)),
    Claim("8.3", "(3) The critical torque deflects it through a right angle", "θ, rad, τ = ε",
          _horizontal),
    Claim("8.3", "(4) For I > Ic a voltage appears; below, (1) and (2), there is none",
          "1 where V ≠ 0, I/Ic = 0 … 1.5, swept up", lambda: _voltage(False), ("8.3",)),
    Claim("8.3",
          "(4) A voltage for I > Ic (read as: for no smaller one, though I falls from there)",
          "1 where V ≠ 0, I/Ic = 0 … 1.5, swept down", lambda: _voltage(True), ("8.3",),
          ("S2-27",)),
    Claim("8.3", "(4) As it rotates, the angular velocity is always in the same direction",
          "1 where v > 0, τ = 1.05, 1.2, 1.5", _one_way),
)  # fmt: skip
