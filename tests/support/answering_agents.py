"""Stand-ins for agents on a bus: they answer commands as an agent does."""

from __future__ import annotations

from collections import Counter

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import VirtualClock
from onboard.runtime.protocols import Bus
from onboard.wire.bus import topics
from onboard.wire.bus.messages import AgentStage, Command, CommandReply, CommandState
from tests.support.sample_messages import GAME, health, on_bus, state

MODES = {
    "abort": "LOITER", "hold": "LOITER", "return": "RTL", "land": "LAND",
    "start": "GUIDED", "resume": "GUIDED",
}  # fmt: skip


class AnsweringAgent:
    """One vehicle's agent: obeys at once, and its autopilot reports the new mode `takes_s` later."""

    def __init__(
        self, bus: Bus, clock: VirtualClock, i: int, takes_s: float = 0.3, refuses: str = ""
    ) -> None:
        self.id = i
        self.refuses = refuses
        self.takes_s = takes_s
        self.heard: Counter[str] = Counter()  # requests by command id
        self.obeyed: list[Command] = []
        self.in_force: Command | None = None
        self.since_ns = 0
        self.mode = "GUIDED"
        self.stage = AgentStage.ACTING
        self.bus = bus
        self._clock = clock
        self._drops: Counter[str] = Counter()
        bus.serve(topics.COMMAND.key(GAME, i), self.answer)

    def answer(self, payload: bytes) -> bytes:
        """The reply to a command."""
        command = topics.COMMAND.decode(payload, self._drops)
        assert command is not None
        self.heard[command.command_id] += 1
        if self.refuses:
            return self._reply(command, CommandState.REFUSED, self.refuses)
        if command.command_id not in [c.command_id for c in self.obeyed]:
            self.obeyed.append(command)
            self.in_force, self.since_ns = command, self._clock.monotonic_ns()
        elif self.in_force is not None and command.command_id != self.in_force.command_id:
            return self._reply(command, CommandState.SUPERSEDED, f"by {self.in_force.kind.value}")
        if self._clock.monotonic_ns() - self.since_ns >= self.takes_s * NS_PER_S:
            self.mode = MODES[command.kind.value]
            return self._reply(command, CommandState.CONFIRMED, "")
        return self._reply(command, CommandState.PENDING, "")

    def _reply(self, command: Command, said: str, reason: str) -> bytes:
        obeyed = self.in_force.sender if self.in_force else ""
        now_ns = self._clock.wall_ns()
        reply = CommandReply(command.command_id, self.id, said, reason, obeyed, now_ns, self.mode)
        return topics.COMMAND.encode_reply(reply)

    def speak(self) -> None:
        """Publish state and health once."""
        now_ns = self._clock.wall_ns()
        for message, topic in (
            (state(self.id, now_ns, mode=self.mode), topics.STATE),
            (health(self.id, now_ns, mode=self.mode, stage=self.stage), topics.HEALTH),
        ):
            self.bus.publish(*on_bus(message), topic.delivery)
