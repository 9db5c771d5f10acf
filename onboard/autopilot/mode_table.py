"""Who flies: the modes' state machine as one table, which `ModeMachine` runs and docs/safety.md draws.

`python -m onboard.autopilot.mode_table` prints the diagram; with `--into FILE` it replaces the one between
the marks in that file.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from enum import Enum, auto
from pathlib import Path
from typing import NamedTuple

from onboard.autopilot.base import Stage


class ModeEvent(Enum):
    """What the machine hears; the value says it in the diagram.

    Of each new heartbeat exactly one event is made: the first that fits, in this order.
    """

    FOUND = "guided mode, and none other before"
    GUIDED_AGAIN = "guided mode, twice in a row"  # asked for by this agent, or chosen by the pilot's switch
    GUIDED = "guided mode"
    FOREIGN = "guided mode of another hand, twice in a row"  # a ground station's, another companion's
    RELEASED = "mode asked for on leaving"
    ECHO = "a request of ours, obeyed late"
    UNCHANGED = "mode as before"  # the one in which the asking began
    OTHER = "any other mode"
    ENTER = "enter"
    LEAVE = "leave"  # to another mode than last time
    LEAVE_AGAIN = "leave again"  # to the same mode
    GIVE_UP = "given up"  # the child that flies by MAVSDK has ended, or nobody wants the guided mode now
    GIVE_BACK = "given up, asked for after a take-over"
    REBOOT = "autopilot restarted"
    REBOOT_AFTER_TAKING = "autopilot restarted within 3 s of a take-over"


class ModeAction(Enum):
    """What the machine does with a transition."""

    ASK_GUIDED = auto()  # ask for the guided mode from now on
    ASK_RELEASE = auto()  # ask for the mode to leave into from now on
    FORGET = auto()  # ask for nothing, and know of no mode asked for
    STOP_ARMING = auto()  # no longer ask for arming
    TELL_CONTROL = auto()  # note: the guided mode is confirmed
    TELL_FOUND = auto()  # note: found in the guided mode without having asked
    TELL_HANDED_BACK = auto()  # note: the pilot's switch chose the guided mode
    TELL_FOREIGN = auto()  # note: neither this agent nor the pilot's switch chose the guided mode
    TELL_RELEASED = auto()  # note: the mode to leave into is confirmed
    TELL_TAKE_OVER = auto()  # note: somebody else, or the autopilot's failsafe, changed the mode
    TELL_ECHO = auto()  # note: an older request of ours was obeyed late
    TELL_CROSSED = auto()  # note: an older request of ours was obeyed after another hand's choice
    TELL_REBOOT = auto()  # note: control ended because the autopilot started again


class Transition(NamedTuple):
    """Where an event leads, and what is done on the way, in order."""

    to: Stage
    actions: tuple[ModeAction, ...] = ()


S, E, A = Stage, ModeEvent, ModeAction
_ENTER = Transition(S.ENTERING, (A.ASK_GUIDED,))
_LEAVE = Transition(S.LEAVING, (A.ASK_RELEASE, A.STOP_ARMING))
_CONFIRMED = Transition(S.ACTIVE, (A.TELL_CONTROL,))
_FOUND = Transition(S.ACTIVE, (A.TELL_FOUND,))
_BACK = Transition(S.ACTIVE, (A.TELL_HANDED_BACK,))
_LEFT = Transition(S.LEFT, (A.TELL_RELEASED,))
_TAKEN = Transition(S.TAKEN, (A.TELL_TAKE_OVER, A.STOP_ARMING))
_REBOOT = Transition(S.IDLE, (A.FORGET, A.TELL_REBOOT))
_AGAIN = Transition(S.ENTERING, (A.TELL_ECHO, A.ASK_GUIDED))
_LEAVE_AGAIN = Transition(S.LEAVING, (A.TELL_ECHO, A.ASK_RELEASE))
_ELSEWHERE = Transition(S.TAKEN, (A.TELL_FOREIGN, A.STOP_ARMING))
_GIVE_UP = Transition(S.IDLE, (A.FORGET, A.STOP_ARMING))

TABLE: dict[tuple[Stage, ModeEvent], Transition] = {
    (S.IDLE, E.ENTER): _ENTER,
    (S.IDLE, E.LEAVE): _LEAVE,
    (S.IDLE, E.LEAVE_AGAIN): _LEAVE,
    (S.IDLE, E.FOUND): _FOUND,
    (S.IDLE, E.GUIDED_AGAIN): _BACK,
    (S.IDLE, E.FOREIGN): Transition(S.IDLE, (A.TELL_FOREIGN,)),
    (S.IDLE, E.ECHO): Transition(S.IDLE, (A.TELL_CROSSED,)),
    (S.IDLE, E.GIVE_UP): _GIVE_UP,
    (S.ENTERING, E.GUIDED): _CONFIRMED,
    (S.ENTERING, E.GUIDED_AGAIN): _CONFIRMED,
    (S.ENTERING, E.RELEASED): _TAKEN,
    (S.ENTERING, E.OTHER): _TAKEN,
    (S.ENTERING, E.LEAVE): _LEAVE,
    (S.ENTERING, E.GIVE_UP): _GIVE_UP,
    (S.ENTERING, E.GIVE_BACK): Transition(S.TAKEN, (A.FORGET, A.STOP_ARMING)),
    (S.ENTERING, E.LEAVE_AGAIN): _LEAVE,
    (S.ACTIVE, E.RELEASED): _TAKEN,
    (S.ACTIVE, E.UNCHANGED): _TAKEN,
    (S.ACTIVE, E.OTHER): _TAKEN,
    (S.ACTIVE, E.ECHO): _AGAIN,
    (S.ACTIVE, E.LEAVE): _LEAVE,
    (S.ACTIVE, E.LEAVE_AGAIN): _LEAVE,
    (S.ACTIVE, E.REBOOT): _REBOOT,
    (S.ACTIVE, E.REBOOT_AFTER_TAKING): _REBOOT,
    (S.ACTIVE, E.GIVE_UP): _GIVE_UP,
    (S.LEAVING, E.RELEASED): _LEFT,
    (S.LEAVING, E.OTHER): _TAKEN,
    (S.LEAVING, E.ENTER): _ENTER,
    (S.LEAVING, E.LEAVE): _LEAVE,
    (S.LEFT, E.GUIDED_AGAIN): _BACK,
    (S.LEFT, E.FOREIGN): _ELSEWHERE,
    (S.LEFT, E.OTHER): _TAKEN,
    (S.LEFT, E.ECHO): _LEAVE_AGAIN,
    (S.LEFT, E.ENTER): _ENTER,
    (S.LEFT, E.LEAVE): _LEAVE,
    (S.LEFT, E.REBOOT): _REBOOT,
    (S.LEFT, E.REBOOT_AFTER_TAKING): _REBOOT,
    (S.TAKEN, E.GUIDED_AGAIN): _BACK,
    (S.TAKEN, E.FOREIGN): Transition(S.TAKEN, (A.TELL_FOREIGN,)),
    (S.TAKEN, E.ECHO): Transition(S.TAKEN, (A.TELL_CROSSED,)),
    (S.TAKEN, E.ENTER): _ENTER,
    (S.TAKEN, E.LEAVE): _LEAVE,
    (S.TAKEN, E.LEAVE_AGAIN): _LEAVE,
    (S.TAKEN, E.REBOOT_AFTER_TAKING): _REBOOT,
}
"""(stage, event) → transition. What is missing changes nothing and does nothing."""

BEGIN, END = "<!-- begin: onboard.autopilot.mode_table -->", "<!-- end: onboard.autopilot.mode_table -->"


def transition(stage: Stage, event: ModeEvent) -> Transition:
    """Return what an event does in a stage."""
    return TABLE.get((stage, event), Transition(stage))


def diagram() -> str:
    """Return the table as a Mermaid state diagram, one arrow for each pair of stages."""
    arrows: dict[tuple[Stage, Stage], list[str]] = {}
    for (stage, event), step in TABLE.items():
        arrows.setdefault((stage, step.to), []).append(event.value)
    lines = ["stateDiagram-v2", f"    [*] --> {Stage.IDLE.value}"]
    for (stage, to), words in arrows.items():
        lines.append(f"    {stage.value} --> {to.value}: {' / '.join(words)}")
    return "\n".join(lines)


def drawn_into(text: str) -> str:
    """Return a document with the diagram between its marks; ValueError where the marks are missing."""
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"found no place for the diagram, expected the lines {BEGIN} and {END}")
    return f"{before}{BEGIN}\n```mermaid\n{diagram()}\n```\n{END}{after}"


def main(arguments: Sequence[str]) -> int:
    """Print the diagram, or write it into a file; the exit code is 2 for arguments not understood."""
    if not arguments:
        print(diagram())
        return 0
    if len(arguments) != 2 or arguments[0] != "--into":
        print("usage: python -m onboard.autopilot.mode_table [--into FILE]", file=sys.stderr)
        return 2
    path = Path(arguments[1])
    path.write_text(drawn_into(path.read_text(encoding="utf-8")), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
