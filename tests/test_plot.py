"""`pendax.plot`: an `ax` in, the same out, and the data on it."""

import inspect

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import pendax
from pendax import plot

pytestmark = pytest.mark.usefixtures("standard_promotion")

TS = np.linspace(0, 10, 50)


@pytest.fixture
def ax():
    return Figure().subplots()


def test_time_series_and_portrait(ax):
    run = pendax.simulate(pendax.Pendulum(), TS, np.array([1.0, 1.9]))
    assert plot.time_series(ax, TS, run.theta, [1.0, 1.9], name="v0") is ax
    assert [t.get_text() for t in ax.get_legend().get_texts()] == ["1", "1.9"]
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), run.theta[1])
    ax = Figure().subplots()
    assert plot.phase_portrait(ax, run.theta, run.v, [1.0, 1.9]) is ax
    assert plot.separatrix(ax, pendax.Pendulum()) is ax
    x, y = ax.lines[-2].get_xydata().T
    np.testing.assert_allclose(pendax.energy(pendax.Pendulum(), x, y), 2, rtol=1e-13)


def test_many_curves_get_a_colour_bar(ax):
    plot.time_series(ax, TS, np.outer(np.arange(20.0), TS), np.arange(20.0), name="slope")
    assert ax.get_legend() is None
    assert ax.figure.axes[1].get_ylabel() == "slope"


def test_levels_are_closed(ax):
    """A swing's level reaches v = 0 at both turning points, within the grid."""
    plot.energy_levels(ax, pendax.Pendulum(), [0.5, 2.5])
    x, y = ax.lines[0].get_xydata().T
    assert abs(np.nanmax(np.where(y == 0, x, np.nan)) - np.pi / 3) < 4e-3
    assert np.nanmin(ax.lines[1].get_ydata()[:2001]) == pytest.approx(1, rel=1e-12)


def test_potential(ax):
    assert plot.potential_energy(ax, pendax.Pendulum(4.0), [1.0, 2.0]) is ax
    level = ax.lines[1].get_xydata()
    x = level[np.isfinite(level[:, 1]), 0]
    np.testing.assert_allclose(np.abs(x[np.abs(x) < np.pi]).max(), np.pi / 2, atol=4e-3)


def test_spectrum_marks_harmonics(ax):
    exact = pendax.harmonics(pendax.Pendulum(), 1.9, count=5)
    at = float(exact.frequency) * np.arange(1, 6)
    power = np.asarray(exact.amplitude) ** 2
    assert plot.spectrum(ax, np.linspace(0, 4, 9), np.ones(9), (at, power)) is ax
    assert [t.get_text() for t in ax.texts] == ["1", "3", "5"]


def test_fate_map(ax):
    tau, v0 = np.array([0.1, 0.19, 0.3]), np.array([0.1, 2.3])
    ends = pendax.settle(pendax.Pendulum(1.0, 0.16, tau), v0[:, None])
    assert plot.fate_map(ax, tau, v0, ends) is ax
    shown = ax.collections[0].get_array()
    np.testing.assert_array_equal(np.ma.getmaskarray(shown), np.asarray(ends.running) != 0)
    np.testing.assert_array_equal(shown.compressed(), np.asarray(ends.well)[ends.running == 0])
    with pytest.raises(ValueError, match=r"`ends` must be of shape \(3, 2\)"):
        plot.fate_map(ax, v0, tau, ends)


def test_work_precision(ax):
    methods = {"closed form": (0.0, 1e-4), "Dopri8": ([1e-3, 1e-9], [0.1, 0.3])}
    assert plot.work_precision(ax, methods) is ax
    assert ax.lines[0].get_ydata() == [1e-17]
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")


@pytest.mark.parametrize("v", [0.5, 3.0])
def test_construction(ax, v):
    assert plot.construction(ax, pendax.Pendulum(), 1.0, v) is ax
    found = {line.get_label(): line.get_xydata() for line in ax.lines}
    (chord,) = (xy for name, xy in found.items() if str(name).startswith("AP"))
    assert np.linalg.norm(chord[1] - chord[0]) == pytest.approx(2 * np.sin(0.5), rel=1e-12)


def test_looks():
    with plot.style("dark"):
        assert mpl.rcParams["axes.facecolor"] == plot.DARK_STYLE["axes.facecolor"]
        assert plot.colour_of("law") == plot.DARK_COLOURS["law"]
    with plot.style():
        assert plot.colour_of("law") == plot.COLOURS["law"]
    with pytest.raises(ValueError, match="`look` must be 'light' or 'dark', but got 'dim'"):
        inspect.unwrap(plot.style)("dim")  # pyright: ignore[reportArgumentType]


def test_legends_stay_within_the_figure(ax):
    """Beside the axes only where the layout makes room."""
    plot.time_series(ax, TS, np.ones((2, TS.size)), [1.0, 2.0], name="$v_0$")
    figure = ax.figure
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    box = ax.get_legend().get_window_extent(canvas.get_renderer())
    assert figure.bbox.contains(box.x1, box.y1)
    assert ax.bbox.contains(box.x0, box.y0)


def test_bad_input(ax):
    with pytest.raises(ValueError, match=r"as many points as there are abscissae.*\(50,\) and"):
        plot.time_series(ax, TS, np.ones((TS.size, 2)))
    with pytest.raises(ValueError, match="`energies` must be some numbers ≥ 0"):
        plot.energy_levels(ax, pendax.Pendulum(), [-1.0])
    with pytest.raises(ValueError, match="`name` must be one of below, above"):
        plot.colour_of("blue")


def test_values_and_curves_differ(ax):
    with pytest.raises(ValueError, match="rows with one of the `values` each"):
        plot.time_series(ax, TS, np.ones((2, TS.size)), [1.0])
