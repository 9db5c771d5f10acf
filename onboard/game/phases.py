"""The phases of a game as one table, which `GameMaster` runs and docs/conventions.md draws.

`python -m onboard.game.phases` prints the diagram.
"""

from __future__ import annotations

from enum import Enum

from onboard.wire.bus.messages import Phase


class PhaseEvent(Enum):
    """What leads from one phase to the next; the value says it in the diagram."""

    ALL_READY = "everybody is ready and the start is given"
    NOT_READY = "somebody is not ready any more"
    PATIENCE_OVER = "not ready in time"
    BEGINNING = "t₀ has come"
    RESULT = "captured, arrived, denied or escaped"
    ABORT = "abort"
    RECOVERY_DUE = "the time after the end is over"


TRANSITIONS: dict[tuple[Phase, PhaseEvent], Phase] = {
    (Phase.STAGING, PhaseEvent.ALL_READY): Phase.READY,
    (Phase.STAGING, PhaseEvent.PATIENCE_OVER): Phase.ENDED,
    (Phase.STAGING, PhaseEvent.ABORT): Phase.ENDED,
    (Phase.READY, PhaseEvent.NOT_READY): Phase.STAGING,
    (Phase.READY, PhaseEvent.BEGINNING): Phase.RUNNING,
    (Phase.READY, PhaseEvent.ABORT): Phase.ENDED,
    (Phase.RUNNING, PhaseEvent.RESULT): Phase.ENDED,
    (Phase.RUNNING, PhaseEvent.ABORT): Phase.ENDED,
    (Phase.ENDED, PhaseEvent.RECOVERY_DUE): Phase.RECOVERY,
}
"""(phase, event) → the next phase. An event that is missing for a phase changes nothing in it."""


def diagram() -> str:
    """The table as a Mermaid state diagram, one arrow for each pair of phases."""
    arrows: dict[tuple[Phase, Phase], list[str]] = {}
    for (phase, event), following in TRANSITIONS.items():
        arrows.setdefault((phase, following), []).append(event.value)
    lines = ["stateDiagram-v2", f"    [*] --> {Phase.STAGING.value}"]
    for (phase, following), words in arrows.items():
        lines.append(f"    {phase.value} --> {following.value}: {' / '.join(words)}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(diagram())
