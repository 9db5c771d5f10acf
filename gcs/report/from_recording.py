"""A run's values from its recording: the recorded stream through the watch, and what it said on the way."""

from __future__ import annotations

from math import nan
from pathlib import Path

import numpy as np

from gcs.picture.reducer import PictureReducer
from gcs.picture.thresholds import Thresholds
from gcs.recording.reader import Recording
from gcs.report.data import Band, Beside, Flown, Link, Run, thinned
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import (
    DecisionReport,
    Health,
    Message,
    Outcome,
    PhaseChange,
    Role,
    State,
    SupervisorAction,
    Track,
)

SHORTEST_S = 0.05
SILENCE_S = 1.0  # a rule is taken to be in force for so long after its last report


class _OpenBand:
    def __init__(self, stamp_ns: int, rule: str, why: str, quarry: int) -> None:
        self.start_ns = self.end_ns = stamp_ns
        self.rule, self.why, self.quarry = rule, why, quarry

    def closed(self, zero_ns: int) -> Band:
        """The band in seconds since the instant `zero_ns`."""
        start, end = (self.start_ns - zero_ns) / NS_PER_S, (self.end_ns - zero_ns) / NS_PER_S
        return Band(start, max(end, start + SHORTEST_S), self.rule, self.why)


class _Vehicle:
    def __init__(self) -> None:
        self.role: Role | None = None
        self.states: list[tuple[float, ...]] = []
        self.tracks: list[tuple[float, ...]] = []
        self.health: list[tuple[float, ...]] = []
        self.bands: list[_OpenBand] = []
        self.guards: list[_OpenBand] = []


class _Collector:
    """Takes the messages in; times are still nanoseconds, t₀ comes late."""

    def __init__(self) -> None:
        self.vehicles: dict[int, _Vehicle] = {}
        self.phases: list[tuple[int, str]] = []
        self.t0_ns = 0
        self.outcome: Outcome | None = None

    def take(self, message: Message, now_ns: int) -> None:
        """Keep what the report needs of a message that arrived at the wall instant `now_ns`."""
        if isinstance(message, State):
            self._state(message, now_ns)
        elif isinstance(message, Track):
            vehicle = self._vehicle(message.id)
            vehicle.tracks.append((message.stamp_ns, *message.position, *message.velocity))
        elif isinstance(message, DecisionReport):
            self._decision(message)
        elif isinstance(message, Health):
            self._health(message)
        elif isinstance(message, PhaseChange):
            self.t0_ns = message.t0_ns or self.t0_ns
            if not self.phases or self.phases[-1][1] != message.phase.value:
                self.phases.append((now_ns, message.phase.value))
        elif isinstance(message, Outcome):
            self.outcome = message

    def _vehicle(self, vehicle_id: int) -> _Vehicle:
        return self.vehicles.setdefault(vehicle_id, _Vehicle())

    def _state(self, state: State, now_ns: int) -> None:
        vehicle = self._vehicle(state.id)
        vehicle.role = state.role
        late = (now_ns - state.stamp_ns) / NS_PER_S
        row = (state.stamp_ns, *state.position, *state.velocity, state.airspeed, *state.wind, late)
        vehicle.states.append(row)

    def _decision(self, decision: DecisionReport) -> None:
        vehicle = self._vehicle(decision.id)
        why = f"{decision.strategy}, {decision.level.value}, {decision.module.value}"
        why += f", after evader {decision.quarry}" if decision.quarry else ""
        _extend(vehicle.bands, decision.stamp_ns, decision.rule, why, decision.quarry)
        guarded = "" if decision.supervisor is SupervisorAction.OK else decision.supervisor.value
        _extend(vehicle.guards, decision.stamp_ns, guarded, decision.reason)

    def _health(self, health: Health) -> None:
        battery = health.battery if health.battery >= 0 else nan
        self._vehicle(health.id).health.append((health.stamp_ns, health.link_quality, battery))


def _extend(bands: list[_OpenBand], stamp_ns: int, rule: str, why: str, quarry: int = 0) -> None:
    """One more report: the band goes on, or ends where another begins; silence ends it too."""
    fresh = bool(bands) and stamp_ns - bands[-1].end_ns < SILENCE_S * NS_PER_S
    if fresh:
        bands[-1].end_ns = stamp_ns
    if not fresh or (bands[-1].rule, bands[-1].quarry) != (rule, quarry):
        bands.append(_OpenBand(stamp_ns, rule, why, quarry))


def from_recording(
    path: Path, recording: Recording, files: Beside, limits: Thresholds | None = None, version: str = ""
) -> Run:
    """Everything of a run that was recorded."""
    reducer = PictureReducer(recording.game, limits, version)
    collector = _Collector()
    for entry in recording.entries():
        heard = reducer.apply(*entry)
        if heard is not None:
            collector.take(heard.message, entry.stamp_ns)
    picture = reducer.picture(recording.end_ns)
    setup = picture.game.setup
    roles = {m.id: m.role for m in setup.roster} if setup is not None else {}
    zero_ns = collector.t0_ns or recording.start_ns
    flown, links, rules, guards = {}, {}, {}, {}
    for vehicle_id, vehicle in sorted(collector.vehicles.items()):
        role = vehicle.role or roles.get(vehicle_id, Role.TRACKER)
        way = _way(vehicle_id, role, vehicle, zero_ns)
        if way is not None:
            flown[vehicle_id] = thinned(way)
        if vehicle.health:
            links[vehicle_id] = Link(*_columns(vehicle.health, zero_ns))
        rules[vehicle_id] = tuple(band.closed(zero_ns) for band in vehicle.bands)
        guards[vehicle_id] = tuple(band.closed(zero_ns) for band in vehicle.guards if band.rule)
    notes = [*files.notes, *recording.remarks]
    if not flown:
        notes.append(f"{path}: no state and no track of any vehicle")
    alerts = sorted((*picture.past_alerts, *picture.alerts), key=lambda a: (a.raised_ns, a.name))
    return Run(
        name=setup.scenario if setup is not None else recording.game,
        folder=path if path.is_dir() else path.parent,
        notes=tuple(notes),
        scenario=files.scenario,
        setup=setup,
        targets=picture.game.targets,
        outcome=collector.outcome,
        fates=picture.game.fates,
        phases=tuple(((at - zero_ns) / NS_PER_S, phase) for at, phase in collector.phases),
        flown=flown,
        links=links,
        rules={vehicle_id: bands for vehicle_id, bands in rules.items() if bands},
        guards={vehicle_id: bands for vehicle_id, bands in guards.items() if bands},
        alerts=tuple(alerts),
        commands=picture.commands,
        log=picture.log,
        t0_ns=zero_ns,
        summary=files.summary,
        timing=files.timing,
    )


def _columns(rows: list[tuple[float, ...]], zero_ns: int) -> list[np.ndarray]:
    """Columns of rows whose first value is an instant, in order of time."""
    stamps = np.array([row[0] for row in rows], dtype=np.int64)
    order = np.argsort(stamps, kind="stable")
    rest = np.array([row[1:] for row in rows], dtype=np.float64)[order]
    return [(stamps[order] - zero_ns) / NS_PER_S, *rest.T]


def _way(vehicle_id: int, role: Role, vehicle: _Vehicle, zero_ns: int) -> Flown | None:
    rows = vehicle.states or vehicle.tracks
    if not rows:
        return None
    columns = _columns(rows, zero_ns)
    t, *rest = columns
    place, velocity = np.column_stack(rest[0:3]), np.column_stack(rest[3:6])
    if vehicle.states:
        airspeed, wind, latency = rest[6], np.column_stack(rest[7:10]), rest[10]
        return Flown(vehicle_id, role, "state", t, place, velocity, airspeed, wind, latency)
    unknown = np.full(len(t), nan)
    wind = np.full((len(t), 3), nan)
    return Flown(vehicle_id, role, "track", t, place, velocity, unknown, wind, unknown)
