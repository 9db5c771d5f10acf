"""The own link: whose frames count, and where messages go."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from onboard.agent.mavlink_radio import Radio
from onboard.runtime.clock import VirtualClock
from onboard.runtime.loop import EPOCH_NS
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.frames import Packet, Sender
from onboard.wire.mavlink.signing import MemoryStore, Signing

KEY = bytes(range(32))


class Wire:
    """A link without a loop: what is sent is kept, what arrives is put in by hand."""

    name = "wire"

    def __init__(self) -> None:
        self.sent: list[tuple[bytes, Hashable | None]] = []
        self.hear: Callable[[bytes, Hashable], None] = lambda data, peer: None

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        self.sent.append((data, peer))

    def receive(self, receiver: Callable[[bytes, Hashable], None]) -> None:
        self.hear = receiver

    def counters(self) -> dict[str, int]:
        return {"sent": len(self.sent)}

    def close(self) -> None:
        """Nothing to release."""


def opened(*wires: Wire, signing: Signing | None = None, mute: bool = False) -> tuple[Radio, list[Packet]]:
    """A radio of vehicle 2 and what it hears."""
    radio = Radio(wires, 2, VirtualClock(EPOCH_NS), signing=signing, mute=mute)
    heard: list[Packet] = []
    radio.open(lambda packet, now: heard.append(packet))
    return radio, heard


def beat(system: int = 2, component: int = 1, signing: Signing | None = None) -> bytes:
    """A heartbeat of somebody's."""
    return Sender(system, component, signing=signing).pack(commands.OwnHeartbeat(), EPOCH_NS)


def test_answers_go_to_the_autopilots_peer_and_to_nobody_elses() -> None:
    wire = Wire()
    radio, heard = opened(wire)
    wire.hear(beat(), ("127.0.0.1", 5760))
    wire.hear(beat(system=255, component=190), ("10.0.0.9", 14550))
    radio.send(commands.OwnHeartbeat())
    assert len(heard) == 2
    assert wire.sent[-1][1] == ("127.0.0.1", 5760)


def test_a_torn_frame_of_one_peer_does_not_spoil_anothers() -> None:
    wire = Wire()
    radio, heard = opened(wire)
    wire.hear(beat()[:9], "a")
    wire.hear(beat(), "b")
    assert len(heard) == 1
    assert radio.counters()["truncated"] == 1


def test_a_crowd_of_peers_is_bounded_and_the_autopilot_is_not_forgotten() -> None:
    wire = Wire()
    radio, _ = opened(wire)
    wire.hear(beat(), "autopilot")
    for n in range(100):
        wire.hear(b"\x00", n)
    radio.send(commands.OwnHeartbeat())
    assert wire.sent[-1][1] == "autopilot"
    assert radio.counters()["peers_forgotten"] > 50


def test_with_a_key_only_signed_frames_count_and_ours_are_signed() -> None:
    wire = Wire()
    radio, heard = opened(wire, signing=Signing(KEY, MemoryStore()))
    wire.hear(beat(), "a")
    assert heard == []
    assert radio.counters()["signature_unsigned"] == 1
    signed = beat(signing=Signing(KEY, MemoryStore()))
    wire.hear(signed, "a")
    wire.hear(signed, "a")
    forged = bytearray(beat(signing=Signing(bytes(32), MemoryStore())))
    wire.hear(bytes(forged), "a")
    assert len(heard) == 1
    assert radio.counters()["signature_replayed"] == 1
    assert radio.counters()["signature_wrong"] == 1
    radio.send(commands.OwnHeartbeat())
    assert wire.sent[-1][0][2] & 1  # the frame says it is signed


def test_mute_sends_nothing_and_counts_it() -> None:
    wire = Wire()
    radio, _ = opened(wire, mute=True)
    wire.hear(beat(), "a")
    radio.send(commands.OwnHeartbeat())
    assert wire.sent == []
    assert radio.counters()["muted"] == 1
