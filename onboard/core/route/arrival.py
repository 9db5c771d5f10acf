"""Arriving at a place at an instant with a heading: turn, fly straight, turn, and a last straight line.

Kernel style, in the air mass as seen from above, where a plane flies at constant airspeed and the wind is
nothing: places are (north, east) [m] from where the plane is now. The shortest such paths are Dubins' (1957,
Am. J. Math. 79). Who has time left circles first, and the last line is drawn out until the path takes exactly
as long as there is time: a holding pattern timed to the instant.
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
    radius: float  # [m] of both turns
    first: float  # [rad, signed] with the circles that are flown before
    straight: float  # [m]
    second: float  # [rad, signed]
    last: float  # [m]

    @property
    def length(self) -> float:
        """[m]."""
        return self.radius * (abs(self.first) + abs(self.second)) + self.straight + self.last


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
    return Pose(
        start.x + length * cos(start.heading), start.y + length * sin(start.heading), start.heading
    )


def at(path: Path, length: float) -> Pose:
    """Where the path is after a length [m]; it goes on straight at both ends."""
    here = path.start
    if length <= 0.0:
        return ahead(here, length)
    for angle, line in ((path.first, path.straight), (path.second, path.last)):
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
            return Path(start, radius, 0.0, -1.0, 0.0, last)
        course += first * atan2(2.0 * radius, sqrt(square))
    a = _sweep(first * (course - start.heading))
    b = _sweep(second * (entry.heading - course))
    return Path(start, radius, first * a, sqrt(square), second * b, last)


def shortest(start: Pose, goal: Pose, radius: float, last: float) -> Path:
    """The shortest path with a last line of exactly `last` [m]."""
    best = joined(start, goal, radius, 1.0, 1.0, last)
    for first, second in ((-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        path = joined(start, goal, radius, first, second, last)
        if path.straight >= 0.0 and path.length < best.length:
            best = path
    return best


def arrive(start: Pose, goal: Pose, radius: float, length: float, least: float) -> Arrival:
    """The path of exactly `length` [m] to the goal with the shortest last line of at least `least` [m]."""
    best = Arrival(False, shortest(start, goal, radius, least))
    circle = TURN * radius
    step = circle / STEPS
    for first, second in ((1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)):
        low, spare = 0.0, -1.0
        for k in range(STEPS + 2):
            last = least + k * step
            if best.exact and last >= best.path.last:
                break
            path = joined(start, goal, radius, first, second, last)
            if path.straight < 0.0:
                spare = -1.0
                continue
            now = (length - path.length) / circle  # circles that there is time for
            if spare >= 0.0 and floor(now) < floor(spare) and spare - now < 0.5:
                found = _fitted(start, goal, radius, first, second, low, last, length)
                if found.exact and (not best.exact or found.path.last < best.path.last):
                    best = found
            low, spare = last, now
    return best


def _fitted(  # noqa: PLR0913  (compiled code takes no bundles)
    start: Pose, goal: Pose, radius: float, first: float, second: float, low: float, high: float,
    length: float,
) -> Arrival:  # fmt: skip
    """The last line between two lengths at which the time left makes whole circles."""
    circle = TURN * radius
    whole = floor((length - joined(start, goal, radius, first, second, low).length) / circle)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        path = joined(start, goal, radius, first, second, middle)
        if path.straight >= 0.0 and path.length + whole * circle < length:
            low = middle
        else:
            high = middle
    path = joined(start, goal, radius, first, second, low)
    path = path._replace(first=path.first + first * whole * TURN)
    return Arrival(abs(path.length - length) < 1e-3 * radius, path)


def _sweep(angle: float) -> float:
    """An angle in [0, 2π) [rad]."""
    sweep = angle - TURN * floor(angle / TURN)
    return 0.0 if sweep > TURN - ROUNDING else sweep
