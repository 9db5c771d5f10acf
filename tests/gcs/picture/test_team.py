"""The pursuers' plan as the ground station shows it."""

from __future__ import annotations

import msgspec
import pytest

from gcs.console.detail import detail
from gcs.console.plain_lines import status
from gcs.console.status_line import status_line
from gcs.picture.team import counting
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Phase
from onboard.wire.bus.team_messages import PartReason, PlannedPart, TeamPlan, TeamRole
from tests.support.sample_messages import START_NS, Tower, decision, phase, setup, state


def plan(planner: int, **changes: object) -> TeamPlan:
    parts = (
        PlannedPart(2, TeamRole.GOALKEEPER, (300.0, 0.0, -50.0), 0.0, 12.0, PartReason.FIRST_AT_TARGET),
        PlannedPart(3, TeamRole.CHASER, (0.0, 0.0, -50.0), 0.0, -1.0, PartReason.NO_GAP_IN_REACH),
    )
    base = TeamPlan(planner, START_NS, 1.0, parts, False, 0.6, -0.5, 0.0, closer=3, closes=41.0)
    return msgspec.structs.replace(base, **changes)


def test_the_lowest_fresh_planner_counts_then_the_newest_and_none_for_ever() -> None:
    heard = {2: (plan(2), 0), 3: (plan(3), NS_PER_S // 2)}
    assert counting(heard, NS_PER_S).id == 2  # type: ignore[union-attr]
    assert counting(heard, NS_PER_S + NS_PER_S // 4).id == 3  # type: ignore[union-attr]
    assert counting(heard, 5 * NS_PER_S).id == 3  # type: ignore[union-attr]
    assert counting(heard, 6 * NS_PER_S) is None
    assert counting({}, 0) is None


def told(tower: Tower) -> str:
    """Everything that the console says of vehicle 2, and of the game."""
    picture = tower.picture
    line = "".join(text for text, _ in status_line(picture, "", "", 200))
    return "\n".join([line, *status(picture), *(text for text, _ in detail(picture, 2))])


def test_the_console_says_role_reason_and_who_could_close_the_band() -> None:
    tower = Tower()
    tower.hear(setup(), phase(Phase.RUNNING), state(2), state(3), decision(2), plan(2))
    said = told(tower)
    assert said.count("plan of 2: way out 34° at 331°, 3 could close it by T+41 s") == 2
    assert "goalkeeper in the plan of 2: at the target before the evader" in said
    assert "role goalkeeper" in said
    tower.hear(plan(2, closed=True, gap=-0.1, stamp_ns=START_NS + 1))
    assert "plan of 2: band closed" in told(tower)


@pytest.mark.parametrize("over", [False, True])
def test_an_old_plan_is_not_shown_nor_one_of_a_game_that_is_over(over: bool) -> None:
    tower = Tower()
    tower.hear(setup(), phase(Phase.RUNNING), state(2), state(3), decision(2), plan(2))
    if over:
        tower.hear(phase(Phase.ENDED))
    else:
        tower.wait(6.0)
        tower.hear(state(2), state(3), decision(2))
    assert "plan of" not in told(tower)
