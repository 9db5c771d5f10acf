"""The own vehicle: its autopilot discovered, asked for what is needed, and flown through its adapter."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from enum import Enum
from math import radians

from onboard.agent.config import AgentConfig
from onboard.agent.core.child_courier import ChildCourier
from onboard.agent.core.events import Outbox
from onboard.agent.core.journal import Journal
from onboard.agent.core.mavlink_radio import Radio
from onboard.agent.core.rate import Rate
from onboard.agent.core.telemetry_requests import Requests
from onboard.autopilot.base import Adapter, Refusal, Setpoint, Stage, Telemetry
from onboard.autopilot.choose import AdapterOptions, adapter_for
from onboard.autopilot.flight_limits import FlightLimits, read_limits, unread
from onboard.autopilot.mode_requests import AnswerTimes
from onboard.autopilot.stream_rates import REMEDIES, Shortfall
from onboard.autopilot.telemetry_state import Observer
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO
from onboard.core.safety.policy import Command
from onboard.core.safety.supervisor import SupervisorOutput
from onboard.wire.bus.messages import Severity
from onboard.wire.mavlink.commands import CommandLong, OwnHeartbeat, Target
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.ids import AUTOPILOT, COMPANION
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import (
    CommandAck,
    GlobalPosition,
    Heartbeat,
    MessageInterval,
    ParamValue,
    RadioStatus,
    StatusText,
    Timesync,
    Version,
)

DOUBTS = {  # why positions do not count, in words
    "position_jump": "the autopilot's position jumped away from its velocity: not flown on",
    "position_frozen": "the autopilot's position stands still against its velocity: not flown on",
}
DOUBT_S = 0.5  # a doubt that lasts for longer is told [s]
SECOND_S = 10.0  # without a second autopilot, until one is news again [s]
SHORT_S = 60.0  # between two words on one cause of slow telemetry [s]
COMPONENTS_MAX = 8
_ANSWERED = {Heartbeat, CommandAck, ParamValue, Timesync, MessageInterval, Version, StatusText}
_SEVERITIES = {"info": Severity.INFO, "warning": Severity.WARNING, "error": Severity.ERROR}


class Control(Enum):
    """Whether control of the vehicle changed hands in a step."""

    SAME = "same"
    TAKEN = "taken"  # somebody else changed the autopilot's mode
    HANDED_BACK = "handed back"  # a pilot chose the guided mode: the agent flies again
    RESTARTED = "restarted"  # what looked like a take-over was the autopilot starting again


def _change(before: Stage, after: Stage, *, handed: bool) -> Control:
    if after is Stage.TAKEN and before is not Stage.TAKEN:
        return Control.TAKEN
    if after is Stage.ACTIVE and (before in (Stage.TAKEN, Stage.LEFT) or (handed and before is Stage.IDLE)):
        return Control.HANDED_BACK
    if after is Stage.IDLE and before is Stage.TAKEN:
        return Control.RESTARTED
    return Control.SAME


def _let_through(verdict: SupervisorOutput, facing: float | None) -> Setpoint | None:
    """The setpoint of a verdict; None where it lets none pass."""
    if verdict.command is Command.STREAM:
        return new(Setpoint, (verdict.air, verdict.wind, facing))
    return Setpoint(ZERO) if verdict.command is Command.HOVER else None


class VehicleLink:
    """One vehicle and its autopilot. Time is an argument throughout."""

    def __init__(self, config: AgentConfig, radio: Radio, journal: Journal, out: Outbox) -> None:
        self.config = config
        self.radio = radio
        self.observer = Observer(config.id)
        self.telemetry = Telemetry()
        self.adapter: Adapter | None = None
        self.refusal = ""
        self.foreign: Counter[str] = Counter()
        self.heard_systems: dict[int, float] = {}
        self.position_rate, self.setpoint_rate = Rate(), Rate()
        self.sent_at = NEVER  # of the last setpoint [s]
        self.now = NEVER  # when it was looked at last [s]
        self.facing: float | None = None  # [rad] where a multicopter is to look; None: as it likes
        self.flown = False  # the vehicle was under this process's control once
        self.version: Version | None = None  # of the autopilot, once it has said so
        self.to = Target(config.id)
        self._journal = journal
        self._child = ChildCourier(out)
        self._heartbeat: Heartbeat | None = None
        self._answers = AnswerTimes()
        self._asking: Requests | None = None
        self._limits_of: tuple[Kind, int] | None = None  # of which parameters the limits were read
        self._limits = FlightLimits()
        self._unread: tuple[FlightLimits | None, tuple[str, ...]] = (None, ())  # of which limits, and what
        self._reboots = 0
        self.components: list[int] = []  # others that beat under the vehicle's own system id
        self._second_at = NEVER  # when a second autopilot was last heard [s]
        self._doubt = ""  # told last
        self._undoubted_at = NEVER  # when positions counted last [s]
        self._stepped_at = NEVER
        self._asked_off: set[str] = set()  # streams that were told of
        self._short_at: dict[Shortfall, float] = {}  # causes of slow telemetry, and when they were told [s]

    @property
    def hovers(self) -> bool | None:
        """Whether it can stop in the air; None while no autopilot is known."""
        return None if self.adapter is None else not self.adapter.holds_airspeed

    @property
    def stage(self) -> Stage:
        """Who flies."""
        return Stage.IDLE if self.adapter is None else self.adapter.stage

    @property
    def by_failsafe(self) -> bool:
        """Whether the autopilot's own failsafe took it, and no person."""
        return self.adapter is not None and self.stage is Stage.TAKEN and self.adapter.failsafe

    @property
    def parameters(self) -> dict[str, float]:
        """The autopilot's parameters, as far as read."""
        return {} if self._asking is None else self._asking.parameters

    @property
    def limits(self) -> FlightLimits:
        """What the autopilot itself lets the vehicle do, as far as it has said."""
        if self.adapter is None:
            return FlightLimits()
        read = (self.adapter.kind, -1 if self._asking is None else self._asking.revision)
        if read != self._limits_of:
            self._limits_of, self._limits = read, read_limits(self.adapter.kind, self.parameters)
        return self._limits

    @property
    def unread(self) -> tuple[str, ...]:
        """Parameters that must be read, or limits configured, before a setpoint may leave."""
        if self.adapter is None or self.config.dry_run:  # a dry run asks for none, and sends none
            return ()
        limits = self.limits
        if limits is not self._unread[0]:
            e = self.config.envelope
            said = {"speed_min": e.speed_min, "speed_max": e.speed_max, "climb_max": e.climb_max,
                    "sink_max": e.sink_max}  # fmt: skip
            self._unread = limits, unread(self.adapter.kind, limits, said)
        return self._unread[1]

    @property
    def second_heard(self) -> bool:
        """Whether another autopilot was ever heard under this system id."""
        return self._second_at != NEVER

    def read_also(self, names: Mapping[Kind, tuple[str, ...]]) -> None:
        """Read more parameters than flying needs, by kind of autopilot; for the preflight check."""
        if self._asking is not None and self._heartbeat is not None:
            self._asking.read_also(names.get(self._heartbeat.kind, ()))

    def hear(self, packet: Packet, now: float) -> bool:
        """Take one packet; True for a new position of the own vehicle."""
        if isinstance(packet.value, RadioStatus):  # a telemetry radio at our end: of any system
            if self._asking is not None:
                self._asking.radio(packet.value.buffer_free)
            return False
        if packet.system != self.config.id:
            self.foreign["foreign_system"] += 1
            if packet.component == AUTOPILOT and len(self.heard_systems) < 16:
                self.heard_systems[packet.system] = now
            return False
        if packet.component != AUTOPILOT:
            self.foreign["foreign_component"] += 1
            self._hear_component(packet)
            return False
        value = self.observer.take(now, packet)
        if self._asking is not None:
            self._asking.arrived(packet.name)
        if value is None:
            return False
        if isinstance(value, GlobalPosition):
            self.position_rate.tick()
            return True
        if type(value) not in _ANSWERED:
            return False
        if isinstance(value, Heartbeat):
            self._discover(value)
        elif isinstance(value, CommandAck) and self.adapter is not None:
            if value.target_component in (0, COMPANION):
                self.adapter.answers_in(self._answers.answered(now, value.command))
            self.adapter.acknowledge(now, value)
        elif isinstance(value, ParamValue) and self._asking is not None:
            self._asking.parameter(value)
        elif isinstance(value, Timesync) and self._asking is not None:
            answer = self._asking.clock.take(round(now * NS_PER_S), value)
            if answer is not None:
                self.radio.send(answer)
        elif isinstance(value, MessageInterval) and self._asking is not None:
            self._asking.interval(now, value)
        elif isinstance(value, Version):
            if self.version is not None and 0 != value.uid != self.version.uid != 0:
                self.second_autopilot(now, f"their uids are {self.version.uid:x} and {value.uid:x}")
            else:
                self.version = value
        elif isinstance(value, StatusText) and value.severity <= 4:
            self._journal.warning("autopilot", value.text)
        return False

    def second_autopilot(self, now: float, what: str) -> None:
        """Two autopilots speak under this vehicle's system id: tell it, again where it comes back."""
        if now - self._second_at > SECOND_S:
            text = f"two autopilots with system id {self.config.id}: {what}; give each an id of its own"
            self._journal.error("second_autopilot", text)
        self._second_at = now

    def _hear_component(self, packet: Packet) -> None:
        """Name, once, a component that beats under the vehicle's own system id."""
        known = packet.component in (COMPANION, *self.components)
        if packet.name == "HEARTBEAT" and not known and len(self.components) < COMPONENTS_MAX:
            self.components.append(packet.component)
            self._journal.warning(
                "component",
                f"component {packet.component} beats as system {self.config.id}: while it does, an "
                "ArduPilot's GCS failsafe that watches this id does not notice when this agent dies",
            )

    def look(self, now: float) -> Telemetry:
        """What is known of the vehicle at `now`; also notices an autopilot that started again."""
        self.telemetry, self.now = self.observer.snapshot(), now
        if self.telemetry.reboots != self._reboots:
            self._reboots = self.telemetry.reboots
            self._journal.error("reboot", "the autopilot has started again")
            if self._asking is not None:
                self._asking.again()
        if self.observer.two_clocks(now):
            self.second_autopilot(now, "on one link, where setpoints reach both")
        self._tell_doubt(now)
        return self.telemetry

    def _tell_doubt(self, now: float) -> None:
        """Say that positions do not count, once that has lasted, and that they count again."""
        doubt = self.observer.doubt
        if not doubt:
            self._undoubted_at = now
            if self._doubt:
                self._journal.info("position", "the autopilot's position fits its velocity again")
            self._doubt = ""
        elif doubt != self._doubt and now - self._undoubted_at > DOUBT_S:
            self._doubt = doubt
            self._journal.warning(doubt, DOUBTS[doubt])

    def step(self, now: float, verdict: SupervisorOutput | None = None) -> Control:
        """Send what the adapter wants sent, and note what it says; gives whether control changed hands.

        A setpoint leaves here and nowhere else, and only as the supervisor's verdict on this very step:
        one on another step is counted, and nothing of it is sent."""
        adapter = self.adapter
        if adapter is None:
            return Control.SAME
        before = adapter.stage
        if verdict is not None and verdict.at != now:
            self.foreign["verdict_of_another_step"] += 1
            verdict = None
        setpoint = None if verdict is None else _let_through(verdict, self.facing)
        step = adapter.step(now, self.telemetry, setpoint)
        self._stepped_at = self.now = now
        after = adapter.stage
        self.flown = self.flown or after is Stage.ACTIVE
        for message in step.messages:
            self.radio.send(message)
        if setpoint is not None and after is Stage.ACTIVE:
            self.setpoint_rate.tick()
            self.sent_at = now
        for note in step.notes:
            self._journal.say(_SEVERITIES.get(note.severity, Severity.INFO), note.kind, note.text)
        return Control.SAME if after is before else _change(before, after, handed=adapter.handed)

    def chores(self, now: float) -> None:
        """Everything that is due beside setpoints: requests, and the adapter's own retries."""
        if self._asking is not None:
            for message in self._asking.due(now, self.telemetry.link_quality):
                self.radio.send(message)
                if isinstance(message, CommandLong):
                    self._answers.sent(now, message.command)
            self._tell_shortfall(now, self._asking.shortfall)
            self._tell_asked_off(self._asking.asked_off)
        self.position_rate.review(now)
        self.setpoint_rate.review(now)

    @property
    def shortfall(self) -> Shortfall:
        """Why less telemetry comes than was asked for."""
        return Shortfall.NONE if self._asking is None else self._asking.shortfall

    def _tell_shortfall(self, now: float, cause: Shortfall) -> None:
        """Say why telemetry comes too slowly: each cause once, and again a minute after it was told."""
        if cause is Shortfall.NONE or now - self._short_at.get(cause, NEVER) < SHORT_S:
            return
        self._short_at[cause] = now
        rate = f"position at {self.position_rate.value:.1f} Hz of {self.config.control_rate_hz:g}"
        self._journal.warning("rates", f"{rate}: {cause.value}; {REMEDIES[cause]}")

    def _tell_asked_off(self, names: tuple[str, ...]) -> None:
        """Say which streams were switched off, once for each."""
        off = [name for name in names if name not in self._asked_off]
        if off:
            self._asked_off.update(off)
            text = f"the link is narrow: off or slower, as nobody here reads them: {', '.join(off)}"
            self._journal.info("streams", text)

    def other_link(self) -> None:
        """Another link is used from now on: what was asked for on the last one is asked for again."""
        self._journal.warning("link", f"{self.radio.active} takes over")
        if self._asking is not None:
            self._asking.again()

    def since_step(self, now: float) -> float:
        """Time since the adapter was last stepped [s]."""
        return now - self._stepped_at

    def counters(self) -> dict[str, int]:
        """Foreign packets by cause, and how well the autopilot's clock is known."""
        counts = {**self.foreign, **self.observer.odd}
        if self._asking is not None:
            counts["timesync_round_trip_us"] = self._asking.clock.offset().round_trip_ns // 1000
        return counts

    def child_said(self, line: bytes) -> None:
        """A child process of the adapter's wrote a line."""
        self._child.heard(line)

    def child_exited(self) -> None:
        """A child process of the adapter's has ended."""
        self._child.exited()

    def heartbeat(self) -> None:
        """Our own heartbeat, at 1 Hz."""
        self.radio.send(OwnHeartbeat())

    def _discover(self, heartbeat: Heartbeat) -> None:
        known = self._heartbeat
        self._heartbeat = heartbeat
        if self.adapter is not None and known is not None and known.kind is heartbeat.kind:
            return
        if self.adapter is not None and self.adapter.stage is Stage.ACTIVE:
            return  # it does not turn into another aircraft in flight
        if self._asking is None:
            self._asking = Requests(
                self.to, heartbeat.kind, self.config.control_rate_hz, self.radio.active, self.radio.signed
            )
        found = adapter_for(
            heartbeat,
            self.to,
            AdapterOptions(
                self.config.autopilot.value,
                self.config.may_arm,
                self.config.hold_mode,
                self.config.mavsdk,
                radians(self.config.envelope.bank_max_deg),
                self._child.launch,
            ),
            self.parameters,
        )
        if isinstance(found, Refusal):
            if found.reason != self.refusal:
                self.refusal = found.reason
                self._journal.error("autopilot_refused", found.reason)
        else:
            self.refusal = ""
            if self.adapter is None and (known is None or known.kind is not heartbeat.kind):
                self._journal.info("autopilot", f"{heartbeat.kind.value} found, in {heartbeat.mode}")
            self.adapter = found
