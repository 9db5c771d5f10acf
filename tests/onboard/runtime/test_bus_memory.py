"""What only the memory bus has: impairments from a seed, and exact times."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.impairment import CLEAR, CUT, Impairment
from onboard.runtime.loop import virtual_clock
from onboard.runtime.protocols import Sample
from onboard.wire.bus.topics import Delivery
from tests.support.bus_stages import Heard
from tests.support.real_time import until
from tests.support.virtual_time import virtual

STATE = "apollonius/range/vehicles/2/state"
EVENTS = "apollonius/range/vehicles/2/events"
COMMAND = "apollonius/range/vehicles/2/command"


def impaired(impairment: Impairment, seed: int = 5) -> MemoryBroker:
    return MemoryBroker(impairment, np.random.default_rng(seed))


@virtual
async def test_loss_takes_its_share_of_states_and_not_one_event() -> None:
    async def run(seed: int) -> tuple[list[bytes], list[bytes]]:
        broker = impaired(Impairment(loss=0.3, delay_s=0.02, jitter_s=0.03), seed)
        vehicle, station = broker.connect("2"), broker.connect("gcs")
        state, events = Heard(station, STATE), Heard(station, EVENTS)
        for tick in range(1000):
            vehicle.publish(STATE, tick.to_bytes(2, "big"), Delivery.LATEST)
            if tick % 10 == 0:
                vehicle.publish(EVENTS, tick.to_bytes(2, "big"), Delivery.EVENT)
            await asyncio.sleep(0.05)
        await asyncio.sleep(60)
        return state.payloads, events.payloads

    states, events = await run(1)
    assert 620 < len(states) < 780
    assert states == sorted(states)
    assert events == [tick.to_bytes(2, "big") for tick in range(0, 1000, 10)]
    assert await run(1) == (states, events)
    assert (await run(2))[0] != states


@virtual
async def test_one_connection_can_be_cut_while_the_others_talk_on() -> None:
    broker = impaired(CLEAR)
    vehicle, far, near = broker.connect("2"), broker.connect("far"), broker.connect("near")
    at_far, at_near = Heard(far, STATE), Heard(near, STATE)
    far_events = Heard(far, EVENTS)
    assert far.channel is not None
    far.channel.impairment = CUT
    for tick in range(60):
        vehicle.publish(STATE, bytes([tick]), Delivery.LATEST)
        await asyncio.sleep(0.05)
    vehicle.publish(EVENTS, b"said while it was cut", Delivery.EVENT)
    await asyncio.sleep(0.05)
    assert far_events.samples == []
    far.channel.impairment = CLEAR
    await asyncio.sleep(1.0)
    assert at_far.samples == []
    assert len(at_near.samples) == 60
    assert far_events.payloads == [b"said while it was cut"]
    assert far.counters()["in_cut"] >= 60


@virtual
async def test_flipped_bits_reach_the_receiver_of_latest_messages_alone() -> None:
    broker = impaired(Impairment(bit_error=1.0))
    vehicle, station = broker.connect("2"), broker.connect("gcs")
    state, events = Heard(station, STATE), Heard(station, EVENTS)
    vehicle.publish(STATE, b"\x00\x00", Delivery.LATEST)
    vehicle.publish(EVENTS, b"\x00\x00", Delivery.EVENT)
    await asyncio.sleep(1.0)
    assert int.from_bytes(state.payloads[0], "big").bit_count() == 1
    assert events.payloads == [b"\x00\x00"]


@virtual
async def test_a_request_on_a_slow_connection_ends_at_its_deadline() -> None:
    broker = impaired(Impairment(delay_s=0.8))
    vehicle, station = broker.connect("2"), broker.connect("gcs")
    vehicle.serve(COMMAND, lambda payload: b"accepted")
    clock = virtual_clock()
    assert await station.request(COMMAND, b"hold", 1.0) == []
    assert clock.monotonic_ns() == NS_PER_S
    assert await station.request(COMMAND, b"hold", 2.0) == [b"accepted"]
    assert clock.monotonic_ns() == 2_600_000_000
    assert station.counters()["request_timeout"] == 1


@virtual
async def test_a_broker_is_back_for_its_clients_half_a_second_after_it_returns() -> None:
    broker = MemoryBroker()
    vehicle = broker.connect("2")
    broker.kill()
    broker.restore()
    assert not vehicle.connected()
    await until(vehicle.connected)
    assert virtual_clock().monotonic_ns() == 500_000_000


@virtual
async def test_a_flood_is_bounded_and_counted() -> None:
    broker = MemoryBroker()
    vehicle, station = broker.connect("2"), broker.connect("gcs")
    heard: list[Sample] = []
    station.subscribe(STATE, heard.append)
    for _ in range(10_000):
        vehicle.publish(STATE, b"x", Delivery.LATEST)
    await asyncio.sleep(0)
    counts = station.counters()
    assert len(heard) + counts["overflow"] + counts["limited_vehicles_state"] == 10_000
    assert station.counters()["overflow"] > 0


def test_an_impaired_broker_asks_for_its_generator() -> None:
    with pytest.raises(ValueError, match="needs a generator"):
        MemoryBroker(CLEAR)


@virtual
async def test_duplicates_of_a_request_are_answered_once() -> None:
    broker = impaired(Impairment(duplication=1.0, jitter_s=0.01))
    vehicle, other, station = broker.connect("2"), broker.connect("3"), broker.connect("gcs")
    asked: list[bytes] = []

    def obey(payload: bytes) -> bytes:
        asked.append(payload)
        return b"accepted"

    vehicle.serve(COMMAND, obey)
    other.serve(COMMAND.replace("2", "3"), obey)
    replies = await station.request(COMMAND.replace("2", "*"), b"hold", 1.0)
    assert replies == [b"accepted", b"accepted"]
    assert asked == [b"hold", b"hold"]


@virtual
async def test_two_subscriptions_of_one_session_lose_the_same_messages() -> None:
    broker = impaired(Impairment(loss=0.5))
    vehicle, station = broker.connect("2"), broker.connect("gcs")
    one, all_of_them = Heard(station, STATE), Heard(station, "apollonius/**")
    for tick in range(100):
        vehicle.publish(STATE, bytes([tick]), Delivery.LATEST)
        await asyncio.sleep(0.05)
    assert one.payloads == all_of_them.payloads
    assert 25 < len(one.samples) < 75


@virtual
async def test_a_process_started_again_is_another_publisher() -> None:
    broker = MemoryBroker()
    station = broker.connect("gcs")
    events = Heard(station, EVENTS)
    for life in range(50):  # a new object may well lie where a dead one lay
        vehicle = broker.connect("2")
        vehicle.publish(EVENTS, b"life %d" % life, Delivery.EVENT)
        await asyncio.sleep(0.01)
        await vehicle.close()
        del vehicle
    assert events.payloads == [b"life %d" % life for life in range(50)]


def test_one_hearers_fault_is_not_the_others_and_all_hear_the_same_object() -> None:
    """On a loop that goes on after a callback's error, as a program's does."""

    async def main() -> tuple[list[bytes], list[bytes]]:
        broker, failures = MemoryBroker(), []
        asyncio.get_running_loop().set_exception_handler(lambda loop, context: failures.append(context))
        station = broker.connect("station")
        before, after = Heard(broker.connect("a"), STATE), broker.connect("b")

        def fails(sample: Sample) -> None:
            raise ValueError(sample.key)

        after.subscribe(STATE, fails)
        last = Heard(broker.connect("c"), STATE)
        payload = bytes(range(9))
        station.publish(STATE, payload, Delivery.LATEST)
        await asyncio.sleep(0.0)
        await asyncio.sleep(0.0)
        assert [str(failure["exception"]) for failure in failures] == [STATE]
        assert all(heard is payload for heard in (*before.payloads, *last.payloads))
        return before.payloads, last.payloads

    first, last = asyncio.run(main())
    assert first == last == [bytes(range(9))]
