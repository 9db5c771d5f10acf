"""The agent: telemetry, tracks and team mates in; one setpoint out, before anything is published.

Wiring alone: the rules live in `onboard.core.safety`, the thinking in `onboard.pilot`, the part played
in a game in `acting`, the own autopilot in `craft`, the bus in `table`.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Sequence

from onboard.agent import reports
from onboard.agent.bus_view import Table
from onboard.agent.command_book import Orders
from onboard.agent.config import AgentConfig, KnockOff
from onboard.agent.game_player import Acting
from onboard.agent.journal import Journal
from onboard.agent.mavlink_radio import Radio, Record
from onboard.agent.route_player import Tracking
from onboard.agent.timing import Timing
from onboard.agent.vehicle_link import Craft
from onboard.autopilot.base import ReleaseMode, Stage, Telemetry
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.runtime.protocols import Bus, Clock, Link
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.bus.messages import (
    AgentStage,
    CommandKind,
    CommandReply,
    CommandState,
    Health,
    Role,
    Severity,
    SupervisorAction,
)
from onboard.wire.bus.topics import ALIVE, COMMAND, DECISION, HEALTH, STATE
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.signing import Signing

STATE_EVERY_S = 0.045  # 20 Hz at the control rate
DECISION_EVERY_S = 0.095
LATE = 1.3  # periods after a step without a position: then the timer causes the next
ADAPTER_EVERY_S = 0.075  # the adapter's own retries want 80 ms
LEAVE_S = 1.4  # to leave the vehicle in a mode it can hold alone


def to_stderr(line: str) -> None:
    """One line to standard error: the journal's place under systemd."""
    print(line, file=sys.stderr, flush=True)


class Agent:
    """Flies one vehicle. Everything it needs is handed in; `run` it on any loop, end it with `stop`.

    `nonce` is random for each process; `record(wall_ns, frame)` sees every MAVLink frame; `beat` is called
    with each control step (a service's watchdog). Cancelling `run` falls silent at once, as a kill would;
    `stop` first leaves the vehicle in a mode its autopilot can hold alone. Links and bus are the caller's.
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
        self.version = version
        self.nonce = nonce
        self.clock = clock
        self.bus = bus
        self.journal = Journal(config.id, config.game, nonce, clock, bus.publish, log)
        link_id = config.signing.link_id if config.signing is not None else 0
        self.radio = Radio(
            links, config.id, clock, signing=signing, link_id=link_id, record=record, mute=config.dry_run
        )
        self.craft = Craft(config, self.radio, self.journal)
        self.table = Table(config.game, config.id, config.role, nonce, clock, bus, self.journal)
        back = config.safety.abort is KnockOff.RETURN
        self.orders = Orders(ReleaseMode.RETURN if back else ReleaseMode.HOLD)
        part = Tracking if config.role is Role.TRACKER else Acting
        self.acting = part(config, clock, self.craft, self.table, self.orders, self.journal)
        self.timing = Timing(1.0 / config.control_rate_hz)
        self.stage = AgentStage.WAITING
        self.lacks: tuple[str, ...] = ()
        self._beat = beat
        self._stop = asyncio.Event()
        self._period = 1.0 / config.control_rate_hz
        self._stepped = self._state_at = self._decision_at = NEVER
        self._acted_ns = 0
        self._by_timer = False
        self._connected = True
        self._late: asyncio.TimerHandle | None = None
        self._pace = Pace("chores", ADAPTER_EVERY_S)
        self._keys = {topic: topic.key(config.game, config.id) for topic in (STATE, DECISION, HEALTH)}

    @property
    def now(self) -> float:
        """Monotonic time [s]."""
        return self.clock.monotonic_ns() / NS_PER_S

    # ------------------------------------------------------------------ life

    async def run(self) -> None:
        """Fly until `stop` (or until cancelled)."""
        config = self.config
        role = f"{config.role.value} {config.id}" + (", dry run: sends nothing" if config.dry_run else "")
        self.journal.info("started", f"{role}, game '{config.game}', link {self.radio.active}")
        self.table.open()
        served = self.bus.serve(COMMAND.key(config.game, config.id), self._command)
        token = self.bus.announce(ALIVE.key(config.game, config.id))
        self.radio.open(self._hear)
        self._expect()
        beat, health = Pace("heartbeat", 1.0), Pace("health", 0.5)
        try:
            async with asyncio.TaskGroup() as group:
                tasks = [
                    group.create_task(periodic(self._pace, self._timer, self.clock), name="chores"),
                    group.create_task(periodic(beat, self.craft.heartbeat, self.clock), name="heartbeat"),
                    group.create_task(periodic(health, self._report, self.clock), name="health"),
                ]
                await self._stop.wait()
                for task in tasks:
                    task.cancel()
                await self._leave()
        finally:
            if self._late is not None:
                self._late.cancel()
            self.craft.close()
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
        if adapter is None or self.config.dry_run or adapter.stage not in (Stage.ACTIVE, Stage.ENTERING):
            self.journal.info("stopped", "the vehicle was not under this agent's control")
        else:
            until = self.now + LEAVE_S
            adapter.leave(self.now, ReleaseMode.HOLD)
            while self.now < until and self.craft.stage is Stage.LEAVING:
                craft.look(self.now)
                craft.step(self.now, None)
                await asyncio.sleep(0.05)
            left = self.craft.stage is Stage.LEFT
            text = f"vehicle left in {craft.telemetry.mode}" + ("" if left else ", unconfirmed")
            self.journal.say(Severity.INFO if left else Severity.ERROR, "stopped", text)
        self.stage = AgentStage.ENDED
        self._publish_health()

    # ------------------------------------------------------------------ what arrives

    def _hear(self, packet: Packet, now: float) -> None:
        new = self.craft.hear(packet, now)
        # After a step by the timer the next position counts sooner, or steps would stay with the timer.
        wait = (0.4 if self._by_timer else 0.8) * self._period
        if new and not self._stop.is_set() and now - self._stepped >= wait:
            self._by_timer = False
            self._expect()
            arrived_ns = self.clock.monotonic_ns()
            self.step(now)
            self.timing.latency(self._acted_ns - arrived_ns)

    def _expect(self) -> None:
        """Step by the timer if no position has caused a step by then."""
        if self._late is not None:
            self._late.cancel()
        self._late = asyncio.get_running_loop().call_later(LATE * self._period, self._overdue)

    def _overdue(self) -> None:
        if self._stop.is_set():
            return
        self._by_timer = True
        self._expect()
        self.timing.timer_steps += 1
        self.step(self.now)

    def _timer(self) -> None:
        now = self.now
        if self.craft.idle(now) >= ADAPTER_EVERY_S:
            self.craft.step(now, None)
        self.craft.chores(now)

    def _command(self, payload: bytes) -> bytes:
        """Answer a request on `vehicles/<id>/command`; repeating one changes nothing."""
        command = COMMAND.decode(payload, self.table.drops)
        now = self.now
        if command is None:
            bad = CommandReply("", self.id, CommandState.REFUSED, "undecodable", "", self.clock.wall_ns())
            return COMMAND.encode_reply(bad)
        entry, new = self.orders.give(command, self._refusal(command.kind))
        if new:
            text = f"{command.kind.value} from {command.sender}"
            if entry.reason:
                self.journal.warning("command_refused", f"{text}: {entry.reason}")
            else:
                self.journal.info("command", text)
                self._obey(now)
        self._review_orders()
        reply = CommandReply(
            command_id=command.command_id,
            id=self.id,
            state=entry.state,
            reason=entry.reason,
            obeyed=self.orders.obeyed,
            stamp_ns=self.clock.wall_ns(),
            mode=self.craft.telemetry.mode,
        )
        return COMMAND.encode_reply(reply)

    def _refusal(self, kind: CommandKind) -> str:
        """Why a command cannot be obeyed; '' if it can."""
        if self.config.dry_run:
            return "dry run: this agent sends nothing"
        if self.craft.adapter is None:
            return self.craft.refusal or "no autopilot"
        if self.craft.stage is Stage.TAKEN and kind not in (CommandKind.RESUME, CommandKind.START):
            return f"a pilot flies it, in {self.craft.telemetry.mode}"
        return ""

    def _obey(self, now: float) -> None:
        """Tell the adapter at once what the order in force is."""
        adapter = self.craft.adapter
        if adapter is None:
            return
        self.craft.look(now)
        if self.orders.way is not None:
            adapter.leave(now, self.orders.way)
        else:
            adapter.enter(now)
        self.craft.step(now, None)

    def _review_orders(self) -> None:
        entry = self.orders.review(self.craft.stage)
        if entry is not None:
            text = f"{entry.command.kind.value} from {entry.command.sender}"
            self.journal.info(f"command_{entry.state.value}", text)

    # ------------------------------------------------------------------ the control step

    def step(self, now: float) -> None:
        """One control step at monotonic time `now` [s]: decide, supervise, send; then publish."""
        begun_ns = self.clock.monotonic_ns()
        wall_ns = self.clock.wall_ns()
        self._stepped = now
        self.acting.step(now, wall_ns, begun_ns)
        self._acted_ns = self.clock.monotonic_ns()
        self.timing.step(self._acted_ns - begun_ns)
        if self._beat is not None:
            self._beat()
        self._review_orders()
        self._publish(now, wall_ns, self.craft.telemetry)
        self.acting.train(wall_ns)

    # ------------------------------------------------------------------ what it says

    def _publish(self, now: float, wall_ns: int, t: Telemetry) -> None:
        if t.placed and now - self._state_at >= STATE_EVERY_S and now - t.position_at < 1.0:
            self._state_at = now
            state = reports.state_of(self.id, self.config.role, wall_ns, t, self.nonce)
            self.bus.publish(self._keys[STATE], STATE.encode(state), STATE.delivery)
        acting = self.acting
        thought, verdict = acting.thought, acting.verdict
        if thought is not None and verdict is not None and now - self._decision_at >= DECISION_EVERY_S:
            self._decision_at = now
            time = acting.game_time(wall_ns)
            report = reports.decision_of(
                self.id, acting.side, wall_ns, time, thought, verdict, acting.setpoint
            )
            self.bus.publish(self._keys[DECISION], DECISION.encode(report), DECISION.delivery)

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
                self.journal.warning("bus", "no bus: flying on what is known")
        self.lacks = self.acting.lacks(now, connected)
        stage = self._judge_stage()
        if stage != self.stage:
            self.stage = stage
            lacks = f": lacks {', '.join(self.lacks)}" if self.lacks and stage is AgentStage.WAITING else ""
            self.journal.info("stage", f"{stage.value}{lacks}")
        self._publish_health()

    def _judge_stage(self) -> AgentStage:
        verdict = self.acting.verdict
        if self.craft.stage is Stage.TAKEN:
            return AgentStage.HANDED_OVER
        if self.acting.over:
            return AgentStage.ENDED
        if self.orders.way is not None or (verdict is not None and not verdict.stream):
            return AgentStage.HELD
        if verdict is not None and (self.craft.stage is Stage.ACTIVE or self.config.dry_run):
            return AgentStage.ACTING
        return AgentStage.WAITING if self.lacks else AgentStage.READY

    def _publish_health(self) -> None:
        now, t = self.now, self.craft.telemetry
        verdict = self.acting.verdict
        counters = {
            **self.radio.counters(), **self.craft.counters(), **self.table.drops,
            **{f"bus_{cause}": n for cause, n in self.bus.counters().items()},
            **self._pace.counters(), **self.timing.counters(),
            "strategy_failures": self.acting.failures, "events_suppressed": self.journal.suppressed,
        }  # fmt: skip
        health = Health(
            id=self.id,
            role=self.config.role,
            stamp_ns=self.clock.wall_ns(),
            stage=self.stage,
            lacks=self.lacks,
            autopilot=self.craft.adapter.kind if self.craft.adapter is not None else None,
            mode=t.mode,
            armed=t.armed,
            battery=t.battery,
            link_quality=t.link_quality,
            telemetry_rate_hz=self.craft.position_rate.value,
            setpoint_rate_hz=self.craft.setpoint_rate.value,
            clock_offset_s=self.table.clock.offset_s,
            gps_fix=t.gps_fix,
            ekf_ok=t.ekf_ok,
            supervisor=reports.action_of(verdict) if verdict is not None else SupervisorAction.OK,
            version=self.version,
            counters={cause: number for cause, number in counters.items() if number},
            telemetry_age_s=min(now - t.position_at, 1e6),
            heartbeat_age_s=min(now - t.heartbeat_at, 1e6),
            nonce=self.nonce,
        )
        self.bus.publish(self._keys[HEALTH], HEALTH.encode(health), HEALTH.delivery)
