"""PX4's fixed wing: the point ahead lies where the course leads, and a refused course command is let go."""

from __future__ import annotations

from math import degrees, pi

import pymap3d
import pytest

from onboard.autopilot.base import Setpoint, Stage, Telemetry
from onboard.autopilot.px4_plane import Px4PlaneEncoder
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.commands import CommandInt, PlaceTarget, Target
from onboard.wire.mavlink.ids import CommandId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

HERE = Telemetry(
    kind=Kind.PX4_PLANE, mode="OFFBOARD", latitude_deg=47.4, longitude_deg=8.5, altitude_m=600.0,
    position_at=0.0, velocity=Vec(15.0, 0.0, 0.0),
)  # fmt: skip
EASTWARD = Setpoint(Vec(-4.0, 15.0, -1.0), Vec(4.0, 0.0, 0.0))  # the wind makes the course due east


def targets(encoder: Px4PlaneEncoder, seconds: float, start: float = 0.0) -> list[PlaceTarget | CommandInt]:
    """What is sent in so many seconds at 20 Hz."""
    sent = []
    for step in range(round(20.0 * seconds)):
        sent += encoder.encode(start + 0.05 * step, HERE, EASTWARD)
    return sent  # type: ignore[return-value]


def test_the_point_lies_300_m_ahead_along_the_course_over_ground() -> None:
    encoder = Px4PlaneEncoder(Target(3))
    for target in targets(encoder, 1.0):
        assert isinstance(target, PlaceTarget)
        azimuth, _, way = pymap3d.geodetic2aer(
            target.latitude_deg, target.longitude_deg, 600.0, 47.4, 8.5, 600.0
        )
        assert float(way) == pytest.approx(300.0, abs=0.5)
        assert abs(wrap(azimuth * pi / 180.0 - pi / 2)) < 0.001
        assert 600.0 < target.altitude_m < 609.0  # a climb leads up, and no farther than it drifts


def test_offboard_is_asked_for_after_a_second_of_targets_and_none_goes_out_unasked() -> None:
    encoder = Px4PlaneEncoder(Target(3))
    assert not encoder.ready(0.0)
    assert len(targets(encoder, 1.3)) == 26
    assert encoder.ready(1.3)
    assert {stage for stage in Stage if encoder.sends_in(stage)} == {Stage.ENTERING, Stage.ACTIVE}
    assert encoder.fault(Setpoint(Vec(0.0, 0.0, 0.0))) == "no_direction"


@pytest.mark.parametrize("result", [2, 3], ids=("denied", "unsupported"))
def test_the_course_command_is_an_option_and_gives_way_where_it_is_refused(result: int) -> None:
    assert not [m for m in targets(Px4PlaneEncoder(Target(3)), 2.0) if isinstance(m, CommandInt)]
    encoder = Px4PlaneEncoder(Target(3), course=True)
    courses = [m for m in targets(encoder, 2.0) if isinstance(m, CommandInt)]
    assert {m.command for m in courses} == {CommandId.CHANGE_HEADING}
    assert 2 <= len(courses) <= 3, "the same course is said again once a second"
    assert courses[0].params[1] == pytest.approx(degrees(pi / 2), abs=0.02)
    notes = encoder.acknowledge(CommandAck(CommandId.CHANGE_HEADING, result, 3, 191))
    assert [note.kind for note in notes] == ["course_refused"]
    assert encoder.acknowledge(CommandAck(CommandId.CHANGE_HEADING, result, 3, 191)) == [], "told once"
    later = targets(encoder, 2.0, 10.0)
    assert len(later) == 40
    assert all(isinstance(m, PlaceTarget) for m in later)
