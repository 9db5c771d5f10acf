"""Each behaviour of the simulated autopilots beside the recording that holds it: the same events, the same
end.

The excerpts are cut from flights of real ArduCopter and ArduPlane 4.5.6 and PX4 1.16.0, software in the
loop. Behaviours that no recording holds are listed as such in docs/personalities.md.
"""

from __future__ import annotations

from itertools import pairwise
from statistics import median
from typing import Any

import numpy as np
import pytest

from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.modes import ARDUCOPTER_MODES as COPTER
from onboard.wire.mavlink.modes import PX4_MODES as PX4
from sim_bridge.vehicle.autopilot.health import Fault
from tests.support.flown_autopilot import FlownAutopilot
from tests.support.recorded import Beat, Recorded, heard, recorded

GCS = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
OK, FAILSAFE = 4, 5  # MAV_STATE_ACTIVE and _CRITICAL


def told(changes: list[Beat]) -> list[tuple[int, int]]:
    return [(beat.mode, beat.status) for beat in changes]


def stream(flown: FlownAutopilot, seconds: float, velocity: Vec = ZERO) -> FlownAutopilot:
    return flown.forward(seconds, every_s=0.05, send=lambda: flown.velocity_target(velocity))


def offboard(**more: Any) -> FlownAutopilot:
    flown = FlownAutopilot(Kind.PX4, **more).forward(1.0)
    flown.send(flown.velocity_target(ZERO))
    assert flown.mode_to("OFFBOARD") == 0
    return flown


# ---------------------------------------------------------------------- ArduPilot


def test_loiter_without_a_stick_sinks_as_fast() -> None:
    real = recorded("copter-capture-1v1")
    loiter = next(beat.t for beat in real.changes() if beat.mode == COPTER["LOITER"])
    flown = FlownAutopilot(Kind.ARDUCOPTER, throttle=0.0)
    flown.mode_to("LOITER")
    ours = heard(flown.forward(12.0))
    assert real.sink(loiter + 3.0, loiter + 11.0) == pytest.approx(2.47, abs=0.05)
    assert ours.sink(3.0, 11.0) == pytest.approx(real.sink(loiter + 3.0, loiter + 11.0), rel=0.04)


def test_loiter_with_the_stick_centred_keeps_its_height() -> None:
    real = recorded("copter-agent2-loiter-pilot-hold-kill")
    flown = FlownAutopilot(Kind.ARDUCOPTER, throttle=0.5)
    ours = heard(flown.forward(9.0))
    for who, start in ((real, 13.0), (ours, 0.0)):
        heights = [h for _, h in who.heights(start, start + 8.0)]
        assert max(heights) - min(heights) < 0.3


def test_a_lost_position_lands_a_copter_with_the_same_words() -> None:
    real = recorded("copter-agent2-restart-battery-gpsloss-landfs")
    flown = FlownAutopilot(Kind.ARDUCOPTER)
    flown.mode_to("GUIDED")
    stream(flown, 2.0)
    flown.autopilot.fail(Fault.GPS)
    flown.forward(10.0)
    flown.autopilot.fail(Fault.GPS, failed=False)
    ours = heard(flown.forward(3.0))
    words = ["EKF variance", "EKF Failsafe: changed to LAND Mode", "EKF Failsafe Cleared"]
    guided, land = COPTER["GUIDED"], COPTER["LAND"]
    for who in (real, ours):
        assert [text for text in who.texts() if text in words] == words
        assert told(who.changes())[-3:] == [(guided, OK), (land, FAILSAFE), (land, OK)]


def test_a_cleared_failsafe_leaves_the_vehicle_in_rtl_and_the_fence_brings_it_back() -> None:
    real = recorded("copter-restart-leaves-failsafe-rtl-then-fence")
    flown = FlownAutopilot(Kind.ARDUCOPTER, parameters={"FS_GCS_ENABLE": 1, "SYSID_MYGCS": 1})
    flown.mode_to("GUIDED")
    beat = DialectSender(1, 191)
    flown.send(GCS, beat)
    flown.forward(7.0)  # its agent is dead
    since = len(flown.heard)
    flown.forward(0.5)
    for _ in range(3):
        flown.send(GCS, beat)
        flown.forward(0.4)
    flown.mode_to("GUIDED")
    flown.autopilot.parameters.put("FENCE_RADIUS", 10.0)
    flown.autopilot.parameters.put("FENCE_ENABLE", 1.0)
    for _ in range(6):
        flown.send(GCS, beat)
        stream(flown, 1.0, Vec(4.0, 0.0, 0.0))
    flown.heard = flown.heard[since:]
    ours = heard(flown)
    rtl, guided = COPTER["RTL"], COPTER["GUIDED"]
    for who in (real, ours):
        modes = [mode for mode, _ in told(who.changes())]
        assert [a for a, b in pairwise([*modes, -1]) if a != b] == [rtl, guided, rtl]
        assert [t for t in who.texts() if "Fail" in t or "Fence" in t] == [
            "GCS Failsafe Cleared",
            "Fence Breached",
        ]
        assert who.changes()[0].status == FAILSAFE
        assert who.changes()[-1].status == OK


def answers(who: Recorded, number: int) -> list[tuple[float, int]]:
    return [(t, m.result) for t, m in who.own("COMMAND_ACK") if m.command == number]


def test_answers_come_late_in_a_heap() -> None:
    real = recorded("plane-late-answers")
    orders = [t for t, m in real.asked("COMMAND_LONG") if m.command == 176]
    real_late = answers(real, 176)[0][0] - orders[0]
    assert 1.5 < real_late < 2.0
    assert sum(t < answers(real, 176)[0][0] for t in orders) >= 10  # asked again and again meanwhile
    flown = FlownAutopilot(Kind.ARDUPLANE, answer_delay_s=(0.4, 3.0), generator=np.random.default_rng(1))
    number = flown.autopilot.modes["LOITER"]
    for _ in range(12):
        flown.send(dialect.MAVLink_command_long_message(1, 1, 176, 0, 1, number, 0, 0, 0, 0, 0))
        flown.forward(0.1)
    flown.forward(3.0)
    ours = [t for t, _ in answers(heard(flown), 176)]
    assert len(ours) == 12  # each is answered, as the recorded ones are
    assert {result for _, result in answers(real, 176)} == {0}
    assert 0.4 <= ours[0] <= 3.0
    assert ours[-1] <= 1.2 + 3.0


def test_another_station_takes_the_rate_that_was_asked_for() -> None:
    real = recorded("copter-behind-mavproxy-rates")
    times = [t for t, _ in real.own("GLOBAL_POSITION_INT")]
    rates = [sum(a <= t < a + 5.0 for t in times) / 5.0 for a in range(0, 40, 5)]
    assert rates[0] > 10.0  # 17.5 Hz until the other station asks
    assert min(rates) < 5.0  # 4 Hz is what MAVProxy asks
    flown = FlownAutopilot(Kind.ARDUCOPTER, other_station_hz=4.0)
    flown.forward(0.1)
    assert flown.command(511, 33, 50_000) == 0
    ours = [t for t, _ in heard(flown.forward(20.0)).own("GLOBAL_POSITION_INT")]
    assert sum(t < 4.0 for t in ours) / 4.0 > 15.0
    assert sum(10.0 <= t < 20.0 for t in ours) / 10.0 == pytest.approx(4.0, abs=0.2)


def test_airspeeds_outside_the_limits_are_denied_and_no_others() -> None:
    real = recorded("plane-supervised-as-copter")
    asked = [
        m.param2 for s in real.said if (m := s.message).get_type() == "COMMAND_INT" and m.command == 43000
    ]
    asked += [m.param2 for t, m in real.asked("COMMAND_LONG") if m.command == 43000]
    results = [result for _, result in answers(real, 43000)]
    assert len(asked) == len(results) >= 10
    flown = FlownAutopilot(Kind.ARDUPLANE)  # AIRSPEED_MIN 10, _MAX 30 as the recorded one
    flown.mode_to("GUIDED")
    assert [flown.command_int(43000, 0, speed, 0, 0, 0, 0, 0, 0) for speed in asked] == results
    assert set(results) == {0, 2}


# ---------------------------------------------------------------------- PX4


@pytest.mark.parametrize(
    "name",
    [
        "px4-frozen-agent-regain-geofence-battery",
        "px4-geofence-hold-then-rtl",
        "px4-rc-loss-hold-rtl",
        "px4-pilot-sticks-posctl",
    ],
)
def test_an_order_of_a_mode_is_acknowledged_twice_and_told_by_a_heartbeat_of_its_own(name: str) -> None:
    real = recorded(name)
    ours = heard(offboard().forward(1.0))
    for who in (real, ours):
        acknowledged = answers(who, 176)
        assert len(acknowledged) >= 2
        assert [result for _, result in acknowledged] == [0] * len(acknowledged)
        beats = who.beats()
        first = next(beat for beat in beats if beat.mode == PX4["OFFBOARD"])
        assert 0.0 < first.t - acknowledged[1][0] < 0.1
    orders = [m for _, m in real.asked("COMMAND_LONG") if m.command == 176]
    assert len(answers(real, 176)) == 2 * len(orders)


def test_other_changes_are_told_by_the_heartbeat_of_the_second() -> None:
    real = recorded("px4-frozen-agent-regain-geofence-battery")
    flown = stream(offboard(), 5.0)
    flown.forward(3.0)
    ours = heard(stream(flown, 3.0))
    for who in (real, ours):
        gaps = [b.t - a.t for a, b in pairwise(who.beats())]
        assert median(gaps) == pytest.approx(1.0, abs=0.02)
        assert sum(abs(gap - 1.0) < 0.05 for gap in gaps) >= 0.6 * len(gaps)  # but after orders, and hiccups


def test_lost_targets_are_held_after_a_second_and_their_return_takes_it_back_into_offboard() -> None:
    real = recorded("px4-frozen-agent-regain-geofence-battery")
    flown = stream(offboard(), 5.0).forward(3.0)
    ours = heard(stream(flown, 3.0))
    hold, back = PX4["HOLD"], PX4["OFFBOARD"]
    assert told(real.changes())[1:5] == [(back, OK), (hold, FAILSAFE), (back, OK), (hold, FAILSAFE)]
    assert told(ours.changes())[-3:] == [(back, OK), (hold, FAILSAFE), (back, OK)]


def test_a_restarted_stream_takes_it_back_though_nobody_asked() -> None:
    real = recorded("px4-restart-without-take-control-back-into-offboard")
    first = real.changes()[:2]
    assert told(first) == [(PX4["HOLD"], FAILSAFE), (PX4["OFFBOARD"], OK)]
    assert not [t for t, m in real.asked("COMMAND_LONG") if m.command == 176 and t < first[1].t]
    begun = real.asked("SET_POSITION_TARGET_LOCAL_NED")[0][0]
    assert first[1].t - begun < 1.1  # one second's heartbeat
    flown = stream(offboard(), 3.0).forward(5.0)
    flown.send(flown.velocity_target(ZERO))  # one target
    flown.forward(0.05)
    assert flown.mode == "OFFBOARD"


@pytest.mark.parametrize("name", ["px4-geofence-hold-then-rtl", "px4-rc-loss-hold-rtl"])
def test_it_holds_for_five_seconds_before_it_returns(name: str) -> None:
    real = recorded(name)
    if "geofence" in name:
        flown = stream(offboard(parameters={"GF_ACTION": 3, "GF_MAX_HOR_DIST": 10}), 12.0, Vec(2.0, 0.0, 0.0))
    else:
        flown = stream(offboard(parameters={"COM_RCL_EXCEPT": 0, "NAV_RCL_ACT": 2}), 3.0)
        flown.autopilot.set_throttle(flown.now_ns, None)
        stream(flown, 8.0)
    ours = heard(flown)
    for who in (real, ours):
        held, returning = who.changes()[-2:]
        assert told([held, returning]) == [(PX4["HOLD"], FAILSAFE), (PX4["RTL"], FAILSAFE)]
        assert returning.t - held.t == pytest.approx(5.0, abs=0.1)


def test_position_mode_without_sticks_sinks_and_falls_to_altitude_mode_without_a_position() -> None:
    real = recorded("px4-default-params-posctl-to-offboard-gpsloss")
    flown = FlownAutopilot(Kind.PX4, throttle=None, parameters={"COM_OBL_RC_ACT": 0}).forward(1.0)
    flown.send(flown.velocity_target(ZERO))
    flown.mode_to("OFFBOARD")
    stream(flown, 3.0)
    flown.autopilot.fail(Fault.GPS)  # the agent ends its stream
    flown.forward(20.0)
    flown.autopilot.fail(Fault.GPS, failed=False)
    ours = heard(flown.forward(2.0))
    by_hand = [PX4["POSCTL"], PX4["ALTCTL"], PX4["POSCTL"]]
    for who in (real, ours):
        assert told(who.changes())[-3:] == [(mode, FAILSAFE) for mode in by_hand]
    lost, blind, _ = real.changes()[-3:]
    ours_lost, ours_blind, _ = ours.changes()[-3:]
    assert blind.t - lost.t == pytest.approx(4.0, abs=0.1)
    assert ours_blind.t - ours_lost.t == pytest.approx(blind.t - lost.t, abs=1.1)  # heartbeats' grid
    assert 0.6 < real.sink(22.0, 55.0) < 0.9
    z = flown.airframe.motion.velocity.z
    assert z == pytest.approx(0.8)  # what was seen in POSCTL; recorded in ALTCTL: 0.7


def test_a_take_off_to_zero_degrees_is_accepted_and_never_climbs() -> None:
    real = recorded("px4-ground-start-never-climbs")
    flown = FlownAutopilot(Kind.PX4, airborne=False, ready_s=0.0)
    asked = [(t, m) for t, m in real.asked("COMMAND_LONG") if m.command in (400, 22)]
    for t, m in asked:
        flown.forward(t - flown.now_ns * 1e-9)
        altitude = 488.0 + 19.9
        flown.send(
            dialect.MAVLink_command_long_message(1, 1, m.command, 0, m.param1, 0, 0, 0, 0, 0, altitude)
        )
    ours = heard(flown.forward(30.0 - flown.now_ns * 1e-9))
    for who in (real, ours):
        assert {result for _, result in answers(who, 22)} == {0}
        assert max(abs(h) for _, h in who.heights(1.0, 30.0)) < 1.0
        armed = [beat for beat in who.changes() if beat.armed]
        disarmed = [beat for beat in who.changes() if not beat.armed and beat.t > armed[0].t]
        assert disarmed[0].t - armed[0].t == pytest.approx(11.0, abs=1.1)


def test_a_pilots_sticks_hold_in_position_mode() -> None:
    real = recorded("px4-pilot-sticks-posctl")
    taken = next(beat for beat in real.changes() if beat.mode == PX4["POSCTL"])
    assert taken.status == OK  # a pilot, no failsafe
    flown = stream(offboard(), 2.0)
    flown.autopilot.pilot_mode(flown.now_ns, "POSCTL")
    ours = heard(stream(flown, 10.0))
    assert told(ours.changes())[-1] == (PX4["POSCTL"], OK)
    for who, start in ((real, taken.t + 1.0), (ours, 5.0)):
        heights = [h for _, h in who.heights(start, start + 5.0)]
        assert max(heights) - min(heights) < 1.0


@pytest.mark.parametrize(
    "name",
    ["px4-frozen-agent-regain-geofence-battery", "px4-rc-loss-hold-rtl", "px4-ground-start-never-climbs"],
)
def test_no_text_reaches_a_link_on_which_no_ground_station_speaks(name: str) -> None:
    assert recorded(name).texts() == []
    flown = stream(offboard(), 2.0).forward(5.0)
    assert heard(flown).texts() == []
