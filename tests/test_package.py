"""What a fresh user sees first: imports, README, notebooks."""

import ast
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


def test_a_room_is_loaded_when_it_is_asked_for():
    show = "print(*sorted(m for m in sys.modules if m.startswith('pendax.')))"
    assert "jax" not in python("import sys, pendax; print(*sys.modules)").split()
    loaded = python(f"import sys, pendax; pendax.frequency; {show}").split()
    assert "pendax._exact" in loaded
    rooms = ("fate", "fit", "josephson", "taylor", "_simulate")
    assert not [m for m in loaded if m.split(".")[1] in rooms]
    special = python(f"import sys; from pendax.special import ellipk; {show}").split()
    assert all(m.split(".")[1] in ("special", "_arrays") for m in special)


def test_public_names_are_where_they_are_said_to_be():
    """Those for type checkers, those that are loaded when asked for, and the help."""
    import pendax

    tree = ast.parse((ROOT / "pendax/__init__.py").read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    said = {a.name: f".{n.module or ''}" for n in block.body for a in n.names}
    assert {n for n, room in said.items() if room == "."} == set(pendax._MODULES)
    assert {n: room for n, room in said.items() if room != "."} == pendax._HOME
    for name in said:
        assert name in dir(pendax)
        assert getattr(pendax, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'frequencies'"):
        pendax.frequencies  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]


def test_import_leaves_the_settings_of_jax_alone():
    assert python("import jax, pendax; print(jax.config.jax_enable_x64)").strip() == "False"


def test_plots_load_when_asked_for():
    python("import pendax; pendax.plot.frequency_curve; pendax.figures.FIGURES['13']")


BLOCKS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[-1][:30])
def test_readme_example_runs(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    python(block)


def test_readme_has_examples():
    assert len(BLOCKS) > 5


def test_every_public_name_has_a_docstring():
    import pendax
    import pendax.special

    for module in (pendax, pendax.special):
        for name in dir(module):
            if name[0] != "_" and callable(getattr(module, name)):
                assert len(getattr(module, name).__doc__ or "") > 40, name


def execute(path):
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": path.parent}}).execute()
    return notebook


QUICK = ("elliptic", "separatrix")  # the others take a minute or two each


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=[] if path.stem in QUICK else pytest.mark.full)
        for path in sorted((ROOT / "notebooks").glob("*.ipynb"))
    ],
)
def test_notebook_runs(path):
    pictures = sum("image/png" in str(cell.get("outputs")) for cell in execute(path).cells)
    assert pictures >= 2


@pytest.mark.full
def test_fitting_a_real_swing(shared, monkeypatch):
    """The recording that the notebook names, in place of the synthetic one."""
    swing = shared / "data/pendulum/benard_free_swing_45deg.csv"
    monkeypatch.setenv("PENDAX_SWING", str(swing))
    text = str([cell.get("outputs") for cell in execute(ROOT / "notebooks/fitting.ipynb").cells])
    assert "recording from PENDAX_SWING: 4871 samples" in text


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda p: p.stem)
def test_notebook_is_stored_without_output(path):
    for cell in nbformat.read(path, as_version=4).cells:
        assert cell.cell_type != "code" or not (cell.outputs or cell.execution_count)
