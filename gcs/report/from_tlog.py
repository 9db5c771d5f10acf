"""A run's values from its telemetry logs alone: where everybody flew, how fast, with what battery."""

from __future__ import annotations

from collections import Counter
from math import nan
from pathlib import Path

import numpy as np

from gcs.picture.several import planned
from gcs.report.data import Array, Beside, Flown, Link, Run, thinned
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Role
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.tlog import read_tlog
from onboard.wire.mavlink.values import AirData, GlobalPosition, SysStatus, Wind

AUTOPILOT = 1  # MAV_COMP_ID_AUTOPILOT1


class _Log:
    """What one log says."""

    def __init__(self) -> None:
        self.places: list[tuple[int, GlobalPosition]] = []
        self.airspeeds: list[tuple[int, float]] = []
        self.winds: list[tuple[int, tuple[float, float, float]]] = []
        self.batteries: list[tuple[int, float]] = []


def from_tlogs(folder: Path, files: Beside, why: str) -> Run:
    """What can be said without a recording; `why` there is none goes into the notes.

    `folder` holds `vehicle-ID.tlog` files, or logs with names of their own, of any number of vehicles each;
    it may be such a log itself. Raises ConfigError where there is none.
    """
    notes = [*files.notes, why, "made from telemetry logs: no decisions, no alerts, no commands"]
    logs: dict[int, _Log] = {}
    for path in sorted(folder.glob("*.tlog")) if folder.is_dir() else [folder]:
        kind, _, number = path.stem.partition("-")
        own = int(number) if kind == "vehicle" and number.isdecimal() else None
        causes = Counter[str]()
        found = {i: log for i, log in _read(path, own, causes).items() if log.places}
        if causes:
            told = ", ".join(f"{n} {cause}" for cause, n in sorted(causes.items()))
            notes.append(f"{path}: damaged: {told}")
        if not found:
            notes.append(f"{path}: no position{'' if own is None else f' of vehicle {own}'}")
        logs = found | logs
    if not logs:
        raise ConfigError(f"{folder}: found neither a recording nor a log with positions; {why}")
    zero_ns = min(log.places[0][0] for log in logs.values())
    frame = _frame(files, logs)
    roles = _roles(files, logs)
    flown = {i: thinned(_flown(i, roles[i], log, zero_ns, frame)) for i, log in logs.items()}
    links = {i: _link(log, zero_ns) for i, log in logs.items() if log.batteries}
    scenario = files.scenario
    return Run(
        name=scenario.name if scenario is not None else folder.name,
        folder=folder if folder.is_dir() else folder.parent,
        notes=tuple(notes),
        scenario=scenario,
        setup=None,
        targets=planned(scenario) if scenario is not None else (),
        outcome=None,
        fates=(),
        phases=(),
        flown=flown,
        links=links,
        rules={},
        guards={},
        alerts=(),
        commands=(),
        log=(),
        t0_ns=zero_ns,
        summary=files.summary,
        timing=files.timing,
    )


def _read(path: Path, own: int | None, causes: Counter[str]) -> dict[int, _Log]:
    """What the autopilots in a log say; of vehicle `own` alone where that is given."""
    logs: dict[int, _Log] = {}
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    for stamp_ns, packet in read_tlog(data, causes):
        if packet.component != AUTOPILOT or own not in (None, packet.system):
            continue
        value, log = packet.value, logs.setdefault(packet.system, _Log())
        if isinstance(value, GlobalPosition):
            if value.latitude_deg or value.longitude_deg:  # 0°, 0° is told before there is a fix
                log.places.append((stamp_ns, value))
        elif isinstance(value, AirData):
            log.airspeeds.append((stamp_ns, value.airspeed))
        elif isinstance(value, Wind):
            log.winds.append((stamp_ns, (value.velocity.x, value.velocity.y, value.velocity.z)))
        elif isinstance(value, SysStatus) and value.battery >= 0:
            log.batteries.append((stamp_ns, value.battery))
    return logs


def _frame(files: Beside, logs: dict[int, _Log]) -> Frame:
    """The scenario's frame; without one, that of the first vehicle's first place."""
    if files.scenario is not None:
        origin = files.scenario.flight.origin
        return Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
    first = logs[min(logs)].places[0][1]
    return Frame(first.latitude_deg, first.longitude_deg, first.altitude_m - first.above_home_m)


def _roles(files: Beside, logs: dict[int, _Log]) -> dict[int, Role]:
    """Of the scenario; by habit the evader is 1."""
    evaders = files.scenario.evader_ids if files.scenario is not None else (1,)
    return {i: Role.EVADER if i in evaders else Role.PURSUER for i in logs}


def _flown(vehicle: int, role: Role, log: _Log, zero_ns: int, frame: Frame) -> Flown:
    t = np.array([(stamp - zero_ns) / NS_PER_S for stamp, _ in log.places])
    places = [frame.ned_from_geodetic(p.latitude_deg, p.longitude_deg, p.altitude_m) for _, p in log.places]
    velocity = np.array([p.velocity for _, p in log.places], dtype=np.float64)
    airspeed = _at(t, log.airspeeds, zero_ns)
    wind = np.column_stack([_at(t, [(s, w[axis]) for s, w in log.winds], zero_ns) for axis in range(3)])
    return Flown(
        vehicle, role, "tlog", t, np.array(places, dtype=np.float64), velocity, airspeed, wind,
        np.full(len(t), nan),
    )  # fmt: skip


def _at(t: Array, samples: list[tuple[int, float]], zero_ns: int) -> Array:
    if not samples:
        return np.full(len(t), nan)
    at = [(stamp - zero_ns) / NS_PER_S for stamp, _ in samples]
    found: Array = np.interp(t, at, [v for _, v in samples])
    return found


def _link(log: _Log, zero_ns: int) -> Link:
    t = np.array([(stamp - zero_ns) / NS_PER_S for stamp, _ in log.batteries])
    return Link(t, np.full(len(t), nan), np.array([value for _, value in log.batteries]))
