"""What the command lines of `gcs` and `sim-bridge` share: typed values, `-h`, `--version`, completion.

(The agent's is argparse's: see `onboard.cli`.)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum
from functools import partial
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from onboard.config.option_value import parsed
from onboard.config.strict import ConfigError
from onboard.runtime.resources import Shelf, named_files


class _Coercion:
    """What turns an option's words into its type: typer's own, which imports pydantic (0.1 CPU-seconds), once
    there are words; typer asks it for options that nobody gave, too."""

    def __init__(self, param: Any) -> None:
        self._real = param.get_runtime_param

    def coerce(self, value: Any, param: Any, ctx: Any) -> Any:
        """The value in its type; None, or nothing of several, where none was given."""
        if value is None:
            return () if param.multiple or param.nargs == -1 else None
        return self._real().coerce(value, param=param, ctx=ctx)


def _itself(one: _Coercion) -> _Coercion:
    return one


def _coerce_late(command: Any, ctx: Any) -> None:
    """Give a command's options a _Coercion; once each, however often it is called."""
    for param in command.get_params(ctx):
        if "get_runtime_param" not in vars(param):
            param.get_runtime_param = partial(_itself, _Coercion(param))


class Command(TyperCommand):
    """A command that takes no empty value: see `demand_no_empty_value`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """As every command, once the values are looked at."""
        demand_no_empty_value(self, ctx, args)
        _coerce_late(self, ctx)
        return super().parse_args(ctx, args)


class Group(TyperGroup):
    """A group of commands that takes no empty value: see `demand_no_empty_value`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """As every group, once the values are looked at."""
        demand_no_empty_value(self, ctx, args)
        _coerce_late(self, ctx)
        return super().parse_args(ctx, args)


class _Application(typer.Typer):
    def command(self, *arguments: Any, **named: Any) -> Any:
        return super().command(*arguments, **{"cls": Command, **named})


def group(words: str, **more: Any) -> typer.Typer:
    """A group of commands, as all of this project's are; `words` is its help."""
    settings = {"help_option_names": ["-h", "--help"]}
    return _Application(help=words, context_settings=settings, pretty_exceptions_enable=False,
                        rich_markup_mode=None, **{"cls": Group, **more})  # fmt: skip


def demand_no_empty_value(command: Any, ctx: Any, args: list[str]) -> None:
    """Raise ConfigError for an option or argument that is given as an empty word.

    In a script it is a variable that nobody has set, and would count as an option that was not given.
    """
    if not any(word == "" or word.endswith("=") for word in args):
        return
    values, _rest, _order = command.make_parser(ctx).parse_args(args=list(args))
    for param in command.get_params(ctx):
        found = values.get(param.name)
        if found == "" or (isinstance(found, list | tuple) and "" in found):
            name = param.opts[0] if param.param_type_name == "option" else param.name.upper()
            raise ConfigError(f"{name}: found '', expected a value")


def value(kind: Any, *flags: str, words: str, unit: str = "") -> Any:
    """An option whose value has a type with a range, or is of an enum (`onboard.config.bounds`).

    `flags` are its names, none for an argument; `words` its help, `unit` what stands for the value there. A
    value out of range raises ConfigError.
    """
    name = flags[0] if flags else words.rstrip(".").lower()
    choices = [str(one.value) for one in kind] if isinstance(kind, type) and issubclass(kind, Enum) else []
    told = {
        "parser": lambda text: text if text is None else parsed(text, kind, name),
        "metavar": f"[{'|'.join(choices)}]" if choices else unit or "NUMBER",
        "help": words,
    }
    if choices:
        told["autocompletion"] = completing(choices)
    return typer.Option(*flags, **told) if flags else typer.Argument(**told)  # type: ignore[arg-type]


def shipped(shelf: Shelf) -> Callable[[str], list[str]]:
    """Completes the names of what comes with the distribution."""

    def complete(incomplete: str) -> list[str]:
        return completing(named_files(shelf))(incomplete)

    return complete


def completing(known: Iterable[str]) -> Callable[[str], list[str]]:
    """Completes one of the known words."""

    def complete(incomplete: str) -> list[str]:
        return [word for word in known if word.startswith(incomplete)]

    return complete


def _print_version(asked: bool) -> None:
    if asked:
        from onboard.config.version import version

        print(version())
        raise typer.Exit


VersionOption = Annotated[
    bool,
    typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit."),
]
