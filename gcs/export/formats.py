"""The formats that a run can be exported in."""

from __future__ import annotations

from enum import Enum


class Format(Enum):
    """What `gcs export` writes."""

    CSV = "csv"
    PARQUET = "parquet"
    KML = "kml"
    GPX = "gpx"
    CZML = "czml"
    GEOJSON = "geojson"
    FOXGLOVE = "foxglove"  # a layout for its viewer of the recording
