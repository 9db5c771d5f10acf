"""State and orders by datagram beside the session, on real sockets."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from onboard.runtime.bus_field import FieldBus
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.wire.bus.topics import COMMAND, DECISION, EVENTS, SETUP, STATE, Delivery, everything
from tests.support.field_keys import Field
from tests.support.real_time import until

GAME = "range"
OWN = STATE.key(GAME, 2)
ORDER = COMMAND.key(GAME, 2)


async def members(field: Field, *names: str) -> list[FieldBus]:
    buses = []
    for name in names:
        bus = await open_zenoh(listen=name == "ground", config_file=field.config(name))
        assert isinstance(bus, FieldBus)
        buses.append(bus)
    for bus in buses[1:]:
        await until(lambda bus=bus: bus.connected() and bus._path.proved())
    await until(lambda: buses[0]._path.proved() == set(names[1:]))
    return buses


def deafen(bus: FieldBus) -> None:
    """From now on nothing leaves over the session: as TCP that waits for a lost packet."""
    bus._put = lambda *_: None  # type: ignore[method-assign]
    for task in bus._tasks[1:]:
        task.cancel()


@pytest.mark.real
async def test_state_comes_by_datagram_to_the_station_and_the_mate_and_to_no_opponent(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    buses = await members(field, "ground", "second", "vehicle-1", "vehicle-2", "vehicle-3")
    try:
        heard: dict[int, list[bytes]] = {n: [] for n in range(5)}
        for number, bus in enumerate(buses):
            bus.subscribe(OWN, lambda sample, n=number: heard[n].append(sample.payload))
        for bus in buses:
            deafen(bus)
        for number in range(20):
            buses[3].publish(OWN, str(number).encode(), Delivery.LATEST)
            buses[2].publish(OWN, b"forged", Delivery.LATEST)
            await asyncio.sleep(0.02)
        await until(lambda: all(heard[n] and heard[n][-1] == b"19" for n in (0, 1, 4)))
        assert b"forged" not in {payload for found in heard.values() for payload in found}
        assert heard[2] == []
        assert not set(heard[0]) - {str(n).encode() for n in range(20)}
    finally:
        for bus in buses[::-1]:
            await bus.close()


@pytest.mark.real
async def test_an_order_comes_by_datagram_from_either_station_and_from_no_vehicle(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    buses = await members(field, "ground", "second", "vehicle-2", "vehicle-3")
    ground, second, vehicle, mate = buses
    try:
        vehicle.serve(ORDER, lambda question: b"obeyed " + question)
        for bus in buses:
            no_session(bus)
        assert await ground.request(ORDER, b"abort", 2.0) == [b"obeyed abort"]
        assert await second.request(ORDER, b"abort", 2.0) == [b"obeyed abort"]
        assert await mate.request(ORDER, b"abort", 0.5) == []
        mate.serve(COMMAND.key(GAME, 3), lambda question: b"mate obeyed " + question)
        everybody = COMMAND.key(GAME)
        assert set(await second.request(everybody, b"abort", 2.0)) == {b"obeyed abort", b"mate obeyed abort"}
        assert await mate.request(everybody, b"abort", 0.5) == []
    finally:
        for bus in buses[::-1]:
            await bus.close()


def no_session(bus: FieldBus) -> None:
    """Requests over the session never come back."""
    for task in bus._tasks[1:]:
        task.cancel()

    async def silent(self: ZenohBus, key: str, payload: bytes, timeout_s: float) -> list[bytes]:
        await asyncio.sleep(timeout_s)
        return []

    bus._over_session = silent.__get__(bus)  # type: ignore[method-assign]


@pytest.mark.real
async def test_a_session_without_an_echo_is_opened_again_and_everything_declared_comes_back(
    tmp_path: Path,
) -> None:
    field = Field(tmp_path / "keys").make()
    ground, vehicle = await members(field, "ground", "vehicle-2")
    try:
        heard: list[bytes] = []
        ground.subscribe("apollonius/range/vehicles/2/*", lambda sample: heard.append(sample.payload))
        vehicle.publish("apollonius/range/vehicles/2/events", b"one", Delivery.EVENT)
        await until(lambda: b"one" in heard)
        ground._echoing.close()  # the listener answers no more
        await until(lambda: vehicle.counters().get("reopened", 0) > 0)
        await until(vehicle.connected)
        vehicle.publish("apollonius/range/vehicles/2/events", b"two", Delivery.EVENT)
        await until(lambda: b"two" in heard)
    finally:
        await vehicle.close()
        await ground.close()


EVERYTHING = everything(GAME)
LATE = [  # (who writes, what and how it is delivered, who begins to listen after the first message, to what)
    ("vehicle-2", EVENTS.key(GAME, 2), Delivery.EVENT, "ground", EVERYTHING),
    ("vehicle-2", EVENTS.key(GAME, 2), Delivery.EVENT, "ground", "apollonius/range/vehicles/2/*"),
    ("vehicle-2", EVENTS.key(GAME, 2), Delivery.EVENT, "second", EVERYTHING),
    ("vehicle-2", EVENTS.key(GAME, 2), Delivery.EVENT, "second", EVENTS.key(GAME)),
    ("vehicle-2", DECISION.key(GAME, 2), Delivery.LATEST, "ground", EVERYTHING),
    ("vehicle-2", DECISION.key(GAME, 2), Delivery.LATEST, "second", "apollonius/range/*/2/decision"),
    ("ground", SETUP.key(GAME), Delivery.CACHED, "vehicle-3", SETUP.key(GAME)),
    ("ground", SETUP.key(GAME), Delivery.CACHED, "second", EVERYTHING),
    ("vehicle-2", OWN, Delivery.LATEST, "vehicle-3", OWN),
]


@pytest.mark.real
async def test_who_begins_to_listen_late_hears_what_is_written_from_then_on(tmp_path: Path) -> None:
    """A writer learns of every listener, whatever its pattern: the access rules let the news through."""
    field = Field(tmp_path / "keys").make()
    names = ("ground", "second", "vehicle-2", "vehicle-3")
    buses = dict(zip(names, await members(field, *names), strict=True))
    for bus in buses.values():
        bus._path.put = lambda *_: None  # type: ignore[method-assign]
    try:
        for writer, key, delivery, *_ in LATE:
            buses[writer].publish(key, b"before", delivery)
        await asyncio.sleep(0.5)
        heard: list[list[bytes]] = [[] for _ in LATE]
        for (_, key, _, hearer, pattern), found in zip(LATE, heard, strict=True):
            buses[hearer].subscribe(
                pattern, lambda s, key=key, found=found: found.append(s.payload) if s.key == key else None
            )
        await asyncio.sleep(0.5)
        for _ in range(40):
            for writer, key, delivery in {row[:3]: None for row in LATE}:
                buses[writer].publish(key, b"after", delivery)
            await asyncio.sleep(0.1)
            if all(b"after" in found for found in heard):
                break
        deaf = [row for row, found in zip(LATE, heard, strict=True) if b"after" not in found]
        assert not deaf
    finally:
        for bus in [*buses.values()][::-1]:
            await bus.close()
