"""What the agent's own side makes of an autopilot's stream: recorded, foreign, late, restarted."""

from __future__ import annotations

import pytest

from onboard.autopilot import health
from onboard.autopilot.base import Refusal, Telemetry
from onboard.autopilot.choose import adapter_for
from onboard.autopilot.telemetry_state import Observer
from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import norm
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect
from onboard.wire.mavlink.frames import Framer, Packet
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.tlog import read_tlog
from onboard.wire.mavlink.values import Heartbeat
from tests.support.paths import RECORDINGS


def packet(message: MavMessage, sequence: int = 0, system: int = 1, component: int = 1) -> Packet:
    sender = DialectSender(system, component, sequence=sequence)
    (found,) = Framer().feed(sender.pack(message))
    return found


def heartbeat(mode: int, vehicle: int = 2, autopilot: int = 3) -> MavMessage:
    message: MavMessage = dialect.MAVLink_heartbeat_message(vehicle, autopilot, 1, mode, 4, 3)
    return message


def position(boot_ms: int, lat: int = 473_977_000) -> MavMessage:
    message: MavMessage = dialect.MAVLink_global_position_int_message(
        boot_ms, lat, 85_456_000, 500_000, 20_000, 100, 0, 0, 0
    )
    return message


@pytest.mark.parametrize(
    ("name", "kind", "adapter", "modes"),
    [
        (
            "arduplane",
            Kind.ARDUPLANE,
            "arduplane",
            ["INITIALISING", "MANUAL", "TAKEOFF", "GUIDED", "LOITER", "RTL"],
        ),
        ("arducopter", Kind.ARDUCOPTER, "velocity", ["STABILIZE", "GUIDED", "LOITER", "RTL"]),
    ],
)
def test_fed_with_a_recorded_flight_it_tells_the_story(
    name: str, kind: Kind, adapter: str, modes: list[str]
) -> None:
    observer = Observer(1)
    observer.frame = Frame(47.3977, 8.5456, 488.0)
    seen: dict[str, float] = {}
    healthy_at, armed_at, chosen, start = NEVER, NEVER, "", None
    for entry in read_tlog((RECORDINGS / f"{name}-4.5.6-guided.tlog").read_bytes()):
        start = entry.stamp_ns if start is None else start
        now = (entry.stamp_ns - start) / 1e9
        value = observer.take(now, entry.packet)
        if isinstance(value, Heartbeat) and not chosen:
            made = adapter_for(value, Target(1))
            assert not isinstance(made, Refusal)
            chosen = made.name
        snapshot = observer.snapshot()
        if snapshot.mode:
            seen.setdefault(snapshot.mode, now)
        if snapshot.pre_arm_ok and healthy_at == NEVER:
            healthy_at = now
        if snapshot.armed and armed_at == NEVER:
            armed_at = now
    assert (snapshot.kind, chosen) == (kind, adapter)
    assert list(seen) == modes
    assert healthy_at == pytest.approx(23.3, abs=0.8)
    assert armed_at == pytest.approx(24.0 if kind is Kind.ARDUPLANE else 42.0, abs=1.5)
    assert snapshot.reboots == 0
    assert snapshot.link_quality > 0.99
    assert snapshot.placed
    assert 10.0 < norm(snapshot.position) < 2000.0
    assert 0.5 < snapshot.battery <= 1.0
    words = health.read(now, snapshot)
    expected = () if kind is Kind.ARDUPLANE else ("no GPS",)  # the copter was not asked for GPS_RAW_INT
    assert (words.lacks, words.faults) == (expected, ())


def test_a_ground_station_on_the_same_link_changes_nothing() -> None:
    observer = Observer(1)
    observer.take(1.0, packet(heartbeat(4)))
    gcs = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    assert observer.take(1.1, packet(gcs, system=255, component=190)) is None
    assert observer.take(1.2, packet(gcs)) is None  # even under the vehicle's own number
    assert observer.take(1.3, packet(heartbeat(9), component=154)) is None
    assert observer.take(1.4, packet(heartbeat(9), system=2)) is None
    assert observer.snapshot().mode == "GUIDED"
    assert observer.snapshot().heartbeat_at == 1.0


def test_a_late_heartbeat_does_not_undo_a_newer_one() -> None:
    observer = Observer(1)
    observer.take(1.0, packet(heartbeat(4), 11))
    assert observer.take(1.05, packet(heartbeat(5), 10)) is None
    assert observer.snapshot().mode == "GUIDED"
    observer.take(2.0, packet(heartbeat(5), 40))
    assert observer.snapshot().mode == "LOITER"


def test_an_autopilot_that_starts_again_is_noticed_and_its_old_values_are_dropped() -> None:
    observer = Observer(1)
    observer.take(1.0, packet(heartbeat(4), 200))
    observer.take(1.0, packet(position(600_000), 201))
    observer.take(1.1, packet(position(599_990), 200))  # late, not restarted
    assert observer.snapshot().reboots == 0
    observer.take(4.0, packet(position(1_200), 3))
    after = observer.snapshot()
    assert (after.reboots, after.mode, after.heartbeat_at) == (1, "", NEVER)
    assert after.time_boot_s == pytest.approx(1.2)


def test_link_quality_follows_the_gaps_in_the_numbers() -> None:
    observer = Observer(1)
    for k in range(2000):
        if k % 10 >= 3:  # three of ten lost
            observer.take(k * 0.01, packet(position(k * 10), k % 256))
    assert observer.snapshot().link_quality == pytest.approx(0.7, abs=0.08)


def test_what_is_not_known_is_lacking_and_what_went_silent_is_a_fault() -> None:
    nothing = health.read(10.0, Telemetry())
    assert nothing.silent
    assert set(nothing.lacks) >= {"no heartbeat", "no position", "no attitude", "no GPS"}
    well = Telemetry(heartbeat_at=9.5, position_at=9.9, attitude_at=9.9, ekf_at=9.0, ekf_ok=True)
    well = well._replace(gps_at=9.0, gps_fix=3, satellites=12, accuracy_m=0.8)
    well = well._replace(battery=0.8, battery_at=9.0, status_at=9.0, pre_arm_ok=True)
    assert health.read(10.0, well) == health.Health((), ())
    assert health.read(10.0, well._replace(battery=0.2)).battery_low
    assert health.read(10.0, well._replace(gps_fix=2)).estimate_bad
    assert health.read(10.0, well._replace(ekf_ok=False)).estimate_bad
    assert health.read(10.0, well._replace(accuracy_m=9.0)).faults == ("GPS accuracy 9.0 m, needs 5.0",)
    assert health.read(10.6, well).silent
    assert health.read(13.0, well).faults[0] == "heartbeat 3.5 s old"
    assert health.read(10.0, well._replace(pre_arm_ok=False)).lacks == ("pre-arm checks not passed",)
