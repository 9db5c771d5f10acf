"""From a scenario's vehicle to its autopilot."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, degrees

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Kind, VehicleSpec
from onboard.wire.geodesy import Frame
from sim_bridge.vehicle.autopilot.arducopter import ArduCopter
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.px4 import Px4Multicopter
from sim_bridge.vehicle.autopilot.setup import Options, Setup
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
    options: Options = Options(),  # noqa: B008  (a NamedTuple cannot change)
) -> Autopilot:
    """The autopilot of vehicle `system`, that starts with `start` in the game frame `frame`, booted at 0 ns.

    Home is the ground below the start, at the altitude of the game's origin. ROLL_LIMIT_DEG of a plane
    allows the turn rate of its `spec`. Raises ValueError for parameters that this kind does not have.
    """
    p = start.position
    ground = Vec(p.x, p.y, 0.0 if options.airborne else p.z)
    own = Vec(ground.x + system * OFFSET.x, ground.y + system * OFFSET.y, ground.z + (system % 10) * OFFSET.z)
    ability = ability_of(spec, kind)
    setup = Setup(
        kind=kind,
        system=system,
        frame=frame,
        start=start,
        home=frame.geodetic_from_ned(ground),
        origin=frame.geodetic_from_ned(own),
        speed_min=ability.speed_min,
        speed_max=ability.speed_max,
        speed_cruise=spec.speed,
        bank_max_deg=degrees(atan(ability.turn_rate * max(spec.speed, 1.0) / STANDARD_GRAVITY)),
        pitch_min_deg=spec.pitch_min_deg,
        pitch_max_deg=spec.pitch_max_deg,
        options=options,
    )
    return PERSONALITIES[kind](setup, now_ns=0)
