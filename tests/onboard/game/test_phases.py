"""The table of phases, walked: every event is caused in every phase, and the master goes where it says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.master import Timing
from onboard.game.phases import TRANSITIONS, PhaseEvent, diagram
from onboard.wire.bus.messages import AgentStage, Phase
from tests.onboard.game.test_master import WALL0, Range, health

PATIENCE_S = 20.0
RECOVERY_S = 3.0


def _range() -> Range:
    """A game whose start is given by `start()`, with short times."""
    timing = Timing(ready_s=2.0, timeout_s=PATIENCE_S, recovery_s=RECOVERY_S, auto_start=False)
    return Range(timing=timing)


def _abort(game: Range) -> None:
    game.master.abort(WALL0 + game.now, game.now, "wind")
    game.fly(0.01)


def _all_ready(game: Range) -> None:
    game.crew()
    game.master.start()
    game.fly(0.6)


def _not_ready(game: Range) -> None:
    game.agents[2] = health(2, AgentStage.WAITING, lacks=("gps",))
    game.fly(0.6)


def _patience_over(game: Range) -> None:
    game.agents.clear()
    game.fly(PATIENCE_S + 4.0)


def _beginning(game: Range) -> None:
    game.fly(2.1)


def _result(game: Range) -> None:
    game.places[2] = Vec(0.0, 0.0, -50.0)
    game.fly(0.05)


def _recovery_due(game: Range) -> None:
    game.fly(RECOVERY_S + 0.1)


CAUSES: dict[PhaseEvent, Callable[[Range], None]] = {
    PhaseEvent.ALL_READY: _all_ready,
    PhaseEvent.NOT_READY: _not_ready,
    PhaseEvent.PATIENCE_OVER: _patience_over,
    PhaseEvent.BEGINNING: _beginning,
    PhaseEvent.RESULT: _result,
    PhaseEvent.ABORT: _abort,
    PhaseEvent.RECOVERY_DUE: _recovery_due,
}
PATHS = {
    Phase.STAGING: (),
    Phase.READY: (_all_ready,),
    Phase.RUNNING: (_all_ready, _beginning),
    Phase.ENDED: (_abort,),
    Phase.RECOVERY: (_abort, _recovery_due),
}


def brought_into(phase: Phase) -> Range:
    game = _range()
    game.crew()
    game.fly(1.5)  # it has listened and holds the lease
    for step in PATHS[phase]:
        step(game)
    assert game.master.phase is phase
    game.said.clear()
    return game


@pytest.mark.parametrize(("phase", "event"), list(TRANSITIONS), ids=lambda value: value.name)
def test_an_event_leads_where_the_table_says_and_is_published(phase: Phase, event: PhaseEvent) -> None:
    game = brought_into(phase)
    CAUSES[event](game)
    assert game.phases()[0].phase is TRANSITIONS[phase, event]


# Causing these takes so long that an event of the phase itself comes first.
_TIME_LEADS_ON = {
    (Phase.READY, PhaseEvent.RESULT),
    (Phase.READY, PhaseEvent.RECOVERY_DUE),
    (Phase.READY, PhaseEvent.PATIENCE_OVER),
    (Phase.RUNNING, PhaseEvent.PATIENCE_OVER),
    (Phase.ENDED, PhaseEvent.PATIENCE_OVER),
}
_MISSING = [
    (phase, event)
    for phase in Phase
    for event in PhaseEvent
    if (phase, event) not in TRANSITIONS and (phase, event) not in _TIME_LEADS_ON
]


@pytest.mark.parametrize(("phase", "event"), _MISSING, ids=lambda value: value.name)
def test_an_event_that_the_table_lacks_changes_nothing(phase: Phase, event: PhaseEvent) -> None:
    game = brought_into(phase)
    CAUSES[event](game)
    assert {change.phase for change in game.phases()} <= {phase}


def test_every_phase_can_be_reached_and_the_last_is_left_by_nothing() -> None:
    assert set(TRANSITIONS.values()) | {Phase.STAGING} == set(Phase)
    assert not [event for phase, event in TRANSITIONS if phase is Phase.RECOVERY]
    assert {event for _, event in TRANSITIONS} == set(PhaseEvent)


def test_the_handbook_draws_this_table() -> None:
    handbook = Path(__file__).parents[3] / "docs" / "conventions.md"
    assert f"```mermaid\n{diagram()}\n```" in handbook.read_text(encoding="utf-8")


def test_time_in_a_phase_is_what_was_said() -> None:
    game = brought_into(Phase.READY)
    game.fly(2.5)
    (running,) = game.phases()
    assert 0 <= running.stamp_ns - running.t0_ns <= NS_PER_S // 50
