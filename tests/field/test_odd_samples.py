"""One odd sample decides nothing in flight; the same fault that lasts is heeded."""

from __future__ import annotations

import pytest

from onboard.autopilot.health import read
from onboard.autopilot.telemetry_state import Observer
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.paths import RECORDINGS

GOOD = (
    dialect.ESTIMATOR_ATTITUDE
    | dialect.ESTIMATOR_VELOCITY_HORIZ
    | dialect.ESTIMATOR_VELOCITY_VERT
    | dialect.ESTIMATOR_POS_HORIZ_ABS
    | dialect.ESTIMATOR_POS_VERT_ABS
)
E7_PER_M = 1e7 / 111_195.0  # of latitude


class Stream:
    """One autopilot's frames into an observer."""

    def __init__(self) -> None:
        self.observer = Observer(2)
        self._sender = DialectSender(2, 1)
        self._framer = Framer()

    def frame(self, message: MavMessage) -> bytes:
        """The next frame, not yet delivered."""
        return self._sender.pack(message)

    def deliver(self, now: float, raw: bytes) -> None:
        """A frame arrives."""
        for packet in self._framer.feed(raw):
            self.observer.take(now, packet)

    def hear(self, now: float, message: MavMessage) -> None:
        """A frame arrives as it is sent."""
        self.deliver(now, self.frame(message))


def place(boot_s: float, north: float = 0.0, speed: float = 0.0) -> MavMessage:
    """A position `north` [m] of the start, with a speed to the north [m/s]."""
    boot_ms, lat = round(boot_s * 1e3) % 2**32, 473_977_000 + round(north * E7_PER_M)
    message: MavMessage = dialect.MAVLink_global_position_int_message(
        boot_ms, lat, 85_456_000, 538_000, 50_000, round(speed * 100), 0, 0, 0
    )
    return message


def estimator(px4: bool, flags: int = GOOD, ratio: float = 0.3) -> MavMessage:
    message: MavMessage
    if px4:
        message = dialect.MAVLink_estimator_status_message(0, flags, 0.2, 0.2, 0.2, ratio, 0.1, 0.1, 0.8, 1.2)
    else:
        message = dialect.MAVLink_ekf_status_report_message(flags, 0.2, 0.2, 0.2, ratio, 0.1)
    return message


@pytest.mark.parametrize("px4", [True, False])
@pytest.mark.parametrize(
    "odd", [{"ratio": 1.05}, {"ratio": 9.0}, {"flags": GOOD & ~16}, {"flags": 0}], ids=str
)
def test_one_bad_report_of_the_estimator_among_good_ones_is_no_loss(px4: bool, odd: dict[str, float]) -> None:
    stream = Stream()
    for k in range(20):
        stream.hear(0.5 * k, estimator(px4, **(odd if k in (6, 14) else {})))  # type: ignore[arg-type]
        assert stream.observer.snapshot().ekf_ok


@pytest.mark.parametrize("glitch", [dialect.ESTIMATOR_GPS_GLITCH, dialect.ESTIMATOR_ACCEL_ERROR])
def test_every_second_measurement_rejected_is_no_loss(glitch: int) -> None:
    stream = Stream()
    for k in range(40):
        odd = k % 3 == 1
        stream.hear(0.5 * k, estimator(True, GOOD | (glitch if odd else 0), 1.4 if odd else 0.4))
        assert stream.observer.snapshot().ekf_ok


@pytest.mark.parametrize("px4", [True, False])
@pytest.mark.parametrize(
    ("odd", "within"),
    [({"ratio": 1.5}, 1.5), ({"flags": GOOD & ~16}, 0.5), ({"flags": (GOOD & ~16) | 128}, 0.5)],
)
def test_an_estimate_that_stays_bad_is_lost_and_comes_back(
    px4: bool, odd: dict[str, float], within: float
) -> None:
    stream = Stream()
    for k in range(10):
        stream.hear(0.5 * k, estimator(px4))
    lost = NEVER
    for k in range(10, 20):
        stream.hear(0.5 * k, estimator(px4, **odd))  # type: ignore[arg-type]
        if lost == NEVER and not stream.observer.snapshot().ekf_ok:
            lost = 0.5 * k - 5.0
    assert 0.0 < lost <= within
    for k in range(20, 24):
        stream.hear(0.5 * k, estimator(px4))
    assert stream.observer.snapshot().ekf_ok


def test_the_first_report_counts_as_it_is() -> None:
    stream = Stream()
    stream.hear(0.0, estimator(True, ratio=1.5))
    assert not stream.observer.snapshot().ekf_ok


def fix(kind: int) -> MavMessage:
    message: MavMessage = dialect.MAVLink_gps_raw_int_message(
        0, kind, 473_977_000, 85_456_000, 538_000, 100, 100, 0, 0, 12
    )
    return message


def test_one_report_without_a_fix_decides_nothing_and_two_do() -> None:
    stream = Stream()
    for k in range(8):
        stream.hear(0.5 * k, fix(0 if k == 5 else 3))
        assert stream.observer.snapshot().gps_fix == 3
    stream.hear(4.0, fix(1))
    stream.hear(4.5, fix(1))
    assert stream.observer.snapshot().gps_fix == 1


def pack(id: int, function: int, percent: int, millivolts: int) -> MavMessage:
    cells = [millivolts] + [65535] * 9
    message: MavMessage = dialect.MAVLink_battery_status_message(
        id, function, 1, 32767, cells, -1, -1, -1, percent
    )
    return message


def test_one_odd_share_does_not_empty_a_battery() -> None:
    stream = Stream()
    for k in range(8):
        stream.hear(0.5 * k, pack(0, 0, 0 if k == 4 else 80, 15_800))
        assert stream.observer.snapshot().battery == pytest.approx(0.8)
    for k in range(8, 10):
        stream.hear(0.5 * k, pack(0, 0, 10, 13_000))
    assert stream.observer.snapshot().battery == pytest.approx(0.1)


@pytest.mark.parametrize("late_s", [0.3, 1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize("rate", [10, 50])
@pytest.mark.parametrize("count", [1, 5])
def test_frames_that_come_late_are_no_restart_and_move_nothing(late_s: float, rate: int, count: int) -> None:
    stream = Stream()
    sent = []
    for k in range(20 * rate):
        t = k / rate
        late = late_s if 10 * rate <= k < 10 * rate + count else 0.0
        sent.append((t + late, stream.frame(place(3.0 + t, 5.0 * t, 5.0))))
    highest = 0.0
    for t, raw in sorted(sent):
        stream.deliver(t, raw)
        seen = stream.observer.snapshot()
        assert seen.latitude_deg >= highest
        assert t - seen.position_at <= 0.3 + count / rate
        highest = seen.latitude_deg
    assert stream.observer.snapshot().reboots == 0


@pytest.mark.parametrize("odd", [0.0, 1.0, 2.0**32 * 1e-3 - 1.0, 100.0])
def test_one_odd_stamp_is_no_restart_and_deafens_nobody(odd: float) -> None:
    stream = Stream()
    for k in range(200):
        t = 0.05 * k
        stream.hear(t, place(odd if k == 100 else 600.0 + t, 3.0 * t, 3.0))
        seen = stream.observer.snapshot()
        assert seen.reboots == 0
        assert t - seen.position_at <= 0.06


def test_a_clock_that_wraps_after_seven_weeks_is_no_restart() -> None:
    stream = Stream()
    for k in range(200):
        stream.hear(0.05 * k, place(2.0**32 * 1e-3 - 5.0 + 0.05 * k, 0.15 * k, 3.0))
        assert stream.observer.snapshot().position_at == 0.05 * k
    assert stream.observer.snapshot().reboots == 0
    assert stream.observer.snapshot().time_boot_s == pytest.approx(4.95, abs=0.01)


@pytest.mark.parametrize("silence", [0.2, 1.5, 8.0])
def test_a_restart_is_noticed_with_its_second_witness(silence: float) -> None:
    stream = Stream()
    for k in range(100):
        stream.hear(0.05 * k, place(600.0 + 0.05 * k))
    begun = 4.95 + silence
    for k in range(20):
        stream.hear(begun + 0.05 * k, place(min(silence, 1.0) + 0.05 * k))
        if k >= 4:
            assert stream.observer.snapshot().reboots == 1
    assert stream.observer.snapshot().time_boot_s < 3.0


def test_a_jump_of_one_sample_is_left_out_and_one_that_lasts_ages_the_position() -> None:
    stream = Stream()
    for k in range(400):
        t = 0.05 * k
        away = 200.0 if k == 100 or k >= 200 else 0.0
        stream.hear(t, place(60.0 + t, 3.0 * t + away, 3.0))
        seen = stream.observer.snapshot()
        north = (seen.latitude_deg - 47.3977) * 111_195.0
        if k < 200:
            assert abs(north - 3.0 * t) < 1.0
            assert t - seen.position_at <= 0.051
        elif t - 10.0 < 2.9:
            assert north < 31.0
            assert t - seen.position_at == pytest.approx(t - 9.95)
    assert (
        not stream.observer.doubt
    )  # three seconds later it has settled elsewhere: the estimate is what it is
    assert stream.observer.odd["position_jump"] > 50


@pytest.mark.parametrize("speed", [3.0, 10.0, 25.0])
def test_a_position_frozen_while_velocity_runs_on_stops_to_count(speed: float) -> None:
    stream = Stream()
    for k in range(300):
        t = 0.05 * k
        stream.hear(t, place(60.0 + t, speed * min(t, 5.0), speed))
        age = t - stream.observer.snapshot().position_at
        assert age <= max(0.06, t - 4.9)
        if t > 5.6:
            assert age > 0.5  # the supervisor's telemetry rule holds from then on
    assert stream.observer.doubt == "position_frozen"


def test_a_turn_flown_hard_with_slow_telemetry_is_no_contradiction() -> None:
    stream = Stream()
    for k in range(60):
        t = 0.5 * k
        speed = 12.0 if k % 2 else -12.0  # 48 m/s² between samples: harder than any copter
        stream.hear(t, place(60.0 + t, 0.0 if k % 2 else 1.0, speed))
        assert stream.observer.snapshot().position_at == t or k < 2


def test_real_flights_contradict_themselves_only_where_the_estimate_was_lost() -> None:
    for name in ("arducopter-4.5.6-guided", "arduplane-4.5.6-guided"):
        observer, begun = Observer(1), -1
        for entry in read_tlog((RECORDINGS / f"{name}.tlog").read_bytes()):
            begun = entry.stamp_ns if begun < 0 else begun
            now = (entry.stamp_ns - begun) / 1e9
            observer.take(now, entry.packet)
            if now > 15.0:  # before that the estimate finds its place on the ground
                assert not observer.doubt
        assert read(now, observer.snapshot()).faults == ()
