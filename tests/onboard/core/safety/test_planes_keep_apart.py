"""Planes that cannot brake keep apart by turning in time, flown out step by step, and are else left alone."""

from __future__ import annotations

from math import cos, hypot, inf, pi, radians, sin
from typing import NamedTuple

import numpy as np
import pytest

from onboard.core.math.angles import wrap
from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec, yaw_of
from onboard.core.safety.policy import Envelope, Policy
from onboard.core.safety.separation import keep_apart

SPEED, TURN, KEEP = 40.0, radians(4.5), 100.0
DT, REACTION = 0.05, 0.5
POLICY = Policy(
    envelope=Envelope(
        hovers=False, speed_min=32.0, speed_max=SPEED, climb_max=10.0, sink_max=10.0, turn_rate=TURN,
        turn_radius=SPEED / TURN,
    ),
    separation=KEEP,
    reaction=REACTION,
)  # fmt: skip


class Plane(NamedTuple):
    """A plane of constant speed whose course turns at TURN at most, a reaction time late."""

    x: float
    y: float
    course: float


def flown(planes: list[Plane], wanted: list[float], seconds: float) -> float:
    """Everybody wants to keep a course [rad]; the least distance between any two [m]."""
    orders = [[plane.course] * round(REACTION / DT) for plane in planes]
    least = inf
    for _ in range(round(seconds / DT)):
        mates = tuple(
            Mate(k + 2, Vec(p.x, p.y, -1500.0), Vec(SPEED * cos(p.course), SPEED * sin(p.course), 0.0), 0.05)
            for k, p in enumerate(planes)
        )
        moved = []
        for k, plane in enumerate(planes):
            asked = Vec(SPEED * cos(wanted[k]), SPEED * sin(wanted[k]), 0.0)
            kept = keep_apart(asked, mates[k].position, k + 2, mates, POLICY).velocity
            orders[k].append(yaw_of(kept))
            turn = max(-TURN * DT, min(TURN * DT, wrap(orders[k].pop(0) - plane.course)))
            course = plane.course + turn
            x, y = plane.x + SPEED * DT * cos(course), plane.y + SPEED * DT * sin(course)
            moved.append(Plane(x, y, course))
        planes = moved
        gaps = [hypot(a.x - b.x, a.y - b.y) for i, a in enumerate(planes) for b in planes[:i]]
        least = min(least, *gaps) if len(gaps) > 1 else min(least, gaps[0])
    return least


@pytest.mark.parametrize(("count", "least"), [(2, 0.9 * KEEP), (3, 0.4 * KEEP)])
def test_planes_bound_for_one_place_keep_apart(count: int, least: float) -> None:
    """By braking, which no plane can, pairs came within 21 m and threes within 1 m. Threes give way to two at
    once, so that less than the distance is kept by some."""
    for seed in range(6):
        rng = np.random.default_rng([seed, count])
        bearings = rng.uniform(-pi, pi) + np.cumsum(rng.uniform(0.6, 2.0, count))
        far = 1200.0 + rng.uniform(-150.0, 150.0, count)
        places = zip(bearings.tolist(), far.tolist(), strict=True)
        planes = [Plane(r * cos(b), r * sin(b), wrap(b + pi)) for b, r in places]
        assert flown(planes, [plane.course for plane in planes], 45.0) >= least


def test_a_head_on_meeting_passes_on_the_right() -> None:
    planes = [Plane(0.0, 0.0, 0.0), Plane(2000.0, 0.0, pi)]
    assert flown(planes, [0.0, pi], 40.0) >= 0.9 * KEEP


def test_converging_planes_that_pass_clear_are_left_alone() -> None:
    """Two at right angles, one 200 m ahead: they close at 57 m/s, and will be 141 m apart at the nearest."""
    own, mate = Vec(-800.0, 0.0, -1500.0), Mate(3, Vec(0.0, -1000.0, -1500.0), Vec(0.0, SPEED, 0.0), 0.05)
    asked = Vec(SPEED, 0.0, 0.0)
    assert not keep_apart(asked, own, 2, (mate,), POLICY).changed
    later = mate._replace(position=Vec(0.0, -820.0, -1500.0))  # 20 m ahead: 14 m apart at the nearest
    assert not keep_apart(asked, own, 2, (later,), POLICY).changed  # 20 s to go: time enough
    soon = keep_apart(
        asked, Vec(-300.0, 0.0, -1500.0), 4, (later._replace(position=Vec(0.0, -320.0, -1500.0)),), POLICY
    )
    assert soon.changed


def test_the_lower_id_keeps_its_course_while_the_higher_has_time() -> None:
    place, other = Vec(-450.0, 0.0, -1500.0), Vec(0.0, -450.0, -1500.0)
    asked, crossing = Vec(SPEED, 0.0, 0.0), Vec(0.0, SPEED, 0.0)
    assert not keep_apart(asked, place, 2, (Mate(3, other, crossing, 0.05),), POLICY).changed
    assert keep_apart(crossing, other, 3, (Mate(2, place, asked, 0.05),), POLICY).changed
    quiet = keep_apart(asked, place, 2, (Mate(3, other, crossing, 2.0),), POLICY)
    assert quiet.changed
