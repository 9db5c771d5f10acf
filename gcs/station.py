"""The station on the bus: hears everything, keeps the picture, carries commands. The thin shell.

All that is heard goes through `feed`, in order, into the picture's reducer, then as bytes to the taps (a
recorder) and decoded to the hearers (the field's master); what the station itself does goes the same way
as entries of its journal.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import NamedTuple
from uuid import uuid4

from gcs.picture import station_journal
from gcs.picture.courier import Courier
from gcs.picture.reducer import GRID_NS, PictureReducer
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Picture
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Bus, Clock, Sample, Subscription
from onboard.wire.bus.codec import M
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, Role, Severity
from onboard.wire.bus.topics import ALIVE, DEFAULT_GAME, ROOT, Heard, Topic, everything

Tap = Callable[[str, bytes, int], None]  # key, payload, now_ns
Hearer = Callable[[Heard, int], None]  # what was heard, now_ns


LATE_S = 0.3  # a tick of 0.1 s that comes later than this shows an overloaded computer
LATE_FOR_NS = 5 * NS_PER_S  # and for so long it is said
NAME = "gcs"  # of a station without a certificate


class SteadyTime:
    """Wall time at the start, advanced by the monotonic clock: it never jumps."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._offset_ns = clock.wall_ns() - clock.monotonic_ns()

    def now_ns(self) -> int:
        """The instant [ns since the epoch]."""
        return self._clock.monotonic_ns() + self._offset_ns


class StationSetup(NamedTuple):
    """Which game a station watches, and as whom."""

    game: str = DEFAULT_GAME
    operator: str = "gcs"  # signs the commands
    version: str = ""  # of this program, compared with the agents'; "" = not compared
    limits: Thresholds = Thresholds()  # when alerts are raised
    member: str = NAME  # who this station is on the bus: with keys, the name in its certificate


class Station:
    """A ground station on a bus. `run` it as a task; look with `picture`. `new_id` makes command ids."""

    def __init__(
        self,
        bus: Bus,
        clock: Clock,
        setup: StationSetup,
        new_id: Callable[[], str] = lambda: uuid4().hex[:12],
    ) -> None:
        self.game = setup.game
        self.operator = setup.operator
        self.member = setup.member
        self.reducer = PictureReducer(setup.game, setup.limits, setup.version)
        self.bus = bus
        self._time = SteadyTime(clock)
        self._new_id = new_id
        self._taps: list[Tap] = []
        self._hearers: list[Hearer] = []
        self._journal = f"{ROOT}/{self.game}/{station_journal.FOLDER}/"
        self._overflow = 0
        self._late_ns: int | None = None  # when this computer was last late with its own work
        self._latest_s = 0.0
        self._limited: dict[str, int] = {}  # what was over a bound, by kind
        self._heard: list[Subscription] = []
        self._courier = Courier(
            bus, self.game, self.reducer.book, self.now_ns, self._on_reply, self.give_also
        )

    def now_ns(self) -> int:
        """The station's time [ns since the epoch; steady]."""
        return self._time.now_ns()

    def tap(self, tap: Tap) -> None:
        """Let `tap` see all that is fed from now on."""
        self._taps.append(tap)

    @contextmanager
    def heard_by(self, hearer: Hearer) -> Iterator[None]:
        """Let `hearer` have every good message that is fed within the block, decoded."""
        self._hearers.append(hearer)
        try:
            yield
        finally:
            self._hearers.remove(hearer)

    def feed(self, key: str, payload: bytes) -> None:
        """Take in one message, now."""
        now_ns = self.now_ns()
        heard = self.reducer.apply(key, payload, now_ns)
        for tap in self._taps:
            tap(key, payload, now_ns)
        if heard is not None:
            for hearer in tuple(self._hearers):
                hearer(heard, now_ns)

    def note(self, topic: Topic[M], entry: M) -> None:
        """Take in an entry of the own journal, now."""
        self.feed(topic.key(self.game), topic.encode(entry))

    def picture(self) -> Picture:
        """The picture now."""
        return self.reducer.picture(self.now_ns())

    def open(self) -> None:
        """Begin to listen."""
        self._heard.append(self.bus.subscribe(everything(self.game), self._on_sample, every=True))
        self._heard.append(self.bus.presence(ALIVE.key(self.game), self._on_token))

    def close(self) -> None:
        """Stop listening; idempotent. The bus stays open: it is its owner's."""
        for subscription in self._heard:
            subscription.close()
        self._heard.clear()

    async def run(self) -> None:
        """Listen and carry commands until cancelled."""
        if not self._heard:
            self.open()
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._courier.run())
                tasks.create_task(self._tick())
        finally:
            self.close()

    def abort_everybody(self) -> str:
        """Abort all that are known, and whoever else answers a call to all agents; the command's id."""
        order = Command(self._new_id(), CommandKind.ABORT, self.operator, self.now_ns())
        self.note(station_journal.SENT, station_journal.Sent(order, self.ids(), everybody=True))
        self._courier.wake()
        return order.command_id

    def give_also(self, command_id: str, id: int) -> None:
        """Give a command of `abort_everybody` to a vehicle that is only known now."""
        order = self.reducer.book.call_found(command_id, id)
        if order is not None:
            self.note(station_journal.SENT, station_journal.Sent(order, (id,)))
            self._courier.wake()

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        """Give a command to vehicles; its id. It is repeated until each has confirmed.

        `named`: a person has named the one vehicle, and confirms the mode that is shown of it.
        """
        now_ns = self.now_ns()
        whom = tuple(sorted(set(ids)))
        mode = self._shown_mode(whom[0]) if named and len(whom) == 1 else ""
        order = Command(self._new_id(), kind, self.operator, now_ns, mode)
        self.note(station_journal.SENT, station_journal.Sent(order, whom))
        self._courier.wake()
        return order.command_id

    def _shown_mode(self, id: int) -> str:
        vehicles = self.reducer.fleet.vehicles(self.now_ns())
        return next((v.mode for v in vehicles if v.id == id), "")

    def ids(self, role: Role | None = None) -> tuple[int, ...]:
        """All vehicles heard or expected, or those of a role."""
        vehicles = self.reducer.fleet.vehicles(self.now_ns())
        return tuple(v.id for v in vehicles if role is None or v.role is role)

    def acknowledge(self, alert: str) -> None:
        """The operator has seen an alert; "" = all."""
        entry = station_journal.Acknowledged(alert, self.operator)
        self.note(station_journal.ACKNOWLEDGED, entry)

    def remark(self, severity: Severity, kind: str, text: str, advice: str = "", over: bool = False) -> None:
        """Say something in the log; a warning or an error with advice is an alert until it is over."""
        entry = station_journal.Remark(severity, kind, text, advice, over)
        self.note(station_journal.REMARK, entry)

    def _on_sample(self, sample: Sample) -> None:
        if sample.key.startswith(self._journal):
            return  # the journal is the station's own: nobody else writes in it
        self.feed(sample.key, sample.payload)

    def _on_token(self, key: str, alive: bool) -> None:
        self.note(station_journal.PRESENCE, station_journal.Presence(key, alive))

    def _on_reply(self, reply: CommandReply) -> None:
        if not self.reducer.book.knows(reply):  # repeated answers are no news
            self.note(station_journal.REPLIED, station_journal.Replied(reply))

    async def _tick(self) -> None:
        due_ns = self.now_ns()
        while True:
            late_s = (self.now_ns() - due_ns) / NS_PER_S
            self._watch_lateness(late_s)
            self.reducer.tick(self.now_ns())
            self._count_overflow()
            self._count_floods()
            due_ns = self.now_ns() + GRID_NS
            await asyncio.sleep(GRID_NS / NS_PER_S)

    def _watch_lateness(self, late_s: float) -> None:
        """Say while this computer is late with its own work: what looks lost then need not be."""
        now_ns = self.now_ns()
        if late_s >= LATE_S:
            self._late_ns, self._latest_s = now_ns, max(self._latest_s, late_s)
        late = self._late_ns is not None and now_ns - self._late_ns < LATE_FOR_NS
        if late != ("overloaded" in self.reducer.remarks):
            self.remark(
                Severity.WARNING,
                "overloaded",
                f"this computer was late by {self._latest_s:.1f} s: what looks lost or old may be its doing, "
                "not the radio's",
                "close other programs; the vehicles do not depend on it",
                over=not late,
            )
        if not late:
            self._latest_s = 0.0

    def _count_overflow(self) -> None:
        overflow = self.bus.counters().get("overflow", 0)
        grew = overflow > self._overflow
        if grew != ("overflow" in self.reducer.remarks):
            self.remark(
                Severity.ERROR,
                "overflow",
                f"{overflow} messages were lost here: this computer does not keep up",
                "close other programs, or watch fewer vehicles from here",
                over=not grew,
            )
        self._overflow = overflow

    def _count_floods(self) -> None:
        """Say while somebody brings more than the bus lets through."""
        limited = {k: n for k, n in self.bus.counters().items() if k.startswith("limited_")}
        grew = [kind for kind, n in limited.items() if n > self._limited.get(kind, 0)]
        if bool(grew) != ("flood" in self.reducer.remarks):
            kinds = ", ".join(f"{kind.removeprefix('limited_')} {limited[kind]}" for kind in sorted(grew))
            self.remark(
                Severity.WARNING,
                "flood",
                f"more comes than may: {kinds} left out",
                "find who sends it; revoke its key (docs/security.md)",
                over=not grew,
            )
        self._limited = limited
