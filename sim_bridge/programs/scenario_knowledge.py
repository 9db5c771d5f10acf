"""What a scenario's pursuers know as a team, and what they are after: for `sim-bridge scenario check`."""

from __future__ import annotations

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.game.views import told
from onboard.core.math.vectors import ZERO
from onboard.core.strategy.semantic.graph import strength_of
from onboard.core.strategy.semantic.relations import COVERS
from onboard.core.strategy.team.plan_types import Member, Situation
from onboard.game.knowledge_words import Known, known_of, worth_saying
from onboard.game.scenario import Scenario
from onboard.game.team_knowledge import TEAM, is_team, model
from onboard.game.vehicle_spec import targets_of
from sim_bridge.plane_game.setup import (
    heights_of,
    margin_of,
    nearest_of,
    turn_rate_of,
    vehicles_of,
)


def knowledge_of(scenario: Scenario, number: int, whole: bool) -> Known:
    """What the pursuers know at the start of the game against evader `number` of `scenario.evading`.

    `whole` takes its targets as known even where the rules hide them.
    """
    vehicles, count, rules = vehicles_of(scenario), len(scenario.pursuers), scenario.rules
    place = number if number == 0 else count + number
    evader, spec = vehicles[place], scenario.vehicles[place]
    team = tuple(
        Member(vehicles[k], scenario.vehicles[k].limits()._replace(turn_rate=turn_rate_of(scenario, k)), True)
        for k in range(1, count + 1)
    )
    targets = tuple(Target(True, one) for one in targets_of(spec)) or (NO_TARGET,)
    if not whole:
        targets = tuple(told(one, rules) for one in targets)
    limits = spec.limits()._replace(turn_rate=turn_rate_of(scenario, place))
    s = Situation(
        0.0, 0.0, evader, limits, team, targets[0], ZERO, rules, heights_of(scenario), margin_of(scenario),
        evader.position, nearest_of(scenario), targets,
    )  # fmt: skip
    name = next((one.strategy for one in scenario.pursuers if is_team(one.strategy)), TEAM)
    return known_of(s, None, model(name), scenario.ids[place], scenario.pursuer_ids)


def denies(scenario: Scenario) -> tuple[bool, ...]:
    """Whether each pursuer is at one of the first evader's targets before it: at all of it, where that is a
    disc that nobody keeps by standing in its middle."""
    known = knowledge_of(scenario, 0, whole=True)
    count = max(1, len(targets_of(scenario.evader)))
    pursuers = range(len(scenario.pursuers))
    return tuple(any(strength_of(known.edges, COVERS, i, k) > 0.0 for k in range(count)) for i in pursuers)


def knowledge_lines(scenario: Scenario) -> list[str]:
    """For each evader what holds that is worth saying, and the goal of a team that knows it."""
    lines = []
    for number in range(len(scenario.evading)):
        known = knowledge_of(scenario, number, whole=False)
        about = f" of evader {known.evader}" if len(scenario.evading) > 1 else ""
        said = worth_saying(known)
        if targets_of(scenario.evading[number]) and not scenario.rules.target_known:
            said = ["not where it goes (parameters.target_known)", *said]
        lines += [f"what a team knows{about}: {said[0]}", *(f"  {line}" for line in said[1:])]
    return lines
