"""A plan on its way in a compiled game: it is late, some of it is lost, and who hears nothing flies alone."""

from __future__ import annotations

import numpy as np

from onboard.core.math.vectors import ZERO
from onboard.core.strategy.team.plan_types import (
    IDLE,
    OPEN,
    Assignment,
    Heights,
    Margin,
    Plan,
    Reason,
    Role,
)
from sim_bridge.campaign.team_play import Planning, Talk, arrived, opened, posted
from sim_bridge.draws import Key

PURSUERS = 6


def planning(loss: float) -> Planning:
    return Planning(10, 3, loss, 100, Heights(), Margin(), 1500.0, (), Key(1, 2))


def made(time: float) -> Plan:
    return Plan(time, (Assignment(Role.CHASER, ZERO, 0.0, time, Reason.ENCLOSED),) * PURSUERS, OPEN)


def talked(how: Planning, steps: int, silent_from: int = 10**9) -> tuple[Talk, list[float]]:
    """Plans every `every` steps until the planner falls silent; how many have no part at each step."""
    talk = opened(Plan(0.0, (IDLE,) * PURSUERS, OPEN))
    without = []
    for step in range(steps):
        if step % how.every == 0:
            if step < silent_from:
                posted(talk, how, made(float(step)), step)
            else:
                talk.lost[:] = 1.0  # nothing sets out
        arrived(talk, how, step)
        without.append(float(np.mean([part.role == Role.RESERVE for part in talk.parts])))
    return talk, without


def test_a_plan_is_heard_after_its_delay_and_not_before() -> None:
    talk, without = talked(planning(0.0), 14)
    assert without[:3] == [1.0, 1.0, 1.0]
    assert without[3:] == [0.0] * 11
    assert all(part.due == 10.0 for part in talk.parts)


def test_with_a_third_lost_everybody_still_has_a_recent_part() -> None:
    talk, without = talked(planning(0.3), 600)
    assert max(without[100:]) == 0.0
    ages = [600.0 - part.due for part in talk.parts]
    assert 0.0 < min(ages) <= max(ages) < 100.0
    heard = []
    for loss in (0.0, 0.3):
        fresh = [talked(planning(loss), 10 * k + 4)[0].heard[0] == 10 * k + 3 for k in range(0, 40, 2)]
        heard.append(sum(fresh))
    assert heard[0] == 20
    assert 9 < heard[1] < 19


def test_who_hears_nothing_for_long_flies_alone() -> None:
    _talk, without = talked(planning(0.0), 400, silent_from=200)
    assert without[190] == 0.0
    assert without[290] == 0.0
    assert without[300] == 1.0
