"""A ground station at work: bus, station, recorder and whatever else runs beside them, under one owner."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from gcs.console.source import LIVE_HINT, Key
from gcs.picture.values import Picture
from gcs.settings import Settings
from gcs.station import NAME, Station, StationSetup
from onboard.config.version import version
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_security import BusSecurity, Lock, security_of
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.clock import RealClock
from onboard.wire.bus.messages import CommandKind, LinkLock, Severity
from onboard.wire.bus.topics import DEFAULT_GAME

if TYPE_CHECKING:
    from gcs.recording.shell import StationRecorder


class Session:
    """What a program of the ground station works with; it is also what a console shows."""

    title = "live"
    keys: tuple[Key, ...] = ()
    steers = True

    def __init__(
        self, bus: ZenohBus, station: Station, recorder: StationRecorder | None, lock: BusSecurity
    ) -> None:
        self.bus = bus
        self.lock = lock
        self.station = station
        self.recorder = recorder
        self.extra: Callable[[], str] = str  # the master's line, where there is one
        self.leaving = "leave the console? vehicles fly on"

    def picture(self) -> Picture:
        """The picture now."""
        return self.station.picture()

    def status(self) -> str:
        """The lock, the bus and the recording in a line, what matters most first."""
        parts = [self.lock.short, self.extra(), self.bus.status(), self._links()]
        if self.recorder is not None:
            status = self.recorder.status()
            parts.append(f"recording {status.size / 1e6:.1f} MB" if not status.trouble else "NOT RECORDING")
        return ", ".join(part for part in parts if part)

    def hint(self) -> str:
        """The keys that matter most."""
        return LIVE_HINT

    def nobody(self) -> tuple[str, ...]:
        """Where it listens, and what to start."""
        game = self.station.game
        named = "" if game == DEFAULT_GAME else f" --game {game}"
        return (
            f"game {game}: {self.bus.status()}",
            f"a game in software: sim-bridge serve demo{named}, and agents beside it:",
            f"onboard-agent --id 2 --role pursuer --take-control{named}",
            "with another endpoint than the default: --bus ENDPOINT, the same for all",
        )

    def farewell(self) -> str:
        """Where the recording is, and what to do with it; "" where nothing was recorded."""
        if self.recorder is None:
            return ""
        status = self.recorder.status()
        folder = self.recorder.recorder.path.parent
        trouble = f"; NOT COMPLETE: {status.trouble}" if status.trouble else ""
        what = " | ".join(f"gcs {verb} {folder}" for verb in ("replay", "report", "export"))
        return f"recorded {status.size / 1e6:.1f} MB{trouble}: {what}"

    def _links(self) -> str:
        """How many vehicles sign their MAVLink links; "" where none does and the bus has no keys either."""
        locks = self.station.reducer.fleet.link_locks(self.station.now_ns())
        signed = locks.count(LinkLock.SIGNED)
        if not locks or (not signed and self.lock.lock is not Lock.KEYS):
            return ""
        return f"{signed} of {len(locks)} autopilot links signed"

    def act(self, action: str) -> str:
        """A live station has no keys of its own."""
        return ""

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        """Give a command; `named`: a person has named the one vehicle."""
        self.station.command(kind, ids, named=named)
        return ""

    def acknowledge(self, alert: str) -> None:
        """The operator has seen an alert."""
        self.station.acknowledge(alert)


@asynccontextmanager
async def on_air(
    settings: Settings, *, listen: bool, record: bool, versions: bool = True
) -> AsyncIterator[Session]:
    """A station on the bus, recording if asked; all of it ends with the block. Raises ConfigError.

    Without `versions` those of the agents are not compared with the own, which takes time to look up.
    """
    clock = RealClock()
    zenoh = Path(settings.bus.zenoh) if settings.bus.zenoh else None
    async with AsyncExitStack() as stack:
        lock = security_of(settings.bus.endpoint or None, zenoh, clock.wall_ns() / NS_PER_S)
        bus = await open_zenoh(settings.bus.endpoint or None, listen=listen, config_file=zenoh)
        stack.push_async_callback(bus.close)
        member = NAME if lock.member is None else lock.member.name
        shown = version() if versions else ""
        who = StationSetup(settings.game, settings.signature, shown, settings.alerts, member)
        station = Station(bus, clock, who)
        recorder = await _recorder(settings, station, stack) if record else None
        if bus.how == "joined":
            station.remark(Severity.INFO, "bus", bus.status())
        if lock.lock is Lock.OPEN:
            advice = "gcs keys init makes keys (docs/security.md)"
            station.remark(Severity.WARNING, "open_bus", "the bus is open to whoever reaches it", advice)
        station.open()
        tasks = await stack.enter_async_context(asyncio.TaskGroup())
        running = [tasks.create_task(station.run(), name="station")]
        if (listen or record) and (settings.neighbours.adsb or settings.neighbours.cot):
            from gcs.neighbours.teller import teller

            if (neighbours := await teller(station.picture, settings.neighbours, stack)) is not None:
                running.append(tasks.create_task(neighbours.run(), name="neighbours"))
        if recorder is not None:
            running.append(tasks.create_task(recorder.run(), name="recorder"))
        try:
            yield Session(bus, station, recorder, lock)
        finally:
            for task in running:
                task.cancel()


async def _recorder(settings: Settings, station: Station, stack: AsyncExitStack) -> StationRecorder:
    """What records the station into a new folder, until the stack ends."""
    from gcs.recording.shell import StationRecorder
    from onboard.runtime.file_writer import FileWriter
    from onboard.runtime.links import open_link
    from onboard.runtime.run_folder import new_run

    links = []
    for url in settings.recording.mavlink:
        link = await open_link(url)
        stack.callback(link.close)
        links.append(link)
    folder = new_run(Path(settings.recording.folder), settings.game, station.now_ns())
    recorder = StationRecorder(station, folder, links, writer=FileWriter())
    stack.callback(recorder.close)
    station.remark(Severity.INFO, "recording", f"recording into {folder}")
    return recorder
