"""Problems of pursuit alone: two kinds of cars, two cutters, lions."""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, pi, sin

from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, along, distance, scale, sub, unit, yaw_of
from sim_bridge.classic.play import End, Scene, cars, touch
from sim_bridge.classic.problem import Problem
from sim_bridge.classic.values import cars as car
from sim_bridge.classic.values.hull import Depth, depth
from sim_bridge.classic.values.regions import balls_of, farthest_from

AHEAD = Vec(1.0, 0.0, 0.0)
PASSED = 0.15  # turning radii


def _captured(before: Scene, after: Scene) -> End | None:
    """Capture, whose payoff is its time."""
    seen = touch(before, after)
    if seen.share > 1.0:
        return None
    time = before.game.time + seen.share * before.conditions.control.dt
    return End(time, time, True)


def _free(scene: Scene) -> End:
    """Nobody was caught: the payoff is the horizon."""
    horizon = scene.conditions.rules.horizon
    return End(horizon, horizon, False)


def _in_time(start: Scene, payoff: float) -> bool:
    return payoff < start.conditions.rules.horizon


def _course(angle: float, speed: float) -> Vec:
    return Vec(speed * cos(angle), speed * sin(angle), 0.0)


# ---------------------------------------------------------------- homicidal chauffeur


def radius_of(scene: Scene, index: int = 0) -> float:
    """Turning radius of a pursuer [m]."""
    return scene.pursuers[index].speed / scene.game.pursuer_limits[index].turn_rate


def relative(scene: Scene) -> tuple[float, float]:
    """The evader in the first pursuer's frame: to its right and ahead [turning radii]."""
    own, r = scene.pursuers[0], radius_of(scene)
    line, ahead = sub(scene.evader.position, own.position), unit(own.velocity, AHEAD)
    return (line.y * ahead.x - line.x * ahead.y) / r, (line.x * ahead.x + line.y * ahead.y) / r


def _chauffeur_value(scene: Scene) -> float:
    own, r = scene.pursuers[0], radius_of(scene)
    w = scene.evader.speed / own.speed
    return car.chauffeur_time(*relative(scene), w, scene.conditions.rules.R / r) * r / own.speed


def _line(scene: Scene) -> float:
    """Course of the tangent on which the chauffeur will follow [rad]."""
    return yaw_of(scene.pursuers[0].velocity) + car.tangent(*relative(scene)).turn


def _chauffeur_evader(scene: Scene) -> Vec:
    if not car.tangent(*relative(scene)).exists:
        line = sub(scene.evader.position, scene.pursuers[0].position)
        return scale(unit(line, AHEAD), scene.evader.speed)
    return _course(_line(scene), scene.evader.speed)


def _chauffeur_pursuer(scene: Scene) -> tuple[Vec, ...]:
    own = scene.pursuers[0]
    if not car.tangent(*relative(scene)).exists:
        return (sub(scene.evader.position, own.position),)
    return (_course(_line(scene), own.speed),)


def _well_ahead(scene: Scene) -> bool:
    """Three turning radii away or more, within 60° of the nose: no barrier is crossed."""
    x, y = relative(scene)
    return y >= 0.5 * hypot(x, y) >= 1.5


CHAUFFEUR = Problem(
    "homicidal-chauffeur", "Homicidal chauffeur",
    "A fast car that cannot turn at once chases a slow evader that can.",
    "Isaacs 1965, 10.2; Merz 1971; Patsko and Turova 2001",
    "time to capture", "s", -1,
    _chauffeur_value, _in_time, _chauffeur_evader, _chauffeur_pursuer, _captured, _free,
    "proportional navigation turns less than it can; 'evasive' and 'straight' fly on, not along the tangent",
    "the games of `bench` know no turning circle (simple motion)",
    move=cars(agile=True), admits=_well_ahead,
    chasers=("paper", "parallel-pursuit", "pure-pursuit", "proportional-navigation"),
)  # fmt: skip


# ---------------------------------------------------------------- two identical cars


def _miss(scene: Scene) -> car.Miss:
    heading = wrap(yaw_of(scene.evader.velocity) - yaw_of(scene.pursuers[0].velocity))
    return _two_cars(*relative(scene), heading)


_two_cars = lru_cache(4)(car.two_cars)  # both sides ask for the same instant


def _cars_value(scene: Scene) -> float:
    return _miss(scene).distance * radius_of(scene)


def _hard(one: Vehicle, turn: float) -> Vec:
    """A wish that turns a car as hard as it can to one side; 0: straight on."""
    return _course(yaw_of(one.velocity) + 0.5 * pi * turn, one.speed)


def _cars_evader(scene: Scene) -> Vec:
    return _hard(scene.evader, _miss(scene).evader)


def _cars_pursuer(scene: Scene) -> tuple[Vec, ...]:
    return (_hard(scene.pursuers[0], _miss(scene).pursuer),)


def _passing(scene: Scene) -> bool:
    """Turns that do not change are a saddle point, both turn, and the nearest pass comes soon."""
    found, (x, y) = _miss(scene), relative(scene)
    saddle = found.guaranteed - found.distance < 0.02 and abs(found.evader * found.pursuer) == 1.0
    near = 0.1 < found.distance < min(1.0, hypot(x, y) - 0.15) and found.when < 2.0
    if not (saddle and near and found.margin > 0.1 and y > 0.0):
        return False
    heading = yaw_of(scene.evader.velocity) - yaw_of(scene.pursuers[0].velocity)
    return car.straightened(x, y, heading, found) > found.distance - 0.01


def _nearest(before: Scene, after: Scene) -> float:
    return min(before.seen, touch(before, after).smallest)


def _passed(before: Scene, after: Scene) -> End | None:
    """The first pass, once the distance has grown by PASSED more than its least."""
    nearest, now = _nearest(before, after), distance(after.evader.position, after.pursuers[0].position)
    if now < nearest + PASSED * radius_of(after):
        return None
    return End(nearest, after.game.time, nearest <= after.conditions.rules.R)


def _never_passed(scene: Scene) -> End:
    return End(scene.seen, scene.game.time, scene.seen <= scene.conditions.rules.R)


CARS = Problem(
    "two-cars", "Two identical cars",
    "A car chases another of the same speed and turning circle; captured within R.",
    "Merz 1972; Buzikov and Galyaev, arXiv 2206.10199",
    "distance of the first pass", "m", -1,
    _cars_value, lambda start, payoff: payoff <= start.conditions.rules.R, _cars_evader, _cars_pursuer,
    _passed, _never_passed,
    "our evaders turn away as if they could at once, or not at all; 'evasive' does best",
    "the games of `bench` know no turning circle (simple motion)",
    move=cars(agile=False), admits=_passing, noted=_nearest, at_once=False, faster=False,
    chasers=("paper", "parallel-pursuit", "pure-pursuit", "proportional-navigation"),
)  # fmt: skip


# ---------------------------------------------------------------- two cutters and a fugitive ship


def _meeting(scene: Scene) -> Vec:
    return farthest_from(scene.evader.position, balls_of(scene.evader, scene.pursuers))


def _cutters_value(scene: Scene) -> float:
    return distance(_meeting(scene), scene.evader.position) / scene.evader.speed


def _to(one: Vehicle, place: Vec, otherwise: Vec) -> Vec:
    return scale(unit(sub(place, one.position), unit(otherwise, AHEAD)), one.speed)


def _cutters_evader(scene: Scene) -> Vec:
    return _to(scene.evader, _meeting(scene), scene.evader.velocity)


def _cutters_pursuers(scene: Scene) -> tuple[Vec, ...]:
    place = _meeting(scene)
    return tuple(_to(p, place, p.velocity) for p in scene.pursuers)


CUTTERS = Problem(
    "two-cutters", "Two cutters and a fugitive ship",
    "Two faster pursuers catch an evader on the plane as soon as they can.",
    "Isaacs 1965, 6.8; Weintraub, Pachter and Garcia, arXiv 2003.05013",
    "time to capture", "s", -1,
    _cutters_value, _in_time, _cutters_evader, _cutters_pursuers, _captured, _free,
    "pure pursuit chases from behind; our evaders flee from the pursuers, not to where both come last",
    teams=(2, 2), chasers=("paper", "parallel-pursuit", "pure-pursuit", "team"),
)  # fmt: skip


# ---------------------------------------------------------------- lion and man with k-capture


def _depth(scene: Scene) -> Depth:
    """Among those who are not at the evader already."""
    e, near = scene.evader.position, scene.conditions.rules.R
    return depth(e, tuple(p.position for p in scene.pursuers if distance(p.position, e) > near))


def _deep(scene: Scene) -> float:
    return float(_depth(scene).ahead) + _at_it(scene)


def _lion_evader(scene: Scene) -> Vec:
    return scale(_depth(scene).way, scene.evader.speed)


def _lions(scene: Scene) -> tuple[Vec, ...]:
    e = scene.evader
    return tuple(
        _onto(p, scene) or scale(lead(p.position, p.speed, e.position, e.velocity), p.speed)
        for p in scene.pursuers
    )


def _onto(p: Vehicle, scene: Scene) -> Vec | None:
    """The velocity with which a lion is at the evader after the step [m/s], if it can be."""
    dt = scene.conditions.control.dt
    after = along(scene.evader.position, scene.evader.velocity, dt)
    if distance(after, p.position) > p.speed * dt:
        return None
    return scale(sub(after, p.position), 1.0 / dt)


def _at_it(scene: Scene) -> float:
    near = scene.conditions.rules.R
    return float(sum(distance(p.position, scene.evader.position) <= near for p in scene.pursuers))


def _most(before: Scene, after: Scene) -> float:
    return max(before.seen, _at_it(after))


def _k_captured(before: Scene, after: Scene) -> End | None:
    most = _most(before, after)
    return End(most, after.game.time, True) if most >= after.wanted else None


def _with_depth(scene: Scene) -> Scene:
    return scene._replace(seen=0.0, wanted=_deep(scene))


LIONS = Problem(
    "lion-and-man", "Lion and man with k-capture",
    "Pursuers as fast as the evader; it is caught when k of them are at it at once.",
    "Bopardikar and Suri, arXiv 1108.1561",
    "pursuers at the evader at once", "", +1,
    _deep, lambda start, payoff: payoff >= start.wanted, _lion_evader, _lions, _k_captured,
    lambda scene: End(scene.seen, scene.game.time, False),
    "pure pursuit falls in behind; parallel pursuit may fly past an evader that it has reached",
    placed=_with_depth, admits=lambda scene: _deep(scene) >= 1.0, noted=_most, teams=(1, 20), faster=False,
)  # fmt: skip
