"""The fleet picture: what a person at the field sees, and when."""

from __future__ import annotations

from math import isinf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.picture.fleet import Fleet
from gcs.picture.records import LOST_NS
from gcs.picture.reducer import PictureReducer
from gcs.picture.values import Presence
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus import messages, topics
from onboard.wire.bus.messages import OutcomeResult, Phase, Role
from tests.support.sample_messages import (
    GAME,
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


def test_a_vehicle_is_seen_with_what_it_says_and_the_age_of_each():
    tower = Tower()
    tower.hear(state(2), health(2), decision(2))
    tower.wait(0.3)
    seen = tower.vehicle(2)
    assert seen.presence is Presence.PRESENT
    assert (seen.role, seen.mode, seen.armed, seen.rule) == (Role.PURSUER, "GUIDED", True, "intercept")
    assert seen.health is not None
    assert seen.health.battery == 0.9
    assert seen.state_age_s == seen.decision_age_s == seen.health_age_s == pytest.approx(0.3)


def test_silence_from_all_sources_is_a_loss_after_one_second_and_a_word_brings_it_back():
    tower = Tower()
    tower.fly(3.0, 1, 2)
    tower.fly(0.9, 1)
    assert tower.vehicle(2).presence is Presence.PRESENT
    tower.fly(0.2, 1)
    assert tower.vehicle(2).presence is Presence.LOST
    assert tower.vehicle(1).presence is Presence.PRESENT
    tower.hear(event(2, 1))
    assert tower.vehicle(2).presence is Presence.PRESENT


@pytest.mark.parametrize("word", [state(2), health(2), decision(2), event(2, 1)])
def test_any_message_counts_as_life(word):
    tower = Tower()
    for _ in range(30):
        tower.hear(word)
        tower.wait(0.1)
    assert tower.vehicle(2).presence is Presence.PRESENT


def test_a_token_that_goes_is_no_loss_while_messages_come_and_one_that_comes_is_life():
    tower = Tower()
    tower.token(2, True)
    assert tower.vehicle(2).presence is Presence.PRESENT
    assert tower.vehicle(2).token
    tower.fly(0.5, 2)
    tower.token(2, False)
    tower.fly(2.0, 2)
    assert tower.vehicle(2).presence is Presence.PRESENT
    assert not tower.vehicle(2).token


def test_a_track_of_a_vehicle_is_not_its_life():
    tower = Tower()
    tower.hear(state(2))
    for _ in range(30):
        tower.hear(track(2, tower.now_ns))
        tower.wait(0.1)
    assert tower.vehicle(2).presence is Presence.LOST
    assert [t.id for t in tower.picture.tracks] == [2]


def test_the_roster_is_expected_before_it_is_heard():
    tower = Tower()
    tower.hear(setup(3))
    assert [(v.id, v.presence) for v in tower.picture.vehicles] == [(i, Presence.EXPECTED) for i in (1, 2, 3)]
    assert isinf(tower.vehicle(3).age_s)
    assert tower.vehicle(1).role is Role.EVADER


def test_the_game_is_told_with_its_clock_and_outcome():
    tower = Tower()
    t0 = START_NS + 5 * NS_PER_S
    tower.hear(setup(3), phase(Phase.READY, t0))
    assert tower.picture.game.clock == "T−5.0 s"
    tower.wait(7.5)
    tower.hear(phase(Phase.RUNNING, t0))
    assert tower.picture.game.clock == "T+2.5 s"
    tower.hear(messages.Outcome(OutcomeResult.CAPTURED, 2.5, 3, 1.9, tower.now_ns), phase(Phase.ENDED, t0))
    assert tower.picture.game.outcome is not None
    assert tower.picture.game.outcome.captor == 3
    assert any("captured by 3" in line.text for line in tower.picture.log)


def test_the_outcome_of_an_earlier_game_is_not_shown_for_this_one():
    tower = Tower()
    tower.hear(messages.Outcome(OutcomeResult.CAPTURED, 2.5, 3, 1.9, START_NS - 100 * NS_PER_S))
    tower.hear(setup(3), phase(Phase.ENDED, START_NS - 10 * NS_PER_S))
    assert tower.picture.game.outcome is None


def test_a_restart_is_told_from_two_agents_with_one_id():
    tower = Tower()
    tower.hear(state(2, nonce=1))
    tower.wait(0.1)
    tower.hear(state(2, nonce=2))
    tower.wait(0.1)
    assert not tower.vehicle(2).double_id
    assert any(line.kind == "restarted" for line in tower.picture.log)
    tower.hear(state(2, nonce=1))  # the old process speaks again: there are two
    assert tower.vehicle(2).double_id
    tower.fly(4.0, 2)
    assert not tower.vehicle(2).double_id


def test_a_late_state_is_life_but_does_not_move_the_vehicle_back():
    tower = Tower()
    tower.hear(state(2, START_NS, position=(10.0, 0.0, 0.0)))
    tower.hear(state(2, START_NS - NS_PER_S, position=(0.0, 0.0, 0.0)))
    assert tower.vehicle(2).position == (10.0, 0.0, 0.0)
    assert dict(tower.vehicle(2).dropped) == {"late": 1}


def test_events_are_shown_once_and_gaps_are_counted_until_they_fill():
    tower = Tower()
    tower.hear(event(2, 1), event(2, 4))
    assert tower.vehicle(2).missed_events == 2
    tower.hear(event(2, 2), event(2, 3), event(2, 3))
    assert tower.vehicle(2).missed_events == 0
    texts = [line.text for line in tower.picture.log if line.kind == "note"]
    assert texts == ["event 1", "event 4", "event 2", "event 3"]


def test_bad_foreign_and_newer_messages_are_counted_by_cause_and_never_raise():
    tower = Tower()
    key, payload = on_bus(state(2))
    tower.hear_raw(key, payload[:-3])
    tower.hear_raw(key, b"\x92\x63" + payload[2:])  # schema 99
    tower.hear_raw(key, topics.STATE.encode(state(3)))  # says 3 under the key of 2
    tower.hear_raw(key, topics.STATE.encode(state(2, airspeed=float("nan"))))
    tower.hear(state(2, position=(1e300, 0.0, 0.0)))
    tower.hear_raw(f"apollonius/{GAME}/weather", b"")
    tower.hear_raw(f"apollonius/{GAME}/vehicles/9999/state", payload)
    tower.hear_raw("elsewhere", b"")
    counted = dict(tower.picture.dropped)
    assert counted == {
        "undecodable": 1, "schema": 1, "wrong_id": 1, "not_finite": 1, "implausible": 1, "foreign": 3,
    }  # fmt: skip
    assert tower.vehicle(2).presence is Presence.EXPECTED
    assert tower.vehicle(2).schema_age_s == 0.0


def test_the_rate_of_states_is_measured_here():
    tower = Tower()
    tower.fly(3.0, 2, state_hz=20)
    assert tower.vehicle(2).state_rate_hz == pytest.approx(20.0, rel=0.06)
    tower.wait(5.0)
    assert tower.vehicle(2).state_rate_hz == 0.0


def test_trails_are_thinned_and_bounded():
    tower = Tower()
    for _ in range(200):
        tower.hear(state(2, tower.now_ns))
        tower.wait(1.0)
    assert len(tower.vehicle(2).trail) == 120


def test_two_masters_are_noticed_and_forgotten():
    tower = Tower()
    one, other = messages.Master("bridge", START_NS, nonce=1), messages.Master("bridge", START_NS, nonce=2)
    for _ in range(3):
        tower.hear(one)
        tower.wait(0.5)
    assert not tower.picture.game.two_masters
    for _ in range(3):
        tower.hear(one, other)
        tower.wait(0.5)
    assert tower.picture.game.two_masters
    for _ in range(6):
        tower.hear(one)
        tower.wait(0.5)
    assert not tower.picture.game.two_masters


def test_the_assessment_names_who_can_intercept_and_who_denies_the_target():
    tower = Tower()
    tower.hear(setup(3, pursuer_speed=6.0, planar=True), phase(Phase.RUNNING, START_NS))
    tower.hear(messages.EvaderBrief((500.0, 0.0, 0.0), START_NS))
    tower.hear(state(1, position=(0.0, 0.0, 0.0)))
    assert tower.picture.assessments == ()  # no pursuer is known yet
    tower.hear(state(2, position=(300.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)))
    tower.hear(state(3, position=(-300.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0)))
    (found,) = tower.picture.assessments
    can = {p.id: (p.intercepts, p.denies_target) for p in found.prospects}
    assert can == {2: (True, True), 3: (False, False)}
    assert found.target_denied
    assert not found.encircled


def test_the_same_stream_gives_the_same_picture_however_often_one_looks():
    tower = Tower()
    tower.hear(setup(3))
    tower.fly(2.0, 1, 2, 3)
    tower.fly(2.5, 1, 2, battery=0.25)
    tower.hear_raw("elsewhere", b"")
    tower.fly(1.0, 1, 2, 3)
    replayed = PictureReducer(GAME, version="0.1.0")
    for index, (key, payload, now_ns) in enumerate(tower.stream):
        if index % 7 == 0:
            replayed.picture(now_ns)
        replayed.apply(key, payload, now_ns)
    assert tower.picture.alerts
    assert replayed.picture(tower.now_ns) == tower.picture


KEYS = [
    *(topic.key(GAME, 2 if topics.ID in topic.suffix else None) for topic in topics.TOPICS),
    *(f"apollonius/{GAME}/gcs/{name}" for name in ("sent", "replied", "presence", "x")),
]


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(KEYS) | st.text(max_size=30), st.binary(max_size=60)), max_size=20))
def test_no_bytes_on_any_key_raise(messages):
    fleet = Fleet(GAME)
    for key, payload in messages:
        assert fleet.apply(key, payload, START_NS) is None
    assert fleet.received == len(messages)
    fleet.vehicles(START_NS + LOST_NS)
