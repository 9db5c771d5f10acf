"""What the state of the vehicle, its links, its clock and its people demand: the gravest rule speaks."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.safety.envelope import believable
from onboard.core.safety.policy import Action, Cause, Policy, Seen


class Demand(NamedTuple):
    """The least action that a rule demands, and whether it stays until control is handed back."""

    action: Action
    cause: Cause
    latched: bool


CALM = Demand(Action.PASS, Cause.NONE, False)


def health(seen: Seen, policy: Policy, far_outside: bool) -> Demand:
    """The gravest demand of all health rules.

    Comparisons are written so that NaN counts as a fault. Order within one gravity: the first rule speaks.
    """
    if seen.pilot:
        return Demand(Action.END, Cause.PILOT, True)
    fresh = seen.telemetry_age <= policy.telemetry_age
    if not seen.heartbeat_age <= (policy.heartbeat_alone if fresh else policy.heartbeat_age):
        return Demand(Action.END, Cause.HEARTBEAT, False)
    if not seen.strategy_age <= policy.strategy_age:
        return Demand(Action.END, Cause.STRATEGY, False)
    if not seen.ekf_ok:
        return Demand(Action.END, Cause.EKF, False)
    if policy.gps_fix > 0 and seen.gps_fix < policy.gps_fix:
        return Demand(Action.END, Cause.GPS, False)
    worst = CALM
    if seen.order > worst.action:
        worst = Demand(seen.order, Cause.ORDER, False)
    if far_outside and worst.action < Action.RETURN:
        worst = Demand(Action.RETURN, Cause.FAR_OUTSIDE_FENCE, True)
    low = policy.battery > 0.0 and seen.battery != -1.0 and not seen.battery >= policy.battery
    if low and worst.action < Action.RETURN:
        worst = Demand(Action.RETURN, Cause.BATTERY, True)
    if policy.ground_action > worst.action and not seen.ground_age <= policy.ground_age:
        worst = Demand(policy.ground_action, Cause.GROUND_STATION, False)
    if policy.track_action > worst.action and not seen.track_sigma <= policy.track_sigma:
        worst = Demand(policy.track_action, Cause.TRACKS, policy.track_latched)
    if worst.action < Action.HOLD:
        if not fresh or not believable(seen.position, seen.velocity):
            worst = Demand(Action.HOLD, Cause.TELEMETRY, False)
        elif not seen.clock_jump_age >= policy.clock_hold:
            worst = Demand(Action.HOLD, Cause.CLOCK, False)
    return worst
