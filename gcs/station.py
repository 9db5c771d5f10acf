"""The station on the bus: hears everything, keeps the watch, carries commands. The thin shell.

All that is heard goes through `feed`, in order, into the watch and to the taps (a recorder, a printer);
what the station itself does goes the same way as journal entries.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from uuid import uuid4

from gcs.picture import journal
from gcs.picture.alert_rules import Thresholds
from gcs.picture.commands import Courier
from gcs.picture.values import Picture
from gcs.picture.watch import GRID_NS, Watch
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Bus, Clock, Sample, Subscription
from onboard.wire.bus import topics
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, Role, Severity

Tap = Callable[[str, bytes, int], None]  # key, payload, now_ns


class SteadyTime:
    """Wall time at the start, advanced by the monotonic clock: it never jumps."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._offset_ns = clock.wall_ns() - clock.monotonic_ns()

    def now_ns(self) -> int:
        """The instant [ns since the epoch]."""
        return self._clock.monotonic_ns() + self._offset_ns


class Station:
    """A ground station on a bus. `run` it as a task; look with `picture`.

    `operator` signs the commands; `version` is compared with the agents'; `new_id` makes command ids.
    """

    def __init__(
        self,
        bus: Bus,
        clock: Clock,
        game: str,
        *,
        operator: str = "gcs",
        limits: Thresholds | None = None,
        version: str = "",
        new_id: Callable[[], str] = lambda: uuid4().hex[:12],
    ) -> None:
        self.game = game
        self.operator = operator
        self.watch = Watch(game, limits, version)
        self.bus = bus
        self._time = SteadyTime(clock)
        self._new_id = new_id
        self._taps: list[Tap] = []
        self._overflow = 0
        self._heard: list[Subscription] = []
        self._courier = Courier(bus, game, self.watch.book, self.now_ns, self._on_reply)

    def now_ns(self) -> int:
        """The station's time [ns since the epoch; steady]."""
        return self._time.now_ns()

    def tap(self, tap: Tap) -> None:
        """Let `tap` see all that is fed from now on."""
        self._taps.append(tap)

    def feed(self, key: str, payload: bytes) -> None:
        """Take in one message, now."""
        now_ns = self.now_ns()
        self.watch.apply(key, payload, now_ns)
        for tap in self._taps:
            tap(key, payload, now_ns)

    def note(self, name: str, payload: bytes) -> None:
        """Take in an entry of the own journal."""
        self.feed(journal.key(self.game, name), payload)

    def picture(self) -> Picture:
        """The picture now."""
        return self.watch.picture(self.now_ns())

    def open(self) -> None:
        """Begin to listen."""
        self._heard.append(self.bus.subscribe(topics.everything(self.game), self._on_sample, every=True))
        self._heard.append(self.bus.presence(topics.key(self.game, topics.ALIVE), self._on_token))

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

    def command(self, kind: CommandKind, ids: Iterable[int]) -> str:
        """Give a command to vehicles; its id. It is repeated until each has confirmed."""
        now_ns = self.now_ns()
        order = Command(self._new_id(), kind, self.operator, now_ns)
        self.note("sent", journal.SENT.encode(journal.Sent(order, tuple(sorted(set(ids))))))
        self._courier.wake()
        return order.command_id

    def ids(self, role: Role | None = None) -> tuple[int, ...]:
        """All vehicles heard or expected, or those of a role."""
        vehicles = self.watch.fleet.vehicles(self.now_ns())
        return tuple(v.id for v in vehicles if role is None or v.role is role)

    def acknowledge(self, alert: str) -> None:
        """The operator has seen an alert; "" = all."""
        entry = journal.Acknowledged(alert, self.operator)
        self.note("acknowledged", journal.ACKNOWLEDGED.encode(entry))

    def remark(self, severity: Severity, kind: str, text: str, advice: str = "", over: bool = False) -> None:
        """Say something in the log; a warning or an error with advice is an alert until it is over."""
        entry = journal.Remark(severity, kind, text, advice, over)
        self.note("remark", journal.REMARK.encode(entry))

    def _on_sample(self, sample: Sample) -> None:
        if sample.key.split("/")[2:3] == ["gcs"]:
            return  # the journal is the station's own: nobody else writes in it
        self.feed(sample.key, sample.payload)

    def _on_token(self, key: str, alive: bool) -> None:
        self.note("presence", journal.PRESENCE.encode(journal.Presence(key, alive)))

    def _on_reply(self, reply: CommandReply) -> None:
        known = self.watch.book.state(reply.command_id, reply.id)
        if known != (reply.state, reply.reason, reply.mode):  # repeated answers are no news
            self.note("replied", journal.REPLIED.encode(journal.Replied(reply)))

    async def _tick(self) -> None:
        while True:
            self.watch.tick(self.now_ns())
            self._count_overflow()
            await asyncio.sleep(GRID_NS / NS_PER_S)

    def _count_overflow(self) -> None:
        overflow = self.bus.counters().get("overflow", 0)
        grew = overflow > self._overflow
        if grew != ("overflow" in self.watch.remarks):
            self.remark(
                Severity.ERROR,
                "overflow",
                f"{overflow} messages were lost here: this computer does not keep up",
                "close other programs, or watch fewer vehicles from here",
                over=not grew,
            )
        self._overflow = overflow

