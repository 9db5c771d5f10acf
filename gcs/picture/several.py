"""Whose target is where, who is after whom, and how it ended for each: from the messages of a game. Pure.

With one evader there is nothing to tell apart: its target may be told before its id is, and nobody is said
to be after it, for everybody is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from gcs.picture.values import FateView, GoalView
from onboard.game import sides
from onboard.game.scenario import Scenario, targets_of
from onboard.wire.bus.messages import (
    EvaderBrief,
    Outcome,
    OutcomeResult,
    OwnBrief,
    PhaseChange,
    Setup,
    Triple,
)
from onboard.wire.bus.team_messages import TeamPlan


def goals(
    setup: Setup | None, brief: EvaderBrief | None, own: Mapping[int, OwnBrief]
) -> tuple[GoalView, ...]:
    """The targets by evader: of the briefs, where there are none those that pursuers know."""
    found: dict[int, tuple[Triple, ...]] = {}
    if setup is not None:
        found = {one.id: one.targets for one in setup.targets}
        if setup.target is not None and not found:
            found = {first_evader(setup): (setup.target,)}
    if brief is not None:
        told = brief.targets or (() if brief.target is None else (brief.target,))
        found[first_evader(setup)] = told
    found |= {id: one.targets for id, one in own.items()}
    return tuple(GoalView(evader=id, place=place) for id, told in sorted(found.items()) for place in told)


def planned(scenario: Scenario) -> tuple[GoalView, ...]:
    """The targets by evader, as a scenario has them; those of a plane game at the height of its flight."""
    down = -scenario.flight.height
    return tuple(
        GoalView(evader=id, place=(goal.x, goal.y, down if scenario.planar else goal.z))
        for id, spec in zip(scenario.evader_ids, scenario.evading, strict=True)
        for goal in targets_of(spec)
    )


def named(targets: tuple[GoalView, ...]) -> list[tuple[str, Triple]]:
    """Each target with its name for people: `target`; of several evaders `target of 12`, of one with several
    targets `target 2`, as the team's knowledge counts them."""
    by_evader = {goal.evader: [one.place for one in targets if one.evader == goal.evader] for goal in targets}
    found = []
    for evader, places in by_evader.items():
        whose = f" of {evader}" if len(by_evader) > 1 else ""
        for number, place in enumerate(places, 1):
            found.append((f"target{f' {number}' if len(places) > 1 else ''}{whose}", place))
    return found


def first_evader(setup: Setup | None) -> int:
    """The id of the first evader; 0 where there is no setup, or no evader in it."""
    return next(iter(evaders_of(setup)), 0)


def evaders_of(setup: Setup | None) -> tuple[int, ...]:
    """The ids of the evaders."""
    return () if setup is None else sides.evaders({member.id: member.role for member in setup.roster})


def quarries(
    setup: Setup | None, plan: TeamPlan | None, decided: Iterable[tuple[int, int]], known: Sequence[FateView]
) -> tuple[tuple[int, int], ...]:
    """Each pursuer with its quarry, where there are several evaders: as its decision says, else as the plan
    does. `decided` has ids and the quarries of decisions that are fresh (0: none). Nobody is after one that
    is `known` to be out."""
    if len(evaders_of(setup)) < 2:
        return ()
    found: dict[int, int] = {}
    if plan is not None and len(plan.quarries) == len(plan.parts):
        found = {part.id: quarry for part, quarry in zip(plan.parts, plan.quarries, strict=True)}
    found |= {id: quarry for id, quarry in decided if quarry}
    over = {fate.id for fate in known if fate.out} | {0}
    return tuple(sorted((id, quarry) for id, quarry in found.items() if quarry not in over))


def fates(setup: Setup | None, phase: PhaseChange | None, outcome: Outcome | None) -> tuple[FateView, ...]:
    """How it ended for each evader whose game is over."""
    found: dict[int, FateView] = {}
    for one in (*(phase.out if phase is not None else ()), *(outcome.evaders if outcome is not None else ())):
        found[one.id] = FateView(id=one.id, verdict=one.verdict, captor=one.captor, time_s=one.time)
    if outcome is not None and not outcome.evaders and (only := evaders_of(setup)):
        found[only[0]] = FateView(
            id=only[0], verdict=outcome.verdict, captor=outcome.captor, time_s=outcome.time
        )
    return tuple(found[id] for id in sorted(found))


def verdict_in_words(outcome: Outcome) -> str:
    """How a game ended: `evader captured by 3`; of several evaders `3 evaders: 2 captured, 1 arrived`."""
    if len(outcome.evaders) < 2:
        return f"evader {outcome.verdict.value}{f' by {outcome.captor}' if outcome.captor else ''}"
    counts = {verdict: sum(one.verdict is verdict for one in outcome.evaders) for verdict in OutcomeResult}
    told = ", ".join(f"{count} {verdict.value}" for verdict, count in counts.items() if count)
    return f"{len(outcome.evaders)} evaders: {told}"
