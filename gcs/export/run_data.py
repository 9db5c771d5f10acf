"""`gcs.load(run)`: everything that a run left, as tables of NumPy arrays."""

from __future__ import annotations

import csv
import os
from collections import Counter
from collections.abc import Callable, Iterator
from math import nan, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gcs.export.tables import Table, table, with_time
from gcs.picture.several import fates, goals, named
from gcs.picture.station_journal import HEARD_HERE
from gcs.picture.values import FateView, GoalView
from gcs.recording.foxglove_layout import called
from gcs.recording.reader import Recording
from gcs.recording.shell import RECORDING
from gcs.report.data import beside
from gcs.report.from_tlog import from_tlogs
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Scenario
from onboard.wire.bus.messages import (
    DecisionReport,
    EvaderBrief,
    Event,
    Health,
    Message,
    Origin,
    Outcome,
    OwnBrief,
    PhaseChange,
    Role,
    Setup,
    State,
    Track,
    Triple,
)
from onboard.wire.geodesy import Frame

TRUTH = "truth.csv"  # that `sim-bridge fly` leaves: true motion
PLACE = ("north_m", "east_m", "down_m")
VELOCITY = ("v_north_m_s", "v_east_m_s", "v_down_m_s")
COLUMNS: dict[str, tuple[str, ...]] = {
    "states": (
        "stamp_ns", "arrival_ns", "id", "role", *PLACE, *VELOCITY, "airspeed_m_s", "wind_north_m_s",
        "wind_east_m_s", "wind_down_m_s", "roll_rad", "pitch_rad", "yaw_rad", "mode", "armed",
    ),
    "setpoints": ("stamp_ns", "id", *VELOCITY, "supervisor"),
    "decisions": (
        "stamp_ns", "id", "level", "module", "strategy", "rule", *(f"air_{name}" for name in VELOCITY),
        "aim_north_m", "aim_east_m", "aim_down_m", "time_to_aim_s", "miss_m", "supervisor", "reason",
        "predictor", "predictor_sigma_m", "quarry_id",
    ),
    "tracks": (
        "stamp_ns", "arrival_ns", "id", *PLACE, *VELOCITY, "sigma_m", "sigma_velocity_m_s", "sensor",
    ),
    "truth": ("stamp_ns", "id", *PLACE, *VELOCITY, "airspeed_m_s", "roll_rad", "pitch_rad", "yaw_rad"),
    "health": (
        "stamp_ns", "id", "stage", "mode", "armed", "battery_share", "link_share", "telemetry_rate_hz",
        "setpoint_rate_hz", "clock_offset_s", "ekf_ok", "version",
    ),
    "events": ("stamp_ns", "id", "number", "severity", "kind", "text"),
}  # fmt: skip
"""The columns of each table; `t_s` stands before them."""
GEODETIC = ("latitude_deg", "longitude_deg", "altitude_m")  # added to PLACE where the origin is known


class RunData(NamedTuple):
    """What a run left. A table without a row is there all the same, with its columns."""

    name: str
    folder: Path
    t0_ns: int  # wall instant that `t_s` counts from
    origin: Origin | None  # of the game frame; altitudes are above mean sea level
    scenario: Scenario | None  # with every value that was used
    setup: Setup | None
    targets: tuple[GoalView, ...]  # of all evaders
    outcome: Outcome | None
    fates: tuple[FateView, ...]  # how it ended for each evader, as far as it was said
    states: Table  # what each vehicle said of itself
    setpoints: Table  # the velocity over ground that its autopilot was sent
    decisions: Table  # and why
    tracks: Table  # opponents as a sensor saw them
    truth: Table  # in simulation: where they really were
    health: Table
    events: Table
    roles: dict[int, Role]
    notes: tuple[str, ...]  # what is missing or damaged, one line each

    @property
    def tables(self) -> tuple[Table, ...]:
        """All tables, in the order of COLUMNS."""
        return tuple(getattr(self, name) for name in COLUMNS)

    def only(self, ids: tuple[int, ...]) -> RunData:
        """What concerns these vehicles alone. Raises ConfigError for one that the run does not have."""
        known = sorted({id for each in self.tables for id in each.ids})
        for id in ids:
            if id not in known:
                raise ConfigError(f"--id: found vehicle {id}, expected one of {', '.join(map(str, known))}")
        kept: dict[str, Any] = {each.name: each.of(*ids) for each in self.tables}
        return self._replace(**kept)

    def named_targets(self) -> list[tuple[str, Triple]]:
        """Each target with its name for people: `target`, of several evaders `target of 12`."""
        return named(self.targets)

    def called(self, id: int) -> str:
        """A vehicle for a person: `evader 1`."""
        return called(id, self.roles)


def load(run: str | os.PathLike[str]) -> RunData:
    """Read a run folder, or a recording, whole.

    Without a recording the states are those of the telemetry logs, and the other tables are empty. Raises
    ConfigError with one line where there is neither, or where a file is foreign.
    """
    path = Path(run)
    if not path.exists():
        raise ConfigError(f"{path}: no such run")
    folder = path if path.is_dir() else path.parent
    files = beside(folder)
    try:
        recording = Recording(path / RECORDING if path.is_dir() else path)
    except ConfigError as error:
        if not path.is_dir() or not any(path.glob("vehicle-*.tlog")) or "version" in str(error):
            raise
        return _of_logs(path, str(error))
    try:
        heard = _Heard(recording)
    finally:
        recording.close()
    truth = _truth(folder / TRUTH)
    rows = {**heard.rows, "truth": truth}
    setup = heard.setup
    origin = setup.origin if setup is not None else _origin(files.scenario)
    zero_ns = heard.t0_ns or recording.start_ns
    roles = {member.id: member.role for member in setup.roster} if setup is not None else {}
    return RunData(
        name=setup.scenario if setup is not None else recording.game,
        folder=folder,
        t0_ns=zero_ns,
        origin=origin,
        scenario=files.scenario,
        setup=setup,
        targets=goals(setup, heard.brief, heard.own_briefs),
        outcome=heard.outcome,
        fates=fates(setup, heard.phase, heard.outcome),
        roles={**roles, **heard.roles},
        notes=(*files.notes, *recording.remarks, *heard.notes),
        **_tables(rows, zero_ns, origin),
    )


def _tables(rows: dict[str, list[tuple[Any, ...]]], zero_ns: int, origin: Origin | None) -> dict[str, Table]:
    found = {name: table(name, columns, rows.get(name, [])) for name, columns in COLUMNS.items()}
    return {name: _on_earth(with_time(each, zero_ns), origin) for name, each in found.items()}


def _on_earth(given: Table, origin: Origin | None) -> Table:
    """The table with places on Earth, where it has places and the origin is known."""
    if origin is None or not set(PLACE) <= set(given):
        return given
    frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
    places = zip(*(given[name].tolist() for name in PLACE), strict=True)
    earth = np.array([frame.geodetic_from_ned(Vec(*place))[:3] for place in places]).reshape(-1, 3)
    return Table(given.name, {**given, **dict(zip(GEODETIC, earth.T, strict=True))})


def _origin(scenario: Scenario | None) -> Origin | None:
    if scenario is None:
        return None
    spec = scenario.flight.origin
    return Origin(spec.latitude_deg, spec.longitude_deg, spec.altitude_m)


class _Heard:
    """The messages of a recording as rows, by the names of tables."""

    def __init__(self, recording: Recording) -> None:
        self.rows: dict[str, list[tuple[Any, ...]]] = {name: [] for name in COLUMNS}
        self.t0_ns = 0
        self.setup: Setup | None = None
        self.outcome: Outcome | None = None
        self.phase: PhaseChange | None = None
        self.brief: EvaderBrief | None = None
        self.own_briefs: dict[int, OwnBrief] = {}
        self.roles: dict[int, Role] = {}
        drops: Counter[str] = Counter()
        for entry in recording.entries():
            heard = HEARD_HERE.heard(entry.key, entry.payload, drops)
            take = _TAKERS.get(type(heard.message)) if heard is not None else None
            if heard is not None and take is not None:
                take(self, heard.message, entry.stamp_ns)
        told = ", ".join(f"{number} {cause}" for cause, number in sorted(drops.items()))
        self.notes = (f"{recording.path}: messages left out: {told}",) if told else ()

    def state(self, m: State, now_ns: int) -> None:
        """Take in what a vehicle says of itself."""
        self.roles[m.id] = m.role
        angles = (m.roll, m.pitch, m.yaw)
        motion = (*m.position, *m.velocity, m.airspeed, *m.wind, *angles)
        self.rows["states"].append((m.stamp_ns, now_ns, m.id, m.role.value, *motion, m.mode, m.armed))

    def decision(self, m: DecisionReport, now_ns: int) -> None:
        """Take in what was decided, and what was sent for it."""
        why = (m.level.value, m.module.value, m.strategy, m.rule)
        guard = (m.supervisor.value, m.reason, m.predictor, m.predictor_sigma)
        where = (*m.velocity, *m.aim, m.time_to_aim, m.miss)
        self.rows["decisions"].append((m.stamp_ns, m.id, *why, *where, *guard, m.quarry))
        self.rows["setpoints"].append((m.stamp_ns, m.id, *m.setpoint, m.supervisor.value))

    def track(self, m: Track, now_ns: int) -> None:
        """Take in what a sensor saw."""
        place, speed = _sigma(m.covariance[:3]), _sigma(m.covariance[3:])
        self.rows["tracks"].append(
            (m.stamp_ns, now_ns, m.id, *m.position, *m.velocity, place, speed, m.sensor)
        )

    def health(self, m: Health, now_ns: int) -> None:
        """Take in a heartbeat."""
        battery = m.battery if m.battery >= 0 else nan
        rates = (m.link_quality, m.telemetry_rate_hz, m.setpoint_rate_hz, m.clock_offset_s)
        self.rows["health"].append(
            (m.stamp_ns, m.id, m.stage.value, m.mode, m.armed, battery, *rates, m.ekf_ok, m.version)
        )

    def event(self, m: Event, now_ns: int) -> None:
        """Take in what happened."""
        self.rows["events"].append((m.stamp_ns, m.id, m.number, m.severity.value, m.kind, m.text))

    def keep(self, m: Setup | PhaseChange | Outcome | EvaderBrief | OwnBrief, now_ns: int) -> None:
        """Take in what is told of the game."""
        if isinstance(m, Setup):
            self.setup = m
        elif isinstance(m, PhaseChange):
            self.t0_ns, self.phase = m.t0_ns or self.t0_ns, m
        elif isinstance(m, Outcome):
            self.outcome = m
        elif isinstance(m, OwnBrief):
            self.own_briefs[m.id] = m
        else:
            self.brief = m


_TAKERS: dict[type[Message], Callable[[_Heard, Any, int], None]] = {
    State: _Heard.state, DecisionReport: _Heard.decision, Track: _Heard.track, Health: _Heard.health,
    Event: _Heard.event, Setup: _Heard.keep, PhaseChange: _Heard.keep, Outcome: _Heard.keep,
    EvaderBrief: _Heard.keep, OwnBrief: _Heard.keep,
}  # fmt: skip


def _sigma(variances: tuple[float, ...]) -> float:
    """One sigma of an axis: the root of the mean variance; NaN where one is unknown (negative)."""
    return sqrt(sum(variances) / len(variances)) if min(variances) >= 0.0 else nan


def _truth(path: Path) -> list[tuple[Any, ...]]:
    """The rows of a file of true motion; none where there is no file. Raises ConfigError."""
    columns = COLUMNS["truth"]
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return list(_truth_rows(path, csv.DictReader(file), columns))
    except FileNotFoundError:
        return []
    except (OSError, ValueError, csv.Error) as error:
        raise ConfigError(f"{path}: {str(getattr(error, 'strerror', None) or error).lower()}") from None


def _truth_rows(path: Path, rows: csv.DictReader[str], columns: tuple[str, ...]) -> Iterator[tuple[Any, ...]]:
    missing = set(columns) - set(rows.fieldnames or ())
    if missing:
        raise ConfigError(f"{path}: found no column {sorted(missing)[0]}, expected {', '.join(columns)}")
    for row in rows:
        if None in row.values():
            return  # cut while it was written: every line before is whole
        yield (int(row["stamp_ns"]), int(row["id"]), *(float(row[name]) for name in columns[2:]))


def _of_logs(folder: Path, why: str) -> RunData:
    """A run of which only telemetry logs are left."""
    run = from_tlogs(folder, beside(folder), why)
    rows = []
    for flown in run.flown.values():
        stamps = np.round(flown.t * 1e9).astype(np.int64) + run.t0_ns
        columns = np.column_stack([flown.position, flown.velocity, flown.airspeed, flown.wind])
        for stamp_ns, values in zip(stamps.tolist(), columns.tolist(), strict=True):
            rows.append((stamp_ns, stamp_ns, flown.id, flown.role.value, *values, nan, nan, nan, "", False))
    origin = _origin(run.scenario)
    return RunData(
        name=run.name, folder=folder, t0_ns=run.t0_ns, origin=origin, scenario=run.scenario, setup=None,
        targets=run.targets, outcome=None, fates=(), roles={f.id: f.role for f in run.flown.values()},
        notes=run.notes,
        **_tables({"states": rows, "truth": _truth(folder / TRUTH)}, run.t0_ns, origin),
    )  # fmt: skip
