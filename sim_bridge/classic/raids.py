"""Raids: a target that flies with its defender, a flag that is carried home, a perimeter."""

from __future__ import annotations

from functools import lru_cache
from math import atan2, cos, pi, sin

from onboard.core.geometry.apollonius import in_time
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import NORTH, Vec, along, clamp, distance, dot, scale, sub, unit
from sim_bridge.classic.guards import DEFENDERS, all_to, is_clear, kept, lowest_point, to_place
from sim_bridge.classic.play import End, Scene, held_to, simple_motion, touch
from sim_bridge.classic.problem import Problem, aimed_at
from sim_bridge.classic.values.escort import Escort, escort, flag_return
from sim_bridge.classic.values.rim import Breach, breach

WARD_SPEED = 0.5  # of the target that flies, over the attacker's


# ---------------------------------------------------------------- target, attacker and defender


_saddle = lru_cache(4)(escort)  # attacker, defender and target ask for the same instant


def _escort(scene: Scene) -> tuple[Escort, Vec]:
    """The value, and where attacker and defender meet [m]."""
    a, d, ward = scene.evader.position, scene.pursuers[0].position, scene.ward
    assert ward is not None
    axis = unit(sub(a, d), NORTH)
    middle, across = along(d, axis, 0.5 * distance(a, d)), Vec(-axis.y, axis.x, 0.0)
    line = sub(ward.position, middle)
    found = _saddle(0.5 * distance(a, d), dot(line, axis), dot(line, across), ward.speed / scene.evader.speed)
    return found, along(middle, across, found.y)


def _with_ward(scene: Scene) -> Scene:
    """The target that flies begins at the file's target."""
    speed = WARD_SPEED * scene.evader.speed
    ward = Vehicle(scene.home, Vec(0.0, 0.0, 0.0), speed)
    return scene._replace(ward=ward)


def _ward_shown(scene: Scene) -> Scene:
    return scene if scene.ward is None else aimed_at(scene, scene.ward.position)


def _with_ward_moved(scene: Scene, evader: Vec, pursuers: tuple[Vec, ...]) -> Scene:
    """The target flies from where the other two meet, or, on the attacker's side, through that point."""
    ward = scene.ward
    assert ward is not None
    velocity = _ward_velocity(scene)
    place = along(ward.position, velocity, scene.conditions.control.dt)
    moved = ward._replace(position=place, velocity=velocity)
    return simple_motion(scene, evader, pursuers)._replace(ward=moved)


def _ward_velocity(scene: Scene) -> Vec:
    """The target's own optimal flight [m/s]."""
    ward, a, d = scene.ward, scene.evader.position, scene.pursuers[0].position
    assert ward is not None
    away = unit(sub(ward.position, _escort(scene)[1]), unit(sub(d, a), NORTH))
    on_its_side = distance(ward.position, a) < distance(ward.position, d)
    return scale(away, -ward.speed if on_its_side else ward.speed)


def _attacker(scene: Scene) -> Vec:
    """To where the defender will meet it; after the target, keeping its bearing, where it is there first."""
    found, place = _escort(scene)
    if found.value > 0.0 or scene.ward is None:
        return to_place(scene.evader, place)
    own = scene.evader
    way = lead(own.position, own.speed, scene.ward.position, _ward_velocity(scene))
    return scale(way, own.speed)


def _escort_end(before: Scene, after: Scene) -> End | None:
    seen, ward = touch(before, after), after.ward
    assert ward is not None
    time = before.game.time + min(seen.share, 1.0) * before.conditions.control.dt
    if distance(after.evader.position, ward.position) <= before.conditions.rules.R:
        return End(0.0, time, False)
    return End(distance(seen.evader, ward.position), time, True) if seen.share <= 1.0 else None


def _escort_late(scene: Scene) -> End:
    assert scene.ward is not None
    return End(distance(scene.evader.position, scene.ward.position), scene.game.time, True)


def _escort_admits(scene: Scene) -> bool:
    """A clear value, and an attacker that is not over the defender nor the target already."""
    return is_clear(_escort(scene)[0].value, scene) and scene.ward is not None


ESCORT = Problem(
    "target-attacker-defender", "Target, attacker and defender",
    "A defender as fast as the attacker meets it before it reaches a slower target that flies away.",
    "Pachter, Garcia and Casbeer 2014; Garcia, Casbeer and Pachter, arXiv 2002.04054",
    "distance of attacker and target when the defender meets the attacker", "m", +1,
    lambda s: _escort(s)[0].value, kept,
    _attacker, lambda s: all_to(s, _escort(s)[1]), _escort_end, _escort_late,
    "pure pursuit gives ground; 'paper' and 'evasive' flee, 'straight' flies at where the target is now",
    "its target flies, and the referee's targets stand",
    move=_with_ward_moved, shown=_ward_shown, placed=_with_ward, admits=_escort_admits, floor=0.0,
    faster=False, chasers=DEFENDERS,
)  # fmt: skip


# ---------------------------------------------------------------- capture the flag


def _home_line(scene: Scene) -> float:
    """North of the attacker's home line [m]: as far from the flag as the evader was at the start."""
    return scene.wanted


def _flag_value(scene: Scene) -> float:
    """How far from home the attacker is met [m]; on its way in, from where it will be met on its way back."""
    if scene.flag:
        return lowest_point(scene).x - _home_line(scene)
    return scene.home.x + _return(scene)[1] - _home_line(scene)


def _return(scene: Scene) -> tuple[float, float]:
    d = sub(scene.pursuers[0].position, scene.home)
    time = distance(scene.evader.position, scene.home) / scene.evader.speed
    return flag_return(d.y, d.x, time, (scene.evader.speed, scene.pursuers[0].speed))


def _flag_shown(scene: Scene) -> Scene:
    """The flag is the target until it is taken, then the home line's nearest point."""
    if not scene.flag:
        return aimed_at(scene, scene.home)
    return aimed_at(scene, scene.evader.position._replace(x=_home_line(scene)))


def _flag_evader(scene: Scene) -> Vec:
    return to_place(scene.evader, lowest_point(scene) if scene.flag else scene.home)


def _flag_defender(scene: Scene) -> tuple[Vec, ...]:
    if scene.flag:
        return all_to(scene, lowest_point(scene))
    bearing, speed = _return(scene)[0], scene.pursuers[0].speed
    return (Vec(speed * cos(bearing), speed * sin(bearing), 0.0),)


def _flag_move(scene: Scene, evader: Vec, pursuers: tuple[Vec, ...]) -> Scene:
    after = simple_motion(scene, evader, pursuers)
    taken = scene.flag or distance(after.evader.position, scene.home) <= scene.conditions.rules.epsilon_min
    return after._replace(flag=taken)


def _flag_end(before: Scene, after: Scene) -> End | None:
    seen, dt = touch(before, after), before.conditions.control.dt
    left = seen.evader.x - _home_line(before)
    if seen.share <= 1.0:
        return End(left, before.game.time + seen.share * dt, True)
    return End(0.0, after.game.time, False) if after.flag and left <= 0.0 else None


def _flag_late(scene: Scene) -> End:
    return End(max(0.0, scene.evader.position.x - _home_line(scene)), scene.game.time, True)


def _flag_admits(scene: Scene) -> bool:
    """The attacker can be at the flag first, and the value of its return is clear."""
    d, a = scene.pursuers[0], scene.evader
    late = not in_time(scene.home, d.position, d.speed, a.position, a.speed)
    return late and is_clear(_flag_value(scene), scene)


FLAG = Problem(
    "capture-the-flag", "Capture the flag",
    "An attacker that can reach a flag first carries it home over a line; a faster defender meets it.",
    "Garcia, Casbeer and Pachter, CDC 2018; Garcia and Casbeer 2025",
    "distance from home when the attacker is met with the flag", "m", +1,
    _flag_value, kept, _flag_evader, _flag_defender, _flag_end, _flag_late,
    "no strategy of ours knows of the way back: all meet the attacker's way in; our evaders do not attack",
    "the referee ends the game at the target: there is no way back",
    move=_flag_move, shown=_flag_shown, placed=lambda s: s._replace(wanted=s.evader.position.x),
    admits=_flag_admits, floor=0.0, chasers=DEFENDERS,
)  # fmt: skip


# ---------------------------------------------------------------- perimeter defence


def _rim(scene: Scene) -> float:
    return scene.conditions.rules.epsilon_min


def bearing_of(scene: Scene, place: Vec) -> float:
    """Bearing of a place from the perimeter's centre [rad]."""
    line = sub(place, scene.home)
    return atan2(line.y, line.x)


def _between(scene: Scene) -> float:
    """From the defender's bearing to the intruder's [rad, clockwise positive]."""
    return wrap(bearing_of(scene, scene.evader.position) - bearing_of(scene, scene.pursuers[0].position))


def _breach(scene: Scene) -> Breach:
    r = distance(scene.evader.position, scene.home) / _rim(scene)
    return breach(max(r, 1.0 + 1e-9), abs(_between(scene)), scene.evader.speed / scene.pursuers[0].speed)


def _on_rim(scene: Scene, bearing: float) -> Vec:
    return along(scene.home, Vec(cos(bearing), sin(bearing), 0.0), _rim(scene))


def _side(scene: Scene) -> float:
    return 1.0 if _between(scene) >= 0.0 else -1.0


def _intruder(scene: Scene) -> Vec:
    bearing = bearing_of(scene, scene.evader.position) + _side(scene) * _breach(scene).angle
    return to_place(scene.evader, _on_rim(scene, bearing))


def _guard(scene: Scene) -> tuple[Vec, ...]:
    """Along the rim after the intruder's breach."""
    own, side = scene.pursuers[0], _side(scene)
    b = bearing_of(scene, own.position)
    left = abs(_between(scene)) + _breach(scene).angle
    speed = min(own.speed, left * _rim(scene) / scene.conditions.control.dt)
    return (Vec(-side * speed * sin(b), side * speed * cos(b), 0.0),)


def _rim_move(scene: Scene, evader: Vec, pursuers: tuple[Vec, ...]) -> Scene:
    """The defender goes along the rim, as fast as its wish points along it."""
    after = simple_motion(scene, evader, pursuers)
    own = scene.pursuers[0]
    b, wish = bearing_of(scene, own.position), held_to(pursuers[0], own.speed)
    along_it = clamp(wish.y * cos(b) - wish.x * sin(b), -own.speed, own.speed)
    place = _on_rim(scene, b + along_it * scene.conditions.control.dt / _rim(scene))
    moved = own._replace(position=place, velocity=scale(Vec(-sin(b), cos(b), 0.0), along_it))
    return after._replace(game=after.game._replace(pursuers=(moved,)))


def _rim_end(before: Scene, after: Scene) -> End | None:
    """The intruder at the rim: what is left of the arc to the defender [m], 0 where it is met."""
    if touch(before, after).share <= 1.0:
        return End(0.0, after.game.time, True)
    if distance(after.evader.position, after.home) > _rim(after):
        return None
    left = abs(_between(after)) * _rim(after)
    met = left <= after.conditions.rules.R
    return End(0.0 if met else left, after.game.time, met)


def _rim_value(scene: Scene) -> float:
    return _breach(scene).value * _rim(scene)


PERIMETER = Problem(
    "perimeter-defence", "Perimeter defence",
    "A defender that moves on a circle alone meets an intruder where it comes to the circle.",
    "Shishika and Kumar, arXiv 1909.03989",
    "arc left to the defender when the intruder is at the circle", "m", -1,
    _rim_value, lambda _start, payoff: payoff <= 0.0, _intruder, _guard, _rim_end,
    lambda scene: End(0.0, scene.game.time, True),
    "ours aim across the circle, which keeps only what points along it; our evaders do not attack",
    "the defender may leave the circle there; the same disc is guarded in convex-target",
    move=_rim_move, placed=lambda s: _placed_on_rim(s),
    admits=lambda s: is_clear(_rim_value(s), s) and abs(_between(s)) < 0.9 * pi,
    floor=0.0, chasers=("paper", "parallel-pursuit", "goalkeeper", "pure-pursuit"),
)  # fmt: skip


def _placed_on_rim(scene: Scene) -> Scene:
    """The defender on the circle, where it was drawn as seen from the centre."""
    own = scene.pursuers[0]
    moved = own._replace(position=_on_rim(scene, bearing_of(scene, own.position)))
    return scene._replace(game=scene.game._replace(pursuers=(moved,)))
