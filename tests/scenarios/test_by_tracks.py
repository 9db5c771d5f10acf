"""Opponents that are known by their tracks alone, and games that lack them."""

from __future__ import annotations

import msgspec
import pytest

from onboard.game.scenario import Kind, Scenario
from onboard.wire.bus.messages import OutcomeResult, Phase
from tests.support.small_scenarios import EVADER, PURSUER, duel
from tests.support.virtual_time import virtual
from tests.support.whole_games import game_of


def by_track(scenario: Scenario) -> Scenario:
    return msgspec.structs.replace(scenario, evader=msgspec.structs.replace(scenario.evader, tracked=True))


def patient(scenario: Scenario) -> Scenario:
    """With a count-down longer than a track is good."""
    return msgspec.structs.replace(scenario, flight=msgspec.structs.replace(scenario.flight, ready_s=6.0))


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.PX4])
@pytest.mark.game
@virtual
async def test_an_evader_without_an_agent_is_staged_chased_and_captured(kind: Kind) -> None:
    async with game_of(by_track(duel(kind, gap=90.0))) as game:
        assert set(game.agents) == {PURSUER}
        outcome = await game.until_ended()
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, PURSUER)
        assert game.health.keys() == {PURSUER}


@virtual
async def test_a_game_without_tracks_does_not_start_and_says_whose_track_is_missing() -> None:
    async with game_of(patient(duel(timeout_s=15.0))) as game:
        game.bridge.sensor.blind = True
        await game.forward(8.0)
        assert game.phase is Phase.STAGING
        assert game.health[PURSUER].lacks == (f"evader {EVADER}: no track heard",)
        assert game.health[EVADER].lacks == (f"pursuer {PURSUER}: no track heard",)
        game.bridge.sensor.blind = False
        await game.forward(4.0, until=lambda: game.phase is Phase.READY)
        game.bridge.sensor.blind = True  # lost again in the count-down, for longer than a track is good
        await game.forward(10.0, until=lambda: game.phase is Phase.STAGING)
        (lacks,) = game.health[PURSUER].lacks
        assert lacks.startswith(f"evader {EVADER}: its track is ")


@virtual
async def test_a_tracked_evader_that_is_not_seen_ends_the_staging_with_the_reason() -> None:
    async with game_of(by_track(duel(timeout_s=5.0))) as game:
        game.expects_abort()
        game.bridge.sensor.blind = True
        outcome = await game.until_ended()
        assert outcome.verdict == OutcomeResult.ABORTED
        assert outcome.reason.startswith("not ready in time: vehicle 1: no track heard")
