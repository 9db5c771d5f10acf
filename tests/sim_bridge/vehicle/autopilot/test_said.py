"""What streams is told as bare values: another program reads the same fields from the frames."""

from __future__ import annotations

from math import degrees, hypot

import pytest

from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.health import Fault
from tests.support.flown_autopilot import FlownAutopilot


def read(flown: FlownAutopilot, number: int) -> MavMessage:
    """The message as pymavlink's own parser has it."""
    told = telemetry.build(flown.autopilot, number, flown.now_ns)
    assert told is not None
    frame = DialectSender(1, 1).pack(told)
    message: MavMessage = dialect.MAVLink(None).decode(bytearray(frame))
    return message


@pytest.mark.parametrize("kind", [Kind.ARDUPLANE, Kind.ARDUCOPTER])
def test_another_program_reads_where_the_vehicle_is_and_how_it_flies(kind: Kind) -> None:
    flown = FlownAutopilot(kind).forward(3.0)
    pilot = flown.autopilot
    m, place = pilot.motion, pilot.place
    attitude = read(flown, dialect.MAVLINK_MSG_ID_ATTITUDE)
    assert (attitude.time_boot_ms, attitude.yawspeed) == (3000, pytest.approx(m.rates.z, abs=1e-6))
    assert (attitude.roll, attitude.pitch, attitude.yaw) == pytest.approx((m.roll, m.pitch, m.yaw), abs=1e-6)
    where = read(flown, dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT)
    assert (where.lat * 1e-7, where.lon * 1e-7) == pytest.approx(place[:2], abs=1e-7)
    assert (where.alt, where.relative_alt) == pytest.approx((place[2] * 1e3, pilot.height * 1e3), abs=1.0)
    assert (where.vx, where.vy, where.vz) == pytest.approx([100.0 * v for v in m.velocity], abs=0.6)
    assert where.hdg == pytest.approx(degrees(m.yaw) * 100.0 % 36000, abs=0.6)
    hud = read(flown, dialect.MAVLINK_MSG_ID_VFR_HUD)
    assert (hud.airspeed, hud.climb) == pytest.approx((m.airspeed, -m.velocity.z), abs=1e-5)
    assert (hud.groundspeed, hud.alt) == pytest.approx((hypot(*m.velocity[:2]), place[2]), rel=1e-6, abs=1e-5)
    assert (hud.throttle, hud.heading) == (50, round(degrees(m.yaw)) % 360)


def test_another_program_reads_a_fix_and_its_loss() -> None:
    flown = FlownAutopilot(Kind.ARDUCOPTER).forward(1.0)
    fix = read(flown, dialect.MAVLINK_MSG_ID_GPS_RAW_INT)
    assert (fix.fix_type, fix.satellites_visible, fix.time_usec) == (3, 10, 1_000_000)
    assert (fix.eph, fix.epv) == (121, 200)
    assert fix.lat * 1e-7 == pytest.approx(flown.autopilot.place.latitude_deg, abs=1e-7)
    assert read(flown, dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT).velocity_variance == pytest.approx(0.05)
    flown.autopilot.fail(Fault.GPS)
    lost = read(flown, dialect.MAVLINK_MSG_ID_GPS_RAW_INT)
    assert (lost.fix_type, lost.satellites_visible, lost.lat, lost.lon, lost.alt) == (1, 0, 0, 0, 0)
    assert {lost.eph, lost.epv, lost.vel, lost.cog} == {65535}
    report = read(flown, dialect.MAVLINK_MSG_ID_EKF_STATUS_REPORT)
    assert report.velocity_variance == pytest.approx(1.5)
    assert not report.flags & dialect.EKF_POS_HORIZ_ABS
