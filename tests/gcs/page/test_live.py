"""The live page in a real browser: what is shown is what the bus tells, and orders are the console's."""

from __future__ import annotations

import asyncio
import re

import pytest

from gcs.picture.values import LegState
from onboard.wire.bus.messages import CommandKind
from tests.support.page_stage import chromium, opened, seen, stage
from tests.support.real_time import until
from tests.support.sample_messages import setup

pytestmark = pytest.mark.real
COMMANDS = "document.getElementById('command-list').textContent"

EVERYBODY = dict.fromkeys(range(1, 7), LegState.CONFIRMED)


def legs(made, kind):
    """Who was given an order of this kind, and how it stands; of the newest."""
    found = [command for command in made.station.picture().commands if command.kind is kind]
    return {leg.id: leg.state for leg in found[-1].legs} if found else {}


async def test_the_table_the_detail_and_the_scene_show_what_the_bus_tells():
    async with stage(3) as made, chromium() as browser:
        made.tell(setup(3))
        page = await opened(browser, made)
        await seen(page, "document.querySelectorAll('#vehicles tbody tr').length === 3")
        rows = await page.locator("#vehicles tbody tr").all_inner_texts()
        assert [row.split("\t")[0].strip() for row in rows] == ["1", "2", "3"]
        assert all("GUIDED" in row for row in rows)
        await page.locator("#vehicles tbody tr").nth(1).click()
        await seen(page, "document.querySelector('#detail').textContent.includes('2 pursuer')")
        at = await page.evaluate("page.scene.where.get(2)")  # east, up, south
        assert at == pytest.approx(
            [200.0, 50.0, 0.0]
        )  # tests/support/sample_messages: 100 m east of each other
        shown = await page.evaluate("page.scene.frame.vehicles.map(v => [v.id, v.vx, v.vz])")
        assert shown == [[i, 0.0, -10.0] for i in (1, 2, 3)]  # north at 10 m/s


async def test_many_are_marked_and_ordered_and_return_asks_as_in_the_console():
    async with stage(4) as made, chromium() as browser:
        page = await opened(browser, made)
        rows = page.locator("#vehicles tbody tr")
        await rows.nth(1).click()
        await rows.nth(3).click(modifiers=["Shift"])
        assert "2, 3, 4" in await page.locator("#orders .whom").inner_text()
        await page.keyboard.press("h")
        await until(lambda: legs(made, CommandKind.HOLD) == dict.fromkeys((2, 3, 4), LegState.CONFIRMED))
        await page.keyboard.press("b")
        await seen(page, "document.getElementById('question').open")
        assert await page.locator("#question-text").inner_text() == "return 2, 3, 4?"
        assert legs(made, CommandKind.RETURN) == {}
        await page.keyboard.press("n")
        await seen(page, "document.getElementById('said').textContent === 'not done'")
        assert legs(made, CommandKind.RETURN) == {}
        await page.keyboard.press("b")
        await seen(page, "document.getElementById('question').open")
        await page.keyboard.press("y")
        await until(lambda: legs(made, CommandKind.RETURN) == dict.fromkeys((2, 3, 4), LegState.CONFIRMED))
        await page.locator("#line").fill("hold 9")
        await page.locator("#line").press("Enter")
        await seen(page, "document.getElementById('said').textContent === 'no vehicle 9'")


async def test_an_abort_is_one_click_or_key_and_confirmed_though_three_in_ten_messages_are_lost():
    async with chromium() as browser:
        for seed, way in enumerate(("click", "x", "Control+x")):
            async with stage(6, loss=0.3, seed=seed) as made:
                page = await opened(browser, made)
                if way == "click":
                    await page.locator("#abort").click()
                else:
                    if way == "Control+x":
                        await page.locator("#line").focus()
                    await page.keyboard.press(way)
                await until(lambda made=made: legs(made, CommandKind.ABORT) == EVERYBODY)
                await seen(page, f"{COMMANDS}.includes('abort: 6 of 6 confirmed in ')")
                await page.close()


async def test_who_has_not_confirmed_is_named_meanwhile():
    async with stage(3) as made, chromium() as browser:
        made.agents[2].refuses = "a pilot flies"
        page = await opened(browser, made)
        await page.locator("#abort").click()
        await seen(
            page,
            f"{COMMANDS}.includes('2 of 3 confirmed') && {COMMANDS}.includes('3: refused (a pilot flies)')",
        )


async def test_two_browsers_see_one_picture_and_one_alert_is_seen_in_both():
    async with stage(3) as made, chromium() as browser:
        first, second = await opened(browser, made), await opened(browser, made)
        made.agents.pop()  # vehicle 3 falls silent
        lost = "document.getElementById('alert-list').textContent.includes('vehicle 3 is lost')"
        await seen(first, lost)
        await seen(second, lost)
        await first.locator("#alert-list button").first.click()
        await seen(second, "document.querySelector('#alert-list li').classList.contains('seen')")
        await second.locator("#abort").click()
        await seen(first, f"{COMMANDS}.includes('abort')")


async def test_a_lost_connection_greys_the_page_says_since_when_and_comes_back():
    async with chromium() as browser:
        async with stage(2) as made:
            page = await opened(browser, made)
            port = made.port
            await page.locator("tr[data-id='2']").click()
            assert await page.locator("#orders .whom").inner_text() == "to vehicle 2"
            assert not await page.evaluate("document.body.classList.contains('lost')")
        await seen(page, "document.body.classList.contains('lost')")
        silent_ms = await page.evaluate("performance.now() - page.heard")
        assert silent_ms > 1400.0
        told = await page.locator("#lost").inner_text()
        assert re.search(r"Connection lost since \d\d:\d\d:\d\d UTC", told)
        async with stage(2, port=port):
            await seen(page, "!document.body.classList.contains('lost')")
            assert await page.locator("#lost").is_hidden()
            # An order would go to the vehicle that is still selected, and the page says so.
            assert await page.evaluate("page.ids.join()") == "2"
            assert await page.locator("#orders .whom").inner_text() == "to vehicle 2"


async def test_no_request_leaves_the_page_and_words_from_the_network_are_no_markup():
    async with stage(2) as made, chromium() as browser:
        evil = '<script>window.evil = 1</script><img src=x onerror="window.evil = 1">'
        made.tell(setup(2, scenario=evil))
        for agent in made.agents:
            agent.mode = evil
        page = await opened(browser, made)
        await seen(page, "document.getElementById('game').textContent.startsWith('<script>')")
        await seen(page, "document.getElementById('vehicles').textContent.includes('<script>')")
        await asyncio.sleep(0.5)
        assert await page.evaluate("window.evil") is None
        assert await page.evaluate("document.images.length") == 0
        assert made.requests
        assert {url.split("/")[2] for url in made.requests} == {f"localhost:{made.port}"}
