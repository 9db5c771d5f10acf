"""The requests that real autopilots were recorded with, put to our personalities: the same answers."""

from __future__ import annotations

from typing import Any

import pytest

from onboard.game.scenario import Kind
from tests.support.paths import ROOT
from tests.support.personality_comparison import (
    FILES,
    NOT_OURS,
    NOT_THEIRS,
    acknowledgements,
    compared,
    figures,
    filled,
    modes,
    only,
    results,
)

KINDS = pytest.mark.parametrize("kind", list(FILES), ids=lambda kind: kind.value)
PAGE = ROOT / "docs" / "personalities.md"
ASKED_RATES = {
    "LOCAL_POSITION_NED": 20,
    "ATTITUDE": 20,
    "GLOBAL_POSITION_INT": 10,
    "VFR_HUD": 10,
    "SYS_STATUS": 2,
    "WIND": 2,
}


@KINDS
def test_every_command_has_the_same_result_accepted_and_denied_alike(kind: Kind) -> None:
    c = compared(kind)
    assert results(c.ours) == results(c.real)
    assert len(results(c.ours)) == {Kind.ARDUCOPTER: 22, Kind.ARDUPLANE: 20}[kind]
    told = {result for _, result in results(c.ours)}
    assert told == ({0, 4} if kind == Kind.ARDUCOPTER else {0, 2})
    assert sum(len(real) for _, real, _ in acknowledgements(c)) == len(results(c.real))


@KINDS
def test_modes_and_arming_follow_one_another_alike(kind: Kind) -> None:
    c = compared(kind)
    assert modes(c.ours) == modes(c.real)
    assert len(modes(c.ours)) >= 5


def kinds_told(answers: list[tuple[float, Any]]) -> set[str]:
    return {m.get_type() for _, m in answers}


@KINDS
def test_questions_are_answered_with_the_same_kinds_of_messages(kind: Kind) -> None:
    c = compared(kind)
    for stream in (c.real, c.ours):
        before_streams = [entry for entry in stream.heard if entry[0] < 1.2]
        assert kinds_told(before_streams) >= {"COMMAND_ACK", "AUTOPILOT_VERSION", "PARAM_VALUE", "STATUSTEXT"}
        assert "HOME_POSITION" not in kinds_told(before_streams)  # accepted, but there is none yet
        assert stream.by_name["HOME_POSITION"]
        assert stream.by_name["GPS_GLOBAL_ORIGIN"]
        [version] = [m for _, m in stream.by_name["AUTOPILOT_VERSION"]]
        assert version.flight_sw_version >> 8 == 0x040506
        values = [m for _, m in stream.by_name["PARAM_VALUE"]]
        # The listing is numbered; values told beside it, of their own accord, are not.
        numbered = [m for m in values if m.param_index != 65535]
        assert [m.param_index for m in numbered] == list(range(numbered[0].param_count))


@KINDS
def test_our_parameters_have_the_names_and_types_of_the_real_ones(kind: Kind) -> None:
    c = compared(kind)
    real, ours = ({m.param_id: m.param_type for _, m in s.by_name["PARAM_VALUE"]} for s in (c.real, c.ours))
    assert len(ours) > 40
    assert {name: real.get(name) for name in ours} == ours


@KINDS
@pytest.mark.parametrize("name", ASKED_RATES)
def test_streams_run_at_the_asked_rates_on_both_sides(kind: Kind, name: str) -> None:
    c = compared(kind)
    assert c.real.rate(name, 50.0, 95.0) == pytest.approx(ASKED_RATES[name], rel=0.03)
    assert c.ours.rate(name, 50.0, 95.0) == pytest.approx(ASKED_RATES[name], rel=0.03)


@KINDS
def test_arming_is_refused_for_the_same_reason(kind: Kind) -> None:
    c = compared(kind)
    real, ours = (
        [m.text for _, m in s.by_name["STATUSTEXT"] if m.text.startswith("Arm: ")] for s in (c.real, c.ours)
    )
    assert ours == real
    assert len(ours) == (9 if kind == Kind.ARDUCOPTER else 0)


@KINDS
def test_they_fly_alike(kind: Kind) -> None:
    for figure in figures(compared(kind)):
        assert abs(figure.ours - figure.real) <= figure.within, figure


@KINDS
def test_every_difference_in_messages_has_a_reason(kind: Kind) -> None:
    theirs, own = only(compared(kind))
    assert set(theirs) <= set(NOT_OURS)
    assert set(own) <= set(NOT_THEIRS)


def test_the_page_tells_what_was_compared() -> None:
    page = PAGE.read_text()
    assert filled(page) == page, "run: python -m tests.support.personality_comparison docs/personalities.md"
