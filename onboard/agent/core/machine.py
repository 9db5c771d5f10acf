"""The agent as one machine: `handle` an event, do the effects, call `idle`, and again at `next_deadline`.

Telemetry, tracks and team mates in; one setpoint out, before anything is published. `handle` gives what is
urgent. `idle`, called once that is done and only where `pending` says so, publishes and spends a little time
on learning.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, NamedTuple

from onboard.agent.config import AgentConfig, KnockOff
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.command_book import Orders
from onboard.agent.core.command_desk import CommandDesk
from onboard.agent.core.ending import Ending
from onboard.agent.core.events import (
    Announce,
    Answered,
    AnyEffect,
    AnyEvent,
    Beat,
    BusMessage,
    BusState,
    ChildExited,
    ChildSaid,
    Count,
    Counted,
    End,
    Instant,
    LinkBytes,
    LinkFacts,
    Loaded,
    Outbox,
    Publish,
    Request,
    Serve,
    Started,
    Stop,
    Tick,
)
from onboard.agent.core.flight import Flight
from onboard.agent.core.game_player import GamePlayer
from onboard.agent.core.journal import Journal
from onboard.agent.core.mavlink_radio import Radio
from onboard.agent.core.part import Part
from onboard.agent.core.reports import Reports, Standing
from onboard.agent.core.route_player import RoutePlayer
from onboard.agent.core.schedule import EARLY_S, Grid
from onboard.agent.core.signing_watch import SigningWatch
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Stage
from onboard.core.math.constants import NEVER
from onboard.core.safety.policy import Action
from onboard.game.route_file import Route
from onboard.wire.bus.messages import AgentStage, Role
from onboard.wire.bus.topics import ALIVE, COMMAND, DECISION, HEALTH, STATE, Topic
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.signing import Signing

STATE_EVERY_S = 0.045  # 20 Hz at the control rate
DECISION_EVERY_S = 0.095
LATE = 1.3  # periods after a step without a position: then the timer causes the next
ADAPTER_EVERY_S = 0.075  # the adapter's own retries want 80 ms


class Facts(NamedTuple):
    """What the machine is told of the world that it runs in, besides its configuration."""

    nonce: int  # random for each process
    links: tuple[LinkFacts, ...]
    version: str = ""  # of the package, for health reports
    route: Route | None = None  # of a tracker
    signed: bool = False  # whether links are signed, with a key that is not told here
    master: str = ""  # the member whose certificate may write as the master; "" = the bus tells none


class AgentCore:
    """Flies one vehicle. Raises ConfigError for a tracker's strategy that is none."""

    def __init__(self, config: AgentConfig, facts: Facts, signing: Signing | None = None) -> None:
        self.config = config
        self.facts = facts
        self.out = Outbox()
        self.journal = Journal(config.id, config.game, facts.nonce)
        link_id = config.signing.link_id if config.signing is not None else 0
        self.radio = Radio(
            facts.links, config.id, self.out, signing=signing, link_id=link_id, mute=config.dry_run
        )
        self.signing = SigningWatch(self.radio)
        self.vehicle = VehicleLink(config, self.radio, self.journal, self.out)
        self.bus = BusView(config, facts.nonce, self.out, self.journal, facts.master)
        self.orders = Orders(Action.RETURN if config.safety.abort is KnockOff.RETURN else Action.HOLD)
        self.game: GamePlayer | None = None
        part: Part
        if config.role is Role.TRACKER:
            assert facts.route is not None, "a tracker needs a route"
            part = RoutePlayer(config, facts.route, self.vehicle, self.bus, self.journal)
        else:
            part = self.game = GamePlayer(config, self.vehicle, self.bus, self.out, self.journal)
        self.part = part
        self.flight = Flight(config, self.vehicle, self.bus, self.orders, self.journal, part)
        self.desk = CommandDesk(config, facts.nonce, self.orders, self.flight, self.out, self.journal)
        self.ending = Ending(self.vehicle, self.flight, self.journal, mute=config.dry_run)
        self.reports = Reports(config, facts.nonce, facts.version, self.vehicle, self.bus, self.flight)
        self.stage, self.lacks = AgentStage.WAITING, tuple[str, ...]()
        self.steps = self.timer_steps = 0  # control steps; of them those that no position caused
        self._period = 1.0 / config.control_rate_hz
        self._chores, self._heartbeat, self._health = Grid(ADAPTER_EVERY_S), Grid(1.0), Grid(0.5)
        self._deadlines = (self._chores, self._heartbeat, self._health, self.flight.ahead)
        self._step_at = inf  # a control step by the timer is due [s]
        self._stepped = self._state_at = self._decision_at = NEVER
        self._by_timer = False
        self._stepped_wall: Instant | None = None  # of a control step that is not yet published
        self._messages: list[tuple[Topic[Any], bytes]] = []
        self._keys = {topic: topic.key(config.game, config.id) for topic in (STATE, DECISION, HEALTH)}
        self._handlers: dict[type, Callable[[Any, Instant], None]] = {
            Started: self._start,
            LinkBytes: self._take_bytes,
            BusMessage: self._take_message,
            Request: lambda event, now: self.desk.answer(event.token, event.payload, now),
            BusState: self._bus_changed,
            ChildSaid: lambda event, now: self.vehicle.child_said(event.line),
            ChildExited: lambda event, now: self.vehicle.child_exited(),
            Answered: self._answered,
            Loaded: self._loaded,
            Counted: self._report,
            Stop: self._stop,
            Tick: self._tick,
        }

    # ------------------------------------------------------------------ the machine

    def handle(self, event: AnyEvent, now: Instant) -> list[AnyEffect]:
        """Take an event; the effects are to be done in their order, at once."""
        if self.orders.open:
            self.desk.expire(now.s)
        self._handlers[type(event)](event, now)
        if self.radio.due:
            self.radio.flush(now)
        if self.journal.noted:
            self.journal.stamp(now)
        return self.out.take()

    def next_deadline(self) -> float:
        """When to call `handle` with a `Tick` at the latest [s, monotonic]; inf = not by itself."""
        if self.ending.begun:
            return self.ending.at
        at = self._step_at
        for other in self._deadlines:  # asked after every event: three times as fast as `min` of them all
            if other.at < at:
                at = other.at
        return at if self.flight.open is None else min(at, self._answer_by)

    @property
    def _answer_by(self) -> float:
        """When a strategy that was asked counts as stalled [s]; inf while none is."""
        asked = self.flight.open
        return inf if asked is None else asked.begun.s + self.config.safety.strategy_age_s + self._period

    @property
    def pending(self) -> bool:
        """Whether `idle` has something to do."""
        return self._stepped_wall is not None or bool(self._messages or self.journal.stamped)

    def idle(self, now: Instant) -> list[AnyEffect]:
        """Say what there is to say, and learn a little."""
        self.journal.tell(self.out)
        step, self._stepped_wall = self._stepped_wall, None
        if step is not None:
            self._publish(step)
        for topic, payload in self._messages:
            self.out.put(Publish(self._keys[topic], payload, topic.delivery))
        self._messages.clear()
        if step is not None:
            self.part.train(step.wall_ns)
        return self.out.take()

    # ------------------------------------------------------------------ life

    def _start(self, event: Started, now: Instant) -> None:
        config = self.config
        role = f"{config.role.value} {config.id}" + (", dry run: sends nothing" if config.dry_run else "")
        self.journal.info("started", f"{role}, game '{config.game}', link {self.radio.active}")
        if self.game is not None:
            self.game.begin(now)
        self.bus.open()
        self.out.put(Serve(COMMAND.key(config.game, config.id)))
        self.out.put(Announce(ALIVE.key(config.game, config.id)))
        self._expect(now.s)
        for grid in (self._chores, self._heartbeat, self._health):
            grid.start(now.s)

    def _tick(self, event: Tick, now: Instant) -> None:
        """Do what is due."""
        if self.ending.begun:
            if not self.ending.complete:
                self.ending.due(now.s)
                self._close()
            return
        asked = self.flight.open
        if asked is not None and now.s >= self._answer_by - EARLY_S:
            self.flight.given_up(now.s)
            self._stepped_on(now, asked.begun)
        if now.s >= self.flight.ahead.at - EARLY_S:
            think = self.flight.look_ahead(now)
            if think is not None:
                self.out.put(think)
        if now.s >= self._step_at - EARLY_S:
            self._by_timer = True
            self._expect(now.s)
            self.timer_steps += 1
            self._step(now)
        if self._heartbeat.due(now.s):
            self.vehicle.heartbeat()
        if self._health.due(now.s):
            t = self.vehicle.look(now.s)
            self.signing.tell(now.s, t.heartbeat_at, self.journal)
            self.radio.flush(now)
            self.out.put(Count())
            return  # the report tells of this moment; what else is due comes with the next tick, at once
        if self._chores.due(now.s):
            if self.vehicle.since_step(now.s) >= ADAPTER_EVERY_S:
                self.flight.drive(now.s)
            self.vehicle.chores(now.s)

    def _stop(self, event: Stop, now: Instant) -> None:
        """Leave the vehicle in a mode that the autopilot can hold alone, as far as it is ours to leave."""
        if self.ending.begun:
            return
        for grid in (self._chores, self._heartbeat, self._health):
            grid.stop()
        self.ending.begin(now.s)
        self._close()

    def _close(self) -> None:
        if self.ending.complete:
            self.stage = AgentStage.ENDED
            self.out.put(Count())  # the last health report, and then `End`

    # ------------------------------------------------------------------ what arrives

    def _take_bytes(self, event: LinkBytes, now: Instant) -> None:
        received = self.radio.take(event.link, event.peer, event.data, now)
        if received.took_over:
            self.vehicle.other_link()
        if received.second:
            self.vehicle.second_autopilot(now.s, "setpoints stay with the first")
        for packet in received.packets:
            self._hear(packet, now)

    def _hear(self, packet: Packet, now: Instant) -> None:
        new = self.vehicle.hear(packet, now.s)
        # After a step by the timer the next position counts sooner, or steps would stay with the timer.
        wait = (0.4 if self._by_timer else 0.8) * self._period
        if new and not self.ending.begun and now.s - self._stepped >= wait:
            self._by_timer = False
            self._expect(now.s)
            self._step(now)

    def _expect(self, now: float) -> None:
        """Step by the timer if no position has caused a step by then."""
        self._step_at = now + LATE * self._period

    def _take_message(self, event: BusMessage, now: Instant) -> None:
        before = self.bus.setup_number
        track = self.bus.take(event.key, event.payload, now)
        if self.game is None:
            return
        if track is not None:
            self.game.measured(track, now)
        elif self.bus.setup_number != before and self.bus.setup is not None:
            self.game.heard_setup(self.bus.setup)

    def _bus_changed(self, event: BusState, now: Instant) -> None:
        if event.connected == self.bus.connected:
            return
        self.bus.connected = event.connected
        if event.connected:
            self.journal.info("bus", "the bus is there")
        else:
            self.journal.warning("bus", "no bus: flying on what is known")

    def _loaded(self, event: Loaded, now: Instant) -> None:
        if self.game is not None:
            self.game.loaded(event.strategy, event.error)

    # ------------------------------------------------------------------ the control step

    def _step(self, now: Instant) -> None:
        """One control step: decide, supervise, send; `idle` then publishes."""
        if self.flight.open is not None:  # the strategy still thinks
            return
        self._stepped = now.s
        think = self.flight.step(now)
        if think is None:
            self._stepped_on(now, now)
        else:
            self.out.put(think)

    def _answered(self, event: Answered, now: Instant) -> None:
        step = self.flight.open
        if self.flight.answered(event) and step is not None:
            self._stepped_on(now, step.begun)

    def _stepped_on(self, now: Instant, begun: Instant) -> None:
        """A control step that began at `begun` is complete."""
        self.steps += 1
        self.radio.flush(now)
        self.out.put(Beat())
        self.desk.review()
        self._stepped_wall = begun

    # ------------------------------------------------------------------ what it says

    @property
    def _fit(self) -> bool:
        """Whether the vehicle follows the game, as far as was looked at last."""
        return self.stage in (AgentStage.READY, AgentStage.ACTING)

    def _publish(self, step: Instant) -> None:
        now, wall_ns, t = step.s, step.wall_ns, self.vehicle.telemetry
        if t.placed and now - self._state_at >= STATE_EVERY_S and now - t.position_at < 1.0:
            self._state_at = now
            self.out.put(
                Publish(
                    self._keys[STATE], STATE.encode(self.reports.state(wall_ns, self._fit)), STATE.delivery
                )
            )
        if now - self._decision_at >= DECISION_EVERY_S:
            report = self.reports.decision(wall_ns)
            if report is not None:
                self._decision_at = now
                payload = DECISION.encode(report)
                self.out.put(Publish(self._keys[DECISION], payload, DECISION.delivery))

    def _report(self, event: Counted, now: Instant) -> None:
        """Health, and what is looked at twice a second; with the last report, the end."""
        if not self.ending.complete:
            self._judge(now)
        number = self.desk.speak(now.s)
        stopped_by, lock = self.orders.stopped_by, self.radio.lock
        standing = Standing(self.stage, self.lacks, self.counters(event), number, stopped_by, lock)
        health = self.reports.health(standing, now)
        self._messages.append((HEALTH, HEALTH.encode(health)))
        if self.ending.complete:
            self.out.put(End())

    def _judge(self, now: Instant) -> None:
        state = self.part.state(now.wall_ns)
        lacks = self.part.lacks(now)
        if self.flight.take_off.climbing:
            lacks = (*lacks, f"its height of {self.flight.take_off.height:g} m")
        if self.flight.latched:
            lacks = (*lacks, f"a person's resume after: {self.flight.latched}")
        if self.flight.unasked:
            lacks = (*lacks, f"a person's resume: found in {self.vehicle.telemetry.mode}, not chosen by it")
        if self.orders.blocked:
            lacks = (*lacks, f"a person's resume after: {self.orders.blocked}")
        self.lacks = (*lacks, "the master's resume") if state.late else lacks
        stage = self._stage(over=state.over)
        if stage != self.stage:
            self.stage = stage
            text = f": lacks {', '.join(self.lacks)}" if self.lacks and stage is AgentStage.WAITING else ""
            self.journal.info("stage", f"{stage.value}{text}")
        if self.game is not None:
            self.game.fit = self._fit

    def _stage(self, *, over: bool) -> AgentStage:
        output = self.flight.output if self.flight.playing else None
        if self.vehicle.stage is Stage.TAKEN:
            return AgentStage.HANDED_OVER
        if over:
            return AgentStage.ENDED
        if self.orders.order is not Action.PASS or (output is not None and not output.stream):
            return AgentStage.HELD
        flies = self.vehicle.stage is Stage.ACTIVE and not self.flight.unasked
        if output is not None and (flies or self.config.dry_run):
            return AgentStage.ACTING
        return AgentStage.WAITING if self.lacks else AgentStage.READY

    def counters(self, counted: Counted) -> dict[str, int]:
        """Everything that is counted, by cause; what is zero is left out."""
        found = {
            **self.radio.causes,
            **{f"link_{cause}": n for cause, n in counted.links.items() if cause not in ("sent", "received")},
            **self.vehicle.counters(),
            **self.bus.drops,
            **{f"bus_{cause}": n for cause, n in counted.bus.items()},
            **self._chores.counters("chores"),
            "control_steps": self.steps,
            "control_steps_by_timer": self.timer_steps,
            **counted.shell,
            **self.flight.clips.counts,
            "strategy_failures": self.flight.failures,
            "events_suppressed": self.journal.suppressed,
        }
        return {cause: number for cause, number in found.items() if number}
