"""What the supervisor had to clip: every step counted by its cause, every spell told once.

A decision already keeps to what the vehicle can do, so that a clip is an exception: a limit, a fence, a mate.
"""

from __future__ import annotations

from collections import Counter

from onboard.core.safety.policy import Action, Cause
from onboard.core.safety.words import ACTIONS, CAUSES

SPELL_S = 5.0  # clips with no longer pause than this between them are one spell


class ClipSpells:
    """Look at every verdict with `look`; it gives what is to be told."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()  # steps clipped since the start, by cause
        self._cause = Cause.NONE  # of the spell that is on; NONE: none is
        self._begun = self._last = 0.0  # [s]
        self._steps = 0

    def look(self, now: float, before: Action, action: Action, cause: Cause) -> str:
        """What to tell of a verdict at `now` [s, monotonic], given after `before`; "" = nothing new.

        The begin of a spell, its end with its length, and a verdict that lets all pass after a graver one.
        """
        if action is Action.CLIP:
            self.counts[f"clipped_{cause.name.lower()}"] += 1
            told = self._cause
            if told is Cause.NONE:
                self._begun, self._steps, self._cause = now, 0, cause
            self._last, self._steps = now, self._steps + 1
            return f"{ACTIONS[action]}: {CAUSES[cause]}" if told is Cause.NONE else ""
        if action > Action.CLIP:
            self._cause = Cause.NONE
            return f"{ACTIONS[action]}: {CAUSES[cause]}" if action is not before else ""
        free = f"{ACTIONS[Action.PASS]}: {CAUSES[Cause.NONE]}"
        if self._cause is not Cause.NONE and now - self._last > SPELL_S:
            why, self._cause = CAUSES[self._cause], Cause.NONE
            return f"{free}; {self._steps} steps were clipped in {self._last - self._begun:.1f} s: {why}"
        return free if before > Action.CLIP else ""
