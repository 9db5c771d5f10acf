"""The same by NiceGUI: the scene in its page, moved by a script it sends each tick; `PORT VEHICLES HZ`."""

from __future__ import annotations

import struct
import sys
from pathlib import Path

from nicegui import app, ui

from tests.benchmarks.page_spike.load import floats, stamp

HERE = Path(__file__).parent


def main() -> None:
    port, vehicles, hz = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    app.add_static_files("/spike", HERE)

    @ui.page("/")
    def page() -> None:
        import nicegui

        app.add_static_files("/three", Path(nicegui.__file__).parent / "elements/scene/dist")
        ui.add_body_html(
            '<script type="module">import {THREE} from "/three/index.js";'
            'import {scene} from "/spike/scene.js";'
            "window.take = scene(THREE, document.body);</script>"
        )
        ui.html('<div id="host"></div>', sanitize=False)
        state = {"tick": 0}

        def tick() -> None:
            values = floats(vehicles, state["tick"]).tolist()
            state["tick"] += 1
            (sent,) = struct.unpack("<d", stamp())
            ui.run_javascript(f"window.take && window.take({sent}, {values})")

        ui.timer(1.0 / hz, tick)

    ui.run(host="127.0.0.1", port=port, show=False, reload=False)


if __name__ in {"__main__", "__mp_main__"}:
    main()
