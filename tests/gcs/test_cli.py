"""`gcs` from a shell: real processes, Zenoh on loopback."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
from contextlib import asynccontextmanager
from pathlib import Path

import msgspec
import pytest
import typer

from gcs import cli, options, settings, urgent
from gcs.console.plain_lines import PlainLines
from gcs.picture.json_document import document
from gcs.picture.thresholds import Thresholds
from onboard.config import strict as config
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.resources import configs
from onboard.wire.bus import topics
from onboard.wire.bus.messages import CommandKind, Phase
from tests.support.answering_agents import AnsweringAgent
from tests.support.real_time import patience
from tests.support.sample_messages import GAME, START_NS, Tower, on_bus, phase, setup

ROOT = Path(cli.__file__).parent.parent


def gcs(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the program to its end."""
    return subprocess.run(
        [sys.executable, "-m", "gcs.cli", *arguments],
        capture_output=True, text=True, timeout=patience(20.0), cwd=cwd, env=environment(), check=False,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--config", "nowhere.toml", "--plain"), "nowhere.toml: no such file or directory"),
        (("--config", "wrong.toml", "--plain"), "wrong.toml: alerts.battery_lo: unknown key"),
        (("--config", "order.toml", "--plain"), "order.toml: alerts.battery_critical: found 0.5, expected"),
        (("--game", "a/b", "--plain"), "options: game: found 'a/b', expected a name without"),
        (("--bus", "nonsense", "--plain"), "bus: "),
        (("--bus", "tcp/127.0.0.1:99999", "status"), "bus: found 'tcp/127.0.0.1:99999', expected a host and"),
        (("--bus", "tcp/:7447", "status"), "bus: found 'tcp/:7447', expected a host and a port up to 65535"),
        ((), "the console needs a terminal: found standard input, output, error redirected; without"),
        (("command", "abort"), "whom: found nothing, expected ids, --all or --role"),
        (("command", "abort", "2", "--all"), "whom: found ids and --all, expected"),
        (("command", "hold", "--all", "--within", "0"), "--within: found 0, expected"),
        (("command", "jump", "--all"), "what to do: found 'jump', expected one of: start, hold"),
        (("status", "--wait", "-1"), "--wait: found -1, expected"),
        (("game", "run", "nowhere.toml", "--plain"), "nowhere.toml: no such file or directory"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(tmp_path, arguments, message):
    (tmp_path / "wrong.toml").write_text("[alerts]\nbattery_lo = 0.3\n")
    (tmp_path / "order.toml").write_text("[alerts]\nbattery_critical = 0.5\n")
    done = gcs(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert done.stderr.startswith("gcs: ")
    assert message in done.stderr
    assert not (tmp_path / "runs").exists()


def test_the_help_loads_no_console_no_recorder_and_no_bus():
    done = subprocess.run(
        [sys.executable, "-c", "import gcs.cli, sys; print(sorted(sys.modules))"],
        capture_output=True, text=True, timeout=patience(20.0), env=environment(), check=True,
    )  # fmt: skip
    for heavy in ("textual", "rich.console", "mcap", "plotly", "matplotlib", "zenoh", "scipy", "numba"):
        assert f"'{heavy}'" not in done.stdout


def test_the_settings_file_that_comes_along_holds_every_key_with_its_default():
    path = configs() / "gcs.toml"
    assert config.read(path, settings.Settings) == settings.Settings()
    text = path.read_text()
    for part in (settings.Settings, settings.BusSettings, settings.RecordingSettings, Thresholds):
        for key in part.__struct_fields__:
            assert f"{key} = " in text or f"[{key}]" in text


def test_nobody_there_is_said_with_exit_code_1(free_endpoint):
    done = gcs("status", "--bus", free_endpoint, "--wait", "0.1")
    assert done.returncode == 1
    assert f"waiting for a bus at {free_endpoint} (nobody answers there)" in done.stderr
    done = gcs("command", "abort", "--all", "--bus", free_endpoint, "--within", "0.5")
    assert done.returncode == 1
    assert "nobody to command" in done.stderr


@pytest.fixture
def free_endpoint() -> str:
    """A place for a bus that nobody has taken."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    return f"tcp/127.0.0.1:{port}"


@asynccontextmanager
async def field(endpoint: str, count: int = 3, deaf: int = 0, silent: bool = False):
    """`count` vehicles on a bus that listens, and `deaf` more in the game that are not there.

    `silent`: nobody says a word, and no game is set up.
    """
    bus = await open_zenoh(endpoint, listen=True)
    clock = RealClock()
    crews = [AnsweringAgent(bus, clock, i) for i in range(1, count + 1)]
    if not silent:
        bus.publish(*on_bus(setup(count + deaf)), topics.SETUP.delivery)
        bus.publish(*on_bus(phase(Phase.STAGING)), topics.PHASE.delivery)

    async def speak() -> None:
        while not silent:
            for crew in crews:
                crew.speak()
            await asyncio.sleep(0.1)

    task = asyncio.create_task(speak())
    try:
        yield crews
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        await bus.close()


async def shell(*arguments: str, endpoint: str) -> tuple[int, str, str]:
    """Run the program beside a bus; exit code, output, errors."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "gcs.cli", *arguments, "--bus", endpoint, "--game", GAME,
        stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
        env=environment(),
    )  # fmt: skip
    async with asyncio.timeout(patience(20.0)):
        out, err = await process.communicate()
    assert process.returncode is not None
    return process.returncode, out.decode(), err.decode()


@pytest.mark.real
async def test_status_prints_the_picture_once_as_json(free_endpoint):
    async with field(free_endpoint):
        code, out, err = await shell("status", "--json", endpoint=free_endpoint)
    assert (code, err) == (0, "")
    picture = json.loads(out)
    assert picture["format"] == 3
    assert [v["id"] for v in picture["vehicles"]] == [1, 2, 3]
    assert picture["vehicles"][1]["presence"] == "present"
    assert picture["vehicles"][1]["state"]["mode"] == "GUIDED"
    assert picture["game"]["setup"]["scenario"] == "meeting"
    assert picture["game"]["phase"] == "staging"
    assert picture["game"]["setup"]["rules"]["lambda"] == setup(3).rules.lambda_


@pytest.mark.real
async def test_abort_from_a_shell_ends_with_0_only_when_every_vehicle_has_confirmed(free_endpoint):
    async with field(free_endpoint) as crews:
        code, out, _ = await shell("command", "abort", "--all", endpoint=free_endpoint)
        assert code == 0
        assert out.startswith("abort: 3 of 3 confirmed")
        assert out.count("LOITER") == 3
        assert all([c.kind for c in crew.obeyed] == [CommandKind.ABORT] for crew in crews)


@pytest.mark.real
async def test_an_abort_of_everybody_is_called_out_before_anything_is_heard(free_endpoint):
    async with field(free_endpoint, silent=True) as crews:
        code, out, _ = await shell("command", "abort", "--all", endpoint=free_endpoint)
        assert (code, out.splitlines()[0]) == (0, "abort: 3 of 3 confirmed")
        assert all(len(crew.obeyed) == 1 for crew in crews)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("command abort --all", ({}, (), 10.0)),
        ("--bus tcp/h:1 command --game=g abort 3 12 --within 2.5",
         ({"bus": "tcp/h:1", "game": "g"}, (3, 12), 2.5)),
        ("--zenoh k/z.json5 command abort --all --yes --operator anna --bus a --bus b",
         ({"zenoh": Path("k/z.json5"), "operator": "anna", "bus": "b"}, (), 10.0)),
        ("command abort --all 3", None),  # what is not plain is left to Typer, which tells the mistake
        ("command abort", None),
        ("--all command abort", None),
        ("command abort --all --within 0", None),
        ("command abort --all --within x", None),
        ("command abort --all --bus", None),
        ("command abort --role evader", None),
        ("command abort --all --plain", None),
        ("command abort ²", None),
        ("command abort 251", None),
        ("command hold --all", None),
        ("command abort --help", None),
    ],
)  # fmt: skip
def test_a_plain_abort_is_read_without_typer(line, expected):
    found = urgent.abort_of(line.split())
    assert found == (None if expected is None else (options.Options(**expected[0]), *expected[1:]))


@pytest.mark.parametrize("name", urgent.SHARED)
def test_an_abort_read_without_typer_takes_the_options_that_the_command_takes(name):
    command = typer.main.get_command(cli.app).commands["command"]
    declared = {option for parameter in command.params for option in parameter.opts}
    assert name in declared
    assert declared - set(urgent.SHARED) == {"kind", "ids", "--all", "--role", "--yes", "--within"}


FIRST_REQUEST = """
import sys
from onboard.runtime.zenoh_session import ZenohBus
asked = ZenohBus.request
def request(bus, key, payload, timeout_s):
    print(key, *sorted({name.partition(".")[0] for name in sys.modules}
          | {name for name in sys.modules if name.startswith("gcs.")}), file=sys.stderr)
    ZenohBus.request = asked
    return asked(bus, key, payload, timeout_s)
ZenohBus.request = request
from gcs.cli import main
main()
"""
HEAVY = {
    *("numpy", "numba", "textual", "rich", "mcap", "pymavlink", "cryptography", "scipy", "email", "pydantic"),
    *("gcs.programs", "gcs.recording", "gcs.console.app", "gcs.replay", "gcs.report", "gcs.keys"),
}


@pytest.mark.real
async def test_an_abort_calls_everybody_first_and_imports_nothing_large_before(free_endpoint):
    async with field(free_endpoint):
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-c", FIRST_REQUEST, "command", "abort", "--all", "--bus", free_endpoint,
            "--game", GAME, stderr=asyncio.subprocess.PIPE, env=environment(),
        )  # fmt: skip
        async with asyncio.timeout(patience(20.0)):
            _, err = await process.communicate()
    key, *loaded = err.decode().split()
    assert key == topics.COMMAND.key(GAME)
    assert "gcs.shell_command" in loaded
    assert HEAVY & set(loaded) == set()


@pytest.mark.real
async def test_who_does_not_confirm_is_named_and_the_exit_code_is_1(free_endpoint):
    async with field(free_endpoint, count=2, deaf=1):
        code, out, _ = await shell("command", "abort", "--all", "--within", "3", endpoint=free_endpoint)
        assert code == 1
        assert "abort: 2 of 3 confirmed" in out
        assert "vehicle 3: no answer" in out


@pytest.mark.real
async def test_what_ends_a_flight_wants_a_yes_from_a_shell_too(free_endpoint):
    async with field(free_endpoint) as crews:
        code, _, err = await shell("command", "land", "--role", "pursuer", endpoint=free_endpoint)
        assert code == 2
        assert "land ends a flight: found no terminal to ask, expected --yes" in err
        assert not any(crew.obeyed for crew in crews)
        code, out, _ = await shell("command", "land", "--role", "pursuer", "--yes", endpoint=free_endpoint)
        assert code == 0
        assert [len(crew.obeyed) for crew in crews] == [0, 1, 1]
        assert "land: 2 of 2 confirmed" in out


@pytest.mark.real
async def test_lines_for_logs_and_a_recording_until_it_is_told_to_stop(free_endpoint, tmp_path):
    async with field(free_endpoint):
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "gcs.cli", "--plain", "--bus", free_endpoint, "--game", GAME,
            "--runs", str(tmp_path), stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
            env=environment(),
        )  # fmt: skip
        assert process.stdout is not None
        seen = []
        async with asyncio.timeout(patience(20.0)):
            while not any("STATUS vehicle 3" in line for line in seen):
                seen.append((await process.stdout.readline()).decode())
            process.send_signal(signal.SIGTERM)
            _, err = await process.communicate()
        assert process.returncode == 0
        assert err == b""
    said = "".join(seen)
    assert f"joined {free_endpoint} as a client: its port was taken" in said
    assert "recording into" in said
    assert list(tmp_path.glob("*/recording.mcap"))


def test_lines_say_each_event_once_and_how_all_are_every_five_seconds():
    tower = Tower()
    lines = PlainLines()
    tower.hear(setup(2))
    tower.fly(1.0, 1, 2)
    first = lines.lines(tower.picture)
    assert any("game meeting: 2 vehicles, from bridge" in line for line in first)
    status = "STATUS vehicle 2 pursuer ok GUIDED acting link 100% battery 90% heard <1 s ago"
    assert any(status in line for line in first)
    assert lines.lines(tower.picture) == []
    tower.fly(2.0, 1)
    assert [line.split(" ", 1)[1] for line in lines.lines(tower.picture)] == [
        "ERROR vehicle 2 is lost: silent from all sources. look for it, keep others away; "
        "its autopilot's failsafe acts on its own"
    ]
    tower.wait(3.0)
    assert any("STATUS vehicle 2 pursuer LOST" in line for line in lines.lines(tower.picture))


def test_the_document_has_a_name_for_every_field_and_no_infinity():
    tower = Tower()
    tower.hear(setup(2))
    told = document(tower.picture)
    assert msgspec.json.decode(msgspec.json.encode(told)) == told
    assert told["vehicles"][0]["age_s"] is None
    assert told["now_ns"] == START_NS


SHARED = {  # option → its value on the command line, and what the settings or options then hold
    "config": ("other.toml", lambda o: o.settings().operator == "from the file"),
    "game": ("chase", lambda o: o.settings().game == "chase"),
    "bus": ("tcp/127.0.0.1:5555", lambda o: o.settings().bus.endpoint == "tcp/127.0.0.1:5555"),
    "zenoh": ("tls.json5", lambda o: o.settings().bus.zenoh == "tls.json5"),
    "operator": ("ann", lambda o: o.settings().operator == "ann"),
    "runs": ("elsewhere", lambda o: o.settings().recording.folder == "elsewhere"),
    "no-record": (None, lambda o: not o.settings().recording.enabled),
    "plain": (None, lambda o: o.plain is True),
}
BUS_OPTIONS = ("config", "game", "bus", "zenoh")
SUBCOMMANDS = {  # subcommand → what it is called with, and the shared options that it uses
    "status": ((), BUS_OPTIONS),
    "command": (("abort", "--all"), (*BUS_OPTIONS, "operator")),
    "record": ((), (*BUS_OPTIONS, "runs")),
    "replay": (("RUN",), ("config", "plain")),
    "report": (("RUN",), ("config",)),
    "game run": (("field.toml",), tuple(SHARED)),
}


class ReachedError(Exception):
    """A subcommand was about to begin its work with these options."""


@pytest.fixture
def received(monkeypatch, tmp_path):
    """Call `gcs` in this process; the shared options that its subcommand would have begun to work with."""
    (tmp_path / "other.toml").write_text('operator = "from the file"\n')
    monkeypatch.chdir(tmp_path)

    def stop(given: options.Options) -> settings.Settings:
        raise ReachedError(given)

    def call(*arguments: str) -> options.Options:
        with monkeypatch.context() as patched:
            patched.setattr(options.Options, "settings", stop)
            with pytest.raises(ReachedError) as reached:
                cli.app(list(arguments), standalone_mode=False, prog_name="gcs")
        return reached.value.args[0]

    return call


@pytest.mark.parametrize("subcommand", SUBCOMMANDS)
@pytest.mark.parametrize("option", SHARED)
def test_a_shared_option_holds_before_and_after_the_subcommand(received, subcommand, option):
    arguments, used = SUBCOMMANDS[subcommand]
    value, holds = SHARED[option]
    typed = (f"--{option}",) if value is None else (f"--{option}", value)
    before, after = (*typed, *subcommand.split(), *arguments), (*subcommand.split(), *arguments, *typed)
    if option in used:
        assert holds(received(*before)), "before the subcommand"
        assert holds(received(*after)), "after the subcommand"
        assert not holds(received(*subcommand.split(), *arguments)), "without it the default holds"
        return
    done = gcs(*before)
    name = option.removeprefix("no-")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"gcs: --{name}: found before {subcommand}, which does not use it\n"


@pytest.mark.parametrize("typed", [("--plain",), ("--config", "none.toml")])
def test_a_replay_that_decides_again_shows_nothing_and_takes_no_option_for_it(tmp_path, typed):
    said = f"gcs: {typed[0]}: found with replay --decide, which does not use it\n"
    again = ("replay", str(tmp_path), "--decide")
    for arguments in ((*typed, *again), (*again, *typed)):
        done = gcs(*arguments)
        assert (done.returncode, done.stdout, done.stderr) == (2, "", said)


def test_an_option_after_the_subcommand_outranks_the_same_one_before_it(received):
    given = received("--bus", "tcp/10.0.0.1:1", "--game", "early", "status", "--bus", "tcp/10.0.0.2:2")
    assert (given.bus, given.game) == ("tcp/10.0.0.2:2", "early")


@pytest.mark.real
async def test_who_leaves_while_the_bus_is_being_opened_leaves_in_order(free_endpoint):
    """A process that ends inside Zenoh's code dies by SIGABRT: its thread is waited for."""
    for _ in range(3):
        bus = await open_zenoh(free_endpoint)
        await asyncio.sleep(0.45)  # the next attempt begins about now
        await bus.close()
        assert not bus._thread.is_alive()
