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
    away: float  # [rad, signed] flown before, to the other side than the first turn
    first: float  # [rad, signed] with the circles that are flown before
    straight: float  # [m]
    second: float  # [rad, signed]
    last: float  # [m]

    @property
    def length(self) -> float:
        """[m]."""
        turns = abs(self.away) + abs(self.first) + abs(self.second)
        return self.radius * turns + self.straight + self.last


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
    for angle, line in ((path.away, 0.0), (path.first, path.straight), (path.second, path.last)):
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
    entry = ahead(goal, -last)
    x = entry.x - second * radius * sin(entry.heading) - start.x + first * radius * sin(start.heading)
    y = entry.y + second * radius * cos(entry.heading) - start.y - first * radius * cos(start.heading)
    square = x * x + y * y
    course = atan2(y, x)
    if first != second:
        square -= 4.0 * radius * radius
        if square < 0.0:
            return Path(start, radius, 0.0, 0.0, -1.0, 0.0, last)
        course += first * atan2(2.0 * radius, sqrt(square))
    a = _sweep(first * (course - start.heading))
    b = _sweep(second * (entry.heading - course))
    return Path(start, radius, 0.0, first * a, sqrt(square), second * b, last)


def shortest(start: Pose, goal: Pose, radius: float, last: float) -> Path:
    """The shortest path with a last line of exactly `last` [m]."""
    best = joined(start, goal, radius, 1.0, 1.0, last)
    for first, second in ((-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        path = joined(start, goal, radius, first, second, last)
        if path.straight >= 0.0 and path.length < best.length:
            best = path
    return best


class Goal(NamedTuple):
    """What a path is to be: how it turns (1 right, −1 left), where to, and how long."""

    start: Pose
    goal: Pose
    radius: float  # [m]
    first: float
    second: float
    least: float  # last line [m]
    length: float  # [m] in all


def arrive(start: Pose, goal: Pose, radius: float, length: float, least: float) -> Arrival:
    """The path of exactly `length` [m] to the goal with the shortest last line of at least `least` [m].

    Where no last line makes it so long, one that turns away first.
    """
    best = Arrival(False, shortest(start, goal, radius, least))
    for first, second in ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        wanted = Goal(start, goal, radius, first, second, least, length)
        best = _searched(wanted, best, False)
    if best.exact:
        return best
    for first, second in ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        wanted = Goal(start, goal, radius, first, second, least, length)
        best = _searched(wanted, best, True)
    return best


def _one(wanted: Goal, share: float, away: bool) -> Path:
    """A path of the family: drawn out by `share` of a circle on its last line, or turning away by as much."""
    g = wanted
    if not away:
        last = g.least + share * TURN * g.radius
        return joined(g.start, g.goal, g.radius, g.first, g.second, last)
    angle = -g.first * share * TURN
    path = joined(turned(g.start, g.radius, angle), g.goal, g.radius, g.first, g.second, g.least)
    return path._replace(start=g.start, away=angle)


def _searched(wanted: Goal, best: Arrival, away: bool) -> Arrival:
    """The best path, or a better one of a family."""
    circle = TURN * wanted.radius
    low, spare = 0.0, -1.0
    for k in range(STEPS + 2):
        share = k / STEPS
        if best.exact and (away or wanted.least + share * circle >= best.path.last):
            break
        path = _one(wanted, share, away)
        if path.straight < 0.0:
            spare = -1.0
            continue
        now = (wanted.length - path.length) / circle  # circles that there is time for
        if spare >= 0.0 and floor(now) < floor(spare) and spare - now < 0.5:
            found = _fitted(wanted, low, share, away)
            if found.exact and (away or not best.exact or found.path.last < best.path.last):
                best = found
        low, spare = share, now
    return best


def _fitted(wanted: Goal, low: float, high: float, away: bool) -> Arrival:
    """The path of a family between two at which the time left makes whole circles."""
    circle, length = TURN * wanted.radius, wanted.length
    whole = floor((length - _one(wanted, low, away).length) / circle)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        path = _one(wanted, middle, away)
        if path.straight >= 0.0 and path.length + whole * circle < length:
            low = middle
        else:
            high = middle
    path = _one(wanted, low, away)
    path = path._replace(first=path.first + wanted.first * whole * TURN)
    return Arrival(abs(path.length - length) < 1e-3 * wanted.radius, path)


def _sweep(angle: float) -> float:
    """An angle in [0, 2π) [rad]."""
    sweep = angle - TURN * floor(angle / TURN)
    return 0.0 if sweep > TURN - ROUNDING else sweep
