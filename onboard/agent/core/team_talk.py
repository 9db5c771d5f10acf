"""A pursuer's team on the bus: hears plans, plans where it is the planner, and says what it plans."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, isfinite

from onboard.agent.config import AgentConfig
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant, Outbox, Publish
from onboard.agent.core.journal import Journal
from onboard.config.printable import words_of
from onboard.core.math.vectors import Vec
from onboard.core.strategy.semantic.model import MODEL, Model
from onboard.core.strategy.team.plan_types import NOBODY, Assignment, Band, Plan, Reason, Role
from onboard.core.strategy.team.planner import engaged
from onboard.game.knowledge_words import goal_in_words, goal_of, known_of
from onboard.game.knowledge_words import message as message_of
from onboard.pilot.pilot import Question
from onboard.pilot.setup import Crowd
from onboard.pilot.team_seat import Dated, Field, Known, TeamSeat
from onboard.wire.bus.knowledge_messages import PlannedGoal
from onboard.wire.bus.team_messages import PartReason, PlannedBand, PlannedPart, TeamPlan, TeamRole
from onboard.wire.bus.topics import KNOWLEDGE, PLAN

KNOWLEDGE_EVERY = 2  # plans, from one word of what is known to the next: a second


def said(
    dated: Dated, team: tuple[int, ...], stamp_ns: int, nonce: int, goals: tuple[PlannedGoal, ...] = ()
) -> TeamPlan:
    """A plan as it goes over the bus; `team` are the ids of its members in their order."""
    made, planner = dated.plan, dated.planner
    band = made.band
    parts = tuple(
        PlannedPart(
            id,
            TeamRole[part.role.name],
            (part.aim.x, part.aim.y, part.aim.z),
            part.heading,
            part.due if isfinite(part.due) else -1.0,
            PartReason[part.reason.name],
        )
        for id, part in zip(team, made.assignments, strict=True)
    )
    return TeamPlan(
        id=planner,
        stamp_ns=stamp_ns,
        t=made.time,
        parts=parts,
        closed=band.closed,
        gap=band.gap,
        bearing=band.bearing,
        pitch=band.pitch,
        closer=0 if band.closer == NOBODY else team[band.closer],
        closes=band.closes if isfinite(band.closes) else -1.0,
        nonce=nonce,
        quarries=dated.quarries,
        bands=tuple(
            PlannedBand(
                id, one.closed, one.gap, one.bearing, one.pitch,
                0 if one.closer == NOBODY else team[one.closer],
                one.closes if isfinite(one.closes) else -1.0,
            )
            for id, one in dated.bands
        ),
        goals=goals,
    )  # fmt: skip


def understood(message: TeamPlan, team: tuple[int, ...], at: float) -> Dated | None:
    """The plan of a message that came `at` [s, monotonic]; None where it is not one of this team, or holds
    what is no number."""
    parts = {part.id: part for part in message.parts}
    numbers = [message.t, message.gap, message.bearing, message.pitch, message.closes]
    numbers += [n for part in message.parts for n in (*part.aim, part.heading, part.due)]
    numbers += [n for band in message.bands for n in (band.gap, band.bearing, band.pitch, band.closes)]
    several = len(message.quarries) == len(message.parts)
    fits = set(parts) == set(team) and (several or not message.quarries)
    if not fits or not all(map(isfinite, numbers)):
        return None
    assignments = tuple(
        Assignment(
            Role[parts[id].role.name],
            Vec(*parts[id].aim),
            parts[id].heading,
            parts[id].due if parts[id].due >= 0.0 else inf,
            Reason[parts[id].reason.name],
        )
        for id in team
    )
    after = {part.id: id for part, id in zip(message.parts, message.quarries, strict=False)}
    quarries = tuple(after[id] for id in team) if several else ()
    bands = tuple((band.quarry, _band(band, team)) for band in message.bands)
    return Dated(message.id, Plan(message.t, assignments, _band(message, team)), at, quarries, bands)


def _band(told: TeamPlan | PlannedBand, team: tuple[int, ...]) -> Band:
    closer = team.index(told.closer) if told.closer in team else NOBODY
    closes = told.closes if told.closes >= 0.0 else inf
    return Band(told.closed, told.gap, told.bearing, told.pitch, closer, closes)


class TeamTalk:
    """Joins one member's seat with the bus."""

    def __init__(
        self, config: AgentConfig, field: Field, model: Model, bus: BusView, out: Outbox, journal: Journal
    ) -> None:
        """`model` is what the team knows, by which the field's planner plans."""
        id, game = config.id, config.game
        self.seat = TeamSeat(id, field)
        self._model = model
        self._known_key = KNOWLEDGE.key(game, id)
        self._plans = 0  # made so far
        self._own: tuple[PlannedGoal, ...] = ()  # the goals of the last of them
        self._goals = ""  # in words, as they were told last
        self.fit = False  # whether this vehicle follows the game
        self._key, self._bus, self._out, self._journal = PLAN.key(game, id), bus, out, journal
        bus.plans.clear()  # of another game
        self._taken: dict[int, TeamPlan] = {}
        self._dated: Dated | None = None  # the plan that counted when it was last asked
        self._planner = 0  # whose plan counted when it was last asked

    def part(self, now: float) -> Assignment:
        """The own part now [s, monotonic]."""
        for planner, (message, at) in self._bus.plans.items():
            if self._taken.get(planner) is not message:
                self._taken[planner] = message
                made = understood(message, self.seat.field.team, at)
                if made is None:
                    self._bus.drops["foreign_plan"] += 1
                else:
                    self.seat.heard(made)
        self._tell(now)
        return self.seat.part(now)

    @property
    def why(self) -> str:
        """Who planned the part at hand, what it is and why, in words; "" without a plan."""
        dated = self._dated
        if dated is None or self.seat.id not in self.seat.field.team:
            return ""
        part = dated.plan.assignments[self.seat.field.team.index(self.seat.id)]
        reason = PartReason[part.reason.name].value
        whose = f"{part.role.name.lower()} in the plan of {dated.planner}" + (f": {reason}" if reason else "")
        goal = self._goal_of(dated)
        return f"{whose}; goal: {goal}" if goal else whose

    def _goal_of(self, dated: Dated) -> str:
        """What the plan that counts has this member's group after, in words."""
        message = self._taken.get(dated.planner)
        goals = self._own if dated.planner == self.seat.id else () if message is None else message.goals
        pairs = zip(self.seat.field.team, dated.quarries, strict=False)
        quarry = next((quarry for id, quarry in pairs if id == self.seat.id), 0)
        mine = next((goal for goal in goals if quarry in (0, goal.quarry)), None)
        return "" if mine is None else goal_in_words(mine)

    @property
    def quarries(self) -> tuple[int, dict[int, int]]:
        """Of several evaders: whose plan counts, and whom it has each pursuer go for."""
        dated = self._dated
        if dated is None:
            return 0, {}
        pairs = zip(self.seat.field.team, dated.quarries, strict=False)
        return dated.planner, {id: quarry for id, quarry in pairs if quarry}

    def work(
        self, now: Instant, t: float, question: Question, crowd: Callable[[], Crowd] | None = None
    ) -> None:
        """After a control step at `t` [s] since t0: plan where that is this vehicle's to do, and say it.

        `crowd` tells of everybody, where there are several evaders. Where a user's relation or rule fails,
        the team goes on by the core's own model."""
        try:
            self._work(now, t, question, crowd)
        except Exception as error:  # a foreign file may fail in any way
            if self._model is MODEL:
                raise
            self._model = MODEL
            self.seat.field = self.seat.field._replace(planner=engaged)
            self._journal.error("knowledge", f"{words_of(error)}: on by the team's own model")

    def _work(
        self, now: Instant, t: float, question: Question, crowd: Callable[[], Crowd] | None
    ) -> None:
        bus, seat = self._bus, self.seat
        evader = question.others[0] if question.others else None
        mates = bus.mates_at(now.s)
        made = seat.work(Known(now.s, t, question.own, self.fit, mates, bus.unfit, evader, crowd))
        if made is not None:
            self._own = tuple(
                goal_of(self._model, thought.made.choice, thought.evader) for thought in seat.thoughts
            )
            message = said(made, seat.field.team, now.wall_ns, self._bus.nonce, self._own)
            self._out.put(Publish(self._key, PLAN.encode(message), PLAN.delivery))
            if self._plans % KNOWLEDGE_EVERY == 0:
                self._say_known(now)
            self._plans += 1

    def _say_known(self, now: Instant) -> None:
        """Say what the last plan was made of; and what the team is after, where that has changed."""
        seat = self.seat
        for evader, situation, before, made in seat.thoughts:
            known = known_of(situation, before, self._model, evader, seat.field.team)
            told = message_of(known._replace(choice=made.choice), seat.id, now.wall_ns, self._bus.nonce)
            self._out.put(Publish(self._known_key, KNOWLEDGE.encode(told), KNOWLEDGE.delivery))
        goals = "; ".join(filter(None, map(goal_in_words, self._own)))
        if goals != self._goals:
            self._goals = goals
            self._journal.info("goal", goals or "no goal")

    def _tell(self, now: float) -> None:
        """Say whose plan counts where that has changed."""
        dated = self._dated = self.seat.counts(now)
        planner = 0 if dated is None else dated.planner
        if planner != self._planner:
            self._planner = planner
            text = f"{planner} plans for the team" if planner else "no plan: chases alone"
            self._journal.info("planner", text)
