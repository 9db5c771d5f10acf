"""`gcs`: the ground station's program. Imports are lazy: `gcs --help` and `gcs status` load no console."""

from __future__ import annotations

from onboard.runtime.early import one_line_interrupts

one_line_interrupts("gcs", __name__)

import os
import sys
from collections.abc import Coroutine
from functools import partial
from pathlib import Path
from typing import Annotated, Any

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import typer

from gcs import field_commands
from gcs.export.formats import Format
from gcs.options import BUS, STATION, Options, takes
from gcs.urgent import WITHIN_S, Abort, abort_of
from onboard.config.bounds import HttpPort, ListenTime, SystemId, WaitTime
from onboard.config.strict import ConfigError
from onboard.runtime.options import VersionOption, group, shipped, value
from onboard.runtime.program import run
from onboard.runtime.resources import SCENARIOS, shipped_file
from onboard.wire.bus.messages import CommandKind, Role

app = group(
    "The ground station: picture, console, commands, recording, replay, report.",
    epilog="Without a command: the console. Beside `sim-bridge serve SCENARIO` it needs no option."
    " Examples: gcs | gcs status --json | gcs command abort --all | gcs report runs/2026-…",
)
game_app = group(
    "Games with the ground station as their master.",
    no_args_is_help=True,
    epilog="Example: gcs game run one-on-one",
)
app.add_typer(game_app, name="game")
keys_app = group(
    "Keys of a field: who may do what on the bus.",
    no_args_is_help=True,
    epilog="Examples: gcs keys init roster.toml | gcs keys show roster-keys | gcs keys sheet roster-keys",
)
app.add_typer(keys_app, name="keys")

RunArgument = Annotated[Path, typer.Argument(help="Run folder, or a recording in it.")]


def _play(program: Coroutine[Any, Any, int]) -> int:
    """Run a program to its exit code; a ConfigError from within its tasks comes out as such."""
    import asyncio

    try:
        return asyncio.run(program)
    except* ConfigError as group:
        errors = group
    error: BaseException = errors
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    raise error


@app.callback(invoke_without_command=True)
@takes(*STATION)
def console(options: Options, version: VersionOption = False) -> int:
    """The ground station: picture, console, commands, recording, replay, report."""
    from gcs import programs

    found = options.settings()
    return _play(programs.watch(found, record=found.recording.enabled, plain=bool(options.plain)))


@app.command(epilog="Examples: gcs status | gcs status --json --wait 5")
@takes(*BUS)
def status(
    options: Options,
    json: Annotated[bool, typer.Option("--json", help="One JSON object.")] = False,
    wait: Annotated[
        float, value(ListenTime, "--wait", words="How long to listen first [s].", unit="S")
    ] = 1.5,
) -> int:
    """Print the picture once; exit 1 when nobody is heard."""
    from gcs import programs

    return _play(programs.status(options.settings(), json=json, wait_s=wait))


@app.command(
    epilog="Examples: gcs command start --all | gcs command hold 2 3 | gcs command abort --role pursuer"
)
@takes(*BUS, "operator")
def command(
    options: Options,
    kind: Annotated[CommandKind, value(CommandKind, words="What to do.")],
    ids: Annotated[list[int] | None, value(SystemId, words="Vehicles.", unit="IDS")] = None,
    everybody: Annotated[bool, typer.Option("--all", help="All that are heard or in the game.")] = False,
    role: Annotated[Role | None, value(Role, "--role", words="Every vehicle of a role.")] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Do not ask before return and land.")] = False,
    within: Annotated[float, value(WaitTime, "--within", words="How long to try [s].", unit="S")] = WITHIN_S,
) -> int:
    """Command vehicles; exit 0 only when every one of them has confirmed."""
    from gcs import shell_command

    given = [name for name, there in (("ids", ids), ("--all", everybody), ("--role", role)) if there]
    if len(given) != 1:
        raise ConfigError(f"whom: found {' and '.join(given) or 'nothing'}, expected ids, --all or --role")
    order = shell_command.Order(kind, tuple(ids or ()), role, within)
    return _play(shell_command.command(options.settings(), order, sure=yes))


@app.command(epilog="Example: gcs record --runs /data/runs")
@takes(*BUS, "runs")
def record(options: Options) -> int:
    """Record everything that is heard, without a console, until ctrl-C or SIGTERM."""
    from gcs import programs

    return _play(programs.watch(options.settings(), record=True, plain=True))


@app.command(
    epilog="Examples: gcs replay runs/2026-… | gcs replay runs/2026-… --plain"
    " | gcs replay runs/2026-… --decide"
)
@takes("config", "plain")
def replay(
    options: Options,
    run: RunArgument,
    decide: Annotated[
        bool, typer.Option("--decide", help="Run the strategies again; list where they decide otherwise.")
    ] = False,
    evader: Annotated[str, typer.Option("--evader", help="With --decide: this strategy for evaders.")] = "",
    pursuer: Annotated[str, typer.Option("--pursuer", help="With --decide: this one for pursuers.")] = "",
) -> int:
    """Show a recorded run in the console: pause, speed, seek, step (? shows the keys)."""
    from gcs import programs

    if (evader or pursuer) and not decide:
        raise ConfigError("--evader, --pursuer: found without --decide, expected with it")
    if decide:
        options.refuse(("config", "plain"), "replay --decide")
        return programs.decide_again(run, {Role.EVADER: evader, Role.PURSUER: pursuer})
    return programs.replay(run, options.settings().alerts, plain=bool(options.plain))


@app.command(epilog="Examples: gcs assess mine.toml | gcs assess spatial/ring-5 | gcs assess")
@takes(*BUS)
def assess(
    options: Options,
    scenario: Annotated[
        Path | None,
        typer.Argument(
            help="Scenario file or name; none: the game on the bus.", autocompletion=shipped(SCENARIOS)
        ),
    ] = None,
    wait: Annotated[
        float, value(ListenTime, "--wait", words="How long to listen to the bus [s].", unit="S")
    ] = 1.5,
) -> int:
    """Go or no-go: can this team win from here, how likely, and what would change it; exit 1 for a no-go."""
    from gcs import programs

    if scenario is not None:
        return programs.assess_file(shipped_file(scenario, SCENARIOS))
    return _play(programs.assess_bus(options.settings(), wait_s=wait))


@app.command(epilog="Examples: gcs report runs/2026-… | gcs report runs/2026-… --gif")
@takes("config")
def report(
    options: Options,
    run: RunArgument,
    gif: Annotated[
        bool, typer.Option("--gif", help="The scene as a GIF, too; a Chromium of this computer draws it.")
    ] = False,
) -> int:
    """Write the run's report: one page for any browser, without network, and pictures."""
    from gcs import programs

    return programs.report(run, options.settings().alerts, gif=gif)


@app.command(
    epilog="Examples: gcs export RUN | gcs export RUN --format kml --format czml"
    " | gcs export RUN --id 1 --to out",
)
@takes()
def export(
    options: Options,
    run: RunArgument,
    formats: Annotated[
        list[Format] | None, value(Format, "--format", words="May be repeated. Default: csv.")
    ] = None,
    to: Annotated[Path | None, typer.Option("--to", help="Folder [RUN/export].")] = None,
    ids: Annotated[
        list[int] | None, value(SystemId, "--id", words="A vehicle; may be repeated. Default: all.")
    ] = None,
) -> int:
    """Write states, setpoints, decisions, tracks and true motion for other programs; docs/run-folder.md."""
    from gcs import programs

    return programs.export(run, tuple(dict.fromkeys(formats or (Format.CSV,))), to, tuple(ids or ()))


@app.command(
    epilog="Examples: gcs page | gcs page --control | gcs page runs/2026-… | gcs page runs/2026-… runs/2026-…"
    " | gcs page --host 0.0.0.0 --config gcs.toml | gcs page --map field.mbtiles"
)
@takes(*BUS, "operator", "runs", "record")
def page(
    options: Options,
    recordings: Annotated[
        list[Path] | None, typer.Argument(metavar="[RUN [RUN]]", help="Recordings, in place of a live game.")
    ] = None,
    host: Annotated[str | None, typer.Option("--host", help="Address to listen at [127.0.0.1].")] = None,
    port: Annotated[
        int | None, value(HttpPort, "--port", words="Port to listen at; 0 = any [8765].", unit="PORT")
    ] = None,
    control: Annotated[
        bool | None, typer.Option("--control", help="Let who opens the address it prints command vehicles.")
    ] = None,
    map: Annotated[
        Path | None, typer.Option("--map", help="Your own map: MBTiles, PMTiles, or a folder z/x/y.png.")
    ] = None,
) -> int:
    """Serve the game as a page for any browser: 3-D scene, plan, tables, alerts, orders."""
    from gcs.page import program

    found = options.settings(host=host, port=port, control=control, map=map and str(map))
    if not recordings:
        return _play(program.live(found))
    options.refuse(("game", "bus", "zenoh", "operator", "runs", "record"), "a recording")
    if len(recordings) > 2:
        raise ConfigError(f"RUN: found {len(recordings)}, expected one, or two to see beside each other")
    return _play(program.replay(found, tuple(recordings)))


@app.command(epilog="Examples: gcs fence area.plan | gcs fence area.kml --scenario mine.toml")
@takes()
def fence(
    options: Options,
    file: Annotated[Path, typer.Argument(help="QGroundControl .plan, MAVProxy's fence file, or KML.")],
    scenario: Annotated[
        Path | None,
        typer.Option(
            "--scenario",
            help="Check it with this game, and print it in its frame.",
            autocompletion=shipped(SCENARIOS),
        ),
    ] = None,
) -> int:
    """Check a fence from another tool, and print it as a scenario has it."""
    from gcs.fence import show
    from onboard.game.scenario import load

    played = None if scenario is None else load(shipped_file(scenario, SCENARIOS), several=True)
    print("\n".join(show(file, played)))
    return 0


@app.command(epilog="Example: gcs compare runs/20261126T024249Z-demo runs/20261126T031500Z-demo")
@takes()
def compare(
    options: Options,
    first: RunArgument,
    second: Annotated[Path, typer.Argument(help="The run to compare it with.")],
) -> int:
    """Tell what two runs were played with, how they went and where they part."""
    from gcs import programs

    return programs.compare(first, second)


@game_app.command(
    "run", epilog="Examples: gcs game run one-on-one | gcs game run mine.toml --wait --config gcs.toml"
)
@takes(*STATION)
def game_run(
    options: Options,
    scenario: Annotated[
        Path,
        typer.Argument(
            help="Scenario file, or the name of a shipped one.", autocompletion=shipped(SCENARIOS)
        ),
    ],
    start: Annotated[
        bool, typer.Option("--start/--wait", help="Start when all are ready, or wait for `start all`.")
    ] = True,
    take_over: Annotated[
        str, typer.Option("--take-over", metavar="NAME", help="Lead on the running game of a silent master.")
    ] = "",
) -> int:
    """Stage, start, referee and end a game without the bridge; exit 0 when it has ended with a verdict."""
    from gcs import programs
    from onboard.game.scenario import load

    found, played = options.settings(), load(shipped_file(scenario, SCENARIOS), several=True)
    plain = bool(options.plain)
    return _play(programs.play(found, played, plain=plain, auto_start=start, takes_over=take_over))


@game_app.command("check", epilog="Example: gcs game check one-on-one")
@takes(*BUS)
def game_check(
    options: Options,
    scenario: Annotated[
        Path,
        typer.Argument(
            help="Scenario file, or the name of a shipped one.", autocompletion=shipped(SCENARIOS)
        ),
    ],
    wait: Annotated[
        float, value(ListenTime, "--wait", words="How long to listen first [s].", unit="S")
    ] = 3.0,
) -> int:
    """Whether many who hold, abort or return at once keep apart; exit 1 where two might meet."""
    from gcs import programs
    from onboard.game.scenario import load

    found, played = options.settings(), load(shipped_file(scenario, SCENARIOS), several=True)
    return _play(programs.check_crowd(found, played, wait))


app.command(
    epilog="Examples: gcs tracks udpin://0.0.0.0:14560 --map 7=1 | gcs tracks radar.csv --map radar-17=1"
    " | gcs tracks sbs://127.0.0.1:30003 --map 4CA7B3=1 --qnh 1021"
)(field_commands.tracks)
app.command(
    epilog="Example: gcs take-off one-on-one --link 1=udpin://0.0.0.0:14551 --link 2=udpin://0.0.0.0:14552"
    " --may-arm"
)(field_commands.take_off)
app.command(
    epilog="Examples: gcs sign serial:///dev/ttyACM0:115200 --keys roster-keys"
    " | gcs sign serial:///dev/ttyACM0:115200 --set roster-keys/vehicle-2/mavlink.key"
)(field_commands.sign)


@keys_app.command("init", epilog="Example: gcs keys init roster.toml")
def keys_init(
    roster: Annotated[Path, typer.Argument(help="Roster of the field: see configs/field/roster.toml.")],
    folder: Annotated[Path | None, typer.Option("--folder", help="Where to [beside it, NAME-keys].")] = None,
) -> int:
    """Make certificates, access rules and MAVLink keys; again after a change of the roster (revocation)."""
    from gcs.keys import program

    return program.init(roster, folder)


@keys_app.command("show", epilog="Example: gcs keys show roster-keys")
def keys_show(folder: Annotated[Path, typer.Argument(help="Folder of `gcs keys init`.")]) -> int:
    """List who has which certificate, and until when; exit 1 when one has ended."""
    from gcs.keys import program

    return program.show(folder)


@keys_app.command("sheet", epilog="Example: gcs keys sheet roster-keys")
def keys_sheet(folder: Annotated[Path, typer.Argument(help="Folder of `gcs keys init`.")]) -> int:
    """Print what to copy where, what to write into each configuration, and who may do what."""
    from gcs.keys import program

    return program.sheet(folder)


def main() -> None:
    """Run `gcs` and exit with its code."""
    urgent = abort_of(sys.argv[1:])
    run(app if urgent is None else partial(_abort, urgent), "gcs")


def _abort(order: Abort) -> int:
    """An abort, which does not wait until Typer has built its parser."""
    from gcs import shell_command

    meant = shell_command.Order(CommandKind.ABORT, order.ids, None, order.within_s)
    return _play(shell_command.command(order.options.settings(), meant, sure=True))


if __name__ == "__main__":
    main()
