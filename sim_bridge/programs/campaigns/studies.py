"""`sim-bridge campaign study`: the committed comparisons of the paper's claims, a page of Markdown each."""

from __future__ import annotations

import os
import platform
import sys
from pathlib import Path
from typing import Annotated

import typer

from onboard.config.bounds import Count, Flights, Seed
from onboard.runtime.options import group, shipped, value
from onboard.runtime.progress import Progress, over, part
from onboard.runtime.resources import ROUTES, SCENARIOS, shipped_file
from onboard.runtime.run_folder import made

NAME = "sim-bridge campaign study"
app = group(
    "The comparisons of the paper's claims, a page of Markdown each.",
    no_args_is_help=True,
    epilog=f"Examples: {NAME} games --seeds 20 | {NAME} encircled",
)
SPATIAL = SCENARIOS.sought_first("spatial")
RESULTS = Path("runs/studies")
Out = Annotated[Path, typer.Option(help="Folder for the results.")]


def preface(title: str, command: str) -> str:
    """What a result was made with."""
    import numba
    import numpy

    return (
        f"# {title}\n\n`{command}` on {platform.machine()} ({os.cpu_count()} cores), Python"
        f" {platform.python_version()}, NumPy {numpy.__version__}, numba {numba.__version__}.\n"
    )


@app.command(epilog=f"Example: {NAME} tracking --seeds 10 --out /tmp/results")
def tracking(
    seeds: Annotated[int, value(Flights, "--seeds", words="Flights a way.", unit="N")] = 50,
    route: Annotated[
        Path, typer.Option(help="Route file, or the name of a shipped one.", autocompletion=shipped(ROUTES))
    ] = Path("twenty_km"),
    out: Out = RESULTS,
) -> None:
    """Strategy 1, Strategy 2, the intelligent module and straight flight along a timed route."""
    from onboard.game.route_file import load_route
    from onboard.game.scenario import WindSpec
    from sim_bridge.campaign.spatial_campaign import output
    from sim_bridge.campaign.tracking import compare, table

    made(out)
    flown = load_route(shipped_file(route, ROUTES))
    told = f"{flown.name} ({flown.description})" if flown.description else flown.name
    text = preface("Tracking a timed route", f"sim-bridge campaign study tracking --seeds {seeds}")
    text += (
        f"\nRoute {told}, mean wind 5 m/s from a direction drawn by the seed, gusts of 3 m/s rms;"
        f" {seeds} seeds, the same for every way. J = mean deviation / 10 m + mean |time error| / 1 s.\n"
    )
    with Progress("sim-bridge") as progress:
        say = progress.aside(print)
        for number, aircraft in enumerate(("nose", "coordinated", "slip")):
            tell = part(progress.show, number, 3)
            rows = compare(flown, aircraft, range(seeds), WindSpec(speed=5.0, gust_sigma=3.0), tell)
            text += f"\n## {aircraft}\n\n{table(rows)}\n"
            say(f"\n{aircraft}\n{table(rows)}")
    print(f"written: {output(out, 'tracking.md', text)}")


@app.command(epilog=f"Example: {NAME} games --seeds 20 --scenario five --out /tmp/results")
def games(
    seeds: Annotated[int, value(Count, "--seeds", words="Games a way and scenario.", unit="N")] = 200,
    scenario: Annotated[
        list[Path] | None,
        typer.Option(
            help="Scenario files or names; default: five and six pursuers.", autocompletion=shipped(SPATIAL)
        ),
    ] = None,
    figures: Annotated[Path | None, typer.Option(help="Folder for pictures of the first game.")] = None,
    out: Out = RESULTS,
) -> None:
    """The spatial game with the evader's strategy and flying straight, on the same seeds."""
    from onboard.game.scenario import load
    from sim_bridge.campaign.figures import draw_stages
    from sim_bridge.campaign.spatial_campaign import contest, output, play_seed, table
    from sim_bridge.campaign.spatial_draw import spatial
    from sim_bridge.campaign.spatial_game import Evasion

    made(out)
    names = ["five", "six"]
    files = [shipped_file(path, SPATIAL) for path in scenario or ()]
    scenarios = [load(path) for path in files] if files else [spatial(name) for name in names]
    if files:
        names = [path.stem for path in files]
    contests = []
    for name, one in zip(names, scenarios, strict=True):
        print(f"{one.name}: {seeds} seeds, both ways", file=sys.stderr)
        with Progress("sim-bridge") as progress:
            contests.append(contest(one, range(seeds), tell=progress.show))
        if figures is not None:
            for path in draw_stages(one, play_seed(one, 0, Evasion.STRATEGY), figures, f"spatial-{name}"):
                print(f"drawn: {path}")
    text = preface("The spatial game", f"sim-bridge campaign study games --seeds {seeds}")
    text += (
        "\nThe same seeds for both ways: a seed draws the pursuers' places about the scenario's, the"
        " direction of the mean wind, the gusts and the tracks' noise.\n\n" + table(contests) + "\n"
    )
    print(table(contests))
    print(f"written: {output(out, 'games.md', text)}")


@app.command(epilog=f"Example: {NAME} encircled --games 100 --out /tmp/results")
def encircled(
    games: Annotated[int, value(Count, "--games", words="Plane games of each kind.", unit="N")] = 400,
    seed: Annotated[int, value(Seed, "--seed", words="Seed of the places.", unit="N")] = 1,
    out: Out = RESULTS,
) -> None:
    """How often an encircled evader is captured (outcome 1 of 3.4.2 says: always)."""
    from sim_bridge.campaign import encircled as room
    from sim_bridge.campaign.spatial_campaign import output

    made(out)
    with Progress("sim-bridge") as progress:
        found = room.table(room.shares(games, seed, tell=progress.show))
    command = f"sim-bridge campaign study encircled --games {games} --seed {seed}"
    text = preface("Encircled, and then?", command)
    text += (
        f"\nPlane games at {room.PURSUER_SPEED:g} against {room.EVADER_SPEED:g} m/s, R = {room.R:g} m,"
        f" ρ = {room.RHO:g} m, pursuers {room.NEAR:g} to {room.FAR:g} m away, at most {room.HORIZON:g} s.\n\n"
    )
    print(found)
    print(f"written: {output(out, 'encircled.md', text + found + chr(10))}")


@app.command(epilog=f"Example: {NAME} flown --seeds 3 --scenario six --out /tmp/results")
def flown(
    seeds: Annotated[int, value(Count, "--seeds", words="Games a way, from seed 1.", unit="N")] = 10,
    scenario: Annotated[
        Path,
        typer.Option(help="Scenario file, or the name of a shipped one.", autocompletion=shipped(SPATIAL)),
    ] = Path("five"),
    runs: Annotated[Path, typer.Option(help="Folder for the run folders.")] = Path("runs/campaign"),
    out: Out = RESULTS,
) -> None:
    """Repeat seeds of the spatial game whole, with agents and MAVLink, by `sim-bridge fly --fast`."""
    from onboard.game.scenario import load
    from sim_bridge.campaign.sil_crosscheck import fly_game
    from sim_bridge.campaign.spatial_campaign import output, play_seed
    from sim_bridge.campaign.spatial_game import Evasion

    made(out)
    path = shipped_file(scenario, SPATIAL)
    one = load(path)
    lines = [
        "| seed | evader | flown: verdict | time [s] | smallest distance [m] | compiled: verdict | time [s] |"
        " smallest distance [m] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    progress = Progress("sim-bridge")
    for seed in over(range(1, seeds + 1), progress.show, "games flown"):
        for evasion in Evasion:
            game = fly_game(path, seed, evasion, runs)
            kernel = play_seed(one, seed, evasion)
            lines.append(
                f"| {seed} | {game.way} | {game.verdict} | {game.time:.1f} | {game.smallest:.0f} |"
                f" {kernel.verdict.name.lower()} | {kernel.time:.1f} | {kernel.smallest:.0f} |"
            )
            progress.aside(print)(lines[-1])
            text = preface("The spatial game, flown", f"sim-bridge campaign study flown --seeds {seeds}")
            output(out, "games-flown.md", text + f"\n{one.name}\n\n" + "\n".join(lines))
