"""What the wire costs, beside the libraries it could have used: ratios within one run."""

from __future__ import annotations

from collections.abc import Callable
from timeit import repeat

import pymap3d  # type: ignore[import-untyped]

from onboard.autopilot.telemetry_state import Observer
from onboard.core.math.vectors import Vec
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.signing import EPOCH_NS, MemoryStore, Signing
from onboard.wire.mavlink.tlog import read_tlog
from tests.benchmarks import yardstick
from tests.support.paths import RECORDINGS

RECORDING = RECORDINGS / "arduplane-4.5.6-guided.tlog"


def cost(call: Callable[[], object], number: int) -> float:
    """Seconds a call, the best of five."""
    return min(repeat(call, number=number, repeat=5)) / number


def test_geodesy_beside_pymap3d() -> None:
    """Promise: under 5 µs a conversion."""
    frame, place = Frame(47.4, 8.5, 500.0), (47.45, 8.6, 900.0)
    there = cost(lambda: frame.ned_from_geodetic(*place), 2000)
    back = cost(lambda: frame.geodetic_from_ned(Vec(5000.0, -3000.0, -400.0)), 2000)
    their_there = cost(lambda: pymap3d.geodetic2ned(*place, 47.4, 8.5, 500.0), 200)
    their_back = cost(lambda: pymap3d.ned2geodetic(5000.0, -3000.0, -400.0, 47.4, 8.5, 500.0), 200)
    print(f"geodesy: there {there * 1e6:.2f} µs, back {back * 1e6:.2f} µs")
    print(f"pymap3d: there {their_there * 1e6:.2f} µs, back {their_back * 1e6:.2f} µs")
    yardstick.cost("geodetic to NED", there)
    yardstick.cost("NED to geodetic", back)
    assert there < their_there / 2
    assert back < their_back / 5


def test_framing_and_decoding_beside_pymavlink() -> None:
    frames = [entry.packet.raw for entry in read_tlog(RECORDING.read_bytes())][:3000]

    def ours() -> None:
        framer, observer = Framer(), Observer(1)
        for frame in frames:
            for packet in framer.feed(frame):
                observer.take(0.0, packet)

    def theirs() -> None:
        parser = dialect.MAVLink(None)
        parser.robust_parsing = True
        for frame in frames:
            parser.parse_buffer(frame)

    a, b = cost(ours, 1) / len(frames), cost(theirs, 1) / len(frames)
    print(f"a frame framed, decoded, observed {a * 1e6:.1f} µs; pymavlink's parse_buffer {b * 1e6:.1f} µs")
    yardstick.cost("a frame framed, decoded, observed", a)
    assert a < 1.5 * b


def test_signing_and_verifying() -> None:
    key, now = bytes(range(32)), EPOCH_NS + 10**18 // 4
    plain, signed = DialectSender(1, 191), DialectSender(1, 191, signing=Signing(key, MemoryStore()))
    message = dialect.MAVLink_attitude_message(1, 0.1, 0.2, 0.3, 0.0, 0.0, 0.0)

    def through(sender: DialectSender, framer: Framer) -> None:
        (packet,) = framer.feed(sender.pack(message, now), now)
        assert packet.value is not None

    bare_framer, checked_framer = Framer(), Framer(signing=Signing(key, MemoryStore()))
    bare = cost(lambda: through(plain, bare_framer), 2000)
    checked = cost(lambda: through(signed, checked_framer), 2000)
    print(f"a message packed and read: {bare * 1e6:.1f} µs, signed {checked * 1e6:.1f} µs")
    yardstick.cost("a message packed and read", bare)
    yardstick.cost("a message packed and read, signed", checked)
    assert checked < 3 * bare
