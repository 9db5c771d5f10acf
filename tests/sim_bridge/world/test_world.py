"""The world: vehicles fly on their own links, in their own air, at the clock's pace."""

from __future__ import annotations

import asyncio
from math import cos, hypot, radians, sin

import pytest

from onboard.config.strict import FieldError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec, distance, norm
from onboard.game.scenario import WINGED, AirframeKind, Flight, Kind, Scenario, VehicleSpec, WindSpec
from onboard.runtime.clock import VirtualClock
from onboard.runtime.links import MemoryLink, memory_pair
from onboard.runtime.loop import EPOCH_NS, run_virtual, virtual_clock
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.mavlink.commands import VelocityTarget, set_message_interval, set_mode
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import ARDUCOPTER_MODES
from sim_bridge.vehicle.motion import Air, Motion
from sim_bridge.world.staging import wind_of
from sim_bridge.world.world import BEHIND_MAX, World
from tests.support.scripted_companion import Companion
from tests.support.virtual_time import virtual

POSITION = dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT


def three(kind: Kind, **flight: object) -> Scenario:
    """An evader and two pursuers, spread out, 100 m up."""
    fast = kind in WINGED
    evader = VehicleSpec(position=(0.0, 0.0, 100.0), speed=20.0 if fast else 4.0, target=(900.0, 0.0, 100.0))
    pursuers = tuple(
        VehicleSpec(position=(500.0, 300.0 * side, 100.0), speed=22.0 if fast else 5.0) for side in (-1, 1)
    )
    return Scenario(
        name="three",
        evader=evader,
        pursuers=pursuers,
        flight=Flight(autopilot=kind, **flight),  # type: ignore[arg-type]
    )


class Sky:
    """A world on memory links in virtual time, with a companion beside every autopilot."""

    def __init__(self, scenario: Scenario, **options: object) -> None:
        pairs = {id: memory_pair(f"vehicle {id}") for id in scenario.ids}
        self.ours: dict[int, MemoryLink] = {id: pair[1] for id, pair in pairs.items()}
        self.companions = {id: Companion(link, id) for id, link in self.ours.items()}
        links = {id: (pair[0],) for id, pair in pairs.items()}
        self.world = World(scenario, virtual_clock(), links, **options)  # type: ignore[arg-type]

    async def fly(self, seconds: float) -> None:
        try:
            async with asyncio.timeout(seconds):
                await periodic(Pace("world", 0.01), self.world.step, virtual_clock())
        except TimeoutError:
            return


@pytest.mark.parametrize("kind", list(Kind))
def test_everybody_is_heard_on_the_own_link_alone(kind: Kind) -> None:
    @virtual
    async def story() -> None:
        sky = Sky(three(kind))
        await sky.fly(5.0)
        for id, companion in sky.companions.items():
            beats = [p for p in companion.packets if p.name == "HEARTBEAT"]
            assert 5 <= len(beats) <= 6
            assert {p.system for p in companion.packets} == {id}
            assert not companion.bad

    story()


@virtual
async def test_multicopters_hover_and_planes_keep_flying() -> None:
    for kind in Kind:
        sky = Sky(three(kind))
        before = sky.world.motions
        await sky.fly(20.0)
        for id, motion in sky.world.motions.items():
            if kind in WINGED:
                assert motion.airspeed == pytest.approx(20.0 if id == 1 else 22.0, abs=2.0)
                assert motion.position.z == pytest.approx(-100.0, abs=10.0)
            else:
                assert distance(motion.position, before[id].position) < 1.0


@virtual
async def test_only_the_vehicle_that_is_told_moves() -> None:
    sky = Sky(three(Kind.ARDUCOPTER))
    await sky.fly(1.0)
    two = sky.companions[2]
    two.send(set_mode(two.target, ARDUCOPTER_MODES["GUIDED"], px4=False))
    for _ in range(40):
        two.send(VelocityTarget(two.target, 0.0, Vec(0.0, 3.0, 0.0)))
        for deaf in (1, 3):  # the same frames on the others' links: not addressed to them
            sky.companions[deaf].send(VelocityTarget(two.target, 0.0, Vec(0.0, 3.0, 0.0)))
        await sky.fly(0.1)
    assert sky.world.motions[2].velocity == pytest.approx(Vec(0.0, 3.0, 0.0), abs=0.1)
    assert norm(sky.world.motions[1].velocity) < 0.1
    assert norm(sky.world.motions[3].velocity) < 0.1


@virtual
async def test_an_answer_does_not_wait_for_the_next_step() -> None:
    sky = Sky(three(Kind.ARDUCOPTER))
    await sky.fly(0.5)
    two = sky.companions[2]
    two.send(set_message_interval(two.target, POSITION, 20.0))
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    assert two.heard("COMMAND_ACK")
    two.packets.clear()
    await sky.fly(2.0)
    assert 39 <= len(two.heard("GLOBAL_POSITION_INT")) <= 41


@virtual
async def test_what_is_told_over_the_link_is_where_the_vehicle_is() -> None:
    sky = Sky(three(Kind.ARDUPLANE))
    two = sky.companions[2]
    two.send(set_message_interval(two.target, POSITION, 20.0))
    await sky.fly(3.0)
    said = two.heard("GLOBAL_POSITION_INT")[-1]
    autopilot = sky.world.vehicles[2].autopilot
    place = autopilot.game_position(said.lat * 1e-7, said.lon * 1e-7, said.alt * 1e-3)
    assert distance(place, sky.world.motions[2].position) < 22.0 * 0.06 + 0.1


@virtual
async def test_the_wind_carries_planes_and_is_each_vehicles_own() -> None:
    asked: set[tuple[int, bool]] = set()

    def wind(id: int, motion: Motion, t: float) -> Air:
        asked.add((id, t > 0.0))
        return Air(Vec(0.0, 5.0, 0.0) if id == 2 else ZERO, ZERO)

    sky = Sky(three(Kind.ARDUPLANE), wind=wind)
    assert sky.world.motions[2].velocity.y != sky.world.motions[1].velocity.y
    start = sky.world.motions
    await sky.fly(1.0)
    assert asked == {(id, later) for id in (1, 2, 3) for later in (False, True)}
    for id, drift in ((1, 0.0), (2, 5.0)):
        motion = sky.world.motions[id]
        air = Vec(motion.velocity.x, motion.velocity.y - drift, motion.velocity.z)
        assert norm(air) == pytest.approx(motion.airspeed, rel=1e-6)
        assert motion.position != start[id].position


@virtual
async def test_vehicles_on_the_ground_stay_where_they_are() -> None:
    sky = Sky(three(Kind.ARDUCOPTER, ground_start=True))
    await sky.fly(3.0)
    assert sky.world.motions[1].position == Vec(0.0, 0.0, 0.0)
    assert sky.world.vehicles[1].autopilot.parked


def test_two_runs_send_the_same_bytes_at_the_same_instants() -> None:
    async def run() -> list[tuple[int, int, bytes]]:
        taken: list[tuple[int, int, bytes]] = []
        sky = Sky(three(Kind.ARDUPLANE))
        for id in sky.world.vehicles:
            ours, ear = memory_pair(f"ear {id}")
            sky.world.add_link(id, ours)
            ear.receive(lambda data, peer, id=id: taken.append((id, virtual_clock().monotonic_ns(), data)))
        companion = sky.companions[3]
        companion.send(set_message_interval(companion.target, dialect.MAVLINK_MSG_ID_ATTITUDE, 10.0))
        await sky.fly(4.0)
        return taken

    first = run_virtual(run())
    assert first == run_virtual(run())
    assert len(first) > 100
    assert {id for id, *_ in first} == {1, 2, 3}


@virtual
async def test_a_second_link_may_join_in_flight() -> None:
    sky = Sky(three(Kind.PX4))
    await sky.fly(1.0)
    a, b = memory_pair("ground station")
    sky.world.add_link(1, a)
    station = Companion(b, 1)
    sky.companions[1].packets.clear()
    await sky.fly(2.0)
    assert [p.raw for p in station.packets] == [p.raw for p in sky.companions[1].packets]
    assert station.heard("HEARTBEAT")


def test_a_late_step_makes_up_for_lost_time_up_to_a_bound() -> None:
    clock = VirtualClock(EPOCH_NS)
    world = World(three(Kind.ARDUPLANE), clock, {})
    clock.advance_to(100_000_000)
    world.step()
    assert world.elapsed_ns == 100_000_000
    assert world.wall_ns == clock.wall_ns()
    clock.advance_to(60 * NS_PER_S)  # stopped and continued
    world.step()
    assert world.elapsed_ns == 100_000_000 + BEHIND_MAX * world.step_ns
    assert world.lost_steps == 5990 - BEHIND_MAX
    assert world.wall_ns == clock.wall_ns()
    world.step()
    assert world.elapsed_ns == 100_000_000 + BEHIND_MAX * world.step_ns


def test_physics_do_not_depend_on_how_often_the_world_is_asked() -> None:
    def fly(chunk: int) -> Motion:
        clock = VirtualClock(EPOCH_NS)
        world = World(three(Kind.ARDUPLANE), clock, {})
        for tick in range(chunk, 1001, chunk):
            clock.advance_to(tick * 10_000_000)
            world.step()
        return world.motions[2]

    assert fly(1) == fly(4) == fly(10)
    assert hypot(*fly(1).velocity) > 10


def test_an_aircraft_under_the_wrong_autopilot_is_one_clear_line() -> None:
    with pytest.raises(FieldError, match=r"airframe: found coordinated under px4, expected kinematic"):
        three(Kind.PX4, airframe=AirframeKind.COORDINATED)
    with pytest.raises(FieldError, match=r"flight\.ground_start: found true with airframe nose"):
        three(Kind.ARDUPLANE, airframe=AirframeKind.NOSE, ground_start=True)


@pytest.mark.parametrize("kind", [Kind.ARDUPLANE, Kind.PX4_PLANE])
def test_planes_tell_the_wind_as_they_estimate_it_each_with_errors_of_its_own(kind: Kind) -> None:
    @virtual
    async def story() -> None:
        scenario = three(kind, wind=WindSpec(speed=7.0, from_deg=250.0, gust_sigma=1.0))
        sky = Sky(scenario, wind=wind_of(scenario, scenario.seed))
        await sky.fly(30.0)
        told = []
        for id, companion in sky.companions.items():
            last = companion.heard("WIND_COV" if kind is Kind.PX4_PLANE else "WIND")[-1]
            if kind is Kind.PX4_PLANE:
                wind = (last.wind_x, last.wind_y)
            else:
                angle = radians(last.direction + 180.0)
                wind = (last.speed * cos(angle), last.speed * sin(angle))
            true = sky.world.vehicles[id].air.wind
            off = hypot(wind[0] - true.x, wind[1] - true.y)
            assert 0.01 < off < 2.0, (wind, true)  # not the truth, and no fancy
            told.append(wind)
        assert len({round(north, 3) for north, _ in told}) == 3

    story()
