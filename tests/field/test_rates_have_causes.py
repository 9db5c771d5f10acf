"""Why telemetry comes too slowly: a narrow link, another station, a radio, loss, a busy computer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import Instant, LinkBytes, LinkFacts, Note, Send, Started, Tick
from onboard.agent.core.machine import AgentCore, Facts
from onboard.autopilot.stream_rates import NEEDS, Shortfall, StreamRates, capacity_of
from onboard.autopilot.unread_streams import UnreadStreams
from onboard.game.scenario import Kind
from onboard.wire.mavlink import modes
from onboard.wire.mavlink.commands import CommandLong, Target
from onboard.wire.mavlink.dialect import DialectSender, dialect, dialect_packet
from onboard.wire.mavlink.tlog import Entry, read_tlog
from tests.support.flown_autopilot import EPOCH_NS, FlownAutopilot
from tests.support.paths import RECORDINGS
from tests.support.recorded import recorded

SYSTEM, STEP_S = 2, 0.02
COPTER = modes.Kind.ARDUCOPTER


class Line:
    """One way of a serial line: what does not fit is not sent, as autopilots do, and no number is missing."""

    def __init__(self, baud: int) -> None:
        self._room, self._rate = 0.0, baud / 10.0
        self._sender = DialectSender(SYSTEM, 1)

    def carry(self, frames: list[bytes], seconds: float) -> Iterator[bytes]:
        self._room = min(self._room + self._rate * seconds, 256.0)
        for frame in frames:
            if len(frame) <= self._room:
                self._room -= len(frame)
                yield self._sender.pack(dialect_packet(frame).message)


class Flight:
    """An agent beside a simulated autopilot: over UDP, a serial line of `baud`, or one `bridged` to UDP."""

    def __init__(self, kind: Kind, baud: int = 0, *, bridged: bool = False, **options: Any) -> None:
        self.flown = FlownAutopilot(kind, system=SYSTEM, tick_s=STEP_S, **options)
        self.flown.frames.clear()
        serial = baud > 0 and not bridged
        link = f"serial:///dev/ttyAMA0:{baud}" if serial else "udpin://127.0.0.1:14541"
        self.core = AgentCore(AgentConfig(id=SYSTEM, link=(link,)), Facts(1, (LinkFacts(link, serial),)))
        self.line = Line(baud) if baud else None
        self.told: list[str] = []
        self.positions: list[float] = []  # when they came
        self.now = 0.0
        self._do(Started())

    def fly(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end:
            self.now += STEP_S
            self.flown.forward(STEP_S)
            frames = list(self.flown.frames)
            self.flown.frames.clear()
            for frame in frames if self.line is None else self.line.carry(frames, STEP_S):
                before = self.core.vehicle.telemetry.position_at
                self._do(LinkBytes(0, 1, frame))
                at = self.core.vehicle.look(self.now).position_at
                self.positions += [at] if at > before else []
            self._do(Tick())

    def rate(self, seconds: float) -> float:
        """Positions a second of late [Hz]."""
        return sum(at > self.now - seconds for at in self.positions) / seconds

    def hear(self, frame: bytes) -> None:
        self._do(LinkBytes(0, 1, frame))

    def _do(self, event: Any) -> None:
        now = Instant(self.now, EPOCH_NS + int(self.now * 1e9))
        for effect in [*self.core.handle(event, now), *self.core.idle(now)]:
            if isinstance(effect, Send):
                self.flown.autopilot.receive(self.flown.now_ns, effect.frame, "agent")
            elif isinstance(effect, Note):
                self.told.append(effect.line)


def test_px4s_default_streams_are_switched_off_on_a_narrow_line(monkeypatch: pytest.MonkeyPatch) -> None:
    mended = Flight(Kind.PX4, 57600, full_streams=True)
    mended.fly(30.0)
    with monkeypatch.context() as patched:
        patched.setattr(UnreadStreams, "step", lambda *_: [])
        before = Flight(Kind.PX4, 57600, full_streams=True)
        before.fly(30.0)
    assert before.rate(10.0) < 5.0
    assert mended.rate(10.0) > 15.0
    assert any("streams: the link is narrow" in line and "HIGHRES_IMU" in line for line in mended.told)
    assert mended.core.vehicle.look(mended.now).heartbeat_at > mended.now - 1.5


def test_a_narrow_line_behind_udp_is_known_by_what_stays_out() -> None:
    flight = Flight(Kind.PX4, 57600, bridged=True, full_streams=True)
    flight.fly(40.0)
    assert flight.rate(10.0) > 15.0


def test_on_a_wide_line_nothing_is_switched_off() -> None:
    flight = Flight(Kind.PX4, 921600, full_streams=True)
    flight.fly(10.0)
    assert flight.flown.got("ODOMETRY", flight.flown.now_ns - 10**9)


def test_of_the_recorded_line_what_is_read_stays() -> None:
    """PX4 1.16 at 57600 baud: what is asked off is read by nobody, and most of the load."""
    counts = Counter(packet.name for _, packet in narrow_line())
    unread = UnreadStreams(Target(1), [n.message for n in NEEDS[modes.Kind.PX4_MULTICOPTER]], 5760.0)
    asked: dict[str, float] = {}
    for second in range(4):
        for command in unread.step(float(second), counts, 20.0):
            asked[dialect.mavlink_map[int(command.params[0])].msgname] = command.params[1]
    off = {name for name, interval in asked.items() if interval == -1}
    assert {"HIGHRES_IMU", "ODOMETRY", "ATTITUDE_QUATERNION", "LOCAL_POSITION_NED"} & counts.keys() <= off
    assert not off & {"GLOBAL_POSITION_INT", "ATTITUDE", "HEARTBEAT", "BATTERY_STATUS", "COMMAND_ACK"}


def narrow_line() -> list[Entry]:
    """The autopilot's frames of the recording."""
    log = (RECORDINGS / "excerpts" / "px4-57600-onboard-rates.tlog").read_bytes()
    return [entry for entry in read_tlog(log) if entry.packet.component == 1]


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.ARDUPLANE])
def test_what_another_station_takes_is_asked_for_again(kind: Kind) -> None:
    flight = Flight(kind, other_station_hz=4.0)
    flight.fly(35.0)
    assert flight.rate(20.0) > 15.0
    assert flight.core.vehicle.shortfall in (Shortfall.STATION, Shortfall.NONE)
    assert any("rates:" in line and "--streamrate" in line for line in flight.told)
    assert not any(Shortfall.LINK.value in line for line in flight.told)


def test_the_recorded_station_makes_nobody_ask_for_less() -> None:
    """Flown behind MAVProxy on ArduCopter 4.5.6: 0.1.0 asked for 20, 13, 9, 6 and at last 5 Hz."""
    said = [one for one in recorded("copter-behind-mavproxy-rates").said if one.component == 1]
    asking = StreamRates(COPTER, Target(2))
    asked = []
    for second in range(int(said[-1].t)):
        came = Counter(one.message.get_type() for one in said if second <= one.t < second + 1)
        asking.step(float(second), {name: float(n) for name, n in came.items()})
        asked.append(asking.rates["GLOBAL_POSITION_INT"])
    assert min(asked) >= 15.0
    assert asked[-1] == 20.0


class Station:
    """Another station that asks for 4 Hz of everything, every `every` seconds, on a link that carries all."""

    def __init__(self, every: float, *, answers: bool) -> None:
        self.every, self.answers = every, answers
        self.rates: dict[int, float] = {}
        self.granted: list[tuple[int, float]] = []

    def hear(self, commands: list[CommandLong]) -> None:
        for command in commands:
            number = int(command.params[0])
            if command.command == dialect.MAV_CMD_SET_MESSAGE_INTERVAL:
                self.rates[number] = 1e6 / command.params[1] if command.params[1] > 0 else 0.0
            elif self.answers:
                self.granted.append((number, 1.0 / self.rates[number]))

    def takes(self) -> None:
        self.rates = {number: min(rate, 4.0) for number, rate in self.rates.items()}


@pytest.mark.parametrize("answers", [True, False], ids=["says its intervals", "says nothing"])
@pytest.mark.parametrize("every", [4.0, 5.0, 7.0, 1e9])
def test_nobody_elses_requests_make_the_agent_ask_for_less(every: float, answers: bool) -> None:
    station, asking = Station(every, answers=answers), StreamRates(COPTER, Target(1))
    full = {need.message: need.rate for need in NEEDS[COPTER]}
    names = {dialect.mavlink_map[number].msgname: number for number in dialect.mavlink_map}
    came, next_at = 0.0, 10.0
    for now in range(120):
        if now >= next_at:
            station.takes()
            next_at += every
        station.hear(asking.step(float(now), {n: station.rates.get(names[n], 0.0) for n in full}))
        for number, interval in station.granted:
            asking.granted(float(now), number, interval)
        station.granted.clear()
        came += station.rates[names["GLOBAL_POSITION_INT"]] / 120.0
    assert asking.rates == pytest.approx(full, rel=0.2)
    assert came > 12.0


def test_a_rate_that_the_autopilot_never_grants_is_asked_for_ever_more_rarely() -> None:
    asking, asked = StreamRates(COPTER, Target(1)), 0
    capped = {need.message: min(need.rate, 10.0) for need in NEEDS[COPTER]}
    for now in range(300):
        for command in asking.step(float(now), capped):
            number = int(command.params[0])
            if command.command == dialect.MAV_CMD_SET_MESSAGE_INTERVAL:
                asked += number == dialect.MAVLINK_MSG_ID_ATTITUDE
            else:
                asking.granted(float(now), number, 0.1)
    assert asking.rates["ATTITUDE"] == 20.0
    assert asked < 30


def test_a_busy_computer_is_no_slow_link() -> None:
    asking = StreamRates(COPTER, Target(1), capacity_of(57600))
    asking.step(0.0, {})
    budget = asking.budget
    half = {need.message: 0.5 * need.rate for need in NEEDS[COPTER]}
    for now in range(1, 60):
        asking.step(2.0 * now, half, late=True)
    assert (asking.budget, asking.cause) == (budget, Shortfall.LATE)


def test_where_less_asked_brings_less_the_agent_goes_back() -> None:
    """A line that others fill: everybody gets the same share of what he asks for."""
    asking = StreamRates(COPTER, Target(1))
    budgets = []
    for now in range(120):
        asking.step(float(now), {name: 0.4 * rate for name, rate in asking.rates.items()})
        budgets.append(asking.budget)
    assert min(budgets) >= 0.75 * budgets[0]


def test_the_radios_own_word_counts_whatever_system_it_speaks_as() -> None:
    flight = Flight(Kind.ARDUCOPTER)
    flight.fly(5.0)
    radio = DialectSender(51, 68)  # a SiK radio's
    for _ in range(12):
        flight._do(
            LinkBytes(0, 1, radio.pack(dialect.MAVLink_radio_status_message(200, 190, 5, 30, 30, 0, 0)))
        )
        flight.fly(1.0)
    assert flight.core.vehicle.shortfall is Shortfall.RADIO
    assert any("radio's buffer" in line for line in flight.told)


def test_loss_on_the_way_is_named_and_costs_no_rate() -> None:
    asking = StreamRates(COPTER, Target(1))
    asking.step(0.0, {})
    for now in range(1, 20):
        asking.step(float(now), dict(asking.rates), quality=0.7)
    assert asking.cause is Shortfall.LOSS
    assert asking.rates["ATTITUDE"] == 20.0
