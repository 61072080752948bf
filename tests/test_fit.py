"""Terms and initial states from recordings: noise-free, noisy, gapped, several, measured."""

from functools import partial

import fit_scenes
import jax
import jax.numpy as jnp
import numpy as np
import optax
import pytest

from pendax import Pendulum, Result, cycles, fit_frequency, fit_trajectory, simulate
from pendax.fit._recording import recording_of

TRUE = Pendulum(4.0, 0.12)
TS = np.linspace(0.0, 15.0, 150)


def motion(pendulum=TRUE, v0=1.0, theta0=2.0, ts=TS):
    return np.asarray(simulate(pendulum, ts, v0, theta0).theta)


@partial(jax.jit, static_argnums=0)
def fits(kind, rows, starts, noise):
    """All of them in one program; values and errors in the order of the fit's names."""

    def one(row, start, noise):
        ts, theta = fit_scenes.recorded(kind, row)
        measured = theta + noise * fit_scenes.noise_of(theta)
        guess = fit_scenes.pendulum_of(kind, start)
        fit = fit_trajectory(ts, measured, guess, v0=start[3], theta0=start[4])
        found = {name: getattr(fit.model, name, None) for name in ("epsilon", "beta", "tau")}
        found |= {"v0": fit.v0, "theta0": fit.theta0}
        names = list(fit.errors)
        values = jnp.stack([found[name] for name in names])
        columns = jnp.asarray([fit_scenes.COLUMNS.index(name) for name in names])
        return values, jnp.stack([fit.errors[n] for n in names]), row[columns], fit.result, fit.runs

    return jax.vmap(one)(rows, starts, noise)


@pytest.mark.parametrize(
    "kind", ["libration", pytest.param("separatrix", marks=pytest.mark.full), "damped"]
)
def test_thirty_percent_off(kind, dtype):
    """To 1e-8 in float64, from where every phase is lost within a period or two."""
    rows = fit_scenes.scenes(kind, 24, 11)
    arrays = [jnp.asarray(x, dtype) for x in (rows, fit_scenes.beside(rows, 11))]
    quiet = jnp.zeros((24, fit_scenes.SAMPLES), dtype)
    values, _, true, result, _ = fits(kind, *arrays, quiet)
    off = np.max(np.abs(np.asarray(values / true - 1)), 1)
    assert values.dtype == dtype
    if dtype == np.float64:
        assert (off < 1e-8).all()
        assert np.asarray(result == Result.successful).all()
    else:
        # An energy next to the separatrix has few digits in float32.
        assert np.mean(off < 2e-3) >= (0.6 if kind == "separatrix" else 0.9)


def test_intervals_contain_the_truth():
    """240 fits of 1 % noise: 95 % intervals hold the truth in 95 ± 4 %."""
    rows = fit_scenes.scenes("libration", 240, 5)
    noise = np.random.default_rng(6).normal(size=(240, fit_scenes.SAMPLES))
    given = (jnp.asarray(x) for x in (rows, fit_scenes.beside(rows, 5), noise))
    values, errors, true, result, runs = fits("libration", *given)
    assert np.asarray(result == Result.successful).mean() > 0.99
    inside = np.abs((values - true) / errors) < 1.96
    assert ((inside.mean(0) > 0.91) & (inside.mean(0) < 0.99)).all()
    assert np.abs(np.mean(runs)) < 0.3
    assert 0.85 < np.std(runs) < 1.2


def test_a_bad_lane_is_alone():
    rows = fit_scenes.scenes("libration", 24, 11)
    noise = np.zeros((24, fit_scenes.SAMPLES))
    noise[3, 7] = np.nan
    given = (jnp.asarray(x) for x in (rows, fit_scenes.beside(rows, 11), noise))
    values, _, true, result, _ = fits("libration", *given)
    fine = np.asarray(result == Result.successful)
    assert not fine[3]
    assert fine.sum() == 23
    assert (np.abs(values / true - 1)[fine] < 1e-8).all()


def test_state_from_the_data_offset_and_gaps():
    """Nothing given but the scene; a masked stretch of garbage and NaN."""
    theta = motion() + 0.3
    mask = np.ones(TS.size, bool)
    mask[40:60] = False
    dirty = np.where(mask, theta, np.nan)
    ts = np.where(mask, TS, -1.0)
    fit = fit_trajectory(ts, dirty, Pendulum(5.0, 0.0), mask=mask, offset=0.0)
    assert fit.result == Result.successful
    found = [fit.model.epsilon, fit.model.beta, fit.v0, fit.theta0, fit.offset]
    np.testing.assert_allclose(found, [4.0, 0.12, 1.0, 2.0, 0.3], rtol=1e-8)
    assert list(fit.errors) == ["epsilon", "beta", "v0", "theta0", "offset"]
    assert fit.covariance.shape == (5, 5)
    assert fit.residuals.shape == TS.shape
    assert np.isnan(np.asarray(fit.residuals)[~mask]).all()
    # The same in a compressed recording.
    short = fit_trajectory(TS[mask], theta[mask], Pendulum(5.0, 0.0), offset=0.0)
    np.testing.assert_allclose(short.model.epsilon, 4.0, rtol=1e-8)


def test_results_have_the_dtype_of_what_was_given():
    """Whatever the default precision: a guess of plain numbers is weak."""
    narrow = [np.asarray(x, np.float32) for x in (TS, motion())]
    fit = fit_trajectory(*narrow, Pendulum(5.0, 0.0), v0=1.0, theta0=2.0)
    arrays = [x for x in jax.tree.leaves(fit) if jnp.issubdtype(x.dtype, jnp.floating)]
    assert {x.dtype for x in arrays} == {np.dtype(np.float32)}
    np.testing.assert_allclose(fit.model.epsilon, 4.0, rtol=1e-4)


def test_what_is_fixed_stays():
    fixed = ("beta", "theta0")
    fit = fit_trajectory(TS, motion(), Pendulum(5.0, 0.12), theta0=2.0, fixed=fixed)
    assert list(fit.errors) == ["epsilon", "v0"]
    assert fit.model.beta == 0.12
    assert fit.theta0 == 2.0
    np.testing.assert_allclose([fit.model.epsilon, fit.v0], [4.0, 1.0], rtol=1e-8)


def test_several_runs_share_the_scene():
    """Two runs, one shorter, with velocities; v0, θ0 and offset are each run's own."""
    runs = [simulate(TRUE, TS, v0, theta0) for v0, theta0 in ((1.0, 2.0), (-4.0, 0.5))]
    theta = np.stack([run.theta for run in runs]) + np.array([[0.1], [-0.2]])
    velocity = np.stack([run.v for run in runs])
    mask = np.ones(theta.shape, bool)
    mask[1, 100:] = False
    theta[1, 100:] = 0.0
    fit = fit_trajectory(
        TS, theta, Pendulum(4.8, 0.2), velocity=velocity, mask=mask, offset=0.0, sigma=(0.01, 0.02)
    )
    assert fit.result == Result.successful
    np.testing.assert_allclose(fit.v0, [1.0, -4.0], rtol=1e-8)
    np.testing.assert_allclose(fit.theta0, [2.0, 0.5], rtol=1e-8)
    np.testing.assert_allclose(fit.offset, [0.1, -0.2], rtol=1e-8)
    np.testing.assert_allclose([fit.model.epsilon, fit.model.beta], [4.0, 0.12], rtol=1e-8)
    assert fit.covariance.shape == (8, 8)
    assert np.abs(np.asarray(fit.velocity_residuals)[mask]).max() < 1e-9


def test_measured_torque_is_held():
    torque = lambda t: 1.5 * jnp.cos(1.3 * t)  # noqa: E731
    ts = np.linspace(2.0, 14.0, 80)
    true = simulate(Pendulum(4.0, 0.3, torque), ts, 0.5, 0.2, t0=2.0)
    fit = fit_trajectory(ts, np.asarray(true.theta), Pendulum(4.9, 0.22, torque))
    assert fit.result == Result.successful
    assert "tau" not in fit.errors
    np.testing.assert_allclose([fit.model.epsilon, fit.model.beta], [4.0, 0.3], rtol=1e-7)
    np.testing.assert_allclose([fit.v0, fit.theta0], [0.5, 0.2], rtol=1e-7)


@pytest.mark.parametrize(
    "optimiser",
    [
        pytest.param(None, id="root of the loss", marks=pytest.mark.full),
        pytest.param(optax.lbfgs(), id="optax"),
    ],
)
def test_a_robust_loss_forgives_outliers(optimiser):
    rng = np.random.default_rng(4)
    theta = motion() + 0.005 * rng.normal(size=TS.size)
    theta[::12] += rng.uniform(0.5, 1.5, theta[::12].size)
    plain = fit_trajectory(TS, theta, Pendulum(4.5, 0.1), sigma=0.005)
    robust = fit_trajectory(
        TS,
        theta,
        Pendulum(4.5, 0.1),
        sigma=0.005,
        loss=lambda r: jnp.log1p(r * r / 2),
        optimiser=optimiser,
        steps=60,
    )
    assert abs(float(robust.model.epsilon) - 4) < 0.004 < abs(float(plain.model.epsilon) - 4)
    assert abs(float(robust.model.epsilon) - 4) < 4 * float(robust.errors["epsilon"])
    assert robust.history.shape == (60,)
    assert float(plain.reduced_chi2) > 100


@pytest.mark.full
def test_further_starts_find_what_one_misses():
    """From a scene with four times the ε, a minimum elsewhere; it says so."""
    guess = Pendulum(4.0 * 2.6, 0.0)
    alone = fit_trajectory(TS, motion(), guess, v0=-3.0, theta0=0.3)
    assert alone.result != Result.successful or np.isclose(float(alone.model.epsilon), 4.0)
    many = fit_trajectory(TS, motion(), guess, v0=-3.0, theta0=0.3, starts=8)
    assert many.history[-1] <= alone.history[-1]


def test_a_model_that_lacks_something_shows_it():
    """Viscous friction fitted to the constant steps of a dry one."""
    peaks = 2.0 - 0.06 * np.arange(60)
    ts = np.linspace(0, 20, 1200)
    phase = 2.0 * ts
    theta = np.interp(phase / np.pi, np.arange(60), peaks) * np.cos(phase)
    fit = fit_trajectory(ts, theta, Pendulum(4.5, 0.05))
    assert float(fit.runs) < -10
    assert float(fit.reduced_chi2) > 10


def test_runs_may_lie_apart_in_time():
    """Closed form, two runs an hour apart; each counts from its own first time."""
    free = Pendulum(4.0)
    theta = np.stack([motion(free, 1.0, 2.0), motion(free, -4.0, 0.5)])
    fit = fit_trajectory(np.stack([TS, TS + 3600.1]), theta, Pendulum(4.8))
    assert fit.result == Result.successful
    np.testing.assert_allclose(fit.v0, [1.0, -4.0], rtol=1e-8)
    np.testing.assert_allclose(fit.model.epsilon, 4.0, rtol=1e-8)


def test_a_damping_that_is_not_there():
    """β can't go below 0: at nothing, the fit has converged."""
    noise = 0.01 * np.random.default_rng(1).normal(size=TS.size)
    # Negative damping would describe this best.
    growing = motion(Pendulum(4.0)) * (1 + 3e-4 * TS) + noise
    fit = fit_trajectory(TS, growing, Pendulum(4.5, 0.1))
    assert fit.result == Result.successful
    assert float(fit.model.beta) < 0.01 * float(fit.errors["beta"])
    assert 0 < float(fit.errors["beta"]) < 0.01


@pytest.mark.full
def test_a_loss_bent_downwards_says_nothing():
    """Residuals of 30 stated errors: most samples are outliers."""
    theta = motion() + 0.01 * np.random.default_rng(4).normal(size=TS.size)
    fit = fit_trajectory(
        TS,
        theta,
        Pendulum(4.5, 0.1),
        sigma=0.01 / 30,
        loss=lambda r: jnp.log1p(r * r / 2),
        steps=60,
    )
    assert fit.result != Result.successful


@pytest.mark.parametrize(
    ("scene", "v0", "theta0", "ts"),
    [
        (Pendulum(1.0, 0.05, -2.0), 15.0, 0.0, np.linspace(0, 10, 201)),
        (Pendulum(1.0, 1.5), 9.0, 0.0, np.arange(0, 30, 2.0)),
        (Pendulum(1.0), 0.0, 3.1415, np.arange(0, 120, 4.0)),
    ],
    ids=["thrown against a torque", "captured after a turn", "next to the top"],
)
def test_no_false_alarm(scene, v0, theta0, ts):
    """Neither degrees nor wrapped, however coarsely it is sampled."""
    theta = motion(scene, v0, theta0, ts)
    assert recording_of(ts, theta, None, None, None, scene, False).theta.shape == (1, ts.size)


BAD = [
    ({"theta": np.full(150, 0.3)}, "`theta` must move, but it is 0.3 at all times"),
    ({"theta": np.full(150, np.nan)}, "`theta` must be finite, but none of its samples is"),
    ({"theta": np.where(TS > 7, np.nan, TS)}, "`theta` must be finite, but got nan at"),
    ({"velocity": np.full(150, np.nan)}, "`velocity` must be finite, but none"),
    ({"ts": TS[:4], "theta": motion()[:4]}, "more samples than parameters, 4 .epsilon, beta, v0"),
    ({"theta": np.degrees(motion())}, "`theta` must be in radians, but it swings through"),
    ({"theta": motion(theta0=3.0, v0=9.0) % (2 * np.pi)}, "must not be wrapped, but it jumps"),
    ({"ts": TS[::-1]}, "`ts` must increase"),
    ({"ts": 1e3 * TS}, "`ts` must be in the unit of the `guess`, seconds"),
    ({"ts": TS[:9]}, r"`ts` must have shape \(150,\)"),
    ({"fixed": ("gamma",)}, "`fixed` must name some of epsilon, beta, v0, theta0, but got 'gam"),
    ({"fixed": ("epsilon", "beta", "v0", "theta0")}, "must leave something to fit"),
    ({"sigma": -1.0}, "`sigma` must be positive"),
    ({"sigma": (0.1, 0.1)}, "`sigma` must be a pair, .* where both are fitted"),
    ({"mask": np.ones(150)}, "`mask` must be booleans of shape"),
    ({"mask": TS > 99}, "none of its samples is|must leave two or more"),
    ({"guess": Pendulum(np.array([1.0, 2.0]))}, "`guess` must have numbers"),
    ({"starts": 0}, "`starts` must be 1 or more"),
    ({"v0": np.ones(3)}, "`v0` must be one number, or one a run"),
]


@pytest.mark.parametrize(("wrong", "message"), BAD, ids=[x[1][:28] for x in BAD])
def test_bad_input(wrong, message):
    given = {"ts": TS, "theta": motion(), "guess": Pendulum(4.0, 0.1)} | wrong
    ts, theta, guess = (given.pop(name) for name in ("ts", "theta", "guess"))
    with pytest.raises(ValueError, match=message):
        fit_trajectory(ts, theta, guess, **given)


def test_wrapped_rotations_are_unwrapped_when_asked():
    theta = motion(Pendulum(4.0, 0.02), 9.0, 0.1)
    wrapped = np.angle(np.exp(1j * theta))
    with pytest.raises(ValueError, match="unwrap=True"):
        fit_trajectory(TS, wrapped, Pendulum(5.0, 0.03))
    fit = fit_trajectory(TS, wrapped, Pendulum(5.0, 0.03), unwrap=True)
    np.testing.assert_allclose([fit.model.epsilon, fit.model.beta], [4.0, 0.02], rtol=1e-8)


def test_motion_capture(shared):
    """θ and ω of a real pendulum, ten gaps in time."""
    path = shared / "data" / "pendulum" / "schmidt_lipson_real_pend_h_1.csv"
    _, ts, theta, omega = np.loadtxt(path, delimiter=",", skiprows=1).T
    fit = fit_trajectory(ts, theta, Pendulum(1.0, 0.01), velocity=omega)
    assert 5.385 < 2 * np.pi / np.sqrt(float(fit.model.epsilon)) < 5.417
    assert 1e-4 < float(fit.errors["epsilon"]) < 1e-2


def test_encoder_with_dry_friction(shared):
    """Viscous friction alone: the period is right, and the misfit is shown."""
    path = shared / "data" / "pendulum" / "benard_free_swing_135deg.csv"
    ts, theta = np.loadtxt(path, delimiter=",", skiprows=1).T
    late = ts >= 0.232
    fit = fit_trajectory(ts[late], np.radians(theta[late]), Pendulum(100.0, 0.3))
    assert 0.572 < 2 * np.pi / np.sqrt(float(fit.model.epsilon)) < 0.576
    assert float(fit.runs) < -30
    assert float(fit.reduced_chi2) > 100


def test_string_pendulum(shared):
    """Whether the exact law holds within the stated errors; the linear law does not."""
    path = shared / "data" / "pendulum" / "wen_period_vs_amplitude.csv"
    amplitude, period, _, error = np.loadtxt(path, delimiter=",", skiprows=1).T
    fit = fit_frequency(np.abs(amplitude), period, sigma=error)
    assert float(fit.errors["epsilon"]) < 0.02 * float(fit.model.epsilon)
    assert float(fit.reduced_chi2) < 1.5
    flat = np.sum(((period - np.average(period, weights=error**-2)) / error) ** 2) / 22
    assert flat > 2 * float(fit.reduced_chi2)


def test_cycles_and_trajectory_agree():
    found = cycles(TS, motion())
    by_cycles = float(fit_frequency(found.amplitude, found.period).model.epsilon)
    assert by_cycles == pytest.approx(4.0, rel=0.02)
