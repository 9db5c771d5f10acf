"""The agent in a game: takes a setup, thinks, is supervised, and tells its craft what to do."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from onboard.agent import policy_from_config as limits
from onboard.agent.bus_view import Table
from onboard.agent.clocks import JumpWatch
from onboard.agent.command_book import Orders
from onboard.agent.config import AgentConfig
from onboard.agent.journal import Journal
from onboard.agent.participation import Part
from onboard.agent.readiness import lacking
from onboard.agent.takeoff import TakeOff
from onboard.agent.vehicle_link import Craft
from onboard.autopilot.base import ReleaseMode, Setpoint, Stage, Telemetry
from onboard.config.strict import ConfigError
from onboard.core.game.rules import Target
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.core.math.states import Mate, carried
from onboard.core.math.vectors import ZERO, Vec, along
from onboard.core.safety.policy import Action, Cause, Seen
from onboard.core.safety.supervisor import Verdict, Watch, supervise
from onboard.core.safety.words import ACTIONS, CAUSES
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import Pilot, PilotDecision
from onboard.pilot.setup import GameSetup, Own, Side, TrackSample
from onboard.runtime.protocols import Clock
from onboard.wire.bus.messages import Phase, PhaseChange, Role, Setup, Severity, Track
from onboard.wire.geodesy import Frame

SILENT_S = 1.0  # a link silent for longer explains that the autopilot changed to hold by itself
REGAIN_S = 6.0  # … for so long afterwards
WIND_FRESH_S = 10.0
TRAINING_SLICES = 2  # of about 1 ms, after each control step


class Flying(NamedTuple):
    """What a game needs, made once from a setup that fits."""

    game: GameSetup
    pilot: Pilot


class Acting:
    """One agent's part in one game after another. Time is an argument."""

    def __init__(
        self, config: AgentConfig, clock: Clock, craft: Craft, table: Table, orders: Orders, journal: Journal
    ) -> None:
        self.config = config
        self.side = Side.EVADER if config.role is Role.EVADER else Side.PURSUER
        self.part = Part(config.id)
        self.policy = limits.policy_of(config, None, True)
        self.flying: Flying | None = None
        self.why_not = ""  # why the setup at hand was refused
        self.thought: PilotDecision | None = None
        self.verdict: Verdict | None = None
        self.setpoint = ZERO  # [m/s; ground] let through in this step
        self.failures = 0  # of the strategy
        self.take_off = TakeOff(config.take_off_height)
        self._clock, self._craft, self._table = clock, craft, table
        self._orders, self._journal = orders, journal
        self._memory = Memory(config.prediction)
        self._watch = Watch()
        self._jumps = JumpWatch(config.safety.clock_jump_s)
        self._base_ns = clock.wall_ns()
        table.on_track = self.measured
        self._setup_seen = 0
        self._phase_seen: PhaseChange | None = None
        self._failing = False
        self._alive_at = NEVER  # the strategy's last sign of life [s]
        self._silent_at = NEVER  # when the link was last found silent [s]

    def step(self, now: float, wall_ns: int, begun_ns: int) -> None:
        """One control step at monotonic `now` [s]; the setpoint is out when it returns."""
        jump = self._jumps.look(wall_ns, begun_ns)
        if jump != 0.0:
            self._table.clock.restart()
            self._journal.error("clock_jump", f"the wall clock jumped by {jump:+.3f} s")
        telemetry = self._craft.look(now)
        self._follow(wall_ns)
        self._hands(now, telemetry)
        self.setpoint = ZERO
        if self.engaged and self._on(now, wall_ns):
            self._think(now, wall_ns, telemetry, begun_ns)
        else:
            self.thought = self.verdict = None
            self._stand_by(now, telemetry)

    @property
    def engaged(self) -> bool:
        """Whether there is something to fly: a setup that fits."""
        return self.flying is not None

    @property
    def late(self) -> bool:
        """Whether the game runs without this agent until the master lets it act again."""
        return self.part.waits_for_resume(self._table.phase)

    @property
    def over(self) -> bool:
        """Whether the game has ended."""
        return self.part.over(self._table.phase)

    def lacks(self, now: float, connected: bool) -> tuple[str, ...]:
        """What is missing before this agent can play."""
        role = self.config.role
        lacks = lacking(now, self._craft, self._table, self.policy, role, self.why_not, connected)
        if self.take_off.climbing:
            lacks = (*lacks, f"its height of {self.take_off.height:g} m")
        return (*lacks, "the master's resume") if self.late else lacks

    def game_time(self, wall_ns: int) -> float:
        """Seconds since t₀; 0 before it is fixed."""
        return self.part.game_time(self._table.phase, wall_ns)

    def _on(self, now: float, wall_ns: int) -> bool:
        """Whether it is time to act."""
        return self.part.running(self._table.phase, wall_ns)

    def _near(self) -> bool:
        """Whether control should be taken."""
        return self.part.about_to(self._table.phase) and not self.late

    def measured(self, track: Track) -> None:
        """A measurement came: the predictor takes it now, so that no setpoint waits for that."""
        at = (track.stamp_ns - self._base_ns) / NS_PER_S
        sample = TrackSample(track.id, at, Vec(*track.position), Vec(*track.velocity), track.covariance)
        self._memory.take((sample,))
        if self.thought is not None:  # in play: what the next step asks for is reckoned now
            self._memory.predict(track.id, (self._clock.wall_ns() - self._base_ns) / NS_PER_S)

    def train(self, wall_ns: int) -> None:
        """Give the predictors a little time, after everything else is done."""
        if self.flying is not None:
            self._memory.train((wall_ns - self._base_ns) / NS_PER_S, TRAINING_SLICES)

    # ------------------------------------------------------------------ what the master says

    def _follow(self, wall_ns: int) -> None:
        table = self._table
        retry = self.flying is None and bool(self.why_not) and self._craft.hovers is not None
        if table.setup is not None and (table.setup_number != self._setup_seen or retry):
            self._setup_seen = table.setup_number
            self._consider(table.setup)
        phase = table.phase
        if phase is None or phase is self._phase_seen:
            return
        before, self._phase_seen = self._phase_seen, phase
        was = self.part.joined
        self.part.follow(phase, wall_ns)
        if phase.phase is Phase.RUNNING and not self.part.joined:
            self._journal.warning("late", "the game runs already: waiting for the master's resume")
        elif phase.phase is Phase.RUNNING and not was:
            self._journal.info("resumed", "the master lets this agent act")
        elif before is None or before.phase is not phase.phase:
            self._journal.info("phase", phase.phase.value + (f": {phase.reason}" if phase.reason else ""))

    def _consider(self, setup: Setup) -> None:
        """A new setup: take it, or refuse it with the reason."""
        if self.flying is not None:
            self.part.leave()
            self._phase_seen = None
            self.flying = None
        why = limits.contradiction(self.config, setup, self._craft.hovers)
        try:
            pilot = None if why else self._pilot(setup)
        except ConfigError as error:
            pilot, why = None, str(error)
        if pilot is None:
            if why != self.why_not:
                self._journal.error("setup_refused", why)
            self.why_not = why
            return
        self.why_not = ""
        hovers = self._craft.hovers is not False
        origin = setup.origin
        self._craft.observer.frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
        self.policy = limits.policy_of(self.config, setup, hovers)
        mates = (m.id for m in setup.roster if m.role is self.config.role and m.id != self.config.id)
        self._table.follow(tuple(mates))
        game = limits.game_setup(self.config, setup, self._table.target, hovers)
        opponents = [player.id for player in game.opponents(self.side)]
        self._memory, self._watch = Memory(self.config.prediction, opponents), Watch()
        self.flying = Flying(game, pilot)
        self._journal.info("setup", f"{setup.scenario} from {setup.master}: {len(setup.roster)} vehicles")

    def _pilot(self, setup: Setup) -> Pilot:
        """The thinker for a setup. Raises ConfigError for a strategy that does not exist."""
        member = limits.member_of(setup, self.config.id)
        name = self.config.strategy or (member.strategy if member is not None else "")
        if self.side is Side.EVADER:
            evade = evader_strategy(name)
            return Pilot(self.config.id, self.side, name, evader=None if name in ("", *EVADERS) else evade)
        pursue = pursuer_strategy(name)
        return Pilot(self.config.id, self.side, name, pursuer=None if name in ("", *PURSUERS) else pursue)

    # ------------------------------------------------------------------ whose hands fly

    def _hands(self, now: float, t: Telemetry) -> None:
        """Notice silence, take-over and handing back."""
        craft = self._craft
        if t.heartbeat_at != NEVER and now - max(t.heartbeat_at, t.position_at) > SILENT_S:
            self._silent_at = now
        if craft.taken:
            craft.taken = False
            fell_back = t.mode == "HOLD" and now - self._silent_at < REGAIN_S
            if fell_back and self._may_control() and craft.adapter is not None:
                self._journal.warning("regain", f"{t.mode} while the link was silent: asking again")
                craft.adapter.enter(now)
            else:
                self._orders.pilot(hands_back=False)
        if craft.rebooted:
            craft.rebooted = False
            self._orders.pilot(hands_back=True)
        if craft.handed_back:
            craft.handed_back = False
            self._orders.pilot(hands_back=True)

    def _may_control(self) -> bool:
        """Whether this agent may enter the guided mode by itself."""
        return self.config.take_control or self._orders.granted

    def _stand_by(self, now: float, t: Telemetry) -> None:
        """Before and after the game: take control when it is about to begin, leave when it is over."""
        adapter = self._craft.adapter
        if adapter is None:
            return
        orders = self._orders
        idle = adapter.stage in (Stage.IDLE, Stage.LEFT)
        if orders.way is not None:
            adapter.leave(now, orders.way)
        elif self.over:
            if adapter.stage in (Stage.ACTIVE, Stage.ENTERING):
                adapter.leave(now, ReleaseMode.HOLD)
        elif self.engaged and self._may_control() and self._near() and idle:
            adapter.enter(now)
        if orders.resumed:
            self._watch = Watch()
            orders.resumed = False
        if self._takes_off(now):
            self._craft.step(now, None)
            return
        ours = adapter.stage in (Stage.ENTERING, Stage.ACTIVE)
        fresh = now - t.position_at <= self.policy.telemetry_age
        hover = ours and fresh and not adapter.holds_airspeed
        self._craft.step(now, Setpoint(ZERO) if hover else None)

    def _takes_off(self, now: float) -> bool:
        """A ground start: whether the vehicle is on its way up, by this agent's doing."""
        allowed = self.config.may_arm and self.engaged and self._may_control()
        if not allowed or self._orders.way is not None or self.over:
            return False
        return self.take_off.step(now, self._craft)

    # ------------------------------------------------------------------ think, supervise, send

    def _decide(self, now: float, wall_ns: int, own: Own) -> PilotDecision | None:
        """Ask the pilot."""
        flying, table = self.flying, self._table
        if flying is None:
            return None
        game = flying.game
        if self.side is Side.EVADER and table.target is not None and game.target.position != table.target:
            game = game._replace(target=Target(True, table.target))
            self.flying = flying._replace(game=game)
        at = (wall_ns - self._base_ns) / NS_PER_S
        mates = tuple(carried(mate, at) for mate in table.mate_states(self._base_ns))
        return flying.pilot.step(at, own, mates, game, self._memory)

    def _think(self, now: float, wall_ns: int, t: Telemetry, begun_ns: int) -> None:
        craft = self._craft
        hovers = craft.hovers is not False
        wind = t.wind if not hovers and now - t.wind_at < WIND_FRESH_S else ZERO
        position = along(t.position, t.velocity, min(max(0.0, now - t.position_at), 0.5))
        try:
            self.thought = self._decide(now, wall_ns, Own(position, t.velocity, wind))
            self._alive_at = self._clock.monotonic_ns() / NS_PER_S
            self._failing = False
        except Exception as error:  # a strategy of another distribution may fail in any way
            self.failures += 1
            if not self._failing:
                self._journal.error("strategy", f"{type(error).__name__}: {error}")
            self._failing = True
        thought = self.thought
        # A strategy that took too long has stalled.
        thinking = (self._clock.monotonic_ns() - begun_ns) / NS_PER_S
        seen = Seen(
            now=now,
            id=self.config.id,
            position=t.position,
            velocity=t.velocity,
            wind=wind,
            mates=self._mates(now),
            telemetry_age=now - t.position_at if t.placed else inf,
            heartbeat_age=now - t.heartbeat_at,
            strategy_age=max(thinking, now - self._alive_at),
            track_sigma=thought.sigma if thought is not None else inf,
            ground_age=now - self._table.master_at,
            clock_jump_age=now - self._jumps.jumped_at,
            battery=t.battery,
            ekf_ok=t.ekf_ok or t.ekf_at == NEVER,
            gps_fix=t.gps_fix if t.gps_at != NEVER else 3,
            pilot=craft.stage is Stage.TAKEN,
            order=self._orders.action,
            handed_back=self._orders.resumed,
        )
        self._orders.resumed = False
        wanted = thought.velocity if thought is not None and thought.decides else ZERO
        verdict = supervise(wanted, seen, self.policy, self._watch)
        self._watch, self.verdict = verdict.watch, verdict
        self._carry_out(now, verdict, wind, hovers)
        if verdict.changed:
            self._say(verdict)

    def _carry_out(self, now: float, verdict: Verdict, wind: Vec, hovers: bool) -> None:
        """From a verdict to what the adapter is asked for."""
        adapter = self._craft.adapter
        if adapter is None:
            return
        ours = adapter.stage in (Stage.ACTIVE, Stage.ENTERING)
        setpoint: Setpoint | None = None
        if self._orders.way is not None:
            adapter.leave(now, self._orders.way)
        elif verdict.stream:
            if not ours and adapter.stage is not Stage.TAKEN and self._may_control():
                adapter.enter(now)
            setpoint = Setpoint(verdict.air, wind)
            self.setpoint = verdict.ground
        elif verdict.action is Action.HOLD:
            if hovers:
                setpoint = Setpoint(ZERO)
            elif ours:
                adapter.leave(now, ReleaseMode.HOLD)
        elif verdict.action is Action.RETURN:
            if ours or adapter.stage is Stage.LEAVING:
                adapter.leave(now, ReleaseMode.RETURN)
        elif verdict.cause is not Cause.PILOT:
            adapter.end(now)
        self._craft.step(now, setpoint)

    def _mates(self, now: float) -> tuple[Mate, ...]:
        found = []
        for id, heard in self._table.mates.items():
            age = now - heard.at
            velocity = Vec(*heard.state.velocity)
            there = along(Vec(*heard.state.position), velocity, min(max(0.0, age), 1.0))
            found.append(Mate(id, there, velocity, age))
        return tuple(found)

    def _say(self, verdict: Verdict) -> None:
        """Publish a transition of the supervisor, with the level and module whose decision it met."""
        action, thought = verdict.action, self.thought
        severity = Severity.INFO
        if action > Action.CLIP:
            severity = Severity.ERROR if action is Action.END else Severity.WARNING
        level, module = (thought.level, thought.module) if thought is not None else ("", "")
        word = ACTIONS[action]
        self._journal.say(severity, f"supervisor_{word}", f"{word}: {CAUSES[verdict.cause]}", level, module)


