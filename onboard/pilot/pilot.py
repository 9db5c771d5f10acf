"""The stateful thinker: own state, tracks and team mates in, a decision with its reasons out.

Strategies run in the moving air mass: every velocity less the wind, γ from airspeeds, a target on
the ground moving at −w. Multicopters hold groundspeed: their wind is zero. Tracks are carried
forward to now by their predictors. In a plane game heights do not count for the decision; the
vehicle keeps that of its staging place.
"""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.geometry.apollonius import apollonius_sphere, intercept
from onboard.core.geometry.assessment import half_angle
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, ZERO, Vec, add, along, clamp, distance, norm, scale, sub
from onboard.core.strategy.evasion import EvaderView
from onboard.core.strategy.knowledge import Decision, Level, Module
from onboard.core.strategy.pursuit import PursuerView, heading_at
from onboard.core.strategy.registry import DEFAULT, EVADERS, PURSUERS
from onboard.pilot.memory import Memory
from onboard.pilot.predictor import Prediction, PredictorKind
from onboard.pilot.setup import GameSetup, MateState, Own, Player, Side, TrackSample

HEIGHT_GAIN = 0.5  # of keeping the height in a plane game [1/s]
CLIMB_SHARE = 0.3  # and the share of the speed it may use

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
    lacks: tuple[str, ...]
    own: Vehicle
    others: tuple[Vehicle, ...]  # opponents as the strategy saw them
    rho: float


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
    air: Vec  # wind that the view was made in [m/s; where the air moves to]
    sigma: float  # stated error of the worst track that is needed [m]; inf = one is missing
    predictor: str  # what spoke for that track
    lacks: tuple[str, ...]


class Viewpoint:
    """Makes the view of one vehicle's strategy, and of the strategy's answer a decision with its reasons.

    `strategy` names it; the names of other distributions' strategies are as good as the core's.
    """

    def __init__(self, id: int, side: Side, strategy: str = "") -> None:
        self.id = id
        self.side = side
        self.strategy = strategy or DEFAULT
        known = (EVADERS if side is Side.EVADER else PURSUERS).get(self.strategy)
        self._modules: dict[int, Module] = {} if known is None else {r.id: r.module for r in known.table}

    def look(
        self, now: float, own: Own, mates: tuple[MateState, ...], setup: GameSetup, wind: Vec, memory: Memory
    ) -> Question | PilotDecision:
        """What the strategy is to be asked at instant `now` [s]; where it cannot be asked, a decision that
        says what is lacking. `wind` is ZERO for multicopters [m/s; where the air moves to]."""
        me = setup.player(self.id)
        if me is None:
            return self._silent(own, ("a place in the roster",), inf)
        air = _flat(wind) if setup.planar else wind
        seen = Vehicle(
            _seen(own.position, setup.planar), sub(_seen(own.velocity, setup.planar), air), me.speed
        )
        known: list[tuple[Player, Prediction]] = []
        lacks: list[str] = []
        for player in setup.opponents(self.side):
            prediction = memory.predict(player.id, now)
            if prediction is None:
                lacks.append(f"track of {player.side.value} {player.id}")
            else:
                known.append((player, prediction))
        if not known:
            return self._silent(own, tuple(lacks), inf)
        worst = max((p for _, p in known), key=lambda p: p.sigma)
        others = tuple(self._opponent(player, p, now, air, setup, memory) for player, p in known)
        view: EvaderView | PursuerView
        if self.side is Side.EVADER:
            view = self._as_evader(seen, me, others, setup, air)
        else:
            view = self._as_pursuer(now, seen, me, others[0], known[0][0], mates, setup, air, memory)
        sigma = inf if lacks else worst.sigma
        return Question(
            view, own, me, seen, others, air, sigma, worst.source.name.lower(), tuple(lacks)
        )

    def conclude(self, question: Question, decision: Decision, setup: GameSetup) -> PilotDecision:
        """The strategy's answer to a question, with everything a person needs to see why."""
        own = question.own
        return PilotDecision(
            decides=True,
            velocity=self._steered(decision, own, question.me, setup),
            level=Level.TACTICAL.name.lower(),
            module=self._modules.get(decision.rule, Module.INTELLIGENT).name.lower(),
            strategy=self.strategy,
            rule=decision.rule.name.lower(),
            aim=along(_at_height(decision.aim, own.position, setup.planar), question.air, decision.time),
            time=decision.time,
            miss=decision.miss,
            sigma=question.sigma,
            predictor=question.predictor,
            lacks=question.lacks,
            own=question.seen,
            others=question.others,
            rho=setup.rho,
        )

    def _opponent(
        self, player: Player, p: Prediction, now: float, wind: Vec, setup: GameSetup, memory: Memory
    ) -> Vehicle:
        velocity = sub(_seen(p.velocity, setup.planar), wind)
        speed = player.speed if player.speed > 0.0 else memory.top_speed(player.id, now, velocity)
        return Vehicle(_seen(p.position, setup.planar), velocity, speed)

    def _as_evader(
        self, own: Vehicle, me: Player, pursuers: tuple[Vehicle, ...], setup: GameSetup, wind: Vec
    ) -> EvaderView:
        target = _seen(setup.target, setup.planar)
        drift = norm(wind)
        if setup.has_target and drift > TINY:  # on the ground, so moving at −w in the air
            meeting = intercept(target, scale(wind, -1.0 / drift), drift, own.position, own.speed)
            target = meeting.point if meeting.exists else target
        return EvaderView(
            own,
            me.limits,
            pursuers,
            blocked_cones(own, pursuers, setup.rho),
            setup.has_target,
            target,
            setup.R,
            setup.lambda_,
            setup.beta,
            setup.planar,
        )

    def _as_pursuer(
        self,
        now: float,
        own: Vehicle,
        me: Player,
        evader: Vehicle,
        evader_player: Player,
        mates: tuple[MateState, ...],
        setup: GameSetup,
        wind: Vec,
        memory: Memory,
    ) -> PursuerView:
        ahead = memory.predict(evader_player.id, now + setup.lookahead)
        place = evader.position
        if ahead is not None:  # in the air mass as it lies now
            place = along(_seen(ahead.position, setup.planar), wind, -setup.lookahead)
        nearest = None
        for mate in mates:
            if mate.id == self.id:
                continue
            there = _seen(along(mate.position, mate.velocity, clamp(now - mate.t, 0.0, 1.0)), setup.planar)
            if nearest is None or distance(there, own.position) < distance(nearest, own.position):
                nearest = there
        return PursuerView(
            own,
            me.limits,
            evader,
            heading_at(evader),
            nearest is not None,
            own.position if nearest is None else nearest,
            setup.separation,
            ahead is not None,
            place,
            setup.lookahead,
            setup.dt,
            setup.planar,
        )

    def _steered(self, decision: Decision, own: Own, me: Player, setup: GameSetup) -> Vec:
        """The decided velocity; in a plane game with what keeps the height of the staging place."""
        velocity = scale(decision.direction, decision.speed)
        if not setup.planar:
            return velocity
        most = CLIMB_SHARE * decision.speed
        down = clamp(-HEIGHT_GAIN * (me.height + own.position.z), -most, most)
        return add(_flat(velocity), Vec(0.0, 0.0, down))

    def _silent(self, own: Own, lacks: tuple[str, ...], sigma: float) -> PilotDecision:
        here = Vehicle(own.position, own.velocity, 0.0)
        return PilotDecision(
            False, ZERO, Level.TACTICAL.name.lower(), "", self.strategy, "none", own.position, 0.0, 0.0,
            sigma, PredictorKind.NOTHING.name.lower(), lacks, here, (), 0.0,
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
        self._pursue: PursuerStrategy = PURSUERS[DEFAULT].decide if pursuer is None else pursuer
        self._evade: EvaderStrategy = EVADERS[DEFAULT].decide if evader is None else evader
        if side is Side.PURSUER and pursuer is None:
            self._pursue = PURSUERS[self.strategy].decide
        if side is Side.EVADER and evader is None:
            self._evade = EVADERS[self.strategy].decide

    def step(
        self,
        now: float,
        own: Own,
        tracks: tuple[TrackSample, ...],
        mates: tuple[MateState, ...],
        setup: GameSetup,
        wind: Vec,
        memory: Memory,
    ) -> tuple[PilotDecision, Memory]:
        """Decide at instant `now` [s]. `tracks` are the measurements since the last step, `wind` is ZERO
        for multicopters [m/s; where the air moves to]. The memory is moved on and given back."""
        memory.take(tracks)
        question = self.look(now, own, mates, setup, wind, memory)
        if isinstance(question, PilotDecision):
            return question, memory
        view = question.view
        decision = self._evade(view) if isinstance(view, EvaderView) else self._pursue(view)
        return self.conclude(question, decision, setup), memory


def _flat(v: Vec) -> Vec:
    return Vec(v.x, v.y, 0.0)


def _seen(v: Vec, planar: bool) -> Vec:
    return Vec(v.x, v.y, 0.0) if planar else v


def _at_height(aim: Vec, own: Vec, planar: bool) -> Vec:
    return Vec(aim.x, aim.y, own.z) if planar else aim
