"""Results as JSON, with what they were measured on."""

import json
import os
import platform
from importlib.metadata import version
from pathlib import Path

FOLDER = Path(__file__).parent / "results"
_PACKAGES = ("pendax", "jax", "jaxlib", "diffrax", "equinox", "numpy", "scipy")


def write(name: str, rows: list[dict], **settings) -> Path:
    """`rows` of plain values into results/NAME.json, beside the machine, versions and settings."""
    import jax

    FOLDER.mkdir(exist_ok=True)
    path = FOLDER / f"{name}.json"
    content = {
        "machine": {
            "device": jax.devices()[0].device_kind,
            "processor": platform.processor() or platform.machine(),
            "cores": os.cpu_count(),
            "python": platform.python_version(),
        },
        "versions": {package: version(package) for package in _PACKAGES},
        "settings": settings,
        "rows": rows,
    }
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def markdown(rows: list[dict]) -> str:
    """A table, a column for every key of the first row; floats to two digits."""
    head = list(rows[0])
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(_shown(row[name]) for name in head) + " |" for row in rows]
    return "\n".join(lines)


def _shown(value) -> str:
    if value is None:
        return ""
    return f"{value:.2g}" if isinstance(value, float) else str(value)
