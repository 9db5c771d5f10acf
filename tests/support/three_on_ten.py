"""A made-up flight of three evaders and ten pursuers, for tests of what shows games of several evaders.

Evaders 1, 12 and 13 fly to their targets (12 has two), pursuers 2 to 11 fly ahead of the evader that each is
after; nobody thinks. One evader is captured, one arrives, one escapes. Items as those of `chase_messages`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, hypot

from onboard.core.game.rules import Target
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.core.strategy.semantic.model import MODEL
from onboard.core.strategy.team.plan_types import Heights, Member
from onboard.game.knowledge_words import known_of, message
from onboard.game.odds import engagement
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus import knowledge_messages, messages, team_messages, topics
from onboard.wire.bus.messages import (
    AgentStage,
    DecisionLevel,
    DecisionModule,
    EvaderOutcome,
    Message,
    OutcomeResult,
    Phase,
    Role,
    SupervisorAction,
    Triple,
)
from onboard.wire.bus.team_messages import PartReason, TeamRole
from tests.support.chase_messages import EPOCH_NS, Item

R = 8.0
HORIZON_S = 34.0
UP = -50.0
EVADERS = (1, 12, 13)
STARTS: dict[int, Triple] = {1: (0.0, 0.0, UP), 12: (-60.0, 160.0, UP - 10.0), 13: (-40.0, -170.0, UP)}
TARGETS: dict[int, tuple[Triple, ...]] = {
    1: ((420.0, 0.0, UP),), 12: ((260.0, 330.0, UP), (330.0, 140.0, UP)), 13: ((300.0, -420.0, UP),),
}  # fmt: skip
AFTER = {2: 1, 3: 1, 4: 1, 5: 1, 6: 12, 7: 12, 8: 12, 9: 13, 10: 13, 11: 13}
ZONES = (
    messages.Zone("mast", ((150.0, 60.0), (190.0, 60.0), (190.0, 100.0), (150.0, 100.0)), high=90.0),
    messages.Zone("village", ((90.0, -120.0), (160.0, -150.0), (190.0, -90.0), (130.0, -60.0))),
)
FENCE = ((-200.0, -600.0), (700.0, -600.0), (700.0, 600.0), (-200.0, 600.0))
ROLES = (TeamRole.CHASER, TeamRole.RING, TeamRole.GOALKEEPER, TeamRole.BLOCKER)
OFF = {2: 0.0, 3: 55.0, 4: -55.0, 5: 240.0, 6: 190.0, 7: 240.0, 8: 300.0, 9: 150.0, 10: 210.0, 11: 260.0}


def setup(game: str = "field") -> messages.Setup:
    """The game."""
    places = _starts()
    order = (1, *AFTER, 12, 13)
    roster = tuple(
        messages.Member(i, Role.EVADER, 12.0, places[i]) if i in EVADERS
        else messages.Member(i, Role.PURSUER, 9.0, places[i])
        for i in order
    )
    return messages.Setup(
        game=game, scenario="three on ten", scenario_hash="00000000deadbeef", master="bridge",
        origin=messages.Origin(47.397742, 8.545594, 488.0), roster=roster,
        rules=messages.RulesMessage(R, 2.0 * R, horizon=HORIZON_S),
        fence=messages.Fence(FENCE, 5.0, 150.0),
        track_sigma=0.5, zones=ZONES,
    )  # fmt: skip


def _starts() -> dict[int, Triple]:
    """Pursuers stand ahead of their evader on its way, to both sides."""
    found = dict(STARTS)
    for number, (id, evader) in enumerate(AFTER.items()):
        (n, e, d), (tn, te, _) = STARTS[evader], TARGETS[evader][0]
        share, side = 0.45 + 0.04 * (number % 4), OFF[id] * (-1.0) ** number
        long = hypot(tn - n, te - e)
        u, w = (tn - n) / long, (te - e) / long
        found[id] = (n + share * (tn - n) - w * side, e + share * (te - e) + u * side, d + 3.0 * (number % 3))
    return found


class _Game:
    """Where everybody is."""

    def __init__(self) -> None:
        self.places = _starts()
        self.ways: dict[int, Triple] = dict.fromkeys(self.places, (0.0, 0.0, 0.0))
        self.nearest = dict.fromkeys(EVADERS, float("inf"))
        self.out: list[EvaderOutcome] = []

    def playing(self) -> list[int]:
        gone = {one.id for one in self.out}
        return [id for id in EVADERS if id not in gone]

    def quarry(self, pursuer: int) -> int:
        """The one that it was set on, while that plays, else the nearest."""
        playing = self.playing()
        if not playing or AFTER[pursuer] in playing:
            return AFTER[pursuer]
        return min(playing, key=lambda id: apart(self.places[pursuer], self.places[id]))

    def step(self, dt: float, time: float) -> None:
        playing = self.playing()
        for id in EVADERS:
            self.ways[id] = _to(self.places[id], TARGETS[id][0], 12.0) if id in playing else (0.0, 0.0, 0.0)
        for id in AFTER:
            evader = self.quarry(id)
            at, way = self.places[evader], self.ways[evader]
            ahead = min(8.0, apart(self.places[id], at) / 21.0)
            aim = tuple(a + ahead * v for a, v in zip(at, way, strict=True))
            self.ways[id] = _to(self.places[id], aim, 9.0)
        for id, way in self.ways.items():
            self.places[id] = tuple(a + dt * v for a, v in zip(self.places[id], way, strict=True))
        for id in playing:
            self._judge(id, time)

    def _judge(self, id: int, time: float) -> None:
        near, captor = min((apart(self.places[p], self.places[id]), p) for p in AFTER)
        self.nearest[id] = min(self.nearest[id], near)
        if near < R:
            self.out.append(EvaderOutcome(id, OutcomeResult.CAPTURED, time, captor, near))
        elif min(apart(self.places[id], goal) for goal in TARGETS[id]) < R:
            self.out.append(EvaderOutcome(id, OutcomeResult.ARRIVED, time, 0, self.nearest[id]))


def apart(a: Triple, b: Triple) -> float:
    """The distance of two places [m]."""
    return sum((x - y) ** 2 for x, y in zip(a, b, strict=True)) ** 0.5


def _to(place: Triple, aim: Triple, speed: float) -> Triple:
    away = max(1.0, apart(place, aim))
    return tuple((b - a) / away * speed for a, b in zip(place, aim, strict=True))


def flight(game: str = "field") -> Iterator[Item]:
    """The messages of the flight, in order of arrival."""
    plan, played = setup(game), _Game()
    t0_ns = EPOCH_NS + 2 * NS_PER_S

    def item(message: Message, at_ns: int) -> Item:
        topic = next(topic for topic in topics.TOPICS if topic.message is type(message))
        id = getattr(message, "id", None) if topics.ID in topic.suffix else None
        return Item(topic.key(game, id), topic.encode(message), at_ns)

    yield item(plan, EPOCH_NS)
    for id, goals in TARGETS.items():
        yield item(messages.OwnBrief(id, EPOCH_NS, goals), EPOCH_NS)
    yield item(messages.PhaseChange(Phase.STAGING, 0, EPOCH_NS), EPOCH_NS + 1)
    dt, told = 0.1, 0
    for step in range(round((HORIZON_S + 3.0) / dt)):
        now_ns = EPOCH_NS + 10_000 + round(step * dt * NS_PER_S)
        time = (now_ns - t0_ns) / NS_PER_S
        if step == 10:
            yield item(messages.PhaseChange(Phase.READY, t0_ns, now_ns), now_ns)
        if step == 20:
            yield item(messages.PhaseChange(Phase.RUNNING, t0_ns, now_ns), now_ns)
        if step % 5 == 0:
            yield item(messages.Master("bridge", now_ns, 2.0, 7), now_ns)
        running = 0.0 <= time <= HORIZON_S and len(played.out) < len(EVADERS)
        if running:
            played.step(dt, time)
        if len(played.out) > told:
            told = len(played.out)
            out = tuple(played.out)
            yield item(messages.PhaseChange(Phase.RUNNING, t0_ns, now_ns, out=out), now_ns + 10)
        for said, late in _said(plan, played, step, time, now_ns):
            yield item(said, now_ns + late)
    end_ns = now_ns + 900_000
    for id in played.playing():
        played.out.append(EvaderOutcome(id, OutcomeResult.ESCAPED, HORIZON_S, 0, played.nearest[id]))
    each = tuple(sorted(played.out, key=lambda one: one.id))
    smallest = min(played.nearest.values())
    outcome = messages.Outcome(OutcomeResult.ARRIVED, HORIZON_S, 0, smallest, end_ns, evaders=each)
    yield item(outcome, end_ns)
    yield item(messages.PhaseChange(Phase.ENDED, t0_ns, end_ns, out=each), end_ns + 1)


def _said(
    plan: messages.Setup, played: _Game, step: int, time: float, now_ns: int
) -> Iterator[tuple[Message, int]]:
    """What everybody says at a step, with when [ns later]."""
    gone = {one.id for one in played.out}
    for member in plan.roster:
        id, late = member.id, 1000 * member.id
        place, way = played.places[id], played.ways[id]
        yield messages.State(
            id, member.role, now_ns, place, way, 12.0, (1.0, 2.0, 0.0), 0.0, 0.0, atan2(way[1], way[0]),
            "GUIDED", True, 1000 + id,
        ), late  # fmt: skip
        if member.role is Role.EVADER:
            yield messages.Track(id, now_ns, place, way, (0.25,) * 3 + (0.04,) * 3, "radar"), late + 1
        if step % 5 == 0:
            yield _health(member, now_ns, AgentStage.ENDED if id in gone else AgentStage.ACTING), late + 2
        if time >= 0.0 and id not in gone:
            yield _decision(member, played, time, now_ns), late + 3
    if time >= 0.0 and step % 2 == 0:
        yield _plan(played, time, now_ns), 50_000
    if time >= 0.0 and step % 10 == 0:
        for late, evader in enumerate(played.playing()):
            yield _knowledge(plan, played, evader, time, now_ns), 60_000 + late


def _health(member: messages.Member, now_ns: int, stage: AgentStage) -> messages.Health:
    return messages.Health(
        member.id, member.role, now_ns, stage, (), Kind.ARDUCOPTER, "GUIDED", True, 0.9, 1.0, 20.0, 20.0, 0.0,
        3, True, SupervisorAction.OK, "0", {}, nonce=1000 + member.id,
    )  # fmt: skip


def _decision(
    member: messages.Member, played: _Game, time: float, now_ns: int
) -> messages.DecisionReport:
    id, evader = member.id, member.role is Role.EVADER
    quarry = 0 if evader else played.quarry(id)
    aim = TARGETS[id][0] if evader else played.places[quarry]
    rule = "free_ray_to_target" if evader else "intercept"
    return messages.DecisionReport(
        id, now_ns, time, DecisionLevel.TACTICAL, DecisionModule.GEOMETRIC, "paper" if evader else "team",
        rule, played.ways[id], aim, apart(played.places[id], aim) / member.speed, 2.0, quarry=quarry,
    )  # fmt: skip


def _knowledge(
    plan: messages.Setup, played: _Game, evader: int, time: float, now_ns: int
) -> knowledge_messages.Knowledge:
    """What the planner says of one evader and those who are after it, by the core's own network."""
    team = tuple(id for id in AFTER if played.quarry(id) == evader)

    def member(id: int) -> Member:
        speed = 12.0 if id in EVADERS else 9.0
        return Member(Vehicle(Vec(*played.places[id]), Vec(*played.ways[id]), speed), VehicleLimits(), True)

    situation = engagement(
        member(evader), tuple(map(member, team)), Target(True, Vec(*TARGETS[evader][0])), plan.core_rules(),
        Heights(5.0, 150.0), 0.5,
    )  # fmt: skip
    targets = tuple(Target(True, Vec(*goal)) for goal in TARGETS[evader])
    situation = situation._replace(now=time, targets=targets)
    return message(known_of(situation, None, MODEL, evader, team), 2, now_ns, 1002)


def _plan(played: _Game, time: float, now_ns: int) -> team_messages.TeamPlan:
    parts = tuple(
        team_messages.PlannedPart(
            id, ROLES[number % 4], played.places[played.quarry(id)], 0.0, -1.0, PartReason.NO_GAP_IN_REACH
        )
        for number, id in enumerate(AFTER)
    )
    bands = tuple(
        team_messages.PlannedBand(id, id == 1, -0.1 if id == 1 else 1.2, 0.3, 0.0, 0, -1.0)
        for id in played.playing()
    )
    quarries = tuple(played.quarry(id) for id in AFTER)
    return team_messages.TeamPlan(
        2, now_ns, time, parts, False, 1.2, 0.3, 0.0, quarries=quarries, bands=bands, nonce=1002
    )
