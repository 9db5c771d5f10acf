"""`sim-bridge accept`: fly the acceptance stories against a reachable autopilot and its simulated twin.

Each story is announced and flown after a person's consent; whatever happens, the vehicle is left in the mode
in which it can be left. All frames of the flight, both ways, go into a .tlog.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Clock, Link
from onboard.wire.mavlink.tlog import TlogWriter
from sim_bridge.vehicle.acceptance.companion import Companion
from sim_bridge.vehicle.acceptance.stories import PARAMETERS, Note, Pause, Story, holding_mode, stories
from sim_bridge.vehicle.acceptance.twin import PLAYED, Begun, Twin, begun

TICK_S = 0.02
HEARD_WITHIN_S = 10.0  # the autopilot's first heartbeat
SETTLE_S = 4.0  # for streams and parameters
LOW = 10.0  # [m] above home: stories are flown above this only
Confirm = Callable[[str], bool]
Say = Callable[[str], None]


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """What `accept` can be told."""

    tlog: Path = Path("accept.tlog")
    only: tuple[str, ...] = ()  # names of the stories to fly; none: all
    yes: bool = False  # fly every story without asking


class Row(NamedTuple):
    """One line of the table."""

    story: str
    what: str
    real: str
    twin: str
    same: bool


def accept(url: str, options: Options, say: Say, confirm: Confirm) -> list[Row]:
    """Fly the stories against the autopilot at a link's URL; the table's rows.

    Raises ConfigError: a link that cannot be, nobody heard, a vehicle without stories or too low to fly them.
    """
    return asyncio.run(accept_on(url, options, say, confirm))


async def accept_on(
    url: str, options: Options, say: Say, confirm: Confirm, clock: Clock | None = None
) -> list[Row]:
    """`accept` on the running loop."""
    clock = clock or RealClock()
    try:
        log = options.tlog.open("xb")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ConfigError(f"{options.tlog}: {reason}; expected a new file for the log") from None
    with log:
        link = await open_link(url)
        flight = Flight(link, clock, TlogWriter(log))
        try:
            return await _fly(flight, url, options, say, confirm)
        finally:
            link.close()


class Flight:
    """A companion on a real link, in real time."""

    def __init__(self, link: Link, clock: Clock, log: TlogWriter) -> None:
        self.companion = Companion()
        self._link = link
        self._clock = clock
        self._log = log
        self._begun_ns = clock.monotonic_ns()
        link.receive(self._arrived)

    async def wait(self, pause: Pause) -> None:
        """Let time pass as a pause says."""
        end_ns = self._clock.monotonic_ns() + round(pause.seconds * NS_PER_S)
        while self._clock.monotonic_ns() < end_ns and not (pause.until is not None and pause.until()):
            self._tick()
            await asyncio.sleep(TICK_S)

    async def ask(self, confirm: Confirm, question: str) -> bool:
        """Ask a person, and go on beating meanwhile."""
        answer = asyncio.create_task(asyncio.to_thread(confirm, question))
        while not answer.done():
            self._tick()
            await asyncio.sleep(TICK_S)
        return answer.result()

    async def fly(self, story: Story) -> list[Note]:
        """Fly one story to its end; what it saw."""
        notes: list[Note] = []
        for pause in story.fly(self.companion, notes):
            await self.wait(pause)
        return notes

    async def leave(self) -> None:
        """Leave the vehicle in the mode in which it can be left."""
        companion = self.companion
        companion.target, companion.beats = None, True
        mode = holding_mode(companion)
        for _ in range(5):
            companion.order_mode(mode)
            await self.wait(Pause(1.2, lambda: companion.mode == mode))
            if companion.mode == mode:
                return

    def _tick(self) -> None:
        self.companion.tick((self._clock.monotonic_ns() - self._begun_ns) / NS_PER_S)
        for frame in self.companion.outgoing():
            self._log.write(self._clock.wall_ns(), frame)
            self._link.send(frame)

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        for frame in self.companion.receive(data, peer):
            self._log.write(self._clock.wall_ns(), frame)


async def _fly(flight: Flight, url: str, options: Options, say: Say, confirm: Confirm) -> list[Row]:
    found, chosen = await _found(flight, url, options)
    twin = Twin(found)
    twin.settle(SETTLE_S)
    stick = "no transmitter is heard" if found.throttle is None else f"throttle stick at {found.throttle:.0%}"
    say(f"{found.kind.value}, system {found.system}, {found.height:.0f} m above home; {stick}")
    rows: list[Row] = []
    try:
        for story in chosen:
            say(story.announcement)
            if not options.yes and not await flight.ask(confirm, f"Fly '{story.name}'?"):
                say("not flown")
                continue
            real = await flight.fly(story)
            rows += compared(story.name, real, twin.fly(story))
    finally:
        await flight.leave()
    return rows


async def _found(flight: Flight, url: str, options: Options) -> tuple[Begun, list[Story]]:
    """What the link leads to, and the stories to be flown there."""
    companion = flight.companion
    await flight.wait(Pause(HEARD_WITHIN_S, lambda: companion.system != 0))
    if companion.system == 0:
        raise ConfigError(
            f"{url}: no autopilot was heard within {HEARD_WITHIN_S:g} s, expected its HEARTBEAT"
        )
    if companion.kind not in PLAYED:
        raise ConfigError(f"{url}: found {companion.kind.value}, expected one of "
                          + ", ".join(kind.value for kind in PLAYED))  # fmt: skip
    known = stories(companion.kind)
    names = [story.name for story in known]
    unknown = [name for name in options.only if name not in names]
    if unknown:
        raise ConfigError(f"--only: found {unknown[0]}, expected one of {', '.join(names)}")
    companion.ask_streams()
    for name in PARAMETERS[companion.kind]:
        companion.ask_parameter(name)
    await flight.wait(Pause(SETTLE_S))
    height = companion.height
    if not companion.armed or height is None or height < LOW:
        where = "unknown" if height is None else f"{height:.1f} m above home"
        raise ConfigError(
            f"{url}: found height {where}, {'armed' if companion.armed else 'disarmed'}; expected a vehicle "
            f"that flies more than {LOW:g} m above home (or is told so, on the bench)"
        )
    return begun(companion), [s for s in known if not options.only or s.name in options.only]


def compared(story: str, real: list[Note], twin: list[Note]) -> list[Row]:
    """One row for each thing that either of them saw."""
    ours = {note.what: note for note in twin}
    theirs = {note.what: note for note in real}
    rows = []
    for what in dict.fromkeys([note.what for note in real + twin]):
        a, b = theirs.get(what), ours.get(what)
        if a is None or b is None:
            same = False
        elif isinstance(a.value, str) or isinstance(b.value, str):
            same = a.value == b.value
        else:
            same = abs(a.value - b.value) <= a.within
        rows.append(Row(story, what, _words(a), _words(b), same))
    return rows


def _words(note: Note | None) -> str:
    if note is None:
        return "not seen"
    return note.value if isinstance(note.value, str) else f"{note.value:.1f}"


def table(rows: list[Row]) -> str:
    """The table as text, a star at each line that differs."""
    lines = [("", "story", "what", "real", "simulated twin")]
    lines += [("" if row.same else "*", row.story, row.what, row.real, row.twin) for row in rows]
    widths = [max(len(line[i]) for line in lines) for i in range(5)]
    return "\n".join(
        "  ".join(cell.ljust(w) for cell, w in zip(line, widths, strict=True)).rstrip() for line in lines
    )
