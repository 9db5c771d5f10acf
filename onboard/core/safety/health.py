"""What the state of the vehicle, its links, its clock and its people demand: the gravest rule speaks."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from onboard.core.safety.envelope import believable
from onboard.core.safety.policy import Action, Cause, Policy, SupervisorInput


class HealthAction(NamedTuple):
    """The least action that a rule demands, and whether it stays until control is handed back."""

    action: Action
    cause: Cause
    latched: bool


CALM = HealthAction(Action.PASS, Cause.NONE, False)


def health(seen: SupervisorInput, policy: Policy, far_outside: bool) -> HealthAction:
    """The gravest demand of all health rules.

    Comparisons are written so that NaN counts as a fault. Order within one gravity: the first rule speaks.
    """
    if seen.pilot:
        return HealthAction(Action.END, Cause.FAILSAFE if seen.failsafe else Cause.PILOT, True)
    fresh = seen.telemetry_age <= policy.telemetry_age
    if not seen.heartbeat_age <= (policy.heartbeat_alone if fresh else policy.heartbeat_age):
        return HealthAction(Action.END, Cause.HEARTBEAT, False)
    if not seen.strategy_age <= policy.strategy_age:
        return HealthAction(Action.END, Cause.STRATEGY, False)
    if not seen.ekf_ok:
        return HealthAction(Action.END, Cause.EKF, False)
    if policy.gps_fix > 0 and seen.gps_fix < policy.gps_fix:
        return HealthAction(Action.END, Cause.GPS, False)
    worst = CALM
    if seen.order > worst.action:
        worst = HealthAction(seen.order, Cause.ORDER, False)
    if seen.over and worst.action < Action.HOLD:
        worst = HealthAction(Action.HOLD, Cause.OVER, False)
    if far_outside and worst.action < Action.RETURN:
        worst = HealthAction(Action.RETURN, Cause.FAR_OUTSIDE_FENCE, True)
    low = policy.battery > 0.0 and seen.battery != -1.0 and not seen.battery >= policy.battery
    if low and worst.action < Action.RETURN:
        worst = HealthAction(Action.RETURN, Cause.BATTERY, True)
    alone = policy.ground_return < inf and not seen.ground_age <= policy.ground_return
    if alone and worst.action < Action.RETURN:
        worst = HealthAction(Action.RETURN, Cause.GROUND_STATION, True)
    if policy.ground_action > worst.action and not seen.ground_age <= policy.ground_age:
        worst = HealthAction(policy.ground_action, Cause.GROUND_STATION, False)
    if policy.track_action > worst.action and not seen.track_sigma <= policy.track_sigma:
        worst = HealthAction(policy.track_action, Cause.TRACKS, policy.track_latched)
    if worst.action < Action.HOLD:
        if not fresh or not believable(seen.position, seen.velocity):
            worst = HealthAction(Action.HOLD, Cause.TELEMETRY, False)
        elif not seen.clock_jump_age >= policy.clock_hold:
            worst = HealthAction(Action.HOLD, Cause.CLOCK, False)
    return worst
