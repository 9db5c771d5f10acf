"""One agent at its time limits and bounds: what holds just before, and no longer just after."""

from __future__ import annotations

import msgspec
import pytest

from onboard.agent.core.events import BusMessage, End, Instant, LinkBytes, LinkFacts, Outbox, Stop, Tick
from onboard.agent.core.hands import GIVEN_S
from onboard.agent.core.mavlink_radio import PEERS_MAX, Radio
from onboard.agent.core.signing_watch import HEARD_S, SigningWatch
from onboard.agent.core.to_place import approach_of, own_state
from onboard.autopilot.base import Stage
from onboard.core.game.rules import Rules
from onboard.core.math.constants import NEVER
from onboard.core.safety.policy import Envelope, Policy
from onboard.pilot.setup import GameSetup, Player, Side
from onboard.runtime.loop import EPOCH_NS
from onboard.wire.bus import topics
from onboard.wire.bus.messages import Command, CommandKind, CommandState, Member, Phase, Quote, Role
from onboard.wire.mavlink.commands import OwnHeartbeat
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.signing import MemoryStore, Signing
from tests.support.lone_agent import GAME, VEHICLE, LoneAgent, playing


def heard(agent: LoneAgent, message: MavMessage, system: int = VEHICLE, component: int = 1) -> None:
    """A frame of somebody's arrives."""
    agent.do(LinkBytes(0, 1, DialectSender(system, component).pack(message)))


def said(agent: LoneAgent, kind: str) -> int:
    return agent.core.journal.kinds.get(kind, 0)


# ---------------------------------------------------------------------- control


@pytest.mark.parametrize(("mode", "status"), [("RTL", 4), ("LAND", 4), ("LOITER", 5), ("LOITER", 4)])
def test_by_itself_an_agent_ends_no_way_home_no_landing_and_no_failsafe(mode: str, status: int) -> None:
    agent = LoneAgent(take_control=True)
    agent.autopilot.mode, agent.autopilot.status = MODES[Kind.ARDUCOPTER][mode], status
    agent.run(1.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    agent.master.phase(Phase.READY, 3.0)
    agent.run(2.0)
    takes = mode == "LOITER" and status == 4
    assert agent.autopilot.mode_name == ("GUIDED" if takes else mode)


def test_what_a_person_gave_is_there_for_five_seconds() -> None:
    agent = LoneAgent()
    agent.run(1.0)
    hands = agent.core.flight.hands
    hands.give(agent.s)
    assert hands.given(agent.s + GIVEN_S - 0.01)
    assert not hands.given(agent.s + 5.0)
    hands.give(agent.s)
    hands.entered()
    assert not hands.given(agent.s)


def test_of_64_orders_each_is_answered_as_it_stands_and_of_an_older_one_that_it_is_old() -> None:
    agent = playing()
    assert agent.order(Command("a", CommandKind.HOLD, "x", 0)).state is CommandState.PENDING
    agent.run(1.0)
    for n in range(63):
        agent.order(Command(f"s-{n}", CommandKind.START, "x", 0, quote=Quote(0, 0, 1)))
    assert agent.order(Command("a", CommandKind.HOLD, "x", 0)).state is CommandState.CONFIRMED
    agent.order(Command("one more", CommandKind.START, "x", 0, quote=Quote(0, 0, 1)))
    assert agent.order(Command("a", CommandKind.HOLD, "x", 0)).state is CommandState.SUPERSEDED


def test_where_the_supervisor_would_send_it_home_at_once_a_person_is_refused() -> None:
    agent = LoneAgent(take_control=False)
    agent.autopilot.battery = 10
    agent.run(2.0)
    nonce, number = agent.core.bus.masters.last or (0, 0)
    quote = Quote(nonce, number, agent.core.facts.nonce, "")
    reply = agent.order(Command("s", CommandKind.START, "x", 0, quote=quote))
    assert reply.state is CommandState.REFUSED
    assert "it would not fly" in reply.reason


@pytest.mark.parametrize(("heard_s", "regains"), [(0.5, True), (4.5, True), (7.0, False)])
def test_a_px4_that_fell_to_hold_in_a_silence_is_asked_again_within_six_seconds_of_it(
    heard_s: float, regains: bool
) -> None:
    """Later it is a person's HOLD."""
    agent = playing(Kind.PX4_MULTICOPTER)
    agent.autopilot.talks = False
    agent.run(1.5)
    agent.autopilot.talks = True
    agent.run(heard_s)
    agent.autopilot.mode = MODES[Kind.PX4_MULTICOPTER]["HOLD"]
    agent.run(3.0)
    assert said(agent, "regain") == regains
    assert agent.autopilot.mode_name == ("OFFBOARD" if regains else "HOLD")


def test_a_vehicle_that_confirms_nothing_is_left_unconfirmed_within_a_second_and_a_half() -> None:
    agent = playing()
    agent.autopilot.talks = False
    begun = agent.s
    effects = agent.do(Stop())
    while not any(isinstance(effect, End) for effect in effects):
        assert agent.s < begun + 5.0
        effects = agent.step()
    assert agent.s - begun == pytest.approx(1.4, abs=0.11)


# ---------------------------------------------------------------------- its steps


def test_a_step_is_made_by_the_timer_a_third_of_a_period_after_a_position_that_does_not_come() -> None:
    agent = playing()
    steps = agent.core.steps
    for passed, made in ((0.060, 0), (0.006, 1)):
        agent.s += passed
        agent.wall_ns += round(passed * 1e9)
        agent.do(Tick())
        assert agent.core.steps == steps + made


def test_after_one_position_that_did_not_come_steps_go_with_the_positions_again() -> None:
    """The timer's step is 65 ms after the last one, the next position 35 ms after that."""
    agent = playing()
    steps, by_timer = agent.core.steps, agent.core.timer_steps
    for passed in (0.065, 0.035):
        agent.s += passed
        agent.wall_ns += round(passed * 1e9)
        for frame in agent.autopilot.says(agent.s) if passed == 0.035 else ():
            agent.do(LinkBytes(0, 1, frame))
        agent.do(Tick())
    assert (agent.core.steps, agent.core.timer_steps) == (steps + 2, by_timer + 1)


def test_who_was_not_told_that_the_game_runs_flies_to_its_place_for_a_second_after_the_start() -> None:
    agent = LoneAgent()
    agent.run(1.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    agent.master.phase(Phase.READY, 1.0)
    agent.run(1.9)
    own = own_state(agent.s, agent.core.vehicle.telemetry, hovers=True)
    assert agent.core.part.approach(agent.now, own) is not None
    agent.run(0.2)
    assert agent.core.part.approach(agent.now, own) is None


# ---------------------------------------------------------------------- what it lacks


def test_a_master_is_lacking_once_it_was_silent_for_five_seconds() -> None:
    agent = playing()
    agent.master.on = False
    agent.run(4.4)
    assert "a master" not in agent.core.lacks
    agent.run(1.2)
    assert "a master" in agent.core.lacks


def test_another_agent_with_its_id_is_told_again_after_half_a_minute() -> None:
    agent = playing()
    assert agent.health is not None
    twin = msgspec.structs.replace(agent.health, nonce=agent.core.facts.nonce + 1)
    key, payload = topics.HEALTH.key(GAME, VEHICLE), topics.HEALTH.encode(twin)
    for at_s, told in ((0.0, 1), (29.0, 1), (31.0, 2)):
        agent.core.handle(BusMessage(key, payload), agent.now._replace(s=agent.s + at_s))
        assert said(agent, "double_id") == told


def test_the_other_systems_on_a_link_are_named_where_no_autopilot_is_found_and_at_most_sixteen() -> None:
    agent = LoneAgent()
    agent.autopilot.talks = False
    for system in range(100, 120):
        heard(agent, dialect.MAVLink_heartbeat_message(2, 3, 0, 0, 4, 3), system)
    agent.run(1.0)
    assert f"an autopilot (heard: system {', '.join(map(str, range(100, 116)))})" in agent.core.lacks


def test_components_that_beat_as_the_vehicle_are_named_once_and_eight_at_most() -> None:
    agent = LoneAgent()
    for _ in range(2):
        for component in range(150, 160):
            heard(agent, dialect.MAVLink_heartbeat_message(26, 8, 0, 0, 4, 3), component=component)
    assert agent.core.vehicle.components == list(range(150, 158))
    assert said(agent, "component") == 8


# ---------------------------------------------------------------------- the own autopilot


def version(uid: int) -> MavMessage:
    return dialect.MAVLink_autopilot_version_message(0, 0, 0, 0, 0, [0] * 8, [0] * 8, [0] * 8, 0, 0, uid)


def test_two_boards_with_one_id_are_told_by_their_uids_again_after_ten_seconds_and_no_uid_is_none() -> None:
    agent = LoneAgent()
    agent.run(0.5)
    for uid in (0, 7, 7, 0):  # a board that does not say its uid is no other board
        heard(agent, version(uid))
    assert said(agent, "second_autopilot") == 0
    agent = LoneAgent()
    agent.run(0.5)
    heard(agent, version(7))
    heard(agent, version(8))
    assert said(agent, "second_autopilot") == 1
    agent.run(9.0)
    heard(agent, version(8))
    agent.run(9.0)  # it goes on: no news
    heard(agent, version(8))
    assert said(agent, "second_autopilot") == 1
    agent.run(10.5)
    heard(agent, version(8))
    assert said(agent, "second_autopilot") == 2


def test_a_position_that_jumped_is_told_once_it_has_not_counted_for_half_a_second() -> None:
    agent = playing()
    agent.autopilot.place = agent.autopilot.place._replace(x=200.0)
    agent.run(0.4)
    assert said(agent, "position_jump") == 0
    agent.run(0.4)
    assert said(agent, "position_jump") == 1


def test_a_px4_takes_off_to_its_height_above_where_it_stands_in_metres_above_the_sea() -> None:
    agent = LoneAgent(Kind.PX4_MULTICOPTER, may_arm=True, take_off_height=40.0)
    vehicle = agent.autopilot
    vehicle.landed = dialect.MAV_LANDED_STATE_ON_GROUND
    vehicle.place = vehicle.place._replace(z=-12.0)  # home lies 12 m below: what is set 40 m above it
    agent.run(2.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(4.0)
    heights = [seventh for _, command, seventh in vehicle.orders if command == dialect.MAV_CMD_NAV_TAKEOFF]
    assert heights
    assert heights[-1] == pytest.approx(400.0 + 40.0, abs=0.1)


@pytest.mark.parametrize("talks", [True, False])
def test_a_hold_is_judged_by_fresh_positions_alone(talks: bool) -> None:
    """A link that falls silent while the vehicle rises a little brings no word of a lost hold."""
    agent = playing()
    agent.order(Command("h", CommandKind.HOLD, "x", 0))
    agent.run(4.0)
    assert agent.core.vehicle.stage is Stage.LEFT
    assert said(agent, "held") == 1
    agent.autopilot.place = agent.autopilot.place._replace(z=-52.5)
    agent.run(0.1)
    agent.autopilot.talks = talks
    agent.run(3.0)
    assert said(agent, "hold_lost") == talks


@pytest.mark.parametrize(("up", "climbs"), [(19.0, True), (21.0, False)])
def test_a_px4_plane_that_circles_is_up_from_half_its_height_on(up: float, climbs: bool) -> None:
    """It accepts a height ten metres off and circles there: HOLD is its own word that it is up."""
    agent = LoneAgent(Kind.PX4_PLANE, may_arm=True, take_off_height=40.0)
    vehicle = agent.autopilot
    vehicle.parameters["FW_AIRSPD_TRIM"] = 15.0
    vehicle.mode, vehicle.speed = MODES[Kind.PX4_PLANE]["TAKEOFF"], 0.0
    vehicle.landed, vehicle.place = 1, vehicle.place._replace(z=0.0)
    agent.run(2.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    assert agent.core.flight.take_off.climbing
    vehicle.landed = 2
    for height in range(1, 1 + int(up)):
        vehicle.place = vehicle.place._replace(z=-float(height))
        agent.run(0.2)
    assert agent.core.flight.take_off.climbing
    vehicle.mode = MODES[Kind.PX4_PLANE]["HOLD"]
    agent.run(0.5)
    assert agent.core.flight.take_off.climbing == climbs


# ---------------------------------------------------------------------- links


def test_sixteen_peers_of_a_link_are_kept_apart_and_one_more_makes_one_forgotten() -> None:
    radio = Radio([LinkFacts("wire", False)], 2, Outbox())
    beat = Sender(255, 190).pack(OwnHeartbeat(), EPOCH_NS)
    for peer in range(PEERS_MAX):
        radio.take(0, peer, beat[:5], Instant(0.0, EPOCH_NS))
    assert radio.causes["peers_forgotten"] == 0
    assert len(radio.take(0, 0, beat[5:], Instant(0.0, EPOCH_NS)).packets) == 1  # its first half is kept
    radio.take(0, 16, beat[:5], Instant(0.0, EPOCH_NS))
    assert radio.causes["peers_forgotten"] == 1
    assert PEERS_MAX == 16


def test_five_frames_that_do_not_fit_the_key_are_a_cause_while_the_autopilot_is_not_heard() -> None:
    radio = Radio([LinkFacts("wire", False)], 2, Outbox(), signing=Signing(bytes(32), MemoryStore()))
    watch = SigningWatch(radio)
    for _ in range(4):
        radio.take(0, 0, Sender(2, 1).pack(OwnHeartbeat(), EPOCH_NS), Instant(0.0, EPOCH_NS))
    assert watch.trouble(10.0, NEVER) == ""
    radio.take(0, 0, Sender(2, 1).pack(OwnHeartbeat(), EPOCH_NS), Instant(0.0, EPOCH_NS))
    assert watch.trouble(10.0, 10.0 - HEARD_S) == ""  # it is heard: somebody else's
    for _ in range(5):
        radio.take(0, 0, Sender(2, 1).pack(OwnHeartbeat(), EPOCH_NS), Instant(0.0, EPOCH_NS))
    assert "unsigned" in watch.trouble(10.0, 10.0 - HEARD_S - 0.01)


# ---------------------------------------------------------------------- to its place


@pytest.mark.parametrize(
    ("declared", "speed", "slowest"),
    [(18.0, 18.0, 12.6), (25.0, 20.0, 12.6), (0.0, 20.0, 12.6), (12.0, 12.0, 12.0)],
)
def test_a_plane_flies_to_its_place_no_faster_than_it_may_and_a_little_above_its_least(
    declared: float, speed: float, slowest: float
) -> None:
    envelope = Envelope(hovers=False, speed_min=12.0, speed_max=20.0)
    game = GameSetup((Player(2, Side.PURSUER, declared, height=80.0),), Rules(R=5.0, rho=10.0))
    found = approach_of(Member(2, Role.PURSUER, declared, (1.0, 2.0, -3.0)), game, Policy(envelope=envelope))
    assert found is not None
    assert found.place.position == (1.0, 2.0, -80.0)
    assert (found.place.speed, found.place.slowest) == pytest.approx((speed, slowest))
