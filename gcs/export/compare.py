"""`gcs compare RUN RUN`: what two runs were played with, how they went, where they part.

Times count from t₀ of each run. Ways are compared by the vehicles' own states, at instants that both know.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from gcs.export.run_data import PLACE, RunData, load
from onboard.game import sides
from onboard.wire.bus.messages import Role

NESTED = (Mapping, list, tuple)
PARTED_M = 1.0  # ways farther apart than this have parted
STEP_S = 0.1
FOLLOWS = frozenset(("id", "strategy", "speed_max", "rho"))  # a scenario may leave these to their defaults
FIGURES = ("evader", "captured by", "after [s]", "smallest distance [m]")


class Row(NamedTuple):
    """One line of the comparison: the same where both are equal."""

    what: str
    first: str
    second: str

    @property
    def same(self) -> bool:
        """Whether both runs say the same."""
        return self.first == self.second


class Comparison(NamedTuple):
    """Two runs beside each other."""

    names: tuple[str, str]
    played: tuple[Row, ...]  # keys of the scenario that differ
    figures: tuple[Row, ...]  # the outcome, and each pursuer's nearest distance
    ways: tuple[str, ...]  # a line for each vehicle that both have
    rules: tuple[Row, ...]  # share of its decisions that each vehicle's rules had
    notes: tuple[str, ...]

    def lines(self) -> list[str]:
        """For a person."""
        first, second = self.names
        found = [f"first:  {first}", f"second: {second}", ""]
        if self.played:
            found += ["played with:", *_table(self.played), ""]
        else:
            found += ["played with the same scenario and seed", ""]
        found += ["how it went:", *_table(self.figures), ""]
        found += ["ways, from t₀ on:", *(f"  {line}" for line in self.ways or ("no vehicle in both",)), ""]
        found += ["rules, share of decisions:", *_table(self.rules)]
        return [*found, *(f"note: {note}" for note in self.notes)]


def _table(rows: tuple[Row, ...]) -> list[str]:
    wide = [max(len(row[column]) for row in rows) for column in range(3)] if rows else [0, 0, 0]
    return [
        f"  {row.what:<{wide[0]}}  {row.first:>{wide[1]}}  {row.second:>{wide[2]}}{'' if row.same else '  ≠'}"
        for row in rows
    ]


def compare(first: Path, second: Path) -> Comparison:
    """Two run folders, or recordings. Raises ConfigError."""
    a, b = load(first), load(second)
    return Comparison(
        (str(first), str(second)),
        tuple(_played(a, b)),
        tuple(_figures(a, b)),
        tuple(_ways(a, b)),
        tuple(_rules(a, b)),
        (*(f"first: {note}" for note in a.notes), *(f"second: {note}" for note in b.notes)),
    )


def _played(a: RunData, b: RunData) -> Iterator[Row]:
    scenarios = a.scenario is not None and b.scenario is not None
    flat = [dict(_flat(msgspec.to_builtins(data.scenario if scenarios else data.setup))) for data in (a, b)]
    for key in dict.fromkeys((*flat[0], *flat[1])):
        found = [one.get(key) for one in flat]
        if key.rpartition(".")[2] in FOLLOWS and any(value in (None, "") for value in found):
            continue  # left to what follows from other keys
        row = Row(key, *("–" if value in (None, "") else str(value) for value in found))
        if not row.same:
            yield row


def _flat(value: Any, at: str = "") -> Iterator[tuple[str, Any]]:
    """Every single value of nested data with its key, `flight.sensor.sigma`."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _flat(inner, f"{at}.{key}" if at else str(key))
    elif isinstance(value, (list, tuple)) and any(isinstance(inner, NESTED) for inner in value):
        for index, inner in enumerate(value):
            yield from _flat(inner, f"{at}[{index}]")
    else:
        yield at, value


def _figures(a: RunData, b: RunData) -> Iterator[Row]:
    told = []
    for data in (a, b):
        outcome = data.outcome
        if outcome is None:
            told.append(("no outcome", "–", "–", "–"))
            continue
        captor = str(outcome.captor) if outcome.captor else "–"
        distance = outcome.smallest_distance
        near = f"{distance:.2f}" if 0.0 <= distance < 1e9 else "–"
        told.append((outcome.verdict.value, captor, f"{outcome.time:.1f}", near))
    yield from map(Row, FIGURES, *told)
    several = sorted({fate.id for data in (a, b) for fate in data.fates if len(data.fates) > 1})
    for id in several:
        yield Row(f"evader {id}", _fate(a, id), _fate(b, id))
    for id in sorted(set(a.states.ids) | set(b.states.ids)):
        if Role.PURSUER in (a.roles.get(id), b.roles.get(id)):
            yield Row(f"pursuer {id} nearest [m]", _nearest(a, id), _nearest(b, id))


def _fate(data: RunData, evader: int) -> str:
    return next((fate.words for fate in data.fates if fate.id == evader), "–")


def _nearest(data: RunData, id: int) -> str:
    """A pursuer's smallest distance to an evader within that one's game."""
    found = [
        near for evader in sides.evaders(data.roles) if (near := _nearest_to(data, id, evader)) is not None
    ]
    return f"{min(found):.2f}" if found else "–"


def _nearest_to(data: RunData, id: int, evader: int) -> float | None:
    there, here = _way(data, evader), _way(data, id)
    if there is None or here is None:
        return None
    end = next((fate.time_s for fate in data.fates if fate.id == evader), np.inf)
    t = _common(there[0], here[0])
    t = t[(t >= 0.0) & (t <= end)]
    if not len(t):
        return None
    apart = _at(t, there) - _at(t, here)
    if data.setup is not None and data.setup.flat:
        apart = apart[:, :2]
    return float(np.linalg.norm(apart, axis=1).min())


Way = tuple[NDArray[np.float64], NDArray[np.float64]]  # instants (n,) [s], places (n, 3) [m; NED]


def _way(data: RunData, id: int) -> Way | None:
    states = data.states.of(id)
    if states.rows < 2:
        return None
    return states["t_s"], np.column_stack([states[axis] for axis in PLACE])


def _common(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Instants that both know, `STEP_S` apart [s]."""
    first, last = max(a[0], b[0]), min(a[-1], b[-1])
    return np.arange(np.ceil(first / STEP_S) * STEP_S, last, STEP_S)


def _at(t: NDArray[np.float64], way: Way) -> NDArray[np.float64]:
    return np.column_stack([np.interp(t, way[0], way[1][:, axis]) for axis in range(3)])


def _ways(a: RunData, b: RunData) -> Iterator[str]:
    for id in sorted(set(a.states.ids) & set(b.states.ids)):
        first, second = _way(a, id), _way(b, id)
        if first is None or second is None:
            continue
        t = _common(first[0], second[0])
        t = t[t >= 0.0]
        if not len(t):
            yield f"{a.called(id)}: no instant after t₀ in both"
            continue
        apart = np.linalg.norm(_at(t, first) - _at(t, second), axis=1)
        parted = np.flatnonzero(apart > PARTED_M)
        when = f", more than {PARTED_M:g} m from {t[parted[0]]:.1f} s on" if len(parted) else ""
        yield f"{a.called(id)}: at most {apart.max():.2f} m apart{when}"


def _rules(a: RunData, b: RunData) -> Iterator[Row]:
    for id in sorted(set(a.decisions.ids) | set(b.decisions.ids)):
        shares = [_shares(data, id) for data in (a, b)]
        for rule in sorted(set(shares[0]) | set(shares[1])):
            told = [f"{share.get(rule, 0.0):.0%}" if share else "–" for share in shares]
            yield Row(f"{(a if shares[0] else b).called(id)}: {rule}", *told)


def _shares(data: RunData, id: int) -> dict[str, float]:
    rules = data.decisions.of(id)["rule"]
    names, counts = np.unique(rules, return_counts=True)
    return {str(name): count / len(rules) for name, count in zip(names, counts, strict=True)}
