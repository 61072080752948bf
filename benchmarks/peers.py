"""The peers that are there: Python libraries, and GSL and Boost through a small driver."""

import importlib
import subprocess
import tempfile
from pathlib import Path
from types import ModuleType

import numpy as np

DRIVER = Path(__file__).parent / "peers.cpp"
THIRD_KIND = Path(__file__).parent / "third_kind.cpp"


def library(name: str) -> ModuleType | None:
    """The module, or None and a line that says so."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        print(f"skipped: {name} ({error})")
        return None


def compiled(peer: str, u: np.ndarray, m: np.ndarray) -> tuple[float, list[np.ndarray]] | None:
    """(seconds an element on one core, [sn, cn, dn]) of "GSL" or "Boost", best of five."""
    flags = ["-DWITH_GSL", "-lgsl", "-lgslcblas"] if peer == "GSL" else []
    return _run(DRIVER, peer, flags, [u, m], 3)


def third_kind(columns: list[np.ndarray]) -> tuple[float, list[np.ndarray]] | None:
    """The same of Boost's Π(n | m) for columns n, m, and Π(n; φ | m) for n, φ, m."""
    return _run(THIRD_KIND, "Boost", [f"-DCOLUMNS={len(columns)}"], columns, 1)


def _run(source, peer, flags, columns, results) -> tuple[float, list[np.ndarray]] | None:
    with tempfile.TemporaryDirectory() as folder:
        program, data = Path(folder) / "peers", Path(folder) / "data"
        command = ["c++", "-O3", "-march=native", "-std=c++17", str(source), "-o", str(program)]
        try:
            subprocess.run([*command, *flags, "-lm"], check=True, capture_output=True, text=True)
        except (OSError, subprocess.CalledProcessError) as error:
            why = getattr(error, "stderr", None) or str(error)
            print(f"skipped: {peer}, whose driver does not build ({why.strip().splitlines()[0]})")
            return None
        np.concatenate(columns).tofile(data)
        done = subprocess.run(
            [str(program), str(columns[0].size), str(data)],
            check=True,
            capture_output=True,
            text=True,
        )
        values = np.fromfile(f"{data}.out").reshape(results, -1)
        return float(done.stdout) * 1e-9, list(values)
