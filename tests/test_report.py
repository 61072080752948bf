"""The verdict on every claim: it covers all of them, follows from numbers, and can flip."""

import re

import numpy as np
import pytest

import pendax.report
from pendax.cli import main
from pendax.figures import FIGURES
from pendax.report import (
    CLAIMS,
    ERRATA,
    SECTIONS,
    Check,
    Claim,
    Erratum,
    Proof,
    ids,
    report,
    verdict,
)

BY_ID = {erratum.id: erratum for erratum in ERRATA}
PROVED = dict.fromkeys(BY_ID, True)  # that they are is tested below


@pytest.fixture(scope="module")
def checks():
    return [claim.check() for claim in CLAIMS]


@pytest.fixture(scope="module")
def proofs():
    return {erratum.id: erratum.proof() for erratum in ERRATA if erratum.proof}


def first_cells(path, start=""):
    rows = re.findall(r"^\| ([^|]+?) \|", path.read_text(), re.M)
    return [row for row in rows if row not in ("id", "#") and row.startswith(start)]


def test_no_entry_is_unanswered(shared):
    listed = first_cells(shared / "checklist.md")
    assert len(listed) > 50
    assert set(ids(CLAIMS)) == set(listed)


def test_every_numbered_misprint_is_there(shared):
    listed = first_cells(shared / "errata.md", "S")
    assert len(listed) > 40
    assert [e.id for e in ERRATA if "-T" not in e.id] == listed
    assert len(BY_ID) == len(ERRATA)


def test_what_is_wrong_by_other_reckoning_is_wrong_here(shared, checks):
    """Well lists and winding numbers, against a table of fates computed elsewhere."""
    rows = [line.split(",") for line in (shared / "truth/claims.csv").read_text().splitlines()[1:]]
    wrong = {row[0] for row in rows if row[-1].startswith("WRONG")}
    found = {
        f"8.2.3-v0={match[1]}": check.agrees().all()
        for claim, check in zip(CLAIMS, checks, strict=True)
        if claim.id == "8.2.3a-j" and (match := re.search(r"(\d\.\d\d)", claim.says))
    }
    assert len(found) == 10
    assert {name for name, right in found.items() if not right} == {
        name for name in wrong if name.startswith("8.2.3")
    }
    (winding,) = (
        check
        for claim, check in zip(CLAIMS, checks, strict=True)
        if claim.id == "7.2a" and "S2-21" in claim.errata
    )
    true = [int(row[2][2:]) for row in rows if row[0].startswith("7.2-beta")]
    assert sorted(np.ravel(winding.found).tolist()) == sorted(true)


def test_every_claim_is_reproduced_or_explained(checks):
    words = [verdict(c, check, BY_ID, PROVED).word for c, check in zip(CLAIMS, checks, strict=True)]
    assert set(words) == {"reproduced", "corrected", "misprint"}
    for claim in CLAIMS:
        assert set(claim.errata) <= set(BY_ID), claim
        assert set(claim.figures) <= set(FIGURES), claim


@pytest.mark.parametrize("i", range(len(CLAIMS)), ids=lambda i: f"{CLAIMS[i].id}-{i}")
def test_a_claim_that_is_perturbed_changes_its_verdict(checks, i):
    claim, check = CLAIMS[i], checks[i]
    claimed = np.asarray(check.claimed, float)
    if check.agrees().all():
        step = 3 * np.asarray(check.tolerance) + 1e-6 * np.maximum(1, np.abs(claimed))
        for moved in (claimed + step, claimed - step):
            changed = check._replace(claimed=moved)
            assert not changed.agrees().any()
            assert verdict(claim, changed, BY_ID, PROVED).word != "reproduced"
    else:
        assert claim.errata
        if check.corrected is not None:
            spoilt = check._replace(found=np.asarray(check.found) + 1)
            assert verdict(claim, spoilt, BY_ID, PROVED).word == "unexplained"
        unproved = PROVED | dict.fromkeys(claim.errata, False)
        assert verdict(claim, check, BY_ID, unproved).word == "unexplained"
        right = check._replace(claimed=check.found)
        assert verdict(claim, right, BY_ID, PROVED).word == "reproduced"


def test_misprints_are_proved(proofs):
    assert len(proofs) >= 40
    for name, proof in proofs.items():
        assert proof.holds(), name
        step = 3 * np.asarray(proof.tolerance) + 1e-6
        assert not proof._replace(corrected=np.asarray(proof.corrected) + step).holds(), name
        assert not proof._replace(printed=proof.truth).holds(), name
        # The truth is no copy of what it proves.
        assert proof.truth is not proof.corrected, name


def test_verdicts():
    kinds = ("formula", "statement", "text")
    errata = {kind: Erratum(kind, kind, "", "", "", None) for kind in kinds}

    def word(claimed, *cited, corrected=None, proved=True):
        claim = Claim("1", "", "", lambda: check, errata=cited)
        check = Check(claimed, [1.0, 2.0], 0.1, corrected)
        return verdict(claim, check, errata, dict.fromkeys(kinds, proved))

    assert word([1.05, 2.0], "formula")[:3] == ("reproduced", 2, 2)
    assert word([1.05, 2.0]).digits == pytest.approx(np.log10(2 / 0.05))
    assert word([1.05, 3.0], "statement")[:3] == ("corrected", 1, 2)
    assert word([1.05, 3.0], "text").word == "misprint"
    assert word([np.nan, 2.0]).word == "unexplained"
    assert word([1.05, 3.0], "statement", proved=False).word == "unexplained"
    assert word([1.05, 3.0], "statement", corrected=[1.0, 2.05]).word == "corrected"
    assert word([1.05, 3.0], "statement", corrected=[1.0, 2.5]).word == "unexplained"
    assert Proof(1.0, 2.0, 2.0, 0.1).holds()
    assert not Proof([1.0, 2.0], 2.0, 2.0, 0.1).holds()


def test_markdown(checks):
    some = [claim for claim in CLAIMS if claim.id in ("1.2 Fig 2", "7.2a", "2.8 Fig10")]
    cited = [e for e in ERRATA if any(e.id in c.errata for c in some)] + [BY_ID["S2-42"]]
    heard = []
    sections = {"One": some[:2], "Two": some[2:]}
    text = report(sections, cited, lambda n: "2.png" if n == "2" else None, heard.append)
    rows = [line for line in text.splitlines() if line.startswith("| ")]
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {9, 10}
    for claim in some:
        assert any(row.startswith(f"| {claim.id} | {claim.says} |") for row in rows)
    assert text.index("## One") < text.index("## Two") < text.index("## Misprints")
    assert "[2](2.png)" in text
    assert heard == [*(e.id for e in cited), *(claim.id for claim in some)]
    assert "**no**" not in text
    for anchor in re.findall(r"\(#([^)]+)\)", text):
        assert f'<a id="{anchor}"></a>' in text
    assert "corrected (9 of 10 hold); [S2-21](#s2-21)" in text


def test_sections_hold_every_claim_once():
    assert sum(map(len, SECTIONS.values())) == len(CLAIMS) == len(set(map(id, CLAIMS)))


def test_command(tmp_path, capsys, monkeypatch):
    some = [claim for claim in CLAIMS if claim.id == "2.8 Fig10"]
    monkeypatch.setattr(pendax.report, "SECTIONS", {"Ten": some})
    monkeypatch.setattr(pendax.report, "ERRATA", (BY_ID["S2-7"],))
    (tmp_path / "figure-10.png").write_bytes(b"")
    assert main(["report", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert f"1 entries, {len(some)} claims" in said
    assert "[10](figure-10.png)" in (tmp_path / "report.md").read_text()
