"""An agent in a game: what a person at the field would see."""

from __future__ import annotations

import pytest

from onboard.agent.core.events import Think
from onboard.autopilot.base import Stage
from onboard.game.scenario import Kind
from onboard.runtime.impairment import CLEAR, CUT
from onboard.wire.bus.messages import AgentStage, Phase
from tests.support.flown_autopilot import FLOWN
from tests.support.small_scenarios import EVADER, MATE, PURSUER, chase, fenced, lossy
from tests.support.virtual_time import virtual
from tests.support.whole_games import autopilot, choose_mode, flies, game_of, mode, place, speed, under_way

KINDS = pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
GUIDED = {Kind.PX4: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED"}
HOLD = {Kind.PX4: "HOLD", Kind.ARDUCOPTER: "LOITER", Kind.ARDUPLANE: "LOITER"}


@KINDS
@virtual
async def test_from_staging_to_the_end_each_kind_of_vehicle_plays_its_part(kind: Kind) -> None:
    async with game_of(chase(kind)) as game:
        game.expects_abort()
        await under_way(game, 6.0)
        assert all(flies(agent) for agent in game.agents.values())
        assert mode(game, PURSUER) == GUIDED[kind]
        fast = 50.0 if kind is Kind.ARDUPLANE else 5.0
        assert speed(game, EVADER) == pytest.approx(fast, rel=0.05)
        game.bridge.master.abort("the day is over")  # type: ignore[union-attr]
        await game.forward(3.0, until=lambda: mode(game, PURSUER) == HOLD[kind])
        await game.forward(1.0)
        assert game.health[PURSUER].stage == AgentStage.ENDED
        for expected in ("started", "autopilot", "setup", "control", "phase", "released"):
            assert expected in game.kinds(PURSUER)


@virtual
async def test_at_30_percent_loss_both_ways_the_chase_goes_on() -> None:
    async with game_of(chase(impairment=lossy(0.3))) as game:
        await under_way(game, 20.0)
        assert all(flies(agent) for agent in game.agents.values())
        assert speed(game, EVADER) > 4.0
        assert game.health[PURSUER].link_quality < 0.85


@KINDS
@virtual
async def test_a_link_cut_for_three_seconds_and_back(kind: Kind) -> None:
    async with game_of(chase(kind)) as game:
        game.expects(PURSUER, "supervisor_end")
        await under_way(game)
        game.impair(PURSUER, CUT)
        await game.forward(3.0)
        assert not flies(game.agents[PURSUER])
        assert "supervisor_hold" in game.kinds(PURSUER)
        game.impair(PURSUER, CLEAR)
        await game.forward(6.0, until=lambda: flies(game.agents[PURSUER]))
        await game.forward(3.0, until=lambda: mode(game, PURSUER) == GUIDED[kind])
        assert flies(game.agents[EVADER])


@virtual
async def test_an_autopilot_that_starts_again_in_flight_is_noticed_and_flown_again() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "reboot", "supervisor_end")
        await under_way(game)
        autopilot(game, PURSUER).reboot(game.bridge.world.elapsed_ns)
        await game.forward(10.0, until=lambda: "reboot" in game.kinds(PURSUER))
        await game.forward(40.0, until=lambda: flies(game.agents[PURSUER]))


@virtual
async def test_a_killed_agent_started_again_waits_for_the_masters_resume() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "supervisor_end")
        await under_way(game)
        game.kill_agent(PURSUER)
        await game.forward(2.0)
        agent = game.start_agent(PURSUER)
        await game.forward(8.0, until=lambda: flies(agent))
        story = [kind for kind in game.kinds(PURSUER) if kind in ("started", "resumed", "supervisor_clip")]
        again = story[story.index("started", 1) :]
        assert again[:2] == ["started", "resumed"]


@virtual
async def test_without_the_masters_resume_an_agent_that_comes_late_does_not_fly() -> None:
    async with game_of(chase()) as game:
        await under_way(game)
        game.kill_agent(PURSUER)
        await game.forward(2.0)
        game.bridge.master.rules.heard_health = lambda health, now: None  # type: ignore[union-attr,method-assign]
        agent = game.start_agent(PURSUER)
        await game.forward(5.0)
        assert not flies(agent)
        assert "the master's resume" in agent.core.lacks
        assert game.health[PURSUER].stage == AgentStage.WAITING
        assert "late" in game.kinds(PURSUER)


@KINDS
@virtual
async def test_when_a_pilot_changes_the_mode_the_agent_stops_at_once_and_says_so(kind: Kind) -> None:
    async with game_of(chase(kind)) as game:
        game.expects(PURSUER, "supervisor_end")
        await under_way(game)
        agent = game.agents[PURSUER]
        choose_mode(game, PURSUER, "POSCTL" if kind is Kind.PX4 else HOLD[kind])
        await game.forward(1.5, until=lambda: agent.core.vehicle.stage is Stage.TAKEN)
        sent = agent.core.vehicle.sent_at
        await game.forward(10.0)
        assert agent.core.vehicle.sent_at == sent
        assert mode(game, PURSUER) != GUIDED[kind]
        assert game.health[PURSUER].stage == AgentStage.HANDED_OVER
        assert {"take_over", "supervisor_end"} <= set(game.kinds(PURSUER))
        if kind is not Kind.PX4:  # a PX4 pilot cannot choose OFFBOARD without a stream of setpoints
            choose_mode(game, PURSUER, GUIDED[kind])
            await game.forward(5.0, until=lambda: flies(agent))
            assert "handed_back" in game.kinds(PURSUER)


@virtual
async def test_the_evader_turns_before_the_fence_whatever_its_target() -> None:
    async with game_of(chase(fence=fenced())) as game:
        await under_way(game, 1.0)
        for _ in range(90):
            await game.forward(0.5)
            assert place(game, EVADER).x < 150.0
            if game.phase is not Phase.RUNNING:
                break
        assert 1 <= game.kinds(EVADER).count("supervisor_clip") <= 3  # a spell is told once
        counted = game.health[EVADER].counters
        assert sum(n for name, n in counted.items() if name.startswith("clipped_")) > 20
        assert place(game, EVADER).x > 120.0


@virtual
async def test_without_leave_to_take_control_the_agent_waits_for_a_pilot() -> None:
    quiet = {PURSUER: {"take_control": False}}
    async with game_of(chase(), configure=quiet) as game:
        await under_way(game)
        agent = game.agents[PURSUER]
        assert agent.core.vehicle.stage is Stage.IDLE
        assert mode(game, PURSUER) == "LOITER"
        choose_mode(game, PURSUER, "GUIDED")
        await game.forward(3.0, until=lambda: flies(agent))


@virtual
async def test_a_dry_run_decides_and_publishes_but_sends_nothing() -> None:
    async with game_of(chase(), configure={PURSUER: {"dry_run": True}}) as game:
        game.expects(PURSUER, "mode_unconfirmed")
        sent: list[bytes] = []
        vehicle = game.bridge.world.vehicles[PURSUER]
        receive = vehicle.autopilot.receive
        vehicle.autopilot.receive = lambda now, data, peer: sent.append(data) or receive(now, data, peer)  # type: ignore[method-assign,func-returns-value]
        await under_way(game)
        agent = game.agents[PURSUER]
        assert agent.core.flight.decision is not None
        assert agent.core.flight.decision.decides
        assert sent == []


@virtual
async def test_a_battery_that_is_low_while_the_vehicle_waits_under_control_sends_it_home() -> None:
    async with game_of(chase()) as game:
        await game.forward(
            30.0, until=lambda: mode(game, PURSUER) == "GUIDED" and game.phase is Phase.READY
        )
        autopilot(game, PURSUER).set_battery(0.1)
        await game.forward(4.0, until=lambda: mode(game, PURSUER) == "RTL")
        assert "supervisor_return" in game.kinds(PURSUER)


@virtual
async def test_a_strategy_that_never_answers_ends_the_stream() -> None:
    async with game_of(chase()) as game:
        game.expects(PURSUER, "strategy", "supervisor_end")
        await under_way(game, 3.0)
        agent = game.agents[PURSUER]
        agent._effects[Think] = lambda effect: None
        begun = agent.now
        await game.forward(1.0, until=lambda: not flies(agent))
        assert agent.core.vehicle.sent_at - begun <= 0.3
        assert "supervisor_end" in game.kinds(PURSUER)
        await game.forward(5.0)
        assert speed(game, PURSUER) < 0.3


@virtual
async def test_stopping_leaves_the_vehicle_in_a_mode_it_can_hold_alone_within_two_seconds() -> None:
    async with game_of(chase(pursuers=2)) as game:
        await under_way(game)
        begun = game.clock.monotonic_ns()
        await game.land_agents()
        assert (game.clock.monotonic_ns() - begun) / 1e9 < 2.0
        assert {mode(game, id) for id in (EVADER, PURSUER, MATE)} == {"LOITER"}
        assert game.kinds(PURSUER)[-1] == "stopped"


@virtual
async def test_from_the_ground_multicopters_take_off_before_the_game() -> None:
    async with game_of(chase(ground_start=True)) as game:
        await under_way(game, 10.0)
        assert -place(game, PURSUER).z == pytest.approx(30.0, abs=5.0)
        assert speed(game, EVADER) > 4.0


@virtual
async def test_in_the_field_profile_everybody_keeps_to_a_layer_of_height_and_plays_in_the_plane() -> None:
    async with game_of(chase(pursuers=2, field_profile=True)) as game:
        await under_way(game, 30.0)
        heights = sorted(-place(game, id).z for id in (EVADER, PURSUER, MATE))
        assert heights == pytest.approx([120.0, 140.0, 160.0], abs=2.0)
        assert speed(game, EVADER) == pytest.approx(5.0, abs=0.3)
        assert all(flies(agent) for agent in game.agents.values())
