"""What a browser shows of the team's plan, of the odds and of the evader's fan."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from gcs.page import documents
from gcs.picture.values import AssessmentView
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import EvaderBrief, Phase
from onboard.wire.bus.team_messages import PartReason, PlannedPart, TeamPlan, TeamRole
from tests.support.page_stage import chromium, opened, seen, stage
from tests.support.sample_messages import START_NS, Tower, phase, setup, state, track


def plan(stamp_ns: int) -> TeamPlan:
    parts = (
        PlannedPart(2, TeamRole.GOALKEEPER, (300.0, 0.0, -50.0), 0.0, 12.0, PartReason.FIRST_AT_TARGET),
        PlannedPart(3, TeamRole.CHASER, (0.0, 0.0, -50.0), 0.0, -1.0, PartReason.NO_GAP_IN_REACH),
    )
    return TeamPlan(2, stamp_ns, 1.0, parts, False, 0.6, -0.5, 0.0, closer=3, closes=41.0)


@pytest.mark.real
async def test_roles_stand_beside_the_ids_and_the_fan_before_the_evader():
    async with stage(3) as made, chromium() as browser:
        made.tell(setup(3))
        page = await opened(browser, made)
        made.tell(phase(Phase.RUNNING))
        now_ns = made.station.picture().now_ns
        for i in range(5):
            made.tell(track(1, now_ns + i * NS_PER_S // 10))
        made.tell(plan(now_ns))
        await seen(page, "page.scene.parts.get(2) === 'goalkeeper' && page.scene.parts.get(3) === 'chaser'")
        said = await page.locator("#plan").inner_text()
        assert said == "plan of 2: way out 34° at 331°, 3 could close it by T+41 s"
        await seen(page, "page.scene.ground.expected.length === 3")
        places = await page.evaluate("page.scene.ground.expected.map(({after, at}) => [after, ...at])")
        for after, east, up, south in places:  # 10 m/s north, from 100 m east
            assert (east, up, south) == pytest.approx((100.0, 50.0, -10.0 * after), abs=2.0)
        await page.keyboard.press("o")  # shapes off
        await seen(page, "page.scene.ground.fans.children.length === 0")


def test_the_odds_are_the_consoles_words():
    tower = Tower()
    tower.hear(setup(), phase(Phase.RUNNING), state(1), state(2), state(3))
    found = AssessmentView(
        evader=1, encircled=False, gaps=((0.1, 0.6),), largest_gap=0.6, target_denied=True, prospects=(),
        captured=(0.85, 0.8, 0.89),
    )  # fmt: skip
    told = documents.board(replace(tower.picture, assessments=(found,)), "")
    assert told["situation"]["words"] == "widest way out 34°, chance of capture 85 % (80–89), target denied"
    assert told["game"]["plan"] is None


def test_go_or_no_go_stands_first_with_the_odds_or_with_bound_and_band():
    flat = Tower()
    flat.hear(
        setup(4, planar=True, R=2.0, rho=4.0), phase(Phase.RUNNING),
        EvaderBrief((0.0, 900.0, -50.0), START_NS), state(1, position=(0.0, 0.0, -50.0)),
    )  # fmt: skip
    for id, place in ((2, (80.0, 0.0, -50.0)), (3, (-50.0, 70.0, -50.0)), (4, (-40.0, -80.0, -50.0))):
        flat.hear(state(id, position=place))
    found, (judged,) = documents.board(flat.picture, "")["situation"], flat.picture.assessments
    assert judged.word in {"go", "no-go", "open", "unknown"}
    assert found["words"].startswith(f"{judged.word}: ")
    assert "bound: " in judged.why
    told = documents.detail(flat.picture, 1)["lines"]
    assert [f"{judged.word}: {judged.why}", "bold"] in told
    space = Tower()
    space.hear(setup(3, pursuer_speed=8.0), phase(Phase.RUNNING), state(1), state(2), state(3))
    words = documents.board(space.picture, "")["situation"]["words"]
    word, _, why = words.partition(": ")
    assert word == "no-go"
    assert why.startswith("bound: ")
    assert "; the band is open, the widest way out is " in why
