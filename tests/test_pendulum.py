import inspect

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import pendax
from pendax import Pendulum, energy, frequency, simulate


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"epsilon": -1.0}, "Argument `epsilon` must be positive, but got -1.0."),
        ({"epsilon": 0}, "Argument `epsilon` must be positive, but got 0."),
        ({"epsilon": np.array([1.0, -2.0])}, "Argument `epsilon` must be positive, but got -2.0."),
        ({"epsilon": np.inf}, "Argument `epsilon` must be positive, but got inf."),
        ({"beta": -0.1}, "Argument `beta` must be zero or positive, but got -0.1."),
    ],
)
def test_bad_values(arguments, message):
    with pytest.raises(ValueError, match=message):
        Pendulum(**arguments)


def test_absent_terms_are_absent():
    assert len(jax.tree.leaves(Pendulum(2.0))) == 1
    assert len(jax.tree.leaves(Pendulum(2.0, 0.1, 0.3))) == 3
    assert Pendulum(2).epsilon.dtype == jnp.result_type(float)
    assert Pendulum(2).epsilon.weak_type


def test_a_function_of_time_passes_jit():
    pendulum = Pendulum(1.0, 0.1, lambda t: 2 * t)
    assert jax.jit(lambda p: p.tau(3.0))(pendulum) == 6


def test_tracers_and_other_leaves_pass():
    assert jax.jit(lambda e: Pendulum(e).epsilon)(-1.0) == -1
    assert jax.tree.map(lambda _: "leaf", Pendulum(1.0)).epsilon == "leaf"


@pytest.mark.parametrize("function", [frequency, lambda p, v0: pendax.time_to(p, 1.0, v0)])
def test_closed_forms_refuse_damping_and_torque(function):
    with pytest.raises(ValueError, match=r"neither friction nor torque .* got one with `beta`"):
        function(Pendulum(1.0, beta=0.1), 1.0)


def test_a_number_is_no_pendulum():
    with pytest.raises(ValueError, match="Argument `pendulum` must be a Pendulum, but got float"):
        inspect.unwrap(frequency)(9.81, 1.0)


@pytest.mark.parametrize("half", ["float16", "bfloat16"])
def test_half_precision_rounds_float32(half):
    v0 = jnp.asarray([0.5, 1.0, 3.0], half)
    wide = v0.astype(jnp.float32)
    assert frequency(Pendulum(), v0).dtype == half
    assert (frequency(Pendulum(), v0) == frequency(Pendulum(), wide).astype(half)).all()
    run = simulate(Pendulum(), jnp.ones((), half), v0)
    assert run.theta.dtype == half
    assert jnp.isfinite(run.theta).all()


def test_energy_keeps_the_digits_of_small_angles():
    assert energy(Pendulum(3.0), 1e-10, 0.0) == pytest.approx(1.5e-20, rel=1e-15)
    np.testing.assert_allclose(energy(Pendulum(), np.pi, 2.0), 4.0)
