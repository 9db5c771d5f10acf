"""A run on the Earth: ways with instants, rules with places, for maps and globes.

Samples are taken at most `RATE_HZ` times a second: a map shows no more, and stays quick.
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from gcs.export.run_data import GEODETIC, RunData
from gcs.export.tables import Table
from onboard.config.strict import ConfigError
from onboard.game import palette, sides

RATE_HZ = 5.0
KINDS = {"states": "own states", "tracks": "tracks of a sensor", "truth": "true motion"}


class Spot(NamedTuple):
    """A place on Earth at an instant."""

    stamp_ns: int
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class Way(NamedTuple):
    """One vehicle's way, as one source knows it."""

    id: int
    name: str  # "pursuer 2", "pursuer 2, true motion"
    kind: str  # a key of KINDS
    colour: str  # #rrggbb
    spots: tuple[Spot, ...]


class Ruled(NamedTuple):
    """A rule in force for a while."""

    id: int
    rule: str
    begin_ns: int
    end_ns: int
    spot: Spot  # of the vehicle when it began
    words: str  # what was decided, sent and aimed at


def ways(data: RunData) -> list[Way]:
    """Every vehicle's ways, by kind. Raises ConfigError where the origin of the game frame is not known."""
    if data.origin is None:
        raise ConfigError(
            f"{data.folder}: found no origin of the game frame, expected one for places on Earth"
        )
    found, shades = [], sides.colours(data.roles)
    for kind, said in KINDS.items():
        given: Table = getattr(data, kind)
        for id in given.ids:
            name = data.called(id) if kind == "states" else f"{data.called(id)}, {said}"
            colour = shades.get(id, palette.FAINT).light
            found.append(Way(id, name, kind, colour, tuple(_spots(given.of(id)))))
    if not found:
        raise ConfigError(
            f"{data.folder}: found no place of any vehicle, expected states, tracks or true motion"
        )
    return found


def _spots(given: Table) -> Iterator[Spot]:
    next_ns = 0
    last = given.rows - 1
    columns = [given[name].tolist() for name in ("stamp_ns", *GEODETIC)]
    for number, spot in enumerate(map(Spot, *columns)):
        if spot.stamp_ns >= next_ns or number == last:
            next_ns = spot.stamp_ns + round(1e9 / RATE_HZ)
            yield spot


def ruled(data: RunData) -> list[Ruled]:
    """Each rule while it was in force, where its vehicle was then; nothing for vehicles without states."""
    found: list[Ruled] = []
    for id in data.decisions.ids:
        decisions, states, sent = data.decisions.of(id), data.states.of(id), data.setpoints.of(id)
        if not states.rows:
            continue
        rules, stamps = decisions["rule"].tolist(), decisions["stamp_ns"].tolist()
        starts = [row for row in range(len(rules)) if row == 0 or rules[row] != rules[row - 1]]
        for number, row in enumerate(starts):
            ends = starts[number + 1] if number + 1 < len(starts) else len(rules) - 1
            at = min(int(np.searchsorted(states["stamp_ns"], stamps[row])), states.rows - 1)
            spot = Spot(stamps[row], *(float(states[name][at]) for name in GEODETIC))
            found.append(Ruled(id, rules[row], stamps[row], stamps[ends], spot, _words(decisions, sent, row)))
    return found


def _words(decisions: Table, sent: Table, row: int) -> str:
    def three(given: Table, names: tuple[str, ...]) -> str:
        return ", ".join(f"{given[name][row]:.1f}" for name in names)

    setpoint = three(sent, ("v_north_m_s", "v_east_m_s", "v_down_m_s"))
    aim = three(decisions, ("aim_north_m", "aim_east_m", "aim_down_m"))
    supervisor = decisions["supervisor"][row]
    return (
        f"{decisions['strategy'][row]}, {decisions['level'][row]}, {decisions['module'][row]}; "
        f"setpoint {setpoint} m/s (north, east, down); aim {aim} m; supervisor {supervisor}"
    )


def iso(stamp_ns: int) -> str:
    """An instant as ISO 8601 in UTC, to the millisecond."""
    whole, rest = divmod(stamp_ns, 1_000_000_000)
    return f"{datetime.fromtimestamp(whole, UTC):%Y-%m-%dT%H:%M:%S}.{rest // 1_000_000:03d}Z"
