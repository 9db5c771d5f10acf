"""The preflight check: a table a person can act on."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from onboard.agent.config import AgentConfig, EnvelopeConfig, FenceConfig, SafetyConfig
from onboard.agent.preflight import look
from onboard.agent.preflight_rows import Mark, Row, Sight, judge, table
from onboard.autopilot.base import Telemetry
from onboard.runtime.bus_security import BusSecurity, Lock
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus.messages import LinkLock
from onboard.wire.mavlink.modes import Kind
from tests.support.field_keys import Field
from tests.support.real_time import patience

GOOD = Sight(
    now=10.0,
    link="udpin://127.0.0.1:14541",
    datagrams=500,
    kind=Kind.ARDUCOPTER.value,
    version="4.5.6",
    telemetry=Telemetry(
        kind=Kind.ARDUCOPTER, mode="LOITER", battery=0.9, battery_at=9.0, gps_fix=3, satellites=12,
        gps_at=9.0, ekf_ok=True, ekf_at=9.0,
    ),
    position_rate=20.0,
    parameters={
        "FS_GCS_ENABLE": 1.0, "SYSID_MYGCS": 2.0, "FENCE_ENABLE": 1.0, "FENCE_ACTION": 1.0,
        "GUID_TIMEOUT": 1.0, "FS_OPTIONS": 0.0, "ARMING_CHECK": 1.0, "FS_EKF_ACTION": 1.0,
        "BATT_MONITOR": 4.0, "BATT_LOW_VOLT": 10.5, "BATT_FS_LOW_ACT": 2.0,
    },
    signed=True,
    link_lock=LinkLock.SIGNED,
    connected=True,
    bus="tcp/127.0.0.1:7447",
    master=True,
    offset_s=0.004,
)  # fmt: skip


WATCHED = GOOD.parameters or {}


def row(seen: Sight, name: str, config: AgentConfig | None = None) -> Row:
    """One row of the table."""
    return next(row for row in judge(config or AgentConfig(), seen) if row.name == name)


def test_all_in_order_is_all_pass() -> None:
    rows = judge(AgentConfig(), GOOD)
    assert {row.mark for row in rows} == {Mark.PASS}
    assert len(rows) >= 10
    assert all("→" not in line for line in table(rows))


@pytest.mark.parametrize(
    ("change", "name", "mark", "said"),
    [
        ({"link_trouble": "port in use"}, "link", Mark.FAIL, "port in use"),
        ({"datagrams": 0}, "link", Mark.FAIL, "nothing arrives"),
        ({"bad_frames": {"bad_crc": 3}}, "link", Mark.WARN, "bad_crc 3"),
        ({"kind": "", "other_systems": (1, 7)}, "autopilot", Mark.FAIL, "but system 1, 7"),
        ({"refusal": "PX4 fixed wing ignores"}, "autopilot", Mark.FAIL, "PX4 fixed wing"),
        ({"position_rate": 4.0}, "rates", Mark.FAIL, "4.0 Hz of 20"),
        ({"telemetry": GOOD.telemetry._replace(gps_fix=1)}, "GPS", Mark.FAIL, "fix type 1"),
        ({"telemetry": GOOD.telemetry._replace(ekf_ok=False)}, "estimate", Mark.FAIL, "not healthy"),
        ({"telemetry": GOOD.telemetry._replace(battery=0.3)}, "battery", Mark.FAIL, "30%"),
        ({"telemetry": GOOD.telemetry._replace(battery=-1.0)}, "battery", Mark.WARN, "not reported"),
        ({"parameters": {**WATCHED, "FS_GCS_ENABLE": 0.0}}, "agent dies", Mark.FAIL, "FS_GCS_ENABLE is 0"),
        ({"parameters": {**WATCHED, "FENCE_ENABLE": 0.0}}, "fence crossed", Mark.WARN, "off"),
        ({"connected": False}, "bus", Mark.FAIL, "nobody"),
        ({"bus_trouble": "no such file"}, "bus", Mark.FAIL, "no such file"),
        ({"master": False}, "clock", Mark.WARN, "no master"),
        ({"offset_s": 0.1}, "clock", Mark.WARN, "+100 ms"),
        ({"offset_s": -0.4}, "clock", Mark.FAIL, "-400 ms"),
        ({"key_trouble": "found mode 0644"}, "signing key", Mark.FAIL, "0644"),
        ({"free_bytes": 1e6}, "disk", Mark.WARN, "0.0 GB"),
        ({"bytecode": False}, "bytecode", Mark.WARN, "not compiled"),
    ],
)
def test_each_trouble_has_its_row_with_what_to_do(
    change: dict[str, object], name: str, mark: Mark, said: str
) -> None:
    found = row(GOOD._replace(**change), name)  # type: ignore[arg-type]
    assert (found.mark, said in found.found, bool(found.remedy)) == (mark, True, True)
    assert "→" in table([found])[0]


@pytest.mark.parametrize(("seconds", "mark"), [(1.0, Mark.PASS), (3.0, Mark.FAIL)])
def test_the_own_fence_holds_what_a_dead_agents_vehicle_flies_on(seconds: float, mark: Mark) -> None:
    """10 m/s for 0.5 s and the timeout, and 25 m to stop at 2 m/s²: 40 m and 60 m; the fence gives 45 m."""
    corners = ((-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0))
    fence = FenceConfig(polygon=corners, height_min=10.0, height_max=90.0)
    config = AgentConfig(safety=SafetyConfig(fence=fence), envelope=EnvelopeConfig(speed_max=10.0))
    seen = GOOD._replace(parameters={**WATCHED, "GUID_TIMEOUT": seconds})
    found = row(seen, "fence, agent dies", config)
    assert found.mark is mark
    assert f"flies on {10.0 * (0.5 + seconds) + 25.0:.0f} m" in found.found
    assert "the fence is 45 m deep" in found.found


@pytest.mark.parametrize("field", [False, True])
def test_no_key_is_a_warning(field: bool) -> None:
    assert row(GOOD._replace(signed=False), "signing key", AgentConfig(field=field)).mark is Mark.WARN


@pytest.mark.parametrize(
    ("lock", "mark", "said"),
    [
        (LinkLock.SIGNED, Mark.PASS, "locked"),
        (LinkLock.REFUSED, Mark.FAIL, "signature_unsigned 9, signature_wrong 4"),
        (LinkLock.SILENT, Mark.WARN, "no autopilot"),
    ],
)
def test_the_lock_of_the_links_has_a_row_of_its_own(lock: LinkLock, mark: Mark, said: str) -> None:
    bad = {"signature_wrong": 4, "signature_unsigned": 9, "bad_crc": 1}
    found = row(GOOD._replace(signed=True, link_lock=lock, bad_frames=bad), "link lock")
    assert (found.mark, said in found.found) == (mark, True)
    without = judge(AgentConfig(), GOOD._replace(signed=False, link_lock=lock))
    assert all(other.name != "link lock" for other in without)


def test_a_listener_that_lets_one_in_and_answers_nothing_is_a_failure() -> None:
    unserved = "the listener answers nothing: is vehicle-9.1 in its roster?"
    found = row(GOOD._replace(unserved=unserved), "bus")
    assert (found.mark, unserved in found.found, "roster" in found.remedy) == (Mark.FAIL, True, True)


@pytest.mark.real
async def test_the_check_of_a_member_that_was_revoked_says_so(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    old = tmp_path / "old"
    shutil.copytree(field.config("vehicle-3").parent, old)
    field.change("id = 3\n", "id = 3\nkey = 2\n")
    field.make()
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    try:
        config = AgentConfig(
            id=3, game="range", link=("udpin://127.0.0.1:0",), zenoh=str(old / "zenoh.json5")
        )
        seen = await look(config, 0.2)
        assert row(seen, "bus").mark is Mark.FAIL
        assert "is vehicle-3.1 in its roster?" in row(seen, "bus").found
        good = await look(msgspec.structs.replace(config, zenoh=str(field.config("vehicle-3"))), 0.2)
        assert row(good, "bus").mark is Mark.PASS
        assert row(good, "bus lock").found.startswith("locked: vehicle-3.2")
    finally:
        await ground.close()


def test_the_lock_of_the_bus_has_a_row_of_its_own() -> None:
    opened = GOOD._replace(lock=BusSecurity(Lock.OPEN, "OPEN: whoever reaches tcp/10.0.0.1:7447 takes part"))
    assert row(opened, "bus lock", AgentConfig(field=True, open_bus=True)).mark is Mark.WARN
    locked = GOOD._replace(lock=BusSecurity(Lock.KEYS, "locked: vehicle-2.1 in field range, 30 days left"))
    assert row(locked, "bus lock").mark is Mark.PASS


@pytest.mark.real
def test_alone_on_a_machine_it_fails_with_a_table_and_exit_code_1() -> None:
    command = [sys.executable, "-m", "onboard.cli", "check", "--link", "udpin://127.0.0.1:0",
               "--bus", "tcp/127.0.0.1:1", "--seconds", "0.5"]  # fmt: skip
    run = subprocess.run(command, capture_output=True, text=True, timeout=patience(10.0), check=False)
    assert run.returncode == 1, run.stderr
    assert "FAIL  link" in run.stdout
    assert "FAIL  bus" in run.stdout
    assert run.stdout.strip().splitlines()[-1].startswith("not ready: ")
