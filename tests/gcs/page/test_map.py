"""The user's own map: read from each form, put where it belongs, refused with clear words."""

from __future__ import annotations

import asyncio
from io import BytesIO
from pathlib import Path

import aiohttp
import numpy as np
import pymap3d
import pytest
from PIL import Image
from playwright.async_api import Page
from pmtiles.tile import TileType

from gcs.page.tiles import EXPECTED, TileStore, opened_map
from onboard.config.strict import ConfigError
from tests.support import map_files
from tests.support.page_stage import TOKEN, chromium, opened, seen, stage
from tests.support.sample_messages import setup

pytestmark = pytest.mark.real
ORIGIN = (47.0, 8.0, 400.0)  # of tests/support/sample_messages
PLACES = map_files.around((15, 16, 17), *ORIGIN[:2])
FORMS = {
    "MBTiles": lambda folder: map_files.mbtiles(folder / "a b?.mbtiles", PLACES, map_files.picture()),
    "PMTiles": lambda folder: map_files.pmtiles(folder / "a.pmtiles", PLACES, map_files.picture()),
    "folder": lambda folder: map_files.folder(folder / "a", PLACES, map_files.picture("WEBP"), "webp"),
}


@pytest.mark.parametrize("form", FORMS)
async def test_each_form_gives_its_tiles_and_nothing_else(form, tmp_path: Path):
    map = opened_map(FORMS[form](tmp_path))
    assert map.zooms == (15, 17)
    west, south, east, north = map.bounds
    assert west < ORIGIN[1] < east
    assert south < ORIGIN[0] < north
    assert map.credit == ("" if form == "folder" else "© the surveyors")
    store = TileStore(map)
    tile = map_files.picture("WEBP" if form == "folder" else "PNG")
    for place in PLACES:
        assert await store.get(*place) == tile
    z, x, y = PLACES[-1]
    for gone in ((z, x + 1, y), (z, x, y + 1), (14, 0, 0), (18, 0, 0), (z, 1 << z, 0), (-1, 0, 0)):
        assert await store.get(*gone) is None


async def test_what_is_kept_has_a_bound_and_many_may_ask_at_once(tmp_path: Path):
    tile = map_files.picture()
    store = TileStore(opened_map(FORMS["MBTiles"](tmp_path)), most=3 * len(tile))
    found = await asyncio.gather(*(store.get(*place) for place in PLACES * 3))
    assert set(found) == {tile}
    assert store.kept <= 3 * len(tile)


def broken(folder: Path, what: str) -> Path:
    path = folder / "m"
    if what == "nothing there":
        return path
    if what == "an empty folder":
        path.mkdir()
    elif what == "a folder of notes":
        map_files.folder(path, PLACES, b"notes", "txt")
    elif what == "a folder of pages":
        map_files.folder(path, PLACES, b"<html>not found</html>", "png")
    elif what == "vector MBTiles":
        map_files.mbtiles(path, PLACES, b"\x1f\x8b\x08 pbf")
    elif what == "MBTiles without tiles":
        map_files.mbtiles(path, [], b"")
    elif what == "half an MBTiles":
        whole = map_files.mbtiles(folder / "whole", PLACES, map_files.picture()).read_bytes()
        path.write_bytes(whole[:2000])
    elif what == "vector PMTiles":
        map_files.pmtiles(path, PLACES, b"pbf", TileType.MVT)
    elif what == "half a PMTiles":
        path.write_bytes(map_files.pmtiles(folder / "whole", PLACES, map_files.picture()).read_bytes()[:100])
    elif what == "a picture":
        path.write_bytes(map_files.picture())
    return path


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("nothing there", "no such file"), ("an empty folder", "found no folder of a zoom"),
        ("a folder of notes", "found no tile of zoom 17"), ("a folder of pages", "found no picture"),
        ("vector MBTiles", "vector tiles are not drawn"), ("MBTiles without tiles", "found no tile"),
        ("half an MBTiles", "found no tables of MBTiles"), ("vector PMTiles", "found tiles of type MVT"),
        ("half a PMTiles", "found a damaged head"), ("a picture", "found another kind of file"),
    ],
)  # fmt: skip
def test_what_is_no_map_is_told_in_one_line(what, words, tmp_path: Path):
    path = broken(tmp_path, what)
    with pytest.raises(ConfigError, match=words) as caught:
        opened_map(path)
    text = str(caught.value)
    assert text.startswith(f"page.map: {path}: ")
    assert "\n" not in text
    assert what == "nothing there" or text.endswith(EXPECTED)


async def test_tiles_are_for_those_who_may_look(tmp_path: Path):
    map = opened_map(FORMS["MBTiles"](tmp_path))
    z, x, y = PLACES[0]
    async with stage(1, map=map) as made, aiohttp.ClientSession() as client:
        for path, headers, status in (
            (f"tiles/{z}/{x}/{y}", {}, 200), (f"tiles/{z}/{x}/0", {}, 404), ("tiles/99/1/1", {}, 404),
            (f"tiles/{z}/{x}/{y}", {"Origin": "http://evil.example"}, 403),
            (f"tiles/{z}/{x}/{y}?token=guessed", {}, 403), (f"tiles/{z}/..%2f..%2f/{y}", {}, 404),
        ):  # fmt: skip
            async with client.get(made.url + path, headers=headers) as answer:
                assert answer.status == status, path
                if status == 200:
                    assert answer.content_type == "image/png"
                    assert await answer.read() == map_files.picture()
    cookies = {"apollonius": TOKEN}
    async with (
        stage(1) as made,
        aiohttp.ClientSession(cookies=cookies) as client,
        client.get(made.url + f"tiles/{z}/{x}/{y}") as answer,
    ):
        assert answer.status == 404  # a page without a map


async def colours_checked(page: Page) -> int:
    """How many quarters of tiles are in view; each is on the screen where the world has it, in its colour."""
    shot = np.asarray(Image.open(BytesIO(await page.screenshot())).convert("RGB"))
    box = await page.locator("#scene").bounding_box()
    assert box is not None
    expected = []
    for z, x, y in PLACES[-9:]:
        for (i, j), colour in map_files.QUARTERS.items():
            latitude, longitude = slippy(z, x + 0.25 + 0.5 * i, y + 0.25 + 0.5 * j)
            north, east, _ = pymap3d.geodetic2ned(latitude, longitude, ORIGIN[2], *ORIGIN)
            expected.append((float(east), float(-north), colour))
    there = await page.evaluate(
        "all => all.map(([x, z]) => page.scene.onScreen(x, 0, z) || [-1, -1])", expected
    )
    inside = 0
    for (across, down), (_, _, colour) in zip(there, expected, strict=True):
        if not (20 < across < box["width"] - 120 and 60 < down < box["height"] - 60):
            continue  # outside, or below buttons and arrows
        row, column = int(box["y"] + down), int(box["x"] + across)
        patch = np.median(shot[row - 9 : row + 9, column - 9 : column + 9].reshape(-1, 3), axis=0)
        assert patch == pytest.approx(colour, abs=25)
        inside += 1
    return inside


async def test_the_map_lies_where_the_world_has_it(tmp_path: Path):
    map = opened_map(FORMS["MBTiles"](tmp_path))
    async with stage(3, map=map) as made, chromium() as browser:
        made.tell(setup(3))
        page = await opened(browser, made)
        await seen(page, "page.field.origin !== null")
        await page.keyboard.press("v")
        await seen(page, "page.map.group.children.some(m => m.name.startsWith('17/'))")
        assert await page.locator("#credit").inner_text() == "© the surveyors"
        drawn = await page.evaluate(
            "page.map.group.children.map(m => [m.name, [...m.geometry.attributes.position.array]])"
        )
        for name, flat in drawn:
            z, x, y = [int(part) for part in name.split("/")]
            corners = np.reshape(flat, (-1, 3))
            for (i, j), at in (((0, 0), 0), ((1, 0), 4), ((0, 1), 20), ((1, 1), 24)):
                latitude, longitude = slippy(z, x + i, y + j)
                north, east, _ = pymap3d.geodetic2ned(latitude, longitude, ORIGIN[2], *ORIGIN)
                assert [-corners[at][2], corners[at][0]] == pytest.approx([north, east], abs=0.1), name
        await seen(page, "[...page.map.tiles.values()].every(tile => tile !== undefined)")
        await page.keyboard.press("t")
        assert await colours_checked(page) >= 4
        await page.keyboard.press("m")
        assert not await page.evaluate("page.map.group.visible")
        assert {url.split("/")[2] for url in made.requests} == {f"localhost:{made.port}"}


def slippy(zoom: int, x: float, y: float) -> tuple[float, float]:
    """Latitude and longitude of a place on the map, by the slippy map's formula (OpenStreetMap's wiki)."""
    count = 2**zoom
    return float(np.degrees(np.arctan(np.sinh(np.pi * (1 - 2 * y / count))))), x / count * 360 - 180
