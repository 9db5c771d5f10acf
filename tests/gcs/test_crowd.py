"""A roster sent home at once: heights that differ and circles that lie apart pass, others are named."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from gcs.crowd import compare
from onboard.game.scenario import Flight, Parameters, Scenario, VehicleSpec
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus.messages import AgentStage, Health, Role, SupervisorAction
from sim_bridge.rehearsal import Options, Rehearsal
from tests.support.small_scenarios import chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import virtual_clock


def game(*places: tuple[float, float], separation: float = 10.0, field: bool = False) -> Scenario:
    """Vehicles at places, flown at 50 m."""
    specs = [VehicleSpec(position=place, speed=18.0) for place in places]
    return Scenario(
        name="crowd", evader=specs[0], pursuers=tuple(specs[1:]),
        parameters=Parameters(separation=separation), flight=Flight(height=50.0, field_profile=field),
    )  # fmt: skip


def heard(id: int, return_m: float, loiter_m: float = 0.0) -> Health:
    """What a vehicle says of itself."""
    kind = Kind.ARDUPLANE if loiter_m else Kind.ARDUCOPTER
    return Health(
        id, Role.PURSUER, 0, AgentStage.READY, (), kind, "LOITER", True, 1.0, 1.0, 20.0, 0.0, 0.0, 3, True,
        SupervisorAction.OK, "0", {}, return_m=return_m, loiter_m=loiter_m,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("heights", "well"),
    [((60.0, 75.0, 90.0), [True] * 3), ((60.0, 75.0, 80.0), [True, False, False]),
     ((15.0, 15.0, 80.0), [False, False, True]), ((-1.0, 15.0, 80.0), [False, False, True])],
)  # fmt: skip
def test_ways_home_differ_by_the_separation(heights: tuple[float, ...], well: list[bool]) -> None:
    """What is lower than the game is flown at is no height of its own: nobody sinks on the way home."""
    lines = compare(game((0, 0), (30, 0), (60, 0)), {n: heard(n, h) for n, h in enumerate(heights, 1)})
    assert [line.well for line in lines] == well
    assert all(("as vehicle" in line.text) != line.well for line in lines)


def test_circles_at_one_height_lie_apart_or_the_game_is_flown_in_layers() -> None:
    said = {1: heard(1, 100.0, 60.0), 2: heard(2, 130.0, 80.0)}
    assert [line.well for line in compare(game((0, 0), (200, 0)), said)] == [False, False]
    first = compare(game((0, 0), (200, 0)), said)[0]
    assert "its circle may meet that of vehicle 2, 200 m away" in first.text
    assert all(line.well for line in compare(game((0, 0), (300, 0)), said))
    assert all(line.well for line in compare(game((0, 0), (200, 0), field=True), said))


def test_who_is_not_heard_does_not_pass() -> None:
    lines = compare(game((0, 0), (30, 0)), {1: heard(1, 60.0)})
    assert [(line.id, line.well, line.text) for line in lines][1] == (2, False, "not heard")


@virtual
async def test_vehicles_report_the_heights_that_their_autopilots_have() -> None:
    scenario = chase()
    simulated = replace(scenario.flight.simulated, parameters={"RTL_ALT": 13000.0})
    scenario = replace(scenario, flight=replace(scenario.flight, simulated=simulated))
    async with Rehearsal(scenario, virtual_clock(), Options()) as flown:
        await flown.until(lambda: len(flown.health) == 2 and flown.phase.value == "ready", 20.0)
        lines = compare(scenario, flown.health)
    assert [line.well for line in lines] == [False, False]
    assert all("returns at 130 m; as vehicle" in line.text for line in lines)
