"""The child process that MAVSDK lives in: `python -m onboard.autopilot.mavsdk_child URL SYSTEM`.

Reads lines of `mavsdk.LINE` from standard input, says notes on standard output. When no fresh setpoint has
come for 200 ms, or its input ends, it stops offboard (if that is still on) and exits: 3 for silence, 0 for
the end of its input, 4 where no autopilot was found. A setpoint older than that is not fresh: what has waited
in the pipe while this process stood still does not count.
"""

from __future__ import annotations

import asyncio
import os
import sys
from typing import Any

from onboard.autopilot.mavsdk import ENTER, HOLD, LAND, LINE, RELEASE, RETURN, SETPOINT, SILENCE

STREAM_BEFORE = 1.2  # [s] of setpoints before offboard is started
RETRY = 0.5  # [s] between two tries to start
FAREWELL = 1.0  # [s] for stopping offboard before the process ends in any case
LOOK = 0.02  # [s] between two looks at the age of the last setpoint


def say(severity: str, kind: str, text: str) -> None:
    """A note for the parent; lost where it no longer listens."""
    try:
        os.write(1, f"{severity} {kind} {text}\n".encode().replace(b"\n", b" ", text.count("\n")))
    except OSError:
        return


class Feeder:
    """Orders in, MAVSDK calls out."""

    def __init__(self, offboard: Any, action: Any, velocity: type[Any]) -> None:
        self._offboard = offboard
        self._action = action
        self._velocity = velocity
        self._order = b""
        self._target: tuple[float, float, float, float] | None = None
        self._last = 0.0  # [s, monotonic] of the last fresh setpoint
        self._since = 0.0  # … of the first one of this stream; 0 = none
        self._wake = asyncio.Event()

    def hear(self, line: bytes, now: float) -> bool:
        """Take one line; False for the order to go without touching the mode."""
        what, at, *target = LINE.unpack(line)
        if what == SETPOINT:
            if now - at <= SILENCE:
                self._last = at
                self._since = self._since or at
                self._target = (target[0], target[1], target[2], target[3])
        elif what != RELEASE:
            self._order = what
        self._wake.set()
        return bool(what != RELEASE)

    def silent(self, now: float) -> bool:
        """Whether a stream has begun and fresh setpoints have ceased."""
        return self._since > 0.0 and now - self._last > SILENCE

    async def work(self) -> None:
        """Set the latest velocity; start and leave offboard as ordered."""
        loop = asyncio.get_running_loop()
        next_try = 0.0
        while True:
            await self._wake.wait()
            self._wake.clear()
            target, self._target = self._target, None
            if target is not None and self._order in (b"", ENTER):
                await self._offboard.set_velocity_ned(self._velocity(*target))
            now = loop.time()
            streamed = self._since > 0.0 and now - self._since >= STREAM_BEFORE
            if self._order == ENTER and streamed and now >= next_try:
                next_try = now + RETRY
                try:
                    await self._offboard.start()
                    self._order = b""
                    say("info", "mavsdk", "offboard started")
                except Exception as error:
                    say("warning", "mavsdk_refused", str(error))
            elif self._order in (HOLD, RETURN, LAND):
                order, self._order, self._since = self._order, b"", 0.0
                await self.leave(order)

    async def leave(self, order: bytes) -> None:
        """Hold, return or land; the parent repeats the order until the heartbeat reports it."""
        try:
            if order == RETURN:
                await self._action.return_to_launch()
            elif order == LAND:
                await self._action.land()
            elif await self._offboard.is_active():
                await self._offboard.stop()
            else:
                await self._action.hold()
        except Exception as error:
            say("warning", "mavsdk_refused", str(error))

    async def stop(self) -> None:
        """Stop offboard if it is on; the vehicle holds."""
        try:
            async with asyncio.timeout(FAREWELL):
                if await self._offboard.is_active():
                    await self._offboard.stop()
        except Exception as error:
            say("error", "mavsdk_refused", f"stopping offboard: {error}")


async def next_line(reader: asyncio.StreamReader) -> bytes:
    """The next line, or nothing at the end of input."""
    try:
        return await reader.readexactly(LINE.size)
    except (asyncio.IncompleteReadError, OSError):
        return b""


async def serve(url: str, system_id: int) -> int:
    """Connect, then follow orders until silence or the end of input; the exit code."""
    from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
    from mavsdk.asyncio.plugins.action import ActionAsync
    from mavsdk.asyncio.plugins.offboard import OffboardAsync, VelocityNedYaw

    loop = asyncio.get_running_loop()
    reader = asyncio.StreamReader()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    configuration = Configuration.create_with_component_type(ComponentType.COMPANION_COMPUTER)
    configuration.system_id = system_id
    mavsdk = Mavsdk(configuration)
    await mavsdk.add_any_connection(url)
    system = await mavsdk.first_autopilot(timeout_s=10.0)
    if system is None:
        say("error", "mavsdk", f"no autopilot at {url}")
        return 4
    feeder = Feeder(OffboardAsync(system), ActionAsync(system), VelocityNedYaw)
    say("info", "mavsdk", f"connected to {url}")
    code, touch = 0, True
    async with asyncio.TaskGroup() as group:
        work = group.create_task(feeder.work())
        reading = group.create_task(next_line(reader))
        while True:
            await asyncio.wait((reading,), timeout=LOOK)
            if reading.done():
                line = reading.result()
                touch = line == b"" or feeder.hear(line, loop.time())
                if line == b"" or not touch:
                    break
                reading = group.create_task(next_line(reader))
            if feeder.silent(loop.time()):
                code = 3
                break
        reading.cancel()
        work.cancel()
    if touch:
        await feeder.stop()
    say("info" if code == 0 else "error", "mavsdk", "ended" if code == 0 else "no setpoint for 200 ms: ended")
    return code


def main() -> None:
    """The process; it ends at once, whatever threads MAVSDK still has."""
    try:
        code = asyncio.run(serve(sys.argv[1], int(sys.argv[2])))
    except ImportError:
        say("error", "mavsdk", "not installed: pip install 'apollonius[mavsdk]'")
        code = 5
    except Exception as error:
        say("error", "mavsdk", str(error))
        code = 1
    os._exit(code)


if __name__ == "__main__":
    main()
