"""`sim-bridge`: the plane game, the simulated autopilots, whole games."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import typer  # noqa: E402  (threads are set before anything imports NumPy)

from onboard.runtime.config import ConfigError  # noqa: E402
from onboard.runtime.program import run  # noqa: E402

app = typer.Typer(
    help="Plays the autopilots in software, so that everything runs without hardware.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


@app.callback()
def _root() -> None:
    """Keeps subcommands subcommands."""


@app.command(
    epilog="Examples: sim-bridge planar | sim-bridge planar my.toml --strategy pure-pursuit --figures out"
    " | sim-bridge planar my.toml --json",
)
def planar(
    scenarios: Annotated[
        list[Path] | None,
        typer.Argument(help="Scenario files; none: the ten rows of the paper's Table 1."),
    ] = None,
    strategy: Annotated[
        list[str] | None,
        typer.Option(help="Pursuers' strategy; may be repeated. Default: 'paper' and 'earlier' [37]."),
    ] = None,
    dt: Annotated[float | None, typer.Option(help="Time step [s], in place of the scenario's.")] = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object a game, nothing else.")] = False,
    figures: Annotated[
        Path | None, typer.Option(help="Folder for pictures of the initial and final stage (PNG and SVG).")
    ] = None,
    animate: Annotated[Path | None, typer.Option(help="GIF or MP4 of the first game.")] = None,
) -> None:
    """Play the paper's plane game; exit 1 when a verdict differs from the paper's."""
    from onboard.runtime.plugins import pursuer_strategy
    from sim_bridge import planar as room

    if dt is not None and not 0.0 < dt <= 1.0:
        raise ConfigError(f"--dt: found {dt}, expected a time step in (0, 1] s")
    games = room.load_plane(scenarios or room.table1())
    names = strategy or [room.THIS_PAPER, room.EARLIER]
    for name in names:
        pursuer_strategy(name)
    pictures = figures is not None or animate is not None
    if figures is not None:
        _folder(figures)
    results: list[room.Result] = []
    for scenario in games:
        for name in names:
            first = not results
            played = room.play(scenario, name, dt, keep=pictures)
            results.append(room.result(played))
            if json:
                import msgspec

                print(msgspec.json.encode(results[-1]).decode())
            if figures is not None:
                from sim_bridge.planar_figures import draw_game

                draw_game(played, figures)
            if animate is not None and first:
                from sim_bridge.planar_figures import animate as film

                film(played, animate)
    agree, total = room.differs(results)
    if not json:
        print(room.table(results))
        if total:
            print(f"\n{agree} of {total} verdicts as in the paper")
        if figures is not None:
            print(f"{2 * len(results)} pictures in {figures}")
        if animate is not None:
            print(f"animation of the first game in {animate}")
    if agree != total:
        raise typer.Exit(1)


def _folder(path: Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None


def main() -> None:
    """Entry point."""
    run(app, "sim-bridge")


if __name__ == "__main__":
    main()
