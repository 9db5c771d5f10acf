"""The odds of an engagement in words: for `scenario check`, the console and `gcs assess`."""

from __future__ import annotations

from math import degrees

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.geometry.chauffeur import sure_radius
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import scale
from onboard.core.strategy.team.plan_types import Heights, Member, Situation
from onboard.game.odds import GO, Chances, Estimate, Odds, engagement, odds, table
from onboard.game.scenario import Scenario, vec
from onboard.game.staging import places_of, start_headings


def engagement_of(scenario: Scenario) -> Situation:
    """A scenario at its start."""
    evader, *team = (
        Member(Vehicle(place, scale(heading, spec.speed), spec.speed), spec.limits(), True)
        for spec, place, heading in zip(
            scenario.vehicles, places_of(scenario), start_headings(scenario), strict=True
        )
    )
    fence = scenario.flight.fence
    heights = Heights() if fence is None else Heights(fence.height_min, fence.height_max)
    goal = scenario.evader.target
    target = NO_TARGET if goal is None else Target(True, vec(goal))
    return engagement(evader, tuple(team), target, scenario.rules, heights, scenario.flight.sensor.sigma)


def judgement(found: Odds, count: int) -> str:
    """Go, no-go or open, against the evader of the paper: by the interval of the chance of capture of `count`
    pursuers; where the table says nothing by the bound, and by the band."""
    if not found.chances:
        too_few = found.needed == 0 or found.needed > count
        return "go" if found.closed else "no-go" if too_few else "unknown"
    p = next(iter(found.chances.values())).captured
    return "go" if p.low >= GO else "no-go" if p.high < GO else "open"


def share(p: Estimate) -> str:
    """`85 % (80–89)`."""
    return f"{100.0 * p.p:.0f} % ({100.0 * p.low:.0f}–{100.0 * p.high:.0f})"


def lines(s: Situation) -> list[str]:
    """What to expect of an engagement."""
    found = odds(s)
    count = sum(member.fit for member in s.team)
    fast = [member for member in s.team if member.fit and member.vehicle.speed > s.evader.speed]
    if fast:
        sure = min(sure_radius(s.evader.speed, one.vehicle.speed, one.limits.turn_rate) for one in fast)
        safe = "above" if sure < s.rules.R else "not above"
        bound = (
            f"bound: R = {s.rules.R:g} m is {safe} the {sure:.1f} m with which one pursuer captures an evader"
            " that turns at once (the homicidal chauffeur)"
        )
        word = "go" if sure < s.rules.R else "open"
        return [f"{word}: {bound}", f"  the table of odds says nothing here: {found.beyond}"]
    if found.needed > count:
        bound = f"bound: {found.needed} such pursuers at least force a capture, here are {count}"
    elif found.needed == 0:
        bound = "bound: no number of level pursuers closes the band"
    else:
        bound = f"bound: {count} pursuers suffice, {found.needed} are needed at least"
    band = "closed" if found.closed else f"open, the widest way out is {degrees(max(0.0, found.gap)):.0f}°"
    said = [f"{judgement(found, count)}: {bound}; the band is {band}"]
    if found.beyond:
        return [*said, f"  the table of odds says nothing here: {found.beyond}"]
    for name, chance in found.chances.items():
        said.append(f"  evader {name}: {ends(chance)}")
    said.append(f"  (pursuers {table().pursuers}; 95 % intervals of the fit) What would change it:")
    said += [f"    {one.words}: captured {share(one.captured)}" for one in found.changes]
    return said


def ends(chance: Chances) -> str:
    """How such games end."""
    return f"captured {share(chance.captured)}, arrived {share(chance.arrived)}"
