"""The true motion of every simulated vehicle as a file: what sensors, estimates and reports are measured by.

CSV with the units in the names of its columns; `gcs export` and `gcs.load` read it back. One line for each
vehicle and instant, twenty instants a second.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from onboard.core.math.constants import NS_PER_S
from sim_bridge.vehicle.motion import Motion

TRUTH = "truth.csv"
STEP_NS = NS_PER_S // 20
COLUMNS = (
    "stamp_ns", "id", "north_m", "east_m", "down_m", "v_north_m_s", "v_east_m_s", "v_down_m_s",
    "airspeed_m_s", "roll_rad", "pitch_rad", "yaw_rad",
)  # fmt: skip
LINE = "%d,%d" + ",%.6f" * (len(COLUMNS) - 2) + "\n"


class TruthLog:
    """Writes motions in lines; `write` takes bytes and must not block. Give its `step` to `Bridge.watch`."""

    def __init__(self, write: Callable[[bytes], object]) -> None:
        self._write = write
        self._next_ns = 0
        write((",".join(COLUMNS) + "\n").encode())

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> None:
        """Write the motions at the wall instant `wall_ns` [ns] where the next twentieth has come."""
        if wall_ns < self._next_ns:
            return
        self._next_ns = wall_ns // STEP_NS * STEP_NS + STEP_NS
        lines = [
            LINE % (wall_ns, id, *m.position, *m.velocity, m.airspeed, m.roll, m.pitch, m.yaw)
            for id, m in motions.items()
        ]
        self._write("".join(lines).encode())
