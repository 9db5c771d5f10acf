"""What moves, as one flat array a tick: little-endian, made once for all browsers. Pure.

A frame is a head (instant [ms since the epoch] and what its vehicles and tracks are counted) and rows of
`WIDTH` float32 numbers, as `VEHICLE` and `TRACK` name them: game frame (north, east, down), metres, m/s, rad.
`static/frames.js` reads it.
"""

from __future__ import annotations

import struct
from math import inf, nan, sqrt

from gcs.console.vehicle_table import Grade, grades
from gcs.picture.current import moving
from gcs.picture.values import Picture, TrackView, VehicleView
from onboard.wire.bus.messages import Role

HEAD = struct.Struct("<dHHI")  # instant [ms], vehicles, tracks, number of the frame (counts up, wraps)
VEHICLE = (
    "id", "role", "grade", "fed", "north", "east", "down", "v_north", "v_east", "v_down",
    "roll", "pitch", "yaw",
)  # fmt: skip
TRACK = (
    "id", "age", "sigma_north", "sigma_east", "north", "east", "down", "v_north", "v_east", "v_down",
    "sigma_down", "sensor", "spare",
)  # fmt: skip
WIDTH = len(VEHICLE)
ROLES = (None, Role.EVADER, Role.PURSUER, Role.TRACKER)  # by their number in a frame
_ROW = struct.Struct(f"<{WIDTH}f")
AGE_MAX = 1e6  # [s] in place of infinity
assert len(TRACK) == WIDTH


def frame(picture: Picture, number: int = 0) -> bytes:
    """The frame of a picture. A vehicle that was never located is left out."""
    graded = grades(picture)
    vehicles = [
        _ROW.pack(*_vehicle(vehicle, graded[vehicle.id], moving(vehicle)))
        for vehicle in picture.vehicles
        if vehicle.state is not None
    ]
    tracks = [_ROW.pack(*_track(track)) for track in picture.tracks]
    head = HEAD.pack(picture.now_ns / 1e6, len(vehicles), len(tracks), number & 0xFFFFFFFF)
    return b"".join((head, *vehicles, *tracks))


def _vehicle(vehicle: VehicleView, grade: Grade, fed: bool) -> tuple[float, ...]:
    state = vehicle.state
    assert state is not None
    role = ROLES.index(vehicle.role) if vehicle.role in ROLES else 0
    return (
        vehicle.id, role, int(grade), float(fed), *state.position, *state.velocity,
        state.roll, state.pitch, state.yaw,
    )  # fmt: skip


def _track(view: TrackView) -> tuple[float, ...]:
    track = view.track
    north, east, down = (sqrt(v) if 0.0 <= v < inf else nan for v in track.covariance[:3])
    return (
        view.id, min(view.age_s, AGE_MAX), north, east, *track.position, *track.velocity, down, 0.0, 0.0,
    )  # fmt: skip
