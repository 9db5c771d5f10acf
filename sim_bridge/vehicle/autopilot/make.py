"""From a scenario's vehicle to its autopilot."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, degrees

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Kind, VehicleSpec
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.signing import Signing
from sim_bridge.vehicle.autopilot.arducopter import ArduCopter
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.px4 import Px4Multicopter
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.flight.kinematic import ability_of
from sim_bridge.vehicle.motion import Motion

PERSONALITIES: Mapping[Kind, type[Autopilot]] = {
    Kind.PX4: Px4Multicopter,
    Kind.ARDUCOPTER: ArduCopter,
    Kind.ARDUPLANE: ArduPlane,
}
OFFSET = Vec(3.0, -2.0, -0.5)  # [m; NED] per system id, of an autopilot's own origin from its home


def autopilot_for(
    spec: VehicleSpec,
    kind: Kind,
    system: int,
    frame: Frame,
    start: Motion,
    *,
    airborne: bool = True,
    now_ns: int = 0,
    epoch_ns: int = 0,
    parameters: Mapping[str, float] | None = None,
    signing: Signing | None = None,
    ready_s: float = 12.0,
    battery_s: float = 1200.0,
    bank_max_deg: float | None = None,
) -> Autopilot:
    """The autopilot of vehicle `system`, that starts with `start` in the game frame `frame`.

    Home is the ground below the start, at the altitude of the game's origin. `bank_max_deg` is that of
    the airframe where it is not the kinematic one: it sets ROLL_LIMIT_DEG and the radius of waiting.
    Raises ValueError for parameters that this kind does not have.
    """
    p = start.position
    ground = Vec(p.x, p.y, 0.0 if airborne else p.z)
    own = Vec(ground.x + system * OFFSET.x, ground.y + system * OFFSET.y, ground.z + (system % 10) * OFFSET.z)
    ability = ability_of(spec, kind)
    bank = bank_max_deg
    if bank is None:
        bank = degrees(atan(ability.turn_rate * max(spec.speed, 1.0) / STANDARD_GRAVITY))
    setup = Setup(
        kind=kind,
        system=system,
        frame=frame,
        start=start,
        home=frame.geodetic_from_ned(ground),
        origin=frame.geodetic_from_ned(own),
        epoch_ns=epoch_ns,
        airborne=airborne,
        speed_min=ability.speed_min,
        speed_max=ability.speed_max,
        speed_cruise=spec.speed,
        bank_max_deg=bank,
        pitch_min_deg=spec.pitch_min_deg,
        pitch_max_deg=spec.pitch_max_deg,
        ready_s=ready_s,
        healthy_s=0.6 * ready_s,
        battery_s=battery_s,
        parameters=parameters or {},
        signing=signing,
    )
    return PERSONALITIES[kind](setup, now_ns)
