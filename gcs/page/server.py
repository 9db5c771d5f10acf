"""The page's own server: its files, which it carries itself, and one WebSocket for each browser.

It listens where it is told, asks the network for nothing, and reads its files once, at its start.
"""

from __future__ import annotations

import asyncio
import secrets
import ssl
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from importlib.resources import files
from typing import NamedTuple

from aiohttp import WSMsgType, web

from gcs.page.access import COOKIE, Doors, Rights, rights
from gcs.page.field_tls import name_in
from gcs.page.hub import Browser, Hub
from gcs.page.tiles import TileMap, TileStore, kind_of
from onboard.config.strict import ConfigError

TYPES = {".js": "text/javascript", ".css": "text/css", ".html": "text/html", ".svg": "image/svg+xml"}
MESSAGE_MAX = 4096  # bytes that a browser may say at once
MESSAGES_HZ = 30.0  # and how often, in the long run
BURST = 60.0
SEND_S = 10.0  # a browser that takes nothing for so long has gone
PING_S = 5.0


class Address(NamedTuple):
    """Where a page listens."""

    host: str
    port: int
    tls: ssl.SSLContext | None = None


class Static(NamedTuple):
    """A file of the page."""

    content: bytes
    type: str


def static_files() -> dict[str, Static]:
    """The page's files, from the package."""
    folder = files("gcs.page") / "static"
    return {
        entry.name: Static(entry.read_bytes(), TYPES[ending])
        for entry in folder.iterdir()
        if (ending := f".{entry.name.rpartition('.')[2]}") in TYPES
    }


def policy(nonce: str) -> dict[str, str]:
    """The headers that keep anything but the page's own files out of it."""
    rules = (
        "default-src 'none'", f"script-src 'self' 'nonce-{nonce}'", "style-src 'self'",
        "img-src 'self' data: blob:", "connect-src 'self'", "base-uri 'none'", "form-action 'none'",
        "frame-ancestors 'self'", "frame-src 'self'",
    )  # fmt: skip
    return {
        "Content-Security-Policy": "; ".join(rules), "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer", "Cross-Origin-Opener-Policy": "same-origin",
        "Cache-Control": "no-store",
    }  # fmt: skip


class PageServer:
    """Serves a hub to browsers; of two recordings beside each other, two."""

    def __init__(self, hub: Hub, doors: Doors, second: Hub | None = None, map: TileMap | None = None) -> None:
        self.hub = hub
        self.second = second
        self.doors = doors
        self._tiles = TileStore(map) if map is not None else None
        for each in (hub, second):
            if each is not None and map is not None:
                each.map = map.told()
        self._files = static_files()
        self._sockets: set[web.WebSocketResponse] = set()

    def app(self) -> web.Application:
        """What aiohttp runs."""
        app = web.Application()
        tile = r"/tiles/{z:\d{1,2}}/{x:\d{1,8}}/{y:\d{1,8}}"
        app.add_routes([
            web.get("/", self._page), web.get("/live", self._live), web.get("/{name}", self._file),
            web.get(tile, self._tile),
        ])  # fmt: skip
        return app

    async def close(self) -> None:
        """Tell all browsers that the page ends."""
        for socket in tuple(self._sockets):
            with suppress(Exception):
                await socket.close(code=1001, message=b"the page ends")

    def _rights(self, request: web.Request) -> Rights:
        token = request.query.get("token", "") or request.cookies.get(COOKIE, "")
        member = name_in(request.get_extra_info("peercert"))
        return rights(self.doors, request.headers, token, request.remote or "", member)

    async def _page(self, request: web.Request) -> web.Response:
        found = self._rights(request)
        if not found.look:
            return _refused(found.reason)
        if "token" in request.query:  # out of the address bar, into a cookie that no script reads
            answer = web.Response(status=303, headers={"Location": "/", **policy("")})
            answer.set_cookie(
                COOKIE, request.query["token"], httponly=True, samesite="Strict",
                secure=request.secure, path="/",
            )  # fmt: skip
            return answer
        nonce = secrets.token_urlsafe(16)
        both = self.second is not None and "run" not in request.query
        text = self._files["both.html" if both else "index.html"].content.decode().replace("NONCE", nonce)
        return web.Response(text=text, content_type="text/html", headers=policy(nonce))

    async def _file(self, request: web.Request) -> web.Response:
        found = self._rights(request)
        if not found.look:
            return _refused(found.reason)
        file = self._files.get(request.match_info["name"])
        if file is None or file.type == "text/html":
            return web.Response(status=404, text="no such file", headers=policy(""))
        return web.Response(body=file.content, content_type=file.type, headers=policy(""))

    async def _tile(self, request: web.Request) -> web.Response:
        found = self._rights(request)
        if not found.look:
            return _refused(found.reason)
        z, x, y = (int(request.match_info[name]) for name in "zxy")
        tile = await self._tiles.get(z, x, y) if self._tiles is not None else None
        if tile is None:
            return web.Response(status=404, text="the map has no such tile", headers=policy(""))
        headers = policy("") | {"Cache-Control": "private, max-age=3600"}
        return web.Response(body=tile, content_type=kind_of(tile), headers=headers)

    async def _live(self, request: web.Request) -> web.StreamResponse:
        found = self._rights(request)
        if not found.look:
            return _refused(found.reason)
        socket = web.WebSocketResponse(max_msg_size=MESSAGE_MAX, heartbeat=PING_S, compress=False)
        await socket.prepare(request)
        hub = self.second if request.query.get("run") == "2" and self.second is not None else self.hub
        browser = hub.join(found)
        if browser is None:
            await socket.close(code=1013, message=b"too many browsers")
            return socket
        self._sockets.add(socket)
        sending = asyncio.create_task(_send(socket, browser), name="page-send")
        try:
            await self._hear(socket, hub, browser)
        finally:
            hub.leave(browser)
            self._sockets.discard(socket)
            sending.cancel()
            with suppress(asyncio.CancelledError):
                await sending
        return socket

    async def _hear(self, socket: web.WebSocketResponse, hub: Hub, browser: Browser) -> None:
        loop = asyncio.get_running_loop()
        left, at = BURST, loop.time()
        async for message in socket:
            if message.type is not WSMsgType.TEXT:
                break
            now = loop.time()
            left, at = min(BURST, left + (now - at) * MESSAGES_HZ) - 1.0, now
            if left < 0.0:
                browser.say("too many at once: the page hears 30 a second")
                left = 0.0
                continue
            hub.take(browser, message.data)


async def _send(socket: web.WebSocketResponse, browser: Browser) -> None:
    """Send what waits for a browser, until it has gone."""
    try:
        while not socket.closed:
            content = await browser.next()
            async with asyncio.timeout(SEND_S):
                if isinstance(content, bytes):
                    await socket.send_bytes(content)
                else:
                    await socket.send_str(content)
    except (ConnectionError, TimeoutError, RuntimeError):
        with suppress(Exception):
            await socket.close()


def _refused(reason: str) -> web.Response:
    return web.Response(status=403, text=f"refused: {reason}\n", headers=policy(""))


@asynccontextmanager
async def served(server: PageServer, address: Address) -> AsyncIterator[int]:
    """Serve within the block; it yields the port. Raises ConfigError where it cannot listen."""
    runner = web.AppRunner(server.app(), access_log=None, shutdown_timeout=1.0)
    await runner.setup()
    try:
        site = web.TCPSite(runner, address.host, address.port, ssl_context=address.tls)
        try:
            await site.start()
        except OSError as error:
            raise ConfigError(
                f"page.port: found {address.host}:{address.port}, which cannot be listened at"
                f" ({(error.strerror or str(error)).lower()}), expected a free one"
            ) from None
        bound = runner.addresses[0]
        yield int(bound[1])
    finally:
        await server.close()
        await runner.cleanup()
