"""Games of several evaders: each has its own brief and its own end, and the pursuers go on to who is left."""

from __future__ import annotations

from collections import Counter
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from gcs.replay.decide import decide
from onboard.core.math.vectors import Vec, distance
from onboard.game.scenario import Flight, Parameters, Scenario, SensorSpec, VehicleSpec, load
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.resources import configs
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    AgentStage,
    DecisionReport,
    OutcomeResult,
    OwnBrief,
    Phase,
)
from onboard.wire.bus.team_messages import TeamPlan
from onboard.wire.bus.topics import EVADER_BRIEF, OWN_BRIEF
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    HeardOfGame,
    WholeGame,
    flies,
    game_of,
    mode,
    place,
    under_way,
)

pytestmark = pytest.mark.game

NEAR, FAR = 1, 5  # the evaders: one is captured within seconds, the other is far away
AHEAD, BESIDE, LATER = 2, 3, 4  # the pursuers


def raid(strategy: str = "", *, horizon: float = 40.0, **flight: Any) -> Scenario:
    """Two evaders and three pursuers, one of them ahead, one beside, one later."""
    places = {AHEAD: (0.0, 50.0), BESIDE: (25.0, -15.0), LATER: (0.0, 320.0)}
    return Scenario(
        name="raid",
        evader=VehicleSpec(position=(0.0, 0.0), speed=4.0, target=(0.0, 300.0), strategy="straight"),
        evaders=(
            VehicleSpec(
                position=(0.0, 200.0), speed=4.0, targets=((0.0, 340.0), (-300.0, 200.0)), strategy="straight"
            ),
        ),
        pursuers=tuple(VehicleSpec(position=at, speed=5.0, strategy=strategy) for at in places.values()),
        parameters=Parameters(R=3.0, rho=6.0, horizon=horizon, separation=4.0, target_known=True),
        flight=Flight(
            height=80.0, ready_s=1.0, prediction=Predicting.CONSTANT_VELOCITY,
            sensor=SensorSpec(sigma=0.1, sigma_velocity=0.05, delay_s=0.05), **flight,
        ),
    )  # fmt: skip


class Said:
    """Decisions and plans on the bus, by the game's time."""

    def __init__(self, game: WholeGame) -> None:
        self.decisions: list[tuple[float, DecisionReport]] = []
        self.plans: list[tuple[float, TeamPlan]] = []
        drops: Counter[str] = Counter()

        def take(sample: tuple[str, bytes]) -> None:
            heard = topics.TOPICS.heard(*sample, drops)
            if heard is not None and heard.topic is topics.DECISION:
                self.decisions.append((game.now, heard.message))  # type: ignore[arg-type]
            elif heard is not None and heard.topic is topics.PLAN:
                self.plans.append((game.now, heard.message))  # type: ignore[arg-type]

        game.bus.subscribe(topics.everything(game.game), take)

    def quarry(self, id: int) -> int:
        """Whom a vehicle said last that it is after."""
        return [said.quarry for _, said in self.decisions if said.id == id][-1]


@virtual
async def test_who_is_captured_leaves_safely_and_its_pursuers_go_on_to_who_is_left(tmp_path: Path) -> None:
    async with game_of(raid(), folder=tmp_path) as game:
        said = Said(game)
        await under_way(game, 1.0)
        assert [said.quarry(id) for id in (AHEAD, BESIDE, LATER)] == [NEAR, NEAR, FAR]
        assert said.quarry(NEAR) == said.quarry(FAR) == 0
        await game.forward(10.0, until=lambda: mode(game, NEAR) == "LOITER")
        assert game.phase is Phase.RUNNING
        await game.forward(1.5)
        assert game.health[NEAR].stage is AgentStage.ENDED
        assert not flies(game.agents[NEAR])
        assert all(flies(game.agents[id]) for id in (AHEAD, BESIDE, LATER, FAR))
        assert [said.quarry(id) for id in (AHEAD, BESIDE, LATER)] == [FAR, FAR, FAR]
        reasons = {d.reason for _, d in said.decisions if d.id == BESIDE and d.quarry == FAR}
        assert f"after evader {FAR} by its own reckoning" in reasons
        rested = place(game, NEAR)
        nearest = 1e9
        while game.outcome is None:  # who is out is no obstacle forgotten
            await game.forward(0.1)
            nearest = min(nearest, *(distance(place(game, id), rested) for id in (AHEAD, BESIDE)))
        assert nearest > 2.0
        assert distance(place(game, NEAR), rested) < 3.0  # the autopilot holds it
        outcome = game.outcome
        assert outcome.verdict is OutcomeResult.CAPTURED
        assert [(end.id, end.verdict, end.captor) for end in outcome.evaders] == [
            (NEAR, OutcomeResult.CAPTURED, AHEAD),
            (FAR, OutcomeResult.CAPTURED, LATER),
        ]
        await game.land_agents()
        summary = game.summary()
        assert [(end.id, end.verdict) for end in summary.evaders] == [(1, "captured"), (5, "captured")]
        assert {vehicle.stage for vehicle in summary.vehicles} == {"ended"}
    again = decide(tmp_path)
    assert again.compared == again.same > 500
    assert [fed.otherwise for fed in again.fed] == [0] * 5


@virtual
async def test_a_team_divides_by_its_planner_and_a_lost_pursuer_is_replaced() -> None:
    async with game_of(raid("team")) as game:
        said = Said(game)
        await under_way(game, 1.5)
        _, plan = said.plans[-1]
        assert plan.id == AHEAD
        assert dict(zip((part.id for part in plan.parts), plan.quarries, strict=True)) == {
            AHEAD: NEAR, BESIDE: NEAR, LATER: FAR,
        }  # fmt: skip
        assert [band.quarry for band in plan.bands] == [NEAR, FAR]
        assert said.quarry(LATER) == FAR
        reason = [d.reason for _, d in said.decisions if d.id == LATER][-1]
        assert reason.endswith(f"after evader {FAR} in the plan of {AHEAD}")
        game.expects(LATER, "supervisor_end")
        game.kill_agent(LATER)
        await game.forward(2.5)
        _, plan = said.plans[-1]
        given = dict(zip((part.id for part in plan.parts), plan.quarries, strict=True))
        assert given[LATER] == 0
        assert {given[AHEAD], given[BESIDE]} == {NEAR, FAR}
        assert {said.quarry(AHEAD), said.quarry(BESIDE)} == {NEAR, FAR}


@virtual
async def test_no_evader_and_no_pursuer_is_handed_another_ones_brief() -> None:
    """Not what is asked for counts, but what each connection delivers."""
    async with game_of(raid(horizon=3.0), agents=False) as game:
        heard = HeardOfGame(game)
        delivered: dict[int, set[str]] = {id: set() for id in game.scenario.ids}
        for id in game.scenario.ids:
            bus = game.start_agent(id).bus
            bus.tap = lambda sample, keys=delivered[id]: keys.add(sample.key)
        await game.until_ended()
        own = {id: OWN_BRIEF.key(game.game, id) for id in (NEAR, FAR)}
        for id, keys in delivered.items():
            assert keys & set(own.values()) == ({own[id]} if id in own else set())
            assert EVADER_BRIEF.key(game.game) not in keys
        briefs = {
            message.id: message.targets
            for sample in heard.samples
            if sample.key in own.values()
            and isinstance(message := OWN_BRIEF.decode(sample.payload, Counter()), OwnBrief)
        }
        assert briefs == {NEAR: ((0.0, 300.0, -80.0),), FAR: ((0.0, 340.0, -80.0), (-300.0, 200.0, -80.0))}


@virtual
async def test_a_pursuer_and_an_evader_that_is_out_are_started_again() -> None:
    async with game_of(raid()) as game:
        said = Said(game)
        await under_way(game, 1.0)
        await game.forward(20.0, until=lambda: mode(game, NEAR) == "LOITER")
        await game.forward(1.0)
        for id in (NEAR, BESIDE):
            game.kill_agent(id)
        await game.forward(0.5)
        since = len(said.decisions)
        for id in (NEAR, BESIDE):
            game.start_agent(id)
        await game.forward(8.0, until=lambda: flies(game.agents[BESIDE]))
        await game.forward(1.0)
        assert {d.quarry for _, d in said.decisions[since:] if d.id == BESIDE} == {FAR}
        assert game.health[NEAR].stage is AgentStage.ENDED
        assert mode(game, NEAR) == "LOITER"
        assert "control" not in [event.kind for event in game.events if event.id == NEAR][-8:]


@virtual
async def test_an_evader_goes_for_the_target_that_is_not_held_and_has_arrived_there() -> None:
    """A pursuer stands before the nearer target; the other one is free."""
    scenario = Scenario(
        name="two doors",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, targets=((30.0, 0.0), (-24.0, 24.0))),
        pursuers=(VehicleSpec(position=(24.0, 0.0), speed=3.0),),
        parameters=Parameters(R=2.0, rho=4.0, epsilon_min=3.0, horizon=30.0),
        flight=Flight(height=80.0, ready_s=1.0, prediction=Predicting.CONSTANT_VELOCITY),
    )
    async with game_of(scenario) as game:
        outcome = await game.until_ended()
        assert outcome.verdict is OutcomeResult.ARRIVED
        game.assert_near(1, Vec(-24.0, 24.0, -80.0), 8.0)


@pytest.mark.long
def test_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    @virtual
    async def fly(folder: Path) -> None:
        async with game_of(raid("team", horizon=12.0), folder=folder, seed=7) as game:
            await game.until_ended()
            await game.land_agents()

    found = []
    for run in ("one", "two"):
        folder = tmp_path / run
        folder.mkdir()
        fly(folder)
        found.append({file.name: file.read_bytes() for file in folder.iterdir()})
    assert len(found[0]) >= 12
    assert found[0] == found[1]


@pytest.mark.long
@virtual
async def test_three_evaders_and_ten_pursuers_divide_and_keep_apart() -> None:
    """The shipped game, given up after 20 s: every evader has its pursuers, nobody comes too near a mate."""
    scenario = load(configs() / "scenarios" / "flight" / "three-on-ten.toml", several=True)
    async with game_of(scenario) as game:
        said = Said(game)
        await under_way(game, 2.0)
        apart = 1e9
        while game.now < 20.0:
            await game.forward(0.2)
            places = [place(game, id) for id in scenario.pursuer_ids]
            apart = min([apart, *(distance(a, b) for a, b in combinations(places, 2))])
        after = Counter(said.quarry(id) for id in scenario.pursuer_ids)
        assert set(after) == set(scenario.evader_ids)
        assert min(after.values()) >= 2
        assert apart > 0.5 * scenario.parameters.separation
        game.expects_abort()
        assert game.bridge.master is not None
        game.bridge.master.abort("enough was seen")
        await game.forward(2.0)
        assert game.outcome is not None
        assert [end.id for end in game.outcome.evaders] == [1, 12, 13]
        assert {game.health[id].stage for id in scenario.ids} == {AgentStage.ENDED}
        assert {mode(game, id) for id in scenario.ids} == {"LOITER"}
