"""The ten problems by name, and the scenario file of each."""

from __future__ import annotations

from pathlib import Path

from onboard.config.in_words import nearest
from onboard.config.strict import ConfigError
from onboard.game.scenario import load
from onboard.runtime.resources import configs
from sim_bridge.classic.chases import CARS, CHAUFFEUR, CUTTERS, LIONS
from sim_bridge.classic.guards import BORDER, CONVEX, HALF_SPACE
from sim_bridge.classic.play import Scene
from sim_bridge.classic.problem import Problem, scene_of
from sim_bridge.classic.raids import ESCORT, FLAG, PERIMETER

PROBLEMS: dict[str, Problem] = {
    one.name: one
    for one in (CHAUFFEUR, CARS, CUTTERS, ESCORT, CONVEX, HALF_SPACE, BORDER, FLAG, PERIMETER, LIONS)
}
FOLDER = "classic"  # room of the shipped scenarios


def problem_named(name: str) -> Problem:
    """A problem by its name. Raises ConfigError that lists them."""
    found = PROBLEMS.get(name)
    if found is None:
        known = list(PROBLEMS)
        raise ConfigError(f"found '{name}', expected a problem: {', '.join(known)}{nearest(name, known)}")
    return found


def file_of(problem: Problem) -> Path:
    """The shipped scenario of a problem."""
    return configs() / "scenarios" / FOLDER / f"{problem.name}.toml"


def start_of(problem: Problem, file: Path | None = None) -> Scene:
    """The problem's start, as shipped or of a file of one's own. Raises ConfigError."""
    return scene_of(problem, load(file or file_of(problem)))


def played_by_bench() -> tuple[str, ...]:
    """Names of the scenarios whose form the games of `bench` have."""
    return tuple(f"{FOLDER}/{one.name}" for one in PROBLEMS.values() if not one.left_out)
