"""To one's place in time for the start of a game: so that what is flown begins as what is computed does.

A plane meets its place at t₀ with the heading that the scenario asks for, at the game's airspeed; until then
it circles. Its path is planned in the air mass, which carries plane and place alike, and is flown a little
slower than the aircraft can fly: what gusts take is made up for on the way. A multicopter waits at its place
with its nose that way. Both fly at the height of the place.
"""

from __future__ import annotations

from math import atan2, cos, exp, isnan, sin
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec, along, clamp, norm, sub
from onboard.core.route.arrival import Arrival, Path, Pose, arrive, at, shortest
from onboard.core.safety.envelope import bounded, slewed
from onboard.core.safety.policy import Envelope
from onboard.pilot.setup import Own

FARTHEST = 1500.0  # [m] from its place a vehicle does not fly there by itself, or
FARTHEST_TURNS = 3.0  # radii of a plane's turn
HEIGHT_GAIN = 0.5  # [1/s] to the height
CLIMB_SHARE = 0.3  # of the speed that climbing may use
GAIN = 0.25  # [1/s] of leading back to the path near the end;
GAIN_FAR = 0.1  # before, where a wind that is told anew moves the place by all the time that is left
CALLS = 4.0  # GAIN of an error that there is this many times its reciprocal time for
AVERAGED = 60.0  # [s] over which the wind is averaged: what the air does until t₀ is not what it does now;
FIRST = 20.0  # [s] that count for the first word on it
DRIFT = 3.0  # [s] in which it is learned how gusts carry the plane along
LASTS = 12.0  # [s] in which that dies away: some 500 m of air at this speed
AUTHORITY = 0.12  # of the speed that making up for it may take and give, and for an error along the path
MOST_ACROSS = 0.5  # of the speed
LEAD = 0.9  # [s] by which a plane's turn lags behind its course command,
SPEED_LEAD = 1.0  # and its airspeed behind what is commanded
GATHER = 4.0  # [s] before t₀ a plane begins to take up the game's airspeed
LAST = 4.0  # [s] of straight flight before the place, or a radius of its turn if that takes longer
LAST_LEAST = 1.5  # [s] of what is planned again later, or
SHORTER = 0.5  # of the last line: what makes a plane late is so made up for
LOOK_EVERY = 2.0  # [s] a plane looks whether it has lost its path
ASTRAY = 0.3  # [s] of flight from it: then it looks for another one,
ASTRAY_FAR = 0.01  # [s] more for every second left
PUT_OFF = 0.1  # [s] more time than before: t₀ was put off
SHARE = 0.3  # of what it can make up for: so much lost, and it looks for another one, too
LOST = 2.0  # [s] of flight that it will miss its place by: then it says that it will be late
TURNS = 0.05  # [rad] of a turn between two looks that tells how tightly a plane turns
FELL_SHORT = 0.7  # of the turn that was told, for that
WIDENS = 1.5  # times at most in one look
WIDEST = 2.5  # times the radius that may be counted on, in all
SLACK = 1.5  # [s] more than the shortest way that a plane asks for
WIDER = 1.25  # times the radius that may be counted on: what lags in a turn is made up for within it
RESERVE = 0.5  # of its range of airspeeds that a plane keeps for making up for lost time: who is early
# can also turn away and back
PACES = (1.0, 1.02, 0.98, 1.04, 0.96, 0.93, 0.9, 0.86)  # of that at which a plane looks for a path that fits
LONGEST = 600.0  # [s] that no way takes: who needs more cannot get there against the wind
LATEST, LATER = 120, 2  # [s] that a plane says at most it will be late, and by steps of
THERE = 2.0  # [m] from its place a multicopter is at it
SETTLES = 3.0  # [s] for a multicopter to come to rest
INSIDE = 0.999  # of what the limits let a step change


class Place(NamedTuple):
    """Where a vehicle is to be at t₀, and how it may fly there."""

    position: Vec  # [m; NED]; a NaN down: as high as it is
    heading: float | None  # [rad]; None: any
    speed: float  # [m/s; air] that the game reckons with
    slowest: float  # [m/s; air] that a plane may fly
    envelope: Envelope  # what the supervisor lets pass


class Approach:
    """Leads one vehicle to its place. Give it the own state, and the time left to t₀ [s]."""

    def __init__(self, place: Place) -> None:
        self.place = place
        e = place.envelope
        self._path: Path | None = None
        self._looked_at = 0.0  # time left then [s]
        most = e.speed_max - RESERVE * (e.speed_max - min(place.slowest, e.speed_max))
        self._reserved = max(min(place.speed, most), place.slowest)
        self._pace = self._reserved  # [m/s; air] along the path, until the plane gathers speed
        self._left = 0.0  # time left in the last step [s]
        self._late = 0.0  # by which the path is too long [s]
        self._radius = max(1.0, WIDER * e.turn_radius)  # [m] of the paths; grows where it is not kept
        self._course = self._told = 0.0  # [rad] through the air at the last look, flown and told
        self._short = False  # its turn fell short of what was told
        self._behind = 0.0  # where the path says that it is now [m], and
        self._beside = 0.0  # to one side [m]
        self._wind: Vec | None = None  # in the mean [m/s]
        self._heard = 0.0  # [s] of wind in that
        self._flown = place.speed  # [m/s] that its airspeed should be by what was commanded
        self._drift = 0.0  # [m/s] by which it is faster, as gusts carry it
        self._demand: Vec | None = None  # the last velocity [m/s; air]

    def distance(self, own: Own) -> float:
        """To the place, as seen from above [m]."""
        x, y, _ = sub(self.place.position, own.position)
        return float((x * x + y * y) ** 0.5)

    def reaches(self, own: Own) -> bool:
        """Whether the vehicle flies there by itself: it is on its way, or not too far away."""
        return self._path is not None or self.distance(own) <= self._farthest

    def needs(self, own: Own) -> float:
        """Time that the vehicle needs to be at its place [s]; 0 where it is there, or too far away."""
        way = self.distance(own)
        speed = max(0.1, self.place.speed)
        own = own if self._wind is None else own._replace(wind=self._wind)
        if way > self._farthest:
            return 0.0
        if self.place.envelope.hovers:
            braking = self.place.envelope.deceleration
            return 0.0 if way <= THERE else way / speed + speed / braking + SETTLES
        time = self._soonest(own)
        return time + self._longer(own, time)

    def _soonest(self, own: Own) -> float:
        """Time that the plane's shortest way takes, and some to spare [s]."""
        closing = self._reserved / (self._reserved + norm(own.wind))
        time = 0.0
        while time < LONGEST:  # the place moves in the air while the plane is on its way
            start, goal = self._poses(own, time)
            length = shortest(start, goal, self._radius, self._last()).length
            late = (length - self._to_go(time, self._reserved)) / max(0.1, self._reserved) + SLACK
            if late <= 0.0:
                break
            time += max(closing * late, 0.1)  # from below: the place may come towards the plane
        return time

    def misses(self, own: Own, left: float) -> float:
        """Time by which the vehicle would be late [s] with `left` seconds to t₀; 0 where a way fits."""
        path = self._path
        if not self.place.envelope.hovers and path is not None and left <= self._left + PUT_OFF:
            return self._late
        return max(0.0, self.needs(own) - left)

    def steer(self, own: Own, left: float) -> Vec:
        """Velocity to fly [m/s]: a multicopter's over ground, a plane's through the air.

        A plane's changes no faster than its envelope lets it.
        """
        offset = sub(self.place.position, own.position)
        most = CLIMB_SHARE * self.place.speed
        down = 0.0 if isnan(offset.z) else clamp(HEIGHT_GAIN * offset.z, -most, most)
        if self.place.envelope.hovers:
            way = max(1e-6, self.distance(own))
            pace = min(self.place.speed, 0.8 * way, (self.place.envelope.deceleration * way) ** 0.5)
            return Vec(offset.x / way * pace, offset.y / way * pace, down)
        gone = self._left - left  # since the last step [s]
        raw, own = own, self._learn(own, clamp(gone, 0.0, 1.0))
        self._plan(own, left)
        wanted = self._led(own, left, down)
        return self._kept(raw, through(wanted, own.wind, raw.wind), gone)

    # ------------------------------------------------------------------ planes

    @property
    def _farthest(self) -> float:
        return max(FARTHEST, FARTHEST_TURNS * self.place.envelope.turn_radius)

    def _last(self) -> float:
        """The last straight line [m]: what turns and gusts have left behind dies away on it."""
        return max(LAST * self.place.speed, WIDER * self.place.envelope.turn_radius)

    def _poses(self, own: Own, left: float) -> tuple[Pose, Pose]:
        """The own pose and the goal's in the air, which carries both until t₀."""
        air = sub(own.velocity, own.wind)
        start = Pose(0.0, 0.0, atan2(air.y, air.x))
        x, y, _ = sub(self.place.position, own.position)
        heading = start.heading if self.place.heading is None else self.place.heading
        return start, Pose(x - own.wind.x * left, y - own.wind.y * left, heading)

    def _learn(self, own: Own, dt: float) -> Own:
        """The own state in the wind's mean; learns by how much gusts make it faster."""
        if self._wind is None:
            self._wind = own.wind
        self._heard += dt
        share = dt / clamp(self._heard, FIRST, AVERAGED)
        self._wind = along(self._wind, sub(own.wind, self._wind), share)
        own = own._replace(wind=self._wind)
        air, before, most = sub(own.velocity, own.wind), self._demand, AUTHORITY * self.place.speed
        if before is None:
            self._flown = norm(air)
            return own
        self._flown += min(1.0, dt / SPEED_LEAD) * (norm(before) - self._flown)
        more = clamp(norm(air) - self._flown, -most, most)
        self._drift += min(1.0, dt / DRIFT) * (more - self._drift)
        return own

    def _to_go(self, left: float, pace: float) -> float:
        """Length of the path that is flown in the time that is left [m]: at its pace, then gathering speed,
        and carried along by the gust of now while it lasts."""
        carried = self._drift * LASTS * (1.0 - exp(-max(0.0, left) / LASTS))
        gains = self.place.speed - pace
        if left <= GATHER:
            return self.place.speed * left - gains * left * left / (2.0 * GATHER) + carried
        return pace * left + 0.5 * gains * GATHER + carried

    def _speed_at(self, left: float) -> float:
        """Airspeed that flies along the path in time [m/s], the game's at t₀."""
        share = clamp(1.0 - left / GATHER, 0.0, 1.0)
        return self._pace + share * (self.place.speed - self._pace)

    def _led(self, own: Own, left: float, down: float) -> Vec:
        """Velocity along the path and back to it."""
        assert self._path is not None
        path, speed = self._path, self.place.speed
        gone = path.length - self._to_go(left, self._pace)
        end, here = at(path, path.length), at(path, gone)
        later = at(path, gone + LEAD * self._speed_at(left)).heading
        _, goal = self._poses(own, left)
        # Where the path says that the plane is, from where it is: both are carried by the same air.
        x, y = goal.x - (end.x - here.x), goal.y - (end.y - here.y)
        c, s = cos(here.heading), sin(here.heading)
        self._behind, self._beside = x * c + y * s, y * c - x * s
        gain = clamp(CALLS / max(left, 1.0), GAIN_FAR, GAIN)
        along, across = gain * self._behind, gain * self._beside
        most = AUTHORITY * speed
        e = self.place.envelope
        pace = self._speed_at(left - SPEED_LEAD) + clamp(along, -most, most)
        pace = clamp(pace, min(self.place.slowest, speed), max(speed, e.speed_max))
        level = max(0.0, pace * pace - down * down) ** 0.5
        across = clamp(across, -MOST_ACROSS * level, MOST_ACROSS * level)
        ahead = max(0.0, level * level - across * across) ** 0.5
        cross = later + atan2(across, ahead)
        return Vec(level * cos(cross), level * sin(cross), down)

    def _kept(self, own: Own, wanted: Vec, dt: float) -> Vec:
        """The velocity within what the supervisor lets pass, after the last one."""
        e, before = self.place.envelope, self._demand
        air = sub(own.velocity, own.wind)
        if before is None or dt > 1.0:
            before, dt = bounded(air, wanted, e).velocity, 0.0
        dt = max(0.0, INSIDE * dt)  # none where t₀ was put off
        kept = slewed(bounded(wanted, before, e).velocity, before, dt, e).velocity
        self._demand = kept = bounded(kept, before, e).velocity
        return kept

    def _plan(self, own: Own, left: float) -> None:
        """Make the path, and make it again where the plane has lost it, or t₀ was put off."""
        path, speed = self._path, self.place.speed
        put_off = left > self._left + PUT_OFF
        self._left = left
        if path is not None and not put_off:
            if self._looked_at - left < LOOK_EVERY:
                return
            lost = self._lost(left)
            if lost:
                self._widen(own)
            self._looked_at, (self._course, self._told) = left, self._headings(own)
            if not lost:
                self._late = 0.0
                return
        self._looked_at, (self._course, self._told) = left, self._headings(own)
        first = path is None or put_off
        last = self._last() if first else max(LAST_LEAST * speed, SHORTER * self._last())
        found, pace = self._found(own, left, last)
        if found.exact:
            self._path, self._pace, self._late = found.path, pace, 0.0
        elif first:  # there is none: on the shortest until there is more time
            self._path, self._pace = found.path, self._reserved
            self._late = self._too_early(own, left)
        else:  # who has one keeps it, and asks for more time where it is far from it
            late = self._missing(left) > LOST * speed
            self._late = self._too_early(own, left) if late else 0.0

    def _lost(self, left: float) -> bool:
        """Whether another path is better: this one takes too much of what can be made up for in time."""
        allowed = (ASTRAY + ASTRAY_FAR * left) * self.place.speed
        return abs(self._beside) > allowed or self._missing(left, SHARE) > 0.0

    def _missing(self, left: float, share: float = 1.0) -> float:
        """By how much the plane will miss its place [m] with a share of the airspeeds that it may fly."""
        e, time = self.place.envelope, max(0.0, left - GATHER)
        slowest = min(self.place.slowest, self.place.speed)
        more = share * (max(self.place.speed, e.speed_max) - self._pace) * time
        less = share * (self._pace - slowest) * time
        return max(self._behind - more, -self._behind - less, 0.0)

    def _found(self, own: Own, left: float, last: float) -> tuple[Arrival, float]:
        """A path, and the airspeed [m/s] at which it takes the time that is left."""
        slowest = min(self.place.slowest, self.place.speed)
        paces = dict.fromkeys(clamp(s * self._reserved, slowest, self.place.speed) for s in PACES)
        poses = self._poses(own, left)
        for pace in paces:
            found = arrive(*poses, self._radius, self._to_go(left, pace), last)
            if found.exact:
                return found, pace
        # Straight in, a path is as long as it is: at what airspeed it takes the time.
        short = shortest(*poses, self._radius, last)
        gathered = 0.5 * GATHER * (self.place.speed + self._drift)
        pace = (short.length - gathered) / max(left - 0.5 * GATHER, GATHER)
        return Arrival(slowest <= pace <= self.place.speed, short), pace

    def _too_early(self, own: Own, left: float) -> float:
        """By how much t₀ is too early for the way there is, and to hear of another t₀ meanwhile [s]."""
        time = max(left, self._soonest(own)) + SLACK
        return time - left + self._longer(own, time)

    def _longer(self, own: Own, left: float) -> float:
        """Time by which t₀ is too early for any path at a pace that can still be made faster [s]."""
        fast = 0.5 * (self._reserved + self.place.speed)
        for more in range(0, LATEST, LATER):
            found, pace = self._found(own, left + more, self._last())
            if found.exact and pace <= fast:
                return float(more)
        return float(LATEST)

    def _widen(self, own: Own) -> None:
        """Reckon with the turn made since the last look, if that falls short for long."""
        course, told = self._headings(own)
        asked, made = wrap(told - self._told), wrap(course - self._course)
        before, self._short = self._short, abs(asked) > TURNS and made * asked < FELL_SHORT * asked * asked
        if before and self._short:  # not as it begins to turn
            widest = WIDEST * WIDER * self.place.envelope.turn_radius
            self._radius = min(widest, self._radius * min(abs(asked) / max(abs(made), TURNS), WIDENS))

    def _headings(self, own: Own) -> tuple[float, float]:
        """The course through the air, and that which was told last [rad]."""
        course = self._poses(own, 0.0)[0].heading
        return course, course if self._demand is None else atan2(self._demand.y, self._demand.x)


def through(air: Vec, mean: Vec, now: Vec) -> Vec:
    """The velocity through the air of now [m/s] that flies over ground where `air` does in the mean wind."""
    x, y = air.x + mean.x, air.y + mean.y
    ground = (x * x + y * y) ** 0.5
    level = (air.x * air.x + air.y * air.y) ** 0.5
    if ground < 1e-6:
        return air
    x, y = x / ground, y / ground
    across = now.y * x - now.x * y
    if abs(across) >= level:
        return air
    ahead = (level * level - across * across) ** 0.5
    return Vec(ahead * x + across * y, ahead * y - across * x, air.z)
