"""Several evaders, zones and what the team knows on the page, in a real browser."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.gcs.page.test_replay import replayed, source_of
from tests.support.page_stage import chromium, seen
from tests.support.run_folders import make_run
from tests.support.three_on_ten import AFTER, ZONES, R, flight

pytestmark = pytest.mark.real


async def test_a_game_of_three_evaders_is_seen_whole(tmp_path: Path) -> None:
    source = source_of(make_run(tmp_path / "run", list(flight())))
    source.player.pause()
    source.seek_ms(source.told["zero_ms"] + 5000)
    async with replayed(source) as url, chromium() as browser:
        page = await browser.new_page(viewport={"width": 1280, "height": 800})
        page.on("pageerror", lambda error: pytest.fail(f"the page's own error: {error}"))
        await page.goto(url)
        await seen(page, "window.page !== undefined && page.board !== null && page.frames > 1")
        await page.evaluate("page.scene.on.pick(12)")
        await seen(page, "page.scene.ground.chases.children.length === 10")
        told = await page.evaluate(
            """() => {
            const { scene, colours } = page;
            const names = Object.fromEntries(scene.frame.vehicles.map((v) => [v.id, scene.nameOf(v)]));
            const shells = scene.ground.near.children.filter((each) => each.visible);
            return {
              names, shells: shells.map(({ position: { x, y, z } }) => [-z, x, y]),
              places: scene.frame.vehicles.filter((v) => scene.roles[v.role] === "evader")
                .map((v) => [-v.z, v.x, v.y]),
              shades: [1, 12, 13].map((id) => colours.vehicle(id, true)),
              swatches: [1, 12, 13].map((id) => document.querySelector(`tr[data-id="${id}"] .swatch`))
                .map((each) => each.style.background),
              zones: scene.ground.zones.map(({ name, at }) => [name, ...at]),
              arcs: scene.ground.named.map(({ words }) => words), fans: scene.fans.fans.map(({ id }) => id),
              goals: [...document.querySelectorAll("#known .goal")].map((each) => each.textContent),
              relations: [...document.querySelectorAll("#known .relation")].map((each) => each.textContent),
            };
            }"""
        )
        assert told["names"]["12"] == "12 evader"
        assert told["names"]["6"] == f"6 chaser → {AFTER[6]}"
        assert sorted(told["shells"]) == sorted(told["places"])
        assert len(told["shells"]) == 3
        assert len(set(told["shades"])) == len(set(told["swatches"])) == 3
        assert [zone[0] for zone in told["zones"]] == [zone.name for zone in ZONES]
        assert told["zones"][0][2] == 90.0, "its name stands on its ceiling"
        assert told["zones"][1][2] == 150.0, "without an end it is as high as the fence"
        assert sorted(told["fans"]) == [1, 12, 13]
        assert [goal.partition(":")[0] for goal in told["goals"]] == ["evader 1", "evader 12", "evader 13"]
        known = next(word for word in source.picture().game.knowledge if word.quarry == 12)
        by_words = {edge.words: edge.strength for edge in known.edges}
        assert len(told["relations"]) > 3
        for line in told["relations"]:
            words = line[4:]
            assert float(line[:4]) == pytest.approx(by_words[words], abs=0.006), line
        assert any(words.startswith("threatens ") for words in told["arcs"])

        await page.keyboard.press("w")  # relations off
        await seen(page, "page.scene.ground.arcs.children.length === 0")
        await page.evaluate("page.scene.on.pick(2)")  # after evader 1: its game is told
        await seen(page, "document.querySelector('#known').textContent.includes('target 1')")
        assert "evader 1: " in (await page.locator("#known .goal").first.inner_text())

        source.seek_ms(source.told["zero_ms"] + 14000)  # evader 1 is captured
        await seen(page, "page.scene.out.get(1) === 'captured'")
        name = "page.scene.nameOf(page.scene.frame.vehicles.find((v) => v.id === 1))"
        await seen(page, f"{name} === '1 captured'")
        await seen(page, "page.scene.ground.near.children.filter((each) => each.visible).length === 2")
        await seen(page, "page.scene.fans.fans.length === 2")
        cell = page.locator('tr[data-id="1"] td').last
        assert (await cell.inner_text()).startswith("captured by 2 at ")
        assert source.picture().game.setup.rules.R == R
