"""What subscriptions bring waits for the loop, which looks now and then: nothing is lost or out of order."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from collections import Counter, defaultdict, deque
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import psutil  # type: ignore[import-untyped]
import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from onboard.runtime import zenoh_streams
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.loop import run_virtual
from onboard.runtime.protocols import Sample
from onboard.runtime.rate_limit import LATER_S, BusLimit
from onboard.runtime.zenoh_streams import LOOK_S, PUT_OFF_S, Stream, Streams
from onboard.wire.bus.topics import COMMAND, EVENTS, MASTER, STATE, TRACK, Delivery
from tests.support.bus_stages import Heard, free_port
from tests.support.real_time import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

GAME = "range"
ROOT = Path(__file__).parents[3]


class Put(NamedTuple):
    """What a channel gives, as far as the streams look at it."""

    key_expr: str
    payload: zenoh.ZBytes
    kind: zenoh.SampleKind = zenoh.SampleKind.PUT


def put(key: str, payload: bytes) -> Put:
    """A message."""
    return Put(key, zenoh.ZBytes(payload))


class Played:
    """Streams on a loop, one subscription whose channel is filled by hand, and what was heard and when."""

    def __init__(self, *, every: bool = False) -> None:
        self.counts = Counter[str]()
        self.loop = asyncio.get_running_loop()
        self.streams = Streams(self.loop, self.counts, BusLimit())
        self.channel = deque[Put]()
        self.heard = list[tuple[float, Sample]]()
        self.stream = Stream(
            lambda sample: self.heard.append((self.loop.time(), sample)), "**", every=every, kept=True
        )
        self.streams.attach(self.stream, lambda: self.channel.popleft() if self.channel else None)

    @property
    def payloads(self) -> list[bytes]:
        """In the order in which they were heard."""
        return [sample.payload for _, sample in self.heard]


def test_a_message_waits_for_the_next_look_and_no_longer() -> None:
    async def play() -> None:
        played, left = Played(), list[float]()
        for pause in (1.0, 0.003, 0.5, *(0.001,) * 50, 0.3):
            await asyncio.sleep(pause)
            left.append(played.loop.time())
            played.channel.append(put(STATE.key(GAME, len(left)), b"x"))
        await asyncio.sleep(1.0)
        waited = [at - since for since, (at, _) in zip(left, played.heard, strict=True)]
        assert min(waited) >= 0.0
        assert max(waited) <= LOOK_S + 1e-9

    run_virtual(play())


def test_a_loop_that_says_when_it_wants_what_has_come_looks_then_and_only_then() -> None:
    async def play() -> None:
        played = Played()
        begun = played.loop.time()
        for number in range(100):  # a control step every 50 ms, as a position comes
            played.channel.append(put(STATE.key(GAME, 1 + number), b"x"))
            played.streams.look_in(0.042)
            await asyncio.sleep(0.05)
            assert [at - begun for at, _ in played.heard[number:]] == [pytest.approx(0.05 * number + 0.042)]
        assert played.streams.looks == 100  # one look a step
        await asyncio.sleep(1.0)
        assert played.streams.looks == pytest.approx(100 + 1.0 / LOOK_S, abs=2)
        played.streams.detach(played.stream)
        played.streams.look_in(0.042)
        await asyncio.sleep(0.1)
        assert played.streams.looks <= 102 + 1.0 / LOOK_S

    run_virtual(play())


@pytest.mark.parametrize("every", [1, 2, 5, 11, 50, 10_000])
@pytest.mark.parametrize("wait", [0.0, 0.022, 0.042, 0.492, 5.0])
def test_whenever_steps_come_and_whatever_they_say_what_comes_is_heard_soon(every: int, wait: float) -> None:
    async def play() -> None:
        played, left = Played(), list[float]()
        for number in range(500):  # a moment each 10 ms, a control step at `every` one of them
            if number % 7 == 0:
                left.append(played.loop.time())
                played.channel.append(put(STATE.key(GAME, 1 + number), b"x"))
            if number % every == 0:
                played.streams.look_in(wait)
            await asyncio.sleep(0.01)
        await asyncio.sleep(1.0)
        waited = [at - since for since, (at, _) in zip(left, played.heard, strict=True)]
        assert max(waited) <= LOOK_S + min(wait, PUT_OFF_S) + 1e-9

    run_virtual(play())



def test_the_newest_of_a_key_is_heard_and_the_rest_is_counted_but_who_records_hears_all() -> None:
    async def play(every: bool) -> Played:
        played = Played(every=every)
        for number in range(20):
            played.channel.append(put(STATE.key(GAME, 1 + number % 2), b"%d" % number))
            played.channel.append(put(EVENTS.key(GAME, 1), b"event %d" % number))
        await asyncio.sleep(LOOK_S * 1.5)
        return played

    newest, all_of = run_virtual(play(False)), run_virtual(play(True))
    events = [b"event %d" % number for number in range(20)]
    assert newest.payloads == [*events, b"18", b"19"]
    assert newest.counts == {"received": 22, "overwritten": 18}
    assert [p for p in all_of.payloads if p in events] == events
    assert all_of.payloads == [b"%d" % (n // 2) if n % 2 == 0 else b"event %d" % (n // 2) for n in range(40)]
    assert all_of.counts == {"received": 40}


def test_the_newest_of_a_flood_is_heard_at_a_pace_and_in_the_end() -> None:
    async def play() -> None:
        played = Played()
        for number in range(20_000):  # twenty seconds, fifty a look: a state's bound is far below
            played.channel.append(put(STATE.key(GAME, 2), b"%d" % number))
            await asyncio.sleep(0.001)
        await asyncio.sleep(2.0 * LATER_S)
        assert played.payloads[-1] == b"19999"
        numbers = [int(payload) for payload in played.payloads]
        assert numbers == sorted(set(numbers))
        assert len(numbers) <= 20.0 / LOOK_S + 10
        heard = played.counts["received"] + played.counts["overwritten"]
        assert heard == 20_000

    run_virtual(play())


@given(
    st.lists(
        st.tuples(st.sampled_from((STATE, EVENTS)), st.integers(1, 3), st.integers(0, 30)),
        max_size=60,
    )
)
def test_no_key_is_heard_out_of_order_and_its_last_word_always(said: list[tuple[Any, int, int]]) -> None:
    async def play() -> None:
        played = Played()
        sent = defaultdict[str, list[bytes]](list)
        for number, (topic, id, pause_ms) in enumerate(said):
            await asyncio.sleep(pause_ms / 1e3)
            key = topic.key(GAME, id)
            sent[key].append(b"%d" % number)
            played.channel.append(put(key, b"%d" % number))
        await asyncio.sleep(1.0)
        for key, payloads in sent.items():
            heard = [sample.payload for _, sample in played.heard if sample.key == key]
            assert heard == [payload for payload in payloads if payload in heard]  # order, nothing twice
            assert heard[-1] == payloads[-1]
            if key.endswith("events"):
                assert heard == payloads

    run_virtual(play())


def test_who_fails_or_ends_while_hearing_takes_nothing_from_others() -> None:
    async def play() -> None:
        played = Played()
        faults = list[object]()
        played.loop.set_exception_handler(lambda _, context: faults.append(context["exception"]))
        full, ran = deque(put(EVENTS.key(GAME, 1), b"%d" % n) for n in range(6)), list[int]()

        def bad(sample: Sample) -> None:
            ran.append(6 // (int(sample.payload) - 1))
            if sample.payload == b"4":
                played.streams.detach(other)

        other = Stream(bad, "**")
        played.streams.attach(other, lambda: full.popleft() if full else None)
        played.channel.append(put(STATE.key(GAME, 1), b"mine"))
        await asyncio.sleep(2.0 * LOOK_S)
        assert ran == [-6, 6, 3, 2]
        assert [type(fault) for fault in faults] == [ZeroDivisionError]
        assert played.payloads == [b"mine"]
        played.streams.detach(played.stream)
        looks = played.streams.looks
        await asyncio.sleep(1.0)
        assert played.streams.looks == looks  # nobody listens: no timer is left

    run_virtual(play())


# ---------------------------------------------------------------------- over Zenoh


@asynccontextmanager
async def sessions() -> AsyncIterator[tuple[ZenohBus, ZenohBus]]:
    """Who listens, and who connects to it; both are closed in the end."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    listener, client = await open_zenoh(endpoint, listen=True), await open_zenoh(endpoint)
    try:
        yield listener, client
    finally:
        await client.close()
        await listener.close()


@pytest.mark.real
async def test_two_thousand_states_over_zenoh_wake_a_station_seldom_and_all_arrive_in_order() -> None:
    async with sessions() as (station, fleet):
        keys = [STATE.key(GAME, id) for id in range(1, 51)]  # 40 of each: within the bounds of a key
        told = defaultdict[str, list[bytes]](list)
        station.subscribe(STATE.key(GAME), lambda it: told[it.key].append(it.payload), every=True)
        await until(station.connected)
        await until(lambda: fleet.publish(keys[0], b"probe", Delivery.LATEST) or told)
        await asyncio.sleep(0.3)
        told.clear()
        woken, begun = station.counters()["woken"], asyncio.get_running_loop().time()
        for number in range(400):
            for share in range(5):
                key = keys[(5 * number + share) % len(keys)]
                fleet.publish(key, number.to_bytes(2, "big"), Delivery.LATEST)
            await asyncio.sleep(0.001)
        await until(lambda: sum(map(len, told.values())) == 2000)
        took = asyncio.get_running_loop().time() - begun
        assert all(each == sorted(each) and len(set(each)) == 40 for each in told.values())
        assert station.counters()["woken"] - woken <= took / LOOK_S + 2


@pytest.mark.real
async def test_an_order_is_heard_at_once_whenever_the_loop_looks_next(monkeypatch: Any) -> None:
    monkeypatch.setattr(zenoh_streams, "LOOK_S", 1e3)
    async with sessions() as (agent, station):
        heard, order = Heard(agent, STATE.key(GAME, 2)), list[bytes]()

        def obey(question: bytes) -> bytes:
            order.append(question)
            return b"done"

        agent.serve(COMMAND.key(GAME, 1), obey)
        await until(station.connected)
        station.publish(STATE.key(GAME, 2), b"state", Delivery.LATEST)
        assert await station.request(COMMAND.key(GAME, 1), b"abort", 20.0) == [b"done"]
        assert order == [b"abort"]
        assert not heard.samples


@pytest.mark.real
async def test_the_masters_beat_waits_for_no_look_which_would_count_as_an_offset(monkeypatch: Any) -> None:
    monkeypatch.setattr(zenoh_streams, "LOOK_S", 1e3)
    async with sessions() as (agent, master):
        heard, state = Heard(agent, MASTER.key(GAME)), Heard(agent, STATE.key(GAME, 2))
        await until(master.connected)
        master.publish(STATE.key(GAME, 2), b"state", Delivery.LATEST)
        await until(lambda: master.publish(MASTER.key(GAME), b"beat", Delivery.LATEST) or heard.samples)
        assert heard.samples[0].payload == b"beat"
        assert not state.samples


async def grown() -> int:
    """How much this process has grown by a long flight's messages [bytes]."""
    async with sessions() as (agent, others):
        keys = [TRACK.key(GAME, 1), *(STATE.key(GAME, id) for id in range(2, 7))]
        heard = [Heard(agent, TRACK.key(GAME)), *(Heard(agent, key) for key in keys[1:])]
        resident = psutil.Process().memory_info

        async def fly(messages: int) -> None:
            for number in range(messages):
                for key in keys:
                    others.publish(key, b"%200d" % number, Delivery.LATEST)
                if number % 20 == 0:
                    for one in heard:
                        one.samples.clear()
                    await asyncio.sleep(0.001)

        await until(lambda: others.publish(keys[0], b"probe", Delivery.LATEST) or heard[0].samples)
        await fly(1000)
        before = resident().rss
        await fly(7000)
        grown: int = resident().rss - before
        return grown


@pytest.mark.real
def test_what_an_agent_hears_in_a_long_flight_takes_no_memory() -> None:
    """Places of a channel stay in memory once they were used, and messages use one after another.

    Of a process of its own; a few are tried, since on a busy machine messages on their way add some."""
    flight = f"import asyncio; from {__name__} import grown; print(asyncio.run(grown()))"
    tried = []
    for _ in range(5):
        flown = [sys.executable, "-c", flight]
        tried.append(int(subprocess.run(flown, cwd=ROOT, capture_output=True, check=True).stdout))
        if tried[-1] < 4e6:  # 7000 places of six channels are 10 MB
            return
    raise AssertionError(tried)


@pytest.mark.real
async def test_a_channel_that_ran_over_is_counted_and_keeps_the_newest(monkeypatch: Any) -> None:
    monkeypatch.setattr(zenoh_streams, "MANY_MAX", 64)
    async with sessions() as (station, vehicle):
        key, heard = EVENTS.key(GAME, 2), list[bytes]()

        def said(number: int) -> Callable[[], object]:
            return lambda: number.to_bytes(2, "big") in heard

        station.subscribe(EVENTS.key(GAME), lambda sample: heard.append(sample.payload))
        await until(lambda: vehicle.publish(key, bytes(2), Delivery.EVENT) or heard)
        monkeypatch.setattr(zenoh_streams, "LOOK_S", 1.5)
        await asyncio.sleep(0.1)  # the loop has looked once more, and will not for a while
        for number in range(1, 200):
            vehicle.publish(key, number.to_bytes(2, "big"), Delivery.EVENT)
        await until(said(199))
        late = [int.from_bytes(payload, "big") for payload in heard if payload != bytes(2)]
        assert late == list(range(136, 200))
        assert station.counters()["overflow"] == 1
