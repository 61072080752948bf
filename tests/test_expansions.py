"""Series in small angles and small m, each with its error; the geometry of chapter 4."""

import csv
import json
import math

import jax.numpy as jnp
import mpmath as mp
import numpy as np
import pytest

from pendax import Pendulum, geometry, period, period_series, simulate, small_angle
from pendax.special import ellipe_series, ellipk_series


@pytest.mark.parametrize("m", [0.0, 1e-8, 0.1, 0.5, 0.9, 0.99, 1 - 1e-9, 1.0])
def test_partial_sums(m, dtype):
    m = float(dtype.type(m))
    eps, tiny = float(jnp.finfo(dtype).eps), float(jnp.finfo(dtype).tiny)
    with mp.workdps(200):
        c = [(mp.fac2(2 * n - 1) / mp.fac2(2 * n)) ** 2 * mp.mpf(m) ** n for n in range(12)]
        k = [mp.pi / 2 * x for x in c]
        e = [-mp.pi / 2 * x / (2 * n - 1) for n, x in enumerate(c)]
        for terms, series, exact in (
            (k, ellipk_series, mp.ellipk),
            (e, ellipe_series, mp.ellipe),
        ):
            got = series(jnp.asarray(m, dtype), 12)
            for n in range(12):
                total = mp.fsum(terms[: n + 1])
                assert abs(float(got.value[n]) - total) <= 4 * eps * total
                true = total / exact(mp.mpf(m)) - 1 if m < 1 or exact is mp.ellipe else mp.mpf(-1)
                error = abs(float(got.error[n]) - true)
                bar = 1e-5 if dtype == np.float64 else 1e-3
                # Errors are summed from their own terms, except near 1.
                assert error <= bar * abs(true) + (tiny if m < 0.6 else 8 * eps), (m, n)


def test_period_series_against_the_table(shared):
    with (shared / "truth" / "seed000_period_series.csv").open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        got = period_series(math.radians(float(row["theta_max_deg"])), 50)
        for n in (1, 2, 3, 5, 10, 20, 50):
            with mp.workdps(40):
                total, exact = mp.mpf(row[f"S{n}"]), mp.mpf(row["T_over_T0_exact"])
                assert abs(float(got.value[n - 1]) - total) <= 1e-15 * total
                error = abs(float(got.error[n - 1]) - (total / exact - 1))
                assert error <= 1e-15 + 1e-6 * abs(total / exact - 1)


def test_series_refuse():
    with pytest.raises(ValueError, match="`terms` must be 1"):
        period_series(1.0, 0)
    assert jnp.isnan(ellipk_series(jnp.array([-0.1, 0.5, 1.1]), 3).value[:, 2]).tolist() == [
        1,
        0,
        1,
    ]
    assert jnp.isnan(period_series(3.2, 3).value).all()


def test_small_angle_against_the_table(shared):
    table = json.loads((shared / "truth" / "geometry_and_small_angle.json").read_text())
    for row in table["perturbation_1.1_and_2.8"]:
        v0 = float(row["v0"])
        if v0 >= 2:
            continue
        got = small_angle(Pendulum(), v0)
        for found, name in (
            (got.amplitude, "relerr_linear"),
            (got.period, "rel_T_thmax"),
            (got.third, "rel_a3"),
        ):
            np.testing.assert_allclose(found.error, float(row[name]), rtol=1e-4, atol=1e-14)
        true = 2 * math.pi / float(period(Pendulum(), v0)) - 1
        np.testing.assert_allclose(got.isochronous.error, true, rtol=1e-9, atol=1e-15)
        omega2 = float(row["omega2_1_minus_a1sq_8"])
        if omega2 < 0:
            assert jnp.isnan(got.frequency.value)
            continue
        np.testing.assert_allclose(got.frequency.value, math.sqrt(omega2), rtol=1e-13)
    assert jnp.isnan(small_angle(Pendulum(), 2.5).period.error)
    assert small_angle(Pendulum(), 0.0).amplitude.error == 0
    assert jnp.isnan(small_angle(Pendulum(), 2.0).frequency.error)


FIGURES = {"fig15": 120, "fig16": 150, "fig18": None}


@pytest.mark.parametrize("name", FIGURES)
def test_geometry_against_the_table(name, shared):
    table = json.loads((shared / "truth" / "geometry_and_small_angle.json").read_text())[name]
    theta = math.radians(table["theta_deg"])
    top = FIGURES[name]
    k = math.sin(math.radians(top) / 2) if top else 1 / float(table["kappa"])
    got = geometry(Pendulum(), theta, 2 * math.sqrt(k * k - math.sin(theta / 2) ** 2))
    compared = 0
    for length, true in table.items():
        length = "ND" if length == "DN" else length
        if hasattr(got, length):
            np.testing.assert_allclose(getattr(got, length), float(true), rtol=1e-14)
            compared += 1
    assert compared >= 8


@pytest.mark.parametrize("v0", [0.7, 1.9, 2.0, 2.1, 5.0])
def test_every_identity_of_chapter_4(v0):
    pendulum = Pendulum(2.3)
    v0 = v0 * math.sqrt(2.3)
    run = simulate(pendulum, jnp.linspace(-3, 3, 41), v0)
    g = geometry(pendulum, run.theta, run.v)

    def distance(a, b):
        return jnp.linalg.norm(a - b, axis=-1)

    def same(a, b):
        np.testing.assert_allclose(a, b, atol=3e-15 * max(1, v0 * v0))

    for name in ("AD", "AE", "AN", "AP", "AQ", "DE", "EN", "EP", "ND", "NP", "NQ"):
        same(getattr(g, name), distance(getattr(g, name[0]), getattr(g, name[1])))
    same(g.NP**2, g.EN * g.AN)  # PEN is similar to APN
    same(g.NQ**2, g.ND * g.AN)  # DNQ is similar to QNA
    same(g.AP**2 + g.EP**2, g.AE**2)  # a right angle at P
    same(jnp.linalg.norm(g.P, axis=-1), jnp.ones(41))
    if v0 == 2 * math.sqrt(2.3):
        return  # a rounding decides on which side of the separatrix a state is
    if v0 < 2 * math.sqrt(2.3):
        same(g.AB, distance(g.A, g.B))
        same(g.BE, distance(g.B, g.E))
        same(g.AB**2, g.AD * g.AE)  # ABE is similar to ADB
        same(g.B1, g.B * jnp.array([[-1.0, 1.0]]))
        same(g.AN + g.ND, g.AD)
    else:
        assert jnp.isnan(g.AB).all()
        assert jnp.isnan(g.B).all()
        same(g.DE, g.AD - g.AE)
