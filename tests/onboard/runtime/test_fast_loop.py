"""The loops of real time: asyncio's, and uvloop's where it is installed (extra `fast`)."""

from __future__ import annotations

import asyncio
import importlib.util
from collections.abc import Callable

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.shell import Agent, Equipment
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.clock import RealClock
from onboard.runtime.fast_loop import grain_s, loop_factory, loop_name
from onboard.runtime.links import memory_pair
from onboard.wire.bus.messages import Role

LOOPS = ["asyncio", *(["uvloop"] if importlib.util.find_spec("uvloop") else [])]


def factory(name: str) -> Callable[[], asyncio.AbstractEventLoop]:
    made = loop_factory() if name == "uvloop" else asyncio.new_event_loop
    assert made is not None
    return made


def test_uvloop_is_taken_where_it_is_installed() -> None:
    made = loop_factory()
    assert (made is not None) is ("uvloop" in LOOPS)
    if made is not None:
        loop = made()
        assert loop_name(loop) == "uvloop"
        loop.close()


@pytest.mark.parametrize("name", LOOPS)
def test_no_timer_is_earlier_than_the_grain_says(name: str) -> None:
    async def earliest() -> float:
        loop, clock, early = asyncio.get_running_loop(), RealClock(), 0.0
        for number in range(40):
            wait = 0.001 + 0.00013 * number
            due = clock.monotonic_ns() + wait * 1e9
            fired = loop.create_future()
            loop.call_later(wait, fired.set_result, None)
            await fired
            early = max(early, (due - clock.monotonic_ns()) / 1e9 - grain_s(loop))
        return early

    with asyncio.Runner(loop_factory=factory(name)) as runner:
        assert runner.run(earliest()) <= 1e-6


@pytest.mark.parametrize("name", LOOPS)
def test_an_agent_wakes_for_what_is_due_and_not_before(name: str) -> None:
    """A timer that fires early finds nothing due, and would fire again and again until it is."""

    async def ticks() -> tuple[int, int]:
        bus = MemoryBroker().connect()
        agent = Agent(
            AgentConfig(id=2, role=Role.PURSUER), RealClock(), [memory_pair("link")[0]], bus,
            Equipment(log=lambda line: None),
        )  # fmt: skip
        early = every = 0
        tick = agent._tick

        def counted() -> None:
            nonlocal early, every
            every += 1
            early += agent.now < agent.core.next_deadline() - 1e-6
            tick()

        agent._tick = counted  # type: ignore[method-assign]
        running = asyncio.create_task(agent.run())
        await asyncio.sleep(0.8)
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
        return early, every

    with asyncio.Runner(loop_factory=factory(name)) as runner:
        early, every = runner.run(ticks())
    assert early == 0
    assert every > 5
