"""What time and transport cost: virtual wake-ups, links and buses, beside asyncio's own, in one run."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from statistics import median, quantiles
from time import perf_counter, process_time

import pytest

from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.links import open_udp
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.protocols import Sample
from onboard.runtime.tasks import Pace, periodic
from onboard.runtime.zenoh_streams import LOOK_S
from onboard.wire.bus.topics import COMMAND, STATE
from tests.benchmarks import yardstick
from tests.support.bus_stages import free_port
from tests.support.real_time import until
from tests.support.scripted_agents import for_a_while

TASKS, RATE_HZ = 6, 20.0
PAYLOAD = b"x" * 200


def test_virtual_wake_ups_beside_the_stock_loops() -> None:
    """A thousand virtual seconds of six 20 Hz tasks; the stock loop runs as many rounds without waiting."""
    seconds = 1000.0
    wakes = round(TASKS * RATE_HZ * seconds)

    async def virtual() -> None:
        clock = virtual_clock()
        paces = [Pace(str(number), 1.0 / RATE_HZ) for number in range(TASKS)]
        await for_a_while(seconds, *(periodic(pace, lambda: None, clock) for pace in paces))
        assert all(pace.runs >= seconds * RATE_HZ for pace in paces)

    async def stock() -> None:
        async def spin() -> None:
            for _ in range(wakes // TASKS):
                await asyncio.sleep(0)

        await asyncio.gather(*(spin() for _ in range(TASKS)))

    def once() -> float:
        begun = process_time()
        run_virtual(virtual())
        return (process_time() - begun) / wakes

    ours = yardstick.least(once)
    begun = process_time()
    asyncio.run(stock())
    theirs = (process_time() - begun) / wakes
    print(f"virtual wake-up, periodic task {ours * 1e6:.1f} µs; stock loop, sleep(0) {theirs * 1e6:.1f} µs")
    yardstick.cost("virtual wake-up of a periodic task", ours)
    assert ours < 20 * theirs


def test_a_state_to_six_sessions_in_memory() -> None:
    count = 5000

    async def main() -> float:
        broker = MemoryBroker()
        buses = [broker.connect() for _ in range(6)]
        heard: list[Sample] = []
        for bus in buses:
            bus.subscribe(STATE.key("g"), heard.append)
        begun = process_time()
        for _ in range(count):
            buses[0].publish(STATE.key("g", 2), PAYLOAD, STATE.delivery)
            await asyncio.sleep(0.05)
        took = process_time() - begun
        assert len(heard) == 6 * count
        return took / count

    cost = yardstick.least(lambda: run_virtual(main()))
    print(f"memory bus: one state to six sessions {cost * 1e6:.1f} µs")
    yardstick.cost("a state to six sessions in memory", cost)
    assert cost < 0.01


@pytest.mark.real
async def test_round_trips_over_zenoh_beside_bare_udp() -> None:
    """200 bytes there and back at 50 Hz, through a listening station: orders, and states as vehicles tell."""

    async def trips(send: Callable[[], None], arrived: asyncio.Event) -> list[float]:
        times = []
        for _ in range(150):
            arrived.clear()
            begun = perf_counter()
            send()
            await wait_for(arrived.wait())
            times.append(perf_counter() - begun)
            await asyncio.sleep(0.02)
        return times

    async def wait_for(waiting: Awaitable[object]) -> None:
        async with asyncio.timeout(10):
            await waiting

    back = asyncio.Event()
    a, b = await open_udp("127.0.0.1", 0), await open_udp("127.0.0.1", 0)
    b.receive(lambda data, peer: b.send(data))
    a.receive(lambda data, peer: back.set())
    udp = await trips(lambda: a.send(PAYLOAD, b.address), back)
    a.close()
    b.close()

    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station = await open_zenoh(endpoint, listen=True)
    one, two = await open_zenoh(endpoint), await open_zenoh(endpoint)
    order, there, here = COMMAND.key("g", 2), STATE.key("g", 1), STATE.key("g", 2)
    two.serve(order, lambda question: question)
    two.subscribe(there, lambda sample: two.publish(here, sample.payload, STATE.delivery))
    one.subscribe(here, lambda sample: back.set())
    orders = []
    try:
        await until(lambda: one.publish(there, PAYLOAD, STATE.delivery) or back.is_set())
        while not await one.request(order, PAYLOAD, 1.0):
            pass
        for _ in range(150):
            begun = perf_counter()
            assert await one.request(order, PAYLOAD, 10.0) == [PAYLOAD]
            orders.append(perf_counter() - begun)
            await asyncio.sleep(0.02)
        states = await trips(lambda: one.publish(there, PAYLOAD, STATE.delivery), back)
    finally:
        for bus in (one, two, station):
            await bus.close()
    named = ("asyncio UDP", udp), ("an order over Zenoh", orders), ("states over Zenoh", states)
    for name, times in named:
        print(f"{name}: median {median(times) * 1e6:.0f} µs, p99 {quantiles(times, n=100)[98] * 1e6:.0f} µs")
    yardstick.ratio("an order and its reply over Zenoh, by UDP's round trip", median(orders) / median(udp))
    assert median(orders) < 20 * median(udp)
    assert median(states) < 2.0 * LOOK_S + 20 * median(udp)  # each waits for a look at its hearer's
