"""Maps as people have them: tiles in four colours, in each of the three forms."""

from __future__ import annotations

import sqlite3
from io import BytesIO
from math import asinh, pi, radians, tan
from pathlib import Path

from PIL import Image
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

QUARTERS = {(0, 0): (220, 30, 30), (1, 0): (30, 160, 30), (0, 1): (30, 30, 220), (1, 1): (220, 200, 30)}
CREDIT = "© the <a href='x'>surveyors</a>"


def picture(kind: str = "PNG") -> bytes:
    """A tile: red in the north-west, green in the north-east, blue in the south-west, yellow in the rest."""
    tile = Image.new("RGB", (256, 256))
    for (i, j), colour in QUARTERS.items():
        tile.paste(colour, (128 * i, 128 * j, 128 * i + 128, 128 * j + 128))
    out = BytesIO()
    tile.save(out, kind)
    return out.getvalue()


def tile_at(zoom: int, latitude: float, longitude: float) -> tuple[int, int]:
    """The tile over a place, by the slippy map's formula (OpenStreetMap's wiki)."""
    count = 1 << zoom
    return int((longitude + 180) / 360 * count), int((1 - asinh(tan(radians(latitude))) / pi) / 2 * count)


def around(zooms: tuple[int, ...], latitude: float, longitude: float) -> list[tuple[int, int, int]]:
    """Three by three tiles of each zoom."""
    found = []
    for zoom in zooms:
        x, y = tile_at(zoom, latitude, longitude)
        found += [(zoom, x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return found


def mbtiles(path: Path, places: list[tuple[int, int, int]], tile: bytes) -> Path:
    """MBTiles 1.3: rows count from the south."""
    base = sqlite3.connect(path)
    base.execute("CREATE TABLE metadata (name text, value text)")
    base.execute("CREATE TABLE tiles (zoom_level int, tile_column int, tile_row int, tile_data blob)")
    base.execute("INSERT INTO metadata VALUES ('attribution', ?)", (CREDIT,))
    rows = [(z, x, (1 << z) - 1 - y, tile) for z, x, y in places]
    base.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)", rows)
    base.commit()
    base.close()
    return path


def folder(path: Path, places: list[tuple[int, int, int]], tile: bytes, ending: str = "png") -> Path:
    """z/x/y.ENDING."""
    for z, x, y in places:
        file = path / str(z) / str(x) / f"{y}.{ending}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(tile)
    return path


def pmtiles(
    path: Path, places: list[tuple[int, int, int]], tile: bytes, kind: TileType = TileType.PNG
) -> Path:
    """By the format's own writer."""
    with path.open("wb") as file:
        writer = Writer(file)
        for z, x, y in sorted(places, key=lambda place: zxy_to_tileid(*place)):
            writer.write_tile(zxy_to_tileid(z, x, y), tile)
        zooms = [z for z, _, _ in places]
        head = {
            "tile_type": kind, "tile_compression": Compression.NONE, "min_zoom": min(zooms),
            "max_zoom": max(zooms), "min_lon_e7": 79_900_000, "min_lat_e7": 469_900_000,
            "max_lon_e7": 80_100_000, "max_lat_e7": 470_100_000, "center_zoom": min(zooms),
            "center_lon_e7": 80_000_000, "center_lat_e7": 470_000_000,
        }  # fmt: skip
        writer.finalize(head, {"attribution": CREDIT})
    return path
