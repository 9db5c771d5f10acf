"""`onboard-agent`: flies one vehicle; `onboard-agent check` tells beforehand whether it can."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any

import typer

from onboard.runtime.program import run

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Fly one vehicle of a pursuit-evasion game through its autopilot.",
)

Config = Annotated[Path | None, typer.Option(help="TOML file; its template is configs/agent.toml.")]
Id = Annotated[int | None, typer.Option(help="The vehicle: MAVLink system id, and name on the bus [2].")]
RoleOption = Annotated[str | None, typer.Option(help="evader, pursuer or tracker [pursuer].")]
LinkOption = Annotated[
    list[str] | None,
    typer.Option(help="udpin://HOST:PORT, udpout://HOST:PORT or serial:///dev/NAME:BAUD; twice: a second one "
                 "stands by [udpin://127.0.0.1:14539+id]."),
]  # fmt: skip
Autopilot = Annotated[
    str | None, typer.Option(help="auto, velocity, arduplane, arduplane-plain or mavsdk [auto].")
]
GameOption = Annotated[str | None, typer.Option(help="The game to join on the bus [game].")]
BusOption = Annotated[str | None, typer.Option(help="Zenoh endpoint [tcp/127.0.0.1:7447].")]
Zenoh = Annotated[Path | None, typer.Option(help="Zenoh configuration file (JSON5): TLS, routers.")]
Strategy = Annotated[str | None, typer.Option(help="Strategy by name [the setup's].")]
Route = Annotated[Path | None, typer.Option(help="Route file of a tracker.")]
TakeControl = Annotated[
    bool | None,
    typer.Option("--take-control/--no-take-control", help="Enter GUIDED or OFFBOARD by itself [no]."),
]
MayArm = Annotated[bool | None, typer.Option("--may-arm/--never-arm", help="Arm for a ground start [no].")]
DryRun = Annotated[
    bool | None, typer.Option("--dry-run", help="Decide and publish, but send the autopilot nothing.")
]
Log = Annotated[Path | None, typer.Option(help="Write every MAVLink frame to this .tlog file.")]
Timing = Annotated[Path | None, typer.Option(hidden=True, help="Latencies to this JSON file, at the end.")]


@app.callback(invoke_without_command=True)
def fly(
    context: typer.Context,
    config: Config = None,
    id: Id = None,
    role: RoleOption = None,
    link: LinkOption = None,
    autopilot: Autopilot = None,
    game: GameOption = None,
    bus: BusOption = None,
    zenoh: Zenoh = None,
    strategy: Strategy = None,
    route: Route = None,
    take_control: TakeControl = None,
    may_arm: MayArm = None,
    dry_run: DryRun = None,
    log: Log = None,
    timing: Timing = None,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Fly one vehicle. Every setting has a default that works beside `sim-bridge serve`."""
    if version:
        from onboard.agent.program import version as own_version

        print(own_version())
        return
    options = _options(
        id=id, role=role, link=link or None, autopilot=autopilot, game=game, bus=bus, zenoh=zenoh,
        strategy=strategy, route=route, take_control=take_control, may_arm=may_arm, dry_run=dry_run, log=log,
    )  # fmt: skip
    if context.invoked_subcommand is not None:
        context.obj = (config, options)
        return
    from onboard.agent.config import load
    from onboard.agent.program import fly as fly_agent

    raise typer.Exit(fly_agent(load(config, options), timing))


@app.command()
def check(
    context: typer.Context,
    config: Config = None,
    id: Id = None,
    role: RoleOption = None,
    link: LinkOption = None,
    autopilot: Autopilot = None,
    game: GameOption = None,
    bus: BusOption = None,
    zenoh: Zenoh = None,
    seconds: Annotated[float, typer.Option(help="How long to listen [s].")] = 8.0,
) -> None:
    """Preflight: link, autopilot, rates, clock, parameters, bus, keys, disk; exit code 1 if one fails."""
    outer_config, outer = context.obj
    options = outer | _options(
        id=id, role=role, link=link or None, autopilot=autopilot, game=game, bus=bus, zenoh=zenoh
    )
    from onboard.agent.config import load
    from onboard.agent.program import check as check_agent

    raise typer.Exit(check_agent(load(config or outer_config, options), seconds))


def _options(**given: Any) -> dict[str, Any]:
    return {
        name: str(value) if isinstance(value, Path) else value
        for name, value in given.items()
        if value is not None
    }


def main() -> None:
    """Entry point of `onboard-agent`."""
    for library in ("OPENBLAS", "OMP", "MKL"):  # before NumPy: one thread is faster here, and deterministic
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    run(app, "onboard-agent")


if __name__ == "__main__":
    main()
