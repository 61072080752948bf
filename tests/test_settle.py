"""Where motions end, against the truth and against Arb."""

import csv

import fate_references as references
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pendax import Pendulum, Result, mean_velocity, settle, well_boundaries


def ends(found):
    return list(zip(np.ravel(found.running).tolist(), np.ravel(found.well).tolist(), strict=True))


def as_pair(fate):
    kind, n = fate
    return (0, n) if kind == "captured" else (n, 0)


def read(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def test_final_states(shared):
    """§8.2's grids."""
    rows = read(shared / "truth" / "driven_final_states.csv")
    beta, v0, tau = (np.array([float(row[name]) for row in rows]) for name in ("beta", "v0", "tau"))
    true = [
        (0, int(row["n"])) if row["final"] == "captured" else (int(np.sign(t)), 0)
        for row, t in zip(rows, tau, strict=True)
    ]
    assert ends(settle(Pendulum(1.0, beta, tau), v0)) == true


def test_winding(shared):
    """§7.2's table for v0 = 2.3, n = 2 at β = 0.04 included."""
    rows = read(shared / "truth" / "damped_winding.csv")
    beta = np.array([float(row["beta"]) for row in rows])
    found = settle(Pendulum(1.0, beta), 2.3)
    assert found.well.tolist() == [int(row["n_heyoka"]) for row in rows]
    assert settle(Pendulum(1.0, 0.04), 2.3).well == 2
    assert settle(Pendulum(1.0, 0.04), -2.3).well == -2


@pytest.mark.parametrize(("seed", "count"), [(3, 40), pytest.param(4, 400, marks=pytest.mark.full)])
def test_random_starts(seed, count, dtype):
    """Every decade of β from 0.02 to 20, both signs of all."""
    rng = np.random.default_rng(seed)
    columns = (
        10 ** rng.uniform(-1.7, 1.3, count),
        rng.uniform(-1.1, 1.1, count),
        rng.uniform(-20, 20, count),
        rng.uniform(-5, 5, count),
    )
    beta, tau, theta0, v0 = np.stack(columns).astype(dtype)
    found = settle(Pendulum(jnp.ones_like(beta), beta, tau), v0, theta0)
    true = [as_pair(references.fate(*map(float, row))) for row in zip(*columns, strict=True)]
    if dtype == np.float64:
        assert ends(found) == true
    else:
        # Roundings of the start may decide.
        assert sum(x != y for x, y in zip(ends(found), true, strict=True)) <= 1
    assert found.time.dtype == dtype
    assert (found.result == Result.successful).all()


def test_scales():
    """The same in other units of time, and as lanes by broadcasting and by `vmap`."""
    v0, tau = np.linspace(-4, 4, 9), np.linspace(-0.3, 0.3, 5)[:, None]
    one = settle(Pendulum(1.0, 0.16, tau), v0)
    other = settle(Pendulum(9.0, 0.48, 9 * tau), 3 * v0)
    assert ends(one) == ends(other)
    np.testing.assert_allclose(other.time * 3, one.time)

    def lane(tau, v0):
        return settle(Pendulum(1.0, 0.16, tau), v0, throw=False)

    nested = jax.jit(jax.vmap(jax.vmap(lane, (None, 0)), (0, None)))(tau[:, 0], v0)
    assert ends(nested) == ends(one)
    slope = jax.grad(lambda v0: settle(Pendulum(1.0, 0.16), v0, throw=False).time)(2.0)
    assert slope == 0


def test_beside_the_boundaries():
    """A part in 1e-9 to either side, boundaries and fates agree, with Arb as well."""
    scene, v0 = Pendulum(1.0, 0.16), 2.6
    tau = np.asarray(well_boundaries(scene, v0, over="tau", count=5))
    for side in (-1e-9, 1e-9):
        found = settle(Pendulum(1.0, 0.16, tau + side), v0)
        true = [as_pair(references.fate(0.16, x + side, 0.0, v0)) for x in tau]
        # Against a torque above retrapping's, −0.17 here is not, what falls back settles.
        assert ends(found) == true
        assert found.well.tolist() == [k + (side > 0) for k in range(5)]


def test_special_starts():
    def end(*terms, v0, theta0=0.0):
        return ends(settle(Pendulum(*terms), v0, theta0))[0]

    assert end(1.0, 0.1, v0=0.0) == (0, 0)
    assert end(1.0, 0.1, v0=0.0, theta0=4 * np.pi + 0.1) == (0, 2)
    assert end(1.0, 0.1, 1.0 + 1e-12, v0=-50.0) == (1, 0)
    assert end(1.0, 0.1, -2.0, v0=50.0) == (-1, 0)
    # Overdamped, from rest above the lower saddle, and thrown.
    assert end(1.0, 1e6, 0.9, v0=0.0, theta0=-3.0) == (0, 0)
    assert end(1.0, 1e6, 0.9, v0=2e7) == (0, 3)
    assert end(1.0, 30.0, 1.0, v0=0.0, theta0=-1.0) == (0, 0)
    # Released within rounding of the top.
    top = float(np.pi)
    assert end(1.0, 0.1, v0=0.0, theta0=top) == (0, 0)
    assert end(1.0, 0.1, v0=0.0, theta0=np.nextafter(top, 4)) == (0, 1)
    # A hundred thousand turns.
    assert end(1.0, 1e-4, v0=7.0)[0] == 0


def test_tolerances():
    scene, ends = Pendulum(1.0, 0.01), []
    for options in ({}, {"rtol": 1e-4}, {"rtol": 1e-4, "atol": 1e-12}):
        found = settle(scene, 3.0, **options)
        ends.append((int(found.well), float(found.time)))
    assert ends[0] == ends[2] != ends[1]
    with pytest.raises(ValueError, match="`rtol` must be one positive number"):
        settle(scene, 3.0, rtol=-1.0)


def test_lanes_without_an_end():
    def lane(beta, v0):
        return settle(Pendulum(1.0, beta, 0.1), v0, throw=False, max_steps=60)

    beta, v0 = jnp.array([0.0, 0.16, jnp.nan, -1.0, 0.2]), jnp.array([1.0, 30.0, 1.0, 1.0, 1.0])
    found = jax.jit(jax.vmap(lane))(beta, v0)
    expected = [Result.unsettled] * 2 + [Result.not_a_number] * 2 + [Result.successful]
    assert all((found.result == kind)[i] for i, kind in enumerate(expected))
    assert jnp.isnan(found.time).tolist() == [False, False, True, True, False]
    assert (found.running == 0).all()
    with pytest.raises(RuntimeError, match="did not come to an end"):
        settle(Pendulum(1.0, 0.16, 0.1), 30.0, max_steps=60)
    assert settle(Pendulum(1.0, jnp.zeros((0,))), 1.0).well.shape == (0,)
    lost = settle(Pendulum(1.0, 0.3, 0.5), 0.0, jnp.array([1e25, -1e25, 1e18]), throw=False)
    assert (lost.result == Result.not_a_number).all()


@pytest.mark.parametrize("function", [lambda p: settle(p, 1.0), mean_velocity])
def test_bad_scenes(function):
    with pytest.raises(ValueError, match="`pendulum` must have damping"):
        function(Pendulum(1.0))
    with pytest.raises(ValueError, match="`pendulum` must have a constant torque"):
        function(Pendulum(1.0, 0.1, jnp.sin))
