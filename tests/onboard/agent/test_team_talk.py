"""A plan over the bus and back: the same plan, or none where the message is not one of this team's."""

from __future__ import annotations

from collections import Counter
from math import inf, nan
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.agent.core.team_talk import said, understood
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.plan_types import NO_GOAL, NOBODY, Assignment, Band, Plan, Reason, Role
from onboard.pilot.team_seat import Dated
from onboard.wire.bus.team_messages import PartReason, TeamPlan, TeamRole
from onboard.wire.bus.topics import PLAN

TEAM = (2, 3, 7)
numbers = st.floats(-1e5, 1e5)
parts = st.builds(
    Assignment,
    st.sampled_from(Role),
    st.builds(Vec, numbers, numbers, numbers),
    st.floats(-3.2, 3.2),
    st.floats(0.0, 1e4) | st.just(inf),
    st.sampled_from(Reason),
)
bands = st.builds(
    Band,
    st.booleans(),
    numbers,
    numbers,
    numbers,
    st.sampled_from((NOBODY, 0, 1, 2)),
    st.floats(0.0, 1e4) | st.just(inf),
)


plans = st.builds(Plan, st.floats(0.0, 1e4), st.tuples(parts, parts, parts), bands, st.just(NO_GOAL))
quarries = st.just(()) | st.tuples(*(st.sampled_from((0, 1, 9)) for _ in TEAM))


@given(plans, quarries, st.lists(st.tuples(st.sampled_from((1, 9)), bands), max_size=2).map(tuple))
def test_what_is_said_is_understood(
    plan: Plan, after: tuple[int, ...], ways: tuple[tuple[int, Band], ...]
) -> None:
    drops: Counter[str] = Counter()
    dated = Dated(3, plan, 4.0, after, ways)
    heard = PLAN.decode(PLAN.encode(said(dated, TEAM, 5, 9)), drops)
    assert heard is not None
    assert understood(heard, TEAM, 4.0) == dated
    back = msgspec.structs.replace(heard, parts=heard.parts[::-1], quarries=heard.quarries[::-1])
    assert understood(back, TEAM, 4.0) == dated


def test_every_role_and_reason_of_the_core_has_its_word() -> None:
    assert {role.name for role in Role} == {role.name for role in TeamRole}
    assert {reason.name for reason in Reason} == {reason.name for reason in PartReason}


@pytest.mark.parametrize(
    "what", ["another team", "a part too few", "no number", "a quarry too few", "a band that is no number"]
)
def test_what_is_no_plan_of_this_team_is_none(what: str) -> None:
    part = Assignment(Role.CHASER, Vec(1.0, 2.0, 3.0), 0.0, inf, Reason.NONE)
    band = Band(False, 1.0, 0.0, 0.0, 1, 3.0)
    made = Dated(2, Plan(1.0, (part,) * 3, band), 0.0, (1, 1, 9), ((1, band), (9, band)))
    message: TeamPlan = said(made, TEAM, 0, 0)
    assert understood(message, TEAM, 0.0) == made
    changed: dict[str, Any] = {
        "another team": {},
        "a part too few": {"parts": message.parts[:2]},
        "no number": {"gap": nan},
        "a quarry too few": {"quarries": (1, 9)},
        "a band that is no number": {"bands": (msgspec.structs.replace(message.bands[0], pitch=nan),)},
    }[what]
    team = (2, 3, 4) if what == "another team" else TEAM
    assert understood(msgspec.structs.replace(message, **changed), team, 0.0) is None
