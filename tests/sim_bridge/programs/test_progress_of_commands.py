"""Commands that may take long tell how far they are, on standard error, and not when asked to be quiet."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gcs import programs as station
from gcs.picture.thresholds import Thresholds
from onboard.runtime import progress
from onboard.wire.bus.messages import Role
from sim_bridge.programs import planar as command
from sim_bridge.programs.fly import Options, fly
from sim_bridge.studies.predict import predict
from tests.support.sim_bridge_process import short

TOLD = re.compile(r"^(gcs|sim-bridge): +\d+ % \(.+\)$")


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Everything that is told is shown: no work is too short."""
    monkeypatch.setattr(progress, "QUIET_S", 0.0)
    monkeypatch.setattr(progress, "LINE_S", 0.0)


def shares(err: str) -> list[int]:
    """The percentages of the lines on standard error, each of which must tell of progress."""
    lines = [line for line in err.splitlines() if line.strip()]
    assert all(TOLD.match(line) for line in lines), lines
    return [int(line.split("%")[0].split(":")[1]) for line in lines]


def test_a_flown_game_its_report_and_its_replay_tell_how_far_they_are(
    at_once: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    flown = fly(short(tmp_path), Options(fast=True, runs=tmp_path, report=False))
    told = shares(capsys.readouterr().err)
    assert told == sorted(told)
    assert told[-1] > 90
    station.report(flown.folder, Thresholds())
    assert shares(capsys.readouterr().err)[-1] > 80
    station.decide_again(flown.folder, dict.fromkeys(Role, ""))
    assert len(shares(capsys.readouterr().err)) > 10
    fly(short(tmp_path), Options(fast=True, runs=tmp_path, report=False, quiet=True))
    assert capsys.readouterr().err == ""


def test_plane_games_tell_how_far_they_are(
    at_once: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = short(tmp_path)
    command.planar(command.Options((path, path), horizon=1.0))
    assert shares(capsys.readouterr().err) == [0, 25, 50, 75]


@pytest.mark.long
def test_a_prediction_tells_how_far_it_is(at_once: None, capsys: pytest.CaptureFixture[str]) -> None:
    predict(epochs=2)
    told = shares(capsys.readouterr().err)
    assert told[0] < 50
    assert 0 in told[2:]  # after the example the comparison begins
    assert told[-1] > 90
