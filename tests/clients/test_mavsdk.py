"""MAVSDK 4, a client nobody here wrote: it discovers, arms and flies each personality over UDP."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from math import hypot
from typing import Any

import pytest

from onboard.core.math.vectors import Vec, norm, sub
from onboard.game.scenario import Kind
from tests.support import real_time
from tests.support.flown_autopilot import FLOWN
from tests.support.udp_fleet import Fleet, fleet, free_port

mavsdk = pytest.importorskip("mavsdk.asyncio", reason="MAVSDK is not installed (extra `mavsdk`)")

from mavsdk.asyncio import ComponentType, Configuration, Mavsdk  # noqa: E402
from mavsdk.asyncio.plugins.action import ActionAsync  # noqa: E402
from mavsdk.asyncio.plugins.offboard import OffboardAsync, VelocityNedYaw  # noqa: E402
from mavsdk.asyncio.plugins.telemetry import TelemetryAsync  # noqa: E402

pytestmark = [pytest.mark.real, pytest.mark.timeout(120)]
KINDS = pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
MULTICOPTERS = pytest.mark.parametrize("kind", [Kind.PX4, Kind.ARDUCOPTER], ids=lambda kind: kind.value)
PLAYED_S = 25.0  # the longest of these stories on a quiet machine


@asynccontextmanager
async def client(port: int) -> AsyncIterator[Any]:
    """MAVSDK as a ground station that listens on a port."""
    async with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        await sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        yield sdk


async def systems(sdk: Any, count: int) -> dict[int, Any]:
    """All vehicles by their system id, as soon as there are so many whose heartbeat MAVSDK has heard.

    By another message it knows a component 1, but not whose it is, and orders PX4's modes: its main mode 6,
    OFFBOARD, is ArduCopter's RTL. (4.1.0; `is_connected` comes with the heartbeat.)
    """
    while True:
        found = {await s.get_system_id(): s for s in await sdk.get_systems() if await s.is_connected()}
        if len(found) == count:
            return found
        await asyncio.sleep(0.05)


async def until(condition: Callable[[], bool], what: str, promised_s: float = 12.0) -> None:
    """Wait for something to become true."""
    try:
        await real_time.until(condition, promised_s)
    except TimeoutError:
        pytest.fail(f"not within patience for {promised_s:g} s: {what}")


async def first(values: Any, wanted: Callable[[Any], bool]) -> Any:
    """The first value of a subscription that is wanted."""
    try:
        async for value in values:
            if wanted(value):
                return value
    finally:
        await values.aclose()


def unmoved(vehicles: Fleet, starts: dict[int, Vec], ids: tuple[int, ...]) -> bool:
    return all(norm(sub(vehicles.position(id), starts[id])) < 0.5 for id in ids)


@KINDS
async def test_it_discovers_and_arms_every_vehicle_on_one_port(kind: Kind) -> None:
    port = free_port()
    async with (
        asyncio.timeout(real_time.patience(PLAYED_S)),
        fleet(kind, [[port]] * 3, ground=True) as vehicles,
        client(port) as sdk,
    ):
        found = await systems(sdk, 3)
        assert sorted(found) == [1, 2, 3]
        await until(lambda: vehicles.autopilot(2).home_known, "a position estimate")
        telemetry = TelemetryAsync(found[2])
        await first(telemetry.subscribe_health(), lambda health: health.is_home_position_ok)
        assert not vehicles.autopilot(2).armed
        await ActionAsync(found[2]).arm()
        assert await first(telemetry.subscribe_armed(), bool)
        assert [vehicles.autopilot(id).armed for id in (1, 2, 3)] == [False, True, False]
        await ActionAsync(found[2]).disarm()
        await until(lambda: not vehicles.autopilot(2).armed, "disarmed again")


@MULTICOPTERS
async def test_offboard_velocities_move_one_multicopter_and_not_its_neighbours(kind: Kind) -> None:
    port = free_port()
    async with (
        asyncio.timeout(real_time.patience(PLAYED_S)),
        fleet(kind, [[port]] * 3) as vehicles,
        client(port) as sdk,
    ):
        found = await systems(sdk, 3)
        starts = {id: vehicles.position(id) for id in (1, 2, 3)}
        telemetry, offboard = TelemetryAsync(found[2]), OffboardAsync(found[2])
        told = await first(telemetry.subscribe_position_velocity_ned(), lambda _: True)
        assert abs(told.velocity.north_m_s) < 0.1
        await offboard.set_velocity_ned(VelocityNedYaw(3.0, 1.0, -1.0, 0.0))
        if kind == Kind.PX4:
            await asyncio.sleep(1.5)  # the stream that PX4 demands
        await offboard.start()
        mode = {Kind.PX4: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED"}[kind]
        await until(lambda: vehicles.autopilot(2).mode_name == mode, f"{mode} entered")
        wanted = Vec(3.0, 1.0, -1.0)
        await until(lambda: norm(sub(vehicles.motion(2).velocity, wanted)) < 0.05, "the velocity followed")
        told = await first(
            telemetry.subscribe_position_velocity_ned(), lambda value: value.velocity.north_m_s > 2.9
        )
        assert abs(told.velocity.east_m_s - 1.0) < 0.1
        await offboard.set_velocity_ned(VelocityNedYaw(100.0, 0.0, 0.0, 0.0))
        await until(lambda: vehicles.motion(2).velocity.x > 7.5, "its greatest speed")
        assert norm(vehicles.motion(2).velocity) <= 8.0 + 1e-6
        await offboard.stop()
        await until(lambda: norm(vehicles.motion(2).velocity) < 0.5, "stopped")
        assert vehicles.autopilot(2).mode_name != mode
        assert unmoved(vehicles, starts, (1, 3))
        others = [vehicles.autopilot(id).counters["for_others"] for id in (1, 3)]
        assert min(others) > 20  # the same datagrams reached them


async def test_a_plane_enters_guided_and_repositions_and_its_neighbours_do_not() -> None:
    port = free_port()
    async with (
        asyncio.timeout(real_time.patience(PLAYED_S)),
        fleet(Kind.ARDUPLANE, [[port]] * 3) as vehicles,
        client(port) as sdk,
    ):
        found = await systems(sdk, 3)
        telemetry = TelemetryAsync(found[2])
        here = await first(telemetry.subscribe_position(), lambda _: True)
        await ActionAsync(found[2]).arm()  # it is: accepted again
        await ActionAsync(found[2]).goto_location_fixedwing(
            here.latitude_deg + 0.01, here.longitude_deg, here.absolute_altitude_m + 30.0, 90.0
        )
        await until(lambda: vehicles.autopilot(2).mode_name == "GUIDED", "GUIDED entered")
        await until(lambda: -vehicles.position(2).z > 70.0, "the new altitude sought")
        await until(lambda: vehicles.position(2).x > 150.0, "on its way north")
        assert vehicles.motion(2).airspeed <= 30.0
        for id in (1, 3):
            assert vehicles.autopilot(id).mode_name == "LOITER"
            p = vehicles.position(id)
            assert hypot(p.x, p.y - 100.0 * (id - 1)) < 180.0
            assert abs(p.z + 60.0) < 1.0
            assert vehicles.autopilot(id).counters["for_others"] > 0


@KINDS
async def test_the_agents_port_and_the_ground_stations_hear_alike(kind: Kind) -> None:
    """Two clients on two ports, as an agent and QGroundControl would listen."""
    agent, ground = free_port(), free_port()
    ports = [[agent, ground], [ground]]
    async with (
        asyncio.timeout(real_time.patience(PLAYED_S)),
        fleet(kind, ports),
        client(agent) as near,
        client(ground) as far,
    ):
        assert sorted(await systems(far, 2)) == [1, 2]
        assert sorted(await systems(near, 1)) == [1]
