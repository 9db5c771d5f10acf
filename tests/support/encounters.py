"""Encounters of aircraft flown out step by step, each under its supervisor: an oracle of separation.

An aircraft here is what it physically is, and knows nothing of the supervisor's forecasts: a course that
turns at a limited rate towards the one ordered, a climb that follows late, its own gusts (Gauss–Markov,
3 m/s, 10 s) and the mean wind; mates are known late. Decisions come at 5 Hz, a quarter of what is flown.
"""

from __future__ import annotations

from collections.abc import Callable
from math import asin, atan2, cos, exp, inf, pi, radians, sin, sqrt

import numpy as np

from onboard.core.math.angles import wrap
from onboard.core.math.constants import NEVER
from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Envelope, Policy
from onboard.core.safety.supervisor import Before, Flying, allow

DT, EVERY = 0.05, 4
SPEED, TURN, KEEP = 40.0, radians(4.5), 100.0
CLIMB = SPEED * sin(radians(20.0))
PLANE = Policy(
    envelope=Envelope(
        hovers=False, speed_min=32.0, speed_max=SPEED, climb_max=CLIMB, sink_max=CLIMB, turn_rate=TURN,
        turn_radius=SPEED / TURN,
    ),
    separation=KEEP,
    reaction=0.5,
)  # fmt: skip
Wish = Callable[[float, int, Vec], Vec]  # (time, who, place) → wanted velocity through the air


class Aircraft:
    """One aircraft in its air."""

    def __init__(self, place: Vec, course: float, seed: int, gusts: float) -> None:
        """At `place` [m; NED] on a level `course` [rad]; gusts of `gusts` [m/s, rms]."""
        self.place, self.course, self.climb = place, course, 0.0  # climb: down [m/s]
        self.demand, self.stamp = Vec(SPEED * cos(course), SPEED * sin(course), 0.0), NEVER
        self.noise = np.random.default_rng(seed)
        self.gusts, self.gust = gusts, gusts * self.noise.standard_normal(3)

    def velocity(self, wind: Vec) -> Vec:
        """Over ground [m/s]."""
        level = sqrt(max(0.0, SPEED * SPEED - self.climb * self.climb))
        g = self.gust
        return Vec(
            level * cos(self.course) + wind.x + float(g[0]),
            level * sin(self.course) + wind.y + float(g[1]),
            self.climb + 0.5 * float(g[2]),
        )

    def fly(self, wind: Vec) -> None:
        """One step of DT towards the demand."""
        turn = 1.1 * wrap(atan2(self.demand.y, self.demand.x) - self.course)
        self.course = wrap(self.course + DT * max(-TURN, min(TURN, turn)))
        self.climb += DT / 1.6 * (self.demand.z - self.climb)
        keep = exp(-DT / 10.0)
        self.gust = keep * self.gust + self.gusts * sqrt(1.0 - keep * keep) * self.noise.standard_normal(3)
        v = self.velocity(wind)
        self.place = Vec(self.place.x + DT * v.x, self.place.y + DT * v.y, self.place.z + DT * v.z)


def nearest(team: list[Aircraft], wish: Wish, wind: Vec, seconds: float, delay: float = 0.3) -> float:
    """The least distance between any two while everybody wants its `wish` [m]."""
    late = round(delay / DT)
    heard: list[list[Mate]] = []
    least = inf
    for n in range(round(seconds / DT)):
        now = n * DT
        heard.append([Mate(k + 2, a.place, a.velocity(wind), 0.0) for k, a in enumerate(team)])
        if n % EVERY == 0:
            old = heard[max(0, n - late)]
            age = min(now, late * DT)
            mates = tuple(
                m._replace(
                    position=Vec(*(p + age * v for p, v in zip(m.position, m.velocity, strict=True))), age=age
                )
                for m in old
            )
            for k, a in enumerate(team):
                flying = Flying(now, k + 2, a.place, a.velocity(wind))
                before = Before(a.demand, a.stamp)
                a.demand = allow(wish(now, k, a.place), wind, flying, mates, PLANE, before).air
                a.stamp = now
        for a in team:
            a.fly(wind)
        places = np.array([a.place for a in team])
        for i in range(1, len(team)):
            least = min(least, float(np.min(np.linalg.norm(places[:i] - places[i], axis=1))))
    return least


def to_a_place(rng: np.random.Generator, count: int) -> tuple[list[Aircraft], Wish]:
    """All round a place and bound for it, for good."""
    bearings = rng.uniform(-pi, pi) + np.cumsum(rng.uniform(0.3, 2.2, count))
    out = 1200.0 + rng.uniform(-150.0, 150.0, count)
    high = rng.uniform(-80.0, 80.0, count)
    team = [
        Aircraft(Vec(r * cos(b), r * sin(b), -1500.0 + h), wrap(b + pi), int(rng.integers(1 << 30)), 3.0)
        for b, r, h in zip(bearings.tolist(), out.tolist(), high.tolist(), strict=True)
    ]

    def wish(_now: float, _who: int, place: Vec) -> Vec:
        return towards(place, Vec(0.0, 0.0, -1500.0))

    return team, wish


def after_one(rng: np.random.Generator, count: int) -> tuple[list[Aircraft], Wish]:
    """All behind or about one that flies a bent way faster than they do, and after it."""
    team = [
        Aircraft(
            Vec(*rng.uniform(-700.0, 700.0, 2).tolist(), -1500.0 + float(rng.uniform(-60.0, 60.0))),
            float(rng.uniform(-pi, pi)), int(rng.integers(1 << 30)), 3.0,
        )
        for _ in range(count)
    ]  # fmt: skip
    course, bend = float(rng.uniform(-pi, pi)), float(rng.uniform(-0.06, 0.06))

    def wish(now: float, _who: int, place: Vec) -> Vec:
        r = 50.0 / bend if abs(bend) > 1e-3 else 1e6
        a = course + bend * now
        return towards(place, Vec(r * (sin(a) - sin(course)), -r * (cos(a) - cos(course)), -1500.0))

    return team, wish


def anyhow(rng: np.random.Generator, count: int) -> tuple[list[Aircraft], Wish]:
    """Places and courses at random, new wishes every few seconds."""
    team, _ = after_one(rng, count)
    courses = rng.uniform(-pi, pi, (60, count))
    climbs = rng.uniform(-CLIMB, CLIMB, (60, count))

    def wish(now: float, who: int, place: Vec) -> Vec:
        k = int(now / 7.0)
        a, z = float(courses[k, who]), float(climbs[k, who]) if abs(place.z + 1500.0) < 300.0 else 0.0
        return Vec(SPEED * cos(a), SPEED * sin(a), z)

    return team, wish


def towards(place: Vec, goal: Vec) -> Vec:
    """Straight at a goal as steeply as allowed."""
    x, y, z = goal.x - place.x, goal.y - place.y, goal.z - place.z
    level = max(sqrt(x * x + y * y), 1.0)
    pitch = max(-asin(CLIMB / SPEED), min(asin(CLIMB / SPEED), atan2(-z, level)))
    a = atan2(y, x)
    return Vec(SPEED * cos(pitch) * cos(a), SPEED * cos(pitch) * sin(a), -SPEED * sin(pitch))


def clear(team: list[Aircraft]) -> bool:
    """Whether all begin farther apart than 4 times the separation: nearer no rule may be able to help."""
    places = np.array([a.place for a in team])
    return all(
        float(np.linalg.norm(places[i] - places[j])) > 4.0 * KEEP for i in range(len(team)) for j in range(i)
    )
