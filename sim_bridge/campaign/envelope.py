"""How far the aircraft of a compiled game went. Kernel style."""

from __future__ import annotations

from typing import NamedTuple

from sim_bridge.campaign.plane_in_wind import Flown
from sim_bridge.vehicle.flight.plane import PlaneModel


class Envelope(NamedTuple):
    """How far the aircraft went, all of them together."""

    pitch_low: float  # [rad]
    pitch_high: float
    speed_low: float  # share of a vehicle's declared airspeed
    speed_high: float
    lowest: float  # height [m]
    surface: float  # largest share of a servo's stroke


UNMOVED = Envelope(0.0, 0.0, 1.0, 1.0, 1e300, 0.0)


def widened(e: Envelope, flown: Flown, model: PlaneModel, declared: float) -> Envelope:
    """The envelope with one more aircraft's state."""
    plane = flown.plane
    surface = max(
        abs(plane.pitch.surface) / model.pitch_law.surface_limit,
        abs(plane.yaw.surface) / model.yaw_law.surface_limit,
    )
    return Envelope(
        min(e.pitch_low, plane.pitch.angle),
        max(e.pitch_high, plane.pitch.angle),
        min(e.speed_low, plane.speed / declared),
        max(e.speed_high, plane.speed / declared),
        min(e.lowest, -plane.position.z),
        max(e.surface, surface),
    )
