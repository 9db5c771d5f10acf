"""What a vehicle does when its agent dies, value by value; a hover that nothing ends is an error."""

from __future__ import annotations

import pytest

from onboard.autopilot.failsafes import Around, findings, stories
from onboard.autopilot.parameters import CHECKED, WANTED, Finding, gcs_failsafe
from onboard.wire.mavlink.modes import Kind

COPTER, PLANE, PX4, PX4_PLANE = Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4_MULTICOPTER, Kind.PX4_PLANE
SAFE: dict[Kind, dict[str, float]] = {
    COPTER: {
        "FS_GCS_ENABLE": 1, "SYSID_MYGCS": 2, "FS_OPTIONS": 0, "FS_GCS_TIMEOUT": 5, "GUID_TIMEOUT": 3,
        "RTL_ALT_FINAL": 0, "FS_THR_ENABLE": 0, "FS_EKF_ACTION": 1, "FENCE_ENABLE": 1, "FENCE_ACTION": 1,
        "ARMING_CHECK": 1, "BATT_MONITOR": 4, "BATT_FS_LOW_ACT": 2, "BATT_LOW_VOLT": 10.5, "BATT_LOW_MAH": 0,
        "BATT_LOW_TIMER": 10, "BATT_FS_CRT_ACT": 1, "BATT_CRT_VOLT": 9.9, "BATT_CRT_MAH": 0,
    },
    PLANE: {
        "FS_GCS_ENABL": 1, "SYSID_MYGCS": 2, "FS_LONG_ACTN": 1, "FS_LONG_TIMEOUT": 5, "RTL_AUTOLAND": 2,
        "THR_FAILSAFE": 1, "FS_SHORT_ACTN": 0, "FENCE_ENABLE": 1, "FENCE_ACTION": 1, "ARMING_CHECK": 1,
        "BATT_MONITOR": 4, "BATT_FS_LOW_ACT": 1, "BATT_LOW_VOLT": 10.5, "BATT_LOW_TIMER": 10,
    },
    PX4: {
        "COM_OF_LOSS_T": 1, "COM_OBL_RC_ACT": 5, "COM_LOW_BAT_ACT": 3, "NAV_RCL_ACT": 2, "COM_RCL_EXCEPT": 4,
        "COM_RC_IN_MODE": 1, "RTL_LAND_DELAY": 0, "GF_ACTION": 2, "COM_RC_OVERRIDE": 3, "COM_ARM_WO_GPS": 1,
    },
}  # fmt: skip
SAFE[PX4_PLANE] = SAFE[PX4]


def told(kind: Kind, change: dict[str, float | None], around: Around | None = None) -> dict[str, Finding]:
    """Stories of a vehicle that is safe but for a change (None: not read)."""
    parameters = {name: value for name, value in {**SAFE[kind], **change}.items() if value is not None}
    return {one.name: one for one in stories(kind, parameters, 2, around or Around())}


@pytest.mark.parametrize("kind", SAFE)
def test_a_safe_vehicle_has_a_sentence_for_each_thing_and_no_error(kind: Kind) -> None:
    found = findings(kind, SAFE[kind], 2)
    assert {one.severity for one in found} == {"info"}
    names = {one.name for one in found}
    assert {"agent dies", "battery low", "transmitter lost", "fence crossed", "arming"} <= names
    assert all("not known" not in one.text for one in found)


@pytest.mark.parametrize("kind", SAFE)
def test_of_what_is_not_known_nothing_is_trusted(kind: Kind) -> None:
    found = {one.name: one for one in findings(kind, {}, 2)}
    assert found["agent dies"].severity == "error"
    assert found["battery low"].severity == "warning"


@pytest.mark.parametrize("kind", [PX4, PX4_PLANE])
@pytest.mark.parametrize(
    ("value", "severity", "words"),
    [
        (0, "error", "Position mode, which needs sticks"),
        (1, "error", "Altitude mode, which needs sticks"),
        (2, "error", "Manual mode, which needs sticks"),
        (3, "info", "returns"),
        (4, "info", "lands"),
        (5, "info", "until its battery is low"),
        (6, "error", "terminates"),
        (7, "error", "disarms"),
        (9, "error", "does not know"),
        (None, "error", "not known"),
    ],
)
def test_each_value_of_px4s_offboard_loss(kind: Kind, value: float | None, severity: str, words: str) -> None:
    found = told(kind, {"COM_OBL_RC_ACT": value})["agent dies"]
    assert (found.severity, words in found.text) == (severity, True), found
    assert found.text.startswith("1 s after the last target it ")


def test_only_position_mode_is_forgiven_where_a_transmitter_is_heard() -> None:
    sticks = Around(sticks=True)
    severities = [told(PX4, {"COM_OBL_RC_ACT": n}, sticks)["agent dies"].severity for n in (0, 1, 2, 6, 7)]
    assert severities == ["warning", "error", "error", "error", "error"]


UNWATCHED: dict[str, float | None] = {"BATT_FS_LOW_ACT": 0, "BATT_FS_CRT_ACT": 0}
TWO: dict[str, float | None] = {"BATT2_MONITOR": 4, "BATT2_LOW_VOLT": 10, "BATT2_FS_LOW_ACT": 2}


@pytest.mark.parametrize(
    ("kind", "change", "ended"),
    [
        (PX4, {"COM_LOW_BAT_ACT": 0}, False),  # as PX4 is delivered
        (PX4, {"COM_LOW_BAT_ACT": None}, False),
        (PX4, {"COM_LOW_BAT_ACT": 2}, True),
        (PX4, {"COM_LOW_BAT_ACT": 1, "RTL_LAND_DELAY": -1}, False),  # returns, and stays over home
        (PX4, {"COM_OBL_RC_ACT": 3, "RTL_LAND_DELAY": -1, "COM_LOW_BAT_ACT": 0}, False),
        (PX4, {"COM_OBL_RC_ACT": 3, "RTL_LAND_DELAY": -1}, True),
        (PX4, {"COM_OBL_RC_ACT": 3, "COM_LOW_BAT_ACT": 0}, True),
        (PX4_PLANE, {"COM_LOW_BAT_ACT": 0}, False),
        (COPTER, {"FS_GCS_ENABLE": 7}, True),  # brakes: the battery's failsafe lands it
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_FS_LOW_ACT": 0, "BATT_FS_CRT_ACT": 0}, False),
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_LOW_VOLT": 0, "BATT_CRT_VOLT": 0}, False),
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_LOW_TIMER": 0}, False),  # voltages never count
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_MONITOR": 0}, False),
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_LOW_VOLT": 0, "BATT_LOW_MAH": 500}, True),
        (COPTER, {"FS_GCS_ENABLE": 7, "BATT_FS_LOW_ACT": 7, "BATT_FS_CRT_ACT": 0}, False),  # brakes again
        (COPTER, {"RTL_ALT_FINAL": 500, "BATT_FS_LOW_ACT": 2, "BATT_FS_CRT_ACT": 2}, False),
        (
            COPTER,
            {"RTL_ALT_FINAL": None, "RTL_ALT_FINAL_M": 5, **UNWATCHED},
            False,
        ),
        (COPTER, {"RTL_ALT_FINAL": 500}, True),  # critical: lands
        (COPTER, {"FS_GCS_ENABLE": 5, "BATT_MONITOR": 0}, True),
    ],
)
def test_a_hover_ends_or_is_an_error(kind: Kind, change: dict[str, float | None], ended: bool) -> None:
    found = told(kind, change)["agent dies"]
    assert ("that nothing ends" in found.text, found.severity == "error") == (not ended, not ended), found


@pytest.mark.parametrize(
    ("change", "around", "severity"),
    [
        ({"FS_OPTIONS": 0}, Around(), "info"),
        ({"FS_OPTIONS": 16}, Around(), "warning"),  # until its battery is low
        ({"FS_OPTIONS": 16, "BATT_FS_LOW_ACT": 0, "BATT_FS_CRT_ACT": 0}, Around(), "error"),
        ({"FS_OPTIONS": None, "BATT_MONITOR": 0}, Around(), "error"),
        ({"FS_OPTIONS": 16, "BATT_MONITOR": 0}, Around(sticks=True), None),  # a pilot holds it in LOITER
    ],
)
def test_a_copter_held_in_brake_is_brought_home(
    change: dict[str, float | None], around: Around, severity: str | None
) -> None:
    found = told(COPTER, change, around).get("agent dies in hold")
    assert (None if found is None else found.severity) == severity


@pytest.mark.parametrize(
    ("kind", "change", "around", "words"),
    [
        (COPTER, {"FS_GCS_ENABLE": 0}, Around(), "no GCS failsafe"),
        (COPTER, {"SYSID_MYGCS": 255}, Around(), "does not watch this agent"),
        (COPTER, {"SYSID_MYGCS": None}, Around(), "not known"),
        (COPTER, {"SYSID_MYGCS": None, "MAV_GCS_SYSID": 255}, Around(), "MAV_GCS_SYSID is 255"),
        (COPTER, {"SYSID_MYGCS": None, "MAV_GCS_SYSID": 2, "MAV_GCS_SYSID_HI": 255}, Around(), "2 to 255"),
        (COPTER, {}, Around(beating=(154,)), "component 154 beats"),
        (PLANE, {}, Around(beating=(154,)), "component 154 beats"),
        (PLANE, {"FS_GCS_ENABL": 0}, Around(), "no GCS failsafe"),
        (PLANE, {"FS_GCS_ENABL": 3}, Around(), "but in AUTO"),
        (PLANE, {"FS_LONG_ACTN": 0}, Around(), "flies on"),
        (PLANE, {"FS_LONG_ACTN": 2}, Around(), "glides down"),
        (PLANE, {"FS_LONG_ACTN": None}, Around(), "not known"),
    ],
)
def test_a_failsafe_that_does_not_act_is_an_error_with_its_cause(
    kind: Kind, change: dict[str, float | None], around: Around, words: str
) -> None:
    found = told(kind, change, around)["agent dies"]
    assert (found.severity, words in found.text) == ("error", True), found
    assert found.remedy


@pytest.mark.parametrize(
    ("kind", "change", "name", "severity", "words"),
    [
        (COPTER, {"BATT_FS_LOW_ACT": 5}, "battery low", "error", "falls"),
        (COPTER, {"BATT2_MONITOR": 4}, "battery low", "warning", "nothing watches BATT2"),
        (COPTER, TWO, "battery low", "info", "10 V"),
        (COPTER, {"BATT_LOW_VOLT": 0, "BATT_CRT_VOLT": 0}, "battery low", "warning", "BATT_LOW_VOLT 0"),
        (COPTER, {"FS_THR_ENABLE": 1}, "transmitter lost", "info", "returns"),
        (COPTER, {"FS_THR_ENABLE": 1, "FS_OPTIONS": 4}, "transmitter lost", "info", "flies on"),
        (COPTER, {"FS_EKF_ACTION": 2}, "position lost", "error", "ALT_HOLD"),
        (COPTER, {"FENCE_ACTION": 0}, "fence crossed", "warning", "only reports"),
        (COPTER, {"FENCE_ENABLE": 0}, "fence crossed", "warning", "off"),
        (COPTER, {"ARMING_CHECK": 0}, "arming", "warning", "without all checks"),
        (COPTER, {"ARMING_CHECK": None, "ARMING_SKIPCHK": 0}, "arming", "info", "after all"),
        (COPTER, {"ARMING_CHECK": None, "ARMING_SKIPCHK": 64}, "arming", "warning", "SKIPCHK 64"),
        (PLANE, {"ARMING_REQUIRE": 0}, "arming", "warning", "armed from the start"),
        (PLANE, {"RTL_AUTOLAND": 0}, "agent dies", "warning", "until a person lands it"),
        (PLANE, {"BATT_FS_LOW_ACT": 3}, "battery low", "error", "falls"),
        (PX4, {"NAV_RCL_ACT": 6}, "transmitter lost", "error", "disarms"),
        (PX4, {"COM_RC_IN_MODE": 4}, "transmitter lost", "info", "none is used"),
        (PX4, {"COM_RC_OVERRIDE": 1}, "transmitter lost", "info", "do not take it out of OFFBOARD"),
        (PX4, {"COM_RC_OVERRIDE": None, "MAN_OVERRIDE_SPD": 5}, "transmitter lost", "info", "flies on"),
        (PX4, {"GF_ACTION": 4}, "fence crossed", "error", "falls"),
        (PX4, {"GF_ACTION": 0}, "fence crossed", "warning", "does nothing"),
        (PX4, {"COM_LOW_BAT_ACT": 0}, "battery low", "warning", "only warns"),
        (PX4, {"COM_ARM_WO_GPS": 2}, "arming", "warning", "without GPS"),
    ],
)  # fmt: skip
def test_each_thing_that_may_happen_has_its_sentence(
    kind: Kind, change: dict[str, float | None], name: str, severity: str, words: str
) -> None:
    found = told(kind, change)[name]
    assert (found.severity, words in found.text) == (severity, True), found


def test_a_watched_range_of_one_is_the_agents() -> None:
    newer: dict[str, float] = {"FS_GCS_ENABLE": 1, "MAV_GCS_SYSID": 2, "MAV_GCS_SYSID_HI": 0}
    assert gcs_failsafe(COPTER, newer, 2) is None
    assert gcs_failsafe(COPTER, {**newer, "MAV_GCS_SYSID_HI": 2}, 2) is None


@pytest.mark.parametrize("kind", SAFE)
def test_every_parameter_of_a_story_is_read(kind: Kind) -> None:
    assert SAFE[kind].keys() <= {*WANTED.get(kind, ()), *CHECKED[kind]}
    assert all(len(name) <= 16 for name in CHECKED[kind])  # MAVLink's longest name
