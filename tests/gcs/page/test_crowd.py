"""A large fleet before a browser: all of it is seen, and its drawing compiles nothing anew."""

from __future__ import annotations

import asyncio

import pytest

from gcs.page.hub import AT_ONCE
from onboard.wire.bus.topics import IDS_MOST
from tests.support.page_stage import chromium, opened, seen, stage
from tests.support.sample_messages import Tower, decision, health, setup, state, track

COUNT_PROGRAMS = """(() => {
  const { linkProgram } = WebGL2RenderingContext.prototype;
  window.linked = 0;
  WebGL2RenderingContext.prototype.linkProgram = function (...given) { window.linked += 1; return linkProgram.apply(this, given); };
})()"""  # noqa: E501


def test_a_fleet_as_large_as_the_bus_can_name_is_in_the_picture_and_no_larger():
    tower = Tower()
    for id in (1, 250, 251, IDS_MOST):
        tower.hear(state(id), health(id), decision(id))
    assert [vehicle.id for vehicle in tower.picture.vehicles] == [1, 250, 251, IDS_MOST]
    assert tower.picture.dropped == ()
    tower.hear(state(IDS_MOST + 1))
    assert tower.picture.dropped == (("foreign", 1),)


def test_alerts_of_a_large_fleet_come_as_a_small_one_s_and_its_replay_has_the_same():
    tower = Tower()
    for id in range(1, 2 * AT_ONCE + 2):
        tower.hear(state(id, tower.now_ns))
    for _ in range(30):
        tower.wait(0.1)
        for id in range(2, 2 * AT_ONCE + 2):
            tower.hear(state(id, tower.now_ns))
    assert "lost:1" in tower.alerts()
    assert len(tower.alerts()) == 1
    again = Tower()
    for key, payload, now_ns in tower.stream:
        again.reducer.apply(key, payload, now_ns)
    again.now_ns = tower.now_ns
    assert again.picture.alerts == tower.picture.alerts
    raised = next(alert.raised_ns for alert in tower.picture.alerts)
    assert 1.0 <= (raised - tower.stream[0][2]) / 1e9 <= 1.0 + 4 * 0.1


@pytest.mark.real
async def test_a_browser_sees_a_fleet_larger_than_one_network_and_compiles_its_drawing_once():
    count = AT_ONCE + 50
    async with stage(3) as made, chromium() as browser:
        context = await browser.new_context(viewport={"width": 1280, "height": 800})
        await context.add_init_script(COUNT_PROGRAMS)
        made.tell(setup(3))
        page = await opened(browser, made, context=context)

        async def fly() -> None:
            while True:
                now_ns = made.station.now_ns()
                for id in range(1, count + 1):
                    made.tell(state(id, now_ns, position=(10.0 * (id % 17), 5.0 * id, -50.0)))
                    made.tell(decision(id, now_ns))
                made.tell(track(1, now_ns))
                await asyncio.sleep(0.3)

        flying = asyncio.create_task(fly())
        try:
            await seen(page, f"page.board.vehicles.length === {count}")
            await seen(page, f"page.scene.frame.vehicles.length === {count}")
            await seen(page, f"page.scene.ground.aims.geometry.drawRange.count >= 2 * {count}")
            await seen(page, "page.scene.ground.expected.length === 3")
            await page.evaluate("page.frames = 0")
            await seen(page, "page.frames >= 8", 30.0)  # all has been drawn once
            assert await page.evaluate("page.linked = linked") > 3  # the count counts
            await seen(page, "page.frames >= 20", 30.0)
            assert await page.evaluate("linked - page.linked") == 0
        finally:
            flying.cancel()
