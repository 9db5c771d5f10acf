"""Nothing on the page hides or cuts off anything, on a laptop, a large screen and a tablet held upright."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest
from playwright.async_api import Page

from tests.gcs.page.test_replay import replayed, source_of
from tests.support.page_stage import chromium, opened, seen, stage
from tests.support.run_folders import make_run

pytestmark = pytest.mark.real
SIZES = ((1280, 800), (1920, 1080), (820, 1180))  # [px]
LABELS = """() => [...document.querySelectorAll('.mark.phase:not(.bare)')].map((tick) => {
  const range = document.createRange();
  range.selectNodeContents(tick);
  const box = range.getBoundingClientRect();
  return [tick.textContent, box.left, box.top, box.right, box.bottom];
})"""
NAMES = """() => new Promise((done) => {
  const [scene, found] = [page.scene, []];
  const text = scene.text.bind(scene);
  scene.text = (pen, words, x, y) => found.push([words, x, y - 6, x + pen.measureText(words).width, y + 6]);
  scene.drawNames(scene.labels.getContext('2d'));
  scene.text = text;
  done(found);
})"""
CUT = """() => [...document.querySelectorAll('header *, #views *, .transport *, #orders *')]
  .filter((each) => each.getClientRects().length)
  .map((each) => [each.id || each.textContent, each.getBoundingClientRect()])
  .filter(([, box]) => box.left < -0.5 || box.right > innerWidth + 0.5 || box.top < -0.5)
  .map(([name]) => name)"""

DRAWN = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"

Box = list


def overlapping(boxes: list[Box]) -> list[tuple[str, str]]:
    """Which of these [words, left, top, right, bottom] lie over each other by more than a pixel."""
    return [
        (a[0], b[0])
        for a, b in combinations(boxes, 2)
        if min(a[3], b[3]) - max(a[1], b[1]) > 1.0 and min(a[4], b[4]) - max(a[2], b[2]) > 1.0
    ]


def test_boxes_over_each_other_are_found() -> None:
    assert overlapping([["a", 0, 0, 10, 10], ["b", 5, 5, 15, 15], ["c", 20, 0, 30, 10]]) == [("a", "b")]


async def test_phases_can_be_read_on_the_timeline_at_every_size(tmp_path: Path) -> None:
    source = source_of(make_run(tmp_path / "run"))
    source.player.pause()
    length = source.timeline()["length_ms"]
    phases = {"staging": 0, "ready": 0.004, "running": 0.01, "ended": 0.97, "recovery": 1.0}
    source.told["marks"] = [
        {"at_ms": round(length * at), "kind": "phase", "text": text} for text, at in phases.items()
    ]
    async with replayed(source) as url, chromium() as browser:
        page = await browser.new_page()
        await page.goto(url)
        await seen(page, "window.page !== undefined && document.querySelectorAll('.mark.phase').length === 5")
        for size in SIZES:
            await resized(page, size)
            assert await page.evaluate("page.scene.host.clientHeight >= 0.3 * innerHeight")
            boxes = await page.evaluate(LABELS)
            assert {"ended", "recovery"} <= {box[0] for box in boxes}
            assert len(boxes) >= 4  # three in a hundredth of the lane: one has its tick alone
            assert not overlapping(boxes)
            lane = await page.locator(".track").bounding_box()
            assert lane is not None
            assert all(lane["x"] <= box[1] and box[3] <= lane["x"] + lane["width"] for box in boxes)
            assert not await page.evaluate(CUT)
            assert await page.evaluate("document.documentElement.scrollWidth <= innerWidth")
            titles = await page.locator(".mark.phase").evaluate_all("ticks => ticks.map((t) => t.title)")
            assert all(title.split(" ", 1)[1] in phases for title in titles)


async def test_the_live_page_at_every_size_its_names_and_its_legend() -> None:
    async with stage(4) as made, chromium() as browser:
        page = await opened(browser, made)
        await seen(page, "document.querySelector('#orders button') !== null")
        for size in SIZES:
            await resized(page, size)
            abort = await page.locator("#abort").bounding_box()
            assert abort is not None
            assert abort["y"] < 40
            assert size[0] - 24 < abort["x"] + abort["width"] <= size[0]
            assert not await page.evaluate(CUT)
            assert await page.evaluate("document.documentElement.scrollWidth <= innerWidth")
            alerts, table = [await page.locator(f"#{name}").bounding_box() for name in ("alerts", "vehicles")]
            assert alerts is not None
            assert table is not None
            assert alerts["y"] < table["y"]
        await the_legend_says_what_shapes_mean(page)
        await names_keep_off_each_other(page)


async def names_keep_off_each_other(page: Page) -> None:
    places = "page.scene.frame.vehicles.forEach((v, i) => { v.x = i % 2; v.z = 0; v.y = 50; })"
    await page.evaluate(f"() => {{ page.scene.setFrame = () => {{}}; {places}; }}")
    boxes = [box for box in await page.evaluate(NAMES) if box[0][0].isdigit()]
    assert len(boxes) == 4
    assert not overlapping(boxes)


async def the_legend_says_what_shapes_mean(page: Page) -> None:
    assert await page.locator("#legend").is_hidden()
    await page.keyboard.press("g")
    said = " ".join(await page.locator("#legend dd").all_text_contents())
    for thing in ("evader", "aim", "target", "capture", "safety", "Apollonius", "blocked", "free", "fence"):
        assert thing in said
    drawn = await page.locator("#legend").inner_html()
    used = ("capture", "safety", "target", "apollonius", "cone", "fence", "free")
    for colour in await page.evaluate("(names) => names.map((n) => page.colours[n])", list(used)):
        assert colour in drawn
    await page.locator("#legend-on").click()
    assert await page.locator("#legend").is_hidden()


async def resized(page: Page, size: tuple[int, int]) -> None:
    """Once the page has drawn itself anew."""
    await page.set_viewport_size({"width": size[0], "height": size[1]})
    await page.evaluate(
        "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
