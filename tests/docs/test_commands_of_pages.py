"""Every command that a page prints is one that the programs take, options and all."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import gcs.cli
import onboard.cli
import sim_bridge.cli
from tests.support.paths import ROOT

APPLICATIONS = {"gcs": gcs.cli.app, "sim-bridge": sim_bridge.cli.app}
PAGES = sorted({ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").glob("*/README.md")})
PROGRAM = re.compile(r"(?:\S+/|[A-Z_]+=\S+ )*(gcs|sim-bridge|onboard-agent) (.+)")
ENDS = re.compile(r"\s(?:#|&|>|2>|\||;|&&)(?:\s|$|\d).*|…|\.\.\.|&$|\[\w+ \w+\]")


def commands(text: str) -> Iterator[tuple[str, bool]]:
    """The command lines of a page: those of its blocks, and (True) those in its words, which may be names."""
    for block in re.findall(r"^ *```(?:sh|bash)?\n(.*?)^ *```$", text, re.DOTALL | re.MULTILINE):
        yield from ((line.strip(), False) for line in block.replace("\\\n", " ").splitlines())
    prose = re.sub(r"^ *```.*?^ *```$", "", text, flags=re.DOTALL | re.MULTILINE)
    yield from ((" ".join(words.split()), True) for words in re.findall(r"`([^`]+)`", prose))


def taken(program: str, words: list[str]) -> None:
    """Have the program's own parser take the words; it raises for what it does not know."""
    if program == "onboard-agent":
        onboard.cli.parser().parse_args(words)
        return
    command: Any = typer.main.get_command(APPLICATIONS[program])
    context = command.make_context(program, words)
    while hasattr(command, "commands") and (rest := [*context._protected_args, *context.args]):
        name, command, rest = command.resolve_command(context, rest)
        context = command.make_context(name, rest, parent=context)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_pages_commands_are_taken_by_the_programs(page: Path) -> None:
    for line, named in commands(page.read_text(encoding="utf-8")):
        found = PROGRAM.fullmatch(line)
        if found is None:
            continue
        program, rest = found[1], ENDS.sub("", found[2])
        try:
            taken(program, shlex.split(rest))
        except (Exception, SystemExit) as error:
            if not (named and type(error).__name__ == "MissingParameter"):
                pytest.fail(f"{page.name}: {line}: {error!r}")


def test_a_word_that_no_program_knows_is_seen() -> None:
    with pytest.raises(Exception, match="No such option"):
        taken("sim-bridge", ["campaign", "five", "--shards", "1/2"])
    with pytest.raises(SystemExit):
        taken("onboard-agent", ["--idd", "2"])
