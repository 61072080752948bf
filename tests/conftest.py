"""Strict JAX for every test, both precisions, and the folder of true values."""

import gc
import os
from pathlib import Path

import jax
import jaxtyping
import pytest

# Annotations are checked at run time, in this package alone; before its first import.
jaxtyping.install_import_hook("pendax", "beartype.beartype")

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_numpy_dtype_promotion", "strict")
jax.config.update("jax_numpy_rank_promotion", "raise")

# Tracing makes millions of objects that live on: up to a quarter of its time went into looking at
# them again and again for cycles.
gc.set_threshold(50_000, 20, 20)

ROOT = Path(__file__).parent.parent


@pytest.fixture(params=["float64", "float32"])
def dtype(request):
    """The test runs in either precision, float32 as with JAX's own settings."""
    with jax.enable_x64(request.param == "float64"):
        yield jax.numpy.dtype(request.param)


# For what compiles long and is the same code in both.
float32_in_full = pytest.mark.parametrize(
    "dtype", ["float64", pytest.param("float32", marks=pytest.mark.full)], indirect=True
)


@pytest.fixture(autouse=True, scope="module")
def forget_compiled_programs():
    """After each file: a process may map 65,530 pieces of memory, and some hundred programs of
    XLA's CPU backend use them up, upon which it aborts."""
    yield
    jax.clear_caches()
    gc.collect()


@pytest.fixture(scope="session")
def shared() -> Path:
    """True values and measurements: $PENDAX_SHARED, else `shared` beside the checkout."""
    folder = Path(os.environ.get("PENDAX_SHARED", ROOT.parent / "shared"))
    if not folder.is_dir():
        pytest.skip(f"needs the folder of true values and measurements, {folder}")
    return folder


@pytest.fixture
def standard_promotion():
    """For tests of what mixed dtypes and ranks give."""
    with jax.numpy_dtype_promotion("standard"), jax.numpy_rank_promotion("allow"):
        yield
