"""Commands from the ground: idempotent by id, and confirmed only by what the autopilot reports."""

from __future__ import annotations

from collections import OrderedDict

from onboard.autopilot.base import Stage
from onboard.core.safety.policy import Action
from onboard.wire.bus.messages import Command, CommandKind, CommandState

KEPT = 64  # commands remembered


class Entry:
    """One command, once."""

    def __init__(self, command: Command, state: CommandState, reason: str) -> None:
        self.command = command
        self.state = state
        self.reason = reason


class Orders:
    """Who ordered what, and whether the autopilot reports it."""

    def __init__(self, abort: Action) -> None:
        self.order = Action.PASS  # in force: HOLD, RETURN, LAND, or PASS for none
        self.granted = False  # a start or resume gave the agent control
        self.obeyed = ""
        self._abort = abort
        self._known: OrderedDict[str, Entry] = OrderedDict()
        self._open: Entry | None = None

    def give(self, command: Command, refusal: str) -> tuple[Entry, bool]:
        """Take a command; `refusal` says why it cannot be obeyed now ('' if it can). True for a new one."""
        known = self._known.get(command.command_id)
        if known is not None:
            return known, False
        entry = Entry(command, CommandState.REFUSED if refusal else CommandState.PENDING, refusal)
        self._known[command.command_id] = entry
        if len(self._known) > KEPT:
            self._known.popitem(last=False)
        if refusal:
            return entry, True
        if self._open is not None and self._open.state is CommandState.PENDING:
            self._open.state = CommandState.SUPERSEDED
            self._open.reason = f"by {command.kind.value} from {command.sender}"
        self._open = entry
        self.obeyed = command.sender
        kind = command.kind
        if kind in (CommandKind.START, CommandKind.RESUME):
            self.order = Action.PASS
            self.granted = True
        else:
            self.order = {
                CommandKind.HOLD: Action.HOLD,
                CommandKind.RETURN: Action.RETURN,
                CommandKind.LAND: Action.LAND,
                CommandKind.ABORT: self._abort,
            }[kind]
        return entry, True

    def review(self, stage: Stage) -> Entry | None:
        """Compare the open command with what the autopilot reports; the entry if that settled it."""
        entry = self._open
        if entry is None or entry.state is not CommandState.PENDING:
            return None
        sets_off = entry.command.kind in (CommandKind.START, CommandKind.RESUME)
        if stage is (Stage.ACTIVE if sets_off else Stage.LEFT):
            entry.state = CommandState.CONFIRMED
        elif stage is Stage.TAKEN:
            entry.state = CommandState.REFUSED
            entry.reason = "a pilot has taken over"
        else:
            return None
        return entry

    def taken(self) -> None:
        """A pilot took over: no order is in force any more, and control must be granted anew."""
        self.order = Action.PASS
        self.granted = False

    def handed_back(self) -> None:
        """A pilot hands back: no order is in force any more."""
        self.order = Action.PASS
