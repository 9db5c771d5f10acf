"""The agent's part in the game: which phase, whether it may act, and why it must wait."""

from __future__ import annotations

from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Phase, PhaseChange

JUST_STARTED_S = 1.0  # who first hears of a running game this soon after t₀ was there for the start


class Participation:
    """Follows the phases. An agent that was not there at the start acts only after the master's resume."""

    def __init__(self, id: int) -> None:
        self.joined = False
        self.resumed = False  # by the master, not by a person or from the beginning
        self._id = id
        self._before = (False, False)  # `joined` and `resumed`, before a person's last word

    def follow(self, phase: PhaseChange, wall_ns: int) -> None:
        """Take a phase change (or the cached one) in."""
        if phase.phase in (Phase.STAGING, Phase.READY):
            self.joined, self.resumed = True, False
        elif phase.phase is Phase.RUNNING:
            begun = (wall_ns - phase.t0_ns) / NS_PER_S
            if not self.joined and begun >= JUST_STARTED_S and self._id in phase.resume:
                self.joined = self.resumed = True
            elif begun < JUST_STARTED_S:
                self.joined = True

    def let_in(self) -> None:
        """A person lets this agent act."""
        self._before = (self.joined, self.resumed)
        self.joined, self.resumed = True, False

    def withdraw(self) -> None:
        """The person's word came to nothing."""
        self.joined, self.resumed = self._before

    def leave(self) -> None:
        """Another game's setup came: what was joined is over."""
        self.joined = self.resumed = False

    def waits_for_resume(self, phase: PhaseChange | None) -> bool:
        """Whether the game runs without this agent."""
        return self._goes_on(phase) is Phase.RUNNING and not self.joined

    def running(self, phase: PhaseChange | None, wall_ns: int) -> bool:
        """Whether the agent's part is on: from t₀ to its end."""
        on = self._goes_on(phase) is Phase.RUNNING and self.joined
        return on and phase is not None and wall_ns >= phase.t0_ns

    def about_to(self, phase: PhaseChange | None) -> bool:
        """Whether control should be taken: from ready on."""
        return self._goes_on(phase) in (Phase.READY, Phase.RUNNING)

    def over(self, phase: PhaseChange | None) -> bool:
        """Whether the game has ended, or this vehicle's part in it: it is an evader that is out."""
        return phase is not None and (phase.phase in (Phase.ENDED, Phase.RECOVERY) or is_out(phase, self._id))

    def _goes_on(self, phase: PhaseChange | None) -> Phase | None:
        """The phase for a vehicle that is in the game; None without one, and for an evader that is out."""
        return None if phase is None or is_out(phase, self._id) else phase.phase

    @staticmethod
    def game_time(phase: PhaseChange | None, wall_ns: int) -> float:
        """Seconds since t₀, 0 before it is fixed."""
        return (wall_ns - phase.t0_ns) / NS_PER_S if phase is not None and phase.t0_ns > 0 else 0.0


def is_out(phase: PhaseChange, id: int) -> bool:
    """Whether a vehicle is an evader whose game is over."""
    return bool(phase.out) and any(end.id == id for end in phase.out)  # asked often, nearly always of nobody
