"""From a wanted velocity to one that the aircraft can fly: speed, climb, change of velocity."""

from __future__ import annotations

from onboard.autopilot.base import Envelope
from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import Vec, norm, scale, sub

GAP = 0.4  # [s] without a target: the stream has to begin again


def within(velocity: Vec, envelope: Envelope) -> Vec:
    """The velocity in the same direction [m/s; air, NED] at a speed that speed and climb allow.

    The direction is what a strategy decided: it is kept. Only where the slowest flight in that direction
    would still climb or sink too fast (a plane) is it made flatter.
    """
    speed = norm(velocity)
    if speed <= 1e-6:
        return Vec(0.0, 0.0, 0.0)
    vertical = envelope.climb_max if velocity.z < 0.0 else envelope.sink_max
    factor = min(1.0, envelope.speed_max / speed)
    if abs(velocity.z) * factor > vertical:
        factor = vertical / abs(velocity.z)
    if speed * factor >= envelope.speed_min:
        return scale(velocity, factor)
    slow = envelope.speed_min
    z = velocity.z * slow / speed
    if abs(z) <= vertical:
        return scale(velocity, slow / speed)
    z = vertical if z > 0.0 else -vertical
    level = (velocity.x * velocity.x + velocity.y * velocity.y) ** 0.5
    if level <= 1e-6:
        return Vec(0.0, 0.0, z)  # straight up: a plane has no course to make of it
    along = max(0.0, slow * slow - z * z) ** 0.5 / level
    return Vec(velocity.x * along, velocity.y * along, z)


class Shaper:
    """Wanted velocities over ground → targets a multicopter can follow, one after the other."""

    def __init__(self, envelope: Envelope) -> None:
        self.envelope = envelope
        self._last = Vec(0.0, 0.0, 0.0)
        self._at = NEVER
        self._since = NEVER

    def streamed(self, now: float) -> float:
        """How long targets have been flowing [s]; 0 after a gap."""
        if now - self._at > GAP:
            self._since = NEVER
        return 0.0 if self._since == NEVER else now - self._since

    def restart(self) -> None:
        """The next target begins a new stream."""
        self._since = NEVER

    def shape(self, now: float, wanted: Vec) -> Vec:
        """The target for now: within the envelope, and no further from the last one than it may change."""
        wanted = within(wanted, self.envelope)
        if self.streamed(now) > 0.0 and self.envelope.acceleration > 0.0:
            wanted = towards(self._last, wanted, self.envelope.acceleration * (now - self._at))
        elif self._since == NEVER:
            self._since = now
        self._last, self._at = wanted, now
        return wanted


def towards(last: Vec, wanted: Vec, change: float) -> Vec:
    """`wanted`, or as far from `last` towards it as `change` [m/s] allows."""
    step = sub(wanted, last)
    size = norm(step)
    if size <= change:
        return wanted
    k = change / size
    return Vec(last.x + step.x * k, last.y + step.y * k, last.z + step.z * k)
