"""Commands to vehicles: the book of who was told what and who has confirmed. Pure, time passed in.

Confirmed means that the autopilot reports the state asked for: the agent answers `pending` until then.
Each command is repeated to each vehicle until a final answer, at most every 80 ms: at 30 % loss both
ways a retry every 0.1 s confirms six of six within 2 s in 99.98 % of trials, one every 0.5 s in 19 %.
Repeating is harmless, because agents know a command by its id. After 38 tries (3 s) the pace falls to 1 s.
A command to everybody is also called out to all agents of the game, for 1.5 s at that pace and
until somebody answers: who does is from then on one of those told, and confirms under its own key.
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
CALL_NS = 3 * NS_PER_S // 2  # how long everybody is called: at 30 % loss both ways each hears it
KEPT = 50  # commands
LEGS_MAX = 256  # who may join a command by answering a call: MAVLink knows no more systems

ENDS_A_FLIGHT = frozenset({CommandKind.RETURN, CommandKind.LAND})  # these ask twice; abort never does
SETS_OFF = frozenset({CommandKind.START, CommandKind.RESUME})
FINAL = frozenset({LegState.CONFIRMED, LegState.REFUSED, LegState.SUPERSEDED, LegState.EXPIRED})


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
    __slots__ = ("call", "command", "everybody", "issued_ns", "legs")

    def __init__(self, command: Command, now_ns: int, everybody: bool) -> None:
        self.command = command
        self.issued_ns = now_ns
        self.everybody = everybody
        self.call = CommandRetry(RETRY)
        self.legs: dict[int, _Leg] = {}

    def calls(self, now_ns: int) -> bool:
        wanted = now_ns - self.issued_ns < CALL_NS or not self.legs
        return self.everybody and wanted and not self.expired(now_ns)

    def open(self, leg: _Leg, now_ns: int) -> bool:
        return leg.state not in FINAL and not self.expired(now_ns)

    def expired(self, now_ns: int) -> bool:
        return self.command.kind in SETS_OFF and now_ns - self.issued_ns >= EXPIRY_NS


class Due(NamedTuple):
    """One request to send now."""

    id: int | None  # None: to all agents of the game
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
        *,
        everybody: bool = False,
    ) -> None:
        """Enter a command to `ids`, with what each quotes: fixed now, however often it is sent.

        It supersedes what is open to them, but for one thing: nothing that sets a vehicle off supersedes an
        abort that is not confirmed yet. A command that is known already is given to further vehicles.
        `everybody`: it is also called out to all agents, and those who answer are told it like the rest."""
        order = self._orders.get(command.command_id)
        if order is None:
            order = self._orders[command.command_id] = _Order(command, now_ns, everybody)
        for vehicle_id in sorted(set(ids)):
            self._tell(order, vehicle_id, now_ns, quotes.get(vehicle_id, Quote()))
        while len(self._orders) > KEPT:
            self._orders.pop(next(iter(self._orders)))

    def _tell(self, order: _Order, vehicle_id: int, now_ns: int, quote: Quote) -> _Leg:
        """One more vehicle is told a command."""
        known = order.legs.get(vehicle_id)
        if known is not None:
            return known
        mine = order.legs[vehicle_id] = _Leg(replace(order.command, quote=quote))
        for other in self._orders.values():
            leg = other.legs.get(vehicle_id) if other is not order else None
            if leg is None or not other.open(leg, now_ns):
                continue
            if order.command.kind in SETS_OFF and other.command.kind is CommandKind.ABORT:
                mine.state, mine.took_ns = LegState.REFUSED, now_ns
                mine.reason = "an abort is not confirmed yet"
            else:
                leg.state, leg.took_ns = LegState.SUPERSEDED, now_ns
                leg.reason = f"by {order.command.kind.value}"
        return mine

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

    def call_found(self, command_id: str, vehicle_id: int) -> Command | None:
        """The command to give to a vehicle that answered a call, for one that is not told it yet."""
        order = self._orders.get(command_id)
        wanted = order is not None and order.everybody and len(order.legs) < LEGS_MAX
        return order.command if order is not None and wanted and vehicle_id not in order.legs else None

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
            if order.calls(now_ns) and order.call.due(now_ns):
                found.append(Due(None, order.command))
            for vehicle_id, leg in order.legs.items():
                if order.open(leg, now_ns) and leg.retry.due(now_ns):
                    found.append(Due(vehicle_id, leg.command))
        return found

    def busy(self, now_ns: int) -> bool:
        """Something is open."""
        return any(
            o.calls(now_ns) or any(o.open(leg, now_ns) for leg in o.legs.values())
            for o in self._orders.values()
        )

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
