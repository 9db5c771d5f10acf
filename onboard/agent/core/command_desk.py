"""Where requests on `vehicles/<id>/command` are answered; repeating one changes nothing."""

from __future__ import annotations

from onboard.agent.config import AgentConfig
from onboard.agent.core.command_book import SETS_OFF, Entry, Orders
from onboard.agent.core.events import Count, Instant, Outbox, Reply
from onboard.agent.core.flight import Flight
from onboard.agent.core.journal import Journal
from onboard.agent.core.masters import Words
from onboard.agent.core.readiness import why_no_order
from onboard.wire.bus.messages import Command, CommandReply, CommandState
from onboard.wire.bus.topics import COMMAND


class CommandDesk:
    """Takes orders, and tells how far they have come."""

    def __init__(
        self, config: AgentConfig, nonce: int, orders: Orders, flight: Flight, out: Outbox, journal: Journal
    ) -> None:
        self.config = config
        self._nonce, self._orders, self._flight = nonce, orders, flight
        self._out, self._journal = out, journal
        self._vehicle, self._bus = flight.vehicle, flight.bus
        self._said = Words()
        self.number = 0

    def speak(self, now: float) -> int:
        """The number of the health report that is said now: an order may quote it."""
        self.number += 1
        self._said.add(self._nonce, self.number, now)
        return self.number

    def answer(self, token: int, payload: bytes, now: Instant) -> None:
        """Answer a request."""
        command = COMMAND.decode(payload, self._bus.drops)
        if command is None:
            bad = CommandReply("", self.config.id, CommandState.REFUSED, "undecodable", "", now.wall_ns)
            self._out.put(Reply(token, COMMAND.encode_reply(bad)))
            return
        until = self._until(command, now.s)
        fresh = now.s <= until
        historic = command.kind not in SETS_OFF and not fresh and not self._vehicle.flown
        refusal = self._refusal(command, now.s, fresh=fresh, historic=historic)
        entry, new = self._orders.give(command, refusal, historic=historic, until=until)
        if new:
            text = f"{command.kind.value} from {command.sender}"
            if entry.state is CommandState.REFUSED:
                self._journal.warning("command_refused", f"{text}: {entry.reason}")
            elif historic:
                self._journal.warning("command_historic", f"{text}: {entry.reason}")
            else:
                self._journal.info("command", text)
                self._flight.obey(now.s)
            if entry.state is not CommandState.REFUSED:
                self._out.put(Count())  # the next health report says so: whoever resumes must know of it
        self.review()
        reply = CommandReply(
            command_id=command.command_id,
            id=self.config.id,
            state=entry.state,
            reason=self._waits(entry) if entry.state is CommandState.PENDING else entry.reason,
            obeyed=self._orders.obeyed,
            stamp_ns=now.wall_ns,
            mode=self._vehicle.telemetry.mode,
        )
        self._out.put(Reply(token, COMMAND.encode_reply(reply)))

    def review(self) -> None:
        """Tell of the open order where the autopilot's report has settled it."""
        climbs = self._flight.take_off.climbing and self._vehicle.telemetry.armed
        entry = self._orders.review(self._vehicle.stage, climbs=climbs)
        if entry is not None:
            text = f"{entry.command.kind.value} from {entry.command.sender}"
            self._journal.info(f"command_{entry.state.value}", text)

    def expire(self, now: float) -> None:
        """End what set off and was not reported in time: from now on it never acts."""
        if not self._orders.due(now):
            return
        self.review()  # what is reported is no longer open
        entry = self._orders.expire(now)
        if entry is not None:
            entry.reason = self._waits(entry)
            text = f"{entry.command.kind.value} from {entry.command.sender}"
            self._journal.warning("command_expired", f"{text}: {entry.reason}; it will not act any more")
            self._flight.withdraw(now)

    def _waits(self, entry: Entry) -> str:
        """What an order waits for that sets off; "" for others."""
        vehicle = self._vehicle
        if entry.command.kind not in SETS_OFF or vehicle.adapter is None:
            return ""
        return f"{vehicle.adapter.guided_mode} is not reported, {vehicle.telemetry.mode} is"

    def _until(self, command: Command, now: float) -> float:
        """Until when what it quotes counts: the master's word or, without a master, this agent's own."""
        quote, masters = command.quote, self._bus.masters
        until = masters.quoted_until if masters.holds(now) else self._said.until
        return until(quote.nonce, quote.number)

    def _refusal(self, command: Command, now: float, *, fresh: bool, historic: bool) -> str:
        """Why a command cannot be obeyed; '' if it can."""
        if self.config.dry_run:
            return "dry run: this agent sends nothing"
        unfit = self._orders.unfit(command, self._nonce, fresh=fresh)
        if unfit or historic:
            return unfit
        takes = command.kind in SETS_OFF
        return why_no_order(self._vehicle, takes=takes) or self._flight.objection(now, command)
