"""`sim-bridge campaign`: many games, and what they say."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from onboard.config.bounds import Count, Seed
from onboard.runtime import options
from onboard.runtime.resources import SCENARIOS
from sim_bridge.programs.campaigns.studies import app as studies

Folder = Annotated[Path, typer.Argument(help="Folder of a campaign.")]
Game = Annotated[str, typer.Argument(help="CELL:SEED, as `show` numbers the cells.")]


class RunByDefault(options.Group):
    """A group in which `campaign SCENARIO…` is `campaign run SCENARIO…`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Put `run` before what is no command."""
        if args and args[0] not in self.commands and args[0] not in ("-h", "--help"):
            args = ["run", *args]
        return super().parse_args(ctx, args)

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """Commands, and the scenarios that `run` takes."""
        [scenarios] = [one for one in self.commands["run"].params if one.name == "scenarios"]
        return [*super().shell_complete(ctx, incomplete), *scenarios.shell_complete(ctx, incomplete)]


app = options.group(
    "Play many games: scenarios, strategies, swept values and seeds; `campaign SCENARIO` is `campaign run`.",
    no_args_is_help=True,
    cls=RunByDefault,
    epilog="Examples: sim-bridge campaign five --games 200 | sim-bridge campaign show runs/campaign-five",
)
app.add_typer(studies, name="study")


@app.command(
    epilog="Examples: sim-bridge campaign run five six --evader all --games 200 | sim-bridge campaign run"
    " row01 --sweep sweep.toml --until 'ci<0.02' | sim-bridge campaign run five --shard 2/8 --out /tmp/five"
    " | sim-bridge campaign run one-on-one --flown --games 4"
)
def run(
    scenarios: Annotated[
        list[Path],
        typer.Argument(
            help="Scenario files, or names of shipped ones.",
            autocompletion=options.shipped(SCENARIOS.sought_first("spatial")),
        ),
    ],
    evader: Annotated[
        list[str] | None,
        typer.Option(help="Evader's strategy, or 'all'; may be repeated. Default: the scenario's."),
    ] = None,
    pursuers: Annotated[
        list[str] | None,
        typer.Option(help="Pursuers' strategy, or 'all'; may be repeated. Default: the scenario's."),
    ] = None,
    sweep: Annotated[Path | None, typer.Option(help="TOML file of values to sweep.")] = None,
    games: Annotated[
        int | None, options.value(Count, "--games", words="Games of each kind [100].", unit="N")
    ] = None,
    seed: Annotated[int, options.value(Seed, "--seed", words="The first seed.", unit="N")] = 1,
    until: Annotated[
        str | None, typer.Option(help="Rule that ends it: 'ci<0.01', 'ci(arrived)<0.02'.")
    ] = None,
    max_games: Annotated[
        int | None, options.value(Count, "--max-games", words="At most so many games in all.", unit="N")
    ] = None,
    flown: Annotated[
        bool, typer.Option("--flown", help="Fly each game whole on virtual time, agents included.")
    ] = False,
    out: Annotated[Path | None, typer.Option(help="Folder of the campaign [runs/campaign-SCENARIO].")] = None,
    workers: Annotated[
        int | None, options.value(Count, "--workers", words="Processes [one a core].", unit="N")
    ] = None,
    dask: Annotated[str | None, typer.Option(help="Scheduler of a Dask cluster, tcp://HOST:8786.")] = None,
    shard: Annotated[str | None, typer.Option(help="Play part I of N alone: I/N, for array jobs.")] = None,
    shard_games: Annotated[
        int, options.value(Count, "--shard-games", words="About so many games a file.", unit="N")
    ] = 1000,
) -> None:
    """Play what the folder lacks of a campaign, and tell what its games say. Interrupted, it goes on."""
    from sim_bridge.programs.campaigns import command as room
    from sim_bridge.programs.campaigns.run import run as play
    from sim_bridge.programs.campaigns.show import results, text

    told = room.Options(tuple(scenarios), tuple(evader or ()), tuple(pursuers or ()), sweep, games, max_games,
                        seed, shard_games, flown)  # fmt: skip
    ways = room.ways_of(room.Played(workers, dask, shard, until))
    plan = room.plan_of(told, ways.until is not None)
    folder = room.folder_of(told) if out is None else out
    play(folder, plan, ways, lambda line: typer.echo(f"sim-bridge: {line}", err=True))
    print(text(results(folder)))
    print(f"\nin {folder}")


@app.command(epilog="Examples: sim-bridge campaign show runs/campaign-five --figures pictures")
def show(
    folder: Folder,
    figures: Annotated[Path | None, typer.Option(help="Folder for pictures.")] = None,
) -> None:
    """Tell what a campaign's games say: shares with 95 % intervals, paired tests, pictures."""
    from onboard.runtime.run_folder import made
    from sim_bridge.programs.campaigns.show import results, text

    found = results(folder)
    for note in found.notes:
        typer.echo(f"sim-bridge: {note}", err=True)
    print(text(found))
    if figures is not None:
        from sim_bridge.programs.campaigns.figures import draw

        for path in draw(found, made(figures)):
            print(f"drawn: {path}")


@app.command(epilog="Example: sim-bridge campaign replay runs/campaign-five 0:17 --figures pictures")
def replay(
    folder: Folder,
    game: Game,
    figures: Annotated[Path, typer.Option(help="Folder for the picture.")] = Path("figures"),
) -> None:
    """Play one game again and draw it, and why the evader was not captured; exit 1 when it is not the game of
    the folder."""
    from sim_bridge.programs.campaigns import again

    chosen = again.game_of(folder, game)
    row, pictures, why = again.replay(chosen, figures)
    captor = f" by pursuer {row.captor}" if row.captor else ""
    print(f"{row.verdict}{captor} after {row.time:.2f} s, smallest distance {row.smallest:.2f} m")
    if why:
        print(why)
    for path in pictures:
        print(f"drawn: {path}")
    if not again.agrees(chosen, row):
        kept = chosen.kept
        typer.echo(f"sim-bridge: the folder has another game: {kept}; its sources were others", err=True)
        raise typer.Exit(1)


@app.command(epilog="Example: sim-bridge campaign fly runs/campaign-five 0:17 --runs runs")
def fly(
    folder: Folder,
    game: Game,
    runs: Annotated[Path, typer.Option(help="Folder for run folders.")] = Path("runs"),
    report: Annotated[bool, typer.Option("--report/--no-report", help="Make the report at the end.")] = True,
) -> None:
    """Fly one game whole on virtual time, with agents and MAVLink, and leave a run folder."""
    from sim_bridge.programs.campaigns import again

    print(again.fly(again.game_of(folder, game), runs, report))
