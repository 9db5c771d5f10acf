"""The referee: capture (6), safety distance (4), target reached (5), over the whole step."""

from __future__ import annotations

from enum import IntEnum
from math import inf, sqrt
from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Rules, Target, goal_disc
from onboard.core.geometry.apollonius import in_time
from onboard.core.math.each import each_pair
from onboard.core.math.vectors import TINY, Vec, sub


class GameResult(IntEnum):
    """How a game stands."""

    RUNNING = 0
    CAPTURED = 1  # (6)
    ARRIVED = 2  # (5)
    ESCAPED = 3  # not captured at the horizon, and no target was held
    DENIED = 4  # neither captured nor arrived at the horizon, when a pursuer can be at the target first


NEARLY = 1.0 + 1e-9  # a square within this share of another may count as no larger: a root tells


class Passage(NamedTuple):
    """Two straight segments flown in the same step."""

    smallest: float  # distance at the closest approach [m]
    when: float  # share of the step at the closest approach, 0…1
    enters: bool  # whether the distance falls to the radius
    entry: float  # share of the step at which it does, 0…1


class Closest(NamedTuple):
    """The squares behind a passage."""

    cc: float  # of the distance at the beginning [m²]
    bb: float  # its product with the way relative to each other
    aa: float  # of that way
    when: float  # share of the step at the closest approach, 0…1
    square: float  # of the smallest distance


def closest(a0: Vec, a1: Vec, b0: Vec, b1: Vec) -> Closest:
    """Closest approach of a (a0 → a1) and b (b0 → b1), without a root, and a division only within."""
    rx = a0.x - b0.x
    ry = a0.y - b0.y
    rz = a0.z - b0.z
    x = a1.x - b1.x - rx
    y = a1.y - b1.y - ry
    z = a1.z - b1.z - rz
    cc = rx * rx + ry * ry + rz * rz
    aa = x * x + y * y + z * z
    bb = rx * x + ry * y + rz * z
    when = 0.0
    if aa > TINY * TINY and bb < 0.0:
        when = 1.0 if -bb >= aa else -bb / aa
    return Closest(cc, bb, aa, when, max(0.0, cc + when * (2.0 * bb + when * aa)))


def smallest_square(b0: Vec, b1: Vec, a: tuple[Vec, Vec]) -> float:
    """The square of the smallest distance of b (b0 → b1) and a [m²] (for `each_pair`)."""
    return closest(b0, b1, a[0], a[1]).square


def passage(a0: Vec, a1: Vec, b0: Vec, b1: Vec, radius: float) -> Passage:
    """Closest approach of a (a0 → a1) and b (b0 → b1) [m], and when they come within `radius` [m]."""
    cc, bb, aa, when, square = closest(a0, a1, b0, b1)
    smallest = sqrt(square)
    if cc <= radius * radius:
        return Passage(smallest, when, True, 0.0)
    if smallest > radius or aa <= TINY * TINY:
        return Passage(smallest, when, False, 1.0)
    inside = max(0.0, bb * bb - aa * (cc - radius * radius))
    entry = (-bb - sqrt(inside)) / aa
    return Passage(smallest, when, True, min(1.0, max(0.0, entry)))


class Score(NamedTuple):
    """What the referee has seen so far."""

    verdict: GameResult
    time: float  # of the verdict, or now [s]
    captor: int  # index of the pursuer that captured, −1 = none
    smallest: float  # smallest distance of any pursuer so far [m]
    unsafe: float  # time spent nearer than the safety distance ρ, by step [s]


def opening(e: Vec, pursuers: tuple[Vec, ...]) -> Score:
    """The score before the first step."""
    smallest = 1e300
    for p in pursuers:
        line = sub(p, e)
        d = sqrt(line.x * line.x + line.y * line.y + line.z * line.z)
        smallest = min(smallest, d)
    return Score(GameResult.RUNNING, 0.0, -1, smallest, 0.0)


class Step(NamedTuple):
    """One step of a game, in which everybody flies straight from one place to the next [m; NED]."""

    start: float  # [s since the start of the game]
    dt: float  # duration [s]
    e0: Vec  # the evader at the start
    e1: Vec  # and at the end
    before: tuple[Vec, ...]  # the pursuers at the start
    after: tuple[Vec, ...]  # and at the end, in the same order
    speed: float = 0.0  # of the evader, as the game reckons with it [m/s]; 0 = not known
    speeds: tuple[float, ...] = ()  # of the pursuers, in the same order; none = not known


def judge(score: Score, step: Step, rules: Rules, target: Target) -> Score:
    """The score after one more step.

    Whatever comes first within the step decides: capture (6), arrival (5), the horizon. On a
    tie capture stands. At the horizon the target is denied where `held` says so, else the evader has escaped.
    `target` lies on the ground, as the places of the step do [m; NED].
    """
    if score.verdict != GameResult.RUNNING:
        return score
    start, dt, e0, e1, before, after, _speed, _speeds = step
    least = inf
    for square in each_pair(smallest_square, before, after, (e0, e1)):
        least = min(least, square)
    captor = -1
    capture = 2.0
    if least <= NEARLY * rules.R * rules.R:
        for index in range(len(before)):
            seen = passage(before[index], after[index], e0, e1, rules.R)
            if seen.enters and seen.entry < capture:
                capture = seen.entry
                captor = index
    nearest = sqrt(least)  # as the smallest of the roots is the root of the smallest
    smallest = min(score.smallest, nearest)
    near = nearest < rules.rho
    unsafe = score.unsafe + dt if near else score.unsafe
    share = (rules.horizon - start) / dt
    if captor >= 0 and capture <= share:
        arrival = passage(target.position, target.position, e0, e1, rules.epsilon_min)
        if not target.exists or not arrival.enters or capture <= arrival.entry:
            smallest = min(score.smallest, _nearest(capture, e0, e1, before, after))
            return Score(GameResult.CAPTURED, start + capture * dt, captor, smallest, unsafe)
    reach = rules.epsilon_min
    if target.exists and closest(target.position, target.position, e0, e1).square <= NEARLY * reach * reach:
        arrival = passage(target.position, target.position, e0, e1, rules.epsilon_min)
        if arrival.enters and arrival.entry <= share:
            smallest = min(score.smallest, _nearest(arrival.entry, e0, e1, before, after))
            return Score(GameResult.ARRIVED, start + arrival.entry * dt, -1, smallest, unsafe)
    if share <= 1.0 + 1e-9:
        kept = target.exists and held(step, min(1.0, share), target.position, goal_disc(rules))
        result = GameResult.DENIED if kept else GameResult.ESCAPED
        return Score(result, rules.horizon, -1, smallest, unsafe)
    return Score(GameResult.RUNNING, start + dt, -1, smallest, unsafe)


def judge_any(score: Score, step: Step, rules: Rules, targets: tuple[Target, ...]) -> Score:
    """The score after one more step of an evader with several targets: to reach any of them is to arrive.

    At the horizon it was denied only where every target is held. Targets that do not exist count for nothing.
    """
    found = judge(score, step, rules, targets[0] if len(targets) > 0 else NO_TARGET)
    if score.verdict != GameResult.RUNNING:
        return found
    some = len(targets) > 0 and targets[0].exists
    for k in range(1, len(targets)):
        if targets[k].exists:
            other = judge(score, step, rules, targets[k])
            if not some or _sooner(other, found):
                found = other
            some = True
    return found


def _sooner(a: Score, b: Score) -> bool:
    """Whether of two targets' scores of the same step the first is the evader's."""
    if a.verdict == GameResult.ARRIVED:
        return b.verdict != GameResult.ARRIVED or a.time < b.time
    return a.verdict == GameResult.ESCAPED and b.verdict == GameResult.DENIED


def held(step: Step, share: float, place: Vec, disc: float) -> bool:
    """Whether a pursuer can be at a place [m] no later than the evader, that share of a step later.

    Where `disc` [m] is not 0 it can at every point of that disc about the place.

    It is the test of time to block (`in_time`), by which a defender wins the game of degree of a target that
    does not move: what is held at the horizon is not had by flying straight at it.
    """
    e = _part(step.e0, step.e1, share)
    for index in range(len(step.before)):
        p = _part(step.before[index], step.after[index], share)
        speed = step.speeds[index] if index < len(step.speeds) else 0.0
        if in_time(place, p, speed, e, step.speed, disc):
            return True
    return False


def _part(a: Vec, b: Vec, share: float) -> Vec:
    return Vec(a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share)


def _nearest(share: float, e0: Vec, e1: Vec, before: tuple[Vec, ...], after: tuple[Vec, ...]) -> float:
    """Smallest distance within the first part of a step: a game ends with its verdict."""
    smallest = 1e300
    end = _part(e0, e1, share)
    for index in range(len(before)):
        seen = passage(before[index], _part(before[index], after[index], share), e0, end, 0.0)
        smallest = min(smallest, seen.smallest)
    return smallest
