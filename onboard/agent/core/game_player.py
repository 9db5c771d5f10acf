"""The agent's part in a game: takes a setup, follows the phases, and asks the strategy."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core import policy_from_config as limits
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant, Load, Outbox
from onboard.agent.core.journal import Journal
from onboard.agent.core.part import PartState, Way
from onboard.agent.core.participation import Participation, is_out
from onboard.agent.core.readiness import lacking
from onboard.agent.core.team_talk import TeamTalk
from onboard.agent.core.to_place import approach_of, own_state
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage
from onboard.autopilot.flight_limits import FlightLimits
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.each import new
from onboard.core.math.states import Mate, MateState, carried
from onboard.core.math.vectors import Vec
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.team.plan_types import Heights
from onboard.game import team_knowledge
from onboard.game.team_knowledge import is_team
from onboard.game.track_watch import TrackWatch
from onboard.game.trials import in_words
from onboard.pilot.approach import Approach
from onboard.pilot.hunt import Hunt, hunt_of
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import PilotDecision, Question, Viewpoint
from onboard.pilot.setup import Crowd, GameSetup, Own, Side, TrackSample
from onboard.pilot.team_seat import Field
from onboard.wire.bus.messages import Phase, PhaseChange, Role, Setup, Track
from onboard.wire.geodesy import Frame

OVERDUE_S = 1.0  # the word that the game runs comes within this after t₀
SOON_S = 1.0  # before t₀, from which on the first predictions are made ready
TRAINING_SLICES = 2  # of about 1 ms, after each control step


class Flying(NamedTuple):
    """What a game needs, made once from a setup that fits."""

    game: GameSetup
    viewpoint: Viewpoint
    approach: Approach | None = None  # to its place


class GamePlayer:
    """One vehicle's part in one game after another; see `part.Part`."""

    def __init__(
        self, config: AgentConfig, vehicle: VehicleLink, bus: BusView, out: Outbox, journal: Journal
    ) -> None:
        self.config = config
        self.side = Side.EVADER if config.role is Role.EVADER else Side.PURSUER
        self.policy = limits.policy_of(config, None, True)
        self.strategy = ""
        self.flying: Flying | None = None
        self.fit = False  # whether the vehicle follows the game
        self._team: TeamTalk | None = None  # of who flies by a plan
        self._asked: tuple[Instant, Question] | None = None  # the last control step
        self.why_not = ""  # why the setup at hand was refused
        self._participation = Participation(config.id)
        self._vehicle, self._bus, self._out, self._journal = vehicle, bus, out, journal
        self._memory = Memory(config.prediction)
        self._base_ns = 0  # where the pilot's seconds begin
        # Setup, kind of vehicle and limits as they were judged last.
        self._judged: tuple[int, bool | None, FlightLimits] = (0, None, FlightLimits())
        self._phase_seen: PhaseChange | None = None
        self._tracks = TrackWatch()
        self._briefed: tuple[Vec, ...] = ()  # the own targets that the game at hand was told
        self._ended: frozenset[int] = frozenset()  # evaders whose game is over
        self._seen: dict[int, MateState] = {}  # evaders as they were last measured
        self._loaded: dict[str, str] = {}  # strategies looked up → why they cannot be used, '' = they can
        self._asked_for: set[str] = set()
        self._state: tuple[tuple[object, ...], PartState] = ((), PartState())  # of which facts

    # ------------------------------------------------------------------ what arrives

    def begin(self, now: Instant) -> None:
        """The agent begins."""
        self._base_ns = now.wall_ns

    def heard_setup(self, setup: Setup) -> None:
        """A setup arrived: its strategy is looked up before it is considered."""
        name = self._strategy_of(setup)
        if name in self._asked_for:
            return
        self._asked_for.add(name)
        if team_knowledge.names_file(name) and not self.config.strategy:  # whoever speaks as the master
            self._loaded[name] = (
                f"the setup's strategy: found the file '{name}', expected a name: what is to be run from a"
                " file is said to the agent itself (`strategy` of its configuration, --strategy)"
            )
        else:
            self._out.put(Load(self.side, name))

    def loaded(self, strategy: str, error: str) -> None:
        """A strategy was looked up; `error` says why it cannot be used."""
        self._loaded[strategy] = error

    def measured(self, track: Track, now: Instant) -> None:
        """A measurement came: the predictor takes it now, so that no setpoint waits for that."""
        sample = TrackSample(
            track.id, self._seconds(track.stamp_ns), new(Vec, track.position), new(Vec, track.velocity),
            track.covariance,
        )  # fmt: skip
        self._tracks.heard(track)
        if track.id not in self._ended:  # nobody asks any more where that one will be
            self._memory.take((sample,))
        hunt = None if self.flying is None else self.flying.viewpoint.hunt
        if hunt is not None and track.id in hunt.ids:
            at = now.s - (now.wall_ns - track.stamp_ns) / NS_PER_S
            self._seen[track.id] = MateState(track.id, at, sample.position, sample.velocity)
        # What the next step asks for is reckoned now.
        if (hunt is None or hunt.quarry == track.id) and self._on(now.wall_ns):
            self._memory.prepare(track.id)

    # ------------------------------------------------------------------ the part

    def follow(self, now: Instant) -> None:
        """Consider a new setup, and follow the master's phases."""
        bus, vehicle = self._bus, self._vehicle
        facts = (bus.setup_number, vehicle.hovers, vehicle.limits)
        if facts != self._judged:
            same_setup = facts[0] == self._judged[0]
            name = "" if bus.setup is None else self._strategy_of(bus.setup)
            if bus.setup is None:
                self._judged = facts
                if vehicle.hovers is not None:
                    self.policy = limits.policy_of(self.config, None, vehicle.hovers, vehicle.limits)
            elif name in self._loaded:
                self._judged = facts
                if not (same_setup and self._relimit(bus.setup)):
                    self._consider(bus.setup, self._loaded[name])
        self._follow_phase(now.wall_ns)

    def _relimit(self, setup: Setup) -> bool:
        """Fly on in the game at hand within limits that have changed; False where it must be judged anew."""
        flying, vehicle = self.flying, self._vehicle
        hovers, own = vehicle.hovers, vehicle.limits
        if flying is None or hovers is None or hovers is not self.policy.envelope.hovers:
            return False
        if limits.contradiction(self.config, setup, hovers, own):
            return False
        self.policy = limits.policy_of(self.config, setup, hovers, own)
        game = limits.game_setup(self.config, setup, self._bus.targets, hovers, own)
        self.flying = flying._replace(game=game, approach=self._approach(setup, game))
        if self._team is not None:
            planner = self._team.seat.field.planner  # the core's own, once a user's has failed
            self._team.seat.field = self._field(setup, game)._replace(planner=planner)
        return True

    def state(self, wall_ns: int) -> PartState:
        """Where the game stands for this vehicle."""
        phase, part, engaged = self._bus.phase, self._participation, self.flying is not None
        begun = phase is not None and wall_ns >= phase.t0_ns
        facts = (phase, engaged, begun, part.joined, part.resumed)
        if facts != self._state[0]:
            late = part.waits_for_resume(phase)
            self._state = facts, PartState(
                engaged=engaged,
                near=part.about_to(phase) and not late,
                on=self._on(wall_ns),
                late=late,
                over=part.over(phase),
                resumed=part.resumed,
            )
        return self._state[1]

    def _on(self, wall_ns: int) -> bool:
        """Whether the vehicle is flown by decisions."""
        return self.flying is not None and self._participation.running(self._bus.phase, wall_ns)

    def let_in(self) -> None:
        """A person lets this process act, also in a game that it has not seen begin."""
        self._participation.let_in()

    def withdraw(self) -> None:
        """What let this process in came to nothing."""
        self._participation.withdraw()

    def approach(self, now: Instant, own: Own) -> Way | None:
        """How to fly to its place, from ready to t₀."""
        flying, left = self.flying, self._to_start(now.wall_ns)
        if flying is None or flying.approach is None or left is None or left < -OVERDUE_S:
            return None
        if not flying.approach.reaches(own):
            return None
        place = flying.approach.place
        return Way(flying.approach.steer(own, left), place.heading if place.envelope.hovers else None)

    def place_s(self, now: Instant) -> float:
        """Time that the vehicle needs to its place [s]; before t₀, by which it will be late."""
        flying, vehicle, left = self.flying, self._vehicle, self._to_start(now.wall_ns)
        flies = self.config.take_control or vehicle.stage is Stage.ACTIVE
        if flying is None or flying.approach is None or not flies or not vehicle.telemetry.placed:
            return 0.0
        own = own_state(now.s, vehicle.telemetry, hovers=vehicle.hovers is not False)
        return flying.approach.needs(own) if left is None else flying.approach.misses(own, left)

    def _to_start(self, wall_ns: int) -> float | None:
        """Time left to t₀ [s] while everybody is ready; None before that and after it."""
        phase = self._bus.phase
        ready = phase is not None and phase.phase is Phase.READY and phase.t0_ns > 0
        return -self.time(wall_ns) if ready else None

    def ask(self, now: Instant, own: Own) -> Question | PilotDecision:
        """The view of the game at `now`."""
        flying, bus = self.flying, self._bus
        assert flying is not None
        game = flying.game
        if self.side is Side.EVADER and bus.targets != self._briefed:
            self._briefed = bus.targets
            game = game.with_targets(self.config.id, bus.targets)
            self.flying = flying._replace(game=game)
        at = self._seconds(now.wall_ns)
        hunt = flying.viewpoint.hunt
        before = 0 if hunt is None else hunt.quarry
        if self._team is not None:
            flying.viewpoint.part = self._team.part(now.s)
            flying.viewpoint.why = self._team.why
        if hunt is not None:
            self._prepare(hunt, game.rules.horizon - self.time(now.wall_ns))
        asked = flying.viewpoint.look(at, own, bus.mates_at(now.s), game, self._memory)
        self._asked = (now, asked) if isinstance(asked, Question) else None
        if hunt is not None and hunt.quarry != before and hunt.why:
            self._journal.info("quarry", hunt.why, "strategic", "geometric")
        return asked

    def _prepare(self, hunt: Hunt, left: float) -> None:
        """Tell a pursuer's choice of evaders what the bus knows; the game lasts `left` [s] more."""
        hunt.unfit, hunt.out, hunt.left = self._bus.unfit, self._ended, left
        if self._team is not None:
            hunt.planner, hunt.planned = self._team.quarries

    def obstacles(self, now: float) -> tuple[Mate, ...]:
        """Evaders that are out, where their tracks have them at `now` [s, monotonic].

        They keep apart from nobody any more, so they count as team mates that have gone quiet."""
        if not self._ended:
            return ()
        out = [self._seen[id] for id in self._ended if id in self._seen]
        quiet = self.policy.mate_age + 1e-3
        return tuple(mate._replace(age=max(mate.age, quiet)) for mate in (carried(one, now) for one in out))

    def conclude(self, question: Question, decision: Decision) -> PilotDecision:
        """What the strategy's answer means in this game."""
        assert self.flying is not None
        return self.flying.viewpoint.conclude(question, decision, self.flying.game)

    def lacks(self, now: Instant) -> tuple[str, ...]:
        """What is missing before this agent can play."""
        found = lacking(now.s, self._vehicle, self._bus, self.policy, self.config.role, self.why_not)
        if self.flying is None:
            return found
        opponents = [one for one in self.flying.game.opponents(self.side) if one.id not in self._ended]
        tracks = ((player, self._tracks.lack(player.id, now.wall_ns)) for player in opponents)
        return (*found, *(f"{player.side.value} {player.id}: {why}" for player, why in tracks if why))

    def time(self, wall_ns: int) -> float:
        """Seconds since t₀; 0 before it is fixed."""
        return self._participation.game_time(self._bus.phase, wall_ns)

    def train(self, wall_ns: int) -> None:
        """Give the predictors a little time."""
        if self._team is not None and self._asked is not None:
            self._team.fit = self.fit
            now, question = self._asked
            self._asked = None
            self._team.work(now, self.time(now.wall_ns), question, self._crowd(now, question))
        if self.flying is not None:
            left = self._to_start(wall_ns)
            soon = left is not None and left < SOON_S
            asked = soon or self._participation.running(self._bus.phase, wall_ns)
            hunt = self.flying.viewpoint.hunt
            only = None if hunt is None or not hunt.quarry else hunt.quarry
            self._memory.train(self._seconds(wall_ns), TRAINING_SLICES, asked=asked, only=only)

    def _crowd(self, now: Instant, question: Question) -> Callable[[], Crowd] | None:
        """What tells of everybody, for a plan against several evaders; None where there is one."""
        flying = self.flying
        hunt = None if flying is None else flying.viewpoint.hunt
        if flying is None or hunt is None:
            return None
        game, mates, at = flying.game, self._bus.mates_at(now.s), self._seconds(now.wall_ns)
        return lambda: hunt.crowd(at, question.own, mates, game, self._memory)

    # ------------------------------------------------------------------ what the master says

    def _follow_phase(self, wall_ns: int) -> None:
        phase = self._bus.phase
        if phase is None or phase is self._phase_seen:
            return
        before, self._phase_seen = self._phase_seen, phase
        was = self._participation.joined
        self._participation.follow(phase, wall_ns)
        self._ended = frozenset(end.id for end in phase.out)
        if self.config.id in self._ended and (before is None or not is_out(before, self.config.id)):
            self._journal.info("out", in_words(next(end for end in phase.out if end.id == self.config.id)))
        if phase.phase is Phase.RUNNING and not self._participation.joined:
            self._journal.warning("late", "the game runs already: waiting for the master's resume")
        elif phase.phase is Phase.RUNNING and not was:
            self._journal.info("resumed", "the master lets this agent act")
        elif before is None or before.phase is not phase.phase:
            self._journal.info("phase", phase.phase.value + (f": {phase.reason}" if phase.reason else ""))

    def _consider(self, setup: Setup, strategy_error: str) -> None:
        """A new setup: take it, or refuse it with the reason."""
        if self.flying is not None:
            self._participation.leave()
            self._phase_seen = None
            self.flying = None
        hovers, own = self._vehicle.hovers, self._vehicle.limits
        why = limits.contradiction(self.config, setup, hovers, own) or strategy_error
        why = why or team_knowledge.trouble(self._strategy_of(setup))  # opens no file that was refused
        if why:
            if why != self.why_not:
                self._journal.error("setup_refused", why)
            self.why_not = why
            return
        self.why_not = ""
        if hovers is None or self._vehicle.unread:
            return  # unknown is no default: it is judged again once kind and limits are known
        origin = setup.origin
        self._vehicle.observer.frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
        self.policy = limits.policy_of(self.config, setup, hovers, own)
        self.strategy = self._strategy_of(setup)
        mates = (m.id for m in setup.roster if m.role is self.config.role and m.id != self.config.id)
        self._bus.follow(tuple(mates), is_team(self.strategy))
        several = sum(member.role is Role.EVADER for member in setup.roster) > 1
        self._bus.brief_alone(several and self.side is Side.EVADER)
        game = limits.game_setup(self.config, setup, self._bus.targets, hovers, own)
        opponents = tuple(player.id for player in game.opponents(self.side))
        self._bus.watch(opponents)
        self._memory = Memory(self.config.prediction, opponents)
        self._team = None
        if is_team(self.strategy):
            field, model = self._field(setup, game), team_knowledge.model(self.strategy)
            self._team = TeamTalk(self.config, field, model, self._bus, self._out, self._journal)
        viewpoint = Viewpoint(self.config.id, self.side, self.strategy)
        if self.side is Side.PURSUER:
            viewpoint.hunt = hunt_of(self.config.id, game)
        self._seen.clear()
        self.flying = Flying(game, viewpoint, self._approach(setup, game))
        self._journal.info("setup", f"{setup.scenario} from {setup.master}: {len(setup.roster)} vehicles")

    def _field(self, setup: Setup, game: GameSetup) -> Field:
        """What a seat in the team reckons with: all pursuers whose strategy is the plan's."""
        team = tuple(
            m.id for m in setup.roster
            if m.role is Role.PURSUER and (is_team(m.strategy) or m.id == self.config.id)
        )  # fmt: skip
        fences = self.policy.fences
        floor = max((fence.low for fence in fences), default=Heights().floor)
        ceiling = min((fence.high for fence in fences), default=Heights().ceiling)
        planner = team_knowledge.planner(self.strategy)
        return Field(game, team, Heights(floor, ceiling), setup.track_sigma, planner)

    def _approach(self, setup: Setup, game: GameSetup) -> Approach | None:
        member = limits.member_of(setup, self.config.id)
        return None if member is None else approach_of(member, game, self.policy)

    def _strategy_of(self, setup: Setup) -> str:
        member = limits.member_of(setup, self.config.id)
        return self.config.strategy or (member.strategy if member is not None else "")

    def _seconds(self, stamp_ns: int) -> float:
        return (stamp_ns - self._base_ns) / NS_PER_S
