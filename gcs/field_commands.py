"""Commands of `gcs` for a field: tracks of opponents, take-off, signing keys."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gcs.options import Options, takes
from onboard.config.bounds import Pressure, SystemId, Undulation, WaitTime
from onboard.config.strict import ConfigError
from onboard.runtime.options import value
from onboard.runtime.resources import SCENARIOS, shipped_file

MapOption = Annotated[
    list[str] | None,
    typer.Option("--map", metavar="NUMBER=ID", help="A target of the source is this vehicle; repeatable."),
]


@takes("config", "game", "bus", "zenoh")
def tracks(
    options: Options,
    source: Annotated[str, typer.Argument(help="Link URL, sbs://HOST:PORT, http URL, or .csv, .json, .sbs.")],
    map_: MapOption = None,
    origin: Annotated[str, typer.Option("--origin", help="LAT,LON,ALT of the game frame [the game's].")] = "",
    qnh: Annotated[
        float | None,
        value(Pressure, "--qnh", words="Pressure at sea level [hPa], for barometric heights.", unit="HPA"),
    ] = None,
    geoid: Annotated[
        float | None,
        value(Undulation, "--geoid", words="Sea level above the ellipsoid [m], for GPS heights.", unit="M"),
    ] = None,
) -> int:
    """Feed tracks of opponents into a game from MAVLink telemetry, ADS-B receivers or files."""
    import asyncio

    from gcs.tracks import program
    from gcs.tracks.report import Corrections, mapping

    if not map_:
        raise ConfigError("--map: found none, expected NUMBER=ID, e.g. --map 4CA7B3=1")
    ids, place = mapping(tuple(map_)), program.origin_of(origin)
    wanted = program.Wanted(source, ids, place, Corrections(qnh, geoid))
    return asyncio.run(program.run(options.settings(), wanted))


@takes()
def sign(
    options: Options,
    link: Annotated[str, typer.Argument(help="Link to the autopilot: serial or USB to set a key.")],
    keys: Annotated[
        list[Path] | None, typer.Option("--keys", help="Key files or folders to compare with; repeatable.")
    ] = None,
    set_: Annotated[Path | None, typer.Option("--set", help="Key file to set on the autopilot.")] = None,
    system: Annotated[
        int | None, value(SystemId, "--system", words="System id, where several are heard.", unit="N")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Send the key over a network, readable.")] = False,
) -> int:
    """List which keys the autopilots on a link sign with; set one with --set, on the ground."""
    import asyncio

    from gcs import signing

    return asyncio.run(signing.sign(link, keys or [], set_, system or 0, yes))


@takes()
def take_off(
    options: Options,
    scenario: Annotated[Path, typer.Argument(help="Scenario file, or the name of one that comes along.")],
    link: Annotated[
        list[str] | None, typer.Option("--link", metavar="ID=URL", help="Where a vehicle is; repeatable.")
    ] = None,
    may_arm: Annotated[bool, typer.Option("--may-arm", help="Arm those that stand disarmed.")] = False,
    within: Annotated[
        float, value(WaitTime, "--within", words="Time for each vehicle [s].", unit="S")
    ] = 180.0,
) -> int:
    """Bring vehicles from the ground to their places in a scenario, one after the other."""
    import asyncio

    from gcs import takeoff
    from onboard.game.scenario import load

    if not link:
        raise ConfigError("--link: found none, expected ID=URL, e.g. --link 2=udpin://0.0.0.0:14551")
    links, played = takeoff.links_of(tuple(link)), load(shipped_file(scenario, SCENARIOS), several=True)
    return asyncio.run(takeoff.take_off(played, links, may_arm=may_arm, within_s=within))
