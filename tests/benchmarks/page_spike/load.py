"""What both candidates send: the places of so many vehicles at a tick, and when."""

from __future__ import annotations

import struct

import numpy as np

from onboard.runtime.clock import RealClock


def floats(vehicles: int, tick: int) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    """x, y, z, heading of each vehicle, on circles."""
    angle = 0.05 * tick + np.arange(vehicles)
    radius = 100.0 + 5.0 * np.arange(vehicles)
    places = np.column_stack([radius * np.cos(angle), 10.0 + 0.0 * angle, radius * np.sin(angle), -angle])
    return places.astype(np.float32).ravel()


def stamp() -> bytes:
    """Milliseconds since the epoch, as the browser counts them."""
    return struct.pack("<d", RealClock().wall_ns() / 1e6)
