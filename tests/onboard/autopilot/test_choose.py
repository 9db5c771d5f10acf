"""The adapter that fits the heartbeat, or a refusal that says why."""

from __future__ import annotations

import pytest

from onboard.autopilot.base import Refusal
from onboard.autopilot.choose import AdapterOptions, adapter_for
from onboard.autopilot.parameters import gcs_failsafe
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.telemetry import decode
from onboard.wire.mavlink.values import Heartbeat

WATCHED = {"FS_GCS_ENABL": 1.0, "SYSID_MYGCS": 2.0, "FS_LONG_ACTN": 1.0}


def heartbeat(autopilot: int, vehicle: int) -> Heartbeat:
    value = decode(dialect.MAVLink_heartbeat_message(vehicle, autopilot, 0, 0, 4, 3))
    assert isinstance(value, Heartbeat)
    return value


@pytest.mark.parametrize(
    ("autopilot", "vehicle", "name", "mode", "airspeed"),
    [
        (12, 2, "velocity", "OFFBOARD", False),
        (3, 2, "velocity", "GUIDED", False),
        (3, 1, "arduplane", "GUIDED", True),
    ],
)
def test_each_autopilot_gets_its_own(
    autopilot: int, vehicle: int, name: str, mode: str, airspeed: bool
) -> None:
    adapter = adapter_for(heartbeat(autopilot, vehicle), Target(2))
    assert not isinstance(adapter, Refusal)
    assert (adapter.name, adapter.guided_mode, adapter.holds_airspeed) == (name, mode, airspeed)


@pytest.mark.parametrize(
    ("autopilot", "vehicle", "scheme", "reason"),
    [
        (12, 1, "velocity", "PX4 fixed wing cannot be flown by velocity: expected auto, px4-plane"),
        (12, 22, "auto", "PX4 VTOL"),
        (3, 22, "auto", "ArduPlane VTOL"),
        (3, 10, "auto", "unknown autopilot (autopilot 3, vehicle type 10)"),
        (8, 6, "auto", "unknown autopilot"),
        (3, 1, "velocity", "ArduPlane cannot be flown by velocity: expected auto, arduplane, ardu"),
        (12, 2, "arduplane", "PX4 multicopter cannot be flown by arduplane"),
        (3, 1, "mavsdk", "ArduPlane cannot be flown by mavsdk"),
        (3, 2, "mavsdk", "mavsdk needs a connection of its own"),
        (3, 2, "teleport", "ArduCopter cannot be flown by teleport"),
    ],
)
def test_what_cannot_be_flown_is_refused_with_the_reason(
    autopilot: int, vehicle: int, scheme: str, reason: str
) -> None:
    refusal = adapter_for(heartbeat(autopilot, vehicle), Target(2), AdapterOptions(scheme))
    assert isinstance(refusal, Refusal)
    assert reason in refusal.reason


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"FS_GCS_ENABL": None}, "FS_GCS_ENABL is not known"),
        ({"FS_GCS_ENABL": 0.0}, "no GCS failsafe"),
        ({"SYSID_MYGCS": 255.0}, "SYSID_MYGCS is 255: the failsafe does not watch this agent"),
        ({"FS_LONG_ACTN": 0.0}, "in GUIDED the plane flies on"),
    ],
)
def test_the_plain_variant_needs_a_failsafe_that_watches_the_agent(
    change: dict[str, float | None], reason: str
) -> None:
    plane = heartbeat(3, 1)
    good = adapter_for(plane, Target(2), AdapterOptions("arduplane-plain"), WATCHED)
    assert not isinstance(good, Refusal)
    assert good.name == "arduplane-plain"
    parameters = {k: v for k, v in {**WATCHED, **change}.items() if v is not None}
    refusal = adapter_for(plane, Target(2), AdapterOptions("arduplane-plain"), parameters)
    assert isinstance(refusal, Refusal)
    assert reason in refusal.reason


@pytest.mark.parametrize(
    ("hold_mode", "autopilot", "flown"),
    [("BRAKE", 3, True), ("BREAK", 3, False), ("GUIDED", 3, False), ("BRAKE", 12, False), ("HOLD", 12, True)],
)
def test_a_mode_to_hold_in_that_the_autopilot_does_not_have_is_refused(
    hold_mode: str, autopilot: int, flown: bool
) -> None:
    found = adapter_for(heartbeat(autopilot, 2), Target(2), AdapterOptions(hold_mode=hold_mode))
    assert isinstance(found, Refusal) != flown
    if isinstance(found, Refusal):
        assert f"hold_mode '{hold_mode}' is no mode" in found.reason
        assert "expected one of" in found.reason


def test_parameters_that_defeat_a_failsafe_are_found() -> None:
    assert gcs_failsafe(Kind.ARDUPLANE, WATCHED, 2) is None
    assert gcs_failsafe(Kind.PX4_MULTICOPTER, {}, 2) is None  # it watches the targets themselves
