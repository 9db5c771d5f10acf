"""The plan of a campaign: which games there are, and in which shards they lie.

A *cell* is a scenario with the values of a point of the sweep and a pair of strategies. Every cell is played
with the same seeds, so that games of two cells can be compared in pairs. Shards follow each other by seeds:
the first holds the first seeds of all cells (or of as many cells as fill it), and so on.
"""

from __future__ import annotations

from functools import cached_property
from hashlib import sha256
from typing import Any, NamedTuple

import msgspec

from onboard.config import strict
from onboard.config.strict import ConfigError, FieldError
from onboard.config.undecodable import UNDECODABLE
from onboard.game.scenario import Scenario
from sim_bridge.campaign.spatial_draw import Spread
from sim_bridge.campaign.spatial_fixed import demand_spatial
from sim_bridge.programs.campaigns.fingerprint import Fingerprint
from sim_bridge.programs.campaigns.sweep import Point, put, steps_of

FORMAT = 1
AS_WRITTEN = ""  # the strategies that the scenario names
SPREAD_SHARE = 0.15  # of the nearest pursuer's distance: by how much a seed moves the starts of simple motion
PLAYER_KEYS = frozenset(
    (
        "position",
        "speed",
        "speed_min",
        "speed_max",
        "pitch_min_deg",
        "pitch_max_deg",
        "yaw_min_deg",
        "yaw_max_deg",
        "turn_rate_deg",
        "heading_deg",
        "target",
        "targets",
    )
)
SPATIAL_FLIGHT = ("flight.wind.speed", "flight.wind.gust_sigma", "flight.wind.shear", "flight.airframe",
                  "flight.control_rate_hz", "flight.sensor.")  # fmt: skip
OF_THE_SEED = ("seed", "flight.wind.from_deg")
NOT_SWEPT = ("name", "description", "expect", "evader.strategy", "evaders.strategy", "pursuers.strategy")


class Chosen(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A scenario of a campaign: its short name and all its values."""

    label: str
    data: dict[str, Any]


class Pair(msgspec.Struct, frozen=True, forbid_unknown_fields=True, order=True):
    """The strategies of both sides, "" = those that the scenario names."""

    evader: str
    pursuers: str


class Cell(NamedTuple):
    """One kind of game."""

    number: int
    label: str  # of its scenario
    point: Point
    pair: Pair
    scenario: Scenario  # with the values and the strategies put in


class Shard(NamedTuple):
    """Which games lie in a file."""

    number: int
    cells: range
    seeds: range

    @property
    def games(self) -> int:
        """How many."""
        return len(self.cells) * len(self.seeds)


class Plan(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True, dict=True):
    """A campaign; what `manifest.json` holds."""

    format: int
    scenarios: list[Chosen]
    points: list[Point]
    pairs: list[Pair]
    first_seed: int
    games: int  # of each cell
    shard_games: int  # about so many in a shard
    flown: bool  # by the rehearsal of a whole flight, else computed
    fingerprint: Fingerprint

    @property
    def cell_count(self) -> int:
        """How many kinds of games."""
        return len(self.scenarios) * len(self.points) * len(self.pairs)

    def cell(self, number: int) -> Cell:
        """Cell `number`. Raises ConfigError where a value does not fit the scenario."""
        rest, pair = divmod(number, len(self.pairs))
        at, point = divmod(rest, len(self.points))
        chosen, values = self.scenarios[at], self.points[point]
        return Cell(number, chosen.label, values, self.pairs[pair],
                    scenario_of(chosen, values, self.pairs[pair]))  # fmt: skip

    def shards(self) -> list[Shard]:
        """All shards, in order."""
        step, group = self._steps
        return [self.shard(k) for k in range(-(-self.games // step) * -(-self.cell_count // group))]

    def shard(self, number: int) -> Shard:
        """Shard `number`, counted from 0."""
        step, group = self._steps
        block, part = divmod(number, -(-self.cell_count // group))
        first, end = self.first_seed + block * step, self.first_seed + self.games
        cells = range(part * group, min((part + 1) * group, self.cell_count))
        return Shard(number, cells, range(first, min(first + step, end)))

    @cached_property
    def _steps(self) -> tuple[int, int]:
        """How many seeds, and how many cells, a whole shard has."""
        step = min(self.games, max(1, -(-self.shard_games // self.cell_count)))
        return step, min(self.cell_count, max(1, self.shard_games // step))

    @cached_property
    def _hashes(self) -> list[str]:
        """SHA-256 of each scenario."""
        told = (msgspec.json.encode(chosen, order="deterministic") for chosen in self.scenarios)
        return [sha256(data).hexdigest() for data in told]

    def key(self, shard: Shard) -> str:
        """SHA-256 of all that the shard's contents follow from."""
        cells = [self._cell_key(number) for number in shard.cells]
        said = (FORMAT, self.fingerprint, self.flown, shard.seeds.start, len(shard.seeds), cells)
        return sha256(msgspec.json.encode(said, order="deterministic")).hexdigest()

    @cached_property
    def several(self) -> bool:
        """Whether a scenario has several evaders or targets: then rows tell of each evader."""
        return any("evaders" in one.data or "targets" in one.data["evader"] for one in self.scenarios)

    def _cell_key(self, number: int) -> tuple[Any, ...]:
        rest, pair = divmod(number, len(self.pairs))
        at, point = divmod(rest, len(self.points))
        return (number, self._hashes[at], self.points[point], self.pairs[pair])

    def parameters(self) -> list[str]:
        """The swept keys."""
        return list(self.points[0])


def chosen(label: str, scenario: Scenario) -> Chosen:
    """A scenario as a plan keeps it. Raises ConfigError for what a campaign cannot keep."""
    if scenario.flight.wind.recorded:
        found = scenario.flight.wind.recorded
        raise ConfigError(f"{label}: flight.wind.recorded: found {found!r}, expected a modelled wind")
    return Chosen(label, without_none(scenario.contents()))


def without_none(data: Any) -> Any:
    """Plain data without the keys that are not given."""
    if isinstance(data, dict):
        return {key: without_none(value) for key, value in data.items() if value is not None}
    return [without_none(entry) for entry in data] if isinstance(data, (list, tuple)) else data


def scenario_of(chosen: Chosen, point: Point, pair: Pair) -> Scenario:
    """A scenario with a point's values and a pair's strategies. Raises ConfigError."""
    data = msgspec.json.decode(msgspec.json.encode(chosen.data))
    for path, value in point.items():
        steps = steps_of(path)
        if steps is None or not put(data, steps, value):
            raise ConfigError(f"sweep of {chosen.label}: {path}: found no such key in the scenario")
    if pair.evader != AS_WRITTEN:
        for one in (data["evader"], *data.get("evaders", ())):
            one["strategy"] = pair.evader
    if pair.pursuers != AS_WRITTEN:
        for one in data["pursuers"]:
            one["strategy"] = pair.pursuers
    return strict.convert(data, Scenario, f"sweep of {chosen.label}" if point else chosen.label)


def is_spatial(scenario: Scenario) -> bool:
    """Whether the compiled game of aircraft in their wind plays it; else simple motion (7)–(8) does."""
    if scenario.several:
        return False
    return flies_as_aircraft(scenario)


def flies_as_aircraft(scenario: Scenario) -> bool:
    """Whether its vehicles are aircraft whose one-evader games would be played in their wind."""
    try:
        demand_spatial(scenario)
    except ConfigError:
        return False
    return not scenario.planar


def model(cell: Cell, flown: bool) -> str:
    """In what a cell's games are played, in words."""
    if flown:
        return "flown"
    return "aircraft in wind" if is_spatial(cell.scenario) else "simple motion"


def spread_of(scenario: Scenario) -> Spread:
    """By how much a seed moves the pursuers' starts: 300 m level and 60 m in height for aircraft, and a share
    of the nearest pursuer's distance for others."""
    if is_spatial(scenario):
        return Spread()
    evaders = [spec.start() for spec in scenario.evading]
    near = min(
        ((a.x - here.x) ** 2 + (a.y - here.y) ** 2 + (a.z - here.z) ** 2) ** 0.5
        for a in (spec.start() for spec in scenario.pursuers)
        for here in evaders
    )
    return Spread(SPREAD_SHARE * near, 0.2 * SPREAD_SHARE * near)


def demand_playable(plan: Plan) -> None:
    """Raise ConfigError for a cell that cannot be played, or a swept key that would change nothing."""
    for number in range(plan.cell_count):
        cell = plan.cell(number)
        for path in cell.point:
            why = _no_effect(path, cell, plan.flown)
            if why:
                raise ConfigError(f"sweep of {cell.label}: {path}: {why}")
        if not plan.flown and cell.scenario.several and flies_as_aircraft(cell.scenario):
            raise ConfigError(
                f"{cell.label}: evaders: found several in a game of aircraft in wind, which is not computed;"
                ' expected --flown, or flight.airframe = "kinematic" for simple motion'
            )
        if not plan.flown and not is_spatial(cell.scenario):
            names = {spec.strategy for spec in cell.scenario.pursuers}
            if len(names) > 1:
                raise ConfigError(
                    f"{cell.label}: pursuers.strategy: found {', '.join(sorted(names))}, expected one for"
                    " all in a game of simple motion: --pursuers, or --flown"
                )


def _no_effect(path: str, cell: Cell, flown: bool) -> str:
    """Why a swept key would change nothing, "" where it does."""
    plain = path.partition("[")[0] + path.partition("]")[2] if "[" in path else path
    if plain in NOT_SWEPT:
        return "found in a sweep, expected a number of the game (strategies are options)"
    if plain in OF_THE_SEED:
        return "found in a sweep, but the seed draws it"
    if flown:
        return "" if plain != "parameters.dt" else "found in a sweep of flights, which have no such step"
    table, _, key = plain.partition(".")
    if table in ("evader", "evaders", "pursuers"):
        return "" if key in PLAYER_KEYS else "found in a sweep of computed games, which know nothing of it"
    if is_spatial(cell.scenario):
        known = plain != "parameters.dt" if table == "parameters" else plain.startswith(SPATIAL_FLIGHT)
        return "" if known else "found in a sweep of aircraft in wind, which know nothing of it; see --flown"
    return "" if table == "parameters" else "found in a sweep of simple motion, which knows nothing of it"


def checked(data: bytes, name: str) -> Plan:
    """A manifest's plan. Raises ConfigError that begins with `name`."""
    try:
        plan = msgspec.json.decode(data, type=Plan)
    except (*UNDECODABLE, FieldError) as error:
        raise ConfigError(f"{name}: no manifest of a campaign: {error}") from None
    if plan.format != FORMAT:
        raise ConfigError(f"{name}: found format {plan.format}, expected {FORMAT}")
    return plan
