"""`make bench-page`: a fleet on a real bus, `gcs page` and Chromium; writes benchmarks/results/page.md."""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

import psutil
from playwright.sync_api import sync_playwright

from tests.benchmarks.page_fleet import MINUTE_MS
from tests.support import benchmark_record
from tests.support.bus_stages import free_port
from tests.support.page_stage import OPTIONS, browser_path

APPEAR_S = 40.0  # for the fleet to be seen whole
RESULT = Path("benchmarks/results/page.md")
ROWS = ((200, 10.0), (1000, 2.0))
HEAD = """# The page: what a browser sees of a large fleet

`make bench-page` on {machine}, Chromium headless with software rendering, {seconds:.0f} s a row,
{date}; fleet, station, page and browser share the machine, whose load before was {load:.1f}. The goal: 200 vehicles at 10 Hz with
9.5 pictures a second or more, 250 ms or less from the bus to the pixel for 95 % of them, 35 % of a core or less for
the server, and its memory flat; 1000 vehicles at 2 Hz.

| vehicles | Hz | pictures/s | from message to pixel, 50 / 95 % [ms] | server [% of a core] | its memory first, last [MB] | requests elsewhere |
|---|---|---|---|---|---|---|
"""  # noqa: E501
TAIL = """
A fleet of more than 250 is told less often: 1000 vehicles 2.5 times a second,
so that 2.5 pictures a second are all there are.
Without a graphics card edges are not smoothed (`/?smooth` in the address smooths them).
"""
DELAYS = f"""(() => {{
  window.ages = [];
  page.scene.on.drawn = (frame) => {{
    page.frames += 1;
    const first = frame.vehicles.find((v) => v.id === 1);
    if (first) ages.push((Date.now() % {MINUTE_MS} + {MINUTE_MS} + first.z) % {MINUTE_MS});
  }};
}})()"""


def measured(vehicles: int, hz: float, seconds: float) -> str:
    """A row of the table."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station = subprocess.Popen(
        [sys.executable, "-m", "gcs.cli", "page", "--port", "0", "--no-record", "--bus", endpoint],
        stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    fleet = None
    try:
        assert station.stdout is not None
        found = re.search(r"(http\S+)", station.stdout.readline())
        assert found is not None
        fleet = subprocess.Popen(
            [sys.executable, "-m", "tests.benchmarks.page_fleet", endpoint, str(vehicles), str(hz)]
        )
        with sync_playwright() as play:
            browser = play.chromium.launch(executable_path=browser_path(), args=list(OPTIONS))
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            asked: list[str] = []
            page.on("request", lambda request: asked.append(request.url))
            page.goto(found.group(1))
            until, seen = time.perf_counter() + APPEAR_S, 0
            while seen < vehicles:
                if time.perf_counter() > until:
                    return f"| {vehicles} | {hz:g} | {seen} of them appeared in {APPEAR_S:g} s | | | | |"
                time.sleep(0.2)
                seen = page.evaluate("window.page && page.board ? page.board.vehicles.length : 0")
            page.evaluate(DELAYS)
            time.sleep(3.0)
            process = psutil.Process(station.pid)
            first = process.memory_info().rss / 1e6
            page.evaluate("window.ages = []; page.frames = 0")
            cpu, begun = sum(process.cpu_times()[:2]), time.perf_counter()
            time.sleep(seconds)
            ages, drawn = page.evaluate("ages"), page.evaluate("page.frames")
            took = time.perf_counter() - begun
            cpu = sum(process.cpu_times()[:2]) - cpu
            last = process.memory_info().rss / 1e6
            browser.close()
        parts = statistics.quantiles(ages, n=20)
        elsewhere = sum("//localhost:" not in url for url in asked)
        return (
            f"| {vehicles} | {hz:g} | {drawn / took:.1f} | {parts[9]:.0f} / {parts[18]:.0f} |"
            f" {100 * cpu / took:.0f} | {first:.0f}, {last:.0f} | {elsewhere} |"
        )
    finally:
        for process_ in (fleet, station):
            if process_ is not None:
                process_.terminate()
                process_.wait(10.0)


def main(seconds: float = 60.0) -> None:
    """Measure and write."""
    load = psutil.getloadavg()[0]
    rows = [measured(vehicles, hz, seconds) for vehicles, hz in ROWS]
    head = HEAD.format(
        machine=benchmark_record.machine(), seconds=seconds, date=time.strftime("%Y-%m-%d"), load=load,
    )  # fmt: skip
    RESULT.write_text(head + "\n".join(rows) + "\n" + TAIL, encoding="utf-8")
    print(RESULT.read_text(encoding="utf-8"))


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
