"""The agent: telemetry, tracks and team mates in; one setpoint out, before anything is published.

Wiring and the control step; the rules live in `onboard.core.safety`, the thinking in `onboard.pilot`.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Sequence
from math import inf
from typing import NamedTuple

from onboard.agent import limits, reports
from onboard.agent.clocks import JumpWatch
from onboard.agent.config import AgentConfig, KnockOff
from onboard.agent.craft import Craft
from onboard.agent.game import Part
from onboard.agent.journal import Journal
from onboard.agent.orders import Orders
from onboard.agent.radio import Radio, Record
from onboard.agent.readiness import lacking
from onboard.agent.table import Table
from onboard.agent.timing import Timing
from onboard.autopilot.base import NEVER, Setpoint, Stage, Telemetry, Way
from onboard.core.safety.machine import Verdict, Watch, supervise
from onboard.core.safety.policy import Action, Cause, Mate, Policy, Seen
from onboard.core.safety.words import ACTIONS, CAUSES
from onboard.core.strategies import EVADERS, PURSUERS
from onboard.core.vectors import ZERO, Vec, along
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import Pilot, Thought
from onboard.pilot.setup import GameSetup, Own, Side
from onboard.runtime.config import ConfigError
from onboard.runtime.plugins import evader_strategy, pursuer_strategy
from onboard.runtime.protocols import Bus, Clock, Link
from onboard.runtime.tasks import Pace, periodic
from onboard.wire import swarm
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink import Packet
from onboard.wire.signing import Signing
from onboard.wire.swarm import CommandReply, Health, Phase, Role, Setup, Severity
from onboard.wire.topics import ALIVE, COMMAND, DECISION, HEALTH, STATE, key

STATE_EVERY_S = 0.045  # 20 Hz at the control rate
DECISION_EVERY_S = 0.095
ADAPTER_EVERY_S = 0.075  # the adapter's own retries want 80 ms
LEAVE_S = 1.4  # to leave the vehicle in a mode it can hold alone
SILENT_S = 1.0  # a link silent for longer explains that the autopilot changed to hold by itself
REGAIN_S = 6.0  # … for so long afterwards
WIND_FRESH_S = 10.0
TRAINING_SLICES = 2  # of about 1 ms, after each control step
_NS = 1_000_000_000


def to_stderr(line: str) -> None:
    """One line to standard error: the journal's place under systemd."""
    print(line, file=sys.stderr, flush=True)


class Flying(NamedTuple):
    """What a game needs, made once from a setup that fits."""

    setup: Setup
    policy: Policy
    game: GameSetup
    pilot: Pilot


class Agent:
    """Flies one vehicle. Everything it needs is handed in; `run` it on any loop, end it with `stop`.

    `nonce` is random for each process; `record(wall_ns, frame)` sees every MAVLink frame; `beat` is called
    with each control step (a service's watchdog). Cancelling `run` falls silent at once, as a kill would;
    `stop` first leaves the vehicle in a mode that its autopilot can hold alone.
    """

    def __init__(
        self,
        config: AgentConfig,
        clock: Clock,
        links: Sequence[Link],
        bus: Bus,
        *,
        nonce: int,
        version: str = "",
        log: Callable[[str], None] = to_stderr,
        record: Record | None = None,
        signing: Signing | None = None,
        beat: Callable[[], None] | None = None,
    ) -> None:
        self.config = config
        self.id = config.id
        self.side = Side.EVADER if config.role is Role.EVADER else Side.PURSUER
        self.version = version
        self.nonce = nonce
        self.clock = clock
        self.bus = bus
        self.journal = Journal(config.id, config.game, nonce, clock, bus, log)
        link_id = config.signing.link_id if config.signing is not None else 0
        self.radio = Radio(
            links, config.id, clock, signing=signing, link_id=link_id, record=record, mute=config.dry_run
        )
        self.craft = Craft(config, self.radio, self.journal)
        self.table = Table(config.game, config.id, config.role, nonce, clock, bus, self.journal)
        abort = Way.RETURN if config.safety.abort is KnockOff.RETURN else Way.HOLD
        self.orders = Orders(abort)
        self.part = Part(config.id)
        self.timing = Timing()
        self.memory = Memory()
        self.watch = Watch()
        self.flying: Flying | None = None
        self.thought: Thought | None = None
        self.verdict: Verdict | None = None
        self.setpoint = ZERO  # [m/s; ground] last sent
        self.stage = "waiting"
        self.lacks: tuple[str, ...] = ()
        self.policy = limits.policy_of(config, None, True)
        self.counts: dict[str, int] = {}
        self._beat = beat
        self._stop = asyncio.Event()
        self._jumps = JumpWatch(config.safety.clock_jump_s)
        self._base_ns = clock.wall_ns()
        self._period = 1.0 / config.control_rate_hz
        self._stepped = self._state_at = self._decision_at = self._alive_at = NEVER
        self._silent_at = NEVER  # when the link was last found silent [s]
        self._setup_seen = 0
        self._why_not = ""
        self._phase_seen: object = None
        self._strategy_failed = False
        self._acted_ns = 0
        self._connected = True
        self._pace = Pace("control", min(self._period, ADAPTER_EVERY_S))
        self._keys = {topic: key(config.game, topic, config.id) for topic in (STATE, DECISION, HEALTH)}

    # ------------------------------------------------------------------ life

    async def run(self) -> None:
        """Fly until `stop` (or until cancelled)."""
        config = self.config
        role = f"{config.role.value} {config.id}" + (", dry run: sends nothing" if config.dry_run else "")
        self.journal.info("started", f"{role}, game '{config.game}', link {self.radio.active}")
        self.table.open()
        served = self.bus.serve(key(config.game, COMMAND, config.id), self._command)
        token = self.bus.announce(key(config.game, ALIVE, config.id))
        self.radio.open(self._hear)
        try:
            async with asyncio.TaskGroup() as group:
                tasks = [
                    group.create_task(periodic(self._pace, self._timer, self.clock), name="control"),
                    group.create_task(
                        periodic(Pace("heartbeat", 1.0), self.craft.heartbeat, self.clock), name="heartbeat"
                    ),
                    group.create_task(periodic(Pace("health", 0.5), self._report, self.clock), name="health"),
                ]
                await self._stop.wait()
                await self._leave()
                for task in tasks:
                    task.cancel()
        finally:
            served.close()
            token.close()
            self.table.close()

    def stop(self) -> None:
        """Leave the vehicle and end `run`."""
        self._stop.set()

    async def _leave(self) -> None:
        """Into a mode that the autopilot can hold alone, as far as it is ours to leave."""
        craft = self.craft
        adapter = craft.adapter
        ours = adapter is not None and adapter.stage in (Stage.ACTIVE, Stage.ENTERING)
        if ours and adapter is not None and not self.config.dry_run:
            until = self.now + LEAVE_S
            adapter.leave(self.now, Way.HOLD)
            while self.now < until and adapter.stage is Stage.LEAVING:
                craft.look(self.now)
                craft.step(self.now, None)
                await asyncio.sleep(0.05)
            left = adapter.stage is Stage.LEFT
            text = f"vehicle left in {craft.telemetry.mode}" + ("" if left else ", unconfirmed")
            self.journal.say(Severity.INFO if left else Severity.ERROR, "stopped", text)
        else:
            self.journal.info("stopped", "the vehicle was not under this agent's control")
        self.stage = "ended"
        self._publish_health()

    @property
    def now(self) -> float:
        """Monotonic time [s]."""
        return self.clock.monotonic_ns() / _NS

    # ------------------------------------------------------------------ what arrives

    def _hear(self, packet: Packet, now: float) -> None:
        if self.craft.hear(packet, now) and now - self._stepped >= 0.8 * self._period:
            arrived_ns = self.clock.monotonic_ns()
            self.step(now)
            self.timing.latency(self._acted_ns - arrived_ns)

    def _timer(self) -> None:
        now = self.now
        if now - self._stepped >= 1.4 * self._period:
            self.timing.timer_steps += 1
            self.step(now)
        elif self.craft.idle(now) >= ADAPTER_EVERY_S:
            self.craft.step(now, None)
        self.craft.chores(now)

    def _command(self, payload: bytes) -> bytes:
        """Answer a request on `vehicles/<id>/command`; repeating one changes nothing."""
        command = swarm.COMMAND.decode(payload, self.table.drops)
        now = self.now
        if command is None:
            bad = CommandReply("", self.id, "refused", "undecodable", "", self.clock.wall_ns())
            return swarm.COMMAND_REPLY.encode(bad)
        entry, new = self.orders.give(command, self._refusal(command.kind))
        if new:
            text = f"{command.kind.value} from {command.sender}"
            if entry.reason:
                self.journal.warning("command_refused", f"{text}: {entry.reason}")
            else:
                self.journal.info("command", text)
                self.craft.look(now)
                self._obey(now)
                self.craft.step(now, None)
        self._review_orders()
        reply = CommandReply(
            command_id=command.command_id,
            id=self.id,
            state=entry.state.value,
            reason=entry.reason,
            obeyed=self.orders.obeyed,
            stamp_ns=self.clock.wall_ns(),
            mode=self.craft.telemetry.mode,
        )
        return swarm.COMMAND_REPLY.encode(reply)

    def _refusal(self, kind: swarm.CommandKind) -> str:
        """Why a command cannot be obeyed; '' if it can."""
        if self.config.dry_run:
            return "dry run: this agent sends nothing"
        if self.craft.adapter is None:
            return self.craft.refusal or "no autopilot"
        sets_off = kind in (swarm.CommandKind.RESUME, swarm.CommandKind.START)
        if self.craft.stage is Stage.TAKEN and not sets_off:
            return f"a pilot flies it, in {self.craft.telemetry.mode}"
        return ""

    def _obey(self, now: float) -> None:
        """Tell the adapter what the order in force is."""
        adapter = self.craft.adapter
        if adapter is None:
            return
        if self.orders.way is not None:
            adapter.leave(now, self.orders.way)
        elif self.orders.resumed:
            adapter.enter(now)

    def _review_orders(self) -> None:
        entry = self.orders.review(self.craft.stage)
        if entry is not None:
            text = f"{entry.command.kind.value} from {entry.command.sender} {entry.state.value}"
            self.journal.info(f"command_{entry.state.value}", text)

    # ------------------------------------------------------------------ the control step

    def step(self, now: float) -> None:
        """One control step at monotonic time `now` [s]: decide, supervise, send; then publish."""
        begun_ns = self.clock.monotonic_ns()
        self._stepped = now
        wall_ns = self.clock.wall_ns()
        jump = self._jumps.look(wall_ns, begun_ns)
        if jump != 0.0:
            self.table.clock.restart()
            self.journal.error("clock_jump", f"the wall clock jumped by {jump:+.3f} s")
        telemetry = self.craft.look(now)
        self._follow(now, wall_ns)
        self._hands(now, telemetry)
        running = self.part.running(self.table.phase, wall_ns)
        self.setpoint = ZERO
        if running and self.flying is not None:
            self._act(now, wall_ns, telemetry, self.flying, begun_ns)
        else:
            self.thought = self.verdict = None
            self.table.tracks(self._base_ns) if self.flying is None else self._prepare(wall_ns)
            self._stand_by(now, telemetry)
        self._acted_ns = self.clock.monotonic_ns()
        self.timing.step(self._acted_ns - begun_ns)
        self._review_orders()
        if self._beat is not None:
            self._beat()
        self._publish(now, wall_ns, telemetry)
        if self.flying is not None:
            self.memory.train((wall_ns - self._base_ns) / _NS, TRAINING_SLICES)

    def _follow(self, now: float, wall_ns: int) -> None:
        """Take in what the master has said since."""
        table = self.table
        if table.setup_number != self._setup_seen:
            self._setup_seen = table.setup_number
            self._consider()
        elif self._why_not and self.flying is None and self.craft.hovers is not None:
            self._consider()
        if table.phase is not None and table.phase is not self._phase_seen:
            self._phase_seen = table.phase
            was = self.part.joined
            self.part.follow(table.phase, wall_ns)
            phase = table.phase
            if phase.phase is Phase.RUNNING and not self.part.joined:
                self.journal.warning("late", "the game runs already: waiting for the master's resume")
            elif phase.phase is Phase.RUNNING and not was:
                self.journal.info("resumed", "the master lets this agent act again")
            else:
                reason = f": {phase.reason}" if phase.reason else ""
                self.journal.info("phase", f"{phase.phase.value}{reason}")

    def _consider(self) -> None:
        """A new setup: take it, or refuse it with the reason."""
        setup = self.table.setup
        craft = self.craft
        if setup is None:
            return
        if self.flying is not None:
            self.part.leave()
            self._phase_seen = None
        self.flying = None
        why = limits.contradiction(self.config, setup, craft.hovers)
        pilot: Pilot | None = None
        if not why:
            try:
                pilot = self._pilot(setup)
            except ConfigError as error:
                why = str(error)
        if why or pilot is None:
            if why != self._why_not:
                self.journal.error("setup_refused", why)
            self._why_not = why
            return
        self._why_not = ""
        hovers = craft.hovers is not False
        origin = setup.origin
        craft.observer.frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
        self.policy = limits.policy_of(self.config, setup, hovers)
        craft.envelope(limits.adapter_envelope(self.config, self.policy.envelope))
        self.table.follow(
            tuple(m.id for m in setup.roster if m.role is self.config.role and m.id != self.id)
        )
        self.memory = Memory()
        self.watch = Watch()
        game = limits.game_setup(self.config, setup, self.table.target, hovers)
        self.flying = Flying(setup, self.policy, game, pilot)
        self.journal.info("setup", f"{setup.scenario} from {setup.master}: {len(setup.roster)} vehicles")

    def _pilot(self, setup: Setup) -> Pilot:
        """The thinker for a setup. Raises ConfigError for a strategy that does not exist."""
        member = limits.member_of(setup, self.id)
        name = self.config.strategy or (member.strategy if member is not None else "")
        if self.side is Side.EVADER:
            evade = evader_strategy(name)
            return Pilot(self.id, self.side, name, evader=None if not name or name in EVADERS else evade)
        pursue = pursuer_strategy(name)
        return Pilot(self.id, self.side, name, pursuer=None if not name or name in PURSUERS else pursue)

    def _hands(self, now: float, t: Telemetry) -> None:
        """Whose hands fly: notice silence, take-over and handing back."""
        craft = self.craft
        if t.heartbeat_at != NEVER and now - max(t.heartbeat_at, t.position_at) > SILENT_S:
            self._silent_at = now
        if craft.taken:
            craft.taken = False
            fell_back = t.mode == "HOLD" and now - self._silent_at < REGAIN_S
            if fell_back and self._may_control() and craft.adapter is not None:
                self.journal.warning(
                    "regain", f"the autopilot fell back to {t.mode} while the link was silent: asking again"
                )
                craft.adapter.enter(now)
            else:
                self.orders.pilot(hands_back=False)
        if craft.handed_back:
            craft.handed_back = False
            self.orders.pilot(hands_back=True)
            self.orders.resumed = True

    def _may_control(self) -> bool:
        """Whether this agent may enter the guided mode by itself."""
        return self.config.take_control or self.orders.granted

    def _prepare(self, wall_ns: int) -> None:
        """Keep the tracks warm while the game has not begun."""
        self.memory.take(self.table.tracks(self._base_ns))

    def _stand_by(self, now: float, t: Telemetry) -> None:
        """Before and after the game: take control when it is about to begin, leave when it is over."""
        adapter = self.craft.adapter
        if adapter is None:
            return
        setpoint: Setpoint | None = None
        if self.orders.way is not None:
            adapter.leave(now, self.orders.way)
        elif self.part.over(self.table.phase):
            if adapter.stage in (Stage.ACTIVE, Stage.ENTERING):
                adapter.leave(now, Way.HOLD)
        elif (
            self.flying is not None
            and self._may_control()
            and self.part.about_to(self.table.phase)
            and not self.part.waits_for_resume(self.table.phase)
            and adapter.stage in (Stage.IDLE, Stage.LEFT)
        ):
            adapter.enter(now)
        if self.orders.resumed:
            self.watch = Watch()
            self.orders.resumed = False
        if (
            not adapter.holds_airspeed
            and adapter.stage in (Stage.ENTERING, Stage.ACTIVE)
            and now - t.position_at <= self.policy.telemetry_age
        ):
            setpoint = Setpoint(ZERO)
        self.craft.step(now, setpoint)

    def _act(self, now: float, wall_ns: int, t: Telemetry, flying: Flying, begun_ns: int) -> None:
        """Think, supervise, send."""
        craft, adapter = self.craft, self.craft.adapter
        hovers = craft.hovers is not False
        wind = t.wind if not hovers and now - t.wind_at < WIND_FRESH_S else ZERO
        at = (wall_ns - self._base_ns) / _NS
        position = along(t.position, t.velocity, min(max(0.0, now - t.position_at), 0.5))
        game = flying.game
        if self.side is Side.EVADER and self.table.target is not None and not game.has_target:
            game = game._replace(has_target=True, target=self.table.target)
            self.flying = flying = flying._replace(game=game)
        try:
            self.thought, self.memory = flying.pilot.step(
                at, Own(position, t.velocity), self.table.tracks(self._base_ns),
                self.table.mate_states(self._base_ns), game, wind, self.memory,
            )  # fmt: skip
            self._alive_at = self.now
            self._strategy_failed = False
        except Exception as error:  # a strategy of another distribution may fail in any way
            self.counts["strategy_failures"] = self.counts.get("strategy_failures", 0) + 1
            if not self._strategy_failed:
                self.journal.error("strategy", f"{type(error).__name__}: {error}")
            self._strategy_failed = True
        thought = self.thought
        thinking = (self.clock.monotonic_ns() - begun_ns) / _NS  # a strategy that took too long has stalled
        seen = Seen(
            now=now,
            id=self.id,
            position=t.position,
            velocity=t.velocity,
            wind=wind,
            mates=self._mates(now),
            telemetry_age=now - t.position_at if t.placed else inf,
            heartbeat_age=now - t.heartbeat_at,
            strategy_age=max(thinking, now - self._alive_at),
            track_sigma=thought.sigma if thought is not None else inf,
            ground_age=now - self.table.master_at,
            clock_jump_age=now - self._jumps.jumped_at,
            battery=t.battery,
            ekf_ok=t.ekf_ok or t.ekf_at == NEVER,
            gps_fix=t.gps_fix if t.gps_at != NEVER else 3,
            pilot=craft.stage is Stage.TAKEN,
            order=self.orders.action,
            handed_back=self.orders.resumed,
        )
        self.orders.resumed = False
        wanted = thought.velocity if thought is not None and thought.decides else ZERO
        verdict = supervise(wanted, seen, flying.policy, self.watch)
        self.watch, self.verdict = verdict.watch, verdict
        if adapter is not None:
            self._carry_out(now, verdict, wind, hovers)
        if verdict.changed:
            self._say_transition(verdict)

    def _carry_out(self, now: float, verdict: Verdict, wind: Vec, hovers: bool) -> None:
        """From a verdict to what the adapter is asked for."""
        craft, adapter = self.craft, self.craft.adapter
        assert adapter is not None
        setpoint: Setpoint | None = None
        if self.orders.way is not None:
            adapter.leave(now, self.orders.way)
        elif verdict.stream:
            if adapter.stage in (Stage.IDLE, Stage.LEFT, Stage.LEAVING) and self._may_control():
                adapter.enter(now)
            setpoint = Setpoint(verdict.air, wind)
            self.setpoint = verdict.ground
        elif verdict.action is Action.HOLD:
            if hovers:
                setpoint = Setpoint(ZERO)
            elif adapter.stage in (Stage.ACTIVE, Stage.ENTERING):
                adapter.leave(now, Way.HOLD)
        elif verdict.action is Action.RETURN:
            if adapter.stage in (Stage.ACTIVE, Stage.ENTERING, Stage.LEAVING):
                adapter.leave(now, Way.RETURN)
        elif verdict.cause is not Cause.PILOT:
            adapter.end(now)
        craft.step(now, setpoint)

    def _mates(self, now: float) -> tuple[Mate, ...]:
        found = []
        for id, heard in self.table.mates.items():
            age = now - heard.at
            velocity = Vec(*heard.state.velocity)
            there = along(Vec(*heard.state.position), velocity, min(max(0.0, age), 1.0))
            found.append(Mate(id, there, velocity, age))
        return tuple(found)

    def _say_transition(self, verdict: Verdict) -> None:
        action = verdict.action
        if action <= Action.CLIP:
            severity = Severity.INFO
        else:
            severity = Severity.ERROR if action is Action.END else Severity.WARNING
        text = f"{ACTIONS[action]}: {CAUSES[verdict.cause]}"
        thought = self.thought
        self.journal.say(
            severity,
            f"supervisor_{ACTIONS[action]}",
            text,
            thought.level if thought is not None else "",
            thought.module if thought is not None else "",
        )

    # ------------------------------------------------------------------ what it says

    def _publish(self, now: float, wall_ns: int, t: Telemetry) -> None:
        if t.placed and now - self._state_at >= STATE_EVERY_S and now - t.position_at < 1.0:
            self._state_at = now
            state = reports.state_of(self.id, self.config.role, wall_ns, t, self.nonce)
            self.bus.publish(self._keys[STATE], swarm.STATE.encode(state), STATE.delivery)
        thought, verdict = self.thought, self.verdict
        if thought is not None and verdict is not None and now - self._decision_at >= DECISION_EVERY_S:
            self._decision_at = now
            time = self.part.game_time(self.table.phase, wall_ns)
            report = reports.decision_of(self.id, self.side, wall_ns, time, thought, verdict, self.setpoint)
            self.bus.publish(self._keys[DECISION], swarm.DECISION.encode(report), DECISION.delivery)

    def _report(self) -> None:
        """Health, and what is looked at twice a second."""
        now = self.now
        self.craft.look(now)
        connected = self.bus.connected()
        if connected != self._connected:
            self._connected = connected
            if connected:
                self.journal.info("bus", "the bus is there")
            else:
                self.journal.warning("bus", "the bus is gone: flying on what is known")
        config, table = self.config, self.table
        self.lacks = lacking(now, self.craft, table, self.policy, config.role, self._why_not, connected)
        if self.part.waits_for_resume(table.phase):
            self.lacks = (*self.lacks, "the master's resume")
        stage = self._judge_stage()
        if stage != self.stage:
            self.stage = stage
            lacks = f": lacks {', '.join(self.lacks)}" if self.lacks and stage == "waiting" else ""
            self.journal.info("stage", f"{stage}{lacks}")
        self._publish_health()

    def _judge_stage(self) -> str:
        if self.craft.stage is Stage.TAKEN:
            return "handed_over"
        if self.part.over(self.table.phase):
            return "ended"
        verdict = self.verdict
        if self.orders.way is not None:
            return "held"
        if verdict is not None:
            if not verdict.stream:
                return "held"
            if self.craft.stage is Stage.ACTIVE or self.config.dry_run:
                return "acting"
        return "waiting" if self.lacks else "ready"

    def _publish_health(self) -> None:
        now, t = self.now, self.craft.telemetry
        verdict = self.verdict
        counters = {
            **self.radio.counters(), **self.craft.foreign, **self.table.drops, **self.counts,
            **{f"bus_{cause}": n for cause, n in self.bus.counters().items()},
            **self._pace.counters(), **self.timing.counters(),
            "events_suppressed": self.journal.suppressed,
        }  # fmt: skip
        health = Health(
            id=self.id,
            role=self.config.role,
            stamp_ns=self.clock.wall_ns(),
            stage=self.stage,
            lacks=self.lacks,
            autopilot=self.craft.adapter.kind.value if self.craft.adapter is not None else "",
            mode=t.mode,
            armed=t.armed,
            battery=t.battery,
            link_quality=t.link_quality,
            telemetry_rate_hz=self.craft.position_rate.value,
            setpoint_rate_hz=self.craft.setpoint_rate.value,
            clock_offset_s=self.table.clock.offset_s,
            gps_fix=t.gps_fix,
            ekf_ok=t.ekf_ok,
            supervisor=ACTIONS[verdict.action] if verdict is not None else "ok",
            version=self.version,
            counters={cause: number for cause, number in counters.items() if number},
            telemetry_age_s=min(now - t.position_at, 1e6),
            heartbeat_age_s=min(now - t.heartbeat_at, 1e6),
            nonce=self.nonce,
        )
        self.bus.publish(self._keys[HEALTH], swarm.HEALTH.encode(health), HEALTH.delivery)
