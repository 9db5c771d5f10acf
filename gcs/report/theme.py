"""What a report calls things: vehicles, rules and outcomes in words, and where a rule comes from."""

from __future__ import annotations

from typing import Any, NamedTuple

from gcs.picture.several import verdict_in_words
from gcs.picture.terminal_text import printable
from gcs.report.data import Run
from onboard.core.route.choice import CHOICE, ChoiceRule
from onboard.core.strategy.keep_out import KEEPS_OUT, Before
from onboard.core.strategy.knowledge import Rule
from onboard.core.strategy.registry import EVADERS, PURSUERS

ACTIONS = {
    "clip": "The supervisor sent the nearest velocity that is allowed instead of the one decided.",
    "hold": "The supervisor made the vehicle stay where it was: hover or loiter.",
    "return": "The supervisor made the autopilot fly home.",
    "land": "The supervisor made the autopilot land.",
    "end": "The supervisor ended the stream of setpoints; the autopilot flies alone.",
}


BLOCKED = "When every ray is blocked"


class Explained(NamedTuple):
    """A rule or action in words."""

    sentence: str
    source: str  # section of the paper, or what else it comes from


def words(name: str) -> str:
    """A rule's or key's name for a person."""
    return printable(name.replace("_", " ")).strip()


def glossary() -> dict[str, Explained]:
    """Every rule of the knowledge bases by its name in a recording, each with a sentence."""
    evasion: tuple[Rule[Any], ...] = tuple(rule for known in EVADERS.values() for rule in known.table)
    pursuit: tuple[Rule[Any], ...] = tuple(rule for known in PURSUERS.values() for rule in known.table)
    everything: tuple[Rule[Any] | ChoiceRule | Before, ...] = (*evasion, *pursuit, *KEEPS_OUT, *CHOICE)
    rules = {
        rule.id.name.lower(): Explained(f"When {rule.when}: {rule.then}.", rule.source) for rule in everything
    }
    others = {
        "fixed": Explained("Always: the one strategy that the configuration names.", "configuration"),
        "resultant_force": Explained(f"{BLOCKED} and there is no target: along F_res (21).", "3.4.1, rule 3"),
        "resultant_force_to_target": Explained(
            f"{BLOCKED} and there is a target: along F_res (22).", "3.4.1, rule 3"
        ),
    }
    return rules | others


def explained(rule: str) -> Explained:
    """What a rule says; a rule that no knowledge base here holds is said to be a plug-in's."""
    return glossary().get(rule, Explained("A rule of a strategy that this program does not hold.", "plug-in"))


def verdict(run: Run) -> str:
    """The outcome in one sentence."""
    outcome = run.outcome
    if outcome is None:
        told = run.summary.get("verdict") or run.summary.get("outcome")
        return f"Outcome: {told}" if isinstance(told, str) else "No outcome was recorded"
    if len(outcome.evaders) > 1:
        return f"{verdict_in_words(outcome)} after {outcome.time:.1f} s"
    who = f" by pursuer {outcome.captor}" if outcome.captor else ""
    return f"Evader {outcome.verdict.value}{who} after {outcome.time:.1f} s"


def clock(run: Run) -> str:
    """What the axis of time shows."""
    return f"{'virtual ' if run.virtual else ''}time since the start of the game [s]"
