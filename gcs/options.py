"""The options that several subcommands of `gcs` share, taken before or after the subcommand's name."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import msgspec
import typer

from gcs import settings
from gcs.settings import Settings
from onboard.config.strict import ConfigError


class Options(NamedTuple):
    """The shared options as the user gave them; None where one was not given."""

    config: Path | None = None
    game: str | None = None
    bus: str | None = None
    zenoh: Path | None = None
    operator: str | None = None
    runs: Path | None = None
    record: bool | None = None
    plain: bool | None = None
    page: bool | None = None

    def settings(self, **page: object) -> Settings:
        """The settings of the file (or the defaults) with the options over them; `page`: of the page, None =
        not given. Raises ConfigError."""
        found = settings.load(self.config)
        bus = {"endpoint": self.bus, "zenoh": None if self.zenoh is None else str(self.zenoh)}
        recording = {"folder": None if self.runs is None else str(self.runs), "enabled": self.record}
        found = msgspec.structs.replace(
            found,
            bus=msgspec.structs.replace(found.bus, **_given(bus)),
            recording=msgspec.structs.replace(found.recording, **_given(recording)),
            page=msgspec.structs.replace(found.page, **_given({"enabled": self.page} | page)),
            **_given({"game": self.game, "operator": self.operator}),
        )
        return settings.check(found, "options")

    def refuse(self, names: tuple[str, ...], where: str) -> None:
        """Raise ConfigError if one of these options was given, which `where` does not use."""
        for name in names:
            if getattr(self, name) is not None:
                raise ConfigError(f"--{name}: found with {where}, which does not use it")


DECLARED: dict[str, Any] = {
    "config": Annotated[Path | None, typer.Option("--config", help="Settings file: see configs/gcs.toml.")],
    "game": Annotated[str | None, typer.Option("--game", help="Name of the game on the bus.")],
    "bus": Annotated[str | None, typer.Option("--bus", help="Zenoh endpoint, e.g. tcp/192.168.1.10:7447.")],
    "zenoh": Annotated[Path | None, typer.Option("--zenoh", help="Zenoh configuration file (TLS and more).")],
    "operator": Annotated[str | None, typer.Option("--operator", help="Who signs the commands.")],
    "runs": Annotated[Path | None, typer.Option("--runs", help="Folder for recordings.")],
    "record": Annotated[bool | None, typer.Option("--record/--no-record", help="Record everything heard.")],
    "page": Annotated[bool | None, typer.Option("--page", help="Serve the page for browsers beside it.")],
    "plain": Annotated[bool | None, typer.Option("--plain", help="Lines in place of the console.")],
}
BUS = ("config", "game", "bus", "zenoh")
STATION = (*BUS, "operator", "runs", "record", "plain", "page")


def takes(*names: str) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Make a Typer command that also takes these shared options.

    The decorated function gets them all as its first argument, an `Options`. An option typed before the
    subcommand's name holds for the subcommand; typed again after the name, the later value counts. Raises
    ConfigError for an option typed before a subcommand that does not use it.
    """

    def decorate(function: Callable[..., int]) -> Callable[..., int]:
        def command(ctx: typer.Context, **values: Any) -> int:
            early: dict[str, Any] = ctx.find_object(dict) or {}
            for name in early:
                if name not in names:
                    path = ctx.command_path.partition(" ")[2]
                    raise ConfigError(f"--{name}: found before {path}, which does not use it")
            late = _given({name: values.pop(name) for name in names})
            if ctx.invoked_subcommand is not None:
                ctx.obj = late
                return 0
            return function(Options(**early | late), **values)

        own = list(inspect.signature(function, eval_str=True).parameters.values())[1:]
        keyword = inspect.Parameter.KEYWORD_ONLY
        context = inspect.Parameter("ctx", keyword, annotation=typer.Context)
        shared = [inspect.Parameter(n, keyword, default=None, annotation=DECLARED[n]) for n in names]
        everything = [context, *(p.replace(kind=keyword) for p in own), *shared]
        command.__signature__ = inspect.Signature(everything)  # type: ignore[attr-defined]
        command.__annotations__ = {p.name: p.annotation for p in everything}
        command.__doc__, command.__name__ = function.__doc__, function.__name__
        return command

    return decorate


def _given(values: dict[str, Any]) -> dict[str, Any]:
    """Those that are not None."""
    return {name: value for name, value in values.items() if value is not None}
