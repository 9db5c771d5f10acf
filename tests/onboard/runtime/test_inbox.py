"""Messages of a stream wake the loop together, a lone one and an order at once; none is lost."""

from __future__ import annotations

import asyncio
import threading
import time
from collections import defaultdict
from itertools import pairwise

import pytest

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.inbox import STREAM_S, TOGETHER_S, Inbox
from onboard.runtime.loop import run_virtual
from onboard.wire.bus.topics import COMMAND, STATE, Delivery
from tests.support.bus_stages import Heard, free_port
from tests.support.real_time import until

GAME = "range"
LEFT = 300  # calls that a thread leaves, a millisecond between two


def pauses(at: list[float], seconds: float = TOGETHER_S) -> int:
    """How often the sender itself was silent: the machine is not ours alone."""
    return sum(later - sooner > 0.8 * seconds for sooner, later in pairwise(at))


async def test_a_stream_from_a_thread_wakes_the_loop_twice_and_keeps_its_order() -> None:
    inbox, ran, at = Inbox(asyncio.get_running_loop()), list[int](), list[float]()

    def speak() -> None:
        for number in range(LEFT):
            inbox.queue(lambda number=number: ran.append(number), soon=False)  # type: ignore[misc]
            at.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=speak)
    thread.start()
    await until(lambda: len(ran) == LEFT)
    thread.join()
    assert ran == list(range(LEFT))
    assert inbox.wakes <= 2 + 2 * pauses(at)  # anew after a pause


def test_a_lone_message_is_heard_at_once_and_one_of_a_stream_within_its_window() -> None:
    heard = list[tuple[float, float]]()  # when left and when heard [s]

    async def play() -> None:
        loop = asyncio.get_running_loop()
        inbox = Inbox(loop)
        for pause in (1.0, STREAM_S, 1.0, *(0.001,) * 50, 0.3, 0.02):
            await asyncio.sleep(pause)
            left = loop.time()
            inbox.latest((1, str(left)), lambda left=left: heard.append((left, loop.time())))  # type: ignore[misc]
        await asyncio.sleep(1.0)
        assert inbox.wakes == 6  # five lone ones, the third begins the stream; the one that makes it a stream

    run_virtual(play())
    waited = [at - left for left, at in heard]
    assert len(waited) == 55
    assert [*waited[:4], *waited[-2:]] == [0.0] * 6
    assert max(waited) <= TOGETHER_S + 1e-9


def test_an_order_in_a_stream_is_heard_at_once_and_what_came_before_it_comes_first() -> None:
    heard = list[object]()

    async def play() -> None:
        inbox = Inbox(asyncio.get_running_loop())
        for number in range(4):
            await asyncio.sleep(0.001)
            inbox.queue(lambda number=number: heard.append(number), soon=False)  # type: ignore[misc]
        assert heard == [0, 1]
        inbox.queue(lambda: heard.append("abort"))
        await asyncio.sleep(0.0)
        assert heard == [0, 1, 2, 3, "abort"]

    run_virtual(play())


async def test_a_stream_that_ends_leaves_no_timer_behind() -> None:
    loop = asyncio.get_running_loop()
    inbox, ran = Inbox(loop), list[int]()
    for number in range(3):
        inbox.queue(lambda number=number: ran.append(number), soon=False)  # type: ignore[misc]
        await asyncio.sleep(0)
    await until(lambda: len(ran) == 3)
    await until(lambda: not inbox.looking)
    woken = inbox.wakes
    inbox.queue(lambda: ran.append(3), soon=False)
    assert inbox.wakes == woken + 1


@pytest.mark.real
async def test_two_thousand_states_over_zenoh_wake_a_station_seldom_and_all_arrive_in_order() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station, fleet = await open_zenoh(endpoint, listen=True), await open_zenoh(endpoint)
    keys = [STATE.key(GAME, id) for id in range(1, 51)]  # 40 of each: within the bounds of a key
    told, order, at = defaultdict[str, list[bytes]](list), list[bytes](), list[float]()
    try:
        station.subscribe(STATE.key(GAME), lambda it: told[it.key].append(it.payload), every=True)
        station.serve(COMMAND.key(GAME, 1), lambda question: order.append(question) or b"done")  # type: ignore[func-returns-value]
        await until(station.connected)
        await until(lambda: fleet.publish(keys[0], b"probe", Delivery.LATEST) or told)
        await asyncio.sleep(0.3)
        told.clear()
        woken = station.counters()["woken"]
        for number in range(400):
            for share in range(5):
                key = keys[(5 * number + share) % len(keys)]
                fleet.publish(key, number.to_bytes(2, "big"), Delivery.LATEST)
            at.append(time.monotonic())
            await asyncio.sleep(0.001)
        woken = station.counters()["woken"] - woken
        await until(lambda: sum(map(len, told.values())) == 2000)
        assert all(each == sorted(each) and len(set(each)) == 40 for each in told.values())
        assert woken <= 20 + 2 * pauses(at, TOGETHER_S / 2.0)
        assert await fleet.request(COMMAND.key(GAME, 1), b"abort", 20.0) == [b"done"]
        assert order == [b"abort"]
    finally:
        await fleet.close()
        await station.close()


@pytest.mark.real
async def test_the_latest_of_a_key_in_a_stream_is_heard_and_the_rest_is_counted() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station, vehicle = await open_zenoh(endpoint, listen=True), await open_zenoh(endpoint)
    key = STATE.key(GAME, 2)
    try:
        heard = Heard(station, key)
        await until(lambda: vehicle.publish(key, b"probe", Delivery.LATEST) or heard.samples)
        await asyncio.sleep(1.0)  # until the key's bound has room for fifty at once
        before = station.counters().get("overwritten", 0) + station.counters()["received"]
        for number in range(50):
            vehicle.publish(key, number.to_bytes(2, "big"), Delivery.LATEST)
        await until(lambda: heard.payloads[-1] == (49).to_bytes(2, "big"))
        counts = station.counters()
        assert counts.get("overwritten", 0) + counts["received"] - before == 50
    finally:
        await vehicle.close()
        await station.close()
