"""An autopilot that rests until something is due says byte for byte what one says that never rests."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from onboard.game.scenario import WINGED, Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from sim_bridge.vehicle.autopilot.health import Fault
from sim_bridge.vehicle.autopilot.setup import Options
from sim_bridge.vehicle.wind.estimate import Errors
from tests.support.flown_autopilot import ENDED, PX4, FlownAutopilot

STEP_S = 0.01  # the world's
STATION = DialectSender(255, 190)
SWITCHES = {
    Kind.ARDUCOPTER: ("LOITER", "GUIDED", "RTL", "LAND", "BRAKE", "STABILIZE"),
    Kind.ARDUPLANE: ("LOITER", "GUIDED", "RTL", "FBWA", "CIRCLE"),
    Kind.PX4: ("HOLD", "OFFBOARD", "RTL", "LAND", "POSCTL"),
    Kind.PX4_PLANE: ("HOLD", "OFFBOARD", "RTL", "ALTCTL"),
}
VALUES = {
    Kind.ARDUCOPTER: {"FS_GCS_ENABLE": 1, "FS_GCS_TIMEOUT": 2, "GUID_TIMEOUT": 0.7, "BATT_LOW_VOLT": 11.4,
                      "BATT_LOW_MAH": 300, "BATT_CRT_VOLT": 10.9, "FENCE_ENABLE": 1, "FENCE_RADIUS": 30,
                      "FENCE_TYPE": 3},
    Kind.ARDUPLANE: {"FS_GCS_ENABL": 1, "FS_LONG_TIMEOUT": 2, "BATT_LOW_VOLT": 11.4, "BATT_CRT_VOLT": 10.9,
                     "BATT_FS_LOW_ACT": 1},
    Kind.PX4: {"COM_DL_LOSS_T": 3, "NAV_DLL_ACT": 2, "COM_OF_LOSS_T": 0.6, "BAT_LOW_THR": 0.6,
               "COM_LOW_BAT_ACT": 3, "BAT_CRIT_THR": 0.4, "GF_MAX_HOR_DIST": 40},
    Kind.PX4_PLANE: {"COM_DL_LOSS_T": 3, "NAV_DLL_ACT": 1, "BAT_LOW_THR": 0.6, "BAT_CRIT_THR": 0.4,
                     "COM_LOW_BAT_ACT": 2},
}  # fmt: skip
Act = Callable[[FlownAutopilot], object]


def _sent(message: object, sender: DialectSender | None = None) -> Act:
    return lambda flown: flown.send(message, sender)


def _velocity(rng: np.random.Generator) -> Act:
    vx, vy, vz = rng.uniform(-5.0, 5.0, 3)
    target = dialect.MAVLink_set_position_target_local_ned_message(
        0, 1, 1, 1, 0xDC7, 0, 0, 0, vx, vy, 0.1 * vz, 0, 0, 0, 0, 0
    )
    return _sent(target)


def _place(rng: np.random.Generator) -> Act:
    x, y = rng.uniform(-200.0, 200.0, 2)
    return _sent(
        dialect.MAVLink_set_position_target_local_ned_message(
            0, 1, 1, 1, 0xDF8, x, y, -80.0, 0, 0, 0, 0, 0, 0, 0, 0
        )
    )


def _beat(rng: np.random.Generator) -> Act:
    beat = dialect.MAVLink_heartbeat_message(dialect.MAV_TYPE_GCS, dialect.MAV_AUTOPILOT_INVALID, 0, 0, 4, 3)
    return _sent(beat, STATION)


def _rate(rng: np.random.Generator) -> Act:
    number = int(rng.choice([30, 33, 74, 32, 1, 147, 193, 168]))
    interval = float(rng.choice([-1.0, 0.0, 20_000.0, 50_000.0, 333_333.0]))
    return _sent(dialect.MAVLink_command_long_message(1, 1, 511, 0, number, interval, 0, 0, 0, 0, 0))


def _value(kind: Kind, rng: np.random.Generator) -> Act:
    name = str(rng.choice(list(VALUES[kind])))
    return lambda flown: flown.autopilot.parameters.put(name, VALUES[kind][name])


def _hand(kind: Kind, rng: np.random.Generator) -> Act:
    drawn = rng.integers(7)
    mode, charge = str(rng.choice(SWITCHES[kind])), float(rng.uniform(0.1, 1.0))
    stick = None if rng.random() < 0.5 else float(rng.uniform(0.3, 0.7))
    fault, fails = Fault.GPS if rng.random() < 0.5 else Fault.EKF, bool(rng.random() < 0.4)
    acts: list[Act] = [
        lambda flown: flown.autopilot.pilot_mode(flown.now_ns, mode),
        lambda flown: flown.autopilot.set_battery(charge),
        lambda flown: flown.autopilot.set_voltage(11.0),
        lambda flown: flown.autopilot.set_throttle(flown.now_ns, stick),
        lambda flown: flown.autopilot.fail(fault, fails),
        _value(kind, rng),
        lambda flown: flown.autopilot.reboot(flown.now_ns),
    ]
    return acts[drawn]


def _set(flown: FlownAutopilot, values: dict[str, float]) -> None:
    for name, value in values.items():
        flown.autopilot.parameters.put(name, value)


def _quiet(flown: FlownAutopilot) -> None:
    """Nothing streams: it may rest from one heartbeat to the next."""
    for number in list(type(flown.autopilot).default_rates):
        flown.autopilot.streams.set(number, -1.0, flown.now_ns)


def _script(kind: Kind, rng: np.random.Generator, steps: int) -> dict[int, list[Act]]:
    """What happens before which step: streams that come and go, and now and then a hand at something."""
    script: dict[int, list[Act]] = {0: [_quiet, lambda flown: _set(flown, VALUES[kind])]}
    for make, period in ((_velocity, 5), (_place, 20), (_beat, 100)):
        on = make is not _place
        for step in range(steps):
            if rng.random() < 0.004:
                on = not on
            if on and step % period == 0:
                script.setdefault(step, []).append(make(rng))
    for step in rng.integers(steps // 2, steps, steps // 300).tolist():
        script.setdefault(step, []).append(_hand(kind, rng))
    for step in rng.integers(steps // 2, steps, steps // 500).tolist():
        script.setdefault(step, []).append(_rate(rng))
    for mode in ("GUIDED", "OFFBOARD"):
        if mode in SWITCHES[kind]:
            for step in (20, steps // 4, steps // 2):
                script.setdefault(step, []).append(lambda f, m=mode: f.autopilot.pilot_mode(f.now_ns, m))  # type: ignore[misc]
    return script


def _played(kind: Kind, seed: int, steps: int, *, rests: bool) -> FlownAutopilot:
    rng = np.random.default_rng([seed, *kind.value.encode()])
    flown = FlownAutopilot(
        kind, tick_s=STEP_S, battery_s=0.011 * steps, wind_errors=Errors(*([0.1] * len(Errors._fields)))
    )
    script = _script(kind, rng, steps)
    if seed % 2 and kind is Kind.ARDUCOPTER:  # inside a fence it never rests
        script[0].append(lambda flown: _set(flown, {"FENCE_ENABLE": 0}))
    if seed % 2 and kind is Kind.PX4:
        script[0].append(lambda flown: _set(flown, {"GF_MAX_HOR_DIST": 0}))
    for step in range(steps):
        for act in script.get(step, ()):
            act(flown)
        if not rests:
            flown.autopilot.wake()
        flown.forward(STEP_S)
    return flown


@pytest.mark.parametrize("kind", ENDED)
@pytest.mark.parametrize("seed", range(4))
def test_resting_changes_no_byte(kind: Kind, seed: int) -> None:
    steps = 2500
    resting, watchful = (_played(kind, seed, steps, rests=rests) for rests in (True, False))
    assert [when for when, _ in resting.heard] == [when for when, _ in watchful.heard]
    assert resting.frames == watchful.frames
    assert resting.airframe.motion == watchful.airframe.motion
    assert resting.autopilot.counters == watchful.autopilot.counters


@pytest.mark.parametrize("kind", ENDED)
def test_undisturbed_it_looks_only_when_it_sends(kind: Kind, monkeypatch: pytest.MonkeyPatch) -> None:
    flown = FlownAutopilot(kind, tick_s=STEP_S)
    looks = 0
    watch = flown.autopilot.watch

    def counted(now_ns: int) -> None:
        nonlocal looks
        looks += 1
        watch(now_ns)

    monkeypatch.setattr(flown.autopilot, "watch", counted)
    sent = len({when for when, _ in flown.forward(10.0).heard})
    assert looks < 500  # of 1000 steps
    assert looks <= 1.1 * sent + 5


def test_every_kind_is_here() -> None:
    assert set(SWITCHES) == set(VALUES) == set(ENDED) == WINGED | set(PX4) | {Kind.ARDUCOPTER}
    assert Options().airborne
