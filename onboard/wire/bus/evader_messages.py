"""What the bus says of single evaders: how each one's game ended, and where each one goes. See `messages`."""

from __future__ import annotations

from enum import Enum

from onboard.wire.bus.base import Message, Triple


class OutcomeResult(Enum):
    """How a game ended for the evader."""

    CAPTURED = "captured"
    ARRIVED = "arrived"  # at its target
    ESCAPED = "escaped"  # not captured within the horizon
    DENIED = "denied"  # nor arrived: at the horizon a pursuer can be at its target first
    ABORTED = "aborted"  # ended without a result


class EvaderOutcome(Message, frozen=True):
    """How one evader's game ended, while others' may still run."""

    id: int
    verdict: OutcomeResult
    time: float  # [s] since t0
    captor: int  # id, 0 = nobody
    smallest_distance: float  # [m] of any pursuer to it, −1 = not known


class EvaderTargets(Message, frozen=True):
    """Where one evader goes: to any of these."""

    id: int
    targets: tuple[Triple, ...]  # [m; NED]


class OwnBrief(Message, frozen=True):
    """`vehicles/<id>/brief`: for one of several evaders alone."""

    id: int
    stamp_ns: int
    targets: tuple[Triple, ...]  # [m; NED] it may go to any; () = it has none
