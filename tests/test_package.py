"""What a fresh user sees first: imports, README, notebooks."""

import re
import subprocess
import sys

import nbformat
import pytest
from conftest import ROOT
from nbclient import NotebookClient

README = (ROOT / "README.md").read_text(encoding="utf-8")


def python(code: str) -> str:
    command = [sys.executable, "-W", "error", "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_import_is_lean():
    heavy = ("matplotlib", "diffrax", "optax", "optimistix", "scipy.optimize")
    code = "import sys, pendax; print(*sorted(m for m in sys.modules))"
    loaded = python(code).split()
    assert not [m for m in loaded if m.startswith(heavy)]


def test_import_leaves_the_settings_of_jax_alone():
    assert python("import jax, pendax; print(jax.config.jax_enable_x64)").strip() == "False"


def test_plots_load_when_asked_for():
    python("import pendax; pendax.plot.frequency_curve; pendax.figures.FIGURES['13']")


def test_readme_example_runs():
    blocks = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert blocks
    for block in blocks:
        python(block)


def test_every_public_name_has_a_docstring():
    import pendax
    import pendax.special

    for module in (pendax, pendax.special):
        for name in dir(module):
            if name[0] != "_" and callable(getattr(module, name)):
                assert len(getattr(module, name).__doc__ or "") > 40, name


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.stem)
def test_notebook_runs(path):
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": path.parent}}).execute()


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.stem)
def test_notebook_is_stored_without_output(path):
    for cell in nbformat.read(path, as_version=4).cells:
        assert cell.cell_type != "code" or not (cell.outputs or cell.execution_count)
