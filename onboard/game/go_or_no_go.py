"""The odds of an engagement in words: for `scenario check`, the console and `gcs assess`."""

from __future__ import annotations

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import scale
from onboard.core.strategy.team.plan_types import Heights, Member, Situation
from onboard.game.odds import Chances, Estimate, engagement, headline, odds, table
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


def share(p: Estimate) -> str:
    """`85 % (80–89)`."""
    return f"{100.0 * p.p:.0f} % ({100.0 * p.low:.0f}–{100.0 * p.high:.0f})"


def lines(s: Situation, beyond: str = "") -> list[str]:
    """What to expect of an engagement; the table says nothing where it is known to be `beyond` it."""
    found = odds(s, beyond=beyond)
    word, why = headline(s, found)
    said = [f"{word}: {why}"]
    if found.beyond:
        return [*said, f"  the table of odds says nothing here: {found.beyond}"]
    for name, chance in found.chances.items():
        said.append(f"  evader {name}: {ends(chance)}")
    said.append(
        f"  (pursuers {table().pursuers}; means over games from like starts, 95 % intervals; one may differ)"
    )
    if found.changes:
        said.append("  What would change it:")
    said += [f"    {one.words}: captured {share(one.captured)}" for one in found.changes]
    return said


def ends(chance: Chances) -> str:
    """How such games end."""
    return f"captured {share(chance.captured)}, arrived {share(chance.arrived)}"
