"""What of a picture is still being told: a value that is no longer fed is absent, not shown as current.

Whoever shows how things are takes `current(picture)`; whoever shows where somebody was last takes the picture
itself, and says how old that is. Pure.
"""

from __future__ import annotations

from math import inf

from msgspec.structs import replace

from gcs.picture.values import Picture, TrackView, VehicleView
from onboard.wire.bus.messages import Health

MOTION_OLD_S = 2.0  # states (20 Hz), tracks and decisions (10 Hz) older than this are no longer current
HEALTH_OLD_S = 3.0  # heartbeats of agents (2 Hz) and of autopilots (1 Hz)


def current(picture: Picture) -> Picture:
    """The picture without what is too old to be true now."""
    return replace(
        picture, vehicles=tuple(map(_vehicle, picture.vehicles)), tracks=current_tracks(picture)
    )  # fmt: skip


def current_tracks(picture: Picture) -> tuple[TrackView, ...]:
    """The tracks that are still fed."""
    return tuple(track for track in picture.tracks if track.age_s <= MOTION_OLD_S)


def moving(vehicle: VehicleView) -> bool:
    """Whether a vehicle's state is still fed."""
    return vehicle.state is not None and vehicle.state_age_s <= MOTION_OLD_S


def _vehicle(vehicle: VehicleView) -> VehicleView:
    """A vehicle with the messages that are still fed."""
    health = vehicle.health if vehicle.health_age_s <= HEALTH_OLD_S else None
    moves = moving(vehicle)
    decided = vehicle.decision_age_s <= MOTION_OLD_S
    return replace(
        vehicle,
        state=vehicle.state if moves else None,
        state_age_s=vehicle.state_age_s if moves else inf,
        decision=vehicle.decision if decided else None,
        decision_age_s=vehicle.decision_age_s if decided else inf,
        health=None if health is None else _health(health, vehicle.health_age_s),
        health_age_s=inf if health is None else vehicle.health_age_s,
    )


def _health(health: Health, age_s: float) -> Health:
    """A heartbeat without what its agent passes on of an autopilot that it no longer hears."""
    if min(health.heartbeat_age_s, health.telemetry_age_s) + age_s <= HEALTH_OLD_S:
        return health
    return replace(health, mode="", battery=-1.0, link_quality=0.0, telemetry_rate_hz=0.0, gps_fix=0)
