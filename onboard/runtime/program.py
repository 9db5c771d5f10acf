"""How our programs end: a user's mistake is one line on standard error and exit code 2."""

from __future__ import annotations

import os
import sys

import typer

from onboard.config.strict import ConfigError


def run(app: typer.Typer, name: str) -> None:
    """Run a program: ConfigError and wrong options become one line, ctrl-C exit code 130."""
    try:
        code = app(standalone_mode=False, prog_name=name)
    except ConfigError as error:
        _fail(name, str(error))
    except typer.TyperException as error:
        text = error.format_message()
        if text.startswith("Usage:"):  # no arguments at all: the help
            print(text, file=sys.stderr)
            sys.exit(2)
        _fail(name, f"{' '.join(text.split())} (see {name} --help)")
    except (KeyboardInterrupt, typer.Abort):
        sys.exit(130)
    except BrokenPipeError:  # `| head`: the reader has left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(141)
    else:
        sys.exit(code if isinstance(code, int) else 0)


def _fail(name: str, text: str) -> None:
    print(f"{name}: {text}", file=sys.stderr)
    sys.exit(2)
