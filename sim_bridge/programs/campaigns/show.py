"""What a campaign's games say: a table with Wilson's intervals, and McNemar's tests of paired games."""

from __future__ import annotations

from math import isnan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import pursuer_named
from sim_bridge.campaign.spatial_campaign import mcnemar
from sim_bridge.programs.campaigns import shards
from sim_bridge.programs.campaigns.plan import Plan, model
from sim_bridge.programs.campaigns.until import wilson

VERDICTS = ("captured", "arrived", "denied", "escaped")


class Each(NamedTuple):
    """The games of a cell as one of several evaders had them."""

    id: int
    verdicts: NDArray[Any]
    times: NDArray[np.float64]  # of the verdicts [s]


class Games(NamedTuple):
    """The games of a cell, in the order of their seeds."""

    cell: int
    what: tuple[str, ...]  # scenario, swept values, evader, pursuers, model
    seeds: NDArray[np.int64]
    verdicts: NDArray[Any]
    times: NDArray[np.float64]  # [s]
    smallest: NDArray[np.float64]  # [m]
    each: tuple[Each, ...] = ()  # of several evaders

    def share(self, verdict: str) -> tuple[int, float, float]:
        """How many had the verdict, and Wilson's 95 % interval of its share."""
        return share_of(self.verdicts, verdict)

    def captured(self) -> NDArray[np.bool_]:
        """Game by game."""
        return np.asarray(self.verdicts == "captured", dtype=np.bool_)


class Results(NamedTuple):
    """A campaign's games as they lie in its folder."""

    plan: Plan
    cells: list[Games]
    missing: int  # shards
    notes: list[str]  # on files that do not count


def share_of(verdicts: NDArray[Any], verdict: str) -> tuple[int, float, float]:
    """How often a verdict is among these, and Wilson's 95 % interval of its share."""
    count = int(np.sum(verdicts == verdict))
    return (count, *wilson(count, len(verdicts)))


def results(folder: Path) -> Results:
    """Read a campaign's folder. Raises ConfigError where it is none, or holds no game yet."""
    plan = shards.read_plan(folder)
    found = shards.find(folder, plan)
    notes = [f"{path}: broken; the campaign's command plays it again" for path in found.broken]
    notes += [f"{path}: no shard of this campaign; left out" for path in found.strange]
    if not found.whole:
        raise ConfigError(f"{folder}: found no whole shard, expected one or more")
    table = shards.table_of(found.whole[number] for number in sorted(found.whole)).sort_by(
        [("cell", "ascending"), ("seed", "ascending")]
    )
    numbers = table["cell"].to_numpy()
    columns = {name: table[name].to_numpy() for name in ("seed", "time", "smallest")}
    verdicts = np.array(table["verdict"].to_pylist(), dtype=object)
    listed = table["evaders"].to_pylist() if plan.several else []
    cells = []
    for number in dict.fromkeys(numbers.tolist()):
        rows = slice(*np.searchsorted(numbers, [number, number + 1]))
        cells.append(
            Games(number, _what(plan, number), columns["seed"][rows], verdicts[rows], columns["time"][rows],
                  columns["smallest"][rows], _each(plan, number, listed[rows]))
        )  # fmt: skip
    return Results(plan, cells, len(plan.shards()) - len(found.whole), notes)


def _what(plan: Plan, number: int) -> tuple[str, ...]:
    cell = plan.cell(number)
    pursuers = sorted({pursuer_named(spec.strategy) for spec in cell.scenario.pursuers})
    values = tuple(
        f"{value:.4g}" if isinstance(value, float) else str(value) for value in cell.point.values()
    )
    return (cell.label, *values, shards.evaders_in(cell), "+".join(pursuers), model(cell, plan.flown))


def _each(plan: Plan, number: int, listed: list[Any]) -> tuple[Each, ...]:
    """Of a cell of several evaders each one's games."""
    scenario = plan.cell(number).scenario
    if not scenario.several:
        return ()
    return tuple(
        Each(
            id,
            np.array([game[k]["verdict"] for game in listed], dtype=object),
            np.array([game[k]["time"] for game in listed], dtype=float),
        )
        for k, id in enumerate(scenario.evader_ids)
    )


def table(found: Results) -> str:
    """A line a cell."""
    head = ("cell", "scenario", *found.plan.parameters(), "evader", "pursuers", "played as", "games",
            "captured", "arrived", "denied", "escaped", "time to capture", "to arrival",
            "median smallest")  # fmt: skip
    rows: list[tuple[str, ...]] = [head]
    for one in found.cells:
        games, captured, arrived = len(one.seeds), one.share("captured"), one.share("arrived")
        rows.append(
            (str(one.cell), *one.what, str(games), _share(captured, games), _share(arrived, games),
             str(one.share("denied")[0]), str(one.share("escaped")[0]),
             *("–" if one.each else _mean(one.verdicts, one.times, word) for word in ("captured", "arrived")),
             _metres(one.smallest))
        )  # fmt: skip
    return _columns(rows)


def _columns(rows: list[tuple[str, ...]]) -> str:
    """Rows as text, the first as head."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = [
        "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
    return "\n".join([lines[0], "  ".join("-" * width for width in widths), *lines[1:]])


def evaders_table(found: Results) -> str:
    """Of games of several evaders a line for each evader, and one for all of a cell; "" where there are none.

    Evaders of one game are not independent: the interval of all takes them as if they were.
    """
    rows: list[tuple[str, ...]] = [
        ("cell", "evader", "games", *VERDICTS, "time to capture", "to arrival")
    ]
    for one in found.cells:
        lines = [(str(each.id), each.verdicts, each.times) for each in one.each]
        if len(lines) > 1:
            everybody = np.concatenate([v for _, v, _ in lines])
            lines.append(("all", everybody, np.concatenate([t for *_, t in lines])))
        for who, verdicts, times in lines:
            shares = (_share(share_of(verdicts, word), len(verdicts)) for word in VERDICTS)
            means = (_mean(verdicts, times, word) for word in ("captured", "arrived"))
            rows.append((str(one.cell), who, str(len(verdicts)), *shares, *means))
    return _columns(rows) if len(rows) > 1 else ""


def _share(found: tuple[int, float, float], games: int) -> str:
    count, low, high = found
    return f"{count} = {100 * count / games:.1f} % ({100 * low:.1f}–{100 * high:.1f})"


def _mean(verdicts: NDArray[Any], times: NDArray[np.float64], verdict: str) -> str:
    found = times[verdicts == verdict]
    return f"{float(np.mean(found)):.1f} s" if len(found) else "–"


def _metres(values: NDArray[np.float64]) -> str:
    known = values[~np.isnan(values)]
    middle = float(np.median(known)) if len(known) else float("nan")
    return "–" if isnan(middle) else f"{middle:.1f} m"


class Paired(NamedTuple):
    """Two cells that differ in a strategy alone, over the same seeds."""

    first: Games
    second: Games
    only_first: int  # captured in the first alone
    only_second: int
    p_value: float  # of McNemar's exact test, two-sided

    @property
    def games(self) -> int:
        """Pairs."""
        return len(np.intersect1d(self.first.seeds, self.second.seeds))


def paired(found: Results) -> list[Paired]:
    """Every cell against the first of the same scenario and values."""
    by_place: dict[int, list[Games]] = {}
    for one in found.cells:
        by_place.setdefault(one.cell // len(found.plan.pairs), []).append(one)
    tests = []
    for first, *others in by_place.values():
        for second in others:
            _seeds, a, b = np.intersect1d(first.seeds, second.seeds, return_indices=True)
            mine, theirs = first.captured()[a], second.captured()[b]
            only = int(np.sum(mine & ~theirs)), int(np.sum(theirs & ~mine))
            tests.append(Paired(first, second, *only, mcnemar(*only)))
    return tests


def pairs_text(found: Results) -> str:
    """The paired tests in words, "" where there are none."""
    lines = [
        f"cells {t.first.cell} and {t.second.cell}: of the same {t.games} games {t.only_first} were captured"
        f" in {t.first.cell} only and {t.only_second} in {t.second.cell} only (McNemar, exact: p ="
        f" {t.p_value:.1e})"
        for t in paired(found)
    ]
    return "\n".join(lines)


def text(found: Results) -> str:
    """All that `show` tells."""
    parts = [table(found), evaders_table(found), pairs_text(found)]
    if found.missing:
        parts.append(f"{found.missing} of {len(found.plan.shards())} shards are missing")
    return "\n\n".join(part for part in parts if part)
