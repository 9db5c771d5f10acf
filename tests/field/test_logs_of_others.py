"""Telemetry logs of ground stations: named by date, of several vehicles, cut, begun before a fix."""

from __future__ import annotations

import struct
from math import cos, radians, sin
from pathlib import Path

import pytest

from gcs.report.program import read_run
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.paths import RECORDINGS

START_US = 1_700_000_000_000_000


def circle(path: Path, systems: tuple[int, ...], unfixed_s: float = 5.0) -> None:
    """40 s of circles of 100 m after some seconds of 0°, 0°."""
    senders = {system: DialectSender(system, 1) for system in systems}
    log = b""
    for k in range(450):
        t = 0.1 * k
        a = 0.1 * t
        for system, sender in senders.items():
            lat = round((47.3977 + 100 * cos(a) / 111_320) * 1e7) + 1000 * system
            lon = round((8.5456 + 100 * sin(a) / (111_320 * cos(radians(47.4)))) * 1e7)
            place = (0, 0, -17_000) if t < unfixed_s else (lat, lon, 538_000)
            speed = (-round(1000 * sin(a)), round(1000 * cos(a)))
            message = dialect.MAVLink_global_position_int_message(
                round(t * 1e3), *place, 50_000, *speed, 0, 0
            )
            log += struct.pack(">Q", START_US + round(t * 1e6)) + sender.pack(message)
    path.write_bytes(log)


def test_places_before_a_fix_are_no_places(tmp_path: Path) -> None:
    circle(tmp_path / "vehicle-1.tlog", (1,))
    run = read_run(tmp_path)
    (north, east) = run.extent
    assert north[1] - north[0] < 1000.0
    assert east[1] - east[0] < 1000.0
    assert run.flown[1].t[0] == 0.0
    assert len(run.flown[1].t) > 100


@pytest.mark.parametrize("whole", [True, False])
def test_a_log_named_by_date_is_reported_with_everybody_in_it(tmp_path: Path, whole: bool) -> None:
    log = tmp_path / "2026-11-25 10-00-00.tlog"
    circle(log, (2, 3))
    run = read_run(tmp_path if whole else log)
    assert set(run.flown) == {2, 3}
    assert run.folder == tmp_path


def test_the_recorded_flight_is_reported_from_its_log_alone() -> None:
    run = read_run(RECORDINGS / "arducopter-4.5.6-guided.tlog")
    assert set(run.flown) == {1}
    assert 20.0 < -run.flown[1].position[:, 2].min() < 32.0  # the story beside it: up to 20 m, then RTL


@pytest.mark.parametrize("cut", [1, 9, 500, 10_000])
def test_a_cut_log_is_read_up_to_the_cut_and_zeros_in_it_cost_nothing_else(tmp_path: Path, cut: int) -> None:
    path = tmp_path / "vehicle-1.tlog"
    circle(path, (1,), unfixed_s=0.0)
    data = path.read_bytes()
    whole = len(read_run(tmp_path).flown[1].t)
    path.write_bytes(data[:-cut])
    assert whole - cut / 30 - 2 < len(read_run(tmp_path).flown[1].t) <= whole
    path.write_bytes(data[:5000] + bytes(65_536) + data[5000:])
    assert len(read_run(tmp_path).flown[1].t) >= whole - 2
