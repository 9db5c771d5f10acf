"""A clip is an exception: what a vehicle can do enters the decision; the rest is counted and told once."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.agent.core.clip_spells import SPELL_S, ClipSpells
from onboard.core.math.vectors import Vec, norm, sub
from onboard.core.safety.policy import Action, Cause
from onboard.core.safety.supervisor import reachable, supervise
from onboard.game.scenario import Kind
from tests.support.flown_autopilot import FLOWN
from tests.support.small_scenarios import EVADER, PURSUER, chase
from tests.support.supervised_vehicle import COPTER, PLANE, SupervisedVehicle
from tests.support.virtual_time import virtual
from tests.support.whole_games import game_of, under_way

SLEWS = (Cause.TURN, Cause.ACCELERATION)
velocity = st.builds(Vec, *[st.floats(-25.0, 25.0)] * 2, st.floats(-3.0, 3.0))


@settings(max_examples=40, deadline=None)
@given(st.lists(velocity, min_size=2, max_size=12), st.sampled_from([COPTER, PLANE]))
def test_what_is_reachable_is_not_clipped_and_sends_what_would_have_been_sent(wanted, policy):
    """Step by step: the same setpoint goes out, and neither turn nor acceleration is a reason to clip."""
    start = Vec(4.0, 0.0, 0.0) if policy is COPTER else Vec(20.0, 0.0, 0.0)
    shaped = SupervisedVehicle(policy, Vec(0.0, 0.0, -60.0), start)
    clipped = 0
    for one in wanted:
        for _ in range(3):
            seen, state = shaped.seen, shaped.state
            asked = reachable(one, seen, policy, state)
            verdict, other = supervise(asked, seen, policy, state), supervise(one, seen, policy, state)
            clipped += verdict.cause in SLEWS
            assert norm(sub(verdict.air, other.air)) < 1e-6
            shaped.step(asked)
    assert clipped == 0


@pytest.mark.game
@pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
@virtual
async def test_in_the_open_no_decision_of_a_game_is_clipped(kind: Kind) -> None:
    async with game_of(chase(kind)) as game:
        await under_way(game, 0.0)
        before = {id: dict(game.agents[id].core.flight.clips.counts) for id in (EVADER, PURSUER)}
        await under_way(game, 5.0)
        for id in (EVADER, PURSUER):  # on its way to its place a plane may be asked for a sharper turn
            kinds = game.kinds(id)
            assert "supervisor_clip" not in kinds[kinds.index("phase", kinds.index("control")) :]
            slews = {f"clipped_{cause.name.lower()}" for cause in SLEWS}
            counts = game.agents[id].core.flight.clips.counts
            assert all(counts.get(slew, 0) == before[id].get(slew, 0) for slew in slews)


def test_a_spell_is_told_at_its_begin_and_at_its_end() -> None:
    clips, told = ClipSpells(), []
    before = Action.PASS
    for step in range(400):
        now = 0.05 * step
        action = Action.CLIP if 20 <= step < 100 and step % 3 == 0 else Action.PASS
        text = clips.look(now, before, action, Cause.FENCE_AHEAD if action is Action.CLIP else Cause.NONE)
        told += [(round(now, 2), text)] if text else []
        before = action
    assert clips.counts == {"clipped_fence_ahead": 27}
    (begin, first), (end, last) = told
    assert begin == 1.05
    assert first.startswith("clip: ")
    assert end == pytest.approx(0.05 * 99 + SPELL_S, abs=0.06)
    assert last.startswith("ok: nothing in the way; 27 steps were clipped in 3.9 s: ")


def test_a_hold_ends_a_spell_and_is_told_and_so_is_its_end() -> None:
    clips = ClipSpells()
    assert clips.look(0.0, Action.PASS, Action.CLIP, Cause.SPEED).startswith("clip: ")
    assert clips.look(0.1, Action.CLIP, Action.HOLD, Cause.ORDER).startswith("hold: ")
    assert clips.look(0.2, Action.HOLD, Action.HOLD, Cause.ORDER) == ""
    assert clips.look(0.3, Action.HOLD, Action.PASS, Cause.NONE) == "ok: nothing in the way"
    assert clips.look(0.4, Action.PASS, Action.CLIP, Cause.SPEED).startswith("clip: ")
