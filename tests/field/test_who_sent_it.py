"""Who sent it counts: batteries by id, one autopilot to a system id, components that beat under it."""

from __future__ import annotations

from hashlib import sha256
from itertools import pairwise

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import Instant, LinkBytes, LinkFacts, Note, Send, Started, Tick
from onboard.agent.core.machine import AgentCore, Facts
from onboard.autopilot.telemetry_state import Observer
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect, dialect_packet
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.signing import MemoryStore, Signing

T0 = 1_700_000_000_000_000_000
FIRST, SECOND = 1, 2  # peers


def battery(id: int, function: int, percent: int, millivolts: int) -> MavMessage:
    cells = [millivolts] + [65535] * 9
    message: MavMessage = dialect.MAVLink_battery_status_message(
        id, function, 1, 32767, cells, -1, -1, -1, percent
    )
    return message


def seen(*messages: MavMessage) -> tuple[float, float]:
    """Share and voltage once each message has come five times."""
    observer, sender, framer = Observer(2), DialectSender(2, 1), Framer()
    for k in range(5 * len(messages)):
        for packet in framer.feed(sender.pack(messages[k % len(messages)])):
            observer.take(0.1 * k, packet)
    t = observer.snapshot()
    return t.battery, t.voltage


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize(
    ("messages", "share"),
    [
        ((battery(0, 1, 80, 15_800), battery(1, 4, 10, 7_000)), 0.8),  # a payload's
        ((battery(0, 1, 10, 13_000), battery(1, 4, 80, 7_000)), 0.1),
        ((battery(0, 2, 80, 15_800), battery(3, 3, 5, 5_000)), 0.8),  # the avionics'
        ((battery(0, 1, 15, 14_000), battery(1, 1, 90, 16_600)), 0.15),  # two that fly: the emptiest
        ((battery(0, 0, 60, 14_000), battery(1, 0, -1, 16_600)), 0.6),  # one does not know
        ((battery(2, 4, 10, 7_000),), -1.0),
    ],
)
def test_the_flight_battery_speaks(messages: tuple[MavMessage, ...], share: float, turn: int) -> None:
    assert seen(*messages[::turn])[0] == pytest.approx(share)


def signing_with(key: bytes) -> Signing:
    return Signing(sha256(key).digest(), MemoryStore())


class Agent:
    """One agent without input and output; what it sends goes to peers."""

    def __init__(self, key: bytes = b"") -> None:
        signing = signing_with(key) if key else None
        self.core = AgentCore(AgentConfig(id=2), Facts(1, (LinkFacts("wire", False),)), signing)
        self.sent: list[Send] = []
        self.told: list[str] = []
        self.now = 0.0
        self._do(Started())

    def _do(self, event: object) -> None:
        now = Instant(self.now, T0 + int(self.now * 1e9))
        for effect in [*self.core.handle(event, now), *self.core.idle(now)]:  # type: ignore[arg-type]
            if isinstance(effect, Send):
                self.sent.append(effect)
            elif isinstance(effect, Note):
                self.told.append(effect.line)

    def hear(self, peer: int, sender: DialectSender, message: MavMessage) -> None:
        self._do(LinkBytes(0, peer, sender.pack(message, T0 + int(self.now * 1e9))))

    def text(self, kind: str) -> str:
        """The lines that were told of a kind."""
        return " ".join(line for line in self.told if f" {kind}: " in line)

    def pass_time(self, seconds: float) -> None:
        self.now += seconds
        self._do(Tick())


def stream(k: int, boot_ms: int, lat: int, uid: int = 0) -> list[MavMessage]:
    """What an autopilot sends in the k-th 50 ms."""
    messages: list[MavMessage] = [
        dialect.MAVLink_attitude_message(boot_ms + 50 * k, 0, 0, 0, 0, 0, 0),
        dialect.MAVLink_global_position_int_message(
            boot_ms + 50 * k, lat, 85_456_000, 538_000, 50_000, 0, 0, 0, 0
        ),
    ]
    if k % 20 == 0:
        messages.append(dialect.MAVLink_heartbeat_message(2, 3, 81, 4, 4, 3))
    if k % 20 == 0 and uid:
        messages.append(
            dialect.MAVLink_autopilot_version_message(
                0, 0x04050600, 0, 0, 0, bytes(8), bytes(8), bytes(8), 0, 0, uid
            )
        )
    return messages


@pytest.mark.parametrize("second_boot_ms", [5_000, 1_000_000, 5_000_000], ids=["younger", "same", "older"])
@pytest.mark.parametrize("phase", [0.001, 0.012, 0.037])
def test_a_second_autopilot_with_the_same_id_draws_nothing_and_is_told(
    second_boot_ms: int, phase: float
) -> None:
    agent, first, second = Agent(), DialectSender(2, 1), DialectSender(2, 1, sequence=77)
    places = []
    for k in range(100):
        for message in stream(k, 1_000_000, 473_977_000):
            agent.hear(FIRST, first, message)
        agent.pass_time(phase)
        if k >= 20:
            for message in stream(k, second_boot_ms, 474_977_000):
                agent.hear(SECOND, second, message)
        agent.pass_time(0.05 - phase)
        places.append(agent.core.vehicle.look(agent.now).latitude_deg)
    assert not any(abs(a - b) > 0.05 for a, b in pairwise(places))
    assert {send.peer for send in agent.sent} <= {FIRST, -1}
    assert "second_autopilot" in agent.core.journal.kinds
    assert agent.core.vehicle.telemetry.reboots == 0


@pytest.mark.parametrize("uids", [(111, 222), (0, 0)], ids=["uids", "no uids"])
@pytest.mark.parametrize("ahead", [0, 77, 200])  # of the second's numbers
def test_two_autopilots_through_one_router_are_told(uids: tuple[int, int], ahead: int) -> None:
    agent, first, second = Agent(), DialectSender(2, 1), DialectSender(2, 1, sequence=ahead)
    for k in range(100):
        for message in stream(k, 1_000_000, 473_977_000, uid=uids[0]):
            agent.hear(FIRST, first, message)
        agent.pass_time(0.02)
        for message in stream(k, 5_000, 474_977_000, uid=uids[1]):
            agent.hear(FIRST, second, message)
        agent.pass_time(0.03)
    assert "second_autopilot" in agent.core.journal.kinds
    assert agent.core.vehicle.look(agent.now).latitude_deg == pytest.approx(47.3977, abs=1e-4)
    assert agent.core.vehicle.telemetry.reboots == 0


@pytest.mark.parametrize("ports", ["moves once", "new with every frame"])
def test_one_autopilot_that_changes_its_port_goes_on(ports: str) -> None:
    agent, sender = Agent(), DialectSender(2, 1)
    heard = 0
    for k in range(200):
        peer = (1 if k < 100 else 2) if ports == "moves once" else k + 1
        for message in stream(k, 60_000, 473_977_000):
            agent.hear(peer, sender, message)
        agent.pass_time(0.05)
        heard += agent.now - agent.core.vehicle.look(agent.now).position_at < 0.06
    assert heard >= 190
    assert agent.now - agent.core.vehicle.telemetry.position_at < 0.06
    assert "second_autopilot" not in agent.core.journal.kinds
    agent.sent.clear()
    agent.pass_time(1.0)
    assert {send.peer for send in agent.sent} <= ({2} if ports == "moves once" else set(range(190, 201)))


def test_the_agent_asks_which_board_it_flies_at_first_and_now_and_then_again() -> None:
    agent, sender = Agent(), DialectSender(2, 1)
    asked: list[float] = []
    for k in range(20 * 75):
        for message in stream(k, 60_000, 473_977_000, uid=111 if k >= 200 else 0):
            agent.hear(FIRST, sender, message)
        agent.pass_time(0.05)
        for send in agent.sent:
            for packet in Framer().feed(send.frame):
                m = dialect_packet(packet.raw).message
                if packet.name == "COMMAND_LONG" and m.command == 512 and m.param1 == 148:
                    asked.append(agent.now)
        agent.sent.clear()
    assert 2 <= sum(at < 10.0 for at in asked) <= 6
    assert 1 <= sum(at > 12.0 for at in asked) <= 3
    assert agent.core.vehicle.version is not None
    assert agent.core.vehicle.version.uid == 111


def test_a_gimbal_that_beats_under_the_vehicles_id_is_named_once() -> None:
    agent, autopilot, gimbal = Agent(), DialectSender(2, 1), DialectSender(2, 154)
    beat = dialect.MAVLink_heartbeat_message(26, 8, 0, 0, 4, 3)
    for k in range(60):
        for message in stream(k, 60_000, 473_977_000):
            agent.hear(FIRST, autopilot, message)
        if k % 20 == 0:
            agent.hear(FIRST, gimbal, beat)
        agent.pass_time(0.05)
    assert agent.core.journal.kinds["component"] == 1
    assert agent.core.vehicle.components == [154]


@pytest.mark.parametrize(
    ("theirs", "ours", "said"),
    [
        (b"theirs", b"", "its frames are signed and no key is set"),
        (b"theirs", b"ours", "signed with another key"),
        (b"", b"ours", "arrive unsigned while a key is set"),
        (b"ours", b"ours", ""),
        (b"", b"", ""),
    ],
)
def test_the_running_agent_names_signing_as_the_cause_once(theirs: bytes, ours: bytes, said: str) -> None:
    agent = Agent(ours)
    sender = DialectSender(2, 1, signing=signing_with(theirs) if theirs else None)
    for k in range(100):
        for message in stream(k, 60_000, 473_977_000):
            agent.hear(FIRST, sender, message)
        agent.pass_time(0.05)
    assert agent.core.journal.kinds.get("signing", 0) == (1 if said else 0)
    assert said in agent.text("signing")


def test_a_battery_that_does_not_know_is_unknown_and_not_empty() -> None:
    """−1 % and 65535 mV stand for unknown in both messages; a small pack in `voltages_ext` counts."""
    observer, sender, framer = Observer(2), DialectSender(2, 1), Framer()

    def after(message: MavMessage) -> tuple[float, float]:
        for _ in range(5):
            for packet in framer.feed(sender.pack(message)):
                observer.take(1.0, packet)
        t = observer.snapshot()
        return t.battery, t.voltage

    def status(millivolts: int, percent: int) -> MavMessage:
        found: MavMessage = dialect.MAVLink_sys_status_message(
            0, 0, 0, 0, millivolts, -1, percent, 0, 0, 0, 0, 0, 0
        )
        return found

    assert after(status(65535, -1)) == (-1.0, -1.0)
    assert after(battery(0, 0, -1, 65535)) == (-1.0, -1.0)
    assert after(status(15200, 63)) == pytest.approx((0.63, 15.2))
    assert after(battery(0, 0, 80, 16400)) == pytest.approx((0.8, 16.4))
