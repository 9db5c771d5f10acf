"""Shell completion of the agent's command line, by Typer: imported only where a shell asks.

Typer completes its own command lines; this makes it one from argparse's.
"""

from __future__ import annotations

import argparse
import inspect
from enum import Enum
from typing import Annotated, Any

import typer

from onboard.agent import config
from onboard.runtime.options import completing
from onboard.wire.bus.messages import Role


def complete(parser: argparse.ArgumentParser, name: str) -> int:
    """Answer the shell, or print or install its script, as the command line asks; gives the exit code."""
    typer.main.get_command(_application(parser))(prog_name=name, standalone_mode=False)
    return 0


def _application(parser: argparse.ArgumentParser) -> typer.Typer:
    """A Typer application with the options and commands of `parser`, that does nothing."""
    app = typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False)
    app.callback(invoke_without_command=True)(_command(parser))
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for word, inner in action.choices.items():
                app.command(word)(_command(inner))
    return app


def _command(parser: argparse.ArgumentParser) -> Any:
    def nothing(**_: Any) -> None:
        return None

    parameters = []
    for action in parser._actions:
        flags = [one for one in action.option_strings if one.startswith("--")]
        if not flags or action.help is argparse.SUPPRESS or action.dest in RESERVED:
            continue
        alone = action.nargs == 0
        words = _words(action.dest)
        told: dict[str, Any] = {"help": action.help}
        if words:
            told["autocompletion"] = completing(words)
        typed = Annotated[bool if alone else str, typer.Option(*flags, **told)]  # type: ignore[valid-type]
        keyword = inspect.Parameter.KEYWORD_ONLY
        default = False if alone else ""
        parameters.append(inspect.Parameter(action.dest, keyword, default=default, annotation=typed))
    nothing.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    nothing.__annotations__ = {one.name: one.annotation for one in parameters}
    return nothing


RESERVED = ("help", "install_completion", "show_completion")  # Typer's own
CHOICES: dict[str, type[Enum]] = {"role": Role, "autopilot": config.AdapterChoice}


def _words(option: str) -> list[str]:
    return [str(one.value) for one in CHOICES.get(option, ())]
