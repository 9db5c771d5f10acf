"""Pursuers that fly by a plan do so in games of simple motion too, and deny what a goalkeeper denies."""

from __future__ import annotations

import msgspec
import pytest

from onboard.core.game.referee import GameResult
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Parameters, Scenario, VehicleSpec
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.plane_game.program import play
from sim_bridge.plane_game.setup import conditions_of, game_of
from tests.benchmarks.team_plane import random_games

WITHIN = 70.0  # [s]
DECIDED = (7, 10, 46)  # random games that a goalkeeper denies, and in which the chase alone lets it arrive


def scenario_of(number: int) -> Scenario:
    """A game of the benchmark as a scenario."""
    drawn = random_games(number + 1)
    game, goal = drawn.games[number], drawn.targets[number]
    return Scenario(
        name=f"random {number}",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, target=(goal.x, goal.y)),
        pursuers=tuple(
            VehicleSpec(position=(p.position.x, p.position.y), speed=p.speed) for p in game.pursuers
        ),
        parameters=Parameters(R=2.0, rho=4.0, horizon=WITHIN, dt=0.2, target_known=True),
    )


@pytest.mark.parametrize("number", DECIDED)
def test_the_team_denies_what_a_goalkeeper_denies_and_the_chase_does_not(number: int) -> None:
    scenario = scenario_of(number)
    ends = {way: play(scenario, way).verdict for way in ("parallel-pursuit", "goalkeeper", "team")}
    assert ends == {
        "parallel-pursuit": GameResult.ARRIVED, "goalkeeper": GameResult.DENIED, "team": GameResult.DENIED,
    }  # fmt: skip


def test_a_decision_reckoned_anew_is_one_of_the_plan() -> None:
    played = play(scenario_of(DECIDED[0]), "team")
    rules = {d.rule for d in played.decisions(0).pursuers}
    assert RuleId.GUARD_TARGET in rules


def test_a_campaign_plays_the_plan_of_a_game() -> None:
    """The games of a campaign (here interpreted) and the one that `planar` plays are the same."""
    scenario = scenario_of(DECIDED[0])
    scenario = msgspec.structs.replace(
        scenario, parameters=msgspec.structs.replace(scenario.parameters, horizon=12.0)
    )
    one = play(scenario, "team")
    conditions, start = conditions_of(scenario), game_of(scenario)
    many = campaign(EVADERS["paper"].decide, PURSUERS["team"].decide, 5, compiled=False)
    ends = many(starts_of([start], [conditions.target.position]), conditions, keep=80)
    for step in (1, 20, len(one.frames) - 2):
        places = ends.trace[0, step]
        assert places[3] == pytest.approx(one.frames[step].pursuers[2].position, abs=1e-12)
    assert GameResult(int(ends.verdicts[0])) is one.verdict
