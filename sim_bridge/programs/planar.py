"""What `sim-bridge planar` does: plays games one after the other, prints a table or lines, draws."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import pursuer_named
from onboard.game.plugins import pursuer_strategy
from onboard.game.scenario import Scenario
from onboard.runtime.progress import Progress, over
from onboard.runtime.run_folder import made
from sim_bridge.campaign import plane_play
from sim_bridge.plane_game import program, several


class Options(NamedTuple):
    """What `planar` can be told."""

    files: tuple[Path, ...] = ()  # none: the ten rows of Table 1
    strategies: tuple[str, ...] = ()  # of the pursuers; none: the paper's and that of [37], or in games of
    # several evaders the scenario's own
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
    loaded = program.within_horizon(program.load_plane(options.files or program.table1()), options.horizon)
    games, others = [s for s in loaded if not s.several], [s for s in loaded if s.several]
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
    if others:
        play_several(others, options, films=not games)
    if not games:
        return True
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


def play_several(scenarios: list[Scenario], options: Options, films: bool) -> None:
    """Play games of several evaders or targets, interpreted, and tell of each evader. Raises ConfigError.

    `films`: whether the first of them is the one to animate.
    """
    if options.compile:
        raise ConfigError(
            "--compile: found with a game of several evaders or targets, which is interpreted here; expected"
            " `sim-bridge campaign run`, which compiles it"
        )
    pairs = [(s, name) for s in scenarios for name in options.strategies or own_strategy(s)]
    with Progress("sim-bridge") as progress:
        for number, (scenario, name) in enumerate(over(pairs, progress.show, "games")):
            film = options.film if films and number == 0 else None
            played = several.play(scenario, name, options.dt, keep=bool(options.figures or film))
            found = several.result(played)
            say = progress.aside(print)
            say(msgspec.json.encode(found).decode() if options.json else several.story(found))
            if options.figures is not None or film is not None:
                from sim_bridge.plane_game import several_figures

                if options.figures is not None:
                    drawn = several_figures.draw_game(played, options.figures)
                    if not options.json:
                        say(f"  drawn: {drawn[0]}")
                if film is not None:
                    several_figures.animate(played, film)


def own_strategy(scenario: Scenario) -> tuple[str, ...]:
    """The one strategy of a scenario's pursuers. Raises ConfigError where they have several."""
    names = sorted({pursuer_named(spec.strategy) for spec in scenario.pursuers})
    if len(names) > 1:
        raise ConfigError(
            f"{scenario.name}: pursuers.strategy: found {', '.join(names)}, expected one for all in a plane"
            " game: --strategy"
        )
    return tuple(names)
