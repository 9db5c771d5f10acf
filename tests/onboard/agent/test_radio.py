"""The own link: whose frames count, and where messages go."""

from __future__ import annotations

from onboard.agent.core.events import ANY_PEER, Instant, LinkFacts, Outbox, Send
from onboard.agent.core.mavlink_radio import Radio
from onboard.runtime.loop import EPOCH_NS
from onboard.wire.bus.messages import LinkLock
from onboard.wire.mavlink.commands import OwnHeartbeat
from onboard.wire.mavlink.frames import Packet, Sender
from onboard.wire.mavlink.signing import MemoryStore, Signing

KEY = bytes(range(32))


NOW = Instant(0.0, EPOCH_NS)


class Air:
    """A radio of vehicle 2: what it hears, and what it wants sent."""

    def __init__(self, *, signing: Signing | None = None, mute: bool = False) -> None:
        self.out = Outbox()
        self.radio = Radio([LinkFacts("wire", False)], 2, self.out, signing=signing, mute=mute)
        self.heard: list[Packet] = []

    def hear(self, data: bytes, peer: int) -> None:
        self.heard += self.radio.take(0, peer, data, NOW).packets
        self.out.take()

    def sent(self) -> list[Send]:
        """What goes out when the radio sends a heartbeat."""
        self.radio.send(OwnHeartbeat())
        self.radio.flush(NOW)
        return [effect for effect in self.out.take() if isinstance(effect, Send)]


AUTOPILOT, STRANGER = 3, 7


def beat(system: int = 2, component: int = 1, signing: Signing | None = None) -> bytes:
    """A heartbeat of somebody's."""
    return Sender(system, component, signing=signing).pack(OwnHeartbeat(), EPOCH_NS)


def test_answers_go_to_the_autopilots_peer_and_to_nobody_elses() -> None:
    air = Air()
    air.hear(beat(), AUTOPILOT)
    air.hear(beat(system=255, component=190), STRANGER)
    assert len(air.heard) == 2
    assert [send.peer for send in air.sent()] == [AUTOPILOT]


def test_before_the_autopilot_is_heard_the_one_peer_there_is_gets_what_is_said_and_of_two_nobody() -> None:
    """A telemetry radio or a ground station may speak first on a line on which the autopilot waits for us."""
    air = Air()
    assert [send.peer for send in air.sent()] == [ANY_PEER]
    air.hear(beat(system=51, component=68), STRANGER)
    assert [send.peer for send in air.sent()] == [ANY_PEER]
    air.hear(beat(system=255, component=190), AUTOPILOT)
    assert air.sent() == []
    assert air.radio.causes["no_peer"] == 1


def test_the_lock_of_the_links_tells_silent_signed_and_refused() -> None:
    assert Air().radio.lock is LinkLock.OPEN
    air = Air(signing=Signing(KEY, MemoryStore()))
    assert air.radio.lock is LinkLock.SILENT
    air.hear(beat(), AUTOPILOT)  # without a signature
    assert air.radio.lock is LinkLock.REFUSED
    own = Signing(KEY, MemoryStore())
    air.hear(beat(signing=own), AUTOPILOT)
    assert air.radio.lock is LinkLock.SIGNED
    air.hear(beat(system=7), STRANGER)  # somebody else's, beside a signed one: the link is still locked
    assert air.radio.lock is LinkLock.SIGNED
    late = Instant(2.5, EPOCH_NS + 2_500_000_000)
    air.radio.take(0, AUTOPILOT, beat(signing=Signing(bytes(32), MemoryStore())), late)  # another key since
    assert air.radio.lock is LinkLock.REFUSED


def test_a_second_autopilot_with_the_same_id_draws_nothing_to_itself_and_is_said() -> None:
    air, said = Air(), 0
    for step in range(120):  # both twenty times a second, in every order
        at = Instant(step * 0.025, EPOCH_NS + step * 25_000_000)
        first = step % 2 == 0
        found = air.radio.take(0, AUTOPILOT if first else STRANGER, beat(), at)
        assert len(found.packets) == first
        said += found.second
        air.out.take()
        assert [send.peer for send in air.sent()] == [AUTOPILOT]
    assert said > 50
    assert air.radio.causes["second_autopilot"] + air.radio.causes["other_autopilot"] == 60


def test_an_autopilot_that_comes_back_from_another_port_is_believed_after_a_silence() -> None:
    air = Air()
    air.radio.take(0, AUTOPILOT, beat(), Instant(10.0, EPOCH_NS))
    assert air.radio.take(0, STRANGER, beat(), Instant(10.2, EPOCH_NS)).packets == ()
    assert len(air.radio.take(0, STRANGER, beat(), Instant(11.6, EPOCH_NS)).packets) == 1
    air.out.take()
    assert [send.peer for send in air.sent()] == [STRANGER]


def test_before_anybody_was_heard_the_link_knows_whom_to_send_to() -> None:
    assert [send.peer for send in Air().sent()] == [ANY_PEER]


def test_a_torn_frame_of_one_peer_does_not_spoil_anothers() -> None:
    air = Air()
    air.hear(beat()[:9], STRANGER)
    air.hear(beat(), AUTOPILOT)
    assert len(air.heard) == 1
    air.hear(beat(), STRANGER)
    assert air.radio.causes["truncated"] == 1


def test_a_crowd_of_peers_is_bounded_and_the_autopilot_is_not_forgotten() -> None:
    air = Air()
    air.hear(beat(), AUTOPILOT)
    for n in range(100, 200):
        air.hear(b"\x00", n)
    assert [send.peer for send in air.sent()] == [AUTOPILOT]
    assert air.radio.causes["peers_forgotten"] > 50


def test_with_a_key_only_signed_frames_count_and_ours_are_signed() -> None:
    air = Air(signing=Signing(KEY, MemoryStore()))
    air.hear(beat(), AUTOPILOT)
    assert air.heard == []
    assert air.radio.causes["signature_unsigned"] == 1
    signed = beat(signing=Signing(KEY, MemoryStore()))
    air.hear(signed, AUTOPILOT)
    air.hear(signed, AUTOPILOT)
    air.hear(beat(signing=Signing(bytes(32), MemoryStore())), AUTOPILOT)
    assert len(air.heard) == 1
    assert air.radio.causes["signature_replayed"] == 1
    assert air.radio.causes["signature_wrong"] == 1
    assert air.sent()[0].frame[2] & 1  # the frame says it is signed


def test_mute_sends_nothing_and_counts_it() -> None:
    air = Air(mute=True)
    air.hear(beat(), AUTOPILOT)
    assert air.sent() == []
    assert air.radio.causes["muted"] == 1
