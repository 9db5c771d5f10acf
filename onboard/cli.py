"""`onboard-agent`: flies one vehicle; `onboard-agent check` tells beforehand whether it can.

With argparse, unlike the other programs: an agent stays in memory for a whole flight on a small
computer, and what a richer library imports (some 12 MB) would stay with it.
"""

from __future__ import annotations

from onboard.runtime import early

early.one_line_interrupts("onboard-agent", __name__)

from onboard.agent.lean import begin, lean

if early.program():
    begin()

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from onboard.runtime import program
from onboard.runtime.program import fail

NAME = "onboard-agent"
OPTIONS = ("id", "role", "link", "autopilot", "game", "bus", "zenoh", "strategy", "route", "take_control",
           "may_arm", "dry_run", "log", "events")  # fmt: skip


COMPLETES = "_ONBOARD_AGENT_COMPLETE"  # a shell asks what may follow
COMPLETION = ("--install-completion", "--show-completion")


class Parser(argparse.ArgumentParser):
    """One line for a mistake; what a value may be is said by its type, as in the configuration file."""

    def print_help(self, file: Any = None) -> None:
        """Print the help; unlike argparse, without silence where it cannot be written."""
        print(self.format_help(), end="", file=file)

    def error(self, message: str) -> NoReturn:
        """Print it and exit with code 2."""
        fail(NAME, f"{message} (see {self.prog} --help)")


def _common() -> Parser:
    common = Parser(add_help=False, argument_default=argparse.SUPPRESS)
    add = common.add_argument
    add("--config", metavar="FILE", help="TOML file; its template is configs/agent.toml")
    add("--id", type=_typed("SystemId", "--id"), metavar="N",
        help="the vehicle: MAVLink system id, and name on the bus [2]")  # fmt: skip
    add("--role", type=_typed("Role", "--role"), metavar="ROLE", help="evader, pursuer or tracker [pursuer]")
    add("--link", action="append", metavar="URL",
        help="udpin:HOST:PORT (listen), udpout:HOST:PORT (send), tcp:HOST:PORT (connect), "
        "tcpin:HOST:PORT (listen) or serial:/dev/NAME:BAUD; given twice, the second "
        "stands by [udpin://127.0.0.1:14539+id]")  # fmt: skip
    add("--autopilot", type=_typed("AdapterChoice", "--autopilot"), metavar="ADAPTER",
        help="which adapter flies it: auto, velocity, arduplane, arduplane-plain, px4-plane, "
        "px4-plane-course, mavsdk [auto: the one that fits its heartbeat]")  # fmt: skip
    add("--game", metavar="NAME", help="the game to join on the bus [game]")
    add("--bus", metavar="ENDPOINT", help="Zenoh endpoint [tcp/127.0.0.1:7447]")
    add("--zenoh", metavar="FILE", help="Zenoh configuration (JSON5): TLS, access control, routers")
    return common


def _lean() -> None:
    if early.program():  # who calls this module's functions keeps its own process whole
        lean()


def _typed(kind: str, name: str) -> Callable[[str], Any]:
    """Reads a value by a type of the agent's configuration, which is imported only where the option is typed.

    Gives what the configuration is written in: an enum's word, not the enum. Raises ConfigError.
    """

    def read(text: str) -> Any:
        _lean()  # before the first import of what it leaves out
        from onboard.agent import config
        from onboard.config.option_value import parsed

        found = parsed(text, getattr(config, kind), name)
        return getattr(found, "value", found)

    return read


def parser() -> Parser:
    """The command line."""
    common = _common()
    top = Parser(
        prog=NAME,
        parents=[common],
        description="Fly one vehicle of a pursuit-evasion game through its autopilot. Every setting has a "
        "default that works beside `sim-bridge serve` on the same machine.",
        epilog=f"Examples: {NAME} --role evader --id 1 --take-control | {NAME} --id 2 --dry-run | "
        f"{NAME} check --config /etc/apollonius/agent.toml | {NAME} --show-completion",
        allow_abbrev=False,
    )
    add = top.add_argument
    given = argparse.SUPPRESS
    add("--strategy", metavar="NAME", default=given, help="strategy by name [the setup's]")
    add("--route", metavar="FILE", default=given, help="route file of a tracker")
    add("--take-control", action=argparse.BooleanOptionalAction, default=given,
        help="enter GUIDED or OFFBOARD by itself [no]")  # fmt: skip
    add("--may-arm", action=argparse.BooleanOptionalAction, default=given,
        help="arm and take off for a ground start [no]")  # fmt: skip
    add("--dry-run", action="store_true", default=given,
        help="decide and publish, but send the autopilot nothing")  # fmt: skip
    add("--log", metavar="FILE", default=given, help="write every MAVLink frame to this .tlog file")
    add("--events", metavar="FILE", default=given,
        help="record everything that happens in this file, for gcs replay --decide")  # fmt: skip
    add("--timing", metavar="FILE", default=given, help=argparse.SUPPRESS)
    add("--version", action="store_true", help="print the version and exit")
    for option, words in zip(COMPLETION, ("install", "print"), strict=True):
        add(option, action="store_true", help=f"{words} the completion of this program for the current shell")
    commands = top.add_subparsers(dest="command", metavar="check", parser_class=Parser)
    check = commands.add_parser(
        "check",
        parents=[common],
        help="preflight: what is in order and what is not",
        description="Preflight: link, autopilot, rates, clock, parameters, bus, keys, disk. It commands "
        "nothing; exit code 1 if anything fails.",
        epilog=f"Examples: {NAME} check --id 2 | {NAME} check --config agent.toml --seconds 20",
        allow_abbrev=False,
    )
    check.add_argument(
        "--seconds", type=_typed("CheckTime", "--seconds"), default=8.0, metavar="S",
        help="how long to listen [8]")  # fmt: skip
    return top


def run(arguments: list[str] | None = None) -> int:
    """Run the command line; gives the exit code. Raises ConfigError for a mistake in a file or option."""
    typed = sys.argv[1:] if arguments is None else arguments
    if (typed[:1] and typed[0] in COMPLETION) or COMPLETES in os.environ:
        from onboard.agent.completion import complete

        return complete(parser(), NAME)
    given = vars(parser().parse_args(typed))
    if given["version"]:
        from onboard.config.version import version

        print(version())
        return 0
    _lean()
    file = Path(given["config"]) if "config" in given else None
    options: dict[str, Any] = {name: given[name] for name in OPTIONS if name in given}
    from onboard.agent import config

    settings = config.load(file, options)
    if given["command"] == "check":
        from onboard.agent import preflight

        return preflight.check(settings, given["seconds"])
    from onboard.agent import program as agent

    return agent.fly(settings, Path(given["timing"]) if "timing" in given else None)


def main() -> None:
    """Entry point of `onboard-agent`."""
    for library in ("OPENBLAS", "OMP", "MKL"):  # before NumPy: one thread is faster here, and deterministic
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    program.run(run, NAME)


if __name__ == "__main__":
    main()
