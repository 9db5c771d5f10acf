"""Vectors of the game frame: x north, y east, z down [m or m/s]; the plane game keeps z = 0.

Kernel style: plain functions over floats and NamedTuples, no arrays, no exceptions. The same
source runs interpreted onboard and compiled in simulations.
"""

from __future__ import annotations

from math import atan2, cos, inf, sin, sqrt
from typing import NamedTuple

from onboard.core.math.each import new

TINY = 1e-12  # lengths [m] and speeds [m/s] below this count as zero


class Vec(NamedTuple):
    """A vector in the game frame (north, east, down)."""

    x: float  # north
    y: float  # east
    z: float  # down


ZERO = Vec(0.0, 0.0, 0.0)
NORTH = Vec(1.0, 0.0, 0.0)
DOWN = Vec(0.0, 0.0, 1.0)


def add(a: Vec, b: Vec) -> Vec:
    """a + b."""
    return new(Vec, (a.x + b.x, a.y + b.y, a.z + b.z))


def sub(a: Vec, b: Vec) -> Vec:
    """a − b."""
    return new(Vec, (a.x - b.x, a.y - b.y, a.z - b.z))


def scale(a: Vec, k: float) -> Vec:
    """k a."""
    return new(Vec, (a.x * k, a.y * k, a.z * k))


def along(a: Vec, u: Vec, k: float) -> Vec:
    """a + k u: the point k ahead of a in the direction u."""
    return new(Vec, (a.x + u.x * k, a.y + u.y * k, a.z + u.z * k))


def dot(a: Vec, b: Vec) -> float:
    """a · b."""
    return a.x * b.x + a.y * b.y + a.z * b.z


def cross(a: Vec, b: Vec) -> Vec:
    """a × b (right-handed in north, east, down)."""
    return new(Vec, (a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x))


def norm(a: Vec) -> float:
    """|a|."""
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z)


def distance(a: Vec, b: Vec) -> float:
    """|a − b|."""
    x = a.x - b.x
    y = a.y - b.y
    z = a.z - b.z
    return sqrt(x * x + y * y + z * z)


def is_finite(a: Vec) -> bool:
    """Whether no component of a is NaN or infinite."""
    return -inf < a.x < inf and -inf < a.y < inf and -inf < a.z < inf


def unit(a: Vec, otherwise: Vec) -> Vec:
    """a / |a|, or `otherwise` where a has no length."""
    n = sqrt(a.x * a.x + a.y * a.y + a.z * a.z)
    if n <= TINY:
        return otherwise
    k = 1.0 / n
    return new(Vec, (a.x * k, a.y * k, a.z * k))


def clamp(value: float, low: float, high: float) -> float:
    """The value nearest to `value` in [low, high]."""
    return low if value < low else (high if value > high else value)


def angle_between(u: Vec, v: Vec) -> float:
    """Angle between two unit vectors [rad], accurate near 0 and π."""
    return atan2(norm(cross(u, v)), dot(u, v))


def direction(pitch: float, yaw: float) -> Vec:
    """Unit vector of pitch θ (up) and yaw ψ (north to east) [rad]; (7)–(8)."""
    c = cos(pitch)
    return new(Vec, (c * cos(yaw), c * sin(yaw), -sin(pitch)))


def pitch_of(u: Vec) -> float:
    """Pitch θ of a direction [rad, up positive]."""
    return atan2(-u.z, sqrt(u.x * u.x + u.y * u.y))


def yaw_of(u: Vec) -> float:
    """Yaw ψ of a direction [rad, north 0, east π/2]."""
    return atan2(u.y, u.x)
