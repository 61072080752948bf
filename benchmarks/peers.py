"""The peers that are there: Python libraries, and GSL and Boost through a small driver."""

import importlib
import subprocess
import tempfile
from pathlib import Path
from types import ModuleType

import numpy as np

DRIVER = Path(__file__).parent / "peers.cpp"


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
    with tempfile.TemporaryDirectory() as folder:
        program, data = Path(folder) / "peers", Path(folder) / "data"
        command = ["c++", "-O3", "-march=native", "-std=c++17", str(DRIVER), "-o", str(program)]
        try:
            subprocess.run([*command, *flags, "-lm"], check=True, capture_output=True, text=True)
        except (OSError, subprocess.CalledProcessError) as error:
            why = getattr(error, "stderr", None) or str(error)
            print(f"skipped: {peer}, whose driver does not build ({why.strip().splitlines()[0]})")
            return None
        np.concatenate([u, m]).tofile(data)
        done = subprocess.run(
            [str(program), str(u.size), str(data)], check=True, capture_output=True, text=True
        )
        results = np.fromfile(f"{data}.out").reshape(3, -1)
        return float(done.stdout) * 1e-9, list(results)
