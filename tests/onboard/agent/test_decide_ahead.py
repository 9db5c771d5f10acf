"""Deciding ahead: what leaves is what would have been decided; where nothing was foreseen, it is asked."""

from __future__ import annotations

from math import dist
from typing import Any

from onboard.agent.core.ahead import Foreseen
from onboard.agent.core.events import Instant, Think
from onboard.agent.core.to_place import own_state
from onboard.agent.shell import Agent
from onboard.game.scenario import load
from onboard.pilot.pilot import PilotDecision
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.loop import virtual_clock
from onboard.runtime.resources import configs
from sim_bridge.rehearsal import Options, Rehearsal
from tests.support.virtual_time import virtual

PERIOD = 0.05
FOR_S = 6.0  # of the game
SCENARIO = load(configs() / "scenarios" / "flight" / "one-on-one.toml")
TOLD = {"decide_ahead": True, "prediction": Predicting.CONSTANT_VELOCITY}
AHEAD = {id: TOLD for id in SCENARIO.ids}


def afresh(agent: Agent, now: Instant) -> PilotDecision | None:
    """What the agent's strategy decides at `now`, on the state as it is."""
    flight = agent.core.flight
    t, hovers = flight.vehicle.telemetry, flight.vehicle.hovers is not False
    viewpoint: Any = agent.core.game.flying.viewpoint if agent.core.game and agent.core.game.flying else None
    kept = vars(viewpoint).copy()
    question = flight.part.ask(now, own_state(now.s, t, hovers=hovers))
    if isinstance(question, PilotDecision):
        return None
    answer = agent.thinker.answer(Think(0, flight.part.side, flight.part.strategy, question.view))
    assert answer.decision is not None
    decision = flight.part.conclude(question, answer.decision)
    vars(viewpoint).update(kept)
    return decision


@virtual
async def test_what_was_foreseen_is_what_would_have_been_decided() -> None:
    """Every foreseen decision beside one made afresh: the velocities differ by little, and by far most rules
    are the same; hardly a step goes without."""
    clock = virtual_clock()
    pairs: list[tuple[PilotDecision, PilotDecision]] = []
    ages: list[float] = []
    async with Rehearsal(SCENARIO, clock, Options(configure=AHEAD)) as game:
        for agent in game.agents.values():
            take = agent.core.flight.ahead.take

            def beside(now: float, agent: Agent = agent, take: Any = take) -> Foreseen | None:
                found: Foreseen | None = take(now)
                if found is not None:
                    fresh = afresh(agent, Instant(now, clock.wall_ns()))
                    assert fresh is not None
                    pairs.append((found.decision, fresh))
                    ages.append(found.age)
                return found

            agent.core.flight.ahead.take = beside  # type: ignore[method-assign]
        assert await game.until(lambda: game.now > FOR_S, 60.0)
        steps = sum(agent.core.flight.failures == 0 for agent in game.agents.values())
    assert steps == len(game.agents)
    assert len(pairs) >= 0.95 * len(game.agents) * FOR_S / PERIOD
    assert max(ages) <= PERIOD + 1e-9
    apart = sorted(dist(one.velocity, other.velocity) for one, other in pairs)
    speed = max(dist(other.velocity, (0.0, 0.0, 0.0)) for _, other in pairs)
    assert apart[-len(apart) // 20] <= 0.01 * speed  # 95 of a hundred
    assert sum(one.rule == other.rule for one, other in pairs) >= 0.99 * len(pairs)


@virtual
async def test_an_answer_counts_for_the_step_that_it_was_asked_for_alone() -> None:
    """Half a period early or late at the most, once, never older than a period, and in no other game."""
    async with Rehearsal(SCENARIO, virtual_clock(), Options(configure=AHEAD)) as game:
        agent = game.agents[SCENARIO.ids[1]]
        assert await game.until(lambda: game.now > 1.0, 60.0)
        flight = agent.core.flight
        ahead, begun = flight.ahead, Instant(game.clock.monotonic_ns() / 1e9, game.clock.wall_ns())

        def foreseen(asked: float, taken: float, other_game: bool = False) -> bool:
            """Asked and taken so many periods after a step."""
            ahead.stepped(begun)
            t, at = agent.core.vehicle.telemetry, begun.s + asked * PERIOD
            think = ahead.ask(10**6, at, t, hovers=True, due=True)
            assert think is not None
            assert ahead.answered(agent.thinker.answer(think))
            policy = flight.part.policy
            if other_game:
                flight.part.policy = policy._replace(separation=policy.separation + 1.0)
            found = ahead.take(begun.s + taken * PERIOD)
            flight.part.policy = policy
            assert ahead.take(begun.s + taken * PERIOD) is None
            return found is not None

        assert [foreseen(0.3, taken) for taken in (0.4, 0.6, 1.0, 1.25)] == [False, True, True, True]
        assert not foreseen(0.3, 1.35)  # 1.05 periods old
        assert foreseen(0.6, 1.45)
        assert not foreseen(0.6, 1.55)
        assert not foreseen(0.6, 1.0, other_game=True)


@virtual
async def test_what_fails_ahead_is_asked_again_and_told() -> None:
    """A strategy that breaks is found by the step itself: the supervisor acts as without the option."""

    def broken(view: object) -> Any:
        raise RuntimeError("no idea")

    async with Rehearsal(SCENARIO, virtual_clock(), Options(configure=AHEAD)) as game:
        agent = game.agents[SCENARIO.ids[1]]
        assert await game.until(lambda: game.now > 1.0, 60.0)
        for name in agent.thinker.strategies:
            agent.thinker.strategies[name] = broken
        since = game.clock.monotonic_ns()
        assert await game.until(lambda: "supervisor_end" in game.kinds(agent.id), 1.0)
        told_s = (game.clock.monotonic_ns() - since) / 1e9
        assert told_s < 0.2 + 3 * PERIOD + 0.1  # strategy_age_s, and until it is heard
    assert "strategy" in game.kinds(agent.id)
    assert agent.core.flight.failures > 2
