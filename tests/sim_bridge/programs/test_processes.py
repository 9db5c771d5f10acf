"""Whole games in real processes, over UDP and Zenoh on loopback: agents that die, ctrl-C, taken ports.

Promised: an agent ends within 2 s of a signal, `serve` too, `fly` (which ends its agents first) within 4 s;
the tests wait longer, for a machine may be busy.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from onboard.wire.mavlink.tlog import read_tlog
from tests.support.real_time import patience, slowness
from tests.support.sim_bridge_process import (
    bridge,
    descendants,
    free_port,
    short,
    started,
    until_said,
    well_known_ports,
)

pytestmark = [pytest.mark.real, pytest.mark.timeout(240), pytest.mark.xdist_group("well-known ports")]
SERVE_ENDS_S = 2.0
FLY_ENDS_S = 4.0


@pytest.fixture(autouse=True)
def _alone() -> Iterator[None]:
    with well_known_ports():
        yield


def flight(tmp_path: Path, horizon: float) -> list[object]:
    """The arguments of a game on a bus of its own."""
    scenario = short(tmp_path, horizon=horizon, ready=2.0)
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    return ["fly", scenario, "--no-report", "--runs", tmp_path / "runs", "--bus", endpoint]


def agent(child: subprocess.Popen[str], id: int) -> psutil.Process:
    """The process of one vehicle's agent."""
    name = f"agent-{id}.toml"
    return next(p for p in descendants(child.pid) if any(word.endswith(name) for word in p.cmdline()))


@pytest.mark.game
def test_an_agent_killed_in_flight_is_started_again_and_the_game_goes_on(tmp_path: Path) -> None:
    horizon = 12.0 * min(2.0, round(slowness()))  # enough for an agent to start and to be let in
    with started(*flight(tmp_path, horizon)) as child:
        until_said(child, "  t = ")  # well under way: who comes now is late
        first = agent(child, 2)
        first.kill()
        out, err = child.communicate(timeout=patience(40.0))
        assert child.returncode == 0, out + err
        assert descendants(child.pid) == []
    (folder,) = (tmp_path / "runs").iterdir()
    assert "agent 2 ended with code -9 and is started again (see agent-2.log)" in out
    assert "agent 2 was started again and may act again" in out
    assert f"the target was denied: neither arrived nor captured within {horizon:g} s" in out
    summary = json.loads((folder / "summary.json").read_bytes())
    timing = json.loads((folder / "timing.json").read_bytes())
    assert (summary["mode"], summary["verdict"], summary["time"]) == ("real", "denied", horizon)
    assert [v["stage"] for v in summary["vehicles"]] == ["ended", "ended"]
    assert timing["agents_started_again"] == 1
    assert set(timing["agents"]) == {"1", "2"}
    assert timing["agents"]["1"]["latency_p50_us"] > 0
    told = (folder / "agent-2.log").read_text(encoding="utf-8")
    again = told[told.rindex("started: pursuer 2") :]
    assert again.index("resumed: ") < again.index("supervisor_")
    assert "released: LOITER confirmed" in again
    for id in (1, 2):
        log = read_tlog((folder / f"vehicle-{id}.tlog").read_bytes())
        kinds = {entry.packet.name for entry in log}
        assert {"GLOBAL_POSITION_INT", "SET_POSITION_TARGET_LOCAL_NED"} <= kinds
    assert (folder / "recording.mcap").stat().st_size > 20_000


def test_ctrl_c_in_flight_ends_everybody_and_says_that_there_was_no_verdict(tmp_path: Path) -> None:
    with started(*flight(tmp_path, 60.0)) as child:
        until_said(child, "running")
        crew = descendants(child.pid)
        assert len(crew) >= 2
        os.killpg(child.pid, signal.SIGINT)  # as a terminal does it
        out, err = child.communicate(timeout=patience(FLY_ENDS_S))
        assert child.returncode == 130, out + err
        assert "Traceback" not in err
        gone, left = psutil.wait_procs(crew, timeout=patience(1.0))
        assert left == []
        assert len(gone) == len(crew)
    (folder,) = (tmp_path / "runs").iterdir()
    assert json.loads((folder / "summary.json").read_bytes())["verdict"] == "none"
    told = f"sim-bridge: interrupted: no outcome; the unfinished game is in {folder}"
    assert err.rstrip().endswith(told)
    for id in (1, 2):  # while there still was something to fly, it was left in a mode it can hold
        last = (folder / f"agent-{id}.log").read_text(encoding="utf-8").splitlines()[-1]
        assert last.endswith("stopped: vehicle left in LOITER")


def test_a_port_in_use_is_one_line_and_no_process_is_left(tmp_path: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        with contextlib.suppress(OSError):  # taken by another program: all the same
            taken.bind(("127.0.0.1", 14541))
        run = bridge(*flight(tmp_path, 60.0), promised_s=20.0)
    assert run.returncode == 2, run.stdout
    assert "agent 2: " in run.stderr
    assert "port in use" in run.stderr
    assert len(run.stderr.strip().splitlines()) == 1
    mine = str(tmp_path)
    assert not [words for words in commands() if "onboard.cli" in words and mine in " ".join(words)]


def commands() -> list[list[str]]:
    """The command line of every process."""
    return [process.info["cmdline"] or [] for process in psutil.process_iter(["cmdline"])]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_the_server_without_a_word_of_complaint(number: signal.Signals, tmp_path: Path) -> None:
    scenario, ports = short(tmp_path), tmp_path / "ports.json"
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    with started("serve", scenario, "--bus", endpoint, "--ports", ports) as child:
        lines = until_said(child, "bus: listening")
        child.send_signal(number)
        _, err = child.communicate(timeout=patience(SERVE_ENDS_S))
        assert child.returncode == 0, err
    assert err == ""
    assert json.loads(ports.read_bytes()) == {"1": 14540, "2": 14541}
    assert "short: 2 vehicles, game 'game', seed 3" in lines[0]
