"""The critical law, its series and its fit."""

import csv
import inspect
import json

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, Result, critical_law, fit_critical_law, frequency
from pendax._critical import coefficients, distance, frequency_at


def test_coefficients_are_exact(shared):
    true = json.loads((shared / "truth" / "critical_law_series.json").read_text())
    a, b = coefficients(len(true["A_coeffs"]) - 1)
    assert [str(x) for x in a] == true["A_coeffs"]
    assert [str(x) for x in b] == true["B_coeffs"]


def test_law_and_exact_frequency_against_the_table(shared):
    with (shared / "truth" / "critical_law.csv").open() as file:
        rows = list(csv.DictReader(file))
    t = jnp.array([float(row["t"]) for row in rows])
    for side, letter in (("lower", "l"), ("upper", "u")):
        exact = np.array([float(row[f"omega_{letter}"]) for row in rows])
        leading = np.array([float(row[f"leading_{letter}"]) for row in rows])
        np.testing.assert_allclose(critical_law(t, side), leading, rtol=2e-15)
        np.testing.assert_allclose(frequency_at(t, jnp.ones_like(t), side), exact, rtol=2e-15)
        for order in range(4):
            off = np.asarray(critical_law(t, side, order=order)) / exact - 1
            true = np.array([float(row[f"relerr_{letter}_order{order}"]) for row in rows])
            # The table calls the deviation of exact/law what is law/exact here.
            np.testing.assert_allclose(np.abs(off), np.abs(true), rtol=0.35, atol=1e-15)


@pytest.mark.parametrize("epsilon", [1.0, 9.81])
def test_each_order_gains_a_power_of_t(epsilon):
    t = jnp.array([1e-2, 1e-3]) * np.sqrt(epsilon)
    for side in ("lower", "upper"):
        exact = frequency_at(t, jnp.full_like(t, epsilon), side)
        for order in range(4):
            off = jnp.abs(critical_law(t, side, epsilon, order) / exact - 1)
            if float(off[1]) > 1e-14:
                assert float(off[0] / off[1]) == pytest.approx(10 ** (order + 1), rel=0.2)


def test_edges_of_the_law(dtype):
    t = jnp.asarray([0.0, -1.0, 1e-3, 20.0], dtype)
    value, slope = jax.vmap(jax.value_and_grad(lambda t: critical_law(t, "lower")))(t)
    assert value.dtype == dtype
    assert value[0] == 0
    assert jnp.isnan(value[1])
    assert jnp.isnan(value[3])
    assert jnp.isfinite(jnp.stack([value[2], slope[2]])).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.1, "left"), 'Argument `side` must be "lower" or "upper", but got \'left\'.'),
        ((0.1, "lower", -1.0), "Argument `epsilon` must be positive, but got -1.0."),
        ((0.1, "lower", 1.0, -1), "Argument `order` must be zero or positive, but got -1."),
    ],
)
def test_bad_arguments_of_the_law(arguments, message):
    # A wrong side is caught by the run-time annotations first; ask the function itself.
    with pytest.raises(ValueError, match=message):
        inspect.unwrap(critical_law)(*arguments)


def both_sides(epsilon, low, high, dtype=np.float64, count=3000):
    t = np.geomspace(low, high, count)
    separatrix = 2 * np.sqrt(epsilon)
    return np.concatenate([separatrix - t, separatrix + t]).astype(dtype)


@pytest.mark.parametrize("epsilon", [1.0, 9.81])
def test_fit_recovers_the_law(epsilon):
    v0 = both_sides(epsilon, 1e-12, 1e-6)
    law = fit_critical_law(v0, frequency(Pendulum(epsilon), v0), epsilon)
    assert law.result == Result.successful
    for side, amplitude in ((law.lower, np.pi / 2), (law.upper, np.pi)):
        assert abs(float(side.amplitude) / (amplitude * np.sqrt(epsilon)) - 1) < 1e-6
        assert abs(float(side.scale) / (4 * epsilon**0.25) - 1) < 1e-5
        assert int(side.count) == 3000
        assert float(side.residual) < 1e-7
    assert abs(float(law.ratio) - 2) < 1e-6


def test_fit_in_float32_with_the_next_order():
    """float32 ends at t = 1e-7, where the leading law is off by t/4: order 1 mends that."""
    with jax.enable_x64(False):
        v0 = both_sides(1.0, 1e-5, 1e-2, np.float32, 300)
        law = fit_critical_law(v0, frequency(Pendulum(), v0), order=1)
        assert law.ratio.dtype == jnp.float32
        assert abs(float(law.lower.amplitude) / (np.pi / 2) - 1) < 1e-5
        assert abs(float(law.upper.amplitude) / np.pi - 1) < 1e-5
        assert abs(float(law.upper.scale) / 4 - 1) < 1e-4
        assert abs(float(law.ratio) - 2) < 1e-5


@pytest.mark.parametrize("count", [2, 3, 12, 16, 100])
@pytest.mark.parametrize("window", [(1e-6, 1e-2), (1e-10, 1e-6), (1e-9, 1e-3), (1e-3, 1.0)])
def test_fit_converges_on_few_points(count, window):
    v0 = both_sides(1.0, *window, count=count)
    law = fit_critical_law(v0, frequency(Pendulum(), v0))
    assert law.result == Result.successful
    # What the leading law misses over the window moves A by a few times t/4.
    assert abs(float(law.ratio) - 2) < 4 * window[1] + 1e-9


def test_fit_finds_what_is_there_and_not_the_theory():
    t = np.geomspace(1e-9, 1e-3, 200)
    v0 = np.concatenate([2 - t, 2 + t])
    x, below = distance(jnp.asarray(v0), jnp.ones(400))
    omega = jnp.where(below, 1.3, 2.9) / jnp.log(jnp.where(below, 7.0, 5.0) / jnp.sqrt(x))
    law = fit_critical_law(v0, omega)
    found = [law.lower.amplitude, law.lower.scale, law.upper.amplitude, law.upper.scale]
    np.testing.assert_allclose(jnp.stack(found), [1.3, 7, 2.9, 5], rtol=1e-9)


def test_fit_ignores_the_separatrix_itself_and_reports_a_missing_side():
    v0 = np.append(both_sides(1.0, 1e-9, 1e-6, count=50), 2.0)
    omega = frequency(Pendulum(), v0)
    law = fit_critical_law(v0, omega)
    assert law.result == Result.successful
    assert int(law.lower.count) + int(law.upper.count) == 100
    one_side = fit_critical_law(v0[:50], omega[:50])
    assert one_side.result == Result.too_few_points
    assert jnp.isnan(one_side.upper.amplitude)


def test_distance_is_exact_where_the_root_is_not():
    """At ε = 9.81, (2√ε − v0)(2√ε + v0) misplaces the separatrix; v0² error-free does not."""
    v0 = np.float64(2 * np.sqrt(9.81))
    t, below = distance(jnp.asarray(v0), jnp.asarray(9.81))
    gap = 4 * int(9.81 * 2**60) * 2**60 - int(v0 * 2**60) ** 2
    assert bool(below) == (gap > 0)
    np.testing.assert_allclose(t, abs(gap) / 2.0**120 / (2 * v0), rtol=1e-15)
