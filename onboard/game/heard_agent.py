"""What a game's master knows of one vehicle's agent."""

from __future__ import annotations

from onboard.core.math.constants import NS_PER_S
from onboard.wire.autopilot_kind import GUIDED_MODE
from onboard.wire.bus.messages import AgentStage, Health

CONTROL_NS = 10 * NS_PER_S  # a process started later than this after the last one flew needs a person's word


class HeardAgent:
    """What is known of one vehicle's agent."""

    def __init__(self) -> None:
        self.health: Health | None = None  # its last heartbeat
        self.heard_ns = 0  # arrival of that heartbeat [ns, monotonic]
        self.acting_nonce = 0  # of the process that plays
        self.in_control_ns = -CONTROL_NS  # when it last flew the vehicle [ns, monotonic]
        self.nonces: dict[int, int] = {}  # nonce of a process → last heard [ns, monotonic]
        self.silent = False  # as last told to the people

    def hear(self, health: Health, now_ns: int) -> None:
        """Take a heartbeat, which arrived at `now_ns` [monotonic].

        Who is ready and guided flies already, to its place: what stands in a guided mode of another hand is
        not ready, for it needs a person's word.
        """
        self.health, self.heard_ns = health, now_ns
        if health.stage is AgentStage.ACTING or (health.stage is AgentStage.READY and guided(health)):
            self.in_control_ns = now_ns

    def never_left(self, health: Health, now_ns: int) -> bool:
        """Whether a restarted agent finds its vehicle as the last process left it: guided."""
        return guided(health) and now_ns - self.in_control_ns <= CONTROL_NS


def guided(health: Health) -> bool:
    """Whether the autopilot is in the mode that an agent flies in."""
    return health.autopilot is not None and GUIDED_MODE.get(health.autopilot) == health.mode
