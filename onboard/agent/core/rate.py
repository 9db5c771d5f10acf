"""How often something happens."""

from __future__ import annotations

from onboard.core.math.constants import NEVER

RATE_WINDOW_S = 2.0  # over which rates are measured


class Rate:
    """How often something happened lately [Hz]."""

    def __init__(self) -> None:
        self.value = 0.0
        self._count = 0
        self._since = NEVER

    def tick(self) -> None:
        """It happened."""
        self._count += 1

    def review(self, now: float) -> float:
        """The rate over the last window."""
        if self._since == NEVER:
            self._since = now
        elif now - self._since >= RATE_WINDOW_S:
            self.value = self._count / (now - self._since)
            self._count, self._since = 0, now
        return self.value
