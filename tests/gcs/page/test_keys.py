"""The page without a mouse: Tab reaches all that can be pressed, and every key does what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.async_api import Page

from onboard.runtime.resources import configs
from tests.gcs.page.test_replay import replayed, source_of
from tests.support.page_stage import chromium, opened, seen, stage
from tests.support.run_folders import make_run

pytestmark = pytest.mark.real
DOCS = configs().parent / "docs" / "page.md"
NAME = "(e) => [e.id, e.dataset.id, e.ariaLabel, e.matches('button') ? e.textContent : e.tagName].join(' ')"
REACHABLE = """() => [...document.querySelectorAll('button, input, select, tr[data-id], #scene')]
  .filter((e) => e.getClientRects().length && !e.disabled && e.tabIndex >= 0)
  .map(NAME)"""
POINTED = """() => [...document.querySelectorAll('button, input, select')]
  .filter((e) => e.getClientRects().length && !e.disabled && e.tabIndex < 0).map((e) => e.className)"""
FOCUSED = "(NAME)(document.activeElement)"
CAMERA = "(({ position: p, zoom }) => [p.x, p.y, p.z, zoom])(page.scene.camera)"


async def reached(page: Page) -> tuple[set[str], set[str]]:
    """What can be pressed, and what Tab comes by."""
    there = set(await page.evaluate(REACHABLE.replace("NAME", NAME)))
    found: set[str] = set()
    for _ in range(2 * len(there) + 20):
        await page.keyboard.press("Tab")
        found.add(await page.evaluate(FOCUSED.replace("NAME", NAME)))
        if there <= found:
            break
    return there & set(await page.evaluate(REACHABLE.replace("NAME", NAME))), found  # alerts come and go


async def test_the_live_page_without_a_mouse() -> None:
    async with stage(3) as made, chromium() as browser:
        page = await opened(browser, made)
        await seen(page, "document.querySelectorAll('tr[data-id]').length === 3")
        there, found = await reached(page)
        assert len(there) > 25
        assert there <= found
        assert not await page.evaluate(POINTED)
        await page.evaluate("document.activeElement.blur()")
        await a_button_does_the_same_by_its_key(page)
        await keys_turn_shift_and_near_the_camera(page)
        await the_documents_name_every_key(page)


async def test_tab_reaches_everything_of_a_replay_and_keys_move_it(tmp_path: Path) -> None:
    source = source_of(make_run(tmp_path / "run"))
    source.player.pause()
    async with replayed(source) as url, chromium() as browser:
        page = await browser.new_page(viewport={"width": 1280, "height": 800})
        await page.goto(url)
        await seen(page, "window.page !== undefined && page.replay && page.frames > 0")
        there, found = await reached(page)
        assert there <= found
        # Marks of alerts and events are many; the brackets go from one to the next.
        assert all("mark" in name for name in await page.evaluate(POINTED))
        await page.evaluate("document.activeElement.blur()")
        marks = sorted({mark["at_ms"] for mark in source.told["marks"]})
        await page.keyboard.press("Home")
        await seen(page, "page.replay.at_ms === 0")
        at = 0
        for _ in range(2):
            at = next(mark for mark in marks if mark > at + 50)
            await page.keyboard.press("]")
            await seen(page, f"Math.abs(page.replay.at_ms - {at}) <= 1")
        await page.keyboard.press("[")
        before = max(mark for mark in marks if mark < at - 50)
        await seen(page, f"Math.abs(page.replay.at_ms - {before}) <= 1")
        await page.keyboard.press("End")
        await seen(page, f"page.replay.at_ms === {source.timeline()['length_ms']}")
        await page.keyboard.press("+")
        await seen(page, "page.replay.speed === 2")
        await page.keyboard.press("-")
        await seen(page, "page.replay.speed === 1")


async def a_button_does_the_same_by_its_key(page: Page) -> None:
    shown = "document.querySelectorAll('#views button[aria-pressed]')"
    pressed = f"[...{shown}].map((b) => b.getAttribute('aria-pressed')).join()"
    buttons = page.locator("#views button[aria-pressed]:has(kbd):visible")
    assert await buttons.count() == 7
    for i in range(7):
        key = (await buttons.nth(i).locator("kbd").text_content()) or ""
        before = await page.evaluate(pressed)
        await buttons.nth(i).click()
        by_click = await page.evaluate(pressed)
        await page.keyboard.press(key)
        assert await page.evaluate(pressed) == before != by_click, key
        await page.keyboard.press(key)
        assert await page.evaluate(pressed) == by_click, key
        await page.keyboard.press(key)


async def keys_turn_shift_and_near_the_camera(page: Page) -> None:
    for view in ("space", "plan"):
        for key in ("Shift+ArrowLeft", "Shift+ArrowUp", "PageUp"):
            before = await page.evaluate(CAMERA)
            await page.keyboard.press(key)
            assert await page.evaluate(CAMERA) != pytest.approx(before, rel=1e-3), (view, key)
        distance = "page.scene.perspective.position.distanceTo(page.scene.orbit.target)"
        near = await page.evaluate(distance)
        await page.keyboard.press("PageDown")
        assert await page.evaluate(distance) == pytest.approx((1.2 if view == "space" else 1.0) * near)
        await page.keyboard.press("v")
    selected = await page.evaluate("page.selected")
    await page.keyboard.press("Shift+ArrowDown")  # the camera's, not the table's
    assert await page.evaluate("page.selected") == selected


async def the_documents_name_every_key(page: Page) -> None:
    await page.keyboard.press("?")
    rows = await page.locator("#help td:first-child").all_text_contents()
    text = DOCS.read_text(encoding="utf-8").split("## Keys")[1].split("\n## ")[0]
    named = set(re.findall(r"`([^`]+)`", text))
    for row in rows[: rows.index("?") + 1]:
        keys = row.split(", ") if row.startswith("page up") else row.split(" ")
        assert set(keys) <= named, row
