"""The peers that are there: Python libraries, and GSL and Boost through a small driver."""

import ctypes
import importlib
import subprocess
import tempfile
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from types import ModuleType

import numpy as np

DRIVER = Path(__file__).parent / "peers.cpp"
_RESULTS = {
    "ellipj": 3,
    **dict.fromkeys(("ellipk", "ellipkinc", "ellipeinc", "ellippi", "ellippiinc"), 1),
}


ABSENT: set[str] = set()  # of the peers that were asked for


def library(name: str) -> ModuleType | None:
    """The module, or None and a line that says so."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        print(f"skipped: {name} ({error})")
        ABSENT.add(name)
        return None


def compiled(function: str, columns: list[np.ndarray]) -> dict[str, Callable[[], np.ndarray]]:
    """Calls that give the results, one below the other, by the name of the library; on one core."""
    columns = [np.ascontiguousarray(x, float) for x in columns]
    found = {}
    for peer in ("GSL", "Boost"):
        driver = _built(peer)
        if driver is not None and hasattr(driver, function):
            found[peer] = partial(_called, getattr(driver, function), _RESULTS[function], columns)
    return found


def _called(function, results: int, columns: list[np.ndarray]) -> np.ndarray:
    out = np.empty((results, columns[0].size))
    function(ctypes.c_long(columns[0].size), _pointers(columns), _pointers(out))
    return out if results > 1 else out[0]


def _pointers(rows) -> ctypes.Array:
    return (ctypes.c_void_p * len(rows))(*(row.ctypes.data for row in rows))


@cache
def _built(peer: str) -> ctypes.CDLL | None:
    flags = ["-DWITH_GSL", "-lgsl", "-lgslcblas"] if peer == "GSL" else []
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "peers.so"
        command = ["c++", "-O3", "-march=native", "-std=c++17", "-shared", "-fPIC", str(DRIVER)]
        try:
            subprocess.run(
                [*command, "-o", str(program), *flags, "-lm"],
                check=True,
                capture_output=True,
                text=True,
            )
        except (OSError, subprocess.CalledProcessError) as error:
            why = getattr(error, "stderr", None) or str(error)
            print(f"skipped: {peer}, whose driver does not build ({why.strip().splitlines()[0]})")
            ABSENT.add(peer)
            return None
        driver = ctypes.CDLL(str(program))
    driver.prepare()
    return driver
