"""A picture of a classical problem: the start, what decides it, both sides' optimal paths, and ours."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.core.strategy.registry import DEFAULT_PURSUER
from onboard.game import palette
from onboard.runtime.whole_files import whole_or_nothing
from sim_bridge.classic.guards import BORDER, HALF_SPACE, border
from sim_bridge.classic.play import Scene, ours
from sim_bridge.classic.problem import Problem, play
from sim_bridge.classic.raids import ESCORT, FLAG, PERIMETER
from sim_bridge.classic.values.regions import balls_of
from sim_bridge.plane_game.figures import pyplot

ENDINGS = (".png", ".svg", ".pdf")
STEPS = 200  # points of a drawn path at most


def check(path: Path) -> None:
    """Demand a kind of picture that can be written, in a folder that exists. Raises ConfigError."""
    if path.suffix.lower() not in ENDINGS:
        raise ConfigError(f"--picture: found '{path.name}', expected a name ending in {', '.join(ENDINGS)}")
    if not path.parent.is_dir():
        raise ConfigError(f"--picture: found the folder '{path.parent}', expected one that exists")


def draw(problem: Problem, start: Scene, path: Path) -> None:
    """Optimal play in full lines, our default pursuers against the optimal evader in dotted ones."""
    best = play(problem, start, problem.evader, problem.pursuers, keep=True)
    other = play(problem, start, problem.evader, ours(DEFAULT_PURSUER)(), keep=True)
    plt = pyplot()
    figure, axis = plt.subplots(figsize=(5.6, 6.0), layout="constrained")
    _paths(axis, problem, other.path, ":")
    _paths(axis, problem, best.path, "-")
    _ground(axis, problem, start)
    axis.autoscale_view()
    reach = (axis.get_xlim(), axis.get_ylim())
    if problem.move.__name__ == "simple_motion":
        _balls(axis, problem, start)
    _limits(axis, problem, reach)
    unit = f" {problem.unit}" if problem.unit else ""
    axis.set_title(f"{problem.title}\n{problem.payoff}: {problem.value(start):.1f}{unit}", fontsize=9)
    axis.plot([], [], "k:", label=f"{DEFAULT_PURSUER} in place of optimal pursuers")
    figure.legend(fontsize=8, loc="outside lower center", ncols=3)
    metadata = {"Date": None} if path.suffix.lower() == ".svg" else None
    whole_or_nothing(path, partial(figure.savefig, dpi=110, metadata=metadata))
    plt.close(figure)


def _flat(problem: Problem, place: Vec) -> tuple[float, float]:
    """Across and up on paper: east and north, in space north and height."""
    return (place.x, -place.z) if problem.space else (place.y, place.x)


def _paths(axis: Any, problem: Problem, path: tuple[Scene, ...], style: str) -> None:
    kept = [*path[:: max(1, len(path) // STEPS)], path[-1]]
    lines = [("evader", palette.EVADER.light, [s.evader.position for s in kept])]
    lines += [
        (
            f"pursuer {i + 2}",
            palette.vehicle(i + 2, evader=False).light,
            [s.pursuers[i].position for s in kept],
        )
        for i in range(len(path[0].pursuers))
    ]
    if kept[0].ward is not None:
        lines.append(("target", palette.TARGET.light, [s.ward.position for s in kept if s.ward is not None]))
    for name, colour, places in lines:
        xs, ys = zip(*(_flat(problem, place) for place in places), strict=True)
        axis.plot(xs, ys, style, color=colour, lw=1.6, label=name if style == "-" else None)
        if style == "-":
            axis.plot(xs[0], ys[0], "o", color=colour, ms=6)
            axis.plot(xs[-1], ys[-1], "x", color=colour, ms=6)


def _ground(axis: Any, problem: Problem, start: Scene) -> None:
    """What is defended."""
    from matplotlib.patches import Circle

    colour = palette.TARGET.light
    if problem.name in (BORDER.name, HALF_SPACE.name):
        edge = -border(start)
        axis.axhline(edge, color=colour, lw=1.6, label="border")
    elif problem.name == FLAG.name:
        axis.axhline(start.wanted, color=colour, lw=1.6, label="home")
        axis.plot(*_flat(problem, start.home), "*", color=colour, ms=12, label="flag")
    elif start.conditions.target.exists and problem.name != ESCORT.name:
        radius = start.conditions.rules.epsilon_min
        word = "perimeter" if problem.name == PERIMETER.name else "target"
        axis.add_patch(Circle(_flat(problem, start.home), radius, fill=False, ec=colour, lw=1.6, label=word))


def _balls(axis: Any, problem: Problem, start: Scene) -> None:
    """The Apollonius circles at the start, cut by the paper in space."""
    from matplotlib.patches import Circle

    for number, ball in enumerate(balls_of(start.evader, start.pursuers)):
        word = "Apollonius circles" if number == 0 else None
        edge = palette.APOLLONIUS.light
        axis.add_patch(Circle(_flat(problem, ball.centre), ball.radius, fill=False, ec=edge, label=word))


def _limits(axis: Any, problem: Problem, reach: Any) -> None:
    """A square around the paths and what is defended; circles may reach beyond."""
    half = 0.55 * max(high - low for low, high in reach)
    for (low, high), put in zip(reach, (axis.set_xlim, axis.set_ylim), strict=True):
        put(0.5 * (low + high) - half, 0.5 * (low + high) + half)
    axis.set_aspect("equal")
    axis.set_xlabel("north [m]" if problem.space else "east [m]")
    axis.set_ylabel("height [m]" if problem.space else "north [m]")
    axis.grid(alpha=0.25)
