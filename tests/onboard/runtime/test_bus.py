"""One suite for both buses: what holds in memory holds over Zenoh."""

from __future__ import annotations

import asyncio

from onboard.runtime.protocols import Bus
from onboard.wire.bus.topics import Delivery
from tests.support.bus_stages import Heard, Stage, both_buses
from tests.support.real_time import until

GAME = "apollonius/range"
SETUP = f"{GAME}/game/setup"
STATE = f"{GAME}/vehicles/2/state"
EVENTS = f"{GAME}/vehicles/2/events"
ALIVE = f"{GAME}/vehicles/2/alive"
COMMAND = f"{GAME}/vehicles/2/command"


async def path_stands(publisher: Bus, heard: Heard) -> None:
    """Publish until it is heard: a subscription takes a moment to spread. Then forget what was heard."""

    def heard_one() -> bool:
        publisher.publish(STATE, b"probe", Delivery.LATEST)
        return bool(heard.samples)

    await until(heard_one)
    await asyncio.sleep(0.2)
    heard.samples.clear()


@both_buses()
async def test_what_is_published_is_heard_by_whoever_subscribed(stage: Stage) -> None:
    vehicle, mate, station = await stage.connect(), await stage.connect(), await stage.connect()
    at_mate, at_station = Heard(mate, STATE), Heard(station, f"{GAME}/**")
    elsewhere, own = Heard(mate, f"{GAME}/vehicles/3/state"), Heard(vehicle, STATE)
    await path_stands(vehicle, at_mate)
    at_station.samples.clear()
    own.samples.clear()
    vehicle.publish(STATE, b"\x00\xff here", Delivery.LATEST)
    await until(lambda: at_mate.samples and at_station.samples and own.samples)
    assert at_mate.payloads == at_station.payloads == own.payloads == [b"\x00\xff here"]
    assert at_station.samples[0].key == STATE
    assert elsewhere.samples == []
    assert vehicle.counters()["published"] >= 2


@both_buses()
async def test_events_arrive_all_and_in_order(stage: Stage) -> None:
    vehicle, station = await stage.connect(), await stage.connect()
    heard = Heard(station, f"{GAME}/vehicles/*/events")
    wanted = [f"event {number}".encode() for number in range(100)]
    for payload in wanted:
        vehicle.publish(EVENTS, payload, Delivery.EVENT)
    await until(lambda: len(heard.samples) >= 100)
    assert heard.payloads == wanted


@both_buses()
async def test_a_late_joiner_gets_the_last_cached_value_and_all_events(stage: Stage) -> None:
    master = await stage.connect()
    master.publish(SETUP, b"old setup", Delivery.CACHED)
    master.publish(SETUP, b"setup", Delivery.CACHED)
    for number in range(5):
        master.publish(EVENTS, bytes([number]), Delivery.EVENT)
    master.publish(STATE, b"long gone", Delivery.LATEST)
    await asyncio.sleep(0.3)
    late = await stage.connect()
    setup, events, state = Heard(late, SETUP), Heard(late, EVENTS), Heard(late, STATE)
    await until(lambda: setup.samples and len(events.samples) >= 5)
    await asyncio.sleep(0.3)
    assert setup.payloads == [b"setup"]
    assert events.payloads == [bytes([number]) for number in range(5)]
    assert state.samples == []  # latest-wins topics keep nothing
    again = Heard(late, f"{GAME}/game/*")
    await until(lambda: again.samples)
    assert again.payloads == [b"setup"]


@both_buses()
async def test_a_flood_is_bounded_and_counted_and_its_newest_message_is_heard(stage: Stage) -> None:
    vehicle, mate, station = await stage.connect(), await stage.connect(), await stage.connect()
    flooded, calm = Heard(mate, STATE), Heard(mate, f"{GAME}/vehicles/3/state")
    await path_stands(vehicle, flooded)
    for number in range(5000):
        vehicle.publish(STATE, b"%d" % number, Delivery.LATEST)
        if number % 500 == 0:
            await asyncio.sleep(0.01)
    station.publish(f"{GAME}/vehicles/3/state", b"here", Delivery.LATEST)
    counts = mate.counters()

    def said_again() -> bool:  # a full network drops any message: the last ones are said until they have come
        nonlocal counts
        vehicle.publish(STATE, b"4999", Delivery.LATEST)
        vehicle.publish(STATE, bytes(100_000), Delivery.LATEST)  # of a size that no message of the table has
        counts = mate.counters()
        newest = bool(flooded.samples) and flooded.payloads[-1] == b"4999"
        return newest and bool(calm.samples) and "limited_payload" in counts

    await until(said_again)
    assert len(flooded.samples) <= 300
    assert counts["limited_vehicles_state"] >= 200  # of those that came so far
    assert max(map(len, flooded.payloads)) < 100


@both_buses()
async def test_requests_are_answered_and_nobody_is_waited_for_in_vain(stage: Stage) -> None:
    vehicle, other, station = await stage.connect(), await stage.connect(), await stage.connect()
    asked: list[bytes] = []

    def obey(payload: bytes) -> bytes:
        asked.append(payload)
        return b"accepted " + payload

    serving = vehicle.serve(COMMAND, obey)
    other.serve(f"{GAME}/vehicles/3/command", lambda payload: b"three")
    replies: list[bytes] = []
    while not replies:  # until the word has spread
        replies = await station.request(COMMAND, b"hold", 5.0)
    assert replies == [b"accepted hold"]
    assert set(asked) == {b"hold"}
    while len(replies) < 2:
        replies = await station.request(f"{GAME}/vehicles/*/command", b"all", 5.0)
    assert sorted(replies) == [b"accepted all", b"three"]
    assert await station.request(f"{GAME}/vehicles/9/command", b"hold", 0.5) == []
    serving.close()
    asked.clear()
    await asyncio.sleep(0.3)
    assert await station.request(COMMAND, b"hold", 0.5) == []
    assert asked == []


@both_buses()
async def test_presence_is_seen_coming_and_going(stage: Stage) -> None:
    vehicle, station = await stage.connect(), await stage.connect()
    token = vehicle.announce(ALIVE)
    await asyncio.sleep(0.2)
    seen: list[tuple[str, bool]] = []
    station.presence(f"{GAME}/vehicles/*/alive", lambda key, alive: seen.append((key, alive)))
    await until(lambda: len(seen) >= 1)
    token.close()
    await until(lambda: len(seen) >= 2)
    vehicle.announce(ALIVE)
    await until(lambda: len(seen) >= 3)
    await vehicle.close()
    await until(lambda: len(seen) >= 4)
    assert seen == [(ALIVE, True), (ALIVE, False), (ALIVE, True), (ALIVE, False)]


@both_buses()
async def test_a_closed_subscription_hears_no_more(stage: Stage) -> None:
    vehicle, station = await stage.connect(), await stage.connect()
    closed, open_one = Heard(station, STATE), Heard(station, f"{GAME}/vehicles/*/state")
    await path_stands(vehicle, open_one)
    closed.subscription.close()
    closed.subscription.close()
    closed.samples.clear()
    vehicle.publish(STATE, b"now", Delivery.LATEST)
    await until(lambda: open_one.samples)
    assert closed.samples == []


@both_buses()
async def test_a_bus_that_dies_and_returns_brings_everybody_back(stage: Stage) -> None:
    vehicle, station = await stage.connect(), await stage.connect()
    events, state = Heard(station, EVENTS), Heard(station, STATE)
    seen: list[bool] = []
    station.presence(ALIVE, lambda key, alive: seen.append(alive))
    vehicle.announce(ALIVE)
    vehicle.publish(SETUP, b"setup", Delivery.CACHED)
    vehicle.publish(EVENTS, b"before", Delivery.EVENT)
    await until(lambda: events.samples and seen)
    assert vehicle.connected()

    await stage.kill()
    await until(lambda: not vehicle.connected() and not station.connected())
    await until(lambda: seen == [True, False])
    for number in range(20):
        vehicle.publish(EVENTS, b"while away %d" % number, Delivery.EVENT)
    vehicle.publish(STATE, b"nobody hears this", Delivery.LATEST)
    assert vehicle.counters()["no_bus"] == 21

    await stage.restore()
    await until(lambda: vehicle.connected() and station.connected())
    await until(lambda: len(events.samples) >= 21)
    assert events.payloads == [b"before", *(b"while away %d" % number for number in range(20))]
    await until(lambda: seen == [True, False, True])
    assert b"nobody hears this" not in state.payloads
    await path_stands(vehicle, state)
    late = Heard(await stage.connect(), SETUP)
    await until(lambda: late.samples)
    assert late.payloads == [b"setup"]


@both_buses(up=False)
async def test_a_bus_that_comes_later_finds_everything_waiting(stage: Stage) -> None:
    vehicle, station = await stage.connect(), await stage.connect()
    assert not vehicle.connected()
    setup, events = Heard(station, SETUP), Heard(station, EVENTS)
    seen: list[bool] = []
    station.presence(ALIVE, lambda key, alive: seen.append(alive))
    vehicle.announce(ALIVE)
    serving = vehicle.serve(COMMAND, lambda payload: b"accepted")
    vehicle.publish(SETUP, b"old setup", Delivery.CACHED)
    vehicle.publish(SETUP, b"setup", Delivery.CACHED)
    for number in range(3):
        vehicle.publish(EVENTS, bytes([number]), Delivery.EVENT)
    assert vehicle.counters() == vehicle.counters() | {"no_bus": 5}
    assert await station.request(COMMAND, b"hold", 0.1) == []
    await asyncio.sleep(1.2)

    await stage.restore()
    await until(lambda: setup.samples and len(events.samples) >= 3 and seen)
    assert setup.payloads == [b"setup"]
    assert events.payloads == [b"\x00", b"\x01", b"\x02"]
    assert seen == [True]
    replies: list[bytes] = []
    while not replies:
        replies = await station.request(COMMAND, b"hold", 5.0)
    assert replies == [b"accepted"]
    serving.close()


@both_buses()
async def test_closing_is_final_and_idempotent(stage: Stage) -> None:
    bus = await stage.connect()
    Heard(bus, STATE)
    bus.announce(ALIVE)
    await bus.close()
    await bus.close()
    bus.publish(STATE, b"too late", Delivery.LATEST)
    assert bus.counters()["closed"] == 1
    assert not bus.connected()
