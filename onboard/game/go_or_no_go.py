"""The odds of an engagement in words: for `scenario check`, the console and `gcs assess`."""

from __future__ import annotations

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, distance, scale
from onboard.core.strategy.team.plan_types import NOBODY, Heights, Member, Situation
from onboard.core.strategy.team.quarry import Quarry, quarries_of
from onboard.game.odds import Chances, Estimate, engagement, headline, odds, one_each, table
from onboard.game.scenario import Scenario, targets_of
from onboard.game.staging import places_of, start_headings


def engagement_of(scenario: Scenario) -> Situation:
    """A scenario of one evader at its start; of several the first evader's, as `engagements` has it."""
    return next(iter(engagements(scenario).values()))


def engagements(scenario: Scenario) -> dict[int, Situation]:
    """The engagement of each evader at the start, by id: to the target nearest to it, against those who go
    for it first; against all pursuers where nobody does, or where there is one evader."""
    members = {
        id: Member(Vehicle(place, scale(heading, spec.speed), spec.speed), spec.limits(), True)
        for id, spec, place, heading in zip(
            scenario.ids, scenario.vehicles, places_of(scenario), start_headings(scenario), strict=True
        )
    }
    fence, sigma = scenario.flight.fence, scenario.flight.sensor.sigma
    heights = Heights() if fence is None else Heights(fence.height_min, fence.height_max)
    evaders, rules = scenario.evader_ids, scenario.rules
    goals = {
        id: _nearest(targets_of(spec), members[id])
        for id, spec in zip(evaders, scenario.evading, strict=True)
    }
    team = tuple(members[id] for id in scenario.pursuer_ids)
    given = (0,) * len(team)
    if len(evaders) > 1:
        quarries = tuple(Quarry(members[id].vehicle, members[id].limits, True, goals[id]) for id in evaders)
        given = quarries_of(team, quarries, (NOBODY,) * len(team), rules, rules.horizon)
    return {
        id: engagement(
            members[id], tuple(m for m, quarry in zip(team, given, strict=True) if quarry == number) or team,
            goals[id], rules, heights, sigma,
        )
        for number, id in enumerate(evaders)
    }  # fmt: skip


def beyond_one(scenario: Scenario, evader: int) -> str:
    """Why the table of odds says nothing of an evader's game; "" where it has one evader with one target."""
    spec = scenario.evading[scenario.evader_ids.index(evader)]
    return one_each(len(scenario.evading), len(targets_of(spec)))


def _nearest(goals: tuple[Vec, ...], evader: Member) -> Target:
    place = evader.vehicle.position
    found = min(goals, key=lambda goal: distance(goal, place), default=None)
    return NO_TARGET if found is None else Target(True, found)


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
