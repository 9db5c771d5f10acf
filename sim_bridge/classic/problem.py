"""What a classical problem is, and how one of its games is drawn and played."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, inf, isfinite, pi, sin
from typing import NamedTuple

from numpy.random import Generator

from onboard.config.strict import ConfigError
from onboard.core.game.rules import Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, along, distance
from onboard.game.scenario import Scenario
from sim_bridge.classic.play import End, Evader, Mover, Played, Pursuers, Scene, held_to, simple_motion
from sim_bridge.plane_game.setup import conditions_of, game_of

SPREAD = 0.35  # of its distance to the evader: how far a drawn start moves a pursuer
TURNED = 0.5 * pi  # [rad] at most either way: how a drawn start turns a car
DRAWS = 2000  # starts drawn before a problem counts as having none


def _same(scene: Scene) -> Scene:
    return scene


def _all(_scene: Scene) -> bool:
    return True


def _zero(_before: Scene, now: Scene) -> float:
    return now.seen


class Problem(NamedTuple):
    """A pursuit–evasion problem with a known value. The pursuers want a small payoff, or a great one."""

    name: str  # of the command, and of its scenario file
    title: str
    rule: str  # what is played, in a sentence
    reference: str
    payoff: str  # what the value says, in words
    unit: str
    pursuers_want: int  # −1: little of the payoff, +1: much
    value: Callable[[Scene], float]
    won: Callable[[Scene, float], bool]  # whether a payoff from that start is the pursuers' game
    evader: Evader  # optimal play
    pursuers: Pursuers  # optimal play
    end: Callable[[Scene, Scene], End | None]  # after a step from the first scene to the second
    late: Callable[[Scene], End]  # at the horizon
    why: str  # where ours fall short
    left_out: str = ""  # why `bench` cannot play it, if so
    move: Mover = simple_motion
    shown: Callable[[Scene], Scene] = _same  # what both sides are shown at an instant
    placed: Callable[[Scene], Scene] = _same  # a drawn start put where the rule has it
    admits: Callable[[Scene], bool] = _all  # whether the value holds from a start
    noted: Callable[[Scene, Scene], float] = _zero  # what is carried on after a step
    at_once: bool = True  # whether the evader's velocity is what it decides, so that pursuers see it
    floor: float = -inf  # of the payoff
    teams: tuple[int, int] = (1, 1)  # least and most pursuers
    faster: bool = True  # the pursuers; else they are as fast as the evader
    evaders: tuple[str, ...] = ("paper", "evasive", "straight")
    chasers: tuple[str, ...] = ("paper", "parallel-pursuit", "pure-pursuit")

    def expected(self, value: float) -> float:
        """The payoff of optimal play: a game that is lost for who is paid pays no less than nothing."""
        return max(value, self.floor)

    @property
    def space(self) -> bool:
        """Whether it is played in space."""
        return self.name == "half-space"


def scene_of(problem: Problem, scenario: Scenario) -> Scene:
    """The start that a scenario file describes. Raises ConfigError for one of another form."""
    if scenario.planar == problem.space:
        found, wanted = ("two", "three") if scenario.planar else ("three", "two")
        raise ConfigError(f"{scenario.name}: position: found {found} numbers, expected {wanted}")
    _demand_form(problem, scenario)
    conditions = conditions_of(scenario)
    scene = Scene(game_of(scenario), conditions, conditions.target.position)
    scene = problem.shown(problem.placed(scene))
    if not problem.admits(scene) or not isfinite(problem.value(scene)):
        raise ConfigError(f"{scenario.name}: found a start where the value of '{problem.name}' is not known")
    return scene


def _demand_form(problem: Problem, scenario: Scenario) -> None:
    """Demand as many pursuers, as fast, and a target where the problem has one. Raises ConfigError."""
    where, (least, most) = f"{scenario.name}: found", problem.teams
    count, pace = len(scenario.pursuers), scenario.evader.speed
    if not least <= count <= most:
        wanted = f"{least}" if least == most else f"{least} to {most}"
        raise ConfigError(f"{where} {count} pursuers, expected {wanted} for '{problem.name}'")
    for one in scenario.pursuers:
        if one.speed <= pace if problem.faster else one.speed != pace:
            wanted = f"more than the evader's {pace:g}" if problem.faster else f"the evader's {pace:g}"
            raise ConfigError(
                f"{where} a pursuer of {one.speed:g} m/s, expected {wanted} for '{problem.name}'"
            )
    if problem.floor == 0.0 and scenario.evader.target is None:
        raise ConfigError(f"{where} no target of the evader, expected one for '{problem.name}'")


def drawn(problem: Problem, start: Scene, rng: Generator) -> Scene:
    """A start near another one: every pursuer moved, cars turned, the value known. Raises ConfigError."""
    for _ in range(DRAWS):
        game = start.game
        team = tuple(_moved(one, game.evader.position, start, rng) for one in game.pursuers)
        evader = _turned(game.evader, rng) if not problem.at_once else game.evader
        scene = problem.placed(start._replace(game=game._replace(evader=evader, pursuers=team)))
        scene = problem.shown(scene)
        apart = min(distance(p.position, scene.evader.position) for p in scene.pursuers)
        if apart > 2.0 * start.conditions.rules.R and problem.admits(scene):
            return scene
    raise ConfigError(f"{problem.name}: found no start near the file's for which the value is known")


def _moved(one: Vehicle, evader: Vec, start: Scene, rng: Generator) -> Vehicle:
    far = SPREAD * distance(one.position, evader)
    shift = rng.uniform(-far, far, 3).tolist()
    z = 0.0 if start.conditions.rules.planar else shift[2]
    return one._replace(position=along(one.position, Vec(shift[0], shift[1], z), 1.0))


def _turned(one: Vehicle, rng: Generator) -> Vehicle:
    a = float(rng.uniform(-TURNED, TURNED))
    v = one.velocity
    turned = Vec(v.x * cos(a) - v.y * sin(a), v.x * sin(a) + v.y * cos(a), v.z)
    return one._replace(velocity=turned)


def play(problem: Problem, start: Scene, evader: Evader, pursuers: Pursuers, keep: bool = False) -> Played:
    """Play a game from a start to its end; `keep` keeps every step for a picture."""
    scene, path = start, [start]
    horizon = start.conditions.rules.horizon
    while scene.game.time < horizon - 1e-9:
        wish = evader(scene)
        told = scene
        if problem.at_once:
            seen = scene.evader._replace(velocity=held_to(wish, scene.evader.speed))
            told = scene._replace(game=scene.game._replace(evader=seen))
        after = problem.move(scene, wish, pursuers(told))
        end = problem.end(scene, after)
        after = after._replace(seen=problem.noted(scene, after))
        if keep:
            path.append(after)
        if end is not None:
            return Played(end, tuple(path))
        scene = problem.shown(after)
    return Played(problem.late(scene), tuple(path))


def aimed_at(scene: Scene, place: Vec) -> Scene:
    """The same scene where both sides are shown that target [m]."""
    return scene._replace(conditions=scene.conditions._replace(target=Target(True, place)))
