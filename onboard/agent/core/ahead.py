"""Deciding ahead of a position that is expected: the option `decide_ahead`.

Between two positions the strategy is asked what to do at the next one, for the own state carried forward to
then. When that position comes, the supervisor judges the answer on the state as it is, and the setpoint
leaves without waiting for a thought. An answer counts for one step, at the most half a control period off the
instant it was asked for, and is never older than one period; without one the strategy is asked as always.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import Answered, Instant, Think
from onboard.agent.core.part import Part
from onboard.agent.core.to_place import own_state
from onboard.autopilot.base import Telemetry
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.each import new
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Policy
from onboard.pilot.pilot import PilotDecision, Question

SHARE = 0.6  # of a control period after a step: then the next one is thought about


class OpenStep(NamedTuple):
    """A control step that waits for its strategy's answer."""

    number: int
    begun: Instant
    telemetry: Telemetry
    wind: Vec  # [m/s; where the air moves to], ZERO for multicopters
    question: Question | None


class Foreseen(NamedTuple):
    """A decision made before its position came."""

    decision: PilotDecision
    made: float  # when the strategy had answered [s, monotonic]
    age: float  # now: since it was asked, and no less than the strategy took [s]


class _Asked(NamedTuple):
    number: int
    at: float  # the instant asked for [s, monotonic]
    asked: float  # when [s, monotonic]
    policy: Policy  # of the game that it was asked in
    question: Question
    decision: PilotDecision | None
    took: float  # by the strategy [s]


class Ahead:
    """What was asked ahead, and what came of it. `at` is when to ask [s, monotonic]; inf: not by itself."""

    def __init__(self, config: AgentConfig, part: Part) -> None:
        self.at = inf
        self._period = 1.0 / config.control_rate_hz if config.decide_ahead else inf
        self._part = part
        self._next = Instant(inf, 0)  # when the next position is expected
        self._asked: _Asked | None = None

    def stepped(self, begun: Instant) -> None:
        """A control step began at `begun`: the next is one period later."""
        self._asked = None
        if self._period < inf:
            self.at = begun.s + SHARE * self._period
            self._next = Instant(begun.s + self._period, begun.wall_ns + round(self._period * NS_PER_S))

    def ask(self, number: int, now: float, t: Telemetry, *, hovers: bool, due: bool) -> Think | None:
        """Ask for the next step at `now` [s, monotonic]; None where nobody need be asked, or that fails.

        Not `due`: the part is not on, or the strategy still thinks about the step before."""
        self.at, at = inf, self._next
        if not due:
            return None
        try:
            question = self._part.ask(at, own_state(at.s, t, hovers=hovers))
        except Exception:  # the step itself asks again, and tells
            return None
        if isinstance(question, PilotDecision):
            return None
        self._asked = new(_Asked, (number, at.s, now, self._part.policy, question, None, 0.0))
        return Think(number, self._part.side, self._part.strategy, question.view)

    def answered(self, answer: Answered) -> bool:
        """Take an answer in; False where it was not asked for here. What failed, the step asks again."""
        asked = self._asked
        if asked is None or asked.number != answer.number:
            return False
        self._asked = None
        if answer.decision is not None and not answer.error:
            try:
                decision = self._part.conclude(asked.question, answer.decision)
            except Exception:  # a strategy of another distribution may answer anything
                return True
            self._asked = asked._replace(decision=decision, took=answer.took_s)
        return True

    def take(self, now: float) -> Foreseen | None:
        """The decision for a step at `now` [s, monotonic], handed out once; None where none fits it."""
        asked, self._asked, self.at = self._asked, None, inf
        if asked is None or asked.decision is None or asked.policy is not self._part.policy:
            return None
        age = now - asked.asked
        if abs(now - asked.at) > 0.5 * self._period or age > self._period:
            return None
        return new(Foreseen, (asked.decision, asked.asked + asked.took, max(age, asked.took)))
