"""The preflight check beside the simulated autopilots: what it says, and that it leaves no trace."""

from __future__ import annotations

from hashlib import sha256

import pytest

from onboard.agent.preflight_rows import Mark
from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import Firmware, Kind
from onboard.wire.mavlink.signing import MemoryStore, Signing
from tests.support.checked_vehicle import SYSTEM, checked
from tests.support.flown_autopilot import FlownAutopilot

BROUGHT_HOME: dict[Kind, dict[str, float]] = {
    Kind.ARDUCOPTER: {"FS_GCS_ENABLE": 1, "SYSID_MYGCS": SYSTEM, "FS_OPTIONS": 0, "BATT_FS_LOW_ACT": 2},
    Kind.ARDUPLANE: {"FS_GCS_ENABL": 1, "SYSID_MYGCS": SYSTEM, "FS_LONG_ACTN": 1},
    Kind.PX4: {"COM_LOW_BAT_ACT": 3},
}
KEYS = [Signing(sha256(word).digest(), MemoryStore()) for word in (b"ours", b"theirs")]


def failing(rows: dict[str, object]) -> set[str]:
    return {name for name, row in rows.items() if row.mark is Mark.FAIL} - {"bus"}  # type: ignore[attr-defined]


@pytest.mark.parametrize("kind", BROUGHT_HOME)
@pytest.mark.parametrize("airborne", [False, True], ids=["at rest", "in the air"])
def test_a_vehicle_that_is_set_as_demanded_passes_healthy_and_no_failsafe_starts(
    kind: Kind, airborne: bool
) -> None:
    rows, (flown,) = checked(kind, airborne=airborne, parameters=BROUGHT_HOME[kind])
    assert failing(rows) == set()
    assert rows["estimate"].mark is Mark.PASS
    alone = FlownAutopilot(kind, system=SYSTEM, airborne=airborne, parameters=BROUGHT_HOME[kind])
    for one in (alone, flown):
        one.forward(45.0 - one.now_ns / NS_PER_S)
    assert (flown.mode, flown.texts()) == (alone.mode, alone.texts())


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.ARDUPLANE])
def test_the_newer_names_are_read(kind: Kind) -> None:
    rows, _ = checked(kind, parameters=BROUGHT_HOME[kind], firmware=Firmware.NEWER)
    assert failing(rows) == set()


@pytest.mark.parametrize("kind", BROUGHT_HOME)
def test_over_a_lossy_link_the_check_knows_in_its_usual_time(kind: Kind) -> None:
    rows, _ = checked(kind, parameters=BROUGHT_HOME[kind], loss=0.3)
    assert rows["agent dies"].mark is not Mark.FAIL
    assert not any("not known" in row.found for row in rows.values() if row.name != "arming")


@pytest.mark.parametrize(
    ("kind", "failed"),
    [
        (Kind.ARDUCOPTER, {"agent dies"}),
        (Kind.ARDUPLANE, {"agent dies"}),
        (Kind.PX4, {"agent dies"}),  # it holds its place, and COM_LOW_BAT_ACT is 0
    ],
)
def test_as_delivered_a_dead_agents_vehicle_stays_up_and_the_check_fails(
    kind: Kind, failed: set[str]
) -> None:
    rows, _ = checked(kind)
    assert failing(rows) == failed


def test_px4s_own_default_of_offboard_loss_fails() -> None:
    rows, _ = checked(Kind.PX4, parameters={**BROUGHT_HOME[Kind.PX4], "COM_OBL_RC_ACT": 0}, throttle=None)
    assert rows["agent dies"].mark is Mark.FAIL
    assert "without them it sinks" in rows["agent dies"].found


@pytest.mark.parametrize(
    ("kind", "vehicle_type", "said"),
    [(Kind.PX4, 22, "PX4 VTOL"), (Kind.ARDUPLANE, 22, "ArduPlane VTOL"), (Kind.ARDUCOPTER, 10, "unknown")],
)
def test_an_autopilot_that_nobody_flies_is_one_line(kind: Kind, vehicle_type: int, said: str) -> None:
    rows, _ = checked(kind, vehicle_type=vehicle_type)
    assert failing(rows) == {"autopilot"}
    assert said in rows["autopilot"].found
    assert not rows.keys() & {"rates", "estimate", "agent dies", "parameters"}


def test_a_px4_planes_circle_that_nothing_ends_fails() -> None:
    rows, _ = checked(Kind.PX4_PLANE)
    assert failing(rows) == {"agent dies"}
    assert "circles" in rows["agent dies"].found
    assert failing(checked(Kind.PX4_PLANE, parameters={"COM_LOW_BAT_ACT": 3})[0]) == set()


def test_a_gimbal_that_keeps_the_failsafe_quiet_is_named() -> None:
    rows, _ = checked(Kind.ARDUCOPTER, parameters=BROUGHT_HOME[Kind.ARDUCOPTER], gimbal=True)
    assert rows["components"].mark is Mark.WARN
    assert rows["agent dies"].mark is Mark.FAIL
    assert "component 154" in rows["agent dies"].found


def test_two_autopilots_with_one_id_are_named() -> None:
    rows, _ = checked(Kind.ARDUCOPTER, parameters=BROUGHT_HOME[Kind.ARDUCOPTER], twin=True)
    assert rows["system id"].mark is Mark.FAIL


def test_two_batteries_are_told_by_id_and_function() -> None:
    rows, _ = checked(Kind.ARDUCOPTER, parameters=BROUGHT_HOME[Kind.ARDUCOPTER], batteries=2)
    assert "id 0 (" in rows["battery"].found
    assert "id 1 (" in rows["battery"].found


@pytest.mark.parametrize(
    ("theirs", "ours", "said"),
    [
        (KEYS[1], None, "its frames are signed and no key is set"),
        (KEYS[1], KEYS[0], "another key"),
        (None, KEYS[0], "frames arrive unsigned while a key is set"),
    ],
    ids=["no key", "wrong key", "unsigned"],
)
def test_signing_is_named_as_the_cause(theirs: Signing | None, ours: Signing | None, said: str) -> None:
    rows, _ = checked(Kind.ARDUCOPTER, parameters=BROUGHT_HOME[Kind.ARDUCOPTER], theirs=theirs, signing=ours)
    assert said in rows["signing"].found
    assert rows["signing"].mark is Mark.FAIL
    assert "system id" not in " ".join(row.remedy for row in rows.values())
    if ours is None:
        assert rows["signing key"].mark is Mark.WARN
        assert rows["rates"].remedy == "see signing"
