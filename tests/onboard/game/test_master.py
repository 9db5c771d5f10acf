"""The master as flight stories: it stages, starts, judges and ends; it never shares its chair."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import Any

import msgspec
import pytest
from msgspec.structs import replace

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.master import GameMaster, Publication, Standing, Timing
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus import messages
from onboard.wire.bus.messages import (
    AgentStage,
    EvaderBrief,
    Health,
    Master,
    Member,
    Origin,
    Outcome,
    OutcomeResult,
    Phase,
    PhaseChange,
    Role,
    RulesMessage,
    Setup,
    SupervisorAction,
    Track,
)
from onboard.wire.bus.topics import EVADER_BRIEF, MASTER, PHASE, SETUP

WALL0 = 1_767_225_600 * NS_PER_S
STEP = 10_000_000


def setup(**changes: object) -> Setup:
    """Evader 1 against pursuers 2 and 3, R = 5 m, horizon 30 s."""
    members = (
        Member(1, Role.EVADER, 4.0, (0.0, 0.0, -50.0)),
        Member(2, Role.PURSUER, 5.0, (100.0, 0.0, -50.0)),
        Member(3, Role.PURSUER, 5.0, (0.0, 200.0, -50.0)),
    )
    fields: dict[str, object] = dict(
        game="g", scenario="story", scenario_hash="0" * 16, master="bridge", origin=Origin(47.0, 8.0, 400.0),
        roster=members, rules=RulesMessage(5.0, 10.0, horizon=30.0),
    )  # fmt: skip
    return Setup(**(fields | changes))  # type: ignore[arg-type]


def health(
    id: int, stage: AgentStage = AgentStage.READY, nonce: int = 0, lacks: tuple[str, ...] = ()
) -> Health:
    role = Role.EVADER if id == 1 else Role.PURSUER
    return Health(
        id, role, 0, stage, lacks, Kind.ARDUCOPTER, "GUIDED", True, 1.0, 1.0, 20.0, 20.0, 0.0, 3, True,
        SupervisorAction.OK, "0", {}, nonce=nonce or 100 + id,
    )  # fmt: skip


class Range:
    """A master, a clock, and agents that send their heartbeat twice a second."""

    def __init__(self, target: Vec | None = None, timing: Timing | None = None, **changes: object) -> None:
        patience = timing or Timing(ready_s=2.0, timeout_s=20.0)
        targets = {1: () if target is None else (target,)}
        self.master = GameMaster(setup(**changes), targets, "bridge", 50, patience)
        self.now = 0
        self.agents: dict[int, Health] = {}
        self.places = {1: Vec(0, 0, -50), 2: Vec(100, 0, -50), 3: Vec(0, 200, -50)}
        self.speeds = {1: Vec(0, 0, 0), 2: Vec(0, 0, 0), 3: Vec(0, 0, 0)}
        self.said: list[Publication] = []
        self.news: list[str] = []

    def fly(self, seconds: float) -> None:
        for _ in range(round(seconds * NS_PER_S / STEP)):
            self.now += STEP
            if self.now % (NS_PER_S // 2) == 0:
                for agent in self.agents.values():
                    self.master.heard_health(agent, self.now)
            for id, v in self.speeds.items():
                p, dt = self.places[id], STEP / NS_PER_S
                self.places[id] = Vec(p.x + v.x * dt, p.y + v.y * dt, p.z + v.z * dt)
            self.master.tick(WALL0 + self.now, self.now)
            self.master.observe(WALL0 + self.now, self.now, self.places)
            self.said += self.master.outgoing()
            self.news += self.master.news()

    def crew(self) -> None:
        self.agents = {id: health(id) for id in (1, 2, 3)}

    def begin(self) -> None:
        """Until just after t₀."""
        self.crew()
        self.fly(5.0)
        assert self.master.phase is Phase.RUNNING

    def phases(self) -> list[PhaseChange]:
        return [m for _, m, _ in self.said if isinstance(m, PhaseChange)]

    def outcome(self) -> Outcome:
        outcomes = [m for _, m, _ in self.said if isinstance(m, Outcome)]
        assert len(outcomes) == 1
        return outcomes[0]


def test_it_begins_when_everybody_can_be_at_its_place() -> None:
    field = Range()
    field.crew()
    field.agents[3] = replace(health(3), place_s=12.0)
    field.fly(1.5)
    assert field.master.phase is Phase.READY
    assert field.master.t0_ns == pytest.approx(WALL0 + field.phases()[-1].stamp_ns - WALL0 + 12 * NS_PER_S)
    said = field.master.t0_ns
    field.agents = {id: health(id) for id in (1, 2, 3)}
    field.agents[2] = replace(health(2), place_s=3.0)  # it was turned away, and is late
    field.fly(1.3)
    field.crew()
    field.fly(2.0)
    assert field.master.t0_ns == said + 3 * NS_PER_S
    assert "vehicle 2 needs 3 s more" in field.phases()[-1].reason
    field.fly(14.0)
    assert field.master.phase is Phase.RUNNING


def test_in_a_plane_game_it_is_at_its_target_whatever_the_heights() -> None:
    rules = RulesMessage(5.0, 10.0, horizon=30.0, planar=True)
    field = Range(target=Vec(-40, 0, -80), rules=rules)
    field.begin()
    field.places[1] = Vec(-36, 0, -50)
    field.speeds[1] = Vec(-4, 0, 0)
    field.fly(2.0)
    assert field.outcome().verdict is OutcomeResult.ARRIVED


def test_it_puts_t0_off_for_three_minutes_at_most() -> None:
    field = Range()
    field.crew()
    field.agents[2] = replace(health(2), place_s=9.0)  # whatever it is given, it will be late by 9 s
    field.fly(190.0)
    assert field.master.phase is Phase.RUNNING
    assert field.master.t0_ns - WALL0 < 183 * NS_PER_S
    assert any("vehicle 2 will not be at its place" in line for line in field.news)


def test_it_listens_then_stages_then_waits_for_everybody() -> None:
    field = Range(target=Vec(500, 0, -50))
    field.fly(1.1)
    assert field.said == []  # somebody else might be the master
    field.fly(0.2)
    assert [p.topic for p in field.said[:2]] == [SETUP, EVADER_BRIEF]
    brief = field.said[1].message
    assert isinstance(brief, EvaderBrief)
    assert brief.target == (500.0, 0.0, -50.0)
    assert "500" not in str(field.said[0].message)  # the setup keeps the evader's secret
    field.agents = {1: health(1), 2: health(2, AgentStage.WAITING, lacks=("autopilot",))}
    field.fly(5.0)
    assert field.master.phase is Phase.STAGING
    assert field.master.lacking(WALL0 + field.now, field.now) == {
        2: "waiting: autopilot",
        3: "no agent heard",
    }
    field.crew()
    field.fly(1.0)
    ready = field.phases()[-1]
    assert ready.phase is Phase.READY
    assert ready.t0_ns == ready.stamp_ns + 2 * NS_PER_S
    field.fly(2.5)
    running = field.phases()[-1]
    assert running.phase is Phase.RUNNING
    assert running.t0_ns == ready.t0_ns
    assert 0 <= running.stamp_ns - running.t0_ns <= STEP


def test_the_lease_is_renewed_twice_a_second() -> None:
    field = Range()
    field.fly(11.2)
    leases = [m for _, m, _ in field.said if isinstance(m, Master)]
    assert len(leases) == 20  # the first 1.2 s it listened
    assert {b.stamp_ns - a.stamp_ns for a, b in pairwise(leases)} == {NS_PER_S // 2}
    assert {(m.name, m.nonce, m.lease_s) for m in leases} == {("bridge", 50, 2.0)}


def test_a_capture_is_judged_at_its_instant_between_two_steps() -> None:
    field = Range()
    field.begin()
    t0 = field.phases()[-1].t0_ns
    elapsed = (WALL0 + field.now - t0) / NS_PER_S
    field.places[2] = Vec(100.0, 0, -50)
    field.speeds[2] = Vec(-30.0, 0, 0)
    field.fly(8.0)
    outcome = field.outcome()
    assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, 2)
    assert outcome.time == pytest.approx(elapsed + 95.0 / 30.0, abs=1e-6)
    assert outcome.smallest_distance == pytest.approx(5.0)
    assert field.master.nearest[2] == pytest.approx(5.0)
    assert field.master.nearest[3] == pytest.approx(200.0)
    assert [p.phase for p in field.phases()][-2:] == [Phase.ENDED, Phase.RECOVERY]


def test_a_pursuer_that_flies_through_between_two_steps_has_captured() -> None:
    field = Range()
    field.begin()
    field.places[2] = Vec(100.0, 0, -50)
    field.fly(0.01)
    field.places[2] = Vec(-100.0, 0, -50)  # 200 m in one step
    field.fly(0.01)
    assert field.outcome().captor == 2


def test_an_evader_at_its_target_has_arrived() -> None:
    field = Range(target=Vec(0, -50, -50))
    field.begin()
    field.speeds[1] = Vec(0, -10, 0)
    field.fly(6.0)
    assert field.outcome().verdict == OutcomeResult.ARRIVED
    assert field.outcome().captor == 0


def test_an_evader_that_nobody_catches_has_escaped_at_the_horizon() -> None:
    field = Range()
    field.begin()
    field.fly(40.0)
    assert field.outcome().verdict == OutcomeResult.ESCAPED
    assert field.outcome().time == 30.0


def test_a_target_that_a_pursuer_holds_at_the_horizon_is_denied() -> None:
    field = Range(target=Vec(0, 400, -50))
    field.places[2] = Vec(0.0, 390.0, -50.0)
    field.begin()
    field.fly(40.0)
    assert (field.outcome().verdict, field.outcome().time) == (OutcomeResult.DENIED, 30.0)


PLANE = RulesMessage(5.0, 10.0, horizon=30.0, planar=True)


@pytest.mark.parametrize(("changes", "verdict"), [({}, OutcomeResult.ESCAPED),
    ({"rules": PLANE}, OutcomeResult.CAPTURED),
    ({"field_profile": True}, OutcomeResult.CAPTURED),
])  # fmt: skip
def test_plane_games_and_altitude_layers_are_judged_level(
    changes: dict[str, Any], verdict: OutcomeResult
) -> None:
    field = Range(**changes)
    field.begin()
    field.places[3] = Vec(1.0, 1.0, -90.0)  # 40 m above the evader
    field.fly(40.0)
    assert field.outcome().verdict == verdict


def test_who_is_not_ready_in_time_is_named() -> None:
    field = Range()
    field.agents = {1: health(1), 2: health(2)}
    field.fly(25.0)
    outcome = field.outcome()
    assert outcome.verdict == OutcomeResult.ABORTED
    assert outcome.reason == "not ready in time: vehicle 3: no agent heard"
    assert field.phases()[-1].phase is Phase.RECOVERY


def test_an_agent_lost_in_the_countdown_takes_everybody_back_to_staging() -> None:
    field = Range(timing=Timing(ready_s=5.0))
    field.crew()
    field.fly(2.0)
    assert field.master.phase is Phase.READY
    del field.agents[3]
    field.fly(4.0)
    assert field.phases()[-1].phase is Phase.STAGING
    assert field.phases()[-1].t0_ns == 0
    assert field.phases()[-1].reason == "vehicle 3: agent silent"
    field.crew()
    field.fly(8.0)
    assert field.master.phase is Phase.RUNNING


def acting(field: Range, id: int) -> None:
    """The agent flies."""
    field.agents[id] = health(id, AgentStage.ACTING)
    field.fly(0.5)


@pytest.mark.parametrize(
    ("flew", "dead_s", "changes"),
    [
        (True, 4.0, {"mode": "LOITER"}),
        (True, 4.0, {"mode": "RTL"}),
        (True, 4.0, {"autopilot": None, "mode": ""}),
        (True, 4.0, {"autopilot": Kind.PX4_MULTICOPTER, "mode": "HOLD"}),
        (True, 11.0, {}),
        (False, 4.0, {}),
    ],
)
def test_a_restarted_agent_that_finds_its_vehicle_otherwise_needs_a_person(
    flew: bool, dead_s: float, changes: dict[str, object]
) -> None:
    field = Range()
    field.crew()
    if not flew:
        field.agents[3] = msgspec.structs.replace(health(3), mode="LOITER")
    field.fly(5.0)
    assert field.master.phase is Phase.RUNNING
    if flew:
        acting(field, 3)
    del field.agents[3]
    field.fly(dead_s)
    waiting = health(3, AgentStage.WAITING, nonce=999)
    field.agents[3] = msgspec.structs.replace(waiting, **changes)
    field.fly(3.0)
    assert not any(phase.resume for phase in field.phases())
    if changes.get("autopilot", True):
        assert sum("a person's resume is needed" in line for line in field.news) == 1
    field.agents[3] = health(3, AgentStage.ACTING, nonce=999)  # the person has spoken
    field.fly(1.0)
    assert field.phases()[-1].phase is Phase.RUNNING


def test_a_restarted_agent_acts_again_only_with_the_masters_word() -> None:
    field = Range()
    field.begin()
    acting(field, 3)
    del field.agents[3]
    field.fly(4.0)
    assert field.news[-1] == "agent 3 is silent"
    field.agents[3] = health(3, AgentStage.WAITING, nonce=999, lacks=("the master's word",))
    field.fly(1.0)
    assert field.phases()[-1].resume == (3,)
    assert field.phases()[-1].phase is Phase.RUNNING
    field.agents[3] = health(3, AgentStage.ACTING, nonce=999)
    field.fly(1.0)
    assert field.phases()[-1].resume == ()  # said once: a third process must ask again
    assert len([p for p in field.phases() if p.resume]) == 1


def test_who_was_killed_at_t0_before_it_could_say_that_it_plays_acts_again() -> None:
    """It flew to its place, guided and ready: the master saw it in control."""
    field = Range()
    field.begin()
    del field.agents[3]  # its last heartbeat said: ready, in GUIDED
    field.fly(3.0)
    field.agents[3] = health(3, AgentStage.WAITING, nonce=999, lacks=("the master's word",))
    field.fly(1.0)
    assert field.phases()[-1].resume == (3,)


def test_a_restart_within_one_heartbeat_is_a_restart_and_not_a_double() -> None:
    field = Range()
    field.begin()
    acting(field, 3)
    field.agents[3] = health(3, AgentStage.WAITING, nonce=999)
    field.fly(1.0)
    assert field.phases()[-1].resume == ()  # the old process might still be alive
    field.fly(2.0)
    assert field.phases()[-1].resume == (3,)
    assert not any("two agents" in line for line in field.news)


def test_two_agents_with_one_id_are_named_and_neither_is_resumed() -> None:
    field = Range()
    field.begin()
    for _ in range(6):
        field.fly(0.25)
        field.master.heard_health(health(3, AgentStage.WAITING, nonce=999), field.now)
    field.fly(0.5)
    assert "two agents speak as vehicle 3: stop one" in field.news
    assert all(p.resume == () for p in field.phases())


def test_two_agents_with_one_id_keep_the_game_from_starting() -> None:
    field = Range()
    field.crew()
    for _ in range(12):
        field.fly(0.25)
        field.master.heard_health(health(2, nonce=777), field.now)
    assert field.master.phase is Phase.STAGING
    assert field.master.lacking(WALL0 + field.now, field.now) == {2: "two agents with this id"}


def test_who_hears_another_master_yields_and_says_nothing() -> None:
    field = Range()
    field.master.heard_master(Master("gcs", WALL0, nonce=1), 0)
    field.crew()
    field.fly(10.0)
    assert field.master.standing is Standing.YIELDED
    assert field.said == []
    assert field.news == ["another master is at work: gcs; this one yields and publishes no game"]


def tracked_evader() -> tuple[Member, ...]:
    first, *rest = setup().roster
    return (msgspec.structs.replace(first, tracked=True), *rest)


def seen(at_ns: int, sigma: float = 5.0) -> Track:
    p = sigma**2 / 3.0
    return Track(1, WALL0 + at_ns, (0.0, 0.0, -50.0), (0.0, 0.0, 0.0), (p, p, p, 4.0, 4.0, 4.0), "radar")


@pytest.mark.parametrize(
    ("track", "lacks"),
    [
        (None, "no track heard"),
        (seen(4 * NS_PER_S), ""),
        (seen(-10 * NS_PER_S), "its track is 15 s old"),
        (seen(3600 * NS_PER_S), "its track is stamped 3595 s ahead: compare the sensor's clock"),
        (seen(4 * NS_PER_S, sigma=250.0), "its track is good to 250 m only, expected at most 100 m"),
    ],
)
def test_an_evader_known_by_tracks_alone_is_ready_when_its_track_is_fresh_and_good(
    track: Track | None, lacks: str
) -> None:
    field = Range(roster=tracked_evader())
    field.agents = {id: health(id) for id in (2, 3)}
    field.fly(4.9)
    if track is not None:
        field.master.heard_track(track)
    field.fly(0.1)
    assert field.master.lacking(WALL0 + field.now, field.now) == ({1: lacks} if lacks else {})
    assert field.master.phase is (Phase.STAGING if lacks else Phase.READY)


def test_who_has_a_good_track_and_no_agent_is_told_how_to_play_it() -> None:
    field = Range()
    field.agents = {id: health(id) for id in (2, 3)}
    field.fly(2.0)
    field.master.heard_track(seen(field.now))
    words = field.master.lacking(WALL0 + field.now, field.now)[1]
    assert words.startswith("no agent heard, but a good track: evader.tracked = true")


def test_a_game_whose_evader_nobody_sees_any_more_ends_with_the_reason() -> None:
    field = Range()
    field.begin()
    del field.places[1], field.speeds[1]
    field.fly(9.9)
    assert field.master.phase is Phase.RUNNING
    field.fly(0.3)
    outcome = field.outcome()
    assert (outcome.verdict, outcome.reason) == (OutcomeResult.ABORTED, "nobody has seen vehicle 1 for 10 s")


def test_of_two_that_began_at_once_exactly_one_stays() -> None:
    low, high = Range(), Range()
    high.master.nonce = 60
    for _ in range(30):
        low.fly(0.1)
        high.fly(0.1)
        for speaker, hearer in ((low, high), (high, low)):
            for _, message, _ in speaker.said:
                if isinstance(message, Master):
                    hearer.master.heard_master(message, hearer.now)
    assert low.master.standing is Standing.HOLDING
    assert high.master.standing is Standing.YIELDED
    assert any("second master" in line for line in low.news)


def test_its_own_echo_is_no_second_master() -> None:
    field = Range()
    field.fly(2.0)
    field.master.heard_master(Master("bridge", WALL0, nonce=50), field.now)
    assert field.master.standing is Standing.HOLDING


def test_an_abort_ends_the_game_with_its_reason() -> None:
    field = Range()
    field.begin()
    field.master.abort(WALL0 + field.now, field.now, "range is hot")
    field.fly(0.1)
    assert field.outcome().verdict == OutcomeResult.ABORTED
    assert field.outcome().time > 0
    assert field.phases()[-1].reason == "range is hot"


def test_a_game_without_auto_start_waits_for_the_word() -> None:
    field = Range(timing=Timing(ready_s=1.0, auto_start=False))
    field.crew()
    field.fly(10.0)
    assert field.master.phase is Phase.STAGING
    field.master.start()
    field.fly(2.0)
    assert field.master.phase is Phase.RUNNING


def test_strangers_are_reported_once_and_ignored() -> None:
    field = Range()
    for _ in range(5):
        field.master.heard_health(health(9), field.now)
    field.begin()
    assert field.news.count("vehicle 9 is not in the roster: ignored") == 1


def test_everything_it_says_passes_the_wire() -> None:
    field = Range(target=Vec(500, 0, -50))
    field.begin()
    codecs: dict[type, messages.Codec[Any]] = {
        Setup: SETUP,
        PhaseChange: PHASE,
        Master: MASTER,
        EvaderBrief: EVADER_BRIEF,
    }
    drops = Counter[str]()
    for _, message, _ in field.said:
        codec = codecs[type(message)]
        assert codec.decode(codec.encode(message), drops) == message
    assert not drops
