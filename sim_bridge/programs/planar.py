"""What `sim-bridge planar` does: plays games one after the other, prints a table or lines, draws."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.game.plugins import pursuer_strategy
from onboard.runtime.progress import Progress, over
from onboard.runtime.run_folder import made
from sim_bridge.campaign import plane_play
from sim_bridge.plane_game import program


class Options(NamedTuple):
    """What `planar` can be told."""

    files: tuple[Path, ...] = ()  # none: the ten rows of Table 1
    strategies: tuple[str, ...] = ()  # of the pursuers; none: the paper's and that of [37]
    dt: float | None = None  # [s] in place of the scenario's
    horizon: float | None = None  # [s] likewise
    json: bool = False  # one JSON object a game, nothing else
    figures: Path | None = None  # folder of pictures
    film: Path | None = None  # GIF or MP4 of the first game
    compile: bool = False  # what is not compiled yet, first


def planar(options: Options) -> bool:
    """Play the games and tell of them; whether all verdicts are the paper's. Raises ConfigError.

    Games play compiled where that has been done before (`--compile`, a campaign), else interpreted: the same
    results. Pictures show every step's decisions, so that such games are interpreted.
    """
    games = program.within_horizon(program.load_plane(options.files or program.table1()), options.horizon)
    names = options.strategies or (program.THIS_PAPER, program.EARLIER)
    for name in names:
        pursuer_strategy(name)
    pictures = options.figures is not None or options.film is not None
    if pictures and options.compile:
        raise ConfigError("--compile: found with --figures or --animate, expected without: they interpret")
    if pictures:
        from sim_bridge.plane_game import figures as drawing
    if options.film is not None:
        drawing.check_film(options.film)
    if options.figures is not None:
        made(options.figures)
    results: list[program.Result] = []
    pairs = [(scenario, name) for scenario in games for name in names]
    with Progress("sim-bridge") as progress:
        for scenario, name in over(pairs, progress.show, "games"):
            first = not results
            quick = None if pictures else plane_play.result(scenario, name, options.dt, options.compile)
            if quick is None:
                played = program.play(scenario, name, options.dt, keep=pictures)
                quick = program.result(played)
            results.append(quick)
            if options.json:
                progress.aside(print)(msgspec.json.encode(results[-1]).decode())
            if options.figures is not None:
                drawing.draw_game(played, options.figures)
            if options.film is not None and first:
                drawing.animate(played, options.film)
    agree, total = program.differs(results)
    if not options.json:
        print(program.table(results))
        if total:
            print(f"\n{program.verdict_line(agree, total, games, not options.files)}")
        if options.figures is not None:
            print(f"{2 * len(results)} pictures in {options.figures}")
        if options.film is not None:
            print(f"animation of the first game in {options.film}")
    return agree == total
