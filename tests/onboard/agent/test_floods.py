"""A flood on the link costs the machine no more than its bound, and the autopilot is heard through it."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import AnyEvent, LinkBytes
from onboard.agent.shell import Agent, Equipment
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.loop import EPOCH_NS, VirtualLoop, run_virtual
from onboard.runtime.rate_limit import FROM_OTHERS
from onboard.wire.mavlink.commands import OwnHeartbeat
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.frames import Sender

FLOOD_HZ = 20_000
SECONDS = 3


class ScriptedLink:
    """A link of several peers that only the test writes to."""

    name = "scripted"

    def __init__(self) -> None:
        self.arrives: Callable[[bytes, object], None] = lambda data, peer: None
        self.sent: list[object] = []

    def send(self, data: bytes, peer: object = None) -> None:
        self.sent.append(peer)

    def receive(self, receiver: Callable[[bytes, object], None]) -> None:
        self.arrives = receiver

    def counters(self) -> dict[str, int]:
        return {}

    def close(self) -> None:
        """Nothing to close."""


def test_twenty_thousand_datagrams_a_second_of_a_stranger_do_not_reach_the_machine() -> None:
    assert run_virtual(flooded(stranger="stranger")) == (True, True)


def test_a_flood_from_ever_other_ports_is_bounded_as_one() -> None:
    assert run_virtual(flooded(stranger="")) == (True, True)


def test_words_of_the_autopilot_itself_by_the_thousand_take_nothing_from_its_telemetry() -> None:
    """STATUSTEXT from its own port: a firmware gone mad, or somebody who writes its address."""
    words = dialect.MAVLink_statustext_message(3, b"boom").pack(dialect.MAVLink(None, 2, 1))
    assert run_virtual(flooded(stranger="autopilot", flood=bytes(words))) == (True, True)


def test_kinds_that_nobody_reads_and_bytes_that_are_no_frames_share_one_bound() -> None:
    for flood in (b"\xfd" * 300, b"\x00" * 20, bytes.fromhex("fd0900000002017b4c00") + bytes(11)):
        assert run_virtual(flooded(stranger="autopilot", flood=flood)) == (True, True)


async def flooded(stranger: str, flood: bytes = b"") -> tuple[bool, bool]:
    """(the flood was bounded and counted, every heartbeat of the autopilot counted)."""
    loop = asyncio.get_running_loop()
    assert isinstance(loop, VirtualLoop)
    link = ScriptedLink()
    agent = Agent(AgentConfig(id=2), loop.clock, [link], MemoryBroker().connect(), Equipment())  # type: ignore[list-item]
    passed: Counter[bytes] = Counter()
    feed = agent.feed

    def spy(event: AnyEvent) -> None:
        if isinstance(event, LinkBytes):
            passed[event.data] += 1
        feed(event)

    agent.feed = spy  # type: ignore[method-assign]
    running = asyncio.create_task(agent.run())
    await asyncio.sleep(0.1)
    other = flood or Sender(9, 1).pack(OwnHeartbeat(), EPOCH_NS)
    autopilot = Sender(2, 1)
    link.arrives(beat := autopilot.pack(OwnHeartbeat(), EPOCH_NS), "autopilot")
    await asyncio.sleep(1.5)  # the agent's own heartbeat shows the shell whom it sends to
    passed.clear()
    beats = 0
    for n in range(FLOOD_HZ * SECONDS // 100):
        for k in range(100):
            link.arrives(other, stranger or n * 100 + k)
        if n % 40 == 0:
            beats += 1
            link.arrives(beat, "autopilot")
        await asyncio.sleep(100 / FLOOD_HZ)
    limited = agent._link_limit.limited["autopilot" if stranger == "autopilot" else "link"]
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    most = FROM_OTHERS.burst + FROM_OTHERS.per_s * (SECONDS + 0.1)
    return passed[other] <= most and limited >= FLOOD_HZ * SECONDS - most, passed[beat] == beats
