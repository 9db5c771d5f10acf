"""What a ground station hears on its port without a word: enough to list and place every vehicle."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import Hashable

import pytest

from onboard.game.scenario import Kind
from onboard.runtime.links import open_udp
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from tests.support.flown_autopilot import FLOWN
from tests.support.real_time import until
from tests.support.udp_fleet import HOST, fleet

pytestmark = [pytest.mark.real, pytest.mark.timeout(60)]
KINDS = pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
NEEDED = {
    "HEARTBEAT",
    "SYS_STATUS",
    "GPS_RAW_INT",
    "GLOBAL_POSITION_INT",
    "ATTITUDE",
    "VFR_HUD",
    "EXTENDED_SYS_STATE",
}


class Listener:
    """A port, and the kinds of messages heard there by system id."""

    def __init__(self) -> None:
        self.heard: dict[int, set[str]] = defaultdict(set)
        self.framers: dict[Hashable, Framer] = defaultdict(Framer)

    def take(self, data: bytes, peer: Hashable) -> None:
        for packet in self.framers[peer].feed(data):
            self.heard[packet.system].add(packet.name)

    @property
    def bad(self) -> int:
        return sum(sum(framer.causes.values()) for framer in self.framers.values())


@KINDS
async def test_agents_and_ground_stations_ports_hear_all_that_lists_a_vehicle(kind: Kind) -> None:
    agents, ground = [await open_udp(HOST, 0) for _ in range(3)], await open_udp(HOST, 0)
    ears = [Listener() for _ in range(4)]
    for link, ear in zip([*agents, ground], ears, strict=True):
        link.receive(ear.take)
    try:
        async with fleet(kind, [[agent.address[1], ground.address[1]] for agent in agents]) as vehicles:
            together = ears[3]
            await until(lambda: all(together.heard[id] >= NEEDED for id in (1, 2, 3)))
            for id, ear in zip((1, 2, 3), ears[:3], strict=True):
                assert set(ear.heard) == {id}
                assert ear.heard[id] >= NEEDED
            # It speaks up without a word of welcome, and is answered on every port.
            command = dialect.MAVLink_command_long_message(2, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0)
            ground.send(DialectSender(255, 190).pack(command), vehicles.address(2))
            await until(lambda: "AUTOPILOT_VERSION" in together.heard[2])
            await asyncio.sleep(0.1)
            assert "AUTOPILOT_VERSION" not in together.heard[1] | together.heard[3]
            assert sum(ear.bad for ear in ears) == 0
    finally:
        for link in [*agents, ground]:
            link.close()
