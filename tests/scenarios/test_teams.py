"""A team whose plan survives: its planner is killed, a third of all messages is lost, a pursuer, the bus."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from onboard.core.strategy.knowledge import STRATEGIC
from onboard.core.strategy.team.flying import TEAM
from onboard.game.scenario import Flight, Kind, Parameters, Scenario, VehicleSpec
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.bus import topics
from onboard.wire.bus.knowledge_messages import Knowledge, TeamGoal
from onboard.wire.bus.messages import DecisionLevel, DecisionReport
from onboard.wire.bus.team_messages import PartReason, TeamPlan, TeamRole
from tests.support.small_scenarios import lossy
from tests.support.virtual_time import virtual
from tests.support.whole_games import WholeGame, choose_mode, flies, game_of, under_way

TARGET_REACHED = "somebody is at the target before the evader, or nearly"
KEEPER, MATE, LAST = 2, 3, 4
CHASE = {rule.id.name.lower() for rule in TEAM if rule.id not in STRATEGIC}  # of who has no other part


FAILS = """
from onboard.core.strategy.semantic.goals import GoalRule
from onboard.core.strategy.team.plan_types import Choice, Goal

def mine(scene, edges):
    if scene.situation.now > 3.0:
        raise ZeroDivisionError("nobody thought of this")
    return Choice(Goal.CHASE, 101, -1, 1.0)

GOALS = (GoalRule(101, "mine", "always", "chase", mine),)
"""


def guarded(strategy: str = "team", **flight: Any) -> Scenario:
    """A faster evader far from its target, which is known; two pursuers can be there before it."""
    places = ((330.0, 60.0), (300.0, -70.0), (-60.0, 0.0))
    return Scenario(
        name="guarded",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, target=(400.0, 0.0)),
        pursuers=tuple(VehicleSpec(position=at, speed=4.0, strategy=strategy) for at in places),
        # It arrives farther off than it is captured: standing on the target denies nothing, two guard it.
        parameters=Parameters(R=2.0, rho=6.0, epsilon_min=3.0, horizon=100.0, target_known=True),
        flight=Flight(
            autopilot=Kind.ARDUCOPTER,
            height=120.0,
            ready_s=2.0,
            prediction=Predicting.CONSTANT_VELOCITY,
            **flight,
        ),
    )


class Heard:
    """Plans and decisions on the bus, with the game's time at which each came."""

    def __init__(self, game: WholeGame) -> None:
        self.plans: list[tuple[float, TeamPlan]] = []
        self.decisions: list[tuple[float, DecisionReport]] = []
        self.known: list[Knowledge] = []
        drops: Counter[str] = Counter()

        def take(sample: tuple[str, bytes]) -> None:
            heard = topics.TOPICS.heard(*sample, drops)
            if heard is not None and heard.topic is topics.PLAN:
                self.plans.append((game.now, heard.message))  # type: ignore[arg-type]
            elif heard is not None and heard.topic is topics.KNOWLEDGE:
                self.known.append(heard.message)  # type: ignore[arg-type]
            elif heard is not None and heard.topic is topics.DECISION:
                self.decisions.append((game.now, heard.message))  # type: ignore[arg-type]

        game.bus.subscribe(topics.everything(game.game), take)

    def planners(self, since: float, until: float = 1e9) -> list[int]:
        return [plan.id for t, plan in self.plans if since <= t < until]

    def role(self, id: int) -> tuple[TeamRole, PartReason]:
        part = next(part for part in self.plans[-1][1].parts if part.id == id)
        return part.role, part.reason

    def of(self, id: int, since: float, until: float = 1e9) -> list[DecisionReport]:
        return [d for t, d in self.decisions if d.id == id and since <= t < until]


@virtual
async def test_two_guard_the_target_one_chases_and_everybody_says_why() -> None:
    async with game_of(guarded()) as game:
        heard = Heard(game)
        await under_way(game, 6.0)
        assert set(heard.planners(0.0)) == {KEEPER}
        assert 9 <= len(heard.planners(1.0, 6.0)) <= 11  # twice a second
        roles = [heard.role(id)[0] for id in (KEEPER, MATE, LAST)]
        assert sorted(role.value for role in roles) == ["blocker", "chaser", "goalkeeper"]
        assert roles[2] is TeamRole.CHASER
        for id in (KEEPER, MATE):
            said = heard.of(id, 2.0)[-1]
            assert said.level is DecisionLevel.STRATEGIC
            assert said.rule in {"guard_target", "block_corridor"}
            assert f"in the plan of {KEEPER}: " in said.reason
            assert said.reason.endswith("; goal: deny target 1, as " + TARGET_REACHED)
        chaser = heard.of(LAST, 2.0)[-1]
        assert chaser.level is DecisionLevel.TACTICAL
        assert chaser.rule in CHASE
        assert chaser.reason.startswith(f"chaser in the plan of {KEEPER}")
        known = heard.known[-1]
        assert 5 <= len(heard.known) <= 7  # once a second
        assert (known.id, known.quarry, known.goal.goal) == (KEEPER, 1, TeamGoal.DENY)
        held = {edge.relation: known.nodes[edge.source].name for edge in known.edges}
        assert held["covers"] in {f"pursuer {KEEPER}", f"pursuer {MATE}"}
        assert held["threatens"] == "evader 1"
        assert [event.text for event in game.events if event.kind == "goal"] == [
            f"deny target 1, as {TARGET_REACHED}"
        ]


@virtual
async def test_a_rule_of_a_users_that_fails_in_flight_leaves_the_team_its_own(tmp_path: Path) -> None:
    file = tmp_path / "rules.py"
    file.write_text(FAILS, encoding="utf-8")
    async with game_of(guarded(strategy=f"team:{file}")) as game:
        heard = Heard(game)
        game.expects(KEEPER, "knowledge")
        await under_way(game, 5.0)
        rules = [goal.rule for _, plan in heard.plans for goal in plan.goals]
        assert (rules[0], rules[-1]) == ("mine", "target_reached")
        told = [event for event in game.events if event.kind == "knowledge"]
        assert [event.id for event in told] == [KEEPER]
        assert told[0].text == "nobody thought of this: on by the team's own model"
        assert set(heard.planners(game.now - 1.0)) == {KEEPER}


@virtual
async def test_the_planner_is_killed_and_the_next_one_goes_on_from_its_plan() -> None:
    async with game_of(guarded()) as game:
        heard = Heard(game)
        await under_way(game, 4.0)
        role = heard.role(MATE)[0]
        game.expects(KEEPER, "supervisor_end")
        game.kill_agent(KEEPER)
        killed = game.now
        await game.forward(5.0)
        after = heard.planners(killed + 0.1)
        assert set(after) == {MATE}
        first = next(t for t, plan in heard.plans if plan.id == MATE)
        assert first - killed < 2.0  # the lease and one interval
        assert heard.role(KEEPER) == (TeamRole.RESERVE, PartReason.LOST)
        assert {part.role for _, plan in heard.plans[-2:] for part in plan.parts if part.id == MATE} <= {
            role, TeamRole.GOALKEEPER,
        }  # fmt: skip
        assert all(flies(game.agents[id]) for id in (MATE, LAST))
        assert not [d for d in heard.of(MATE, killed) if not d.reason], "never a moment without a plan"


@virtual
async def test_a_pursuer_is_taken_by_its_pilot_and_its_post_goes_to_another() -> None:
    async with game_of(guarded()) as game:
        heard = Heard(game)
        await under_way(game, 4.0)
        keeper = next(id for id in (KEEPER, MATE) if heard.role(id)[0] is TeamRole.GOALKEEPER)
        other = KEEPER + MATE - keeper
        game.expects(keeper, "supervisor_end")
        choose_mode(game, keeper, "ALT_HOLD")
        await game.forward(4.0)
        assert heard.role(keeper) == (TeamRole.RESERVE, PartReason.LOST)
        assert heard.role(other)[0] is TeamRole.GOALKEEPER
        assert heard.of(other, 0.0)[-1].rule == "guard_target"
        assert heard.planners(game.now - 1.0) == [min(other, LAST)] * 2


@pytest.mark.game
@virtual
async def test_a_third_of_all_messages_lost_leaves_nobody_without_a_plan() -> None:
    async with game_of(guarded(impairment=lossy(0.3))) as game:
        heard = Heard(game)
        await under_way(game, 3.0)
        await game.forward(12.0)
        for id in (KEEPER, MATE, LAST):
            told = [event.text for event in game.events if event.id == id and event.kind == "planner"]
            assert "no plan: chases alone" not in told
            said = heard.of(id, 4.0)
            with_plan = [d for d in said if " in the plan of " in d.reason or d.supervisor.value != "ok"]
            assert len(with_plan) >= 0.99 * len(said)
        counted = Counter(heard.planners(4.0))
        assert counted[KEEPER] >= 0.6 * counted.total()


@virtual
async def test_without_the_bus_each_flies_on_the_last_plan_and_then_alone() -> None:
    async with game_of(guarded()) as game:
        heard = Heard(game)
        await under_way(game, 4.0)
        guards = [id for id in (KEEPER, MATE) if heard.role(id)[0] is not TeamRole.CHASER]
        follower = guards[-1]
        core, bus = game.agents[follower].core, game.agents[follower].bus
        bus.cut()  # type: ignore[attr-defined]
        await game.forward(3.0)
        assert core.flight.decision is not None
        assert core.flight.decision.level == "strategic"
        assert core.flight.decision.rule in {"guard_target", "block_corridor"}
        await game.forward(4.0)
        assert core.flight.decision.level == "tactical"
        assert core.flight.decision.rule in CHASE
        assert heard.planners(game.now - 1.0), "the others have a plan, without it"
        assert heard.role(follower) == (TeamRole.RESERVE, PartReason.LOST)
        bus.mend()  # type: ignore[attr-defined]
        await game.forward(3.0)
        assert f": {heard.role(follower)[1].value}; goal: " in core.flight.decision.why
        told = [event.text for event in game.events if event.id == follower and event.kind == "planner"]
        assert told == ["2 plans for the team", "no plan: chases alone", "2 plans for the team"]
