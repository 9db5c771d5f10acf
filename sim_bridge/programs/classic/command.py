"""What `sim-bridge classic` prints: the list of problems, or one with its value and what strategies reach."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import distance
from onboard.runtime.progress import Progress
from sim_bridge.classic.play import ASIDES, Scene
from sim_bridge.classic.problem import Problem
from sim_bridge.classic.problems import PROBLEMS, problem_named, start_of
from sim_bridge.programs.classic.measure import Row, measured, starts_near

STARTS = 20
HEADINGS = ("side", "strategy", "won of its games", "value", "reached", "difference (95 %)", "share (95 %)")


class Options(NamedTuple):
    """What `classic` can be told."""

    file: Path | None = None  # a start of one's own, in the form of the shipped scenario
    strategies: tuple[str, ...] = ()  # none: the problem's
    starts: int = STARTS
    seed: int = 1
    feints: bool = False  # opponents that begin aside of optimal play, too
    json: bool = False
    picture: Path | None = None


def listed(json: bool) -> str:
    """All problems, a line each: name, value of the shipped start, what it is."""
    found = [(one, one.value(start_of(one))) for one in PROBLEMS.values()]
    if json:
        return "\n".join(_told(one, value) for one, value in found)
    rows = [
        (one.name, _number(value, one), f"{one.payoff}: {one.title}; {one.reference}") for one, value in found
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(2)]
    return "\n".join(f"{a:<{widths[0]}}  {b:>{widths[1]}}  {c}" for a, b, c in rows)


def refuse_without_problem(options: Options) -> None:
    """Demand that what only one problem can use was not given without one. Raises ConfigError."""
    plain = Options(json=options.json)
    for name in ("file", "strategies", "starts", "seed", "feints", "picture"):
        if getattr(options, name) != getattr(plain, name):
            option = "--strategy" if name == "strategies" else f"--{name}"
            raise ConfigError(f"{option}: found without a problem, expected one: {', '.join(PROBLEMS)}")


def _told(problem: Problem, value: float) -> str:
    found = {
        "problem": problem.name, "title": problem.title, "rule": problem.rule, "reference": problem.reference,
        "payoff": problem.payoff, "unit": problem.unit, "value": value, "bench": not problem.left_out,
    }  # fmt: skip
    return msgspec.json.encode(found).decode()


def classic(name: str, options: Options) -> str:
    """One problem, played. Raises ConfigError."""
    problem = problem_named(name)
    start = start_of(problem, options.file)
    if options.picture is not None:
        from sim_bridge.programs.classic import picture

        picture.check(options.picture)
    with Progress("sim-bridge") as progress:
        starts = starts_near(problem, start, options.starts, options.seed)
        rows = measured(problem, starts, options.strategies, options.feints, progress.show)
    if options.picture is not None:
        picture.draw(problem, start, options.picture)
    if options.json:
        return "\n".join(msgspec.json.encode(row).decode() for row in rows)
    lines = [*_head(problem, start), "", *table(problem, rows), "", f"Where ours fall short: {problem.why}."]
    if options.feints:
        lines.append(
            f"The worst of {1 + len(ASIDES)} games a start: optimal opponents, and such that begin aside."
        )
    if problem.left_out:
        lines.append(f"Not played by `bench`: {problem.left_out}.")
    if options.picture is not None:
        lines.append(f"drawn: {options.picture}")
    return "\n".join(lines)


def _head(problem: Problem, start: Scene) -> list[str]:
    value = problem.value(start)
    side = "the pursuers'" if problem.won(start, value) else "the evader's"
    speeds = ", ".join(f"{p.speed:g}" for p in start.pursuers)
    near = min(distance(p.position, start.evader.position) for p in start.pursuers)
    return [
        f"{problem.title}: {problem.rule}",
        f"{problem.reference}",
        f"evader {start.evader.speed:g} m/s, pursuers {speeds} m/s, the nearest {near:.0f} m away",
        f"value, {problem.payoff}: {_number(value, problem)}; the game is {side}",
    ]


def _number(value: float, problem: Problem) -> str:
    digits = 1 if problem.unit else 0
    return f"{value:.{digits}f} {problem.unit}".strip()


def table(problem: Problem, rows: Sequence[Row]) -> list[str]:
    """Lines for a terminal: a row a strategy, each side against the other's optimal play."""
    cells = [HEADINGS]
    cells += [(row.side, row.strategy, won_of(row), *figures(problem, row)) for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(7)]
    padded = ([cell.ljust(width) for cell, width in zip(line, widths, strict=True)] for line in cells)
    return ["  ".join(line).rstrip() for line in padded]


def won_of(row: Row) -> str:
    """How many of the games that theory gives a side it won, with the interval."""
    if row.games == 0:
        return "–"
    return f"{row.won} of {row.games} ({100 * row.won_low:.0f}–{100 * row.won_high:.0f} %)"


def figures(problem: Problem, row: Row) -> tuple[str, str, str, str]:
    """Mean value, mean payoff, their difference with its interval, and the share with its."""
    share = "–"
    if row.share is not None and row.share_low is not None and row.share_high is not None:
        share = f"{100 * row.share:.0f} % ({100 * row.share_low:.0f}–{100 * row.share_high:.0f})"
    unit = f" {problem.unit}" if problem.unit else ""
    gap, low, high = (round(x, 1) + 0.0 for x in (row.difference, row.difference_low, row.difference_high))
    gaps = f"{gap:+.1f}{unit} ({low:+.1f} … {high:+.1f})"
    return f"{row.value:.1f}{unit}", f"{row.reached:.1f}{unit}", gaps, share
