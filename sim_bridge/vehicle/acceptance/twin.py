"""The simulated twin of an accepted autopilot: same kind, parameters, stick, place and motion."""

from __future__ import annotations

from math import radians
from typing import NamedTuple

import numpy as np

from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import WINGED, Firmware, VehicleSpec
from onboard.game.scenario import Kind as Played
from onboard.wire.autopilot_kind import Kind
from onboard.wire.geodesy import Frame
from sim_bridge.vehicle.acceptance.companion import Companion
from sim_bridge.vehicle.acceptance.stories import PARAMETERS, Note, Pause, Story
from sim_bridge.vehicle.autopilot.make import autopilot_for, parameter_names
from sim_bridge.vehicle.autopilot.setup import Options
from sim_bridge.vehicle.flight.kinematic import kinematic, start_motion
from sim_bridge.vehicle.motion import CALM

TICK_S = 0.02
PLAYED = {
    Kind.ARDUCOPTER: Played.ARDUCOPTER,
    Kind.ARDUPLANE: Played.ARDUPLANE,
    Kind.PX4_MULTICOPTER: Played.PX4,
    Kind.PX4_PLANE: Played.PX4_PLANE,
}
CRUISE = {Played.ARDUPLANE: ("AIRSPEED_CRUISE", 22.0), Played.PX4_PLANE: ("FW_AIRSPD_TRIM", 15.0)}
LEAST = {Played.ARDUPLANE: ("AIRSPEED_MIN", 10.0), Played.PX4_PLANE: ("FW_AIRSPD_MIN", 10.0)}
MOST = {Played.ARDUPLANE: ("AIRSPEED_MAX", 30.0), Played.PX4_PLANE: ("FW_AIRSPD_MAX", 20.0)}


class Begun(NamedTuple):
    """How the accepted vehicle was found, from which its twin begins."""

    kind: Kind
    system: int
    height: float  # above home [m]
    yaw_deg: float
    throttle: float | None
    parameters: dict[str, float]


def begun(companion: Companion) -> Begun:
    """What the companion has found."""
    hud = companion.latest.get("VFR_HUD")
    known = {
        name: companion.parameters[name]
        for name in PARAMETERS[companion.kind]
        if name in companion.parameters
    }
    yaw = 0.0 if hud is None else float(hud.heading)
    height = 50.0 if companion.height is None else companion.height
    return Begun(companion.kind, companion.system, height, yaw, companion.throttle, known)


class Twin:
    """The twin in its airframe, and the companion beside it, on a time of their own."""

    def __init__(self, found: Begun) -> None:
        kind = PLAYED[found.kind]
        p = found.parameters
        firmware = Firmware.NEWER if "MAV_GCS_SYSID" in p else Firmware.RECORDED
        names = parameter_names(kind, firmware)
        spec = VehicleSpec(position=(0.0, 0.0, max(5.0, found.height)), speed=5.0, speed_max=8.0)
        if kind in WINGED:
            cruise, least, most = (p.get(*table[kind]) for table in (CRUISE, LEAST, MOST))
            spec = VehicleSpec(
                position=(0.0, 0.0, max(30.0, found.height)), speed=cruise, speed_min=least, speed_max=most,
                turn_rate_deg=40.0, pitch_min_deg=-20.0, pitch_max_deg=25.0,
            )  # fmt: skip
        start = start_motion(spec.start(), radians(found.yaw_deg), kind, spec.speed, CALM, airborne=True)
        options = Options(
            parameters={name: value for name, value in p.items() if name in names},
            throttle=found.throttle,
            firmware=firmware,
            generator=np.random.default_rng(1),
        )
        self.autopilot = autopilot_for(spec, kind, found.system, Frame(47.4, 8.5, 400.0), start, options)
        self.airframe = kinematic(spec, kind, start, CALM)
        self.companion = Companion()
        self._now_ns = 0

    def fly(self, story: Story) -> list[Note]:
        """Fly one story to its end; what it saw."""
        notes: list[Note] = []
        for pause in story.fly(self.companion, notes):
            self.wait(pause)
        return notes

    def settle(self, seconds: float) -> None:
        """Let the companion find the autopilot and its streams."""
        self.wait(Pause(seconds, lambda: self.companion.system != 0))
        self.companion.ask_streams()
        for name in PARAMETERS[PLAYED_BY[self.autopilot.setup.kind]]:
            self.companion.ask_parameter(name)
        self.wait(Pause(seconds))

    def wait(self, pause: Pause) -> None:
        """Let time pass as a pause says."""
        end_ns = self._now_ns + round(pause.seconds * NS_PER_S)
        while self._now_ns < end_ns and not (pause.until is not None and pause.until()):
            self._now_ns += round(TICK_S * NS_PER_S)
            self.companion.tick(self._now_ns / NS_PER_S)
            for frame in self.companion.outgoing():
                self.autopilot.receive(self._now_ns, frame, "companion")
            demand = self.autopilot.step(self._now_ns, self.airframe.motion, CALM)
            if not self.autopilot.parked:
                self.airframe.step(demand, CALM, TICK_S)
            for frame in self.autopilot.outgoing():
                self.companion.receive(frame)


PLAYED_BY = {played: kind for kind, played in PLAYED.items()}
