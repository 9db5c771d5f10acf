"""A plan over the bus and back: the same plan, or none where the message is not one of this team's."""

from __future__ import annotations

from collections import Counter
from math import inf, nan

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.agent.core.team_talk import said, understood
from onboard.core.math.vectors import Vec
from onboard.core.strategy.team.plan_types import NOBODY, Assignment, Band, Plan, Reason, Role
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


@given(st.builds(Plan, st.floats(0.0, 1e4), st.tuples(parts, parts, parts), bands))
def test_what_is_said_is_understood(plan: Plan) -> None:
    drops: Counter[str] = Counter()
    heard = PLAN.decode(PLAN.encode(said(plan, TEAM, 3, 5, 9)), drops)
    assert heard is not None
    assert understood(heard, TEAM) == plan


def test_every_role_and_reason_of_the_core_has_its_word() -> None:
    assert {role.name for role in Role} == {role.name for role in TeamRole}
    assert {reason.name for reason in Reason} == {reason.name for reason in PartReason}


@pytest.mark.parametrize("what", ["another team", "a part too few", "no number"])
def test_what_is_no_plan_of_this_team_is_none(what: str) -> None:
    part = Assignment(Role.CHASER, Vec(1.0, 2.0, 3.0), 0.0, inf, Reason.NONE)
    message: TeamPlan = said(Plan(1.0, (part,) * 3, Band(False, 1.0, 0.0, 0.0, 1, 3.0)), TEAM, 2, 0, 0)
    if what == "another team":
        assert understood(message, (2, 3, 4)) is None
    elif what == "a part too few":
        assert understood(msgspec.structs.replace(message, parts=message.parts[:2]), TEAM) is None
    else:
        assert understood(msgspec.structs.replace(message, gap=nan), TEAM) is None
