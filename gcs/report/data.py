"""What a report shows, as values: read from a run folder's recording, or from its logs where there is none.

Times are seconds since t₀ (since the first message where no game was started). Positions are in the game
frame (north, east, down) [m]; arrays have one row per sample.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gcs.picture.values import Alert, CommandView, LogLine
from onboard.config.strict import ConfigError
from onboard.game import palette
from onboard.game import scenario as scenarios
from onboard.game.scenario import Scenario
from onboard.wire.bus.messages import Fence, Member, Outcome, Role, Setup, Triple

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
    """Distance between a pursuer and the evader."""

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
    target: Triple | None
    outcome: Outcome | None
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
        flown, member = self.flown.get(vehicle), self.member(vehicle)
        role = flown.role if flown is not None else member.role if member is not None else Role.TRACKER
        if role is Role.TRACKER:
            return palette.FAINT.light
        return palette.vehicle(vehicle, role is Role.EVADER).light

    @property
    def evader(self) -> Flown | None:
        """The evader, as far as somebody saw it."""
        return next((f for f in self.flown.values() if f.role is Role.EVADER), None)

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
        if self.target is not None:
            places.append(np.array([self.target[:2]]))
        all_places = np.concatenate(places) if places else np.zeros((1, 2))
        low, high = all_places.min(axis=0), all_places.max(axis=0)
        margin = max(5.0, 0.06 * float((high - low).max()))
        return (
            (float(low[0]) - margin, float(high[0]) + margin),
            (float(low[1]) - margin, float(high[1]) + margin),
        )

    def gaps(self) -> tuple[Gap, ...]:
        """Distance of every pursuer to the evader over the time that both are known."""
        evader = self.evader
        if evader is None:
            return ()
        found = []
        for other in self.flown.values():
            if other.role is not Role.PURSUER or len(other.t) < 2 or len(evader.t) < 2:
                continue
            inside = (evader.t >= other.t[0]) & (evader.t <= other.t[-1])
            t = evader.t[inside]
            there = np.column_stack([np.interp(t, other.t, other.position[:, axis]) for axis in range(3)])
            apart = there - evader.position[inside]
            if self.flat:
                apart = apart[:, :2]
            found.append(Gap(other.id, t, np.linalg.norm(apart, axis=1)))
        return tuple(found)

    def playing(self, t: Array) -> NDArray[np.bool_]:
        """Which of these instants lie within the game: from t₀ to the outcome."""
        inside: NDArray[np.bool_] = t >= 0.0
        return inside if self.outcome is None else inside & (t <= self.outcome.time)

    def at_the_end(self, flown: Flown) -> int:
        """The sample nearest to the outcome; the last one where there is none."""
        return len(flown.t) - 1 if self.outcome is None else int(np.abs(flown.t - self.outcome.time).argmin())

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
            scenario = scenarios.load(folder / "scenario.toml")
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
