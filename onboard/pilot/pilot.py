"""From the own state, tracks and team mates to a decision with its reasons.

Strategies run in the moving air mass: every velocity less the wind, γ from airspeeds, a target on
the ground moving at −w. Multicopters hold groundspeed: their wind is zero. Tracks are carried
forward to now by their predictors. In a plane game heights do not count for the decision; the
vehicle keeps that of its staging place.
"""

from __future__ import annotations

from math import inf, isnan
from typing import NamedTuple

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.game.targets import NONE, at, chosen
from onboard.core.game.views import (
    NOTHING_HELD,
    EvaderView,
    Held,
    PursuerView,
    Sighting,
    Team,
    evader_view,
    heading_at,
    level,
    nearest_mate,
    pursuer_view,
    told,
    with_limits,
)
from onboard.core.geometry.apollonius import apollonius_sphere
from onboard.core.geometry.assessment import half_angle
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.each import new
from onboard.core.math.states import Mate, Vehicle
from onboard.core.math.vectors import ZERO, Vec, add, along, clamp, scale
from onboard.core.strategy.choosing import held_after
from onboard.core.strategy.keep_out import KEEPS_OUT, evader_keeps_out, pursuer_keeps_out
from onboard.core.strategy.knowledge import Decision, Level, Module, RuleId, level_of
from onboard.core.strategy.registry import EVADERS, PURSUERS, evader_named, pursuer_named
from onboard.core.strategy.team.plan_types import IDLE
from onboard.pilot.hunt import Hunt, levelled
from onboard.pilot.memory import Memory
from onboard.pilot.predictor import Prediction, PredictorKind
from onboard.pilot.setup import GameSetup, Own, Player, Side

HEIGHT_GAIN = 0.5  # of keeping the height in a plane game [1/s]
CLIMB_SHARE = 0.3  # and the share of the speed it may use
REMEMBERS = 1.0  # [s] for which a decision is remembered
_LEVELS = {level: level.name.lower() for level in Level}  # in words
_MODULES = {module: module.name.lower() for module in Module}
_RULES = {rule: rule.name.lower() for rule in RuleId}
_PREDICTORS = {kind: kind.name.lower() for kind in PredictorKind}

Quad = tuple[float, float, float, float]


class PilotDecision(NamedTuple):
    """One decision, and everything a person needs to see why."""

    decides: bool  # False: something is missing, `lacks` says what
    velocity: Vec  # [m/s; relative to the air]
    level: str  # strategic | tactical | executive
    module: str  # intelligent | geometric
    strategy: str
    rule: str
    aim: Vec  # [m; NED] over ground
    time: float  # until there [s]
    miss: float  # predicted distance left [m]
    sigma: float  # stated error of the worst track that is needed [m]; inf = none known
    predictor: str  # what spoke for that track
    lacks: tuple[str, ...]  # what is missing for a decision, in words
    own: Vehicle  # as the strategy saw it
    others: tuple[Vehicle, ...]  # opponents as the strategy saw them
    rho: float  # safety distance ρ of the blocked cones [m]
    why: str = ""  # who planned it, in words; "" where the vehicle decides alone
    quarry: int = 0  # of several evaders the one that a pursuer is after; 0 = none


def drawing(thought: PilotDecision, side: Side) -> tuple[tuple[Quad, ...], tuple[Quad, ...]]:
    """Blocked cones (axis, half-angle) and Apollonius spheres (centre, radius) of a thought, for pictures."""
    cones: list[Quad] = []
    circles: list[Quad] = []
    own = thought.own
    if side is Side.EVADER:
        for cone in blocked_cones(own, thought.others, thought.rho):
            cones.append((*cone.axis, half_angle(cone)))
    for other in thought.others:
        fast, slow = (own, other) if side is Side.EVADER else (other, own)
        sphere = apollonius_sphere(fast.position, fast.speed, slow.position, slow.speed)
        if sphere.exists:
            circles.append((*sphere.centre, sphere.radius))
    return tuple(cones), tuple(circles)


class Question(NamedTuple):
    """What a strategy is shown, and what is needed to make a decision with its reasons of its answer."""

    view: EvaderView | PursuerView
    own: Own
    me: Player
    seen: Vehicle  # the own vehicle as the strategy sees it
    others: tuple[Vehicle, ...]  # opponents as the strategy sees them
    wind: Vec  # that the view was made in [m/s; where the air moves to]
    sigma: float  # stated error of the worst track that is needed [m]; inf = one is missing
    predictor: str  # what spoke for that track
    lacks: tuple[str, ...]  # what is missing, in words


class Viewpoint:
    """Makes the view of one vehicle's strategy, and of the strategy's answer a decision with its reasons.

    `strategy` names it; the names of other distributions' strategies are as good as the core's.
    """

    def __init__(self, id: int, side: Side, strategy: str = "") -> None:
        self.id = id
        self.side = side
        self.strategy = evader_named(strategy) if side is Side.EVADER else pursuer_named(strategy)
        known = (EVADERS if side is Side.EVADER else PURSUERS).get(self.strategy.partition(":")[0])
        self.part = IDLE  # of the team's plan, where there is one
        self.why = ""  # whose plan that is, in words
        self.hunt: Hunt | None = None  # of a pursuer that has a choice of evaders or of their targets
        self._aim = NONE  # number of the target that an evader with several goes for
        self._last: Decision | None = None  # and when it was asked for [s]
        self._last_at = self._asked_at = 0.0
        self._modules: dict[int, Module] = {rule.id: rule.module for rule in KEEPS_OUT}
        if known is not None:
            self._modules |= {rule.id: rule.module for rule in known.table}

    def look(
        self, now: float, own: Own, mates: tuple[Mate, ...], setup: GameSetup, memory: Memory
    ) -> Question | PilotDecision:
        """What the strategy is to be asked at instant `now` [s]; where it cannot be asked, a decision that
        says what is lacking.

        `mates` are the team mates as they are now (`carried`); the own vehicle among them is left out.
        `memory` holds the tracks that were taken so far; it is changed in place.
        """
        me = setup.player(self.id)
        if me is None:
            return self._silent(own, ("a place in the roster",))
        planar = setup.rules.planar
        wind = level(own.wind, planar)
        seen = new(Vehicle, (level(own.position, planar), _through_air(own.velocity, wind, planar), me.speed))
        known: list[tuple[Player, Prediction]] = []
        lacks: list[str] = []
        after = self._opponents(now, own, mates, setup, memory)
        if not after:
            return self._silent(own, ("an evader that is still in the game",))
        for player in after:
            prediction = memory.predict(player.id, now)
            if prediction is None:
                lacks.append(f"track of {player.side.value} {player.id}")
            else:
                known.append((player, prediction))
        if not known:
            return self._silent(own, tuple(lacks))
        worst = max((p for _, p in known), key=lambda p: p.sigma)
        others = tuple(_opponent(player, p, now, wind, planar, memory) for player, p in known)
        view: EvaderView | PursuerView
        if self.side is Side.EVADER:
            goal = self._goal(seen, me, others, setup)
            view = evader_view(seen, me.limits, others, goal, wind, setup.rules)
            view = with_limits(view, tuple(player.limits for player, _ in known))
        else:
            later = memory.predict(known[0][0].id, now + setup.control.lookahead)
            sighting = _sighting(others[0], later, wind, setup)
            held = NOTHING_HELD
            if self._last is not None and now - self._last_at <= REMEMBERS:
                rule, aim, time = self._last.rule, self._last.aim, self._last.time
                held = held_after(rule, aim, time, now - self._last_at, wind)
            team = self._team(seen, mates, wind, setup, held, level(own.nose, planar))
            view = pursuer_view(seen, me.limits, sighting, team, setup.control, setup.rules)
        self._asked_at = now
        sigma = inf if lacks else worst.sigma
        predictor = _PREDICTORS[worst.source]
        return new(Question, (view, own, me, seen, others, wind, sigma, predictor, tuple(lacks)))

    def _opponents(
        self, now: float, own: Own, mates: tuple[Mate, ...], setup: GameSetup, memory: Memory
    ) -> tuple[Player, ...]:
        """Whom the strategy is shown: an evader all pursuers, a pursuer the evader that it is after."""
        if self.hunt is not None:
            if self.hunt.choose(now, own, mates, setup, memory):
                self._last = None  # the meeting point that was held was with another one
            player = setup.player(self.hunt.quarry)
            return () if player is None else (player,)
        return setup.opponents(self.side)

    def _goal(self, seen: Vehicle, me: Player, pursuers: tuple[Vehicle, ...], setup: GameSetup) -> Target:
        """The target that an evader goes for; of several the one that it is at soonest."""
        planar = setup.rules.planar
        goals = levelled(setup.targets_of(self.id), planar)
        if len(goals) > 1:
            cones = blocked_cones(seen, pursuers, setup.rules.rho)
            self._aim = chosen(seen, me.limits, cones, goals, planar, self._aim)
            return at(goals, self._aim)
        return goals[0] if goals else NO_TARGET

    def _team(
        self, seen: Vehicle, mates: tuple[Mate, ...], wind: Vec, setup: GameSetup, held: Held, nose: Vec
    ) -> Team:
        """The own side in the moving air; who declares no speed counts as fast as this vehicle."""
        planar = setup.rules.planar
        members, places = [seen], [seen.position]
        hunt = self.hunt
        for mate in mates:
            if mate.id == self.id:
                continue
            place = level(mate.position, planar)
            places.append(place)
            if hunt is None or mate.id in hunt.together:
                player = setup.player(mate.id)
                speed = player.speed if player is not None and player.speed > 0.0 else seen.speed
                members.append(new(Vehicle, (place, _through_air(mate.velocity, wind, planar), speed)))
        target = setup.target if hunt is None else hunt.target_of(hunt.quarry, setup)
        known = told(new(Target, (target.exists, level(target.position, planar))), setup.rules)
        mate_near = nearest_mate(seen.position, tuple(places), 0)
        return new(Team, (mate_near, tuple(members), 0, known, held, self.part, nose, wind))

    def conclude(self, question: Question, decision: Decision, setup: GameSetup) -> PilotDecision:
        """The strategy's answer to a question, with everything a person needs to see why."""
        own, planar = question.own, setup.rules.planar
        view = question.view
        if isinstance(view, EvaderView):
            decision = evader_keeps_out(view, decision)
        else:
            decision = pursuer_keeps_out(view, decision)
        self._last, self._last_at = decision, self._asked_at
        return PilotDecision(
            decides=True,
            velocity=_steered(decision, own, question.me, planar),
            level=_LEVELS[level_of(decision.rule)],
            module=_MODULES[self._modules.get(decision.rule, Module.INTELLIGENT)],
            strategy=self.strategy,
            rule=_RULES[decision.rule],
            aim=along(_at_height(decision.aim, own.position, planar), question.wind, decision.time),
            time=decision.time,
            miss=decision.miss,
            sigma=question.sigma,
            predictor=question.predictor,
            lacks=question.lacks,
            own=question.seen,
            others=question.others,
            rho=setup.rules.rho,
            why=self._reason(),
            quarry=self.hunt.quarry if self.hunt is not None and len(self.hunt.evaders) > 1 else 0,
        )

    def _reason(self) -> str:
        hunted = self.hunt.why if self.hunt is not None else ""
        return "; ".join(word for word in (self.why, hunted) if word)

    def _silent(self, own: Own, lacks: tuple[str, ...]) -> PilotDecision:
        here = new(Vehicle, (own.position, own.velocity, 0.0))
        return PilotDecision(
            False, ZERO, _LEVELS[Level.TACTICAL], "", self.strategy, "none", own.position, 0.0, 0.0,
            inf, _PREDICTORS[PredictorKind.NOTHING], lacks, here, (), 0.0,
        )


class Pilot(Viewpoint):
    """Thinks for one vehicle. The strategies are functions: by default the core's own, by name.

    Raises KeyError for a name that the core does not have; other distributions' strategies come in as
    functions (`pursuer`, `evader`).
    """

    def __init__(
        self,
        id: int,
        side: Side,
        strategy: str = "",
        *,
        pursuer: PursuerStrategy | None = None,
        evader: EvaderStrategy | None = None,
    ) -> None:
        super().__init__(id, side, strategy)
        self._pursue: PursuerStrategy = PURSUERS[pursuer_named("")].decide if pursuer is None else pursuer
        self._evade: EvaderStrategy = EVADERS[evader_named("")].decide if evader is None else evader
        if side is Side.PURSUER and pursuer is None:
            self._pursue = PURSUERS[self.strategy].decide
        if side is Side.EVADER and evader is None:
            self._evade = EVADERS[self.strategy].decide

    def step(
        self, now: float, own: Own, mates: tuple[Mate, ...], setup: GameSetup, memory: Memory
    ) -> PilotDecision:
        """Decide at instant `now` [s]; see `look`."""
        question = self.look(now, own, mates, setup, memory)
        if isinstance(question, PilotDecision):
            return question
        view = question.view
        decision = self._evade(view) if isinstance(view, EvaderView) else self._pursue(view)
        return self.conclude(question, decision, setup)


def _through_air(velocity: Vec, wind: Vec, planar: bool) -> Vec:
    """A velocity over ground [m/s] through air that moves with `wind` [m/s], as the game counts it."""
    (x, y, z), (u, v, w) = velocity, wind
    moved = new(Vec, (x - u, y - v, (0.0 if planar else z) - w))
    return moved


def _opponent(
    player: Player, p: Prediction, now: float, wind: Vec, planar: bool, memory: Memory
) -> Vehicle:
    """An opponent in the moving air, as fast as it is declared to be or was ever seen to fly."""
    velocity = _through_air(p.velocity, wind, planar)
    speed = player.speed if player.speed > 0.0 else memory.top_speed(player.id, now, velocity)
    return new(Vehicle, (level(p.position, planar), velocity, speed))


def _sighting(evader: Vehicle, later: Prediction | None, wind: Vec, setup: GameSetup) -> Sighting:
    """The evader with its place after the lookahead, in the air mass as it lies now."""
    if later is None:
        return new(Sighting, (evader, heading_at(evader), False, evader.position))
    place = along(level(later.position, setup.rules.planar), wind, -setup.control.lookahead)
    return new(Sighting, (evader, heading_at(evader), True, place))


def _steered(decision: Decision, own: Own, me: Player, planar: bool) -> Vec:
    """The decided velocity; in a plane game with what keeps the height of the staging place."""
    velocity = scale(decision.direction, decision.speed)
    if not planar:
        return velocity
    if isnan(me.height):
        return level(velocity, True)
    most = CLIMB_SHARE * decision.speed
    down = clamp(-HEIGHT_GAIN * (me.height + own.position.z), -most, most)
    return add(level(velocity, True), new(Vec, (0.0, 0.0, down)))


def _at_height(aim: Vec, own: Vec, planar: bool) -> Vec:
    return new(Vec, (aim.x, aim.y, own.z)) if planar else aim
