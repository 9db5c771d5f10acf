"""To one's place in time for the start of a game: so that what is flown begins as what is computed does.

A plane meets its place at t₀ with the heading that the scenario asks for, at its airspeed; until then it
circles. A multicopter waits there with its nose that way. Both fly at the height of the place.
"""

from __future__ import annotations

from math import atan2, cos, isnan, sin
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec, clamp, sub
from onboard.core.route.arrival import Path, Pose, arrive, at
from onboard.pilot.setup import Own

FARTHEST = 1500.0  # [m] from its place a vehicle does not fly there by itself
GAIN = 0.25  # [1/s] of leading back to the path, and
HEIGHT_GAIN = 0.5  # [1/s] to the height
CLIMB_SHARE = 0.3  # of the speed that climbing may use
LEAD = 0.9  # [s] by which a plane's turn lags behind its course command
LAST = 4.0  # [s] of straight flight before the place; what is planned again later may have less
LAST_LEAST = 1.5  # [s]
LOOK_EVERY = 2.0  # [s] a plane looks whether it has lost its path
ASTRAY = 0.6  # [s] of flight from it: then it looks for another one
PUT_OFF = 0.1  # [s] more time than before: t₀ was put off
LOST = 2.5  # [s] of flight from it: then it takes another one, though it be late by it
TURNS = 0.05  # [rad] of a turn between two looks that tells how tightly a plane turns
WIDENS = 2.0  # times at most in one look
SLACK = 3.0  # [s] more than the shortest way that a plane asks for
WIDER = 1.25  # times the radius that may be counted on: what lags in a turn is made up for within it
PACES = (1.0, 0.95, 0.9, 0.85, 0.8)  # of its airspeed at which a plane looks for a path that fits
SLOWER, FASTER = 0.95, 1.05  # of that pace where it is early, or late
THERE = 2.0  # [m] from its place a multicopter is at it
SETTLES = 3.0  # [s] for a multicopter to come to rest


class Place(NamedTuple):
    """Where a vehicle is to be at t₀, and how it may fly there."""

    position: Vec  # [m; NED]; a NaN down: as high as it is
    heading: float | None  # [rad]; None: any
    speed: float  # [m/s; air] that the game reckons with
    slowest: float  # [m/s; air] that a plane may fly
    hovers: bool
    radius: float  # [m] of a plane's turn that may be counted on
    braking: float  # [m/s²] of a multicopter


class Approach:
    """Leads one vehicle to its place. Give it the own state, and the time left to t₀ [s]."""

    def __init__(self, place: Place) -> None:
        self.place = place
        self._path: Path | None = None
        self._looked_at = 0.0  # time left then [s]
        self._start_left = 0.0  # time left at the path's start [s]
        self._pace = place.speed  # [m/s; air] along the path
        self._left = 0.0  # time left in the last step [s]
        self._late = 0.0  # by which the path is too long [s]
        self._wide = max(1.0, WIDER * place.radius)  # [m] radius of the paths; grows where it is not kept
        self._course = 0.0  # [rad] through the air, at the last look
        self._astray = 0.0  # from where the path says that it is now [m]

    def distance(self, own: Own) -> float:
        """To the place, as seen from above [m]."""
        x, y, _ = sub(self.place.position, own.position)
        return float((x * x + y * y) ** 0.5)

    def reaches(self, own: Own) -> bool:
        """Whether the vehicle flies there by itself: it is on its way, or not too far away."""
        return self._path is not None or self.distance(own) <= FARTHEST

    def needs(self, own: Own) -> float:
        """Time that the vehicle needs to be at its place [s]; 0 where it is there, or too far away."""
        way = self.distance(own)
        speed = max(0.1, self.place.speed)
        if way > FARTHEST:
            return 0.0
        if self.place.hovers:
            return 0.0 if way <= THERE else way / speed + speed / self.place.braking + SETTLES
        start, goal = self._poses(own, 0.0)
        shortest = arrive(start, goal, self._wide, 0.0, LAST * speed).path.length
        return shortest / speed + SLACK

    def misses(self, own: Own, left: float) -> float:
        """Time by which the vehicle would be late [s] with `left` seconds to t₀; 0 where a way fits."""
        path = self._path
        if not self.place.hovers and path is not None and left <= self._left + PUT_OFF:
            return self._late
        return max(0.0, self.needs(own) - left)

    def steer(self, own: Own, left: float) -> Vec:
        """Velocity to fly [m/s]: a multicopter's over ground, a plane's through the air."""
        offset = sub(self.place.position, own.position)
        most = CLIMB_SHARE * self.place.speed
        down = 0.0 if isnan(offset.z) else clamp(HEIGHT_GAIN * offset.z, -most, most)
        if self.place.hovers:
            way = max(1e-6, self.distance(own))
            pace = min(self.place.speed, 0.8 * way, (self.place.braking * way) ** 0.5)
            return Vec(offset.x / way * pace, offset.y / way * pace, down)
        return self._flown(own, left, down)

    # ------------------------------------------------------------------ planes

    def _poses(self, own: Own, left: float) -> tuple[Pose, Pose]:
        """The own pose and the goal's in the air, which carries both until t₀."""
        air = sub(own.velocity, own.wind)
        start = Pose(0.0, 0.0, atan2(air.y, air.x))
        x, y, _ = sub(self.place.position, own.position)
        heading = start.heading if self.place.heading is None else self.place.heading
        return start, Pose(x - own.wind.x * left, y - own.wind.y * left, heading)

    def _flown(self, own: Own, left: float, down: float) -> Vec:
        self._plan(own, left)
        assert self._path is not None
        speed = self._pace
        gone = speed * (self._start_left - left)
        end = at(self._path, self._path.length)
        here = at(self._path, gone)
        later = at(self._path, gone + LEAD * speed)
        _, goal = self._poses(own, left)
        # Where the path says that the plane is, from where it is: both are carried by the same air.
        astray_x, astray_y = goal.x - (end.x - here.x), goal.y - (end.y - here.y)
        self._astray = (astray_x * astray_x + astray_y * astray_y) ** 0.5
        back = min(1.0, 0.5 * speed / max(1e-6, GAIN * self._astray))
        x = speed * cos(later.heading) + back * GAIN * astray_x
        y = speed * sin(later.heading) + back * GAIN * astray_y
        size = max(1e-6, (x * x + y * y) ** 0.5)
        fastest = self.place.speed
        most = clamp(fastest * fastest - down * down, 0.0, fastest * fastest) ** 0.5
        pace = clamp(size, SLOWER * speed, min(most, FASTER * speed))
        return Vec(x / size * pace, y / size * pace, down)

    def _plan(self, own: Own, left: float) -> None:
        """Make the path, and make it again where the plane has lost it, or t₀ was put off."""
        path, speed = self._path, self.place.speed
        put_off = left > self._left + PUT_OFF
        self._left = left
        if path is not None and not put_off:
            if self._looked_at - left < LOOK_EVERY:
                return
            lost = self._astray > ASTRAY * speed
            if lost:
                self._widen(own, left, path)
            self._looked_at, self._course = left, self._poses(own, left)[0].heading
            if not lost:
                return
        start, goal = self._poses(own, left)
        self._looked_at, self._course = left, start.heading
        last = LAST if path is None or put_off else LAST_LEAST
        for share in PACES:
            pace = max(share * speed, min(speed, self.place.slowest))
            found = arrive(start, goal, self._wide, pace * left, last * speed)
            if found.exact:
                break
        if path is not None and not (found.exact or put_off or self._astray > LOST * speed):
            return  # there is none, and this one is not far
        self._path, self._start_left, self._pace = found.path, left, pace if found.exact else speed
        self._late = 0.0 if found.exact else max(0.0, found.path.length / speed + SLACK - left)

    def _widen(self, own: Own, left: float, path: Path) -> None:
        """Reckon with the turn that the plane has made since the last look, where it fell short."""
        speed = self._pace
        gone, before = speed * (self._start_left - left), speed * (self._start_left - self._looked_at)
        asked = abs(wrap(at(path, gone).heading - at(path, before).heading))
        made = abs(wrap(self._poses(own, left)[0].heading - self._course))
        if asked > TURNS and made < asked:
            self._wide *= min(asked / max(made, TURNS), WIDENS)
