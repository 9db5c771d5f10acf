"""A layout for Foxglove (and Lichtblick) over this project's recordings: scene, map, heights, log."""

from __future__ import annotations

import json
from typing import Any

from gcs.export.run_data import RunData
from gcs.recording.foxglove import WORLD
from onboard.game import palette
from onboard.wire.bus.messages import Role

SCENE, LOG = "/scene", "/log"


def position_topic(id: int) -> str:
    """Where a recording has a vehicle's pose."""
    return f"/position/{id}"


def location_topic(id: int) -> str:
    """Where it has its place on Earth."""
    return f"/location/{id}"


def as_foxglove(data: RunData) -> dict[str, bytes]:
    """One file to import as a layout; its topics are those of the vehicles that told their states."""
    ids = data.states.ids
    panels: dict[str, Any] = {
        "3D!scene": {
            "followTf": WORLD, "followMode": "follow-none",
            "topics": {SCENE: {"visible": True}} | {position_topic(i): {"visible": False} for i in ids},
            "cameraState": {"perspective": True, "distance": 300, "phi": 55, "thetaOffset": 0, "fovy": 45},
        },
        "map!field": {
            "customTileUrl": "", "followTopic": "", "layer": "map", "zoomLevel": 15,
            "topicColors": {
                location_topic(i): palette.vehicle(i, data.roles.get(i) is Role.EVADER).light for i in ids
            },
            "disabledTopics": [],
        },
        "Plot!heights": {
            "title": "height [m]", "isSynced": True, "xAxisVal": "timestamp", "showLegend": True,
            "paths": [
                {"value": f"{position_topic(i)}.pose.position.z", "enabled": True, "label": data.called(i),
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
    return {"foxglove-layout.json": json.dumps(layout, indent=1, ensure_ascii=False).encode()}
