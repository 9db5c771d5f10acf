"""The report in a browser: no error on the console, no request to the network, and the 3D view turns."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from gcs.report.program import write_report
from tests.support.real_time import patience
from tests.support.run_folders import make_run

BROWSERS = ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
OPTIONS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
PATIENCE_MS = 1000.0 * patience(20.0)
CAMERA = (
    "JSON.parse(JSON.stringify(document.getElementById('figure-space')._fullLayout.scene._scene.getCamera()))"
)


def browser_path() -> str:
    """An installed browser; without one the test is skipped, or fails where it is demanded."""
    found = next((path for path in BROWSERS if Path(path).exists()), "")
    if not found and os.environ.get("APOLLONIUS_REQUIRE_BROWSER") == "1":
        pytest.fail("APOLLONIUS_REQUIRE_BROWSER=1, but no chromium is installed (apt-get install chromium)")
    if not found:
        pytest.skip("no chromium is installed (apt-get install chromium)")
    return found


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_report(make_run(tmp_path_factory.mktemp("runs") / "run")).page


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    path = browser_path()
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=path, headless=True, args=list(OPTIONS))
        yield launched
        launched.close()


@pytest.fixture
def tab(browser: Browser) -> Page:
    return browser.new_page(viewport={"width": 1240, "height": 900})


@pytest.mark.real
def test_the_report_opens_without_error_or_request_and_its_3d_view_turns(tab: Page, report: Path) -> None:
    errors: list[str] = []
    requests: list[str] = []
    tab.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    tab.on("pageerror", lambda error: errors.append(str(error)))
    tab.on("request", lambda request: requests.append(request.url))
    tab.goto(report.as_uri())
    tab.wait_for_function("document.querySelectorAll('.figure .main-svg').length >= 9", timeout=PATIENCE_MS)
    tab.wait_for_function(f"{CAMERA}.eye !== undefined", timeout=PATIENCE_MS)

    assert tab.locator("h1").inner_text() == "Evader captured by pursuer 3 after 12.3 s"
    before: Any = tab.evaluate(CAMERA)
    box = tab.locator("#figure-space").bounding_box()
    assert box is not None
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    tab.mouse.move(*middle)
    tab.mouse.down()
    tab.mouse.move(middle[0] + 180, middle[1] + 30, steps=8)
    tab.mouse.up()
    tab.wait_for_function(f"Math.abs({CAMERA}.eye.x - ({before['eye']['x']})) > 0.1", timeout=PATIENCE_MS)
    after: Any = tab.evaluate(CAMERA)

    def far(camera: Any) -> float:
        return float(sum(camera["eye"][axis] ** 2 for axis in "xyz") ** 0.5)

    assert far(after) == pytest.approx(far(before), rel=0.02), "turned, not zoomed"
    assert errors == []
    assert requests == [report.as_uri()]


@pytest.mark.real
def test_the_page_forbids_itself_the_network(tab: Page, report: Path) -> None:
    tab.goto(report.as_uri())
    refused = tab.evaluate("fetch('http://127.0.0.1:9/').then(() => 'sent', () => 'refused')")
    assert refused == "refused"
    blocked = tab.evaluate(
        "new Promise(done => { addEventListener('securitypolicyviolation', e => done(e.effectiveDirective)); "
        "fetch('http://127.0.0.1:9/').catch(() => 0); })"
    )
    assert blocked == "connect-src"
