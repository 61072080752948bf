"""The benchmarks' own arithmetic: timings, bars, what differs, references, the README's blocks."""

import time
from functools import partial
from pathlib import Path

import damped_references
import numpy as np
import pytest

from benchmarks import TOPICS, front, problems, readme, report, results
from benchmarks.timing import Timing, expected, side_by_side

ROOT = Path(__file__).parent.parent


def test_timings_are_of_the_calls():
    """Each call to warm up, and in turn in each round, after itself; ratios round by round."""
    order = []

    def call(name):
        order.append(name)
        time.sleep(0.003)

    found = side_by_side({"a": partial(call, "a"), "b": partial(call, "b")}, 3)
    assert order == list("aabb") * 3
    assert all(len(timing.samples) == 3 for timing in found.values())
    more = side_by_side({"a": partial(time.sleep, 0.003), "b": partial(time.sleep, 0.06)}, 2, 4)
    assert [len(timing.samples) for timing in more.values()] == [4, 2]
    short = side_by_side({"a": lambda: order.append("short")}, 3)["a"]
    assert order.count("short") == 2 + 3 * (1 + 200)
    assert short.median < 1e-3
    ratio = Timing((2.0, 3.0, 8.0)).over(Timing((1.0, 1.0, 2.0)))
    assert ratio["ratio"] == 3.0
    assert (ratio["from"], ratio["to"]) == expected((2.0, 3.0, 4.0))
    assert Timing((2.0, 4.0, 9.0)).over(Timing((1.0, 1.0))) == {
        **dict(zip(("from", "to"), expected((2.0, 4.0)), strict=True)), "ratio": 3.0
    }  # fmt: skip
    twice = Timing((2.0, 2.0))
    once, off = Timing((3.0,)).over(twice), 1.5 * (1 + twice.spread)  # of one a half is assumed
    assert once == pytest.approx({"ratio": 1.5, "from": 1.5 / off, "to": 1.5 * off})
    assert Timing((1.0, 2.0)).in_every_round(Timing((2.0, 3.0)))
    assert not Timing((1.0, 2.0)).in_every_round(Timing((2.0, 2.0)))


@pytest.mark.parametrize("rounds", [3, 5, 20])
def test_medians_of_other_runs_are_in_the_spread(rounds):
    """Of runs of which each round is off by chance alone, 1 of 100 lies outside."""
    rng = np.random.default_rng(3)
    runs = np.exp(rng.normal(0.0, 0.1, (2, 2000, rounds)) + rng.normal(0.0, 0.1, (2, 2000, 1)))
    outside = 0
    for first, second in zip(*runs, strict=True):
        low, high = expected(first)
        assert low <= first.min() <= first.max() <= high
        outside += not low <= np.median(second) <= high
    assert outside <= 0.02 * 2000
    assert Timing(tuple(runs[0, 0])).spread > 0


def test_bars():
    assert results.bar("x", 1.0, at_most=1.0)["verdict"] == "met"
    assert results.bar("x", 1.1, at_most=1.0)["verdict"] == "missed"
    assert results.bar("x", 0.9, at_least=1.0)["verdict"] == "missed"
    assert results.bar("x", float("nan"), at_least=1.0)["verdict"] == "skipped"
    row = results.bar("x", Timing((2.0, 4.0)).over(Timing((1.0, 1.0))), at_most=1.0)
    assert (row["measured"], row["from"], row["to"]) == (3.0, *expected((2.0, 4.0)))
    assert results.missed({"bars": [row]}) == ["x"]
    with pytest.raises(ValueError, match="at_most"):
        results.bar("x", 1.0)


def test_what_differs(capsys):
    """Errors exactly, times and ratios by their spread; the first are counted apart."""
    old = {
        "a": [{"who": "x", "error": 1e-10, "µs": 10.0, "spread": 0.2, "compiling, s": 2.0}],
        "b": [{"ratio": 2.0, "from": 1.8, "to": 2.2}],
    }

    def but(changes):
        return results.differ(old, {**old, "a": [{**old["a"][0], **changes}]})

    assert results.differ(old, old) == but({"µs": 11.9, "spread": 9.0}) == (0, 0, 0)
    assert but({"compiling, s": 2.9}) == (0, 0, 0)
    assert but({"µs": 12.1, "spread": 9.0}) == but({"compiling, s": 3.1}) == (0, 0, 1)
    assert but({"error": float(np.nextafter(1e-10, 1))}) == but({"error": None}) == (1, 0, 0)
    assert but({"error": 1e-9, "µs": 20.0}) == (1, 0, 0)
    assert results.differ(old, {**old, "b": [{"ratio": 2.3, "from": 2.1, "to": 2.6}]}) == (0, 1, 0)
    assert results.differ(old, {**old, "b": [{"ratio": 2.1, "from": 2.0, "to": 2.6}]}) == (0, 0, 0)
    lost = {"where": "x", "ratio": 2.0, "from": 1.8, "to": 2.2, "at": 3}
    both = {"losses": [lost, {**lost, "where": "y"}]}
    assert results.differ(both, {"losses": [{**lost, "at": 4}]}) == (0, 0, 1)
    assert results.differ(both, {"losses": [{**lost, "ratio": 3.0}]}) == (0, 1, 1)
    error = {"where": "x", "of": "error", "ratio": 2.0, "from": None, "to": None}
    assert results.differ({"losses": [error]}, {"losses": [{**error, "ratio": 2.1}]}) == (1, 0, 0)
    assert results.differ(old, {"a": old["a"]}) == (1, 0, 0)
    said = capsys.readouterr().out
    assert "DIFFERS: a: x: error 1e-10 → 1e-09, µs 10 → 20" in said
    assert "error 1e-10 → 1.0000000000000002e-10" in said
    assert "ratio: losses: x: ratio 2 → 3 (from 1.8 to 2.2)" in said
    seconds = {"bar": "compiling, s", "measured": 2.0, "from": 1.8, "to": 2.2}
    assert results.differ({"b": [seconds]}, {"b": [{**seconds, "measured": 3.0}]}) == (0, 0, 1)


def test_another_machine_is_named():
    here = results.here()
    assert results.moved(here) == []
    machine, versions = here["machine"], here["versions"]
    there = {"machine": {**machine, "processor": "abacus"}, "versions": {**versions, "jax": "0"}}
    assert results.moved(there) == [
        f"processor: abacus → {machine['processor']}", f"jax: 0 → {versions['jax']}"
    ]  # fmt: skip
    assert len(results.moved({})) == len(machine) + sum(x is not None for x in versions.values())


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "there is no"),
        ('{"settings": {"seed"', "is damaged (JSONDecodeError"),
        ("[1]", "is damaged (TypeError"),
        ('{"settings": {"seed": 1}}', "is damaged (KeyError('tables')"),
        ('{"settings": {"seed": 2}, "tables": {}}', "is of {'seed': 2}, not {'seed': 1"),
    ],
)
def test_nothing_to_compare_with(content, said, tmp_path, monkeypatch, capsys):
    """It is said before anything is measured."""
    monkeypatch.setattr(results, "FOLDER", tmp_path)
    if content is not None:
        (tmp_path / "dry.json").write_text(content)
    assert results.kept("dry", {"seed": 1, "quick": False}) is None
    assert said in capsys.readouterr().out


def test_losses():
    """Of each peer the smallest error that we don't reach, and where it is fastest; float32 does
    not count as ours, nor wide vectors, and errors below the floor are equal."""

    def row(method, error):
        return {"problem": "p", "method": method, "setting": "", "error": error, "µs": 1.0,
                "spread": 0.0}  # fmt: skip

    rows = [row("pendax", 1e-8), row("pendax", 1e-12), row("pendax, float32", 1e-16)]
    rows += [row("a", 1e-14), row("a", 1e-8), row("a", 1e-6), row("b", 1e-12), row("b", 1e-17)]
    times = [Timing((t,)) for t in (2.0, 4.0, 0.1, 1.0, 1.0, 0.5, 5.0, 9.0)]
    alone, faster, last = front.losses(rows, times, 1e-15)
    assert (alone["peer"], alone["error"], alone["ratio"], alone["at"]) == ("a", 1e-14, None, 1)
    assert (faster["peer"], faster["error"], faster["ratio"], faster["at"]) == ("a", 1e-6, 0.25, 2)
    assert (last["peer"], last["error"]) == ("b", 1e-17)
    assert [x["at"] for x in front.losses(rows, times, 1e-11)] == [3]
    assert [x["pendax, µs"] for x in front.best(rows, 1e-11)] == [1.0, 1.0]
    assert [x["pendax, µs"] for x in front.best(rows, 1e-15)] == [None, None]
    rows, times = [*rows, row("pendax, 512 bits", 1e-7)], [*times, Timing((1.0,))]
    with_wide = front.losses(rows, times, 1e-15)
    assert [x["512 bits"] for x in with_wide] == [None, 0.5, None]
    assert "0.25 (0.11 to 0.56) of our time, 0.5 where XLA uses vectors of 512 bits," in (
        report.losses({"losses": [{**with_wide[1], "why": ""}]})
    )


def test_markdown():
    rows = [{"x": 0.123456, "name": None}, {"x": 123.4, "name": "a"}, {"x": 1e-9, "name": "b"}]
    lines = results.markdown(rows).split("\n")
    assert lines[0] == "| x | name |"
    assert lines[2:] == ["| 0.12 |  |", "| 120 | a |", "| 1e-09 | b |"]


def test_reference_of_a_periodic_torque():
    """Without the wave it is the Taylor series in Arb; with it, a step half as long agrees."""
    found = problems._waved(0.5, 0.9, (0.0, 0.6), 0.3, 1.1, 6.0)
    true = damped_references.trajectory(1.0, 0.5, 0.9, 0.3, 1.1, [6.0])[0][0]
    np.testing.assert_allclose(found, true, rtol=1e-15)
    import mpmath

    with mpmath.workdps(30):

        def force(t, y):
            return [y[1], 0.9 + 0.4 * mpmath.cos(0.6 * t) - 0.5 * y[1] - mpmath.sin(y[0])]

        start = [mpmath.mpf(0.3), mpmath.mpf(1.1)]
        long, short = (problems._extrapolated(force, mpmath.mpf(6), start, step=h)[0]
                       for h in (0.25, 0.125))  # fmt: skip
        assert abs(long - short) < 1e-18


def test_readme_shows_what_was_measured():
    """Every block, and the whole report, is what the results files in the tree give."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert readme.renewed(text) == text
    assert report.REPORT.read_text(encoding="utf-8") == report.text()
    assert {name for name in readme.BLOCKS if f"<!-- {name} -->" in text} == set(TOPICS)
