"""What a report shows, as values: read from a run folder's recording, or from its logs where there is none.

Times are seconds since t₀ (since the first message where no game was started). Positions are in the game
frame (north, east, down) [m]; arrays have one row per sample.
"""

from __future__ import annotations

import json
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gcs.picture.several import named
from gcs.picture.values import Alert, CommandView, FateView, GoalView, LogLine
from onboard.config.strict import ConfigError
from onboard.game import palette, sides
from onboard.game import scenario as scenarios
from onboard.game.scenario import Scenario
from onboard.wire.bus.messages import Fence, Member, Outcome, Role, Setup, Triple, Zone

Array = NDArray[np.float64]
MOST_POINTS = 4000  # a vehicle's samples are thinned to so many


class Flown(NamedTuple):
    """Where one vehicle flew, how fast, and how this is known. One row of each array is one sample."""

    id: int
    role: Role
    source: str  # state | track | tlog
    t: Array  # (n,) [s]
    position: Array  # (n, 3) [m; NED]
    velocity: Array  # (n, 3) [m/s; ground, NED]
    airspeed: Array  # (n,) [m/s], NaN where unknown
    wind: Array  # (n, 3) [m/s; where the air moves to], NaN where unknown
    latency: Array  # (n,) [s] from the stamp to arrival at the station, NaN where unknown

    def at(self, t: Array) -> Array:
        """(m, 3) its places at these instants, between its samples on straight lines [m; NED]."""
        return np.column_stack([np.interp(t, self.t, self.position[:, axis]) for axis in range(3)])

    @property
    def groundspeed(self) -> Array:
        """(n,) [m/s] over ground, vertical part included."""
        speed: Array = np.linalg.norm(self.velocity, axis=1)
        return speed


class Link(NamedTuple):
    """One vehicle's health over time; rows (n,)."""

    t: Array
    quality: Array  # 0…1
    battery: Array  # 0…1, NaN where unknown


class Band(NamedTuple):
    """A rule in force for a while."""

    start: float
    end: float
    rule: str
    why: str  # module, supervisor's words


class Gap(NamedTuple):
    """Distance between a pursuer and the evader, of several the nearest one in the game."""

    id: int
    t: Array  # (n,)
    distance: Array  # (n,) [m]


class Run(NamedTuple):
    """Everything of a run that a report shows."""

    name: str
    folder: Path
    notes: tuple[str, ...]  # what is missing or damaged, one line each
    scenario: Scenario | None
    setup: Setup | None
    targets: tuple[GoalView, ...]  # by evader
    outcome: Outcome | None
    fates: tuple[FateView, ...]  # how it ended for each evader, as far as it was said; by id
    phases: tuple[tuple[float, str], ...]
    flown: dict[int, Flown]  # by id
    links: dict[int, Link]
    rules: dict[int, tuple[Band, ...]]
    guards: dict[int, tuple[Band, ...]]  # when the supervisor acted, `rule` is what it did
    alerts: tuple[Alert, ...]  # in order
    commands: tuple[CommandView, ...]
    log: tuple[LogLine, ...]
    t0_ns: int
    summary: dict[str, Any]
    timing: dict[str, Any]

    @property
    def virtual(self) -> bool:
        """Whether the game was played on virtual time, which runs faster than the clock on the wall."""
        return "virtual_s" in self.timing

    def colour(self, vehicle: int) -> str:
        """A vehicle's colour on white paper, `#rrggbb`: the same in every report."""
        return sides.colours(self.roles).get(vehicle, palette.FAINT).light

    @property
    def roles(self) -> dict[int, Role | None]:
        """Everybody's role, by id: of those who flew and of the setup."""
        roster = self.setup.roster if self.setup is not None else ()
        return {**{m.id: m.role for m in roster}, **{f.id: f.role for f in self.flown.values()}}

    @property
    def evaders(self) -> tuple[Flown, ...]:
        """The evaders by id, as far as somebody saw them."""
        return tuple(self.flown[id] for id in sides.evaders(self.roles) if id in self.flown)

    def fate_of(self, evader: int) -> FateView | None:
        """How the game ended for an evader; None where nobody said so."""
        return next((fate for fate in self.fates if fate.id == evader), None)

    def end_of(self, evader: int) -> float:
        """When an evader's game ended [s]; infinite where nobody said so."""
        fate = self.fate_of(evader)
        return inf if fate is None else fate.time_s

    @property
    def capture_radius(self) -> float | None:
        """The capture radius R [m] of the setup, else of the scenario; None where neither is known."""
        if self.setup is not None:
            return float(self.setup.rules.R)
        return self.scenario.rules.R if self.scenario is not None else None

    @property
    def safety_distance(self) -> float | None:
        """The safety distance ρ [m] of the setup, else of the scenario; None where neither is known."""
        if self.setup is not None:
            return float(self.setup.rules.rho)
        return self.scenario.rules.rho if self.scenario is not None else None

    @property
    def fence(self) -> Fence | None:
        """The geofence of the setup; None where there is none."""
        return self.setup.fence if self.setup is not None else None

    @property
    def zones(self) -> tuple[Zone, ...]:
        """What everybody keeps out of."""
        return self.setup.zones if self.setup is not None else ()

    @property
    def flat(self) -> bool:
        """Whether distances are judged horizontally."""
        if self.setup is not None:
            return self.setup.flat
        return self.scenario is not None and (self.scenario.planar or self.scenario.flight.field_profile)

    @property
    def span(self) -> tuple[float, float]:
        """First and last instant of anything flown [s]."""
        times = [f.t for f in self.flown.values() if len(f.t)]
        return (min(t[0] for t in times), max(t[-1] for t in times)) if times else (0.0, 0.0)

    @property
    def extent(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """North and east limits [m] of all that was flown and of the target, with a margin."""
        places = [f.position[:, :2] for f in self.flown.values() if len(f.t)]
        places += [np.array([goal.place[:2]]) for goal in self.targets]
        all_places = np.concatenate(places) if places else np.zeros((1, 2))
        low, high = all_places.min(axis=0), all_places.max(axis=0)
        margin = max(5.0, 0.06 * float((high - low).max()))
        return (
            (float(low[0]) - margin, float(high[0]) + margin),
            (float(low[1]) - margin, float(high[1]) + margin),
        )

    def named_targets(self) -> list[tuple[str, Triple]]:
        """Each target with its name for people: `target`, of several evaders `target of 12`."""
        return named(self.targets)

    def gaps(self) -> tuple[Gap, ...]:
        """Distance of every pursuer to the evader over the time that both are known; of several evaders to
        the nearest one whose game is not over, after the game to the nearest one of all."""
        evaders = [evader for evader in self.evaders if len(evader.t) > 1]
        found = []
        for other in self.flown.values():
            if other.role is not Role.PURSUER or len(other.t) < 2 or not evaders:
                continue
            t = evaders[0].t if len(evaders) == 1 else other.t
            t = t[(t >= other.t[0]) & (t <= other.t[-1])]
            there = other.at(t)
            apart = np.stack([self._apart(there - evader.at(t), t, evader) for evader in evaders])
            over = np.stack([t > self.end_of(evader.id) for evader in evaders])
            apart = np.where(over & ~over.all(axis=0), np.inf, apart).min(axis=0)
            known = np.isfinite(apart)
            found.append(Gap(other.id, t[known], apart[known]))
        return tuple(found)

    def _apart(self, line: Array, t: Array, evader: Flown) -> Array:
        """Lengths of lines (n, 3) at the instants `t` to an evader, infinite while it is not known."""
        length = np.linalg.norm(line[:, :2] if self.flat else line, axis=1)
        return np.where((t >= evader.t[0]) & (t <= evader.t[-1]), length, np.inf)

    def playing(self, t: Array) -> NDArray[np.bool_]:
        """Which of these instants lie within the game: from t₀ to the outcome."""
        inside: NDArray[np.bool_] = t >= 0.0
        return inside if self.outcome is None else inside & (t <= self.outcome.time)

    def at_the_end(self, evader: Flown) -> int:
        """The sample nearest to the end of an evader's game; the last one where nobody said so."""
        end = self.end_of(evader.id)
        return len(evader.t) - 1 if end == inf else int(np.abs(evader.t - end).argmin())

    def rule_names(self) -> list[str]:
        """Every rule that was in force, in order of first appearance."""
        bands = sorted((b for found in self.rules.values() for b in found), key=lambda b: (b.start, b.rule))
        return list(dict.fromkeys(band.rule for band in bands))

    def action_names(self) -> list[str]:
        """Every action of the supervisor, in order of the alphabet."""
        return sorted({band.rule for bands in self.guards.values() for band in bands})

    def nearest(self) -> dict[int, float]:
        """The smallest distance of each pursuer to the evader within the game [m], by id."""
        found = {}
        for gap in self.gaps():
            inside = gap.distance[self.playing(gap.t)]
            if len(inside):
                found[gap.id] = float(inside.min())
        return found

    def role_of(self, vehicle: int) -> str:
        """For a person: `evader 1`."""
        flown = self.flown.get(vehicle)
        member = self.member(vehicle)
        role = flown.role if flown is not None else member.role if member is not None else None
        return f"{role.value if role is not None else 'vehicle'} {vehicle}"

    def member(self, vehicle: int) -> Member | None:
        """Its place in the roster."""
        roster = self.setup.roster if self.setup is not None else ()
        return next((m for m in roster if m.id == vehicle), None)


def thinned(flown: Flown) -> Flown:
    """At most `MOST_POINTS` samples, the last one among them."""
    n = len(flown.t)
    if n <= MOST_POINTS:
        return flown
    keep = np.unique(np.linspace(0, n - 1, MOST_POINTS).round().astype(int))
    return flown._replace(
        t=flown.t[keep],
        position=flown.position[keep],
        velocity=flown.velocity[keep],
        airspeed=flown.airspeed[keep],
        wind=flown.wind[keep],
        latency=flown.latency[keep],
    )


class Beside(NamedTuple):
    """The files beside a recording."""

    scenario: Scenario | None
    summary: dict[str, Any]
    timing: dict[str, Any]
    notes: tuple[str, ...]


def beside(folder: Path) -> Beside:
    """Read `scenario.toml`, `summary.json` and `timing.json`, as far as they are there and good."""
    notes: list[str] = []
    scenario = None
    if (folder / "scenario.toml").exists():
        try:
            scenario = scenarios.load(folder / "scenario.toml", several=True)
        except ConfigError as error:
            notes.append(str(error))
    found: dict[str, dict[str, Any]] = {}
    for name in ("summary", "timing"):
        path = folder / f"{name}.json"
        found[name] = {}
        if not path.exists():
            continue
        try:
            value = json.loads(path.read_text(encoding="utf-8"))
            found[name] = value if isinstance(value, dict) else {name: value}
        except (OSError, ValueError) as error:
            notes.append(f"{path}: not valid JSON: {error}")
    return Beside(scenario, found["summary"], found["timing"], tuple(notes))
