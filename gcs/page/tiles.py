"""The user's own map: raster tiles of an MBTiles file, a PMTiles file or a folder z/x/y.png, .jpg or .webp.

Tiles are numbered as on the web (XYZ: y counts from the north; MBTiles' own rows count from the south).
Nothing is fetched: what the file does not have is not drawn.
"""

from __future__ import annotations

import asyncio
import json
import re
import sqlite3
import threading
from collections import OrderedDict
from collections.abc import Callable
from contextlib import closing
from functools import partial
from math import atan, degrees, pi, sinh
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import quote

from onboard.config.strict import ConfigError
from onboard.runtime.off_loop import off_loop

ZOOM_MOST = 24
TILE_MOST = 4 << 20  # bytes of one tile
CACHE_MOST = 64 << 20  # bytes of tiles that are kept
KINDS = {"png": "image/png", "jpg": "image/jpeg", "jpeg": "image/jpeg", "webp": "image/webp"}
SQLITE, PMTILES = b"SQLite format 3\0", b"PMTiles"
EXPECTED = "expected an MBTiles or PMTiles file of PNG, JPEG or WebP, or a folder z/x/y.png"
Read = Callable[[int, int, int], bytes | None]
Bounds = tuple[float, float, float, float]  # west, south, east, north [°]


class TileMap(NamedTuple):
    """A map that is open. `read(z, x, y)` may block; None where it has no tile."""

    zooms: tuple[int, int]  # least and greatest
    bounds: Bounds
    credit: str  # whose map it is, for people; "" where the file does not say
    read: Read

    def told(self) -> dict[str, Any]:
        """What a browser learns of it."""
        return {"zooms": list(self.zooms), "bounds": list(self.bounds), "credit": self.credit}


def opened_map(path: Path) -> TileMap:
    """Open a map. Raises ConfigError with one line."""
    try:
        if path.is_dir():
            return _folder(path)
        with path.open("rb") as file:
            head = file.read(16)
        if head == SQLITE:
            return _mbtiles(path)
        if head.startswith(PMTILES):
            return _pmtiles(path)
    except OSError as error:
        raise ConfigError(f"page.map: {path}: {(error.strerror or str(error)).lower()}") from None
    raise _bad(path, "found another kind of file")


def kind_of(tile: bytes) -> str:
    """The media type by a tile's first bytes; "" where it is no picture."""
    if tile.startswith(b"\x89PNG\r\n"):
        return KINDS["png"]
    if tile.startswith(b"\xff\xd8\xff"):
        return KINDS["jpg"]
    return KINDS["webp"] if tile[:4] == b"RIFF" and tile[8:12] == b"WEBP" else ""


class TileStore:
    """Tiles of a map off the event loop, one read at a time; the newest that were asked for are kept."""

    def __init__(self, map: TileMap, most: int = CACHE_MOST) -> None:
        self.map = map
        self.kept = 0  # bytes
        self._most = most
        self._tiles: OrderedDict[tuple[int, int, int], bytes] = OrderedDict()
        self._one = asyncio.Lock()

    async def get(self, z: int, x: int, y: int) -> bytes | None:
        """A tile; None where there is none, where it is no picture, or too large."""
        least, most = self.map.zooms
        if not (least <= z <= most and 0 <= x < 1 << z and 0 <= y < 1 << z):
            return None
        place = (z, x, y)
        async with self._one:
            if place not in self._tiles:
                tile = await off_loop(partial(self._read, z, x, y))
                if tile is None:
                    return None
                self._keep(place, tile)
            self._tiles.move_to_end(place)
            return self._tiles[place]

    def _read(self, z: int, x: int, y: int) -> bytes | None:
        try:
            tile = self.map.read(z, x, y)
        except (OSError, ValueError, sqlite3.Error):  # the file was damaged or went away meanwhile
            return None
        return tile if tile is not None and len(tile) <= TILE_MOST and kind_of(tile) else None

    def _keep(self, place: tuple[int, int, int], tile: bytes) -> None:
        self._tiles[place] = tile
        self.kept += len(tile)
        while self.kept > self._most and len(self._tiles) > 1:
            self.kept -= len(self._tiles.popitem(last=False)[1])


def _bad(path: Path, found: str) -> ConfigError:
    return ConfigError(f"page.map: {path}: {found}, {EXPECTED}")


def _corner(z: int, x: int, y: int) -> tuple[float, float]:
    """Longitude and latitude of a tile's north-west corner [°], by Web Mercator (EPSG:3857)."""
    count = 1 << z
    return 360.0 * x / count - 180.0, degrees(atan(sinh(pi * (1.0 - 2.0 * y / count))))


def _extent(z: int, xs: tuple[int, int], ys: tuple[int, int]) -> Bounds:
    west, north = _corner(z, xs[0], ys[0])
    east, south = _corner(z, xs[1] + 1, ys[1] + 1)
    return west, south, east, north


def _checked(path: Path, map: TileMap, sample: bytes | None) -> TileMap:
    least, most = map.zooms
    if not 0 <= least <= most <= ZOOM_MOST:
        raise _bad(path, f"found zooms {least} to {most}")
    west, south, east, north = map.bounds
    if not (-180.0 <= west < east <= 180.0 and -90.0 <= south < north <= 90.0):
        raise _bad(path, f"found bounds {map.bounds}")
    if sample is None or not kind_of(sample):
        raise _bad(path, "found no picture in its tiles (vector tiles are not drawn)")
    return map


def _plain(text: object) -> str:
    """Text without markup."""
    return re.sub(r"<[^>]*>", "", str(text))[:200].strip()


def _mbtiles(path: Path) -> TileMap:
    lock = threading.Lock()
    address = f"file:{quote(str(path.resolve()))}?mode=ro"

    def rows(query: str, *values: int) -> list[Any]:
        with lock, closing(sqlite3.connect(address, uri=True)) as base:
            return base.execute(query, values).fetchall()

    def read(z: int, x: int, y: int) -> bytes | None:
        query = "SELECT tile_data FROM tiles WHERE zoom_level=? AND tile_column=? AND tile_row=?"
        found = rows(query, z, x, (1 << z) - 1 - y)
        return bytes(found[0][0]) if found else None

    try:
        least, most = rows("SELECT min(zoom_level), max(zoom_level) FROM tiles")[0]
        if least is None:
            raise _bad(path, "found no tile")
        said = dict(rows("SELECT name, value FROM metadata"))
        sides = "min(tile_column), max(tile_column), min(tile_row), max(tile_row)"
        west, east, south, north = rows(f"SELECT {sides} FROM tiles WHERE zoom_level=?", most)[0]
        sample = rows("SELECT tile_data FROM tiles LIMIT 1")[0][0]
    except (sqlite3.Error, TypeError) as error:
        raise _bad(path, f"found no tables of MBTiles ({error})") from None
    last = (1 << most) - 1
    bounds = _extent(most, (west, east), (last - north, last - south))
    return _checked(path, TileMap((least, most), bounds, _plain(said.get("attribution", "")), read), sample)


def _pmtiles(path: Path) -> TileMap:
    from pmtiles import reader as untyped
    from pmtiles.tile import Compression, TileType

    package: Any = untyped  # it has no types

    with path.open("rb") as file:
        reader = package.Reader(package.MmapSource(file))  # the mapping outlives the file
    try:
        head = reader.header()
        if head["tile_type"] not in (TileType.PNG, TileType.JPEG, TileType.WEBP):
            raise _bad(path, f"found tiles of type {head['tile_type'].name}")
        if head["tile_compression"] not in (Compression.NONE, Compression.UNKNOWN):
            raise _bad(path, f"found tiles compressed again ({head['tile_compression'].name})")
        said = reader.metadata()
        sides = [head[name] / 1e7 for name in ("min_lon_e7", "min_lat_e7", "max_lon_e7", "max_lat_e7")]
    except ConfigError:
        raise
    except Exception as error:  # the package says what it likes of a damaged file
        raise _bad(path, f"found a damaged head ({error})") from None

    def read(z: int, x: int, y: int) -> bytes | None:
        try:
            tile: bytes | None = reader.get(z, x, y)
        except Exception as error:
            raise ValueError(str(error)) from None
        return tile

    bounds = (sides[0], sides[1], sides[2], sides[3])
    credit = _plain(said.get("attribution", "")) if isinstance(said, dict) else ""
    zooms = (int(head["min_zoom"]), int(head["max_zoom"]))
    start = head["tile_data_offset"]
    return _checked(path, TileMap(zooms, bounds, credit, read), reader.get_bytes(start, 16))


def _folder(path: Path) -> TileMap:
    zooms = sorted(int(e.name) for e in path.iterdir() if e.is_dir() and _number(e.name))
    if not zooms:
        raise _bad(path, "found no folder of a zoom in it")
    columns = {int(e.name): e for e in (path / str(zooms[-1])).iterdir() if e.is_dir() and _number(e.name)}
    files = {
        int(e.stem): e
        for column in columns.values()
        for e in column.iterdir()
        if _number(e.stem) and e.suffix[1:] in KINDS
    }
    if not files:
        raise _bad(path, f"found no tile of zoom {zooms[-1]}")

    def read(z: int, x: int, y: int) -> bytes | None:
        for ending in KINDS:
            file = path / str(z) / str(x) / f"{y}.{ending}"
            if file.is_file():
                with file.open("rb") as open_file:
                    return open_file.read(TILE_MOST + 1)
        return None

    bounds = _extent(zooms[-1], (min(columns), max(columns)), (min(files), max(files)))
    about = path / "metadata.json"
    try:
        credit = _plain(json.loads(about.read_text("utf-8")).get("attribution", "")) if about.exists() else ""
    except (ValueError, AttributeError):
        raise _bad(path, "found a metadata.json that is none") from None
    sample = next(iter(files.values())).read_bytes()
    return _checked(path, TileMap((zooms[0], zooms[-1]), bounds, credit, read), sample)


def _number(name: str) -> bool:
    """Whether a file's name is a number as tiles have them, written in the one way."""
    return name.isascii() and name.isdigit() and str(int(name)) == name
