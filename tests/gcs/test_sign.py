"""`gcs sign` against simulated autopilots on UDP: who signs with what, and a key set on the ground alone."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from gcs.signing import sign
from onboard.config.strict import ConfigError
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.udp_fleet import fleet, free_port


@pytest.fixture
def keys(tmp_path: Path) -> dict[int, Path]:
    """Key files of two vehicles, as `gcs keys init` lays them out."""
    found = {}
    for id in (1, 2):
        found[id] = tmp_path / f"vehicle-{id}" / "mavlink.key"
        found[id].parent.mkdir()
        found[id].touch(mode=0o600)
        found[id].write_text(bytes(range(id, id + 32)).hex())
    return found


@pytest.mark.real
async def test_a_key_is_set_on_the_ground_and_found_again(
    keys: dict[int, Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    port = free_port()
    url = f"udpin://127.0.0.1:{port}"
    async with fleet(Kind.PX4, [[port]], ground=True) as vehicles:
        assert await sign(url, [], None, 0, sure=False) == 0
        assert capsys.readouterr().out == "system 1 (PX4 multicopter): unsigned\n"
        assert await sign(url, [], keys[1], 0, sure=False) == 0
        assert f"system 1 signs with {keys[1]}" in capsys.readouterr().out
        assert await sign(url, [keys[2]], None, 0, sure=False) == 0
        assert capsys.readouterr().out == "system 1 (PX4 multicopter): signed, none of 1 keys tried\n"
        assert await sign(url, [tmp_path], None, 0, sure=False) == 0
        assert f"signed with {keys[1]}" in capsys.readouterr().out
        unsigned = DialectSender(255, 190).pack(
            dialect.MAVLink_command_long_message(1, 1, 512, 0, 242, 0, 0, 0, 0, 0, 0)
        )
        autopilot = vehicles.autopilot(1)
        before = autopilot.counters["signature_unsigned"]
        autopilot.receive(0, unsigned, "stranger")
        assert autopilot.counters["signature_unsigned"] == before + 1


@pytest.mark.real
async def test_an_armed_vehicle_keeps_its_key_and_no_network_brings_one(keys: dict[int, Path]) -> None:
    port = free_port()
    async with fleet(Kind.ARDUCOPTER, [[port]]):
        with pytest.raises(ConfigError, match="system 1: found it armed, expected it disarmed"):
            await sign(f"udpin://127.0.0.1:{port}", [], keys[1], 0, sure=False)
    with pytest.raises(ConfigError, match="found a link over a network, expected serial or USB"):
        await sign("udpout://10.255.255.1:14550", [], keys[1], 0, sure=False)


@pytest.mark.real
async def test_nobody_on_the_link_is_said(capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    monkeypatch.setattr("gcs.signing.LISTEN_S", 0.1)
    assert await sign(f"udpin://127.0.0.1:{free_port()}", [], None, 0, sure=False) == 1
    assert "no autopilot heard" in capsys.readouterr().err


async def test_a_key_that_others_may_read_is_no_key(tmp_path: Path) -> None:
    path = tmp_path / "mavlink.key"
    path.write_text("00" * 32)
    os.chmod(path, 0o644)
    with pytest.raises(ConfigError, match=r"mavlink\.key"):
        await sign("udpin://127.0.0.1:1", [], path, 0, sure=False)
