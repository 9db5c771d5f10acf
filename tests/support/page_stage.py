"""A page with real sockets before a real browser: a station on a bus in memory, and agents that answer."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

import numpy as np
import pytest
from playwright.async_api import Browser as Chromium
from playwright.async_api import BrowserContext, Page, async_playwright

from gcs.console.source import Key
from gcs.page.access import Doors
from gcs.page.hub import Hub
from gcs.page.server import Address, PageServer, served
from gcs.page.tiles import TileMap
from gcs.picture.values import Picture
from gcs.station import Station, StationSetup
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.clock import RealClock
from onboard.runtime.impairment import Impairment
from onboard.wire.bus.messages import CommandKind, Message
from tests.support.answering_agents import AnsweringAgent
from tests.support.real_time import patience, until
from tests.support.sample_messages import GAME, TOPIC, on_bus

TOKEN = "a-token-for-the-tests"
OPTIONS = (
    "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)  # fmt: skip


class LiveSource:
    """A station as the page's source."""

    title = "live"
    keys: tuple[Key, ...] = ()
    steers = True
    leaving = ""

    def __init__(self, station: Station) -> None:
        self.station = station

    def picture(self) -> Picture:
        return self.station.picture()

    def hint(self) -> str:
        return ""

    def nobody(self) -> tuple[str, ...]:
        return ()

    def status(self) -> str:
        return "bus open"

    def act(self, action: str) -> str:
        return ""

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        self.station.command(kind, ids, named=named)
        return ""

    def acknowledge(self, alert: str) -> None:
        self.station.acknowledge(alert)


@dataclass
class Stage:
    """What a test works with."""

    station: Station
    hub: Hub
    server: PageServer
    broker: MemoryBroker
    agents: list[AnsweringAgent]
    port: int = 0
    requests: list[str] = field(default_factory=list)
    silent: bool = False  # agents say nothing for a while

    @property
    def url(self) -> str:
        return f"http://localhost:{self.port}/"

    def tell(self, message: Message, id: int | None = None) -> None:
        """Somebody publishes this."""
        key, payload = on_bus(message)
        self.agents[0].bus.publish(key, payload, TOPIC[type(message)].delivery)

    async def speak(self) -> None:
        while True:
            if not self.silent:
                for agent in self.agents:
                    agent.speak()
            await asyncio.sleep(0.1)


@asynccontextmanager
async def stage(
    count: int = 3,
    *,
    control: bool = True,
    loss: float = 0.0,
    port: int = 0,
    seed: int = 1,
    map: TileMap | None = None,
    doors: Doors | None = None,
    tls: ssl.SSLContext | None = None,
) -> AsyncIterator[Stage]:
    """A page of `count` vehicles. `loss`: share of all messages of the bus that is lost, each way."""
    clock = RealClock()
    impaired = Impairment(loss=loss) if loss else None
    broker = MemoryBroker(impaired, np.random.default_rng(seed)) if impaired else MemoryBroker()
    station = Station(broker.connect("gcs"), clock, StationSetup(GAME))
    agents = [AnsweringAgent(broker.connect(f"agent {i}"), clock, i) for i in range(1, count + 1)]
    hub = Hub(LiveSource(station), "0")
    server = PageServer(hub, doors or Doors(TOKEN, control, "127.0.0.1"), map=map)
    made = Stage(station, hub, server, broker, agents)
    async with served(server, Address("127.0.0.1", port, tls)) as bound:
        made.port = bound
        tasks = [asyncio.create_task(run) for run in (station.run(), hub.run(), made.speak())]
        try:
            await until(lambda: len(station.ids()) == count)
            yield made
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)


def browser_path() -> str:
    """An installed browser; without one the test is skipped, or fails where it is demanded."""
    from tests.gcs.report.test_report_browser import browser_path as found

    return found()


@asynccontextmanager
async def chromium() -> AsyncIterator[Chromium]:
    """A real browser."""
    async with async_playwright() as playwright:
        launched = await playwright.chromium.launch(executable_path=browser_path(), args=list(OPTIONS))
        try:
            yield launched
        finally:
            await launched.close()


async def seen(page: Page, expression: str, promised_s: float = 10.0) -> None:
    """Wait until an expression holds in the page, whose policy lets nobody evaluate strings in it."""
    async with asyncio.timeout(patience(promised_s)):
        while not await page.evaluate(expression):  # noqa: ASYNC110 - the page sets no event
            await asyncio.sleep(0.02)


async def opened(
    browser: Chromium, made: Stage, *, token: bool = True, context: BrowserContext | None = None
) -> Page:
    """The page in a browser of its own, once it draws. Its requests are kept, its errors fail the test."""
    context = context or await browser.new_context(viewport={"width": 1280, "height": 800})
    page = await context.new_page()
    page.on("request", lambda request: made.requests.append(request.url))
    page.on("pageerror", lambda error: pytest.fail(f"the page's own error: {error}"))
    await page.goto(made.url + (f"?token={TOKEN}" if token else ""))
    await seen(page, "window.page !== undefined && page.board !== null && page.frames > 1")
    return page
