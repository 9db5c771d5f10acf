"""Arriving at a place at an instant with a heading: turn, fly straight, turn, and a last straight line.

Kernel style, in the air mass as seen from above, where a plane flies at constant airspeed and the wind is
nothing: places are (north, east) [m] from where the plane is now. The shortest such paths are Dubins' (1957,
Am. J. Math. 79). Who has time left circles first, and the last line is drawn out until the path takes exactly
as long as there is time: a holding pattern timed to the instant. Where drawing it out makes no difference, as
for who flies straight in, the path turns away first and comes back.
"""

from __future__ import annotations

from math import atan2, cos, floor, sin, sqrt
from typing import NamedTuple

from onboard.core.math.angles import TURN, wrap

STEPS = 32  # of one search for the length of the last line
HALVINGS = 30  # that then find it
AWAY = (0.0, 0.2, 0.4, 0.8, 1.4, 2.0)  # [rad] of the turns away that are tried
ROUNDING = 1e-9  # [rad] a turn this close to a full circle is none


class Pose(NamedTuple):
    """A place seen from above, and where the nose points."""

    x: float  # [m; north]
    y: float  # [m; east]
    heading: float  # [rad, north to east]


class Path(NamedTuple):
    """Turn, straight, turn: then the last line to the goal. Turns to the right are positive."""

    start: Pose
    radius: float  # [m] of all turns
    away: float  # [rad, signed] flown before, to the other side than the first turn, and
    out: float  # [m] straight on
    first: float  # [rad, signed] with the circles that are flown before
    straight: float  # [m]
    second: float  # [rad, signed]
    last: float  # [m]

    @property
    def length(self) -> float:
        """[m]."""
        turns = abs(self.away) + abs(self.first) + abs(self.second)
        return self.radius * turns + self.out + self.straight + self.last


class Arrival(NamedTuple):
    """A path whose length is what was asked for, or where there is none the shortest that was found."""

    exact: bool
    path: Path


def turned(start: Pose, radius: float, angle: float) -> Pose:
    """Where a turn ends; `angle` is positive to the right [rad]."""
    side = 1.0 if angle >= 0.0 else -1.0
    later = start.heading + angle
    x = start.x + side * radius * (sin(later) - sin(start.heading))
    y = start.y - side * radius * (cos(later) - cos(start.heading))
    return Pose(x, y, wrap(later))


def ahead(start: Pose, length: float) -> Pose:
    """Where a straight line ends [m]."""
    return Pose(start.x + length * cos(start.heading), start.y + length * sin(start.heading), start.heading)


def at(path: Path, length: float) -> Pose:
    """Where the path is after a length [m]; it goes on straight at both ends."""
    here = path.start
    if length <= 0.0:
        return ahead(here, length)
    for angle, line in ((path.away, path.out), (path.first, path.straight), (path.second, path.last)):
        arc = path.radius * abs(angle)
        if length <= arc:
            return turned(here, path.radius, angle * length / arc)
        here = turned(here, path.radius, angle)
        length -= arc
        if length <= line:
            return ahead(here, length)
        here = ahead(here, line)
        length -= line
    return ahead(here, length)


def joined(start: Pose, goal: Pose, radius: float, first: float, second: float, last: float) -> Path:
    """The path whose turns go to the sides `first` and `second` (1 right, −1 left), with a last line [m].

    A negative `straight` means that there is none: the circles of turns to different sides overlap.
    """
    a, straight, b = legs(start, ahead(goal, -last), radius, first, second)
    return Path(start, radius, 0.0, 0.0, first * a, straight, second * b, last)


def legs(start: Pose, entry: Pose, radius: float, first: float, second: float) -> tuple[float, float, float]:
    """The turn, the straight line and the turn that join two poses: [rad, unsigned], [m], [rad, unsigned].

    Sides and a negative line as in `joined`.
    """
    x = entry.x - second * radius * sin(entry.heading) - start.x + first * radius * sin(start.heading)
    y = entry.y + second * radius * cos(entry.heading) - start.y - first * radius * cos(start.heading)
    square = x * x + y * y
    course = atan2(y, x)
    if first != second:
        square -= 4.0 * radius * radius
        if square < 0.0:
            return 0.0, -1.0, 0.0
        course += first * atan2(2.0 * radius, sqrt(square))
    a = _sweep(first * (course - start.heading))
    return a, sqrt(square), _sweep(second * (entry.heading - course))


def shortest(start: Pose, goal: Pose, radius: float, last: float) -> Path:
    """The shortest path with a last line of exactly `last` [m]."""
    best = joined(start, goal, radius, 1.0, 1.0, last)
    for first, second in ((-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        path = joined(start, goal, radius, first, second, last)
        if path.straight >= 0.0 and path.length < best.length:
            best = path
    return best


class Family(NamedTuple):
    """Paths to a goal that differ in the length of one line: the last, or where they turn away, that away."""

    start: Pose
    goal: Pose
    radius: float  # [m]
    first: float  # 1 right, −1 left
    second: float
    least: float  # last line [m]
    length: float  # [m] that is wanted
    away: float  # [rad] by which they turn away first


def arrive(start: Pose, goal: Pose, radius: float, length: float, least: float) -> Arrival:
    """The path of exactly `length` [m] to the goal with the shortest last line of at least `least` [m].

    Where no last line makes it so long, one that turns away first, and no further than it must.
    """
    best = Arrival(False, shortest(start, goal, radius, least))
    for away in AWAY:
        for first, second in ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
            best = _searched(Family(start, goal, radius, first, second, least, length, away), best)
        if best.exact:
            break
    return best


def _one(family: Family, line: float) -> Path:
    """The path of a family whose line is so much longer than it must be [m]."""
    f = family
    if f.away == 0.0:
        return joined(f.start, f.goal, f.radius, f.first, f.second, f.least + line)
    angle = -f.first * f.away
    out = ahead(turned(f.start, f.radius, angle), line)
    path = joined(out, f.goal, f.radius, f.first, f.second, f.least)
    return path._replace(start=f.start, away=angle, out=line)


def _searched(family: Family, best: Arrival) -> Arrival:
    """The best path, or a better one of a family."""
    circle = TURN * family.radius
    low, spare = 0.0, -1.0
    for k in range(STEPS + 2):
        line = k * circle / STEPS
        path = _one(family, line)
        if best.exact and path.out + path.last >= best.path.out + best.path.last:
            break
        if path.straight < 0.0:
            spare = -1.0
            continue
        now = (family.length - path.length) / circle  # circles that there is time for
        if spare >= 0.0 and floor(now) < floor(spare) and spare - now < 0.5:
            found = _fitted(family, low, line)
            shorter = found.path.out + found.path.last < best.path.out + best.path.last
            if found.exact and (shorter or not best.exact):
                best = found
        low, spare = line, now
    return best


def _fitted(family: Family, low: float, high: float) -> Arrival:
    """The path of a family between two lines at which the time left makes whole circles."""
    circle, length = TURN * family.radius, family.length
    whole = floor((length - _one(family, low).length) / circle)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        path = _one(family, middle)
        if path.straight >= 0.0 and path.length + whole * circle < length:
            low = middle
        else:
            high = middle
    path = _one(family, low)
    path = path._replace(first=path.first + family.first * whole * TURN)
    return Arrival(abs(path.length - length) < 1e-3 * family.radius, path)


def _sweep(angle: float) -> float:
    """An angle in [0, 2π) [rad]."""
    sweep = angle - TURN * floor(angle / TURN)
    return 0.0 if sweep > TURN - ROUNDING else sweep
