"""What a story's waits do when its game fails: they end at once, and tell what happened last."""

from __future__ import annotations

import pytest

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Kind
from onboard.runtime.impairment import CUT
from onboard.runtime.loop import virtual_clock
from tests.support.flown_autopilot import FlownAutopilot
from tests.support.small_scenarios import EVADER, PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import GameError, WholeGame, game_of, under_way


def now_s(game: WholeGame) -> float:
    """Virtual time [s]."""
    return game.clock.monotonic_ns() / 1e9


@virtual
async def test_an_error_that_nobody_expects_ends_a_wait_at_once_with_the_last_events() -> None:
    begun = []

    async def story() -> None:
        async with game_of(chase()) as game:
            await under_way(game, 1.0)
            game.impair(PURSUER, CUT)
            begun.append(now_s(game))
            await game.forward(60.0)

    with pytest.raises(GameError, match="vehicle 2 told an error that nobody expects") as caught:
        await story()
    assert virtual_clock().monotonic_ns() / 1e9 - begun[0] < 6.0
    (told,) = caught.value.__notes__
    assert [f"vehicle {id} in GUIDED" in told for id in (EVADER, PURSUER)] == [True, True]
    own = told.split("vehicle 2 in")[1].splitlines()
    assert 3 < len(own) - 1 <= 20
    assert "supervisor_end: end: " in own[-1]


@virtual
async def test_an_error_that_the_story_expects_of_that_vehicle_is_a_part_of_it() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 1.0)
        game.expects(PURSUER, "supervisor_end")
        game.impair(PURSUER, CUT)
        await game.forward(6.0)
        assert "supervisor_end" in game.kinds(PURSUER)
        game.impair(EVADER, CUT)
        with pytest.raises(GameError, match="vehicle 1 told an error"):
            await game.forward(6.0)


@virtual
async def test_an_aborted_game_and_a_condition_that_never_holds_end_a_wait() -> None:
    async with game_of(chase()) as game:
        await under_way(game, 1.0)
        begun = now_s(game)
        with pytest.raises(GameError, match="did not happen within 2 s"):
            await game.forward(2.0, until=lambda: False)
        assert now_s(game) - begun == pytest.approx(2.0, abs=0.1)
        assert game.bridge.master is not None
        game.bridge.master.abort("rain")
        with pytest.raises(GameError, match=r"given up: .*rain"):
            await game.forward(60.0)
        assert now_s(game) - begun < 4.0


@virtual
async def test_a_task_that_crashes_and_a_failed_assertion_are_told_with_the_story() -> None:
    def broken() -> None:
        raise ZeroDivisionError("in the world's task")

    async def crash() -> None:
        async with game_of(chase()) as game:
            game.bridge.world.step = broken  # type: ignore[method-assign]
            await game.forward(5.0)

    async def elsewhere() -> None:
        async with game_of(chase()) as game:
            await game.forward(1.0)
            game.assert_near(EVADER, Vec(0.0, 30.0, -120.0), within=2.0)

    for story, error, text in (
        (crash, ZeroDivisionError, "in the world's task"),
        (elsewhere, AssertionError, r"30\.00 m from"),
    ):
        with pytest.raises(error, match=text) as caught:
            await story()
        assert "vehicle 1 in LOITER" in caught.value.__notes__[0]


def test_an_autopilot_flown_alone_stops_at_its_condition_or_tells_its_last_texts() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    flown.forward(5.0, until=lambda: flown.now_ns >= 1_000_000_000)
    assert flown.now_ns == 1_000_000_000
    flown.assert_near(flown.position, within=0.0)
    with pytest.raises(AssertionError, match=r"did not happen within 2 s\n3\.00 s: LOITER at"):
        flown.forward(2.0, until=lambda: False)
    with pytest.raises(AssertionError, match=r"10\.00 m from"):
        flown.assert_near(flown.position._replace(x=flown.position.x + 10.0), within=9.0)
