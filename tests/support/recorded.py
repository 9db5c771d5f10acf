"""Recordings of real autopilots as tests read them: one vehicle's modes, texts, heights and answers."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.wire.mavlink.dialect import dialect_packet
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.paths import RECORDINGS

PX4 = 12  # MAV_AUTOPILOT_PX4


class Said(NamedTuple):
    """One frame of a recording."""

    t: float  # since its first frame [s]
    system: int
    component: int
    message: Any


class Beat(NamedTuple):
    """One heartbeat of an autopilot."""

    t: float
    mode: int
    status: int  # MAV_STATE
    armed: bool


class Recorded:
    """An excerpt of a recording: whole frames, cut in time and thinned of what nobody compares."""

    def __init__(self, said: list[Said]) -> None:
        self.said = said

    def own(self, name: str) -> list[tuple[float, Any]]:
        """What the autopilot (component 1) sent of one kind of message."""
        return [(s.t, s.message) for s in self.said if s.component == 1 and s.message.get_type() == name]

    def asked(self, name: str) -> list[tuple[float, Any]]:
        """What others than the autopilot sent of one kind of message."""
        return [(s.t, s.message) for s in self.said if s.component != 1 and s.message.get_type() == name]

    def beats(self) -> list[Beat]:
        """The autopilot's heartbeats."""
        return [
            Beat(t, m.custom_mode, m.system_status, bool(m.base_mode & 128)) for t, m in self.own("HEARTBEAT")
        ]

    def changes(self) -> list[Beat]:
        """Those heartbeats that tell another mode, status or arming than the one before."""
        out: list[Beat] = []
        for beat in self.beats():
            if not out or out[-1][1:] != beat[1:]:
                out.append(beat)
        return out

    def texts(self) -> list[str]:
        """The autopilot's status texts."""
        return [m.text for _, m in self.own("STATUSTEXT")]

    def heights(self, start: float, end: float) -> list[tuple[float, float]]:
        """Height above home [m] in time."""
        return [(t, m.relative_alt * 1e-3) for t, m in self.own("GLOBAL_POSITION_INT") if start <= t <= end]

    def sink(self, start: float, end: float) -> float:
        """Mean sink rate between two instants [m/s]."""
        there = self.heights(start, end)
        return (there[0][1] - there[-1][1]) / (there[-1][0] - there[0][0])


@cache
def recorded(name: str) -> Recorded:
    """The excerpt of that name in tests/field/recordings/excerpts."""
    entries = list(read_tlog((RECORDINGS / "excerpts" / f"{name}.tlog").read_bytes()))
    zero = entries[0].stamp_ns
    return Recorded(
        [
            Said((e.stamp_ns - zero) / NS_PER_S, e.packet.system, e.packet.component, message)
            for e in entries
            if (message := dialect_packet(e.packet.raw).message) is not None
        ]
    )


def heard(flown: Any) -> Recorded:
    """What a simulated vehicle has sent, seen in the same way."""
    zero = flown.heard[0][0] if flown.heard else 0
    return Recorded(
        [Said((t - zero) / NS_PER_S, m.get_srcSystem(), m.get_srcComponent(), m) for t, m in flown.heard]
    )
