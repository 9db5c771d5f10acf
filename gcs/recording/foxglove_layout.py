"""A layout for Foxglove (and Lichtblick) over this project's recordings: scene, map, heights, log."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from gcs.recording.file import Run, at_once
from gcs.recording.foxglove import WORLD
from onboard.game import palette, sides
from onboard.wire.bus.messages import Role

LAYOUT = "foxglove-layout.json"
SCENE, LOG = "/scene", "/log"


def position_topic(id: int) -> str:
    """Where a recording has a vehicle's pose."""
    return f"/position/{id}"


def location_topic(id: int) -> str:
    """Where it has its place on Earth."""
    return f"/location/{id}"


def called(id: int, roles: Mapping[int, Role]) -> str:
    """A vehicle for a person: `evader 1`."""
    return f"{roles[id].value if id in roles else 'vehicle'} {id}"


def layout_of_viewer(ids: Iterable[int], roles: Mapping[int, Role]) -> bytes:
    """A file to import as a layout; its topics are those of these vehicles."""
    ids, shades = sorted(ids), sides.colours(roles)
    panels: dict[str, Any] = {
        "3D!scene": {
            "followTf": WORLD, "followMode": "follow-none",
            "topics": {SCENE: {"visible": True}} | {position_topic(i): {"visible": False} for i in ids},
            "cameraState": {"perspective": True, "distance": 300, "phi": 55, "thetaOffset": 0, "fovy": 45},
        },
        "map!field": {
            "customTileUrl": "", "followTopic": "", "layer": "map", "zoomLevel": 15,
            "topicColors": {location_topic(i): shades.get(i, palette.FAINT).light for i in ids},
            "disabledTopics": [],
        },
        "Plot!heights": {
            "title": "height [m]", "isSynced": True, "xAxisVal": "timestamp", "showLegend": True,
            "paths": [
                {"value": f"{position_topic(i)}.pose.position.z", "enabled": True, "label": called(i, roles),
                 "timestampMethod": "receiveTime"}
                for i in ids
            ],
        },
        "RosOut!log": {"topicToRender": LOG, "searchTerms": [], "minLogLevel": 1},
    }  # fmt: skip
    right = {"direction": "column", "splitPercentage": 45, "first": "map!field", "second": "Plot!heights"}
    layout = {
        "configById": panels, "globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1},
        "layout": {
            "direction": "column", "splitPercentage": 75, "second": "RosOut!log",
            "first": {"direction": "row", "splitPercentage": 60, "first": "3D!scene", "second": right},
        },
    }  # fmt: skip
    return json.dumps(layout, indent=1, ensure_ascii=False).encode()


class LayoutFile:
    """Keeps a layout of the vehicles recorded so far in the recording's folder, by `run` at the disk.

    A layout that lies there already stays as it is. Where the disk refuses, the next call tries again.
    """

    def __init__(self, folder: Path, run: Run = at_once) -> None:
        self._path = folder / LAYOUT
        self._run = run
        self._written: dict[int, Role] | None = None
        self._busy = self._foreign = False

    def hold(self, roles: Mapping[int, Role]) -> None:
        """Let the file show these vehicles."""
        if self._busy or self._foreign or roles == self._written:
            return
        self._busy = True
        if not self._run(partial(self._write, dict(roles))):
            self._busy = False

    def _write(self, roles: dict[int, Role]) -> None:
        part = self._path.with_name(f".{LAYOUT}.part")
        try:
            if self._written is None and self._path.exists():
                self._foreign = True
                return
            part.write_bytes(layout_of_viewer(roles, roles))
            os.replace(part, self._path)
            self._written = roles
        except OSError:
            with suppress(OSError):
                part.unlink(missing_ok=True)
        finally:
            self._busy = False
