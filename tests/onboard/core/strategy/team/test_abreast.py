"""A wall of pursuers against an evader that dodges, in still air, by an aircraft model of the test's own."""

from __future__ import annotations

from math import cos, pi, radians, sin

import pytest

from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.game.views import (
    Nearest,
    PursuerView,
    Team,
    evader_view,
    heading_at,
    pursuer_view,
    sighted,
    with_limits,
)
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, distance, yaw_of
from onboard.core.strategy.knowledge import RuleId, level_of
from onboard.core.strategy.registry import EVADERS, PURSUERS

TURN = radians(4.5)
EVADER = VehicleLimits(40.0, 50.0, -0.35, 0.35, turn_rate=TURN)
PURSUER = VehicleLimits(32.0, 40.0, -0.35, 0.35, turn_rate=TURN)
RULES = Rules(25.0, 88.0, separation=100.0, horizon=100.0)
GOAL = Target(True, Vec(6000.0, 0.0, -1500.0))


def view_of(team: tuple[Vehicle, ...], index: int, evader: Vehicle) -> PursuerView:
    seen = sighted(evader, heading_at(evader), 1.0)
    mine = Team(Nearest(False, ZERO), team, index, NO_TARGET)
    return pursuer_view(team[index], PURSUER, seen, mine, Control(0.2), RULES)


def moved(own: Vehicle, course: float, dt: float) -> Vehicle:
    """A level vehicle, its course turned towards another as fast as it turns."""
    now = yaw_of(own.velocity)
    now += max(-TURN * dt, min(TURN * dt, wrap(course - now)))
    v = Vec(own.speed * cos(now), own.speed * sin(now), 0.0)
    return Vehicle(Vec(own.position.x + v.x * dt, own.position.y + v.y * dt, own.position.z), v, own.speed)


def played(pursuing: str, evading: str, apart: float = 145.0) -> tuple[float, set[RuleId]]:
    """Four pairs at 2 km, one before the target: the least distance to the evader [m] until it is past the
    first pair, and the rules that spoke."""
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0), 50.0)
    placed = []
    for k in range(8):
        a, off = 0.5 * pi * (k // 2), apart * (k % 2 - 0.5)
        place = Vec(2000.0 * cos(a) - off * sin(a), 2000.0 * sin(a) + off * cos(a), -1500.0)
        placed.append(Vehicle(place, Vec(-40.0 * cos(a), -40.0 * sin(a), 0.0), 40.0))
    team, least, rules = tuple(placed), 1e9, set()
    for _ in range(300):
        view = evader_view(evader, EVADER, team, GOAL, ZERO, RULES)
        ahead = EVADERS[evading].decide(with_limits(view, (PURSUER,) * 8))
        decisions = [PURSUERS[pursuing].decide(view_of(team, k, evader)) for k in range(8)]
        rules |= {d.rule for d in decisions}
        for _ in range(2):
            evader = moved(evader, yaw_of(ahead.direction), 0.05)
            team = tuple(
                moved(own, yaw_of(d.direction), 0.05) for own, d in zip(team, decisions, strict=True)
            )
            least = min(least, *(distance(own.position, evader.position) for own in team))
    return least, rules


def test_who_dodges_past_one_runs_into_the_next() -> None:
    """In parallel pursuit both of a pair are passed together."""
    alone, _ = played("parallel-pursuit", "dodge")
    wall, rules = played("abreast", "dodge")
    assert alone > 2.0 * RULES.R
    assert wall <= RULES.R
    assert RuleId.ABREAST in rules
    assert level_of(RuleId.ABREAST).name == "STRATEGIC"


def test_who_flies_on_between_two_is_met_too() -> None:
    assert played("abreast", "straight")[0] <= RULES.R


@pytest.mark.parametrize("bearing", [0.7, 1.3, 2.5])
def test_without_anybody_beside_it_is_parallel_pursuit(bearing: float) -> None:
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0), 50.0)
    team = tuple(
        Vehicle(Vec(1500.0 * c, 1500.0 * s, -1500.0), Vec(-40.0 * c, -40.0 * s, 0.0), 40.0)
        for c, s in ((1.0, 0.0), (cos(bearing), sin(bearing)))
    )
    for k in range(2):
        view = view_of(team, k, evader)
        assert PURSUERS["abreast"].decide(view) == PURSUERS["parallel-pursuit"].decide(view)


def test_the_two_of_a_pair_keep_to_their_own_sides() -> None:
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0), 50.0)
    team = tuple(Vehicle(Vec(1500.0, y, -1500.0), Vec(-40.0, 0.0, 0.0), 40.0) for y in (-60.0, 60.0))
    left, right = (PURSUERS["abreast"].decide(view_of(team, k, evader)) for k in range(2))
    assert left.rule == right.rule == RuleId.ABREAST
    assert left.direction.y < 0.0 < right.direction.y  # from 120 m to 145 m apart
