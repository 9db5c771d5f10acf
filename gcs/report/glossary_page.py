"""The glossary of rules, docs/rules.md: `python -m gcs.report.glossary_page` prints it.

The sentences are those of the knowledge bases, as the report has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gcs.report import theme
from onboard.core.route.choice import CHOICE
from onboard.core.strategy.keep_out import KEEPS_OUT
from onboard.core.strategy.registry import EVADERS, PURSUERS

HEAD = """# Rules and what they say

What console, report and recordings name as the rule in force, in words. Made from the knowledge bases by
`python -m gcs.report.glossary_page`. A rule that stands here under no strategy is a plug-in's own.
"""


def described() -> str:
    """The page, in Markdown."""
    parts = [HEAD]
    for title, known in (("The evader's", EVADERS), ("The pursuers'", PURSUERS)):
        parts += [f"\n## {title}\n\n", *_table(_used(known), "strategies")]
    zones: dict[str, list[str]] = {rule.id.name.lower(): [] for rule in KEEPS_OUT}
    parts += ["\n## Before every strategy, where there are zones\n\n", *_table(zones, "")]
    choice = {rule.id.name.lower(): ["route"] for rule in CHOICE} | {"fixed": ["route"]}
    parts += ["\n## Choice between the strategies of a route (3.6)\n\n", *_table(choice, "")]
    parts.append("\n## The supervisor's\n\n| action | what it says |\n|---|---|\n")
    parts += [f"| `{action}` | {said} |\n" for action, said in theme.ACTIONS.items()]
    return "".join(parts)


def _used(known: Mapping[str, Any]) -> dict[str, list[str]]:
    """The rules of knowledge bases, each with the strategies that have it."""
    found: dict[str, list[str]] = {}
    for strategy, named in known.items():
        for rule in named.table:
            name = rule.id.name.lower()
            names = [f"{name}_to_target", name] if name == "resultant_force" else [name]
            for one in names:
                found.setdefault(one, []).append(strategy)
    return found


def _table(rules: Mapping[str, list[str]], last: str) -> list[str]:
    more, line = (f" {last} |", "---|") if last else ("", "")
    head = f"| rule | what it says | source |{more}\n|---|---|---|{line}\n"
    rows = []
    for rule, strategies in rules.items():
        said = theme.explained(rule)
        more = f" {', '.join(dict.fromkeys(strategies))} |" if last else ""
        rows.append(f"| `{rule}` | {said.sentence} | {said.source} |{more}\n")
    return [head, *rows]


if __name__ == "__main__":
    print(described(), end="")
