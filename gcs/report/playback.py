"""A run as a report's scene plays it: rows of places, the ground, marks, for `page/static/playback.js`."""

from __future__ import annotations

from typing import Any

import numpy as np

from gcs.page import documents
from gcs.page.documents import Document
from gcs.report import drawing
from gcs.report.data import Run
from onboard.core.math.constants import NS_PER_S

PLACES_MOST = 1500  # of one vehicle
VEHICLES_MOST = 200  # in a file that is handed on
MARKS_MOST = 200


def scene_of(run: Run) -> Document | None:
    """The scene's data; None where nobody is known to have flown."""
    ways = [flown for _, flown in sorted(run.flown.items()) if len(flown.t) > 1][:VEHICLES_MOST]
    if not ways:
        return None
    begin, end = run.span
    most = max(50, PLACES_MOST * 6 // max(6, len(ways)))
    return {
        "palette": documents.colours(),
        "field": _field(run),
        "ways": [
            {
                "id": flown.id,
                "role": flown.role.value,
                "rows": drawing.thin(np.column_stack([flown.t, flown.position]), most),
            }
            for flown in ways
        ],
        "marks": _marks(run, begin, end),
        "begin": begin,
        "end": end,
    }


def _field(run: Run) -> Document:
    setup = run.setup
    origin = None
    if setup is not None:
        origin = [setup.origin.latitude_deg, setup.origin.longitude_deg, setup.origin.altitude_m]
    return {
        "targets": documents.targets(run.targets),
        "roster": [
            {"id": id, "role": flown.role.value, "start": flown.position[0].tolist()}
            for id, flown in sorted(run.flown.items())
        ],
        "capture": run.capture_radius, "safety": run.safety_distance, "flat": run.flat,
        "planar": bool(setup.rules.planar) if setup is not None else run.flat, "origin": origin,
    } | documents.limits(setup)  # fmt: skip


def _marks(run: Run, begin: float, end: float) -> list[dict[str, Any]]:
    """Phases and alerts on the time of the flight [ms since its begin]."""
    found: list[dict[str, Any]] = [{"at": at, "kind": "phase", "text": name} for at, name in run.phases]
    for alert in run.alerts:
        at = (alert.raised_ns - run.t0_ns) / NS_PER_S
        found.append({"at": at, "kind": "alert", "text": alert.text, "severity": alert.severity.value})
    inside = [mark for mark in found if begin <= mark["at"] <= end][:MARKS_MOST]
    return [mark | {"at_ms": round(1000.0 * (mark["at"] - begin))} for mark in inside]
