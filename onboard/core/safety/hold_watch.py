"""Whether a vehicle that was left to hold does hold: what it does counts, not the mode that it reports."""

from __future__ import annotations

from enum import Enum
from math import hypot
from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import ZERO, Vec, sub

SETTLED = 2.0  # [s] within the limits that make a hold
PATIENCE = 10.0  # [s] at most until it holds
LOST = 1.0  # [s] outside the limits that make a hold a lost one


class HoldLimits(NamedTuple):
    """What counts as holding. A multicopter's; `of_plane` gives a plane's."""

    height: float = 2.0  # from where it was found [m]
    reach: float = 3.0  # from where it was found, in the horizontal [m]
    climb: float = 0.5  # up or down [m/s]
    airspeed_min: float = 0.0  # [m/s]
    airspeed_max: float = 1e9  # [m/s]


def of_plane(radius: float, speed_min: float, speed_max: float) -> HoldLimits:
    """The limits of a plane that circles with a radius [m] at airspeeds between two [m/s].

    Three radii about the middle of the circle are six from one side to the other.
    """
    return HoldLimits(15.0, 6.0 * radius, 1e9, 0.8 * speed_min, 1.2 * speed_max)


class HoldState(Enum):
    """What is known of a hold."""

    WAITING = "waiting"  # not held yet, but there is still time
    HELD = "held"
    LOST = "lost"  # it never came to hold in time, or holds no more


class HoldWatch:
    """Watches one hold from the instant when its mode was accepted [s, monotonic]."""

    def __init__(self, now: float, limits: HoldLimits) -> None:
        self.state = HoldState.WAITING
        self._limits, self._begun = limits, now
        self._anchor = ZERO
        self._since = NEVER  # since when it has been within the limits
        self._inside_at = now  # when it was last within them

    def look(self, now: float, position: Vec, velocity: Vec, airspeed: float | None) -> bool:
        """Take what was measured (NED [m], [m/s]; airspeed None: unknown); return whether it changed."""
        before, limits = self.state, self._limits
        gap = sub(position, self._anchor)
        near = self._since != NEVER and hypot(gap.x, gap.y) <= limits.reach and abs(gap.z) <= limits.height
        flies = airspeed is None or limits.airspeed_min <= airspeed <= limits.airspeed_max
        inside = near and flies and abs(velocity.z) <= limits.climb
        if inside:
            self._inside_at = now
        if before is HoldState.HELD and now - self._inside_at > LOST:
            self.state = HoldState.LOST
        elif before is HoldState.WAITING and inside and now - self._since >= SETTLED:
            self.state = HoldState.HELD
        elif before is HoldState.WAITING and now - self._begun > PATIENCE:
            self.state = HoldState.LOST
        elif before is HoldState.WAITING and not inside:
            self._anchor, self._since = position, now
        return self.state is not before
