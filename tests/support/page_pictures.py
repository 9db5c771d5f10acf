"""Pictures of the page for docs/page.md: `python -m tests.support.page_pictures` (`make page-pictures`).

It flies games on virtual time and shows their recordings: as the live page shows a game, as a replay, two
beside each other, and as a report. `--look FOLDER` draws page, replay and report at three sizes in both
themes instead, for those who change the look.
"""

from __future__ import annotations

import argparse
import asyncio
import io
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from playwright.async_api import Browser as Chromium
from playwright.async_api import Page

from gcs.page.access import Doors
from gcs.page.hub import Hub
from gcs.page.replay import PageReplay, marks_of, opened
from gcs.page.server import Address, PageServer, served
from gcs.page.tiles import TileMap, opened_map
from gcs.picture.thresholds import Thresholds
from gcs.replay.source import open_run
from gcs.report.program import read_run
from onboard.runtime.clock import RealClock
from onboard.runtime.resources import configs
from tests.support.map_files import around
from tests.support.page_stage import chromium, seen
from tests.support.paths import ROOT

TOKEN = "a-token-for-pictures"
LARGEST = 200_000  # bytes of a picture
LAPTOP, WIDE, TABLET = (1280, 800), (1920, 1080), (820, 1180)  # [px]
START_MS = 60_000  # for a page to be there on a busy machine
FLIGHT = configs() / "scenarios" / "flight"
ORIGIN = (47.397742, 8.545594)  # of the demo's field [°]: where PX4's simulations are
ZOOMS = (14, 15, 16, 17)


class Shot(NamedTuple):
    """A picture: its name, where and how it is taken."""

    name: str
    size: tuple[int, int] = LAPTOP
    dark: bool = False
    since_s: float = 14.0  # of the game, since t₀
    select: int = 2
    keys: str = ""  # pressed before
    script: str = "0"  # done before


LIVE = (
    Shot("page-space"),
    Shot("page-plan", WIDE, dark=True, keys="v"),
    Shot("page-selected", dark=True, since_s=9.0, select=1, keys="vg"),
    Shot("page-tablet", TABLET),
)
TEAM = (Shot("page-team", since_s=6.0, select=3, keys="v"),)
SEVERAL = (
    Shot("page-several", since_s=20.0, select=9, keys="v"),
    Shot("page-knowledge", WIDE, dark=True, since_s=20.0, select=7, keys="vg",
         script="document.getElementById('knowledge').scrollIntoView()"),
)  # fmt: skip
ZONES = (Shot("page-zones", dark=True, since_s=42.0, select=1),)
ALERTS = (Shot("page-alerts", since_s=20.0),)
HEIGHTS = (Shot("page-spheres", since_s=9.0, select=1),)
MAP = (Shot("page-map", keys="v"),)
REPLAY = (Shot("page-replay", since_s=20.0),)
LOOKS = [Shot(f"-{w}x{h}-{'dark' if dark else 'light'}", (w, h), dark)
         for w, h in (LAPTOP, WIDE, TABLET) for dark in (False, True)]  # fmt: skip


class AsLive(PageReplay):
    """A recording that the page takes for a game on the bus, so that the same picture can be made again."""

    steers = True
    title = "live"

    def status(self) -> str:
        return "listening at tcp/127.0.0.1:7447, recording"


class Runs(NamedTuple):
    """Run folders of the games."""

    demo: Path
    guarded: Path
    paper: Path
    team: Path
    lossy: Path
    heights: Path
    several: Path
    zones: Path


def flown(folder: Path) -> Runs:
    """Fly the games: the demo, a target that is guarded, the same by the paper's rules, the same by a team of
    which one begins nearer to the target, a game with loss on every link, the demo at several heights, a
    game of three evaders, and one with two obstacles."""
    text = (FLIGHT / "goalkeeper.toml").read_text(encoding="utf-8")
    paper, team = folder / "paper.toml", folder / "team.toml"
    paper.write_text(text.replace('"goalkeeper', '"paper'), encoding="utf-8")
    near = text.replace("[20, -85]", "[80, -40]").replace('"goalkeeper', '"team')
    team.write_text(near, encoding="utf-8")
    heights = folder / "heights.toml"
    up = iter((60, 60, 40, 75, 85, 45, 60))
    planar = (FLIGHT / "demo.toml").read_text(encoding="utf-8")
    spatial = re.sub(r"(position|target) = \[(.*)\]", lambda m: f"{m[1]} = [{m[2]}, {next(up)}]", planar)
    heights.write_text(spatial.replace("five on one", "five on one, in space"), encoding="utf-8")
    made = (str(paper), str(team), "heavy-loss", str(heights), "three-on-ten", "two-obstacles")
    scenarios = ("demo", "goalkeeper", *made)
    found = []
    for name, scenario in zip(Runs._fields, scenarios, strict=True):
        command = [sys.executable, "-m", "sim_bridge.cli", "fly", "--fast", "--quiet", scenario]
        subprocess.run([*command, "--runs", str(folder / name)], check=True, cwd=ROOT)
        found += [next((folder / name).iterdir())]
    return Runs(*found)


def source_of(run: Path, kind: type[PageReplay] = PageReplay) -> PageReplay:
    """A run as the page's source, standing still."""
    recording = open_run(run)
    found = opened(recording, Thresholds(), "")
    source = kind(found.player, run.name, RealClock().monotonic_ns, marks_of(recording, found, read_run(run)))
    source.player.pause()
    return source


def to(source: PageReplay, since_s: float) -> None:
    """Let it show this instant since t₀."""
    source.seek_ms(round(source.told["zero_ms"] + 1000 * since_s))


def terrain(folder: Path) -> TileMap:
    """A map: hills with contour lines, made up of waves, as a folder of tiles around the field."""
    for zoom, x, y in around(ZOOMS, *ORIGIN):
        across = (x + np.arange(256) / 256.0) / 2**zoom * 2**18
        down = (y + np.arange(256) / 256.0) / 2**zoom * 2**18
        east, south = np.meshgrid(across - 2**18 * (180 + ORIGIN[1]) / 360, down % 4096)
        height = np.sin(1.3 * east + 0.6 * south) + np.sin(0.5 * east - 1.1 * south) + np.sin(2.9 * east)
        height = np.round(height * 4.0) / 4.0  # few shades: a small picture
        shade = np.stack([205 - 14 * height, 222 - 9 * height, 196 - 16 * height], axis=-1)
        line = (np.diff(height, axis=0, append=height[-1:]) != 0) | (
            np.diff(height, axis=1, append=height[:, -1:]) != 0
        )
        shade[line] -= 32
        file = folder / str(zoom) / str(x) / f"{y}.png"
        file.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(shade.clip(0, 255).astype(np.uint8)).save(file)
    about = {"attribution": "hills that nobody has climbed"}
    (folder / "metadata.json").write_text(json.dumps(about), encoding="utf-8")
    return opened_map(folder)


@asynccontextmanager
async def page_of(*hubs: Hub, map: TileMap | None = None) -> AsyncIterator[str]:
    """The address of a page that serves these."""
    doors = Doors(TOKEN, True, "127.0.0.1")
    server = PageServer(hubs[0], doors, hubs[1] if len(hubs) > 1 else None, map)
    async with served(server, Address("127.0.0.1", 0)) as port:
        tasks = [asyncio.create_task(hub.run()) for hub in hubs]
        try:
            yield f"http://localhost:{port}/?token={TOKEN}"
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)


async def looked(browser: Chromium, url: str, shot: Shot) -> Page:
    """A page of a shot's size and theme, once all its parts draw."""
    page = await browser.new_page(
        viewport={"width": shot.size[0], "height": shot.size[1]},
        color_scheme="dark" if shot.dark else "light",
    )
    page.set_default_timeout(START_MS)
    mark = "&" if "?" in url else "?"
    await page.goto(f"{url}{mark}smooth")  # edges are smoothed without a graphics card, too
    drawn = "(window.page ? page.board !== null && page.frames > 3 : typeof playback !== 'undefined')"
    for part in page.frames[1:] or page.frames:
        await seen(part, drawn, START_MS / 1000)
    return page


async def kept(page: Page, file: Path) -> None:
    """Keep what is seen."""
    await asyncio.sleep(1.0)  # for the curves and the map's tiles
    keep(Image.open(io.BytesIO(await page.screenshot())).convert("RGB"), file)
    await page.close()


def keep(shot: Image.Image, file: Path) -> None:
    """Write a picture: as it is, or in fewer colours where that is too much."""
    shot.save(file, "PNG", optimize=True)
    if file.stat().st_size >= LARGEST:
        few(shot).save(file, "PNG", optimize=True)
    size = file.stat().st_size
    if size >= LARGEST:
        raise ValueError(f"{file}: found {size} bytes, expected fewer than {LARGEST}")
    print(f"{file}: {size // 1000} kB", flush=True)


def few(shot: Image.Image) -> Image.Image:
    """A picture in 256 of its colours: of those that look alike the most frequent."""
    alike: dict[tuple[int, ...], list[tuple[int, tuple[int, ...]]]] = {}
    for count, colour in shot.getcolors(shot.width * shot.height) or ():
        alike.setdefault(tuple(part >> 3 for part in colour), []).append((count, colour))
    most = sorted(alike.values(), key=lambda group: -sum(count for count, _ in group))[:256]
    palette = Image.new("P", (1, 1))
    palette.putpalette([part for group in most for part in max(group)[1]])
    return shot.quantize(palette=palette, dither=Image.Dither.NONE)


async def shown(
    browser: Chromium, source: PageReplay, shots: tuple[Shot, ...], folder: Path, map: TileMap | None = None
) -> None:
    """Take these shots of one source."""
    timeline = None if isinstance(source, AsLive) else source
    async with page_of(Hub(source, "0", timeline), map=map) as url:
        for shot in shots:
            to(source, shot.since_s)
            page = await looked(browser, url, shot)
            await page.evaluate("(id) => page.scene.on.pick(id)", shot.select)
            for key in shot.keys:
                await page.keyboard.press(key)
            await seen(page, f"document.querySelector('tr.chosen').dataset.id === '{shot.select}'")
            await page.evaluate(shot.script)
            await kept(page, folder / f"{shot.name}.png")


async def both(browser: Chromium, runs: tuple[Path, Path], folder: Path, shot: Shot) -> None:
    """Two runs beside each other."""
    sources = [source_of(run) for run in runs]
    for source in sources:
        to(source, shot.since_s)
    async with page_of(*(Hub(source, "0", source) for source in sources)) as url:
        await kept(await looked(browser, url, shot), folder / f"{shot.name}.png")


async def pictures(runs: Runs, folder: Path) -> None:
    """Draw all pictures of the documents."""
    live, lossy = source_of(runs.demo, AsLive), source_of(runs.lossy, AsLive)
    report = (runs.demo / "report.html").resolve().as_uri()
    async with chromium() as browser:
        with tempfile.TemporaryDirectory() as tiles:
            await shown(browser, live, MAP, folder, terrain(Path(tiles)))
        await shown(browser, live, LIVE, folder)
        await shown(browser, source_of(runs.team, AsLive), TEAM, folder)
        await shown(browser, source_of(runs.heights, AsLive), HEIGHTS, folder)
        await shown(browser, source_of(runs.several, AsLive), SEVERAL, folder)
        await shown(browser, source_of(runs.zones, AsLive), ZONES, folder)
        await shown(browser, lossy, ALERTS, folder)
        await shown(browser, source_of(runs.demo), REPLAY, folder)
        await both(browser, (runs.guarded, runs.paper), folder, Shot("page-two-runs", WIDE))
        page = await looked(browser, report, Shot(""))
        await page.evaluate("document.getElementById('stage').scrollIntoView(); playback.move(14)")
        await kept(page, folder / "page-report.png")


async def looks(runs: Runs, folder: Path) -> None:
    """Draw page, replay, two runs and report at three sizes in both themes."""
    live, replay = source_of(runs.demo, AsLive), source_of(runs.demo)
    report = (runs.demo / "report.html").resolve().as_uri()
    async with chromium() as browser:
        for shot in LOOKS:
            await shown(browser, live, (shot._replace(name=f"live{shot.name}"),), folder)
            await shown(browser, replay, (shot._replace(name=f"replay{shot.name}"),), folder)
            await both(browser, (runs.guarded, runs.paper), folder, shot._replace(name=f"both{shot.name}"))
            await kept(await looked(browser, report, shot), folder / f"report{shot.name}.png")


def main() -> None:
    """Fly, and draw what was asked for."""
    parser = argparse.ArgumentParser(prog="python -m tests.support.page_pictures", description=__doc__)
    parser.add_argument("--runs", type=Path, help="keep the runs here, or take them from here if they are")
    parser.add_argument("--look", type=Path, help="draw every size and theme into this folder instead")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as spare:
        folder = options.runs or Path(spare)
        folder.mkdir(parents=True, exist_ok=True)
        made = [next((folder / name).iterdir(), None) for name in Runs._fields if (folder / name).is_dir()]
        runs = Runs(*made) if len(made) == len(Runs._fields) else flown(folder)  # type: ignore[arg-type]
        if options.look:
            options.look.mkdir(parents=True, exist_ok=True)
            asyncio.run(looks(runs, options.look))
        else:
            asyncio.run(pictures(runs, ROOT / "docs" / "pictures"))


if __name__ == "__main__":
    main()
