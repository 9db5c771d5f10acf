"""A made-up flight for tests of what records and shows: the bus messages of a simple chase.

Pursuers fly at the evader, the evader at its target; nobody thinks. The same arguments give the same
messages. Items are (key, payload, stamp_ns) in order of arrival.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, atan2, cos, sin, sqrt
from typing import NamedTuple

from gcs.picture import station_journal
from onboard.core.math.constants import NS_PER_S
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus import messages, topics
from onboard.wire.bus.messages import (
    AgentStage,
    CommandKind,
    CommandState,
    DecisionLevel,
    DecisionModule,
    Message,
    OutcomeResult,
    Phase,
    Role,
    Severity,
    SupervisorAction,
    Triple,
)

EPOCH_NS = 1_760_000_000 * NS_PER_S
TARGET = (400.0, 100.0, -60.0)


class Item(NamedTuple):
    """One message as it arrived."""

    key: str
    payload: bytes
    stamp_ns: int


def setup(game: str, vehicles: int) -> messages.Setup:
    """Evader 1, pursuers from 2 up on a wide arc ahead."""
    roster = [messages.Member(1, Role.EVADER, 12.0, (0.0, 0.0, -50.0))]
    for index in range(vehicles - 1):
        angle = (index - (vehicles - 2) / 2) * 0.35
        start = (260.0 * cos(angle), 260.0 * sin(angle), -40.0 - 4.0 * (index % 5))
        roster.append(messages.Member(index + 2, Role.PURSUER, 9.0, start))
    return messages.Setup(
        game=game,
        scenario="a chase",
        scenario_hash="0123456789abcdef",
        master="bridge",
        origin=messages.Origin(47.397742, 8.545594, 488.0),
        roster=tuple(roster),
        rules=messages.RulesMessage(5.0, 10.0, epsilon_min=3.0, horizon=60.0, separation=4.0),
        fence=messages.Fence(
            ((-100.0, -400.0), (600.0, -400.0), (600.0, 400.0), (-100.0, 400.0)), 5.0, 150.0
        ),
        track_sigma=0.5,
    )


def chase(
    duration_s: float = 20.0,
    *,
    vehicles: int = 3,
    game: str = "field",
    state_only: bool = False,
    story: bool = True,
) -> Iterator[Item]:
    """The messages of a chase of `duration_s`; `story` adds an outcome, events, commands and alerts."""
    plan = setup(game, vehicles)

    def item(topic: topics.Topic, vehicle: int | None, payload: bytes, at_ns: int) -> Item:
        return Item(topic.key(game, vehicle), payload, at_ns)

    t0_ns = EPOCH_NS + 2 * NS_PER_S
    if not state_only:
        yield item(topics.SETUP, None, topics.SETUP.encode(plan), EPOCH_NS)
        yield item(
            topics.EVADER_BRIEF,
            None,
            topics.EVADER_BRIEF.encode(messages.EvaderBrief(TARGET, EPOCH_NS)),
            EPOCH_NS,
        )
        staging = messages.PhaseChange(Phase.STAGING, 0, EPOCH_NS)
        yield item(topics.PHASE, None, topics.PHASE.encode(staging), EPOCH_NS + 1000)
        for member in plan.roster:
            token = station_journal.Presence(topics.ALIVE.key(game, member.id), True)
            yield entry(game, token, EPOCH_NS + 2000)
    places = {m.id: m.start for m in plan.roster}
    velocities: dict[int, Triple] = {m.id: (0.0, 0.0, 0.0) for m in plan.roster}
    dt = 0.05
    steps = round(duration_s / dt)
    captured = False
    for step in range(steps):
        now_ns = EPOCH_NS + 10_000 + step * 50_000_000
        running = now_ns >= t0_ns and not captured
        time = (now_ns - t0_ns) / NS_PER_S
        if not state_only:
            if step == 20:
                yield item(
                    topics.PHASE,
                    None,
                    topics.PHASE.encode(messages.PhaseChange(Phase.READY, t0_ns, now_ns)),
                    now_ns,
                )
            if step == 40:
                change = messages.PhaseChange(Phase.RUNNING, t0_ns, now_ns)
                yield item(topics.PHASE, None, topics.PHASE.encode(change), now_ns)
            if step % 10 == 0:
                yield item(
                    topics.MASTER,
                    None,
                    topics.MASTER.encode(messages.Master("bridge", now_ns, 2.0, 7)),
                    now_ns,
                )
        for member in plan.roster:
            aim = TARGET if member.role is Role.EVADER else places[1]
            velocity = _towards(places[member.id], aim, member.speed) if running else (0.0, 0.0, 0.0)
            velocities[member.id] = velocity
            at = now_ns + member.id * 1000
            yield item(
                topics.STATE, member.id, topics.STATE.encode(_state(member, places, velocity, time, at)), at
            )
            if state_only:
                continue
            if step % 2 == 0:
                report = _decision(member, places, velocity, aim, time, at)
                yield item(topics.DECISION, member.id, topics.DECISION.encode(report), at + 100)
            if step % 2 == 1:
                track = messages.Track(
                    member.id, at, places[member.id], velocity, (0.25,) * 3 + (0.04,) * 3, "radar"
                )
                yield item(topics.TRACK, member.id, topics.TRACK.encode(track), at + 200)
            if step % 10 == 5:
                yield item(
                    topics.HEALTH,
                    member.id,
                    topics.HEALTH.encode(_health(member, step, running, at)),
                    at + 300,
                )
        if story and not state_only:
            yield from _story(plan, game, step, now_ns + 900_000, time)
        for vehicle, velocity in velocities.items():
            north, east, down = places[vehicle]
            places[vehicle] = (north + velocity[0] * dt, east + velocity[1] * dt, down + velocity[2] * dt)
        smallest = min(_distance(places[1], places[m.id]) for m in plan.roster[1:])
        if story and not state_only and not captured and smallest < plan.rules.R:
            captured = True
            end_ns = now_ns + 950_000
            captor = min(plan.roster[1:], key=lambda m: _distance(places[1], places[m.id])).id
            outcome = messages.Outcome(
                OutcomeResult.CAPTURED, time, captor, smallest, end_ns, f"vehicle {captor} within 5 m"
            )
            yield item(topics.OUTCOME, None, topics.OUTCOME.encode(outcome), end_ns)
            ended = messages.PhaseChange(Phase.ENDED, t0_ns, end_ns)
            yield item(topics.PHASE, None, topics.PHASE.encode(ended), end_ns + 1)


def entry(game: str, message: Message, at_ns: int) -> Item:
    """An entry of the station's journal."""
    topic = next(topic for topic in station_journal.JOURNAL if topic.message is type(message))
    return Item(topic.key(game), topic.encode(message), at_ns)


def _story(plan: messages.Setup, game: str, step: int, now_ns: int, time: float) -> Iterator[Item]:
    """What makes a flight worth a report: an event, and a command that one vehicle is slow to obey."""
    if step == 100:
        event = messages.Event(2, 1, now_ns, Severity.WARNING, "limit", "decision clipped: pitch")
        yield Item(topics.EVENTS.key(game, 2), topics.EVENTS.encode(event), now_ns)
    ids = tuple(m.id for m in plan.roster)
    command = messages.Command("c-1", CommandKind.HOLD, "gcs@field", now_ns)
    if step == 300:
        yield entry(game, station_journal.Sent(command, ids), now_ns)
    for vehicle in ids:
        if step in (302, 303 + 2 * vehicle):
            state = CommandState.PENDING if step == 302 else CommandState.CONFIRMED
            reply = messages.CommandReply("c-1", vehicle, state, "", "gcs@field", now_ns, "LOITER")
            yield entry(game, station_journal.Replied(reply), now_ns + vehicle)


def _towards(place: Triple, aim: Triple, speed: float) -> Triple:
    away = _distance(place, aim)
    if away < 1.0:
        return (0.0, 0.0, 0.0)
    return tuple((b - a) / away * speed for a, b in zip(place, aim, strict=True))  # type: ignore[return-value]


def _distance(a: Triple, b: Triple) -> float:
    return sqrt(sum((x - y) ** 2 for x, y in zip(a, b, strict=True)))


def _state(
    member: messages.Member, places: dict[int, Triple], velocity: Triple, time: float, at_ns: int
) -> messages.State:
    speed = _distance(velocity, (0.0, 0.0, 0.0))
    yaw = atan2(velocity[1], velocity[0]) if speed > 0 else 0.0
    pitch = asin(-velocity[2] / speed) if speed > 0 else 0.0
    wind = (2.0 + 0.5 * sin(time), -1.0, 0.0)
    return messages.State(
        member.id,
        member.role,
        at_ns - 20_000_000,
        places[member.id],
        velocity,
        speed,
        wind,
        0.1,
        pitch,
        yaw,
        "GUIDED",
        True,
        1000 + member.id,
    )


def _decision(
    member: messages.Member, places: dict[int, Triple], velocity: Triple, aim: Triple, time: float, at_ns: int
) -> messages.DecisionReport:
    evader = member.role is Role.EVADER
    rule = "towards_target" if evader else ("intercept" if int(time) % 4 else "close_in")
    cones = ((1.0, 0.0, 0.0, 0.2),) if evader else ()
    return messages.DecisionReport(
        member.id,
        at_ns,
        time,
        DecisionLevel.TACTICAL,
        DecisionModule.GEOMETRIC,
        "paper",
        rule,
        velocity,
        aim,
        _distance(places[member.id], aim) / member.speed,
        2.0,
        cones,
    )


def _health(member: messages.Member, step: int, running: bool, at_ns: int) -> messages.Health:
    battery = max(0.1, 0.95 - 0.0005 * step - 0.05 * member.id)
    quality = 1.0 if member.id != 2 else 0.9
    return messages.Health(
        member.id,
        member.role,
        at_ns,
        AgentStage.ACTING if running else AgentStage.READY,
        (),
        Kind.ARDUCOPTER,
        "GUIDED",
        True,
        battery,
        quality,
        50.0,
        20.0,
        0.002 * member.id,
        3,
        True,
        SupervisorAction.OK,
        "0.1.0",
        {"bad_crc": step // 50},
        0.02,
        0.4,
        1000 + member.id,
    )
