"""The scene of a report as a GIF: a headless Chromium of this computer draws it, frame by frame."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import tempfile
from collections.abc import AsyncIterator, Callable
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from onboard.config.strict import ConfigError

BROWSERS = (
    "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
)  # fmt: skip
FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--use-gl=angle",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--remote-debugging-port=0",
)  # fmt: skip
FRAMES = 80  # of the whole flight
FRAME_MS = 100  # that each is shown
SIZE = (800, 460)  # [px]
START_S, ANSWER_S = 60.0, 60.0
Tell = Callable[[float, str], None]
READY = "typeof playback !== 'undefined' && playback.scene.drawn > 0"
DRAWN = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(playback.t))))"


class Tab(NamedTuple):
    """A page of a browser, spoken to by its DevTools protocol."""

    socket: Any
    numbers: list[int]

    async def ask(self, method: str, **given: object) -> dict[str, Any]:
        """The result of a command. Raises ConfigError where the browser refuses or says nothing."""
        self.numbers[0] += 1
        await self.socket.send_json({"id": self.numbers[0], "method": method, "params": given})
        try:
            async with asyncio.timeout(ANSWER_S):
                while True:
                    told = json.loads((await self.socket.receive()).data)
                    if told.get("id") == self.numbers[0]:
                        break
        except (TimeoutError, TypeError, ValueError):
            raise ConfigError(f"--gif: the browser gave no answer to {method}") from None
        if "error" in told:
            raise ConfigError(f"--gif: the browser refused {method}: {told['error'].get('message', '')}")
        found: dict[str, Any] = told["result"]
        return found

    async def value(self, expression: str) -> Any:
        """What an expression of the page comes to."""
        found = await self.ask(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        return found.get("result", {}).get("value")


def browser_path() -> str:
    """A Chromium of this computer. Raises ConfigError where there is none."""
    found = next((path for path in BROWSERS if Path(path).exists()), "")
    if not found:
        raise ConfigError(
            "--gif: found no Chromium or Chrome on this computer, expected one to draw the scene"
        )
    return found


def write_gif(page: Path, gif: Path, tell: Tell = lambda share, what: None) -> Path:
    """Draw the scene of a report into a GIF. Raises ConfigError with one line."""
    try:
        import aiohttp  # noqa: F401
        from PIL import Image
    except ModuleNotFoundError as error:
        raise ConfigError(f"--gif: found no {error.name}, expected: pip install 'apollonius[page]'") from None
    pictures = asyncio.run(_frames(f"{page.resolve().as_uri()}?smooth", browser_path(), tell))
    shades = [
        Image.open(BytesIO(picture)).convert("P", palette=Image.Palette.ADAPTIVE) for picture in pictures
    ]
    try:
        shades[0].save(gif, save_all=True, append_images=shades[1:], duration=FRAME_MS, loop=0, optimize=True)
    except OSError as error:
        raise ConfigError(f"{gif}: {(error.strerror or str(error)).lower()}") from None
    return gif


async def _frames(page: str, browser: str, tell: Tell) -> list[bytes]:
    """PNG pictures of the scene over the whole flight."""
    async with _tab(browser) as tab:
        width, height = SIZE
        await tab.ask("Page.enable")
        window = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        await tab.ask("Emulation.setDeviceMetricsOverride", **window)
        await tab.ask("Page.navigate", url=page)
        async with asyncio.timeout(START_S):
            while not await tab.value(READY):  # noqa: ASYNC110 - the page sets no event
                await asyncio.sleep(0.1)
        await tab.value(
            "(() => { const s = document.getElementById('stage');"
            f" s.style.cssText = 'position:fixed;top:0;left:0;z-index:9;width:{width}px;height:{height}px';"
            " playback.scene.resize(); playback.scene.fit(); })()"
        )
        begin, end = await tab.value("[Math.max(0, playback.data.begin), playback.data.end]")
        found = []
        for number in range(FRAMES):
            tell(number / FRAMES, "drawing the scene")
            t = begin + (end - begin) * number / (FRAMES - 1)
            await tab.value(f"playback.move({t!r}); {DRAWN}")
            clip = {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}
            shot = await tab.ask("Page.captureScreenshot", format="png", clip=clip)
            found.append(base64.b64decode(shot["data"]))
        return found


@contextlib.asynccontextmanager
async def _tab(browser: str) -> AsyncIterator[Tab]:
    """A browser of its own with one tab, until the block ends."""
    import aiohttp

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        process = await asyncio.create_subprocess_exec(
            browser, *FLAGS, f"--user-data-dir={folder}", f"--window-size={SIZE[0]},{SIZE[1]}", "about:blank",
            stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.DEVNULL,
        )  # fmt: skip
        try:
            port = await _port(Path(folder) / "DevToolsActivePort", process)
            async with aiohttp.ClientSession() as client:
                async with client.get(f"http://127.0.0.1:{port}/json/list") as answer:
                    pages = [each for each in await answer.json() if each["type"] == "page"]
                url = pages[0]["webSocketDebuggerUrl"]
                async with client.ws_connect(url, max_msg_size=1 << 26) as socket:
                    yield Tab(socket, [0])
        finally:
            if process.returncode is None:
                process.kill()
            await process.wait()


def _first_line(file: Path) -> int:
    return int(file.read_text(encoding="ascii").split()[0])


async def _port(file: Path, process: asyncio.subprocess.Process) -> int:
    """The port that the browser listens at, once it does."""
    try:
        async with asyncio.timeout(START_S):
            while process.returncode is None:
                with contextlib.suppress(OSError, ValueError, IndexError):
                    return _first_line(file)
                await asyncio.sleep(0.05)
    except TimeoutError:
        pass
    raise ConfigError("--gif: the browser did not start")
