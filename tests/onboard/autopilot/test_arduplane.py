"""ArduPlane: roll at 20 Hz, altitude and speed on change, never a velocity."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import atan2, degrees, inf, nan, pi, radians, sin, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.autopilot.arduplane import ArduPlaneEncoder
from onboard.autopilot.base import ReleaseMode, Setpoint, Stage
from onboard.autopilot.guided import GuidedAdapter
from onboard.core.guidance.plane import bank_for
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import ZERO, Vec, direction, norm, scale
from onboard.wire.mavlink.commands import CommandInt, CommandLong, RollTarget, Target
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.modes import Kind
from tests.onboard.autopilot.scripted import DT, Plane, Scripted

BANK_MAX = radians(45)


def adapter(*, plain: bool = False) -> GuidedAdapter:
    return GuidedAdapter(Target(1), ArduPlaneEncoder(Target(1), BANK_MAX, plain=plain))


def plane(wind: Vec = ZERO, *, plain: bool = False) -> Plane:
    return Plane(adapter(plain=plain), wind)


def fly(play: Plane, seconds: float, wanted: Vec | Callable[[float], Vec]) -> list[tuple[Vec, Vec]]:
    """(wanted air velocity, velocity over ground) at each step."""
    path = []
    for _ in range(round(seconds / DT)):
        air = wanted(play.now) if callable(wanted) else wanted
        play.fly(DT, Setpoint(air, play.wind))
        play.move()
        path.append((air, play.telemetry.velocity))
    return path


def test_it_never_sends_a_plane_a_velocity_target() -> None:
    for plain in (False, True):
        play = plane(plain=plain)
        fly(play, 5.0, Vec(20.0, 0.0, -1.0))
        play.adapter.leave(play.now, ReleaseMode.HOLD)
        play.fly(2.0, Setpoint(Vec(20.0, 0.0, 0.0)))
        play.adapter.enter(play.now)
        play.fly(2.0, Setpoint(Vec(20.0, 0.0, 0.0)))
        kinds = {type(message) for _, message in play.sent}
        assert RollTarget in kinds or plain
        assert kinds <= {RollTarget, CommandInt, CommandLong}


def test_roll_at_20_hz_altitude_and_speed_at_most_twice_a_second() -> None:
    play = plane()
    fly(play, 20.0, lambda now: scale(direction(0.1 * sin(now), 0.3 * now), 20.0 + 3.0 * sin(now)))
    rolls = [at for at, message in play.sent if isinstance(message, RollTarget)]
    assert len(rolls) == 400
    for command in (43000, 43001):
        times = [at for at, m in play.sent if isinstance(m, CommandInt) and m.command == command]
        assert min(b - a for a, b in pairwise(times)) >= 0.5 - 1e-9
        assert len(times) > 20


def test_what_does_not_change_is_said_once_in_three_seconds() -> None:
    play = plane()
    fly(play, 10.0, Vec(22.0, 0.0, 0.0))
    before = len(play.sent)
    fly(play, 12.0, Vec(22.0, 0.0, 0.0))
    slow = [m.command for _, m in play.sent[before:] if isinstance(m, CommandInt)]
    assert sorted(set(slow)) == [43000, 43001]
    assert len(slow) <= 10


def test_a_lost_command_is_said_again_until_it_is_acknowledged() -> None:
    play = plane()
    fly(play, 5.0, Vec(20.0, 0.0, 0.0))
    play.deaf = True
    before = len(play.sent)
    fly(play, 4.0, Vec(26.0, 0.0, 0.0))
    speeds = [m.params[1] for _, m in play.sent[before:] if isinstance(m, CommandInt) and m.command == 43000]
    assert len(speeds) >= 7
    assert set(speeds) == {26.0}


@pytest.mark.parametrize("wind", [ZERO, Vec(0.0, 8.0, 0.0), Vec(-6.0, 5.0, 0.0)])
def test_it_follows_a_course_that_swings_by_70_degrees_in_wind(wind: Vec) -> None:
    """The measured scheme on a real ArduPlane: course 9.8° RMS, climb 0.68 m/s, airspeed 0.67 m/s."""
    play = plane(wind)

    def wanted(now: float) -> Vec:
        yaw = radians(70.0) * sin(2 * pi * now / 40.0)
        climb = 2.0 * sin(2 * pi * now / 30.0)
        level = 22.0 + 2.0 * sin(2 * pi * now / 25.0)
        return Vec(level * direction(0, yaw).x, level * direction(0, yaw).y, -climb)

    path = fly(play, 120.0, wanted)[400:]
    course = [
        wrap(atan2(air.y + wind.y, air.x + wind.x) - atan2(ground.y, ground.x)) for air, ground in path
    ]
    climb = [air.z - ground.z for air, ground in path]
    assert degrees(sqrt(sum(e * e for e in course) / len(course))) < 13.0
    assert sqrt(sum(e * e for e in climb) / len(climb)) < 1.0


def test_level_flight_stays_level() -> None:
    play = plane(Vec(3.0, 3.0, 0.0))
    fly(play, 60.0, Vec(0.0, 22.0, 0.0))
    assert play.telemetry.altitude_m == pytest.approx(600.0, abs=1.0)


def test_a_right_turn_is_a_right_bank_and_the_limit_holds() -> None:
    north = Vec(22.0, 0.0, 0.0)
    assert bank_for(radians(10), north, 0.0, radians(45)) > 0
    assert bank_for(radians(-10), north, 0.0, radians(45)) < 0
    assert bank_for(radians(179), north, 0.0, radians(45)) == radians(45)
    assert bank_for(radians(-179), north, 0.0, radians(45)) == -radians(45)
    assert bank_for(radians(30), ZERO, radians(30), radians(45)) == 0.0  # no way over ground: the nose counts


def test_to_end_changes_no_mode_that_is_the_supervisors() -> None:
    play = plane()
    fly(play, 3.0, Vec(22.0, 0.0, 0.0))
    play.adapter.end(play.now)
    assert play.fly(3.0, None) == []
    assert play.adapter.stage is Stage.ACTIVE


def test_pilot_takes_over() -> None:
    play = plane()
    fly(play, 3.0, Vec(22.0, 0.0, 0.0))
    play.beat("FBWA")
    assert play.fly(5.0, Setpoint(Vec(22.0, 0.0, 0.0))) == []
    assert play.adapter.stage is Stage.TAKEN
    play.adapter.end(play.now)  # a stalled strategy must not take it from the pilot
    assert play.fly(5.0, None) == []


def test_a_refused_setpoint_is_told_once() -> None:
    play = plane()
    play.result = 2
    fly(play, 5.0, Vec(22.0, 0.0, 0.0))
    assert [note.text for note in play.notes if note.kind == "setpoint_refused"] == [
        "altitude refused: result 2",
        "airspeed refused: result 2",
    ]


def test_the_plain_variant_commands_a_course_below_360() -> None:
    play = plane(plain=True)
    fly(play, 10.0, lambda now: direction(0.0, -0.2 * now))
    courses = [m for _, m in play.sent if isinstance(m, CommandInt) and m.command == 43002]
    assert len(courses) > 50
    assert all(0.0 <= m.params[1] < 360.0 and m.params[0] == 0.0 for m in courses)


anything = st.floats(allow_nan=True, allow_infinity=True)


@settings(max_examples=200, deadline=None)
@given(anything, anything, anything, st.floats(-30, 30), st.floats(-3.2, 3.2))
def test_whatever_comes_the_bank_keeps_its_limit_and_the_rest_is_what_was_asked_for(
    x: float, y: float, z: float, w: float, yaw: float
) -> None:
    play, sender = plane(Vec(w, -w, 0.0)), Sender(1, 191)
    play.telemetry = play.telemetry._replace(yaw=yaw, velocity=direction(0.0, yaw))
    for message in play.fly(1.1, Setpoint(Vec(x, y, z), play.wind)):
        assert sender.pack(message)
        if isinstance(message, RollTarget):
            assert abs(message.roll) <= BANK_MAX + 1e-9
        elif message.command == 43000:
            assert message.params[1] == norm(Vec(x, y, z))
        elif message.command == 43001:  # the reference may drift by 8 m, the climb leads by 3.3 s
            assert abs(message.z - 600.0) <= (8.0 + abs(z) * 3.3) * (1.0 + 1e-6)


def test_a_setpoint_that_is_no_number_is_not_sent() -> None:
    play = plane()
    play.fly(0.2, None)
    assert play.fly(1.0, Setpoint(Vec(nan, inf, 0.0))) == []
    assert play.fly(1.0, Setpoint(ZERO)) == []
    assert play.kinds()[-2:] == ["not_finite", "no_direction"]


def test_entering_takes_the_mode_and_waits_for_the_heartbeat() -> None:
    play = Scripted(Kind.ARDUPLANE, adapter(), "AUTO")
    play.adapter.enter(play.now)
    sent = play.fly(1.0, Setpoint(Vec(22.0, 0.0, 0.0)))
    assert sent[0].command == 176
    assert play.adapter.stage is Stage.ACTIVE
    assert norm(play.telemetry.velocity) == 0.0
