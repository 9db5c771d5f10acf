"""The pursuers' plan in the picture: which one counts, and what it says in words."""

from __future__ import annotations

from math import degrees

from onboard.core.math.constants import NS_PER_S
from onboard.pilot.team_seat import LEASE_S, OLD_S
from onboard.wire.bus.team_messages import PlannedBand, PlannedPart, TeamPlan

MOST_TOLD = 4  # evaders that are told one by one
Plans = dict[int, tuple[TeamPlan, int]]  # by planner, with when each came [ns]


def counting(heard: Plans, now_ns: int) -> TeamPlan | None:
    """The plan that is flown: the lowest fresh planner's, else the newest; None where all are old."""
    aged = [((now_ns - at) / NS_PER_S, plan) for plan, at in heard.values()]
    fresh = [plan for age, plan in aged if age <= LEASE_S]
    if fresh:
        return min(fresh, key=lambda plan: plan.id)
    age, newest = min(aged, key=lambda pair: pair[0], default=(OLD_S + 1.0, None))
    return newest if age <= OLD_S else None


def part_of(plan: TeamPlan | None, id: int) -> PlannedPart | None:
    """A vehicle's part of a plan; None where it has none."""
    return None if plan is None else next((part for part in plan.parts if part.id == id), None)


def part_in_words(plan: TeamPlan, part: PlannedPart) -> str:
    """A part and its reason, for people."""
    why = f": {part.reason.value}" if part.reason.value else ""
    return f"{part.role.value} in the plan of {plan.id}{why}"


def band_in_words(plan: TeamPlan) -> str:
    """Whether the evader's band is closed, and who could close it, for people; of several evaders of each."""
    if len(plan.bands) > MOST_TOLD:
        closed = sum(one.closed for one in plan.bands)
        widest = max(plan.bands, key=lambda one: one.gap)
        most = f"E{widest.quarry} {_band(widest)}"
        return f"plan of {plan.id}: {closed} of {len(plan.bands)} bands closed; {most}"
    if plan.bands:
        return f"plan of {plan.id}: " + "; ".join(f"E{one.quarry} {_band(one)}" for one in plan.bands)
    return f"plan of {plan.id}: {_band(plan)}"


def _band(band: TeamPlan | PlannedBand) -> str:
    if band.closed:
        return "band closed"
    said = f"way out {degrees(band.gap):.0f}° at {degrees(band.bearing) % 360.0:.0f}°"
    if band.closer and band.closes >= 0.0:
        said += f", {band.closer} could close it by T+{band.closes:.0f} s"
    return said
