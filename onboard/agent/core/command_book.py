"""Commands from the ground: once each, in order, of an age, confirmed only by what the autopilot reports.

docs/commands.md is the specification.
"""

from __future__ import annotations

from collections import OrderedDict
from math import inf
from typing import NamedTuple

from onboard.autopilot.base import Stage
from onboard.core.safety.policy import Action
from onboard.wire.bus.messages import Command, CommandKind, CommandState

KEPT = 64  # commands remembered with their state
KNOWN = 1 << 16  # … and by id alone: none of these becomes new again
SETS_OFF = frozenset({CommandKind.START, CommandKind.RESUME})

Key = tuple[str, str, CommandKind]  # id, sender, kind: nobody's order hides behind another's id


class Entry:
    """One command, once."""

    def __init__(self, command: Command, state: CommandState, reason: str, until: float = inf) -> None:
        self.command = command
        self.state = state
        self.reason = reason
        self.until = until  # [s; the agent's own clock] what sets off expires then, if it is pending still


class Standing(NamedTuple):
    """What was in force before an order that sets off: in force again where that comes to nothing."""

    order: Action = Action.PASS
    granted: bool = False
    blocked: str = ""


class Orders:
    """Who ordered what, and whether the autopilot reports it."""

    def __init__(self, abort: Action) -> None:
        self.order = Action.PASS  # in force: HOLD, RETURN, LAND, or PASS for none
        self.granted = False  # a start or resume gave the agent control
        self.obeyed = ""
        self._abort = abort
        self.stopped_by = ""  # id of the last order obeyed that stops
        self.blocked = ""  # an order from before this agent had control, which a person has to clear
        self._known: OrderedDict[Key, Entry] = OrderedDict()
        self._ids: OrderedDict[Key, None] = OrderedDict()
        self._open: Entry | None = None
        self._before = Standing()

    def unfit(self, command: Command, nonce: int, *, fresh: bool) -> str:
        """Why a command that sets off does not count for this process (`nonce`); '' if it does.

        `fresh`: it quotes what this agent heard, or said, a short time ago."""
        quote = command.quote
        if command.kind not in SETS_OFF:
            return ""
        if quote.agent != nonce:
            return "meant for another process of this agent: look, and give it again"
        if not fresh:
            return "too old: it quotes nothing that was heard in the last 5 s"
        if quote.after != self.stopped_by:
            return f"given before {self.stopped_by} stopped this vehicle: look, and give it again"
        return ""

    def give(
        self, command: Command, refusal: str, *, historic: bool = False, until: float = inf
    ) -> tuple[Entry, bool]:
        """Take a command; `refusal` says why it cannot be obeyed now ('' if it can). True for a new one.

        `historic`: a stop from before the agent had control. It moves nothing; it blocks the start.
        `until` [s]: when it expires, if it sets off."""
        key = (command.command_id, command.sender, command.kind)
        known = self._known.get(key)
        if known is not None:
            return known, False
        if key in self._ids:
            return Entry(command, CommandState.SUPERSEDED, "an old order, known already"), False
        self._ids[key] = None
        if len(self._ids) > KNOWN:
            self._ids.popitem(last=False)
        entry = Entry(command, CommandState.REFUSED if refusal else CommandState.PENDING, refusal, until)
        self._known[key] = entry
        if len(self._known) > KEPT:
            self._known.popitem(last=False)
        if refusal:
            return entry, True
        sets_off_still = self._sets_off
        if self._open is not None and self._open.state is CommandState.PENDING:
            self._open.state = CommandState.SUPERSEDED
            self._open.reason = f"by {command.kind.value} from {command.sender}"
            if sets_off_still and command.kind not in SETS_OFF:
                self._withdraw()
        self._open = entry
        self.obeyed = command.sender
        kind = command.kind
        if kind in SETS_OFF:
            if not sets_off_still:
                self._before = Standing(self.order, self.granted, self.blocked)
            self.order = Action.PASS
            self.granted, self.blocked = True, ""
            return entry, True
        self.stopped_by = command.command_id
        if historic:
            self.blocked = f"{kind.value} from {command.sender}"
            entry.state, entry.reason = CommandState.CONFIRMED, "not in control: the start is blocked"
        else:
            self.order = {
                CommandKind.HOLD: Action.HOLD,
                CommandKind.RETURN: Action.RETURN,
                CommandKind.LAND: Action.LAND,
                CommandKind.ABORT: self._abort,
            }[kind]
        return entry, True

    @property
    def open(self) -> bool:
        """Whether any command was given that another one has not ended."""
        return self._open is not None

    @property
    def _sets_off(self) -> bool:
        """Whether the open command sets off, and is not reported yet."""
        entry = self._open
        return entry is not None and entry.state is CommandState.PENDING and entry.command.kind in SETS_OFF

    def _withdraw(self) -> None:
        """What set off has come to nothing: all is as it was before."""
        self.order, self.granted, self.blocked = self._before

    def due(self, now: float) -> bool:
        """Whether the open command sets off, was not reported yet, and its time is over."""
        return self._open is not None and now > self._open.until and self._sets_off

    def expire(self, now: float) -> Entry | None:
        """End what set off and was not reported in time; the entry if it ended now."""
        entry = self._open
        if entry is None or not self.due(now):
            return None
        entry.state = CommandState.EXPIRED
        self._withdraw()
        return entry

    def review(self, stage: Stage, *, climbs: bool = False) -> Entry | None:
        """Compare the open command with what the autopilot reports; the entry if that settled it.

        `climbs`: armed, it takes off by this agent's wish."""
        entry = self._open
        if entry is None or entry.state is not CommandState.PENDING:
            return None
        sets_off = entry.command.kind in SETS_OFF
        if stage is (Stage.ACTIVE if sets_off else Stage.LEFT) or (sets_off and climbs):
            entry.state = CommandState.CONFIRMED
        elif stage is Stage.TAKEN and not (sets_off and self.granted):  # taken since, not before
            entry.state = CommandState.REFUSED
            entry.reason = "a pilot has taken over"
        else:
            return None
        return entry

    def taken(self) -> None:
        """A pilot took over: no order is in force any more, and control must be granted anew."""
        if self._sets_off:
            self.blocked = self._before.blocked
        self.order = Action.PASS
        self.granted = False

    def handed_back(self) -> None:
        """A pilot hands back: no order is in force any more."""
        self.order = Action.PASS
