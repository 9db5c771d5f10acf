"""Stages on which one story plays over either bus: in memory on virtual time, over Zenoh for real."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Awaitable, Callable
from typing import Protocol

import pytest

from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.loop import run_virtual
from onboard.runtime.protocols import Bus, Sample
from tests.support.real_time import patience


class Stage(Protocol):
    """A bus that can be joined, killed and brought back."""

    async def connect(self) -> Bus: ...

    async def kill(self) -> None: ...

    async def restore(self) -> None: ...

    async def strike(self) -> None: ...


class MemoryStage:
    def __init__(self, up: bool) -> None:
        self.broker = MemoryBroker()
        self.broker.up = up

    async def connect(self) -> Bus:
        return self.broker.connect()

    async def kill(self) -> None:
        self.broker.kill()

    async def restore(self) -> None:
        self.broker.restore()

    async def strike(self) -> None:
        for bus in list(self.broker.buses):
            await bus.close()


class ZenohStage:
    def __init__(self) -> None:
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self._router: ZenohBus | None = None
        self._buses: list[ZenohBus] = []

    async def connect(self) -> Bus:
        bus = await open_zenoh(self.endpoint)
        self._buses.append(bus)
        return bus

    async def kill(self) -> None:
        assert self._router is not None
        await self._router.close()

    async def restore(self) -> None:
        self._router = await open_zenoh(self.endpoint, listen=True)
        assert self._router.how == "listening"

    async def strike(self) -> None:
        for bus in self._buses:
            await bus.close()
        if self._router is not None:
            await self._router.close()


def free_port() -> int:
    """A TCP port that is free now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def both_buses(
    *, up: bool = True
) -> Callable[[Callable[[Stage], Awaitable[None]]], Callable[[str], None]]:
    """Make two tests of a story: over the memory bus and over Zenoh. `up`: the broker is there at start."""

    def make(story: Callable[[Stage], Awaitable[None]]) -> Callable[[str], None]:
        async def play(stage: Stage) -> None:
            try:
                if up and isinstance(stage, ZenohStage):
                    await stage.restore()
                async with asyncio.timeout(patience(20.0)):
                    await story(stage)
            finally:
                await stage.strike()

        def test(bus: str) -> None:
            if bus == "memory":
                run_virtual(play(MemoryStage(up)))
            else:
                asyncio.run(play(ZenohStage()))

        test.__name__, test.__doc__, test.__module__ = story.__name__, story.__doc__, story.__module__
        buses = ["memory", pytest.param("zenoh", marks=pytest.mark.real)]
        return pytest.mark.parametrize("bus", buses)(test)

    return make


class Heard:
    """What one subscriber heard, in order."""

    def __init__(self, bus: Bus, pattern: str) -> None:
        self.samples: list[Sample] = []
        self.subscription = bus.subscribe(pattern, self.samples.append)

    @property
    def payloads(self) -> list[bytes]:
        return [sample.payload for sample in self.samples]
