"""Where a game wants its vehicle at t₀, and how to get there in time: what `pilot.approach` is told."""

from __future__ import annotations

from math import cos, sin

from onboard.autopilot.base import Telemetry
from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO, Vec, along, clamp, direction, sub
from onboard.core.safety.envelope import bounded
from onboard.core.safety.policy import Envelope, Policy
from onboard.pilot.approach import LEAD, WIDER, Approach, Place
from onboard.pilot.setup import GameSetup, Own
from onboard.wire.bus.messages import Member

WIND_FRESH_S = 10.0
SPARE = 1.05  # times its least airspeed is as slow as a plane flies to its place
NOSE_FRESH_S = 0.5
CARRIED_S = 0.5  # a position is carried forward by its velocity for no longer


def own_state(now: float, t: Telemetry, *, hovers: bool) -> Own:
    """The own state at `now` [s, monotonic]: its last position carried forward, and for planes the wind."""
    wind = ZERO if hovers or now - t.wind_at >= WIND_FRESH_S else t.wind
    position = along(t.position, t.velocity, clamp(now - t.position_at, 0.0, CARRIED_S))
    nose = ZERO
    if not hovers and now - t.attitude_at < NOSE_FRESH_S:
        nose = direction(t.pitch, t.yaw)
    return new(Own, (position, t.velocity, wind, nose))


def by_itself(own: Own, envelope: Envelope) -> Vec:
    """Velocity through the air [m/s] of a plane that is not led, within its limits: gusts are no decision."""
    air = sub(own.velocity, own.wind)
    return bounded(air, air, envelope).velocity


def circling(own: Own, envelope: Envelope) -> Vec:
    """Velocity through the air [m/s] that keeps a plane turning to the right, within its limits."""
    air, radius = by_itself(own, envelope)._replace(z=0.0), envelope.turn_radius
    speed = (air.x * air.x + air.y * air.y) ** 0.5
    lead = min(1.0, LEAD * speed / max(1.0, WIDER * radius))
    c, s = cos(lead), sin(lead)
    return Vec(c * air.x - s * air.y, s * air.x + c * air.y, 0.0)


def approach_of(member: Member, game: GameSetup, policy: Policy) -> Approach | None:
    """The way to a vehicle's place in a game; None where the roster names no speed for it."""
    player, e = game.player(member.id), policy.envelope
    if player is None:
        return None
    height = policy.layer if policy.layered else player.height
    speed = member.speed if 0.0 < member.speed <= e.speed_max else e.speed_max
    place = Vec(member.start[0], member.start[1], -height)
    slowest = min(speed, SPARE * e.speed_min)
    return Approach(Place(place, member.heading, speed, slowest, e))
