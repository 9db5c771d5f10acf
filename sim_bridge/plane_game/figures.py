"""Pictures of plane games, in the manner of the paper's Figures 2 and 5–7, and animations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import atan2, degrees, pi
from pathlib import Path
from typing import Any

from onboard.config.strict import ConfigError
from onboard.core.game.advance import still_view
from onboard.core.geometry.apollonius import apollonius_sphere
from onboard.core.geometry.assessment import half_angle
from onboard.core.math.vectors import Vec, norm
from onboard.core.strategy.evasion import resultant_force, target_direction
from onboard.game import palette
from onboard.game.scenario import Scenario
from onboard.runtime.whole_files import whole_or_nothing
from sim_bridge.plane_game.program import Played

EVADER, TARGET, CIRCLE, CONE = (
    colour.light for colour in (palette.EVADER, palette.TARGET, palette.APOLLONIUS, palette.CONE)
)
STRATEGY_NAMES = {"paper": "strategy of this paper", "earlier": "strategy of the earlier paper [37]"}


def pyplot() -> Any:
    """Matplotlib's interface, drawing into files: the same bytes for the same picture."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "apollonius"
    import matplotlib.pyplot as plt

    return plt


def draw_game(played: Played, folder: Path, stem: str = "") -> list[Path]:
    """Initial and final stage side by side, as PNG and SVG named `stem` ("": after scenario and strategy).

    Returns the files written.
    """
    plt = pyplot()
    figure, axes = plt.subplots(1, 2, figsize=(14, 7.2), layout="constrained")
    for axis, index, title in ((axes[0], 0, "initial stage"), (axes[1], -1, "final stage")):
        draw_stage(axis, played, len(played.frames) - 1 if index else 0)
        axis.set_title(title)
    score = played.final.score
    strategy = STRATEGY_NAMES.get(played.strategy, played.strategy)
    figure.suptitle(
        f"{played.scenario.name}, {strategy}: {played.verdict.name.lower()} at {score.time:.1f} s, "
        f"smallest distance {score.smallest:.1f} m"
    )
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=9)
    name = f"{played.scenario.name}-{played.strategy}".replace(" ", "-").replace(",", "").replace("/", "-")
    return saved(figure, folder, stem or name)


def saved(figure: Any, folder: Path, stem: str) -> list[Path]:
    """A picture as PNG and SVG, which are told; the figure is closed."""
    written = []
    for ending in ("png", "svg"):
        path = folder / f"{stem}.{ending}"
        metadata = {"Date": None} if ending == "svg" else None
        whole_or_nothing(path, partial(figure.savefig, dpi=110, metadata=metadata))
        figure.set_layout_engine("none")  # laid out by the first, which takes as long as drawing does
        written.append(path)
    pyplot().close(figure)
    return written


def draw_stage(axis: Any, played: Played, index: int) -> None:
    """One instant: paths so far, circles and centres, cones, forces, headings."""
    game, decisions, target = played.frames[index], played.decisions(index), played.conditions.target
    view = still_view(game, played.conditions)
    span = extent(_points(played))
    zones_on(axis, played.scenario)
    _paths(axis, played, index)
    for number, pursuer in enumerate(game.pursuers):
        sphere = apollonius_sphere(game.evader.position, game.evader.speed, pursuer.position, pursuer.speed)
        if sphere.exists:
            axis.add_patch(_circle(sphere.centre, sphere.radius, CIRCLE))
            axis.plot(
                sphere.centre.y,
                sphere.centre.x,
                "+",
                color=CIRCLE,
                ms=7,
                label="Apollonius circle and its centre" if number == 0 else None,
            )
        vehicle, colour = number + 2, _pursuer(number)  # ids as on the bus: the evader is 1
        axis.plot(pursuer.position.y, pursuer.position.x, "o", color=colour, ms=7, label=f"pursuer {vehicle}")
        start = played.frames[0].pursuers[number].position  # where no two are in one place
        axis.annotate(str(vehicle), (start.y, start.x), (6, 5), textcoords="offset points", color=colour)
        arrow(axis, pursuer.position, decisions.pursuers[number].direction, 0.05 * span, colour, None)
    e = game.evader.position
    for number, cone in enumerate(view.cones):
        half, middle = half_angle(cone), atan2(cone.axis.x, cone.axis.y)
        if half < pi:
            axis.add_patch(wedge(e, 0.14 * span, middle, half))
            if number == 0:
                axis.plot([], [], color=CONE, lw=8, alpha=0.25, label="headings blocked by a pursuer")
    axis.plot(e.y, e.x, "o", color=EVADER, ms=8, label="evader 1")
    arrow(axis, e, decisions.evader.direction, 0.13 * span, EVADER, "chosen heading")
    force = resultant_force(view)
    if norm(force) > 0.0:
        size = 1.0 / norm(force)
        way = Vec(force.x * size, force.y * size, 0.0)
        arrow(axis, e, way, 0.09 * span, palette.FORCE.light, "resultant force F_res")
    if target.exists:
        arrow(axis, e, target_direction(view), 0.09 * span, TARGET, "direction of the target F_g")
        axis.plot(target.position.y, target.position.x, "*", color=TARGET, ms=14, label="target")
    rule = decisions.evader.rule.name.lower().replace("_", " ")
    words = f"t = {game.time:.2f} s\nevader: {rule}"
    axis.text(
        0.02,
        0.98,
        words,
        transform=axis.transAxes,
        va="top",
        fontsize=9,
        bbox={"fc": palette.PAPER.light, "ec": "none", "alpha": 0.8},
    )
    frame(axis, _points(played))


def check_film(path: Path) -> None:
    """Demand a kind of film that can be written here. Raises ConfigError."""
    ending = path.suffix.lower()
    if ending not in (".gif", ".mp4"):
        raise ConfigError(f"--animate: found '{path.name}', expected a name ending in .gif or .mp4")
    if ending == ".mp4":
        from matplotlib.animation import FFMpegWriter

        if not FFMpegWriter.isAvailable():
            raise ConfigError("--animate: .mp4 needs ffmpeg, which is not here; .gif needs nothing")
    if not path.parent.is_dir():
        raise ConfigError(f"--animate: found the folder '{path.parent}', expected one that exists")


def animate(played: Played, path: Path, seconds: float = 10.0, fps: int = 12) -> None:
    """The game as GIF, or as MP4 where ffmpeg is at hand. Raises ConfigError."""
    title = f"{played.scenario.name}: {played.verdict.name.lower()} at {played.final.score.time:.1f} s"

    def draw(axis: Any, index: int) -> None:
        draw_stage(axis, played, index)
        axis.set_title(title)

    filmed(draw, len(played.frames), path, seconds, fps)


def filmed(
    draw_at: Callable[[Any, int], None], frames: int, path: Path, seconds: float = 10.0, fps: int = 12
) -> None:
    """A film of what `draw_at(axis, frame)` draws of so many frames. Raises ConfigError."""
    check_film(path)
    plt = pyplot()
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter

    figure, axis = plt.subplots(figsize=(7.5, 7.5), layout="constrained")
    count = min(frames, max(2, int(seconds * fps)))
    chosen = [round(k * (frames - 1) / (count - 1)) for k in range(count)]

    def draw(index: int) -> None:
        axis.clear()
        draw_at(axis, index)

    movie = FuncAnimation(figure, draw, frames=chosen)
    writer = PillowWriter(fps=fps) if path.suffix.lower() == ".gif" else FFMpegWriter(fps=fps)
    whole_or_nothing(path, lambda part: movie.save(part, writer=writer, dpi=80))
    plt.close(figure)


def zones_on(axis: Any, scenario: Scenario) -> None:
    """The zones of a scenario on a map."""
    from matplotlib.patches import Polygon

    colour = palette.ZONE.light
    for spec in scenario.zones:
        corners = [(east, north) for north, east in spec.prism().polygon]
        axis.add_patch(Polygon(corners, fc=colour, ec=colour, alpha=0.25, lw=1.0))
        east, north = (sum(values) / len(corners) for values in zip(*corners, strict=True))
        axis.annotate(spec.name, (east, north), ha="center", va="center", color=colour, fontsize=9)


def _paths(axis: Any, played: Played, index: int) -> None:
    frames = played.frames[: index + 1]
    step = max(1, len(frames) // 600)
    kept = [*frames[:-1:step], frames[-1]]
    line = [f.evader.position for f in kept]
    axis.plot([p.y for p in line], [p.x for p in line], "--", color=EVADER, lw=1.4)
    for number in range(len(played.final.pursuers)):
        line = [f.pursuers[number].position for f in kept]
        axis.plot([p.y for p in line], [p.x for p in line], "-", color=_pursuer(number), lw=1.0)


def _pursuer(number: int) -> str:
    """The colour of the pursuer with this number, counted from 0."""
    return palette.vehicle(number + 2, evader=False).light


def _circle(centre: Vec, radius: float, colour: str) -> Any:
    from matplotlib.patches import Circle

    return Circle((centre.y, centre.x), radius, fill=False, ec=colour, lw=1.0)


def wedge(centre: Vec, radius: float, middle: float, half: float) -> Any:
    """Headings about a middle [rad, clockwise from north] as a sector about a place."""
    from matplotlib.patches import Wedge

    return Wedge(
        (centre.y, centre.x),
        radius,
        degrees(middle - half),
        degrees(middle + half),
        fc=CONE,
        alpha=0.16,
        ec="none",
    )


def arrow(axis: Any, start: Vec, way: Vec, length: float, colour: str, label: str | None) -> None:
    """An arrow from a place along a unit vector."""
    axis.annotate(
        "",
        (start.y + way.y * length, start.x + way.x * length),
        (start.y, start.x),
        arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6},
    )
    if label:
        axis.plot([], [], color=colour, lw=1.6, label=label)


def _points(played: Played) -> list[Vec]:
    step = max(1, len(played.frames) // 100)
    points = [v.position for f in played.frames[::step] for v in (f.evader, *f.pursuers)]
    target = played.conditions.target
    return [*points, target.position] if target.exists else points


def extent(points: Sequence[Vec]) -> float:
    """The width of a picture of these places [m]."""
    wide = max(p.y for p in points) - min(p.y for p in points)
    high = max(p.x for p in points) - min(p.x for p in points)
    return 1.3 * max(wide, high, 1.0)


def frame(axis: Any, points: Sequence[Vec]) -> None:
    """The axes of a picture of these places."""
    half = 0.5 * extent(points)
    east = 0.5 * (max(p.y for p in points) + min(p.y for p in points))
    north = 0.5 * (max(p.x for p in points) + min(p.x for p in points))
    axis.set_xlim(east - half, east + half)
    axis.set_ylim(north - half, north + half)
    axis.set_aspect("equal")
    axis.set_xlabel("east (Z) [m]")
    axis.set_ylabel("north (X) [m]")
    axis.grid(alpha=0.25)
