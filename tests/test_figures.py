"""The sources' figures: what they show, and that all of it can be read."""

import itertools
from functools import cache

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

import pendax
from pendax import plot
from pendax.cli import main
from pendax.figures import ANIMATIONS, FIGURES

pytestmark = pytest.mark.usefixtures("standard_promotion")

# One of each kind; the others are of the same functions with other numbers.
SOME = ("2", "4", "5.2g", "7b", "9", "13", "18", "7.2a", "8.2.2b", "8.2.3", "B", "es4")
OTHERS = sorted(set(FIGURES) - set(SOME))
names = pytest.mark.parametrize(
    "name", [*SOME, *(pytest.param(name, marks=pytest.mark.full) for name in OTHERS)]
)


def texts(figure: Figure):
    """Bounding boxes of all that is written, in pixels, those of nothing left out."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    for text in figure.findobj(mpl.text.Text):
        if text.get_visible() and text.get_text().strip():
            box = text.get_window_extent(renderer)
            if box.width > 0:
                yield text, box


@cache
def drawn_once(name):
    with plot.style():
        return FIGURES[name].figure()


@names
def test_nothing_written_is_cut_off_or_written_over(name):
    figure = drawn_once(name)
    with plot.style():
        found = list(texts(figure))
    inside = figure.bbox.padded(1)
    # Ticks beyond the limits are artists too, though not drawn.
    drawn = [(t, b) for t, b in found if not (t.axes is None and not inside.overlaps(b))]
    ticks = {t for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)
             for t in (*axis.get_ticklabels(), *axis.get_ticklabels(minor=True))}  # fmt: skip
    within = {t for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)
              for tick in axis._update_ticks() for t in (tick.label1, tick.label2)}  # fmt: skip
    drawn = [(t, b) for t, b in drawn if t not in ticks or t in within]
    assert len(drawn) >= 3
    for text, box in drawn:
        assert inside.contains(box.x0, box.y0), text
        assert inside.contains(box.x1, box.y1), text
    for (one, a), (other, b) in itertools.combinations(drawn, 2):
        # Half a line of one over the other; letters at points of a construction may touch.
        a_, b_ = (x.shrunk(0.8, 0.8) for x in (a, b))
        if len(one.get_text()) > 1 and len(other.get_text()) > 1:
            assert not a_.overlaps(b_), (one, other)


@names
def test_axes_have_names_and_units(name):
    figure = drawn_once(name)
    for ax in figure.axes:
        if ax.axison:
            assert ax.get_xlabel() or ax.get_ylabel(), ax
    assert FIGURES[name].heading in figure.get_suptitle()


def lines(name: str) -> dict[str, np.ndarray]:
    with plot.style():
        (ax, *_) = FIGURES[name].figure().axes
    return {line.get_label(): line.get_xydata() for line in ax.lines}


def test_curves_are_those_of_the_source():
    """Their v0 in the legend, the motion at each (an independent solution) in the curve."""
    import diffrax

    shown = lines("5a")
    assert list(shown) == ["1.7", "1.75", "1.8", "1.85", "1.9", "1.95"]
    for v0, xy in shown.items():
        run = pendax.simulate(
            pendax.Pendulum(), xy[::200, 0], float(v0), solver=diffrax.Dopri8(), rtol=1e-10,
            atol=1e-10,
        )  # fmt: skip
        np.testing.assert_allclose(xy[::200, 1], run.theta, atol=1e-7)


def test_solvers_leave_the_separatrix_and_the_exact_motion_does_not():
    shown = lines("5.2g")
    (exact,) = (xy for name, xy in shown.items() if name.startswith("exact"))
    np.testing.assert_allclose(exact[:, 1], 4 * np.arctan(np.exp(exact[:, 0])) - np.pi, atol=1e-14)
    for name, xy in shown.items():
        if name.startswith("Tsit5"):
            assert np.abs(xy[:, 1] - np.pi)[-60:].max() > 3


@pytest.mark.parametrize(("name", "wells"), [("8.2.3e", [0, 1, 2, 4]), ("8.2.3j", [2, 3, 4, 5, 6])])
def test_where_driven_orbits_end(name, wells):
    with plot.style():
        ax = FIGURES[name].figure().axes[0]
    assert ax.get_title().split("=")[1] == " " + ", ".join(map(str, wells))
    rest = ax.lines[-1].get_xdata()
    assert sorted({round(x / (2 * np.pi)) for x in rest}) == wells


@pytest.mark.parametrize("name", list(ANIMATIONS))
def test_films(name):
    with plot.style():
        figure, draw, count = ANIMATIONS[name].make()
        pictures = []
        for frame in (0, count // 3, count - 1):
            draw(frame)
            canvas = FigureCanvasAgg(figure)
            canvas.draw()
            pictures.append(np.asarray(canvas.buffer_rgba()).copy())
    assert count >= 50
    assert all((a != b).any() for a, b in itertools.combinations(pictures, 2))


def test_command_lists_and_draws(tmp_path, capsys):
    assert main(["figures", "--list"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert listed == [*FIGURES, *ANIMATIONS]
    out = tmp_path / "out"
    assert main(["figures", "--only", "10", "7", "--out", str(out), "--quiet"]) == 0
    drawn = {f"figure-{n}.{form}" for n in ("10", "7a", "7b") for form in ("png", "svg")}
    assert {path.name for path in out.iterdir()} == drawn
    assert (out / "figure-7a.svg").read_text().startswith("<?xml")
    assert capsys.readouterr().out == ""


def test_the_same_figure_is_the_same_file(tmp_path):
    for out in ("one", "two"):
        assert main(["figures", "--only", "8c", "--out", str(tmp_path / out), "--quiet"]) == 0
    for form in ("png", "svg"):
        one, two = ((tmp_path / out / f"figure-8.{form}").read_bytes() for out in ("one", "two"))
        assert one == two


def test_an_unknown_name_says_which_are_near(tmp_path, capsys):
    assert main(["figures", "--only", "5A", "5z", "qq", "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "no figure '5z' (5" in said
    assert "'qq'; --list names them all" in said
    assert "5A" not in said
    assert not (tmp_path / "out").exists()


def test_dark(tmp_path):
    assert main(["figures", "--only", "4", "--look", "dark", "--format", "png", "--out",
                 str(tmp_path), "--quiet"]) == 0  # fmt: skip
    with Image.open(tmp_path / "figure-4.png") as image:
        picture = np.asarray(image.convert("L"))
    assert np.median(picture) < 40
    assert picture.max() > 200


@pytest.mark.full
def test_all_in_two_minutes(tmp_path):
    assert main(["figures", "--out", str(tmp_path), "--quiet"]) == 0
    assert len(list(tmp_path.iterdir())) == 2 * len(FIGURES) + len(ANIMATIONS)
