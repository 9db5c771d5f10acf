"""Committed figures are those of today's sources, and the hash sees what changes a figure."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.figures import sources
from tests.figures.catalogue import FIGURES, Figure, missing
from tests.figures.sources import code, fingerprint, measured, place, stamp, stamped
from tests.support.paths import RESULTS, ROOT

PAGES = pytest.mark.parametrize("figure", FIGURES, ids=lambda figure: figure.page)


@pytest.mark.long
@PAGES
def test_the_committed_page_was_made_from_todays_sources(figure: Figure) -> None:
    made = stamped(figure.text())
    assert made is not None, f"{figure.page} bears no stamp; run: make figures PAGES={figure.page}"
    assert made == fingerprint(figure), f"{figure.page} is stale; run: make figures PAGES={figure.page}"


@PAGES
def test_a_page_bears_its_stamp_and_names_files_that_exist(figure: Figure) -> None:
    assert not missing(figure)
    line = stamp(figure, "2026-01-02")
    assert stamped(f"# Title\n\ntable\n\n{line}\n") == fingerprint(figure)
    assert stamped("# Title\n\ntable\n") is None


def test_what_is_measured_is_what_is_imported_wherever_the_import_stands() -> None:
    found = measured(["sim_bridge.campaign.spatial_campaign"])
    assert {"onboard.core.geometry.apollonius", "sim_bridge.draws"} <= set(found)
    assert not any(module.startswith(("gcs.", "onboard.agent.")) for module in found)
    for module in found:
        assert place(module).is_file(), module


def test_a_comment_changes_no_hash_and_a_digit_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    figure = FIGURES[0]
    before, real = fingerprint(figure), place
    [victim] = [module for module in measured(figure.modules) if module.endswith("campaign.encircled")]
    text = real(victim).read_text(encoding="utf-8")

    def seen(changed: str) -> str:
        copy = tmp_path / "changed.py"
        copy.write_text(changed, encoding="utf-8")
        monkeypatch.setattr(sources, "place", lambda module: copy if module == victim else real(module))
        return fingerprint(figure)

    assert seen(f"# a remark\n{text}") == before
    assert seen(re.sub(r'^"""', '"""Other words. ', text, count=1)) == before
    digit = re.sub(r"(?m)^(NEAR\b.*= *)(\d)", lambda m: f"{m[1]}{(int(m[2]) + 1) % 10}", text, count=1)
    assert digit != text
    assert seen(digit) != before


def test_code_that_differs_differs() -> None:
    assert code("def f():\n    'says'\n    return 1") == code("def f():\n\n    return 1  # one")
    assert code("def f():\n    return 1") != code("def f():\n    return 2")


def test_the_pages_of_the_catalogue_are_committed() -> None:
    assert all((ROOT / "benchmarks" / "results" / figure.page).is_file() for figure in FIGURES)


def test_the_claims_of_the_readme_are_those_of_the_committed_pages() -> None:
    """The README says how often an encircled evader escapes after all; so does the page, row by row."""
    page = (RESULTS / "encircled.md").read_text(encoding="utf-8")
    rows = re.findall(r"\| \d \| (\w+) \| \w+ \| (encircled|not encircled) \| (\d+) of (\d+)", page)
    found = {key: [(int(c), int(n)) for *what, c, n in rows if tuple(what) == key]
             for key in {(place, start) for place, start, *_ in rows}}
    escaped = [round(100.0 * (1.0 - c / n)) for c, n in found["random", "encircled"]]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"fails in {min(escaped)} to {max(escaped)} % of games from random places" in readme
    ring = found["ring", "encircled"]
    assert all(c == n for c, n in ring)
    assert f"in none of {sum(n for _, n in ring)} from an" in readme
    free = found["random", "not encircled"]
    assert not any(c for c, _ in free)
