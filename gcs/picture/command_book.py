"""Commands to vehicles: the book of who was told what and who has confirmed. Pure, time passed in.

Confirmed means that the autopilot reports the state asked for: the agent answers `pending` until then.
Each command is repeated to each vehicle until a final answer, at most every 80 ms: at 30 % loss both
ways a retry every 0.1 s confirms six of six within 2 s in 99.98 % of trials, one every 0.5 s in 19 %.
Repeating is harmless, because agents know a command by its id. After 38 tries (3 s) the pace falls to 1 s.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from msgspec.structs import replace

from gcs.picture.values import CommandView, Leg, LegState
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, Quote
from onboard.wire.retry import CommandRetry, RetryPolicy

RETRY_NS = 80_000_000
PATIENCE = 38  # tries at that pace: 3 s
RETRY = RetryPolicy(RETRY_NS, patience=PATIENCE, slow=NS_PER_S)
# `start` and `resume` expire: a vehicle that comes back later must not set off on its own
EXPIRY_NS = 5 * NS_PER_S
KEPT = 50  # commands

ENDS_A_FLIGHT = frozenset({CommandKind.RETURN, CommandKind.LAND})  # these ask twice; abort never does
SETS_OFF = frozenset({CommandKind.START, CommandKind.RESUME})
FINAL = frozenset({LegState.CONFIRMED, LegState.REFUSED, LegState.SUPERSEDED})


class _Leg:
    __slots__ = ("command", "mode", "obeyed", "reason", "retry", "state", "took_ns")

    def __init__(self, command: Command) -> None:
        self.command = command  # with what had been heard of this vehicle when it was given
        self.state = LegState.SENT
        self.reason = ""
        self.mode = ""
        self.obeyed = ""
        self.took_ns: int | None = None  # final since
        self.retry = CommandRetry(RETRY)


class _Order:
    __slots__ = ("command", "issued_ns", "legs")

    def __init__(
        self, command: Command, ids: Iterable[int], now_ns: int, quotes: Mapping[int, Quote]
    ) -> None:
        self.command = command
        self.issued_ns = now_ns
        self.legs = {i: _Leg(replace(command, quote=quotes.get(i, Quote()))) for i in sorted(set(ids))}

    def open(self, leg: _Leg, now_ns: int) -> bool:
        return leg.state not in FINAL and not self.expired(now_ns)

    def expired(self, now_ns: int) -> bool:
        return self.command.kind in SETS_OFF and now_ns - self.issued_ns >= EXPIRY_NS


class Due(NamedTuple):
    """One request to send now."""

    id: int
    command: Command


class CommandBook:
    """Who was told what, who has answered, and what is to be sent again."""

    def __init__(self) -> None:
        self._orders: dict[str, _Order] = {}

    def issue(
        self,
        command: Command,
        ids: Iterable[int],
        now_ns: int,
        quotes: Mapping[int, Quote] = MappingProxyType({}),
    ) -> None:
        """Enter a command to `ids`, with what each quotes: fixed now, however often it is sent.

        It supersedes what is open to them, but for one thing: nothing that sets a vehicle off supersedes an
        abort that is not confirmed yet."""
        if command.command_id in self._orders:
            return
        order = _Order(command, ids, now_ns, quotes)
        for other in self._orders.values():
            for vehicle_id, leg in other.legs.items():
                if vehicle_id not in order.legs or not other.open(leg, now_ns):
                    continue
                if command.kind in SETS_OFF and other.command.kind is CommandKind.ABORT:
                    mine = order.legs[vehicle_id]
                    mine.state, mine.took_ns = LegState.REFUSED, now_ns
                    mine.reason = "an abort is not confirmed yet"
                else:
                    leg.state, leg.took_ns = LegState.SUPERSEDED, now_ns
                    leg.reason = f"by {command.kind.value}"
        self._orders[command.command_id] = order
        while len(self._orders) > KEPT:
            self._orders.pop(next(iter(self._orders)))

    def reply(self, reply: CommandReply, now_ns: int) -> None:
        """Enter an answer. Late ones of a leg that is final change nothing."""
        order = self._orders.get(reply.command_id)
        leg = order.legs.get(reply.id) if order else None
        if order is None or leg is None or leg.state in FINAL:
            return
        leg.state = LegState(reply.state.value)
        leg.reason, leg.mode, leg.obeyed = reply.reason, reply.mode, reply.obeyed
        if leg.state in FINAL:
            leg.took_ns = now_ns

    def knows(self, reply: CommandReply) -> bool:
        """Whether state, reason and mode of an answer are what the book has of its leg already."""
        order = self._orders.get(reply.command_id)
        leg = order.legs.get(reply.id) if order else None
        found = (leg.state.value, leg.reason, leg.mode) if leg else None
        return found == (reply.state.value, reply.reason, reply.mode)

    def due(self, now_ns: int) -> list[Due]:
        """What is to be sent now; counts as sent."""
        found = []
        for order in self._orders.values():
            for vehicle_id, leg in order.legs.items():
                if order.open(leg, now_ns) and leg.retry.due(now_ns):
                    found.append(Due(vehicle_id, leg.command))
        return found

    def busy(self, now_ns: int) -> bool:
        """Something is open."""
        return any(o.open(leg, now_ns) for o in self._orders.values() for leg in o.legs.values())

    def view(self, command_id: str, now_ns: int) -> CommandView | None:
        """One command as the picture shows it."""
        order = self._orders.get(command_id)
        return self._view(order, now_ns) if order else None

    def views(self, now_ns: int) -> tuple[CommandView, ...]:
        """The last commands, newest last."""
        return tuple(self._view(order, now_ns) for order in self._orders.values())

    def _view(self, order: _Order, now_ns: int) -> CommandView:
        legs = []
        for vehicle_id, leg in order.legs.items():
            state = leg.state
            end = leg.took_ns
            if end is None:
                end = now_ns
                if order.expired(now_ns):
                    state, end = LegState.EXPIRED, order.issued_ns + EXPIRY_NS
            legs.append(
                Leg(
                    id=vehicle_id,
                    state=state,
                    reason=leg.reason,
                    mode=leg.mode,
                    obeyed=leg.obeyed,
                    took_s=(end - order.issued_ns) / NS_PER_S,
                )
            )
        return CommandView(
            command_id=order.command.command_id,
            kind=order.command.kind,
            sender=order.command.sender,
            issued_ns=order.issued_ns,
            legs=tuple(legs),
        )
