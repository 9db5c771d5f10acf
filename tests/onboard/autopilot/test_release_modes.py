"""The mode that a vehicle is left in: safe with the sticks that are there, and to be had."""

from __future__ import annotations

from itertools import product

import pytest

from onboard.autopilot.base import ReleaseMode, Stage, Telemetry
from onboard.autopilot.mode_machine import ModeMachine
from onboard.autopilot.pilot_hands import FLOWN_BY_HAND
from onboard.autopilot.release_modes import Release, chain, stick_centred
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.values import CommandAck
from tests.support.paths import ROOT

COPTER, PLANE, PX4 = Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4_MULTICOPTER
THERE = Telemetry(gps_at=10.0, gps_fix=3, ekf_at=10.0, ekf_ok=True, channels_at=10.0, channels=(1500,) * 8)
SET = {"THR_DZ": 100.0, "FS_OPTIONS": 16.0, "FS_GCS_ENABLE": 1.0, "SYSID_MYGCS": 2.0}
CENTRED, LOW = THERE, THERE._replace(channels=(1500, 1500, 1000, 1500))


@pytest.mark.parametrize(
    ("what", "telemetry", "parameters", "now", "live"),
    [
        ("in the middle", CENTRED, SET, 10.5, True),
        ("at the edge of the dead zone", THERE._replace(channels=(0, 0, 1600)), SET, 10.5, True),
        ("beyond it", THERE._replace(channels=(0, 0, 1601)), SET, 10.5, False),
        ("low, as without a transmitter", LOW, SET, 10.5, False),
        ("not heard", THERE._replace(channels=()), SET, 10.5, False),
        ("never reported", THERE._replace(channels_at=Telemetry().channels_at), SET, 10.5, False),
        ("old", CENTRED, SET, 12.1, False),
        ("dead zone not read", CENTRED, {}, 10.5, False),
        ("on a channel that is not reported", CENTRED, SET | {"RCMAP_THROTTLE": 9.0}, 10.5, False),
        ("on another channel", LOW, SET | {"RCMAP_THROTTLE": 2.0}, 10.5, True),
        ("asymmetric limits", THERE._replace(channels=(0, 0, 1660)),
         SET | {"RC3_MIN": 1300.0, "RC3_MAX": 2000.0}, 10.5, True),
        ("receiver unhealthy", CENTRED._replace(unhealthy=65536), SET, 10.5, False),
    ],
)  # fmt: skip
def test_what_is_unknown_is_no_stick(
    what: str, telemetry: Telemetry, parameters: dict[str, float], now: float, live: bool
) -> None:
    assert stick_centred(now, telemetry, parameters) is live, what


@pytest.mark.parametrize(
    ("kind", "telemetry", "parameters", "purpose", "modes"),
    [
        (COPTER, CENTRED, SET, ReleaseMode.HOLD, ("LOITER", "BRAKE", "RTL", "LAND")),
        (COPTER, LOW, SET, ReleaseMode.HOLD, ("BRAKE", "RTL", "LAND")),
        (COPTER, CENTRED, {}, ReleaseMode.HOLD, ("BRAKE", "RTL", "LAND")),
        (COPTER, LOW, SET, ReleaseMode.DEPART, ("RTL", "LAND")),
        (COPTER, LOW, {}, ReleaseMode.DEPART, ("RTL", "LAND")),
        (COPTER, LOW, SET | {"FS_OPTIONS": 0.0}, ReleaseMode.DEPART, ("BRAKE", "RTL", "LAND")),
        (COPTER, LOW, SET | {"FS_OPTIONS": 0.0, "FS_GCS_ENABLE": 0.0}, ReleaseMode.DEPART, ("RTL", "LAND")),
        (COPTER, LOW, SET | {"FS_OPTIONS": 0.0, "SYSID_MYGCS": 255.0}, ReleaseMode.DEPART, ("RTL", "LAND")),
        (COPTER, LOW, SET, ReleaseMode.RETURN, ("RTL", "LAND")),
        (PLANE, LOW, {}, ReleaseMode.HOLD, ("LOITER", "RTL")),
        (PLANE, LOW, {}, ReleaseMode.DEPART, ("RTL", "LOITER")),
        (PX4, LOW, {}, ReleaseMode.HOLD, ("HOLD", "RTL", "LAND")),
        (PX4, LOW, {}, ReleaseMode.DEPART, ("HOLD", "RTL", "LAND")),
    ],
)
def test_the_chain_of_each_vehicle(
    kind: Kind,
    telemetry: Telemetry,
    parameters: dict[str, float],
    purpose: ReleaseMode,
    modes: tuple[str, ...],
) -> None:
    assert chain(purpose, 10.5, telemetry, Release(kind, parameters, 2)) == modes


NEEDS_POSITION = {"LOITER", "BRAKE", "RTL", "HOLD", "POSHOLD", "AUTO", "GUIDED", "OFFBOARD"}


@pytest.mark.parametrize(("kind", "purpose"), list(product((COPTER, PLANE, PX4), ReleaseMode)))
def test_no_chain_asks_for_what_the_vehicle_cannot_fly(kind: Kind, purpose: ReleaseMode) -> None:
    blind = (
        THERE._replace(gps_fix=1),
        THERE._replace(ekf_ok=False),
        CENTRED._replace(gps_fix=0, ekf_ok=False),
    )
    for telemetry in (*blind, CENTRED, LOW, Telemetry()):
        for hold in ("", "LOITER", "BRAKE"):
            modes = chain(purpose, 10.5, telemetry, Release(kind, SET, 2, hold if kind is COPTER else ""))
            assert modes
            assert set(modes) <= set(MODES[kind])
            if telemetry in blind:
                assert not NEEDS_POSITION & set(modes)
            if kind is COPTER and not stick_centred(10.5, telemetry, SET):
                assert not FLOWN_BY_HAND[Kind.ARDUCOPTER] & set(modes)


class Answering:
    """An autopilot that refuses some modes, or is slow, against one machine; steps of 20 ms."""

    def __init__(self, *refused: str, delay: float = 0.0, deaf: tuple[str, ...] = ()) -> None:
        self.machine = ModeMachine(1, "GUIDED")
        self.refused, self.delay, self.deaf = refused, delay, deaf
        self.now, self.mode = 100.0, "GUIDED"
        self.asked: list[str] = []
        self.notes: list[str] = []
        self.heard = True
        self._on_their_way: list[tuple[float, str]] = []
        self._beat = 100.0

    def fly(self, seconds: float) -> None:
        for _ in range(round(seconds / 0.02)):
            self.now += 0.02
            while self._on_their_way and self._on_their_way[0][0] <= self.now:
                _, mode = self._on_their_way.pop(0)
                if mode not in self.refused:
                    self.mode, self._beat = mode, self.now
                self.machine.acknowledge(self.now, CommandAck(176, 4 if mode in self.refused else 0, 1, 191))
            if self.heard and self.now - self._beat >= 1.0:
                self._beat = self.now
            place = self.now if self.heard else 0.0
            telemetry = Telemetry(mode=self.mode, heartbeat_at=self._beat, position_at=place)
            step = self.machine.step(self.now, telemetry)
            self.notes += [note.kind for note in step.notes]
            if step.mode:
                self.asked.append(step.mode)
                if step.mode not in self.deaf and self.heard:
                    self._on_their_way.append((self.now + self.delay, step.mode))

    def controlled(self) -> Answering:
        self.machine.enter()
        self.fly(max(1.0, 3.0 * self.delay))
        assert self.machine.stage is Stage.ACTIVE
        self.asked.clear()
        return self


HOLD_CHAIN = ("LOITER", "RTL", "LAND")


@pytest.mark.parametrize("delay", [0.0, 0.1, 0.4])
@pytest.mark.parametrize(
    ("refused", "held"), [((), "LOITER"), (("LOITER",), "RTL"), (("LOITER", "RTL"), "LAND")]
)
def test_what_is_refused_gives_way_to_the_next(refused: tuple[str, ...], held: str, delay: float) -> None:
    vehicle = Answering(*refused, delay=delay).controlled()
    vehicle.machine.leave(ReleaseMode.HOLD, HOLD_CHAIN)
    vehicle.fly(4.0)
    assert (vehicle.mode, vehicle.machine.stage) == (held, Stage.LEFT)
    vehicle.fly(6.0)  # nothing that is still on its way undoes it
    assert (vehicle.mode, vehicle.machine.stage) == (held, Stage.LEFT)


def test_what_is_not_answered_gives_way_after_half_a_second_but_silence_is_no_reason_to_land() -> None:
    vehicle = Answering(deaf=("LOITER", "RTL")).controlled()
    vehicle.machine.leave(ReleaseMode.HOLD, HOLD_CHAIN)
    vehicle.fly(0.45)
    assert set(vehicle.asked) == {"LOITER"}
    vehicle.fly(0.25)
    assert vehicle.asked[-1] == "RTL"
    vehicle.fly(10.0)
    assert "LAND" not in vehicle.asked


def test_a_silent_link_gives_way_to_nothing() -> None:
    vehicle = Answering().controlled()
    vehicle.heard = False
    vehicle.machine.leave(ReleaseMode.HOLD, HOLD_CHAIN)
    vehicle.fly(8.0)
    assert set(vehicle.asked) == {"LOITER"}
    vehicle.heard = True
    vehicle.fly(2.0)
    assert vehicle.mode == "LOITER"


@pytest.mark.parametrize("delay", [0.4, 1.0, 3.0])
def test_late_answers_are_no_pilots(delay: float) -> None:
    """Recorded on a plane: answers after 0.4–3 s, then LOITER → GUIDED → LOITER "by another hand"."""
    vehicle = Answering(delay=delay).controlled()
    for _ in range(3):
        vehicle.machine.leave(ReleaseMode.HOLD, ("LOITER",))
        vehicle.fly(0.6 * delay)
        vehicle.machine.enter()
        vehicle.fly(4.0 * delay)
        assert vehicle.machine.stage is Stage.ACTIVE
        assert vehicle.mode == "GUIDED"
    assert not {"take_over", "handed_back"} & set(vehicle.notes)


def test_a_pilot_is_a_pilot_while_answers_are_late() -> None:
    vehicle = Answering(delay=1.0).controlled()
    vehicle.mode, vehicle._beat = "FBWA", vehicle.now
    vehicle.fly(0.1)
    assert vehicle.machine.stage is Stage.TAKEN
    vehicle.fly(8.0)
    assert vehicle.mode == "FBWA"


def test_the_handbook_names_each_chain() -> None:
    text = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    for words in ("LOITER → BRAKE → RTL → LAND", "BRAKE → RTL → LAND", "RTL → LOITER", "HOLD → RTL → LAND"):
        assert words in text
