"""What the agent says of itself on the bus: state, decision, health."""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant
from onboard.agent.core.flight import Flight
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Action
from onboard.core.safety.supervisor import SupervisorOutput
from onboard.core.safety.words import ACTIONS, CAUSES
from onboard.pilot.pilot import PilotDecision, drawing
from onboard.wire.bus.messages import (
    AgentStage,
    DecisionLevel,
    DecisionModule,
    DecisionReport,
    Health,
    LinkLock,
    State,
    SupervisorAction,
)

LINK_DEAD = 2.0  # [s] an autopilot that is silent for longer gives nothing of its telemetry
UNSURE = 1e6  # stands for an error that is not known [m]


class Standing(NamedTuple):
    """How the agent as a whole stands."""

    stage: AgentStage
    lacks: tuple[str, ...]  # what is missing before it can play
    counters: dict[str, int]
    number: int  # of this report
    stopped_by: str  # id of the last order obeyed that stops
    link_lock: LinkLock = LinkLock.SILENT  # of the MAVLink links


class Reports:
    """Makes what one agent publishes of itself."""

    def __init__(
        self,
        config: AgentConfig,
        nonce: int,
        version: str,
        vehicle: VehicleLink,
        bus: BusView,
        flight: Flight,
    ) -> None:
        self._id, self._role, self._nonce, self._version = config.id, config.role, nonce, version
        self._vehicle, self._bus, self._flight = vehicle, bus, flight

    def state(self, stamp_ns: int, fit: bool = True) -> State:
        """`vehicles/<id>/state`; `fit`: whether the vehicle follows the game."""
        t = self._vehicle.telemetry
        return State(
            id=self._id,
            role=self._role,
            stamp_ns=stamp_ns,
            position=t.position,
            velocity=t.velocity,
            airspeed=t.airspeed,
            wind=t.wind,
            roll=t.roll,
            pitch=t.pitch,
            yaw=t.yaw,
            mode=t.mode,
            armed=t.armed,
            nonce=self._nonce,
            fit=fit,
        )

    def decision(self, stamp_ns: int) -> DecisionReport | None:
        """`vehicles/<id>/decision`: with the pictures of what was decided, and what became of it.

        None while nothing is decided."""
        flight = self._flight
        decision, output = flight.decision, flight.output
        if decision is None or output is None:
            return None
        cones, circles = drawing(decision, flight.part.side)
        return DecisionReport(
            id=self._id,
            stamp_ns=stamp_ns,
            t=flight.part.time(stamp_ns),
            level=DecisionLevel(decision.level),
            module=DecisionModule(decision.module),
            strategy=decision.strategy,
            rule=decision.rule,
            velocity=_sound(flight.wanted),
            aim=_sound(decision.aim),
            time_to_aim=_number(decision.time),
            miss=_number(decision.miss),
            cones=tuple(cone for cone in cones if all(map(isfinite, cone))),
            circles=tuple(circle for circle in circles if all(map(isfinite, circle))),
            supervisor=SupervisorAction(ACTIONS[output.action]),
            reason=_reason(decision, output),
            predictor=decision.predictor,
            predictor_sigma=min(_number(decision.sigma, UNSURE), UNSURE),
            setpoint=_sound(flight.setpoint),
            quarry=decision.quarry,
        )

    def health(self, standing: Standing, now: Instant) -> Health:
        """`vehicles/<id>/health`."""
        vehicle, t, flight, output = self._vehicle, self._vehicle.telemetry, self._flight, self._flight.output
        own = vehicle.limits
        return Health(
            id=self._id,
            role=self._role,
            stamp_ns=now.wall_ns,
            stage=standing.stage,
            lacks=standing.lacks,
            autopilot=None if vehicle.adapter is None else vehicle.adapter.kind,
            mode=t.mode,
            armed=t.armed,
            battery=t.battery,
            link_quality=t.link_quality if now.s - max(t.position_at, t.heartbeat_at) < LINK_DEAD else 0.0,
            telemetry_rate_hz=vehicle.position_rate.value,
            setpoint_rate_hz=vehicle.setpoint_rate.value,
            clock_offset_s=self._bus.clock.offset_s,
            gps_fix=t.gps_fix,
            ekf_ok=t.ekf_ok,
            supervisor=SupervisorAction(ACTIONS[output.action if output is not None else Action.PASS]),
            version=self._version,
            counters=standing.counters,
            telemetry_age_s=min(now.s - t.position_at, 1e6),
            heartbeat_age_s=min(now.s - t.heartbeat_at, 1e6),
            nonce=self._nonce,
            number=standing.number,
            stopped_by=standing.stopped_by,
            link_lock=standing.link_lock,
            failsafe=vehicle.by_failsafe,
            hold_lost=self._flight.hold.lost,
            return_m=-1.0 if own.return_height is None else own.return_height,
            loiter_m=own.loiter_radius or 0.0,
            place_s=flight.part.place_s(now),
        )


def _reason(decision: PilotDecision, output: SupervisorOutput) -> str:
    """The supervisor's where it acts; else what is lacking, or the plan that is followed."""
    if output.action != Action.PASS:
        return CAUSES[output.cause]
    return ", ".join(decision.lacks) or decision.why


def _number(value: float, otherwise: float = 0.0) -> float:
    return value if isfinite(value) else otherwise


def _sound(v: Vec) -> tuple[float, float, float]:
    return (_number(v.x), _number(v.y), _number(v.z))
