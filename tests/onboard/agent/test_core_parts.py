"""Parts of the agent's core by themselves: what each does exactly at its limits, and just beyond."""

from __future__ import annotations

from math import asin, isnan, pi, radians, tan

import pytest

from onboard.agent.config import AgentConfig, EnvelopeConfig, SafetyConfig
from onboard.agent.core.child_courier import LINES_MAX, ChildCourier
from onboard.agent.core.clip_spells import ClipSpells
from onboard.agent.core.clocks import JumpWatch, MasterClock
from onboard.agent.core.events import ChildEnd, ChildLine, ChildStart, Instant, Outbox
from onboard.agent.core.journal import BURST, Journal
from onboard.agent.core.masters import WORDS_KEPT, Hearing, Masters, Words
from onboard.agent.core.participation import Participation
from onboard.agent.core.policy_from_config import contradiction, envelope_of, game_setup, policy_of
from onboard.agent.core.rate import RATE_WINDOW_S, Rate
from onboard.agent.core.schedule import Grid
from onboard.agent.core.telemetry_requests import baud_of
from onboard.agent.core.to_place import own_state
from onboard.autopilot.base import Note, Telemetry
from onboard.autopilot.flight_limits import FlightLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.safety.policy import Action, Cause
from onboard.runtime.loop import EPOCH_NS
from onboard.wire.bus.messages import (
    Fence,
    LimitsMessage,
    Master,
    Member,
    Origin,
    Phase,
    PhaseChange,
    Role,
    RulesMessage,
    Setup,
)

COPTER = AgentConfig(id=2, game="g")


def setup(speed: float = 15.0, down: float = -50.0, **changes: object) -> Setup:
    """A game of evader 1 and pursuer 2, whose limits of pitch are those of a multicopter."""
    limits = LimitsMessage(pitch_min=-pi / 2, pitch_max=pi / 2)
    roster = (
        Member(1, Role.EVADER, 10.0, (200.0, 0.0, -50.0)),
        Member(2, Role.PURSUER, speed, (0.0, 0.0, down), limits),
    )
    told = {"rules": RulesMessage(2.0, 4.0), "roster": roster, **changes}
    return Setup(
        game="g", scenario="s", scenario_hash="0", master="m", origin=Origin(47.0, 8.0, 400.0),
        **told,  # type: ignore[arg-type]
    )  # fmt: skip


# ---------------------------------------------------------------------- from configuration and setup


def test_the_pitch_that_the_game_reckons_with_is_that_of_climb_and_sink_over_speed() -> None:
    config = AgentConfig(id=2, game="g", envelope=EnvelopeConfig(climb_max=6.0, sink_max=3.0))
    player = game_setup(config, setup(15.0), (), True).player(2)
    assert player is not None
    assert player.limits.pitch_max == pytest.approx(asin(6.0 / 15.0))
    assert player.limits.pitch_min == pytest.approx(-asin(3.0 / 15.0))


def test_the_evader_that_has_a_target_is_told_that_it_has_one() -> None:
    place = Vec(300.0, 20.0, -40.0)
    runner = COPTER.__class__(id=1, game="g", role=Role.EVADER)
    assert game_setup(runner, setup(), (place,), True).target == (True, place)
    assert not game_setup(runner, setup(), (), True).target.exists


def test_a_pursuer_knows_the_target_from_the_setup_alone_and_only_where_the_rules_say_so() -> None:
    brief, place = (Vec(300.0, 20.0, -40.0),), (7.0, 8.0, -40.0)
    known = RulesMessage(2.0, 4.0, target_known=True)
    assert not game_setup(COPTER, setup(), brief, True).target.exists
    assert not game_setup(COPTER, setup(target=place), brief, True).target.exists
    assert not game_setup(COPTER, setup(rules=known), brief, True).target.exists
    assert game_setup(COPTER, setup(rules=known, target=place), (), True).target == (True, Vec(*place))


@pytest.mark.parametrize(("may_arm", "up"), [(True, 25.0), (False, None)])
def test_a_place_on_the_ground_is_flown_at_the_height_of_the_take_off_or_as_high_as_it_is(
    may_arm: bool, up: float | None
) -> None:
    config = AgentConfig(id=2, game="g", may_arm=may_arm, take_off_height=25.0)
    for down, height in ((0.0, up), (-0.99, up), (-1.0, 1.0), (-50.0, 50.0)):
        player = game_setup(config, setup(down=down), (), True).player(2)
        assert player is not None
        assert isnan(player.height) if height is None else player.height == height


@pytest.mark.parametrize(
    ("rules", "fits"), [((2.0, 2.0), True), ((2.0, 1.9), False), ((0.0, 4.0), False), ((0.1, 4.0), True)]
)
def test_the_radius_of_capture_is_more_than_nothing_and_no_more_than_the_safety_distance(
    rules: tuple[float, float], fits: bool
) -> None:
    assert (contradiction(COPTER, setup(rules=RulesMessage(*rules)), True) == "") is fits


@pytest.mark.parametrize(
    ("corners", "low", "high", "fits"),
    [(3, 10.0, 11.0, True), (2, 10.0, 90.0, False), (3, 10.0, 10.0, False)],
)
def test_a_fence_has_three_corners_and_a_height(corners: int, low: float, high: float, fits: bool) -> None:
    square = ((-300.0, -300.0), (300.0, -300.0), (300.0, 300.0))
    why = contradiction(COPTER, setup(fence=Fence(square[:corners], low, high)), True)
    assert why == ("" if fits else "the fence is no area")


@pytest.mark.parametrize(
    ("asked", "fits"), [(20.0, True), (20.4, True), (19.6, True), (20.5, False), (19.5, False)]
)
def test_a_plane_that_flies_one_speed_plays_games_of_that_speed_within_two_percent(
    asked: float, fits: bool
) -> None:
    why = contradiction(COPTER, setup(asked), False, FlightLimits(cruise=20.0))
    assert ("FW_AIRSPD_TRIM" in why) is not fits


def test_a_vehicle_is_refused_what_it_is_configured_or_built_not_to_fly_and_not_its_very_limits() -> None:
    own = EnvelopeConfig(speed_min=12.0, speed_max=18.0)
    config = AgentConfig(id=2, game="g", envelope=own)
    assert [contradiction(config, setup(v), True) == "" for v in (11.9, 12.0, 18.0, 18.1)] == [
        False, True, True, False,
    ]  # fmt: skip
    autopilots = FlightLimits(speed_min=12.0, speed_max=18.0)
    assert [contradiction(COPTER, setup(v), False, autopilots) == "" for v in (11.9, 12.0, 18.0, 18.1)] == [
        False, True, True, False,
    ]  # fmt: skip


def test_the_tighter_limit_counts_and_a_multicopters_least_speed_is_none() -> None:
    tight = FlightLimits(speed_min=9.0, speed_max=12.0, climb_max=2.0, sink_max=1.0)
    member = setup(15.0).roster[1]
    plane, copter = envelope_of(COPTER, member, False, tight), envelope_of(COPTER, member, True, tight)
    assert (plane.speed_min, plane.speed_max, plane.climb_max, plane.sink_max) == (9.0, 12.0, 2.0, 1.0)
    assert (copter.speed_min, copter.speed_max) == (0.0, 12.0)
    loose = envelope_of(COPTER, member, False, FlightLimits(speed_max=40.0, climb_max=90.0, sink_max=90.0))
    assert (loose.speed_max, loose.climb_max, loose.sink_max) == pytest.approx((15.0, 15.0, 15.0))
    assert envelope_of(COPTER, setup(0.0).roster[1], True).speed_max == 10.0  # none declared: caution


def test_a_turn_is_as_wide_as_bank_and_turn_rate_let_it_whichever_is_less() -> None:
    member, level = setup(20.0).roster[1], 9.80665 * tan(radians(30.0))
    for turn_deg, radius in ((90.0, 20.0**2 / level), (5.0, 20.0 / radians(5.0))):
        own = EnvelopeConfig(bank_max_deg=30.0, turn_rate_deg=turn_deg)
        found = envelope_of(AgentConfig(id=2, game="g", envelope=own), member, False)
        assert found.turn_radius == pytest.approx(radius)


@pytest.mark.parametrize(("age", "alone", "counts"), [(2.0, 5.0, 5.0), (6.0, 5.0, 6.0)])
def test_heartbeats_alone_may_be_missed_for_no_less_than_all_telemetry(
    age: float, alone: float, counts: float
) -> None:
    config = AgentConfig(id=2, game="g", safety=SafetyConfig(heartbeat_age_s=age, heartbeat_alone_s=alone))
    assert policy_of(config, None, True).heartbeat_alone == counts


def test_a_dead_multicopter_coasts_as_long_as_its_autopilot_says_and_a_plane_is_no_such_case() -> None:
    assert policy_of(COPTER, None, True).coast == 3.0  # ArduCopter's GUID_TIMEOUT unless told
    assert policy_of(COPTER, None, True, FlightLimits(coast=0.5)).coast == 0.5
    assert policy_of(COPTER, None, False, FlightLimits(coast=0.5)).coast == 0.0


# ---------------------------------------------------------------------- the part in the game


def phase(which: Phase, t0_ns: int = EPOCH_NS, resume: tuple[int, ...] = ()) -> PhaseChange:
    return PhaseChange(which, t0_ns, EPOCH_NS, resume)


def test_the_games_time_is_nothing_until_its_start_is_fixed() -> None:
    assert Participation.game_time(phase(Phase.STAGING, 0), EPOCH_NS) == 0.0
    assert Participation.game_time(phase(Phase.READY), EPOCH_NS - 2_000_000_000) == -2.0
    assert Participation.game_time(None, EPOCH_NS) == 0.0


@pytest.mark.parametrize(
    ("after_s", "resume", "joined", "resumed"),
    [
        (0.999, (), True, False),  # it was there for the start
        (0.999, (2,), True, False),
        (1.0, (), False, False),
        (1.0, (3,), False, False),
        (1.0, (2,), True, True),
    ],
)
def test_who_first_hears_of_the_game_a_second_after_its_start_waits_for_the_masters_word(
    after_s: float, resume: tuple[int, ...], joined: bool, resumed: bool
) -> None:
    part = Participation(2)
    part.follow(phase(Phase.RUNNING, resume=resume), EPOCH_NS + round(after_s * 1e9))
    assert (part.joined, part.resumed) == (joined, resumed)


def test_a_part_is_on_from_the_very_start_of_the_game() -> None:
    part, runs = Participation(2), phase(Phase.RUNNING)
    part.follow(phase(Phase.STAGING, 0), EPOCH_NS)
    assert not part.running(runs, EPOCH_NS - 1)
    assert part.running(runs, EPOCH_NS)


# ---------------------------------------------------------------------- the adapter's child


def test_what_the_child_says_is_passed_on_in_order_and_a_flood_is_cut() -> None:
    courier = ChildCourier(Outbox())
    courier.launch("udp://")
    courier.heard(b"warning offboard not accepted")
    courier.heard(b"half a line")
    courier.heard(b"mumble")
    assert courier.said() == [
        Note("warning", "offboard", "not accepted"), Note("half", "a", "line"),
    ]  # fmt: skip
    assert courier.said() == []
    for n in range(2 * LINES_MAX):
        courier.heard(b"info line %d" % n)
    assert [note.text for note in courier.said()] == [str(n) for n in range(LINES_MAX)]


def test_nothing_is_written_to_a_child_that_is_not_there_and_it_is_ended_once() -> None:
    out = Outbox()
    courier = ChildCourier(out)
    assert not courier.send(b"x")
    courier.launch("udp://")
    courier.heard(b"info of the last child")
    courier.launch("udp://")
    assert courier.said() == []
    assert courier.send(b"y")
    courier.close()
    courier.close()
    assert out.take() == [ChildStart(("udp://",)), ChildStart(("udp://",)), ChildLine(b"y"), ChildEnd()]
    courier.launch("udp://")
    courier.exited()
    assert not courier.alive()
    assert not courier.send(b"z")


# ---------------------------------------------------------------------- clocks and counts


def test_an_offset_alerts_beyond_50_ms_clears_below_40_and_forbids_beyond_200() -> None:
    clock = MasterClock()

    def hear(ms: float) -> tuple[bool, bool, bool]:
        clock.restart()
        return clock.hear(EPOCH_NS + round(ms * 1e6), EPOCH_NS), clock.alert, clock.ready

    assert hear(50.0) == (False, False, True)
    assert hear(-50.1) == (True, True, True)
    assert hear(45.0) == (False, True, True)  # no second word at the edge
    assert hear(200.0) == (False, True, True)
    assert hear(-200.1) == (False, True, False)
    assert hear(40.0) == (True, False, True)


def test_delay_only_adds_to_an_offset_and_ten_seconds_of_stamps_count() -> None:
    clock = MasterClock()
    for late_ms in (500, 30, 700):
        clock.hear(EPOCH_NS + late_ms * 1_000_000, EPOCH_NS)
    assert clock.offset_s == pytest.approx(0.03)
    for _ in range(19):
        clock.hear(EPOCH_NS + 700_000_000, EPOCH_NS)
    assert clock.offset_s == pytest.approx(0.7)


def test_a_jump_of_the_wall_clock_is_told_once_with_its_size_and_sign() -> None:
    watch = JumpWatch(0.5)
    assert watch.look(Instant(10.0, EPOCH_NS)) == 0.0
    assert watch.look(Instant(11.0, EPOCH_NS + 1_500_000_000)) == 0.0  # half a second is let pass
    assert watch.look(Instant(12.0, EPOCH_NS + 1_999_000_000)) == pytest.approx(-0.501)
    assert watch.jumped_at == 12.0
    assert watch.look(Instant(13.0, EPOCH_NS + 2_999_000_000)) == 0.0
    assert watch.jumped_at == 12.0


def test_a_grid_keeps_to_its_instants_and_passes_over_what_was_missed() -> None:
    grid = Grid(0.1)
    grid.start(5.0)
    assert grid.due(5.0)
    assert grid.at == pytest.approx(5.1)
    assert not grid.due(5.09)
    assert grid.due(5.1 - 5e-7)  # a timer may be that early
    assert grid.due(5.26)
    assert grid.at == pytest.approx(5.3)
    assert (grid.overruns, grid.skipped) == (0, 0)
    assert grid.due(5.61)  # 5.3 ran late, 5.4 to 5.6 are passed over
    assert grid.at == pytest.approx(5.7)
    assert (grid.overruns, grid.skipped) == (1, 3)
    assert grid.worst_s == pytest.approx(0.31)


def test_a_rate_is_counted_over_two_seconds() -> None:
    rate, at = Rate(), 100.0
    rate.review(at)
    for _ in range(20):
        rate.tick()
    assert rate.review(at + RATE_WINDOW_S - 0.01) == 0.0
    assert rate.review(at + RATE_WINDOW_S) == pytest.approx(10.0)
    assert rate.review(at + 2 * RATE_WINDOW_S) == 0.0


@pytest.mark.parametrize(
    ("link", "baud"),
    [
        ("serial:///dev/ttyS1:115200", 115200), ("serial:///dev/ttyS1", 57600), ("udpin://0.0.0.0:14550", 0),
    ],
)  # fmt: skip
def test_the_name_of_a_serial_link_tells_its_baud_rate(link: str, baud: int) -> None:
    assert baud_of(link) == baud


def test_a_position_is_carried_forward_for_half_a_second_and_wind_is_a_planes_for_ten() -> None:
    t = Telemetry(position=Vec(1.0, 0.0, -9.0), velocity=Vec(4.0, 0.0, 0.0), position_at=100.0,
                  wind=Vec(0.0, 3.0, 0.0), wind_at=95.0)  # fmt: skip
    for now, north in ((99.0, 1.0), (100.25, 2.0), (100.5, 3.0), (104.0, 3.0)):
        assert own_state(now, t, hovers=True).position == pytest.approx((north, 0.0, -9.0))
    assert own_state(104.9, t, hovers=False).wind == Vec(0.0, 3.0, 0.0)
    assert own_state(105.0, t, hovers=False).wind == ZERO
    assert own_state(104.9, t, hovers=True).wind == ZERO


# ---------------------------------------------------------------------- what is told


def test_of_one_kind_twenty_events_in_ten_seconds_are_told_and_the_rest_counted() -> None:
    journal = Journal(2, "g", 1)

    def say(at: float, kind: str = "flood") -> int:
        journal.warning(kind, "again")
        journal.stamp(Instant(at, EPOCH_NS))
        return journal.kinds.get(kind, 0)

    assert [say(100.0) for _ in range(BURST + 2)][-3:] == [BURST, BURST, BURST]
    assert journal.suppressed == 2
    assert say(100.0, "other") == 1
    assert say(109.9) == BURST
    assert say(110.0) == BURST + 1


def test_a_spell_of_clips_is_told_at_its_begin_and_once_it_has_rested_for_five_seconds() -> None:
    spells = ClipSpells()
    told = [
        spells.look(at, Action.PASS, action, Cause.FENCE_AHEAD if action is Action.CLIP else Cause.NONE)
        for at, action in (
            (1.0, Action.CLIP), (2.0, Action.PASS), (6.0, Action.CLIP), (11.0, Action.PASS),
            (11.1, Action.PASS), (12.0, Action.PASS),
        )
    ]  # fmt: skip
    assert [bool(words) for words in told] == [True, False, False, False, True, False]
    assert "2 steps were clipped in 5.0 s" in told[4]
    assert spells.counts == {"clipped_fence_ahead": 2}


# ---------------------------------------------------------------------- masters


def word(name: str, number: int = 1, lease_s: float = 2.0, takes_over: str = "") -> Master:
    return Master(name, EPOCH_NS, lease_s, 5, number, takes_over)


def test_another_master_leads_once_the_lease_has_run_out_and_not_at_its_last_instant() -> None:
    masters = Masters()
    assert masters.hear(word("a"), 10.0) is Hearing.LEADS
    assert masters.hear(word("b"), 12.0) is Hearing.SECOND_MASTER
    assert masters.holds(12.0)
    assert masters.hear(word("b", 2), 12.01) is Hearing.LEADS
    assert masters.name == "b"


@pytest.mark.parametrize(("said", "holds_s"), [(0.0, 0.1), (-5.0, 0.1), (3.0, 3.0), (1e9, 60.0)])
def test_a_lease_is_a_tenth_of_a_second_to_a_minute_whatever_is_said(said: float, holds_s: float) -> None:
    masters = Masters()
    masters.hear(word("a", lease_s=said), 10.0)
    assert masters.holds(10.0 + holds_s - 0.001)
    assert not masters.holds(10.0 + holds_s + 0.001)


def test_a_running_game_is_taken_over_by_name_alone() -> None:
    masters = Masters()
    masters.hear(word("a"), 10.0)
    masters.game_runs = True
    assert masters.hear(word("b"), 20.0) is Hearing.NOT_TAKEN_OVER
    assert masters.hear(word("b", 2, takes_over="c"), 20.1) is Hearing.NOT_TAKEN_OVER
    assert masters.hear(word("b", 3, takes_over="a"), 20.2) is Hearing.LEADS


def test_of_ten_masters_eight_are_kept() -> None:
    masters = Masters()
    found = [masters.hear(word(name), 10.0) for name in "abcdefghij"]
    assert found == [Hearing.LEADS, *[Hearing.SECOND_MASTER] * 7, *[Hearing.OVERFLOW] * 2]
    assert masters.hear(word("i", 2), 12.1) is Hearing.LEADS  # nobody else is left


def test_a_word_is_quoted_for_five_seconds_from_when_it_was_first_heard() -> None:
    words = Words()
    words.add(5, 1, 10.0)
    words.add(5, 1, 14.0)  # again, on its way for long: no newer
    assert words.until(5, 1) == 15.0
    assert words.until(5, 2) < 0.0  # never heard: never
    for number in range(2, WORDS_KEPT + 2):
        words.add(5, number, 10.0)
    assert words.until(5, 1) < 0.0
    assert words.until(5, 2) == 15.0
