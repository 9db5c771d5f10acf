"""PX4's failsafes: which condition wants which action, what waits for COM_FAIL_ACT_T, what is latched.

A condition that begins latches its action until a person chooses a mode or the vehicle disarms. Actions that
leave the place (return, land) are first held for COM_FAIL_ACT_T, so that a person can step in. Of several
actions the strongest counts.
"""

from __future__ import annotations

from typing import NamedTuple

OFFBOARD_LOSS = {0: "POSCTL", 1: "ALTCTL", 2: "STABILIZED", 3: "RTL", 4: "LAND", 5: "HOLD", 6: "TERMINATE",
                 7: "TERMINATE"}  # fmt: skip
"""COM_OBL_RC_ACT; 6 terminates the flight and 7 disarms: the motors stop."""
LINK = {1: "HOLD", 2: "RTL", 3: "LAND", 5: "TERMINATE", 6: "TERMINATE"}  # NAV_DLL_ACT and NAV_RCL_ACT
GEOFENCE = {2: "HOLD", 3: "RTL", 4: "TERMINATE", 5: "LAND"}  # GF_ACTION
STRENGTH = ("POSCTL", "ALTCTL", "STABILIZED", "HOLD", "RTL", "LAND", "TERMINATE")  # weakest first


class Condition(NamedTuple):
    """One reason for a failsafe, as it is now."""

    cause: str  # unlike for every reason; a worse level of the same has another
    present: bool
    action: str  # of STRENGTH; "" = only a warning
    text: str  # STATUSTEXT at its beginning


class Wish(NamedTuple):
    """One latched action and when its condition began."""

    action: str
    since_ns: int


class Latches:
    """The latched actions of one vehicle."""

    def __init__(self) -> None:
        self._wishes: dict[str, Wish] = {}
        self._present: set[str] = set()

    def look(self, conditions: list[Condition], now_ns: int) -> list[str]:
        """Take the conditions as they are now; gives the texts of those that begin."""
        begun = []
        for condition in conditions:
            if not condition.present:
                self._present.discard(condition.cause)
            elif condition.cause not in self._present:
                self._present.add(condition.cause)
                begun.append(condition.text)
                if condition.action:
                    self._wishes[condition.cause] = Wish(condition.action, now_ns)
        return begun

    @property
    def latched(self) -> bool:
        """Whether any action is wanted."""
        return bool(self._wishes)

    def release(self) -> None:
        """A person chose a mode: what is latched counts no more; a condition must begin anew."""
        self._wishes.clear()

    def forget(self) -> None:
        """The vehicle has disarmed or landed: conditions that are still there begin anew in the air."""
        self._wishes.clear()
        self._present.clear()

    def action(self, now_ns: int, hold_s: float) -> str:
        """The strongest action wanted now; "" for none."""
        wanted = ""
        for wish in self._wishes.values():
            waits = (now_ns - wish.since_ns) * 1e-9 < hold_s and STRENGTH.index(wish.action) < len(
                STRENGTH
            ) - 1
            wanted = stronger(wanted, "HOLD" if waits else wish.action)
        return wanted


def stronger(one: str, other: str) -> str:
    """The stronger of two actions, "" being the weakest."""
    rank = {name: number for number, name in enumerate(STRENGTH)}
    return one if rank.get(one, -1) >= rank.get(other, -1) else other
