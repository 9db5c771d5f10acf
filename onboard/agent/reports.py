"""What the agent says of itself on the bus: state, decision, health."""

from __future__ import annotations

from math import isfinite

from onboard.autopilot.base import Telemetry
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Action
from onboard.core.safety.supervisor import Verdict
from onboard.core.safety.words import ACTIONS, CAUSES
from onboard.pilot.pilot import PilotDecision, drawing
from onboard.pilot.setup import Side
from onboard.wire.bus.messages import (
    DecisionLevel,
    DecisionModule,
    DecisionReport,
    Role,
    State,
    SupervisorAction,
)

UNSURE = 1e6  # stands for an error that is not known [m]


def state_of(id: int, role: Role, stamp_ns: int, t: Telemetry, nonce: int) -> State:
    """`vehicles/<id>/state`."""
    return State(
        id=id,
        role=role,
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
        nonce=nonce,
    )


def decision_of(
    id: int,
    side: Side,
    stamp_ns: int,
    game_time: float,
    thought: PilotDecision,
    verdict: Verdict,
    setpoint: Vec,
) -> DecisionReport:
    """`vehicles/<id>/decision`: with the pictures of what was decided, and what became of it."""
    cones, circles = drawing(thought, side)
    return DecisionReport(
        id=id,
        stamp_ns=stamp_ns,
        t=game_time,
        level=DecisionLevel(thought.level),
        module=DecisionModule(thought.module),
        strategy=thought.strategy,
        rule=thought.rule,
        velocity=_sound(thought.velocity),
        aim=_sound(thought.aim),
        time_to_aim=_number(thought.time),
        miss=_number(thought.miss),
        cones=tuple(cone for cone in cones if all(map(isfinite, cone))),
        circles=tuple(circle for circle in circles if all(map(isfinite, circle))),
        supervisor=action_of(verdict),
        reason=CAUSES[verdict.cause] if verdict.action != Action.PASS else ", ".join(thought.lacks),
        predictor=thought.predictor,
        predictor_sigma=min(_number(thought.sigma, UNSURE), UNSURE),
        setpoint=_sound(setpoint),
    )


def action_of(verdict: Verdict) -> SupervisorAction:
    """The supervisor's action as the bus names it."""
    return SupervisorAction(ACTIONS[verdict.action])


def _number(value: float, otherwise: float = 0.0) -> float:
    return value if isfinite(value) else otherwise


def _sound(v: Vec) -> tuple[float, float, float]:
    return (_number(v.x), _number(v.y), _number(v.z))
