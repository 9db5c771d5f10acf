"""PX4 and ArduCopter by velocity targets, as stories."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import inf, nan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.autopilot.base import ReleaseMode, Setpoint, Stage
from onboard.autopilot.guided import GuidedAdapter
from onboard.autopilot.velocity import VelocityEncoder
from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.mavlink.commands import CommandLong, Target, VelocityTarget
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck
from tests.onboard.autopilot.scripted import Scripted

EAST = Setpoint(Vec(0.0, 5.0, 0.0))
HOVER = Setpoint(ZERO)


def px4() -> Scripted:
    encoder = VelocityEncoder(Kind.PX4_MULTICOPTER, Target(1))
    return Scripted(Kind.PX4_MULTICOPTER, GuidedAdapter(Target(1), encoder), "HOLD")


def copter(*, may_arm: bool = False, hold_mode: str = "") -> Scripted:
    encoder = VelocityEncoder(Kind.ARDUCOPTER, Target(1), hold_mode)
    return Scripted(Kind.ARDUCOPTER, GuidedAdapter(Target(1), encoder, may_arm=may_arm), "LOITER")


def test_px4_sees_a_second_of_setpoints_before_it_is_asked_for_offboard() -> None:
    play = px4()
    play.adapter.enter(play.now)
    play.fly(2.0, None)
    assert play.sent == []  # no stream, no request
    begin = play.now
    play.fly(2.5, HOVER)
    asked = next(at for at, message in play.sent if isinstance(message, CommandLong))
    targets = [at for at, message in play.sent if isinstance(message, VelocityTarget) and at < asked]
    assert 1.0 <= asked - begin <= 1.5
    assert len(targets) >= 20
    assert play.adapter.stage is Stage.ACTIVE
    assert play.telemetry.mode == "OFFBOARD"


def test_px4_targets_are_as_mavsdk_sends_them() -> None:
    play = px4()
    play.adapter.enter(play.now)
    play.fly(2.0, HOVER)
    message = play.fly(4.0, EAST)[-1]
    assert isinstance(message, VelocityTarget)
    assert message.to == Target(1)
    assert message.velocity == pytest.approx((0.0, 5.0, 0.0))
    assert message.yaw == pytest.approx(1.5708, abs=1e-3)


def test_arducopter_gets_no_target_before_guided_and_the_right_mask_in_it() -> None:
    play = copter()
    assert play.fly(1.0, EAST) == []
    play.adapter.enter(play.now)
    first = play.fly(0.2, EAST)
    assert isinstance(first[0], CommandLong)
    sent = play.fly(3.0, EAST)
    assert {type(message) for message in sent} == {VelocityTarget}
    assert len(sent) == 60
    assert (sent[-1].yaw, sent[-1].velocity.y) == (None, 5.0)


def test_a_setpoint_goes_out_as_the_supervisor_let_it_pass() -> None:
    play = copter()
    play.adapter.enter(play.now)
    play.fly(3.0, EAST)
    turned = play.fly(0.05, Setpoint(Vec(1.0, -9.0, 3.0), Vec(0.5, 0.0, 0.0)))
    assert [message.velocity for message in turned] == [Vec(1.5, -9.0, 3.0)]


def test_the_command_is_repeated_until_the_heartbeat_says_so_but_never_faster_than_80_ms() -> None:
    play = copter()
    play.deaf = True
    play.adapter.enter(play.now)
    play.fly(5.0, None)
    times = [at for at, message in play.sent if message.command == 176]
    gaps = [b - a for a, b in pairwise(times)]
    assert min(gaps) >= 0.08
    assert len([at for at in times if at - times[0] < 2.0]) == 5  # on a sound link the wait doubles
    assert play.kinds() == ["mode_unconfirmed"]
    play.deaf = False
    play.fly(1.0, None)
    assert play.adapter.stage is Stage.ACTIVE


def test_on_a_link_that_loses_frames_a_mode_is_asked_for_every_80_ms() -> None:
    play = copter()
    play.deaf = True
    play.telemetry = play.telemetry._replace(link_quality=0.8)
    play.fly(0.05, None)
    play.adapter.enter(play.now)
    play.fly(2.0, None)
    times = [at for at, message in play.sent if message.command == 176]
    assert len(times) >= 19  # every second step of 50 ms


def test_a_repeated_command_says_how_often_it_was_sent_before_and_a_new_one_begins_at_0() -> None:
    play = copter(may_arm=True)
    play.deaf = True
    play.adapter.enter(play.now)
    play.adapter.arm(play.now)
    play.fly(60.0, None)
    play.adapter.leave(play.now, ReleaseMode.RETURN)
    play.fly(1.5, None)
    commands = [m for _, m in play.sent if isinstance(m, CommandLong)]
    modes = [m.confirmation for m in commands if m.command == 176]
    arming = [m.confirmation for m in commands if m.command == 400]
    assert modes[-5:] == [0, 1, 2, 3, 4]
    assert modes[:-5] == list(range(len(modes) - 5))
    assert arming == list(range(len(arming)))


def test_a_refusal_is_told_once_and_tried_again() -> None:
    play = copter()
    play.result = 4
    play.adapter.enter(play.now)
    play.fly(5.0, None)
    assert play.kinds() == ["mode_refused"]
    assert 4 <= len(play.sent) <= 6
    play.result = 0
    play.fly(1.5, None)
    assert play.adapter.stage is Stage.ACTIVE


@pytest.mark.parametrize("make", [px4, copter])
def test_a_pilot_takes_over_and_the_stream_ends_at_once(make: Callable[[], Scripted]) -> None:
    play = make()
    play.adapter.enter(play.now)
    play.fly(3.0, EAST)
    play.beat("POSCTL" if play.kind is Kind.PX4_MULTICOPTER else "STABILIZE")
    assert play.fly(20.0, EAST) == []
    assert play.adapter.stage is Stage.TAKEN
    assert play.kinds()[-1] == "take_over"
    assert "hands off" in play.notes[-1].text


def test_the_pilot_hands_back_by_choosing_guided_again() -> None:
    play = copter()
    play.adapter.enter(play.now)
    play.fly(2.0, EAST)
    play.beat("LOITER", channels=(1500, 1500, 1500, 1500, 1100), channels_at=play.now)
    play.fly(3.0, EAST)
    play.beat("GUIDED")
    play.fly(0.4, EAST)
    play.telemetry = play.telemetry._replace(channels=(1500, 1500, 1500, 1500, 1900), channels_at=play.now)
    play.fly(0.1, EAST)
    assert play.adapter.stage is Stage.TAKEN  # one heartbeat may be an old one that came late
    play.fly(1.5, EAST)
    assert play.adapter.stage is Stage.ACTIVE
    assert play.kinds()[-1] == "handed_back"


def test_a_pilot_who_changes_the_mode_while_we_ask_is_obeyed() -> None:
    play = copter()
    play.deaf = True
    play.adapter.enter(play.now)
    play.fly(0.5, None)
    play.beat("ALT_HOLD")
    assert play.fly(3.0, EAST) == []
    assert play.adapter.stage is Stage.TAKEN


@pytest.mark.parametrize(
    ("way", "px4_mode", "copter_mode"),
    [
        (ReleaseMode.HOLD, "HOLD", "BRAKE"),
        (ReleaseMode.RETURN, "RTL", "RTL"),
        (ReleaseMode.LAND, "LAND", "LAND"),
    ],
)
def test_leaving_ends_the_targets_and_hands_to_a_mode_the_autopilot_holds_alone(
    way: ReleaseMode, px4_mode: str, copter_mode: str
) -> None:
    for play, mode in ((px4(), px4_mode), (copter(), copter_mode)):
        play.adapter.enter(play.now)
        play.fly(3.0, EAST)
        play.adapter.leave(play.now, way)
        sent = play.fly(3.0, EAST)
        assert [type(message) for message in sent] == [CommandLong]
        assert play.telemetry.mode == mode
        assert play.adapter.stage is Stage.LEFT


def test_hold_by_brake_where_there_is_no_transmitter() -> None:
    play = copter(hold_mode="BRAKE")
    play.adapter.enter(play.now)
    play.fly(1.0, EAST)
    play.adapter.leave(play.now, ReleaseMode.HOLD)
    play.fly(1.0, None)
    assert play.telemetry.mode == "BRAKE"


def test_return_after_hold_is_asked_for_too() -> None:
    play = copter()
    play.adapter.enter(play.now)
    play.fly(1.0, EAST)
    play.adapter.leave(play.now, ReleaseMode.HOLD)
    play.fly(1.0, None)
    play.adapter.leave(play.now, ReleaseMode.RETURN)
    play.fly(1.0, None)
    assert play.telemetry.mode == "RTL"
    assert play.adapter.stage is Stage.LEFT


def test_it_never_arms_unless_told() -> None:
    play = copter()
    assert play.adapter.arm(play.now) is False
    play.adapter.enter(play.now)
    play.fly(3.0, EAST)
    commands = [message.command for _, message in play.sent if isinstance(message, CommandLong)]
    assert commands == [176]
    allowed = copter(may_arm=True)
    allowed.result = 4  # refused for a while although the pre-arm bit is set
    assert allowed.adapter.arm(allowed.now)
    allowed.fly(6.0, None)
    assert allowed.kinds() == ["arming_refused"]
    assert len(allowed.sent) == 3
    allowed.result = 0
    allowed.fly(3.0, None)
    assert allowed.telemetry.armed
    assert allowed.kinds()[-1] == "armed"


def test_an_answer_to_somebody_else_changes_nothing() -> None:
    play = copter()
    play.deaf = True
    play.adapter.enter(play.now)
    play.fly(0.1, None)
    play.adapter.acknowledge(play.now, CommandAck(176, 0, 255, 190))
    assert len(play.fly(1.0, None)) >= 5  # it is asked for on


def test_an_autopilot_that_starts_again_is_no_pilot() -> None:
    play = copter()
    play.adapter.enter(play.now)
    play.fly(2.0, EAST)
    play.beat("STABILIZE", reboots=1)
    assert play.fly(2.0, EAST) == []
    assert play.adapter.stage is Stage.IDLE
    assert play.kinds()[-1] == "reboot"
    play.adapter.enter(play.now)
    play.fly(2.0, EAST)
    assert play.adapter.stage is Stage.ACTIVE


def test_no_setpoint_means_silence() -> None:
    play = px4()
    play.adapter.enter(play.now)
    play.fly(3.0, EAST)
    play.adapter.end(play.now)
    assert play.fly(5.0, None) == []


anything = st.floats(allow_nan=True, allow_infinity=True)


@settings(max_examples=200, deadline=None)
@given(anything, anything, anything, anything)
def test_whatever_comes_a_target_is_what_was_asked_for_and_fits_a_frame(
    x: float, y: float, z: float, w: float
) -> None:
    play, sender = copter(), Sender(1, 191)
    play.adapter.enter(play.now)
    play.fly(0.2, None)
    for message in play.fly(0.3, Setpoint(Vec(x, y, z), Vec(w, 0.0, 0.0))):
        assert message.velocity == Vec(x + w, y, z)
        assert sender.pack(message)


def test_a_setpoint_that_is_no_number_is_told() -> None:
    play = copter()
    play.adapter.enter(play.now)
    play.fly(0.2, None)
    assert play.fly(1.0, Setpoint(Vec(nan, inf, 0.0))) == []
    assert play.kinds().count("not_finite") == 1
