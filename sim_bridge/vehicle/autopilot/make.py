"""From a scenario's vehicle to its autopilot."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, degrees

from numpy.random import Generator

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Firmware, Kind, Scenario, Transmitter, VehicleSpec
from onboard.wire.geodesy import Frame
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot.arducopter import ArduCopter
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.generations import ADDED, renamed
from sim_bridge.vehicle.autopilot.px4_multicopter import Px4Multicopter
from sim_bridge.vehicle.autopilot.px4_plane import Px4Plane
from sim_bridge.vehicle.autopilot.setup import Options, Setup
from sim_bridge.vehicle.flight.kinematic import ability_of
from sim_bridge.vehicle.motion import Motion

PERSONALITIES: Mapping[Kind, type[Autopilot]] = {
    Kind.PX4: Px4Multicopter,
    Kind.PX4_PLANE: Px4Plane,
    Kind.ARDUCOPTER: ArduCopter,
    Kind.ARDUPLANE: ArduPlane,
}
OFFSET = Vec(3.0, -2.0, -0.5)  # [m; NED] per system id, of an autopilot's own origin from its home


TABLES = {
    Kind.PX4: tables.PX4,
    Kind.PX4_PLANE: tables.PX4_PLANE,
    Kind.ARDUCOPTER: tables.ARDUCOPTER,
    Kind.ARDUPLANE: tables.ARDUPLANE,
}
THROTTLE = {Transmitter.CENTRED: 0.5, Transmitter.LOW: 0.0, Transmitter.NONE: None}


def parameter_names(kind: Kind, firmware: Firmware) -> frozenset[str]:
    """The parameters that a kind has, under the names of a generation and under the recorded ones."""
    recorded = {parameter.name for parameter in TABLES[kind]}
    own = {parameter.name for parameter in ADDED.get((kind, firmware), ())}
    return frozenset(recorded | own | {new.name for new in renamed(kind, firmware).values()})


def options_of(scenario: Scenario, random: Generator, parameters: Mapping[str, float]) -> Options:
    """The options of a scenario's autopilots; `random` draws the delays of one vehicle's answers."""
    spec = scenario.flight.simulated
    least = spec.answer_delay_s
    return Options(
        airborne=not scenario.flight.ground_start,
        parameters=parameters,
        throttle=THROTTLE[spec.transmitter],
        answer_delay_s=(least, max(least, spec.answer_delay_max_s)),
        generator=random,
        batteries=spec.batteries,
        firmware=spec.firmware,
        gimbal=spec.gimbal,
        full_streams=spec.full_streams,
        other_station_hz=spec.other_station_hz,
    )


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
