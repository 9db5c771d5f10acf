"""The tables of docs/gym.md: `python -m sim_bridge.gym.describe` prints them."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable

from onboard.core.strategy.features import (
    ACTIONS,
    EVADER_SEES,
    PURSUER_SEES,
    Axes,
    Form,
    Row,
    Steering,
    evader_width,
    pursuer_width,
)
from sim_bridge.gym.exchange import Rewards
from sim_bridge.gym.task import Wish


def described() -> str:
    """Observations, actions, rewards and keywords in Markdown."""
    plane = Form(Axes.NED, Steering.HEADING, True, 1.0, 1.0)
    space = plane._replace(planar=False)
    sizes = f"{pursuer_width(plane)} in the plane, {pursuer_width(space)} in space"
    each = f"{evader_width(plane, 0)} + 4 n in the plane, {evader_width(space, 0)} + 6 n in space, n pursuers"
    return "\n".join((
        f"A pursuer sees ({sizes}):\n", _sees(PURSUER_SEES),
        f"\nThe evader sees ({each}):\n", _sees(EVADER_SEES),
        "\nActions, each number from −1 to 1:\n", _table(("`actions=`", "what it says"), _actions()),
        "\nRewards, `Rewards(outcome=…, …)`:\n", _table(("weight", "default", "of"), _fields(Rewards)),
        "\nKeywords of every environment:\n", _table(("keyword", "default", "what it is"), _fields(Wish)),
        "",
    ))  # fmt: skip


def _sees(rows: Iterable[Row]) -> str:
    return _table(
        ("numbers", "unit", "times"),
        ((row.what, row.unit, "axes, for each pursuer in turn" if row.each else "axes") for row in rows),
    )


def _actions() -> Iterable[tuple[str, ...]]:
    return ((f"`{kind.name.lower()}`", words) for kind, words in ACTIONS.items())


def _fields(kind: type) -> Iterable[tuple[str, ...]]:
    """A structure's fields with their defaults and the words behind them."""
    lines = inspect.getsource(kind).splitlines()
    for node in ast.parse("\n".join(lines)).body[0].body:  # type: ignore[attr-defined]
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            words = lines[node.lineno - 1].partition("  # ")[2]
            yield f"`{ast.unparse(node.target)}`", f"`{ast.unparse(node.value)}`", words


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


if __name__ == "__main__":
    print(described())
