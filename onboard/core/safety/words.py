"""The supervisor's causes and actions in words: for events, the ground station and the documents."""

from __future__ import annotations

from onboard.core.safety.policy import Action, Cause

ACTIONS: dict[Action, str] = {
    Action.PASS: "ok",
    Action.CLIP: "clip",
    Action.HOLD: "hold",
    Action.RETURN: "return",
    Action.LAND: "land",
    Action.END: "end",
}

CAUSES: dict[Cause, str] = {
    Cause.NONE: "nothing in the way",
    Cause.SPEED: "the decision's speed lies outside the vehicle's limits",
    Cause.CLIMB: "the decision climbs or sinks faster than the vehicle may",
    Cause.TURN: "the decision turns faster than the vehicle may",
    Cause.ACCELERATION: "the decision changes the velocity faster than the vehicle may",
    Cause.FENCE_AHEAD: "the fence is nearer than the way to stop or turn",
    Cause.CEILING_AHEAD: "the ceiling is nearer than the way to level off",
    Cause.FLOOR_AHEAD: "the floor is nearer than the way to level off",
    Cause.OUTSIDE_FENCE: "outside the fence: on the way back in",
    Cause.SEPARATION: "a team mate is too near",
    Cause.LAYER: "outside the height layer of one's own",
    Cause.NOT_FINITE: "the decision is not a number",
    Cause.TELEMETRY: "the vehicle's own position is too old or not credible",
    Cause.HEARTBEAT: "the autopilot's heartbeat is missing",
    Cause.TRACKS: "the tracks are lost: their stated error is too large",
    Cause.STRATEGY: "the strategy has stalled",
    Cause.GROUND_STATION: "the ground station is silent",
    Cause.CLOCK: "the clock jumped",
    Cause.BATTERY: "the battery is low",
    Cause.EKF: "the autopilot's position estimate is not healthy",
    Cause.GPS: "the autopilot has no GPS fix",
    Cause.PILOT: "somebody else changed the mode: hands off until control is handed back",
    Cause.FAILSAFE: "the autopilot's own failsafe flies: hands off until control is given back",
    Cause.ORDER: "ordered from the ground",
    Cause.FAR_OUTSIDE_FENCE: "far outside the fence",
    Cause.ZONE_AHEAD: "a zone is nearer than the way to stop or turn",
    Cause.INSIDE_ZONE: "in a zone: on the way out",
    Cause.OVER: "the vehicle's part is over",
}
