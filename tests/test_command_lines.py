"""Every command line of the project, walked: typed values, help with examples, version, names, completion."""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import gcs.cli
import onboard.cli
import sim_bridge.cli
from onboard.config.bounds import Latitude, Seed, SystemId
from onboard.config.option_value import parsed
from onboard.config.strict import ConfigError
from onboard.runtime.resources import AIRCRAFT, SCENARIOS, configs, named_files, shipped_file
from onboard.wire.bus.messages import CommandKind
from tests.support.real_time import patience

APPLICATIONS = {"gcs": gcs.cli.app, "sim-bridge": sim_bridge.cli.app}
MODULES = {"gcs": "gcs.cli", "sim-bridge": "sim_bridge.cli", "onboard-agent": "onboard.cli"}
ROOT = Path(__file__).parent.parent


def walk(path: str, command: Any) -> Iterator[tuple[str, Any]]:
    """Every command and group below one, with the words that lead to it."""
    yield path, command
    for word, inner in getattr(command, "commands", {}).items():
        yield from walk(f"{path} {word}", inner)


COMMANDS = [pair for name, app in APPLICATIONS.items() for pair in walk(name, typer.main.get_command(app))]
EVERY = pytest.mark.parametrize(("path", "command"), COMMANDS, ids=[path for path, _ in COMMANDS])


def agent_parsers() -> list[argparse.ArgumentParser]:
    top = onboard.cli.parser()
    inner = [a for a in top._actions if isinstance(a, argparse._SubParsersAction)]
    return [top, *(parser for action in inner for parser in action.choices.values())]


def run(program: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", MODULES[program], *arguments]
    env = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    return subprocess.run(
        command, capture_output=True, text=True, timeout=patience(20.0), env=env, check=False
    )


@EVERY
def test_every_command_has_examples_that_its_own_parser_takes(path: str, command: Any) -> None:
    told = " ".join((command.epilog or "").split())
    assert "Example" in told, f"{path} --help shows no example"
    examples = told.partition("Examples:" if "Examples:" in told else "Example:")[2].split(" | ")
    name = next(one for one in APPLICATIONS if path.startswith(one))
    for example in (one.partition(", and then")[0].strip() for one in examples):
        assert example.startswith(path), f"{example}: an example of {path}"
        found, words = typer.main.get_command(APPLICATIONS[name]), shlex.split(example[len(name) :])
        while words and words[0] in getattr(found, "commands", {}):
            found, words = found.commands[words[0]], words[1:]
        found.make_context(example, words)


@EVERY
def test_h_is_help_everywhere(path: str, command: Any) -> None:
    assert command.context_settings.get("help_option_names") == ["-h", "--help"] or " " in path
    with pytest.raises(typer.Exit), command.make_context("x", ["-h"], **INHERITED):
        pass


INHERITED = {"help_option_names": ["-h", "--help"]}  # a subcommand has them of its group


@EVERY
def test_no_number_and_no_choice_is_read_without_its_range(path: str, command: Any) -> None:
    """A bare `int`, `float` or enum of Typer's has no range of ours, and its words are a library's."""
    for parameter in command.params:
        read = parameter.type_descriptor
        if str(read.annotation) not in READ_AS_THEY_ARE:
            assert read.parameter_info.parser is not None, f"{path}: {parameter.name}: {read.annotation}"


READ_AS_THEY_ARE = {str(kind) for kind in (str, bool, Path, list[str], list[Path])}


def test_the_agents_numbers_and_choices_have_their_ranges_too() -> None:
    for parser in agent_parsers():
        assert "Example" in (parser.epilog or ""), parser.prog
        for action in parser._actions:
            assert action.choices is None or action.dest == "command", action.dest
            assert action.type not in (int, float), action.dest


@pytest.mark.parametrize("program", MODULES)
def test_every_program_tells_its_version(program: str) -> None:
    told = run(program, "--version")
    assert (told.returncode, told.stderr) == (0, "")
    assert told.stdout.strip()[0].isdigit()


@pytest.mark.parametrize(
    ("text", "kind", "said"),
    [
        ("-5", Seed, "--x: found -5, expected a whole number from 0 to 2^63 − 1"),
        ("9" * 5000, Seed, "…, expected a whole number from 0"),
        ("9" * 30, Seed, f"--x: found {'9' * 30}, expected a whole number from 0"),
        ("1.5", Seed, "--x: found '1.5', expected a whole number"),
        ("", Seed, "--x: found '', expected a whole number"),
        ("nan", Latitude, "--x: found nan, expected a finite number"),
        ("1e999", Latitude, "--x: found inf, expected a finite number"),
        ("251", SystemId, "--x: found 251, expected a MAVLink system id"),
        (
            "Hodl",
            CommandKind,
            "expected one of: start, hold, resume, return, land, abort; did you mean 'hold",
        ),
        ("zzz", CommandKind, "expected one of: start, hold, resume, return, land, abort"),
    ],
)
def test_a_typed_value_out_of_range_is_told_as_in_a_file(text: str, kind: Any, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        parsed(text, kind, "--x")
    assert said in str(error.value)
    assert len(str(error.value)) < 300


def test_a_shipped_file_is_found_by_each_of_its_names_and_never_by_a_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for shelf in (SCENARIOS, AIRCRAFT):
        for name, path in named_files(shelf).items():
            assert shipped_file(Path(name), shelf) == path
            assert shipped_file(Path(f"{name}.toml"), shelf) == path
    table = configs() / "scenarios" / "table1" / "row03.toml"
    assert shipped_file(Path("row03"), SCENARIOS.sought_first("table1")) == table
    assert shipped_file(Path("table1/row03"), SCENARIOS) == table
    (tmp_path / "demo").mkdir()  # a folder of runs may have a scenario's name
    assert shipped_file(Path("demo"), SCENARIOS).name == "demo.toml"
    mine = tmp_path / "one-on-one"
    mine.write_text("x")
    assert shipped_file(Path("one-on-one"), SCENARIOS) == Path("one-on-one")
    for wrong, said in (
        (tmp_path, "is a directory"),
        (Path("one-on-on"), "did you mean 'one-on-one'?"),
        (Path("one-on-on.toml"), "no such file or directory; did you mean 'one-on-one'?"),
        (Path("../table1/row01"), "no such file"),
    ):
        with pytest.raises(ConfigError, match=said.replace("?", r"\?")):
            shipped_file(wrong, SCENARIOS)


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("sim-bridge planar one-on-one --horizon 1", "one on one"),
        ("sim-bridge scenario check table1/row03", "table 1, row 3"),
        ("sim-bridge list autopilots", "px4-plane"),
    ],
)
def test_commands_take_the_names_of_what_is_shipped(command: str, said: str) -> None:
    program, *arguments = command.split()
    told = run(program, *arguments)
    assert told.returncode == 0, told.stderr
    assert said in told.stdout


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("sim-bridge fly --fast one-on-one --bus tcp/127.0.0.1:9", "--bus: found with --fast"),
        ("sim-bridge predict one-on-one --epochs 5", "--epochs: found with one-on-one, expected only"),
        ("sim-bridge predict one-on-one --printed", "--printed: found with one-on-one, expected only"),
        # What a script's variable that nobody has set leaves of an option.
        ("sim-bridge campaign row01 --shard=", "--shard: found '', expected a value"),
        ("sim-bridge campaign run row01 --shard ''", "--shard: found '', expected a value"),
        ("sim-bridge campaign row01 --dask ''", "--dask: found '', expected a value"),
        ("sim-bridge bench --evader paper --evader '' --games 2", "--evader: found '', expected a value"),
        ("sim-bridge campaign show ''", "FOLDER: found '', expected a value"),
        ("gcs --bus '' status", "--bus: found '', expected a value"),
        ("gcs game run one-on-one --take-over ''", "--take-over: found '', expected a value"),
    ],
)
def test_an_option_that_would_do_nothing_is_refused(command: str, said: str) -> None:
    program, *arguments = shlex.split(command)
    told = run(program, *arguments)
    assert (told.returncode, told.stdout, told.stderr.count("\n")) == (2, "", 1)
    assert said in told.stderr


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("gcs command ho", ["hold"]),
        ("sim-bridge fly one", ["one-on-one"]),
        ("sim-bridge campaign one", ["one-on-one"]),
        ("sim-bridge campaign five six --shard-g", ["--shard-games"]),
        ("onboard-agent --role pu", ["pursuer"]),
    ],
)
def test_a_shell_completes_commands_options_and_names(line: str, words: list[str]) -> None:
    program = line.split()[0]
    variable = f"_{program.replace('-', '_').upper()}_COMPLETE"
    asked = {variable: "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
    told = run(program, **asked)
    assert told.stdout.split() == words, told.stderr
