"""SciPy's own tests of these functions, run with pendax's in their place.

Deliberate differences, none of which these tests touch: `ellipj` takes m < 0 and m > 1,
where SciPy gives NaN; arrays are JAX's.
"""

import importlib
import warnings

import numpy as np
import pytest
import scipy.special

import pendax.special

NAMES = ["ellipj", "ellipk", "ellipkm1", "ellipe"]


def in_numpy(function):
    def call(*arguments):
        results = function(*(np.asarray(x, float) for x in arguments))
        if isinstance(results, tuple):
            return tuple(np.asarray(x)[()] for x in results)
        return np.asarray(results)[()]

    return call


@pytest.fixture
def scipys(monkeypatch, request):
    """SciPy's test module of a name, with pendax's functions wherever it finds SciPy's."""
    for mark in ("fail_slow", "slow", "xslow", "thread_unsafe", "xfail_on_32bit"):
        request.config.addinivalue_line("markers", f"{mark}: SciPy's")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # as SciPy's own configuration does

        def load(name):
            pytest.importorskip("scipy.special.tests", reason="SciPy comes without its tests")
            for function in NAMES:
                ours = in_numpy(getattr(pendax.special, function))
                monkeypatch.setattr(scipy.special, function, ours)
            module = importlib.import_module(f"scipy.special.tests.{name}")
            return importlib.reload(module)

        yield load


@pytest.mark.parametrize("name", ["ellipj_nan", "ellipj", "ellipk", "ellipe"])
def test_basic(scipys, name):
    getattr(scipys("test_basic").TestEllip(), f"test_{name}")()


def test_dn_at_the_quarter_period(scipys):
    scipys("test_mpmath").test_dn_quarter_period()


@pytest.mark.parametrize("name", ["ellipk", "ellipe", "ellipfun_sn", "ellipfun_cn", "ellipfun_dn"])
def test_against_mpmath(scipys, name):
    getattr(scipys("test_mpmath").TestSystematic(), f"test_{name}")()


def test_tables(scipys):
    """The tables of K and E that SciPy took from Boost, and its own."""
    module = scipys("test_data")
    tests = [t for t in (*module.BOOST_TESTS, *module.LOCAL_TESTS) if uses_ours(t)]
    assert len(tests) == 3
    for test in tests:
        test.check(dtype=np.float64)


def uses_ours(test) -> bool:
    return getattr(test.func, "__name__", "") in ("ellipk_", "ellipe_", "call")
