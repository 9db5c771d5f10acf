"""One static page: three.js, a scene, one WebSocket with a binary array a tick; `PORT VEHICLES HZ`."""

from __future__ import annotations

import asyncio
import sys
from importlib.util import find_spec
from pathlib import Path

from aiohttp import web

from tests.benchmarks.page_spike.load import floats, stamp

PAGE = """<!doctype html><title>spike</title><div id=host></div><script type=module>
import {THREE} from "/three.js"; import {scene} from "/scene.js";
const take = scene(THREE, document.getElementById("host"));
const socket = new WebSocket(`ws://${location.host}/live`); socket.binaryType = "arraybuffer";
socket.onmessage = (m) => take(new DataView(m.data).getFloat64(0, true), new Float32Array(m.data, 8));
</script>"""


def main() -> None:
    port, vehicles, hz = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    spec = find_spec("nicegui")
    assert spec is not None
    assert spec.origin is not None
    three = Path(spec.origin).parent / "elements/scene/dist/index.js"

    async def live(request: web.Request) -> web.WebSocketResponse:
        socket = web.WebSocketResponse()
        await socket.prepare(request)
        tick = 0
        while not socket.closed:
            await socket.send_bytes(stamp() + floats(vehicles, tick).tobytes())
            tick += 1
            await asyncio.sleep(1.0 / hz)
        return socket

    async def page(request: web.Request) -> web.Response:
        return web.Response(text=PAGE, content_type="text/html")

    async def three_js(request: web.Request) -> web.FileResponse:
        return web.FileResponse(three)

    async def scene_js(request: web.Request) -> web.FileResponse:
        return web.FileResponse(Path(__file__).parent / "scene.js")

    app = web.Application()
    app.add_routes(
        [
            web.get("/", page),
            web.get("/live", live),
            web.get("/three.js", three_js),
            web.get("/scene.js", scene_js),
        ]
    )
    web.run_app(app, host="127.0.0.1", port=port, print=None)


if __name__ == "__main__":
    main()
