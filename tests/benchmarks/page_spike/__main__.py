"""`python -m tests.benchmarks.page_spike`: a static page against NiceGUI, in Chromium; Markdown to stdout."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from urllib.request import urlopen

import psutil
from playwright.sync_api import sync_playwright

CHROMIUM = "/usr/bin/chromium"
OPTIONS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-unsafe-swiftshader",
)
SECONDS = 20.0


def measured(module: str, port: int, vehicles: int, hz: float) -> str:
    """A row of the table."""
    begun = time.perf_counter()
    command = [
        sys.executable,
        "-m",
        f"tests.benchmarks.page_spike.{module}",
        str(port),
        str(vehicles),
        str(hz),
    ]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while True:
            try:
                urlopen(f"http://127.0.0.1:{port}/", timeout=5.0).read()
                break
            except OSError:
                time.sleep(0.05)
        start = time.perf_counter() - begun
        process = psutil.Process(server.pid)
        with sync_playwright() as play:
            browser = play.chromium.launch(executable_path=CHROMIUM, args=list(OPTIONS))
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(f"http://127.0.0.1:{port}/")
            page.wait_for_function("window.seen && window.seen.drawn > 5")
            page.evaluate("window.seen.drawn = 0; window.seen.delays = []")
            cpu, begun = sum(process.cpu_times()[:2]), time.perf_counter()
            time.sleep(SECONDS)
            took = time.perf_counter() - begun
            cpu = sum(process.cpu_times()[:2]) - cpu
            seen = page.evaluate("window.seen")
            browser.close()
        delays = statistics.quantiles(seen["delays"], n=20)
        memory = process.memory_info().rss / 1e6
        return (
            f"| {module} | {vehicles} | {hz:g} | {start:.1f} | {seen['drawn'] / took:.1f} |"
            f" {delays[9]:.0f} / {delays[18]:.0f} |"
            f" {100 * cpu / took:.1f} | {memory:.0f} |"
        )
    finally:
        server.terminate()
        server.wait(10.0)


def main() -> None:
    print(
        "| page | vehicles | Hz | start [s] | pictures/s | delay 50/95 % [ms] |"
        " server [% of a core] | memory [MB] |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for number, (vehicles, hz) in enumerate([(200, 10.0), (1000, 2.0)]):
        for other, module in enumerate(("serve_static", "serve_nicegui")):
            print(measured(module, 18740 + 2 * number + other, vehicles, hz), flush=True)


if __name__ == "__main__":
    main()
