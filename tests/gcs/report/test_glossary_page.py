"""The glossary of rules holds every rule that can be in force, and is up to date."""

from __future__ import annotations

from gcs.report.glossary_page import described
from gcs.report.theme import ACTIONS
from onboard.game import palette
from onboard.wire.bus.messages import SupervisorAction
from tests.support.paths import ROOT


def test_the_page_is_up_to_date() -> None:
    page = (ROOT / "docs" / "rules.md").read_text(encoding="utf-8")
    assert page == described(), "python -m gcs.report.glossary_page > docs/rules.md"


def test_every_rule_that_has_a_colour_has_a_sentence() -> None:
    lines = described().splitlines()
    for rule in palette.RULES:
        (line,) = {line for line in lines if line.startswith(f"| `{rule}` |")}
        assert "does not hold" not in line, rule


def test_every_action_of_the_supervisor_has_a_sentence() -> None:
    assert set(ACTIONS) == {action.value for action in SupervisorAction} - {"ok"}
