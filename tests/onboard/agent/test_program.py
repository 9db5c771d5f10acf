"""The agent as a program: what it imports, how it is told things, how it ends."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from onboard.agent.config import AgentConfig, load
from onboard.config.strict import ConfigError
from onboard.runtime.clock import VirtualClock
from onboard.runtime.resources import configs
from onboard.runtime.systemd import Notifier
from tests.support.real_time import patience

HEAVY = (
    *("scipy", "control", "numba", "matplotlib", "pymavlink.mavutil"),
    *("textual", "rich", "typer", "pydantic", "mcap", "plotly"),
)


def program(code: str) -> subprocess.CompletedProcess[str]:
    """Run a program in an interpreter of its own; it ends well."""
    command = [sys.executable, "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=patience(20.0))


def agent(*arguments: str, promised_s: float = 10.0) -> subprocess.CompletedProcess[str]:
    """Run `onboard-agent` to its end."""
    command = [sys.executable, "-m", "onboard.cli", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=patience(promised_s), check=False)


def test_nothing_heavy_is_on_the_agents_import_path() -> None:
    code = (
        "import onboard.cli, onboard.agent.program, onboard.agent.preflight, sys, json;"
        "print(json.dumps(sorted(sys.modules)))"
    )
    run = program(code)
    modules = json.loads(run.stdout)
    assert "onboard.agent.shell" in modules
    assert [name for name in modules if name.startswith(HEAVY)] == []


def test_help_imports_neither_numpy_nor_the_dialect() -> None:
    code = "import onboard.cli, sys; print('numpy' in sys.modules, 'pymavlink' in sys.modules)"
    run = program(code)
    assert run.stdout.split() == ["False", "False"]
    shown = agent("--help")
    assert shown.returncode == 0
    for option in ("--config", "--link", "--autopilot", "--game", "--bus", "--dry-run", "--role", "--id"):
        assert option in shown.stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--role", "chef"], "--role: found 'chef', expected one of: evader, pursuer, tracker"),
        (["--id", "0"], "id: found 0, expected a MAVLink system id from 1 to 250"),
        (["--id", "x"], "--id: found 'x', expected a whole number"),
        (["--nonsense"], "unrecognized arguments: --nonsense"),
        (["--link", "carrier-pigeon"], "link: found 'carrier-pigeon', expected udpin:HOST"),
        (["--config", "/nowhere/agent.toml"], "/nowhere/agent.toml"),
        (["--game", "a/b"], "game: found 'a/b', expected a name without"),
        (["--autopilot", "horse"], "autopilot"),
        (["--strategy", "papr"], "options: strategy: found 'papr', expected one of a pursuer's: paper"),
        (["--strategy", "straight"], "options: strategy: found 'straight', expected one of a pursuer's"),
        (["--role", "evader", "--strategy", "pure-pursuit"], "expected one of an evader's: paper, "),
        (["--route", "x.toml"], "route: found 'x.toml', expected none: a pursuer follows no route"),
        (["check", "--seconds", "0"], "--seconds: found 0, expected 0.5 to 600 s"),
    ],
)
def test_a_wrong_option_is_one_line_and_exit_code_2(arguments: list[str], said: str) -> None:
    run = agent(*arguments)
    assert run.returncode == 2
    assert said in run.stderr
    assert len(run.stderr.strip().splitlines()) == 1
    assert run.stdout == ""


def test_a_port_in_use_is_one_line_and_exit_code_2() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        run = agent("--link", f"udpin://127.0.0.1:{taken.getsockname()[1]}")
    assert run.returncode == 2
    assert "port in use" in run.stderr
    assert len(run.stderr.strip().splitlines()) == 1


def test_a_key_file_that_others_can_read_is_refused(tmp_path: Path) -> None:
    key = tmp_path / "key"
    key.write_bytes(bytes(32))
    key.chmod(0o644)
    file = tmp_path / "agent.toml"
    file.write_text(f'[signing]\nkey = "{key}"\n', encoding="utf-8")
    run = agent("--config", str(file), "--link", "udpin://127.0.0.1:0")
    assert run.returncode == 2
    assert "0644" in run.stderr


def test_the_template_is_the_defaults() -> None:
    assert load(configs() / "agent.toml", {}) == AgentConfig()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("idd = 3", "idd: unknown key"),
        ("control_rate_hz = 80.0", "control_rate_hz: found 80.0, expected a rate in (0, 50] Hz"),
        ("[safety]\nstrategy_age_s = 1.0", "safety.strategy_age_s: found 1.0, expected a time in (0, 0.2] s"),
        ("envelope = {speed_min = 9.0, speed_max = 5.0}", "envelope.speed_min: found 9.0, expected at most"),
        ("[safety]\nfence_margin = -1.0", "safety.fence_margin: found -1.0, expected zero or more"),
        ("[safety]\nbattery = nan", "safety.battery: found nan"),
        ('[safety]\ntrack_action = "dance"', "safety.track_action"),
    ],
)
def test_a_wrong_configuration_names_file_key_and_what_was_expected(
    tmp_path: Path, text: str, said: str
) -> None:
    file = tmp_path / "agent.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError) as error:
        load(file, {})
    assert str(error.value).startswith(f"{file}: ")
    assert said in str(error.value)


def test_options_outrank_the_file(tmp_path: Path) -> None:
    file = tmp_path / "agent.toml"
    file.write_text('id = 5\nrole = "evader"\n', encoding="utf-8")
    assert load(file, {"id": 7}).id == 7
    assert load(file, {"id": 7}).role.value == "evader"
    assert load(file, {}).links == ("udpin://127.0.0.1:14544",)


@pytest.mark.real
def test_a_signal_ends_it_with_exit_code_0_with_no_bus_and_no_autopilot() -> None:
    command = [sys.executable, "-m", "onboard.cli", "--link", "udpin://127.0.0.1:0",
               "--bus", "tcp/127.0.0.1:1"]  # fmt: skip
    for number in (signal.SIGTERM, signal.SIGINT):
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            assert process.stderr is not None
            lines = []
            for line in process.stderr:
                lines.append(line)
                if "lacks" in line or "waiting" in line or "bus" in line:
                    break
            process.send_signal(number)
            rest = process.communicate(timeout=patience(2.0))[1]
            assert process.returncode == 0
            assert "stopped" in rest
            assert "started: pursuer 2" in "".join(lines)


def test_the_service_manager_hears_ready_and_a_watchdog_and_nothing_more(tmp_path: Path) -> None:
    path = str(tmp_path / "notify")
    clock = VirtualClock(0)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(path)
        manager.settimeout(1.0)
        environment = {"NOTIFY_SOCKET": path, "WATCHDOG_USEC": "2000000", "WATCHDOG_PID": str(os.getpid())}
        notifier = Notifier(clock, environment)
        notifier.ready()
        for n in range(40):  # two seconds of control steps
            clock.advance_to(n * 50_000_000)
            notifier.alive()
        notifier.status("two\nlines")
        notifier.stopping()
        heard = [manager.recv(100).decode() for _ in range(7)]
        assert heard == ["READY=1", *["WATCHDOG=1"] * 4, "STATUS=two lines", "STOPPING=1"]
        notifier.close()
    assert not Notifier(clock, {}).active
    gone = Notifier(clock, {"NOTIFY_SOCKET": path + "x", "WATCHDOG_USEC": "1000"})
    gone.ready()
    gone.close()


def test_the_service_unit_restarts_and_watches_the_agent() -> None:
    unit = (configs() / "onboard-agent.service").read_text(encoding="utf-8")
    for line in ("Type=notify", "WatchdogSec=2", "Restart=always", "RestartPreventExitStatus=2"):
        assert line in unit.splitlines()
