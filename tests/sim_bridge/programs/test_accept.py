"""`sim-bridge accept` against simulated autopilots on UDP: nothing differs from the twin, or it is named."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.game.scenario import Kind
from onboard.wire.mavlink.tlog import read_tlog
from sim_bridge.programs.accept import Options, Row, accept_on, compared, table
from sim_bridge.vehicle.acceptance.stories import Note, stories
from sim_bridge.vehicle.acceptance.twin import PLAYED, Begun, Twin
from tests.support.udp_fleet import HOST, Fleet, fleet, free_port

pytestmark = pytest.mark.real


async def accepted(kind: Kind, tlog: Path, *only: str, before: object = None) -> list[Row]:
    port = free_port()
    async with fleet(kind, [[port]]) as vehicles:
        if callable(before):
            before(vehicles)
        options = Options(tlog=tlog, yes=True, only=only)
        return await accept_on(f"udpin://{HOST}:{port}", options, lambda line: None, lambda question: False)


@pytest.mark.timeout(240)
async def test_simulated_autopilots_are_as_their_twins(tmp_path: Path) -> None:
    flights = [accepted(kind, tmp_path / f"{kind.value}.tlog") for kind in Kind]
    for kind, rows in zip(Kind, await asyncio.gather(*flights), strict=True):
        assert [row for row in rows if not row.same] == [], table(rows)
        assert {row.story for row in rows} == {"hold", "refusal", "follow", "return", "silence"}
        names = [entry.packet.name for entry in read_tlog((tmp_path / f"{kind.value}.tlog").read_bytes())]
        assert names.count("HEARTBEAT") > 40  # both ways
        assert "COMMAND_LONG" in names
        assert "COMMAND_ACK" in names


@pytest.mark.timeout(60)
async def test_what_differs_is_named(tmp_path: Path) -> None:
    def sinks(vehicles: Fleet) -> None:
        autopilot = vehicles.autopilot(1)
        autopilot.allows = lambda now_ns, mode: "broken"  # type: ignore[method-assign]

    rows = await accepted(Kind.PX4, tmp_path / "a.tlog", "return", before=sinks)
    differ = {row.what: (row.real, row.twin) for row in rows if not row.same}
    assert differ["mode after 4 s"] == ("HOLD", "RTL")
    assert differ["RTL: answers"] == ("accepted, later", "accepted, accepted")
    assert "*" in table(rows)


async def test_a_story_is_flown_only_with_consent(tmp_path: Path) -> None:
    port, asked = free_port(), []

    def refuse(question: str) -> bool:
        asked.append(question)
        return False

    async with fleet(Kind.ARDUCOPTER, [[port]]) as vehicles:
        before = vehicles.position(1)
        options = Options(tlog=tmp_path / "a.tlog")
        rows = await accept_on(f"udpin://{HOST}:{port}", options, lambda line: None, refuse)
        assert abs(vehicles.position(1).z - before.z) < 0.5
    assert rows == []
    assert len(asked) == 5


@pytest.mark.parametrize(
    ("ground", "only", "words"),
    [
        (True, "hold", "expected a vehicle that flies"),
        (False, "dance", "--only: found dance, expected one of"),
    ],
)
async def test_what_cannot_be_flown_is_refused_in_one_line(
    ground: bool, only: str, words: str, tmp_path: Path
) -> None:
    port = free_port()
    async with fleet(Kind.ARDUCOPTER, [[port]], ground=ground):
        with pytest.raises(ConfigError, match=words):
            await accept_on(
                f"udpin://{HOST}:{port}",
                Options(tlog=tmp_path / "a.tlog", yes=True, only=(only,)),
                lambda line: None,
                lambda question: True,
            )


def test_the_log_is_never_written_over(tmp_path: Path) -> None:
    (tmp_path / "a.tlog").write_bytes(b"flight")
    with pytest.raises(ConfigError, match="expected a new file"):
        asyncio.run(
            accept_on(
                "udpin://127.0.0.1:0",
                Options(tlog=tmp_path / "a.tlog"),
                lambda line: None,
                lambda question: True,
            )
        )
    assert (tmp_path / "a.tlog").read_bytes() == b"flight"


def test_numbers_differ_beyond_what_the_story_allows() -> None:
    rows = compared(
        "s",
        [Note("a", 2.0, 0.5), Note("b", "HOLD"), Note("c", 1.0)],
        [Note("a", 2.6, 0.5), Note("b", "HOLD")],
    )
    assert [row.same for row in rows] == [False, True, False]
    assert rows[2].twin == "not seen"


@pytest.mark.parametrize("kind", list(PLAYED), ids=lambda kind: kind.value)
def test_the_twin_takes_the_measured_parameters(kind: object) -> None:
    for act, mode in ((5.0, "HOLD"), (3.0, "RTL")):
        if not str(getattr(kind, "value", "")).startswith("px4"):
            return
        twin = Twin(Begun(kind, 3, 60.0, 90.0, None, {"COM_OBL_RC_ACT": act}))  # type: ignore[arg-type]
        twin.settle(2.0)
        told = {note.what: note.value for note in twin.fly(stories(kind)[-1])}  # type: ignore[arg-type]
        assert told["mode in the end"] == mode
