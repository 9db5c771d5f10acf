"""Between geodetic coordinates (WGS-84) and the game frame: scalar code, a matrix per origin precomputed.

North and east are those of the plane tangent to the ellipsoid at the origin; down is the origin's
altitude less the point's, both above mean sea level. At 20 km a tangent plane lies 31 m off level:
so down is measured by altitude, as barometers and autopilots do, and not in that plane. With no
model of the geoid at hand, altitudes stand for heights above the ellipsoid; over the extent of a
game an undulation shifts north and east by its share of the Earth's radius (30 m: 5 parts in a million).
"""

from __future__ import annotations

from math import atan2, cos, degrees, radians, sin, sqrt
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec

A = 6378137.0  # semi-major axis of WGS-84 [m]
F = 1.0 / 298.257223563  # flattening
B = A * (1.0 - F)  # semi-minor axis [m]
E2 = F * (2.0 - F)  # first eccentricity squared
EP2 = E2 / (1.0 - E2)  # second eccentricity squared
CLOSE = 1e-4  # [m] altitude error at which the inverse is content: moves north–east by less than 1 µm
ROUNDS = 20  # of the inverse: two or three are usual, and far beyond a game they still converge


class Geodetic(NamedTuple):
    """A place on Earth."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class Frame:
    """The game frame, or an autopilot's local frame, at one origin.

    `Frame(latitude_deg, longitude_deg, altitude_m)`; the altitude is above mean sea level.
    """

    __slots__ = ("_cl", "_cp", "_h0", "_ke", "_kn", "_sl", "_sp", "_x0", "_y0", "_z0", "origin")

    def __init__(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> None:
        self.origin = Geodetic(latitude_deg, longitude_deg, altitude_m)
        phi, lam = radians(latitude_deg), radians(longitude_deg)
        self._sp, self._cp = sin(phi), cos(phi)
        self._sl, self._cl = sin(lam), cos(lam)
        self._h0 = altitude_m
        w = sqrt(1.0 - E2 * self._sp * self._sp)
        n = A / w  # radius of curvature in the prime vertical
        m = n * (1.0 - E2) / (w * w)  # in the meridian
        self._kn = 0.5 / (m + altitude_m)  # by how much the plane rises above level northwards,
        self._ke = 0.5 / (n + altitude_m)  # and eastwards [1/m]
        r = (n + altitude_m) * self._cp
        self._x0, self._y0 = r * self._cl, r * self._sl
        self._z0 = (n * (1.0 - E2) + altitude_m) * self._sp

    def ned_from_geodetic(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> Vec:
        """Position in this frame [m; NED] of a geodetic one."""
        phi, lam = radians(latitude_deg), radians(longitude_deg)
        s, c = sin(phi), cos(phi)
        n = A / sqrt(1.0 - E2 * s * s)
        r = (n + altitude_m) * c
        x = r * cos(lam) - self._x0
        y = r * sin(lam) - self._y0
        z = (n * (1.0 - E2) + altitude_m) * s - self._z0
        out = self._cl * x + self._sl * y  # away from the Earth's axis, in the origin's meridian
        place = (self._cp * z - self._sp * out, self._cl * y - self._sl * x, self._h0 - altitude_m)
        found = new(Vec, place)
        return found

    def geodetic_from_ned(self, position: Vec) -> Geodetic:
        """Geodetic position of one in this frame [m; NED]; the inverse of `ned_from_geodetic`."""
        north, east, down = position
        altitude = self._h0 - down
        # The plane's own vertical coordinate of that altitude: level plus the Earth's curvature.
        plumb = down + north * north * self._kn + east * east * self._ke
        phi = lam = 0.0
        for _ in range(ROUNDS):
            out = -self._sp * north - self._cp * plumb
            x = self._x0 + self._cl * out - self._sl * east
            y = self._y0 + self._sl * out + self._cl * east
            z = self._z0 + self._cp * north - self._sp * plumb
            p = sqrt(x * x + y * y)
            # Bowring (1985): parametric latitude, then the geodetic one.
            t = atan2(z * A, p * B)
            st, ct = sin(t), cos(t)
            phi = atan2(z + EP2 * B * st * st * st, p - E2 * A * ct * ct * ct)
            s, c = sin(phi), cos(phi)
            error = p * c + z * s - A * sqrt(1.0 - E2 * s * s) - altitude
            lam = atan2(y, x)
            if -CLOSE < error < CLOSE:
                break
            plumb += error
        return Geodetic(degrees(phi), degrees(lam), altitude)
