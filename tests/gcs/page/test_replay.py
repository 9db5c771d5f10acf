"""A recording on the page: wherever the slider goes, the scene is where the recording was then."""

from __future__ import annotations

import asyncio
import time
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from gcs.page.access import Doors
from gcs.page.hub import Hub
from gcs.page.replay import PageReplay, marks_of, opened
from gcs.page.server import Address, PageServer, served
from gcs.picture.thresholds import Thresholds
from gcs.replay.source import open_run
from gcs.report.program import read_run
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import RealClock
from tests.support.chase_messages import chase
from tests.support.page_stage import chromium, seen
from tests.support.run_folders import make_run

pytestmark = pytest.mark.real


def source_of(run: Path) -> PageReplay:
    recording = open_run(run)
    found = opened(recording, Thresholds(), "")
    told = marks_of(recording, found, read_run(run))
    return PageReplay(found.player, run.name, RealClock().monotonic_ns, told)


@asynccontextmanager
async def replayed(*sources: PageReplay):
    hubs = [Hub(source, "0", source) for source in sources]
    async with served(
        PageServer(hubs[0], Doors("", False, "127.0.0.1"), *hubs[1:]), Address("127.0.0.1", 0)
    ) as port:
        tasks = [asyncio.create_task(hub.run()) for hub in hubs]
        try:
            yield f"http://localhost:{port}/"
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_run(tmp_path_factory.mktemp("runs") / "run")


def test_marks_and_curves_are_the_recordings(run: Path) -> None:
    source, values = source_of(run), read_run(run)
    told = source.marks()
    phases = [mark["text"] for mark in told["marks"] if mark["kind"] == "phase"]
    assert phases[:3] == ["staging", "ready", "running"]
    by_name = {curve["name"]: curve for curve in told["curves"]}
    gap = values.gaps()[0]
    line = next(line for line in by_name["distance to the evader"]["lines"] if line["id"] == gap.id)
    assert np.interp(line["t"], gap.t, gap.distance) == pytest.approx(line["y"], abs=0.02)
    assert by_name["rule in force"]["rows"]
    length = source.timeline()["length_ms"]
    assert all(0 <= mark["at_ms"] <= length for mark in told["marks"])


def test_a_jump_costs_a_small_part_of_playing_up_to_there(tmp_path: Path) -> None:
    """By a ratio of processor times, which another load on the machine changes little; the page's own figures
    are in benchmarks/results/page-scrub.md."""
    source = source_of(make_run(tmp_path / "long", list(chase(90.0))))
    player = source.player
    begun = time.process_time()
    player.seek(player.start_ns)
    while not player.ended:  # at this pace through all of it, as without an index
        player.advance(NS_PER_S)
    through = time.process_time() - begun
    player.pause()
    length = source.timeline()["length_ms"]
    took = []
    for i in range(1, 21):
        begun = time.process_time()
        source.seek_ms(i * 9 % 20 * length // 20)
        source.picture()
        took.append(time.process_time() - begun)
    assert sorted(took)[18] < 0.2 * through  # half of it on average without an index; 4 s of 90 with one


async def test_the_slider_moves_the_scene_to_where_the_recording_was(run: Path) -> None:
    values = read_run(run)
    async with replayed(source_of(run)) as url, chromium() as browser:
        page = await browser.new_page(viewport={"width": 1280, "height": 800})
        await page.goto(url)
        await seen(page, "window.page !== undefined && page.replay && page.frames > 0")
        await page.keyboard.press(" ")
        await seen(page, "page.replay.playing === false")
        zero_ms = source_of(run).marks()["zero_ms"]
        for since in (3.0, 1.0, 5.5):
            at_ms = round(zero_ms + 1000 * since)
            await page.evaluate(
                "(at) => { const s = document.querySelector('#time input'); s.value = at;"
                " s.dispatchEvent(new Event('change')); }",
                at_ms,
            )
            shown_ms = at_ms // 100 * 100  # the slider's step
            await seen(page, f"Math.abs(page.replay.at_ms - {shown_ms}) < 100")
            for id, flown in values.flown.items():
                then = (shown_ms - zero_ms) / 1000
                place = [np.interp(then, flown.t, flown.position[:, axis]) for axis in range(3)]
                await seen(page, f"page.scene.where.has({id})")
                east, up, south = await page.evaluate(f"page.scene.where.get({id})")
                speed = max(5.0, float(flown.groundspeed.max()))
                assert [-south, east, -up] == pytest.approx(place, abs=0.25 * speed)
        await page.keyboard.press(".")
        await seen(page, f"Math.abs(page.replay.at_ms - {shown_ms} - 100) < 60")
        await page.locator("#time button", has_text="loop").click()
        await seen(page, "page.replay.loops")
        assert await page.locator("#abort").is_hidden()  # nobody is there to command
        assert await page.locator("#orders").is_hidden()


async def test_two_runs_stand_beside_each_other_at_one_time_since_their_start(run: Path) -> None:
    first, second = source_of(run), source_of(run)
    async with replayed(first, second) as url, chromium() as browser:
        page = await browser.new_page(viewport={"width": 1280, "height": 800})
        await page.goto(url)
        while len(page.frames) < 3:  # noqa: ASYNC110 - frames set no event
            await asyncio.sleep(0.05)
        halves = page.frames[1:]
        for half in halves:
            await seen(half, "window.page !== undefined && page.replay && page.frames > 0")
        await halves[0].evaluate(
            "() => { const s = document.querySelector('#time input'); s.value = 4000;"
            " s.dispatchEvent(new Event('change')); }"
        )
        await seen(halves[1], "page.replay.at_ms >= 3900")
        assert second.timeline()["at_ms"] >= 3900
