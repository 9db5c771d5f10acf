"""The browsers of a page and what they get: one picture for all, made once a tick.

Nobody waits for anybody: a browser that is slow gets the newest frame and board, not all of them.
"""

from __future__ import annotations

import asyncio
from collections import deque
from typing import Protocol

import msgspec

from gcs.console import command_parser
from gcs.console.command_parser import Order
from gcs.console.questions import Questions
from gcs.console.source import Source
from gcs.page import documents, requests
from gcs.page.access import Rights
from gcs.page.fan import Fans
from gcs.page.frames import frame
from gcs.picture.values import Picture
from onboard.wire.bus.messages import CommandKind

TICK_HZ = 10.0
BOARD_EACH = 4  # ticks, or a few less where these are longer
AT_ONCE = 250  # vehicles that are told ten times a second; a larger fleet is told less often
BROWSERS_MOST = 16
SAID_MOST = 32  # answers that wait for one browser
NOT_ALLOWED = "this page only shows: it was started without --control, or opened without its token"


class Timeline(Protocol):
    """What a source that can be moved in time has beside the rest (a replay)."""

    def seek_ms(self, at_ms: int) -> None:
        """Go to this instant [ms since its begin]."""
        ...

    def timeline(self) -> documents.Document:
        """Length, place, speed and whether it plays."""
        ...

    def marks(self) -> documents.Document:
        """What does not change: marks on the timeline, curves."""
        ...


class Browser:
    """One browser: its rights, what it has selected and is asked, and what waits for it."""

    def __init__(self, rights: Rights) -> None:
        self.rights = rights
        self.selected: int | None = None
        self.questions = Questions()
        self._latest: dict[str, str | bytes] = {}  # the newest of each kind, in order of its first waiting
        self._said: deque[str] = deque(maxlen=SAID_MOST)
        self._wake = asyncio.Event()

    def put(self, kind: str, content: str | bytes) -> None:
        """Let the newest of a kind wait to be sent."""
        self._latest[kind] = content
        self._wake.set()

    def say(self, text: str, what: str = "said") -> None:
        """Tell the person at this browser."""
        self._said.append(_json({"what": what, "text": text}))
        self._wake.set()

    async def next(self) -> str | bytes:
        """The next thing to send, once there is one: answers first."""
        while not self._said and not self._latest:
            self._wake.clear()
            await self._wake.wait()
        return self._said.popleft() if self._said else self._latest.pop(next(iter(self._latest)))


class Hub:
    """Feeds browsers from a source, and the source from browsers."""

    def __init__(self, source: Source, version: str, timeline: Timeline | None = None) -> None:
        self.source = source
        self.map: documents.Document | None = None  # what browsers learn of the user's map
        self.browsers: set[Browser] = set()
        self._version = version
        self._timeline = timeline
        self._number = 0
        self._pace = 1  # how many times longer a tick is: one for each `AT_ONCE` vehicles begun
        self._field: str = ""
        self._fans = Fans()

    def join(self, rights: Rights) -> Browser | None:
        """A new browser, which has all that stands; None where there are too many."""
        if len(self.browsers) >= BROWSERS_MOST:
            return None
        browser = Browser(rights)
        steers = rights.command and self.source.steers
        told = documents.hello(self.source.title, steers=steers, version=self._version, map=self.map)
        browser.put("hello", _json(told))
        picture = self.source.picture()
        browser.put("field", _json(documents.field(picture)))
        browser.put("trails", _json(documents.trails(picture)))
        if self._timeline is not None:
            browser.put("marks", _json(self._timeline.marks()))
        browser.put("board", self._board(picture))
        self.browsers.add(browser)
        return browser

    def leave(self, browser: Browser) -> None:
        """It has gone."""
        self.browsers.discard(browser)

    async def run(self) -> None:
        """Feed all browsers until cancelled; nothing is computed while there are none."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            due = max(due + self._pace / TICK_HZ, loop.time())
            await asyncio.sleep(due - loop.time())
            if self.browsers:
                self.tick()

    def tick(self) -> None:
        """Let the newest picture wait for every browser."""
        self._show(self.source.picture())

    def _show(self, picture: Picture, *, whole: bool = False) -> None:
        """Let a picture wait for every browser; its tables too where it is their turn, or `whole`."""
        self._number += 1
        self._pace = max(1, -(-len(picture.vehicles) // AT_ONCE))
        moved = frame(picture, self._number)
        self._fans.take(picture)
        fans = _json(self._fans.document())
        slow = self._number % max(2, BOARD_EACH // self._pace) == 0
        field = _json(documents.field(picture)) if slow else self._field
        for browser in self.browsers:
            browser.put("fans", fans)
            browser.put("frame", moved)
            if browser.questions.lapsed(picture.now_ns):
                browser.say("not done", "answered")
            if field != self._field:
                browser.put("field", field)
        self._field = field
        if slow or whole:
            self._tell(picture)

    def _tell(self, picture: Picture) -> None:
        board = self._board(picture)
        details: dict[int | None, str] = {}
        for browser in self.browsers:
            browser.put("board", board)
            if browser.selected not in details:
                details[browser.selected] = _json(documents.detail(picture, browser.selected))
            browser.put("detail", details[browser.selected])

    def _board(self, picture: Picture) -> str:
        told = documents.board(picture, self.source.status())
        if self._timeline is not None:
            told["timeline"] = self._timeline.timeline()
        return _json(told)

    def take(self, browser: Browser, text: str) -> None:
        """What a browser said."""
        said = requests.request(text)
        if isinstance(said, str):
            browser.say(said)
        elif isinstance(said, requests.Select):
            browser.selected = said.id
            browser.put("detail", _json(documents.detail(self.source.picture(), said.id)))
        elif isinstance(said, requests.Act | requests.Seek):
            self._move(browser, said)
        elif not browser.rights.command:
            browser.say(NOT_ALLOWED)
        else:
            self._steer(browser, said)

    def _move(self, browser: Browser, said: requests.Act | requests.Seek) -> None:
        if self._timeline is None:
            browser.say("this is live: there is nothing to move in time")
            return
        if isinstance(said, requests.Seek):
            self._timeline.seek_ms(said.at_ms)
        elif told := self.source.act(said.action):
            browser.say(told)
        picture = self.source.picture()
        trails = _json(documents.trails(picture))
        for each in self.browsers:
            each.put("trails", trails)
        self._show(picture, whole=True)

    def _steer(self, browser: Browser, said: requests.Request) -> None:
        picture = self.source.picture()
        match said:
            case requests.Abort():
                browser.questions.no()
                ids = tuple(vehicle.id for vehicle in picture.vehicles)
                self._give(browser, Order(CommandKind.ABORT, ids), picture)
            case requests.Give(kind, ids, named):
                known = tuple(sorted({i for i in ids if picture.vehicle(i) is not None}))
                strangers = sorted(set(ids) - set(known))
                if strangers:
                    browser.say(f"no vehicle {strangers[0]}")
                else:
                    self._put(browser, Order(kind, known, named and len(known) == 1), picture)
            case requests.Line(typed):
                self._typed(browser, typed, picture)
            case requests.Yes():
                asked = browser.questions.yes()
                if isinstance(asked, Order):
                    self._give(browser, asked, picture)
            case requests.No():
                if browser.questions.no():
                    browser.say("not done", "answered")
            case requests.Acknowledge(name):
                self.source.acknowledge(name)

    def _typed(self, browser: Browser, text: str, picture: Picture) -> None:
        meaning = command_parser.parse(text, picture, browser.selected)
        if isinstance(meaning, command_parser.Wrong):
            browser.say(meaning.reason)
        elif isinstance(meaning, Order):
            self._put(browser, meaning, picture)
        elif meaning.what == "ack":
            fresh = [alert.name for alert in picture.alerts if not alert.acknowledged]
            if fresh:
                self.source.acknowledge("" if meaning.argument == "all" else meaning.argument or fresh[0])
        elif meaning.what == "select":
            browser.selected = int(meaning.argument)
            browser.say(meaning.argument, "selected")
        else:
            browser.say(meaning.argument, meaning.what)

    def _put(self, browser: Browser, order: Order, picture: Picture) -> None:
        question = browser.questions.put(order, picture)
        if question:
            browser.say(question, "ask")
        else:
            self._give(browser, order, picture)

    def _give(self, browser: Browser, order: Order, picture: Picture) -> None:
        if not order.ids:
            browser.say("no vehicle is known yet")
            return
        told = self.source.command(order.kind, order.ids, named=order.named)
        browser.say(told or f"{order.kind.value} to {command_parser.names(order.ids, picture)}", "answered")
        self._tell(self.source.picture())


def _json(document: documents.Document) -> str:
    return msgspec.json.encode(document).decode()
