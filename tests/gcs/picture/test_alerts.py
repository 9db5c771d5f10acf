"""Alerts: each is raised when it should be, says what to do, clears, and does not flap."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.picture import station_journal
from gcs.picture.alert_rules import room_inside
from gcs.picture.alerts import CLEAR_NS, Alerts, Finding
from gcs.picture.thresholds import SUPERVISOR, Thresholds
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.wire.bus import messages
from onboard.wire.bus.messages import AgentStage, CommandState, LinkLock, Phase, Severity
from tests.support.sample_messages import (
    START_NS,
    Tower,
    decision,
    event,
    health,
    on_bus,
    phase,
    setup,
    state,
    track,
)

SQUARE = messages.Fence(((-200.0, -500.0), (200.0, -500.0), (200.0, 500.0), (-200.0, 500.0)), 10.0, 120.0)


def test_all_is_well_in_a_healthy_flight():
    tower = Tower()
    tower.hear(setup(3), messages.Master("bridge", START_NS, lease_s=60.0))
    tower.hear(phase(Phase.STAGING))
    tower.fly(5.0, 1, 2, 3)
    assert tower.alerts() == set()


def test_a_killed_agent_is_lost_in_the_picture_within_one_and_a_half_seconds_and_back_within_two():
    tower = Tower()
    tower.fly(3.0, 1, 2)
    tower.fly(0.9, 1)  # the last word came 50 ms before
    assert tower.alerts() == set()
    tower.fly(0.2, 1)
    assert tower.alerts() == {"lost:2"}
    alert = tower.picture.alerts[0]
    assert alert.severity is Severity.ERROR
    assert "failsafe" in alert.advice
    tower.fly(2.0, 1, 2)
    assert tower.alerts() == set()
    assert [a.name for a in tower.picture.past_alerts] == ["lost:2"]


def test_an_agent_whose_autopilot_fell_silent_is_not_lost():
    tower = Tower()
    tower.fly(2.0, 2)
    for _ in range(6):
        tower.hear(health(2, tower.now_ns, telemetry_age_s=1.2, heartbeat_age_s=1.2))
        tower.wait(0.25)
    assert tower.alerts() == {"stale:2", "autopilot_silent:2"}


@pytest.mark.parametrize(
    ("changes", "name", "severity"),
    [
        ({"battery": 0.29}, "battery:2", Severity.WARNING),
        ({"battery": 0.19}, "battery:2", Severity.ERROR),
        ({"link_quality": 0.5}, "link:2", Severity.WARNING),
        ({"clock_offset_s": 0.06}, "clock:2", Severity.WARNING),
        ({"clock_offset_s": -0.3}, "clock:2", Severity.ERROR),
        ({"heartbeat_age_s": 2.5}, "autopilot_silent:2", Severity.ERROR),
        ({"stage": AgentStage.HANDED_OVER}, "handed_over:2", Severity.WARNING),
        ({"stage": AgentStage.HANDED_OVER, "failsafe": True}, "handed_over:2", Severity.WARNING),
        ({"hold_lost": "LOITER does not hold"}, "hold_lost:2", Severity.ERROR),
        ({"ekf_ok": False}, "estimate:2", Severity.ERROR),
        ({"gps_fix": 1}, "estimate:2", Severity.ERROR),
        ({"version": "0.0.9"}, "version:2", Severity.WARNING),
    ],
)
def test_what_health_tells_is_raised_and_cleared(changes, name, severity):
    tower = Tower()
    tower.fly(2.0, 2)
    assert tower.alerts() == set()
    tower.fly(3.0, 2, **changes)
    assert {a.name: a.severity for a in tower.picture.alerts} == {name: severity}
    assert tower.picture.alerts[0].advice
    tower.fly(3.0, 2)
    assert tower.alerts() == set()
    assert [a.name for a in tower.picture.past_alerts] == [name]


def test_a_lost_hold_stands_until_somebody_moves_the_vehicle():
    tower = Tower()
    tower.fly(2.0, 2)
    tower.fly(60.0, 2, hold_lost="LOITER does not hold: 31.0 m above home, climbing -2.5 m/s")
    tower.note(station_journal.ACKNOWLEDGED, station_journal.Acknowledged("hold_lost:2", "anna"))
    tower.fly(60.0, 2, hold_lost="LOITER does not hold: 31.0 m above home, climbing -2.5 m/s")
    (alert,) = tower.picture.alerts
    assert (alert.name, alert.acknowledged) == ("hold_lost:2", True)
    assert "31.0 m above home" in alert.text
    assert "return 2" in alert.advice


@pytest.mark.parametrize(
    ("counter", "lock", "name", "severity", "said"),
    [
        ("signature_stale", LinkLock.SIGNED, "signature_stale:2", Severity.ERROR, "in the past"),
        ("signature_future", LinkLock.SIGNED, "signature_future:2", Severity.ERROR, "in the future"),
        ("signature_wrong", LinkLock.SIGNED, "signature_wrong:2", Severity.WARNING, "another key"),
        ("signature_unsigned", LinkLock.REFUSED, "signature_unsigned:2", Severity.ERROR, "is not heard"),
        ("signature_replayed", LinkLock.SIGNED, "signature_replayed:2", Severity.WARNING, "again"),
        ("bus_limited_state", LinkLock.OPEN, "flooded:2", Severity.WARNING, "bus state 40"),
        ("link_limited_link", LinkLock.OPEN, "flooded:2", Severity.WARNING, "link link 40"),
        ("log_lost", LinkLock.OPEN, "records_lost:2", Severity.WARNING, "log lost 40"),
        ("stamps_unsaved", LinkLock.OPEN, "records_lost:2", Severity.WARNING, "stamps unsaved 40"),
    ],
)
def test_a_counter_of_trouble_is_an_alert_while_it_grows(counter, lock, name, severity, said):
    tower = Tower()
    tower.fly(2.0, 2, counters={counter: 37, "control_steps": 1})
    tower.fly(8.0, 2, counters={counter: 37, "control_steps": 500})  # since long ago, and no more
    assert tower.alerts() == set()
    for n in (38, 39, 40):
        tower.fly(0.5, 2, counters={counter: n}, link_lock=lock)
    alert = tower.picture.alerts[0]
    assert (alert.name, alert.severity, bool(alert.advice)) == (name, severity, True)
    assert said in alert.text
    assert "40" in alert.text
    tower.fly(7.0, 2, counters={counter: 40})
    assert tower.alerts() == set()


def test_an_agent_that_was_started_again_begins_its_counters_anew():
    tower = Tower()
    tower.fly(8.0, 2, counters={"signature_wrong": 40})
    tower.fly(1.0, 2, counters={"signature_wrong": 3}, nonce=77)
    assert "signature_wrong:2" in tower.alerts()


def test_a_stranger_who_counts_a_thousand_things_does_not_fill_the_picture():
    tower = Tower()
    for n in range(40):
        tower.hear(health(2, tower.now_ns, counters={f"limited_{n}_{i}": n + 1 for i in range(200)}))
        tower.wait(0.1)
    assert len(tower.vehicle(2).growing) == 64
    tower.fly(7.0, 2)
    assert tower.vehicle(2).growing == ()


def test_a_vehicle_that_acts_in_a_mode_that_does_not_follow_is_told():
    tower = Tower()
    for _ in range(40):
        tower.hear(state(2, tower.now_ns, mode="LOITER"), health(2, tower.now_ns, mode="LOITER"))
        tower.wait(0.05)
    assert tower.alerts() == {"mode:2"}


def test_the_geofence_is_near_then_crossed_then_over():
    tower = Tower()
    tower.hear(setup(2, fence=SQUARE))

    def at(north: float) -> set[str]:
        for _ in range(40):
            tower.hear(state(2, tower.now_ns, position=(north, 0.0, -50.0)))
            tower.wait(0.05)
        return tower.alerts()

    assert at(180.0) == set()
    assert at(196.0) == {"fence_near:2"}
    assert at(194.0) == {"fence_near:2"}  # not clear before it has come 2 m further in
    assert at(205.0) == {"fence_crossed:2"}
    assert "5 m" in tower.picture.alerts[0].text
    assert at(100.0) == set()


def test_floor_and_ceiling_are_part_of_the_fence():
    assert room_inside(Vec(0.0, 0.0, -60.0), SQUARE) == 50.0
    assert room_inside(Vec(0.0, 0.0, -130.0), SQUARE) == -10.0
    assert room_inside(Vec(0.0, 0.0, -3.0), SQUARE) == -7.0


def test_what_ground_and_supervisor_both_judge_they_judge_alike():
    limits = Thresholds()
    assert limits.state_stale_s == SUPERVISOR.telemetry_age
    assert limits.heartbeat_stale_s == SUPERVISOR.heartbeat_age
    assert limits.battery_critical == SUPERVISOR.battery
    assert limits.fence_near_m == SUPERVISOR.fence_margin
    assert limits.gps_fix == SUPERVISOR.gps_fix


def test_team_mates_too_near_to_each_other_are_told_once_for_the_pair():
    tower = Tower()
    tower.hear(setup(3, separation=10.0))

    def apart(metres: float) -> set[str]:
        for _ in range(40):
            tower.hear(state(1, tower.now_ns, position=(0.0, 0.5, 0.0)))  # the evader is no team mate
            tower.hear(state(2, tower.now_ns, position=(0.0, 0.0, 0.0)))
            tower.hear(state(3, tower.now_ns, position=(metres, 0.0, 0.0)))
            tower.wait(0.05)
        return tower.alerts()

    assert apart(12.0) == set()
    assert apart(9.0) == {"separation:2:3"}
    assert apart(11.0) == {"separation:2:3"}
    assert apart(12.0) == set()


def test_two_agents_with_one_id_are_an_error():
    tower = Tower()
    for nonce in (1, 2, 1, 2):
        tower.hear(state(2, tower.now_ns, nonce=nonce))
        tower.wait(0.1)
    assert "double_id:2" in tower.alerts()


def test_bad_bytes_and_another_schema_are_told_and_pass():
    tower = Tower()
    tower.fly(1.0, 2)
    key, payload = on_bus(state(2))
    tower.hear_raw(key, b"\x92\x63" + payload[2:])
    tower.fly(0.2, 2)
    assert tower.alerts() == {"dropped", "schema:2"}
    assert any("1 schema" in a.text for a in tower.picture.alerts)
    tower.fly(8.0, 2)
    assert tower.alerts() == set()


def test_missed_events_a_missing_vehicle_and_a_stranger_are_told():
    tower = Tower()
    tower.hear(setup(3), phase(Phase.STAGING), messages.Master("bridge", START_NS, lease_s=60.0))
    tower.hear(event(2, 1), event(2, 5))
    tower.fly(4.0, 1, 2, 9)
    assert tower.alerts() == {"missed_events:2", "missing:3", "stranger:9"}


def test_no_track_of_the_evader_and_a_silent_master_are_told_while_the_game_runs():
    tower = Tower()
    tower.hear(setup(2), phase(Phase.RUNNING, START_NS), messages.Master("bridge", START_NS))
    for _ in range(40):
        tower.hear(track(1, tower.now_ns), messages.Master("bridge", tower.now_ns), state(1), state(2))
        tower.wait(0.1)
    assert tower.alerts() == set()
    for _ in range(30):
        tower.hear(state(1, tower.now_ns), state(2, tower.now_ns))
        tower.wait(0.1)
    assert tower.alerts() == {"track_stale:1", "no_master"}


def test_what_the_supervisor_orders_is_shown_with_its_reason():
    tower = Tower()
    for _ in range(20):
        tower.hear(state(2, tower.now_ns))
        tower.hear(
            decision(
                2, tower.now_ns, supervisor=messages.SupervisorAction.HOLD, reason="the track is too old"
            )
        )
        tower.wait(0.05)
    assert tower.alerts() == {"supervisor:2"}
    assert "the track is too old" in tower.picture.alerts[0].text


def test_a_command_nobody_confirms_becomes_an_alert_that_names_who():
    tower = Tower()
    tower.fly(1.0, 2, 3)
    order = messages.Command("c1", messages.CommandKind.ABORT, "tower", START_NS)
    tower.note(station_journal.SENT, station_journal.Sent(order, (2, 3)))
    confirmed = messages.CommandReply("c1", 2, CommandState.CONFIRMED, "", "tower", START_NS, "LOITER")
    tower.note(station_journal.REPLIED, station_journal.Replied(confirmed))
    tower.fly(1.9, 2, 3)
    assert tower.alerts() == set()
    tower.fly(0.3, 2, 3)
    assert [a.text for a in tower.picture.alerts] == ["abort not confirmed by 3"]


def test_a_remark_with_advice_stands_until_it_is_over():
    tower = Tower()
    full = station_journal.Remark(Severity.ERROR, "disk", "the disk is full", "free some space")
    tower.note(station_journal.REMARK, full)
    tower.wait(10.0)
    assert tower.alerts() == {"disk"}
    tower.note(station_journal.REMARK, msgspec.structs.replace(full, over=True))
    tower.wait(3.0)
    assert tower.alerts() == set()


def test_an_alert_is_acknowledged_and_asks_again_only_when_it_worsens():
    tower = Tower()
    tower.fly(2.0, 2, battery=0.28)
    seen = station_journal.Acknowledged("battery:2", "anna")
    tower.note(station_journal.ACKNOWLEDGED, seen)
    tower.fly(1.0, 2, battery=0.27)
    assert [a.acknowledged for a in tower.picture.alerts] == [True]
    tower.fly(1.0, 2, battery=0.19)
    assert [(a.acknowledged, a.severity) for a in tower.picture.alerts] == [(False, Severity.ERROR)]


def test_a_value_that_hovers_at_its_limit_does_not_flap():
    tower = Tower()
    tower.fly(2.0, 2, battery=0.29)
    for step in range(100):
        level = 0.30 + (0.01 if step % 2 else -0.01)
        tower.fly(0.6, 2, battery=level)
    lines = [line for line in tower.picture.log if line.kind in ("alert", "cleared")]
    assert len(lines) == 1


@settings(max_examples=100, deadline=None)
@given(st.lists(st.booleans(), min_size=1, max_size=200))
def test_however_a_cause_comes_and_goes_the_board_changes_at_most_once_in_the_time_to_clear(causes):
    board = Alerts()
    finding = Finding("cause", 2, Severity.WARNING, "text", "advice")
    changes = []
    for step, wrong in enumerate(causes):
        now_ns = step * NS_PER_S // 10
        for alert in board.judge(lambda _, wrong=wrong: [finding] if wrong else [], now_ns):
            changes.append((now_ns, alert.cleared_ns > 0))
    assert bool(changes) == any(causes)
    assert [cleared for _, cleared in changes] == [bool(i % 2) for i in range(len(changes))]
    for (raised, _), (cleared, _) in zip(changes[::2], changes[1::2], strict=False):
        assert cleared - raised >= CLEAR_NS


def test_a_cause_that_does_not_last_is_not_raised():
    board = Alerts()
    finding = Finding("cause", 0, Severity.WARNING, "text", "advice", hold_s=1.0)
    for now in range(9):
        assert board.judge(lambda _: [finding], now * NS_PER_S // 10) == []
    assert board.judge(lambda _: [], 9 * NS_PER_S // 10) == []
    assert board.judge(lambda _: [finding], NS_PER_S) == []
    assert len(board.judge(lambda _: [finding], 2 * NS_PER_S)) == 1
