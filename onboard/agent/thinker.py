"""Runs strategies for the agent: the core's own by name, and those of other distributions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from onboard.agent.core.events import Answered, Load, Loaded, Think
from onboard.config.printable import named
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.core.strategy.knowledge import Decision, RuleId
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.pilot.setup import Side
from onboard.runtime.protocols import Clock

Strategy = Callable[[Any], Decision]


class Thinker:
    """Strategies by side and name, looked up once."""

    def __init__(self, clock: Clock) -> None:
        self.strategies: dict[tuple[Side, str], Strategy] = {}
        self._clock = clock

    def load(self, wanted: Load) -> Loaded:
        """Look a strategy up."""
        try:
            find = evader_strategy if wanted.side is Side.EVADER else pursuer_strategy
            strategy: Strategy = find(wanted.strategy)
        except ConfigError as error:
            return Loaded(wanted.strategy, str(error))
        if not is_own(wanted.side, wanted.strategy):
            strategy = _foreign(strategy)
        self.strategies[wanted.side, wanted.strategy] = strategy
        return Loaded(wanted.strategy, "")

    def answer(self, question: Think) -> Answered:
        """Ask a strategy, and measure how long it takes. A strategy may fail in any way."""
        begun = self._clock.monotonic_ns()
        decision: Decision | None = None
        error = ""
        try:
            decision = self.strategies[question.side, question.strategy](question.view)
        except KeyboardInterrupt:
            raise
        except BaseException as trouble:  # SystemExit, too: it is the strategy that leaves, not the agent
            error = named(trouble)
        return Answered(question.number, decision, error, (self._clock.monotonic_ns() - begun) / NS_PER_S)


def is_own(side: Side, strategy: str) -> bool:
    """Whether a strategy is one of the core's own ("" = the default)."""
    return strategy in ("", *(EVADERS if side is Side.EVADER else PURSUERS))


def _foreign(strategy: Strategy) -> Strategy:
    """A strategy of another distribution, whose answers are made plain numbers."""

    def decide(view: Any) -> Decision:
        d = strategy(view)
        return Decision(
            bool(d.fires), _vec(d.direction), float(d.speed), RuleId(d.rule), _vec(d.aim), float(d.time),
            float(d.miss),
        )  # fmt: skip

    return decide


def _vec(v: Any) -> Vec:
    x, y, z = v
    return Vec(float(x), float(y), float(z))
