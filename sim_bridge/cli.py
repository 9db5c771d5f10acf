"""`sim-bridge`: the plane game, the simulated autopilots, whole games, campaigns."""

from __future__ import annotations

from onboard.runtime.early import one_line_interrupts

one_line_interrupts("sim-bridge", __name__)

import os
from pathlib import Path
from typing import Annotated

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import typer

from onboard.config.bounds import Count, Epochs, Flights, PositiveDistance, PositiveDuration, Seed, TimeStep
from onboard.config.printable import printable
from onboard.config.strict import ConfigError
from onboard.runtime import options
from onboard.runtime.options import VersionOption
from onboard.runtime.program import run
from onboard.runtime.resources import AIRCRAFT, CLASSIC, SCENARIOS, shipped_file
from sim_bridge.programs.campaigns.cli import app as campaign_app
from sim_bridge.programs.shipped_list import Listed

ScenarioArgument = Annotated[
    Path,
    typer.Argument(
        help="Scenario file, or the name of a shipped one (demo, one-on-one …).",
        autocompletion=options.shipped(SCENARIOS),
    ),
]
SeedOption = Annotated[
    int | None, options.value(Seed, "--seed", words="Seed, in place of the scenario's.", unit="N")
]
BusOption = Annotated[str, typer.Option(help="Zenoh endpoint [tcp/127.0.0.1:7447].")]

app = options.group(
    "Plays the autopilots in software, so that everything runs without hardware.",
    no_args_is_help=True,
    epilog="Examples: sim-bridge list | sim-bridge fly --fast one-on-one | sim-bridge planar",
)


@app.callback()
def _root(version: VersionOption = False) -> None:
    """Plays the autopilots in software, so that everything runs without hardware."""


@app.command(
    epilog="Examples: sim-bridge planar | sim-bridge planar --compile"
    " | sim-bridge planar three-on-ten --figures out"
    " | sim-bridge planar my.toml --json | sim-bridge planar --horizon 200",
)
def planar(
    scenarios: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Scenario files or names; none: the ten rows of the paper's Table 1.",
            autocompletion=options.shipped(SCENARIOS.sought_first("table1")),
        ),
    ] = None,
    strategy: Annotated[
        list[str] | None,
        typer.Option(help="Pursuers' strategy; may be repeated [paper and earlier; of several: their own]."),
    ] = None,
    dt: Annotated[
        float | None,
        options.value(TimeStep, "--dt", words="Time step [s], in place of the scenario's.", unit="S"),
    ] = None,
    horizon: Annotated[
        float | None,
        options.value(PositiveDuration, "--horizon", words="Longest game [s], likewise.", unit="S"),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object a game, nothing else.")] = False,
    figures: Annotated[
        Path | None, typer.Option(help="Folder for pictures of the initial and final stage (PNG and SVG).")
    ] = None,
    animate: Annotated[Path | None, typer.Option(help="GIF or MP4 of the first game.")] = None,
    compile: Annotated[
        bool, typer.Option("--compile", help="Compile first, half a minute a strategy; kept for later runs.")
    ] = False,
) -> None:
    """Play the paper's plane game; exit 1 when a verdict differs from the paper's."""
    from sim_bridge.programs import planar as room

    shelf = SCENARIOS.sought_first("table1")
    files = tuple(shipped_file(one, shelf) for one in scenarios or ())
    wanted = room.Options(files, tuple(strategy or ()), dt, horizon, json, figures, animate, compile)
    if not room.planar(wanted):
        raise typer.Exit(1)


@app.command(epilog="Example: sim-bridge serve demo, and then: onboard-agent --id 2 --take-control; gcs")
def serve(
    scenario: ScenarioArgument,
    bus: BusOption = "",
    listen: Annotated[
        bool, typer.Option("--listen/--join", help="Be the one that the others connect to.")
    ] = True,
    game: Annotated[str, typer.Option(help="Name of the game on the bus.")] = "game",
    zenoh: Annotated[Path | None, typer.Option(help="Zenoh configuration file.")] = None,
    referee: Annotated[
        bool, typer.Option("--referee/--no-referee", help="Be the game's master, unless another one is.")
    ] = True,
    once: Annotated[bool, typer.Option("--once", help="End when the game has ended.")] = False,
    seed: SeedOption = None,
    ports: Annotated[Path | None, typer.Option(help="Write the agents' ports to this JSON file.")] = None,
) -> None:
    """Play the autopilots of a scenario on UDP in real time, with its sensor and master on the bus."""
    from sim_bridge.programs.serve import Options
    from sim_bridge.programs.serve import serve as run_server

    chosen = Options(
        game=game, bus=bus, listen=listen, zenoh=zenoh, referee=referee, once=once, seed=seed, ports=ports
    )
    path = shipped_file(scenario, SCENARIOS)
    run_server(path, chosen)


@app.command(epilog="Examples: sim-bridge fly demo | sim-bridge fly --fast --seed 3 my.toml --runs /tmp/runs")
def fly(
    scenario: ScenarioArgument,
    fast: Annotated[bool, typer.Option("--fast", help="One process, virtual time, deterministic.")] = False,
    seed: SeedOption = None,
    runs: Annotated[Path, typer.Option(help="Folder for run folders.")] = Path("runs"),
    bus: BusOption = "",
    report: Annotated[bool, typer.Option("--report/--no-report", help="Make the report at the end.")] = True,
    quiet: Annotated[bool, typer.Option("--quiet", help="Only the result.")] = False,
) -> None:
    """Fly a whole game, agents included, and leave a run folder; exit 1 when it ended without a verdict."""
    from sim_bridge.programs import fly as room

    if fast and bus:
        raise ConfigError("--bus: found with --fast, whose bus is within the one process")
    path, chosen = shipped_file(scenario, SCENARIOS), room.Options(fast, seed, runs, bus, report, quiet)
    flown = room.fly(path, chosen, lambda line: print(printable(line), flush=True))
    print(room.story(flown))
    if flown.summary.verdict not in ("captured", "arrived", "denied", "escaped"):
        raise typer.Exit(1)


@app.command(
    epilog="Examples: sim-bridge accept udpin://127.0.0.1:14541 | sim-bridge accept"
    " serial:///dev/ttyUSB0:57600 --only hold --only silence --tlog bench.tlog",
)
def accept(
    url: Annotated[str, typer.Argument(help="Link to the autopilot, as the agent's.")],
    tlog: Annotated[Path, typer.Option(help="New file for all frames of the flight.")] = Path("accept.tlog"),
    only: Annotated[
        list[str] | None,
        typer.Option(help="A story: hold, refusal, follow, return, silence; may be repeated. Default: all."),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Fly every story without asking.")] = False,
) -> None:
    """Fly stories against a real autopilot and its simulated twin; exit 1 when they differ."""
    from sim_bridge.programs import accept as room

    chosen = room.Options(tlog=tlog, only=tuple(only or ()), yes=yes)
    rows = room.accept(url, chosen, lambda line: print(line, flush=True), typer.confirm)
    differ = sum(not row.same for row in rows)
    print(room.table(rows))
    print(f"\n{len(rows) - differ} of {len(rows)} as the simulated twin; the flight is in {tlog}")
    if differ:
        raise typer.Exit(1)


@app.command("list", epilog="Examples: sim-bridge list | sim-bridge list strategies")
def list_(
    what: Annotated[Listed | None, options.value(Listed, words="What.")] = None,
) -> None:
    """List scenarios, strategies, aircraft and autopilots by the names that commands and files take."""
    from sim_bridge.programs.shipped_list import lines

    print("\n".join(lines(what)))


app.add_typer(campaign_app, name="campaign")


@app.command(
    epilog="Examples: sim-bridge bench --games 50 | sim-bridge bench --scenario five --evader paper"
    " | sim-bridge bench --classic --games 50 | sim-bridge bench --key organisers.key --out /tmp/bench",
)
def bench(
    scenario: Annotated[
        list[Path] | None,
        typer.Option(
            help="Scenario; may be repeated. Default: Table 1, demo and five.",
            autocompletion=options.shipped(SCENARIOS),
        ),
    ] = None,
    pursuers: Annotated[
        list[str] | None, typer.Option(help="Pursuers' strategy; may be repeated. Default: all.")
    ] = None,
    evader: Annotated[
        list[str] | None, typer.Option(help="Evader's strategy; may be repeated. Default: all.")
    ] = None,
    classic: Annotated[
        bool,
        typer.Option("--classic", help="The classical problems that it can play, instead."),
    ] = False,
    games: Annotated[int, options.value(Flights, "--games", words="Games of each kind.", unit="N")] = 20,
    key: Annotated[Path | None, typer.Option(help="File of a key that hides the seeds.")] = None,
    out: Annotated[Path, typer.Option(help="Folder of the leaderboard.")] = Path("runs/bench"),
    workers: Annotated[
        int | None, options.value(Count, "--workers", words="Processes [one a core].", unit="N")
    ] = None,
) -> None:
    """Rank every strategy, plug-ins too: each side's against each of the other's, one page of HTML."""
    from sim_bridge.programs.leaderboard import command as room
    from sim_bridge.programs.leaderboard.page import text

    strategies = tuple(evader or ()), tuple(pursuers or ())
    if classic:
        if scenario:
            raise ConfigError("--classic: found with --scenario, expected one of the two")
        scenario = room.classic_scenarios()
    told = room.Options(tuple(scenario or ()), *strategies, games, key, workers, out)
    made = room.bench(told, lambda line: typer.echo(f"sim-bridge: {line}", err=True))
    print(text(made.board))
    print(f"\n{made.page} (open it in a browser), {made.data.name}")


@app.command(
    epilog="Examples: sim-bridge classic | sim-bridge classic two-cutters --starts 5"
    " | sim-bridge classic convex-target --strategy goalkeeper --strategy evasive --json"
    " | sim-bridge classic half-space --picture half-space.svg",
)
def classic(
    name: Annotated[
        str,
        typer.Argument(
            help="Problem; none: all of them with their values.",
            metavar="NAME",
            autocompletion=options.shipped(CLASSIC),
        ),
    ] = "",
    file: Annotated[
        Path | None, typer.Option(help="Scenario of one's own in place of the problem's (classic/NAME).")
    ] = None,
    strategy: Annotated[
        list[str] | None, typer.Option(help="Strategy of either side; may be repeated. Default: several.")
    ] = None,
    starts: Annotated[
        int, options.value(Flights, "--starts", words="Games: the file's start and others near it.", unit="N")
    ] = 20,
    seed: Annotated[int, options.value(Seed, "--seed", words="Seed of the other starts.", unit="N")] = 1,
    feints: Annotated[
        bool,
        typer.Option("--feints", help="Opponents also begin aside of optimal play."),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="One JSON object a line, nothing else.")] = False,
    picture: Annotated[Path | None, typer.Option(help="Draw the problem (PNG, SVG or PDF).")] = None,
) -> None:
    """Play classical problems with known values: the value, what strategies reach of it, and why not all."""
    from sim_bridge.programs.classic import command as room

    own = None if file is None else shipped_file(file, SCENARIOS)
    chosen = room.Options(own, tuple(strategy or ()), starts, seed, feints, json, picture)
    if not name:
        room.refuse_without_problem(chosen)
    print(room.classic(name, chosen) if name else room.listed(json))


scenario_app = options.group(
    "Make and check scenario files.",
    no_args_is_help=True,
    epilog="Examples: sim-bridge scenario new mine.toml | sim-bridge scenario check mine.toml",
)
app.add_typer(scenario_app, name="scenario")


@scenario_app.command("new", epilog="Example: sim-bridge scenario new mine.toml")
def scenario_new(
    file: Annotated[Path, typer.Argument(help="File to write; it must not exist.")],
) -> None:
    """Write a commented template of a scenario."""
    from sim_bridge.programs.scenario_tools import new

    print(new(file))


@scenario_app.command(
    "check",
    epilog="Examples: sim-bridge scenario check mine.toml | sim-bridge scenario check demo --figures out",
)
def scenario_check(
    scenario: ScenarioArgument,
    figures: Annotated[
        Path | None, typer.Option(help="Folder for a picture of the start and the evader's band.")
    ] = None,
) -> None:
    """Check a scenario; print turn radii, free cones, the evader's band and the expected duration."""
    from onboard.game.scenario import load
    from sim_bridge.programs.fly import demand_strategies
    from sim_bridge.programs.scenario_tools import check, singly

    file = shipped_file(scenario, SCENARIOS)
    found = load(file, several=True)
    demand_strategies(found, str(file))
    print(check(found))
    if figures is not None:
        from sim_bridge.programs.scenario_picture import draw_band

        for one, stem in singly(found, file.stem):
            for path in draw_band(one, figures, stem):
                print(f"drawn: {path}")


@scenario_app.command(
    "stage",
    epilog="Examples: sim-bridge scenario stage spatial/six ring.toml"
    " | sim-bridge scenario stage mine.toml ring.toml --seconds 60",
)
def scenario_stage(
    scenario: ScenarioArgument,
    file: Annotated[Path, typer.Argument(help="File to write; it must not exist.")],
    seconds: Annotated[
        float | None,
        options.value(
            PositiveDuration, "--seconds", words="Time to get there; none: as long as it takes.", unit="S"
        ),
    ] = None,
    nearest: Annotated[
        float | None,
        options.value(
            PositiveDistance,
            "--nearest",
            words="No nearer to the evader [10 rho; 17 rho in space].",
            unit="M",
        ),
    ] = None,
) -> None:
    """Write the scenario with its pursuers on a ring that closes the evader's band, or say why none does."""
    from sim_bridge.programs.scenario_band import stage_file

    print(stage_file(shipped_file(scenario, SCENARIOS), file, seconds, nearest))


@app.command(epilog="Examples: sim-bridge design | sim-bridge design coordinated --figures out")
def design(
    aircraft: Annotated[
        Path,
        typer.Argument(
            help="Aircraft file, or the name of a shipped one.", autocompletion=options.shipped(AIRCRAFT)
        ),
    ] = Path("nose"),
    figures: Annotated[Path | None, typer.Option(help="Folder for Bode and step plots.")] = None,
) -> None:
    """Print margins, bandwidth and step-response figures of the configured aircraft's loops."""
    from sim_bridge.studies.design import design as report_on

    print(report_on(shipped_file(aircraft, AIRCRAFT), figures))


@app.command(
    epilog="Examples: sim-bridge predict | sim-bridge predict track.csv --figures out"
    " | sim-bridge predict one-on-one",
)
def predict(
    source: Annotated[
        Path | None,
        typer.Argument(
            help="Track (CSV), or scenario; none: the example of 3.5.2 and a weave.",
            autocompletion=options.shipped(SCENARIOS),
        ),
    ] = None,
    figures: Annotated[Path | None, typer.Option(help="Folder for figures.")] = None,
    json: Annotated[bool, typer.Option("--json", help="JSON lines in place of tables.")] = False,
    seed: Annotated[int, options.value(Seed, "--seed", words="Seed of training and noise.", unit="N")] = 1,
    printed: Annotated[
        bool, typer.Option("--printed", help="Train the example by the printed rule (27)-(28).")
    ] = False,
    epochs: Annotated[
        int | None,
        options.value(Epochs, "--epochs", words="Epochs of the example's training [1000].", unit="N"),
    ] = None,
) -> None:
    """Compare predictors on a recorded or simulated track: a table and a figure."""
    from sim_bridge.studies.predict import predict as run_predict

    if source is not None and (printed or epochs is not None):
        name = "--printed" if printed else "--epochs"
        raise ConfigError(f"{name}: found with {source}, expected only with the example, without a file")
    source = None if source is None else shipped_file(source, SCENARIOS)
    run_predict(source, figures, json, seed, printed, epochs or 1000)


def main() -> None:
    """Run the command line `sim-bridge`."""
    run(app, "sim-bridge")


if __name__ == "__main__":
    main()
