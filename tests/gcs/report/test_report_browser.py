"""The report in a browser: no error on the console, no request to the network, and the 3D view turns."""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from gcs.report import moving
from gcs.report.program import read_run, write_report
from onboard.config.strict import ConfigError
from tests.support.real_time import patience
from tests.support.run_folders import make_run

BROWSERS = ("/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome")
OPTIONS = (
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
# the places [px] of what matches, in order of the page
BOXES = "all => all.map(e => e.getBoundingClientRect()).map(b => [b.left, b.top, b.right, b.bottom])"


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


def drag(tab: Page, figure: str, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Press, move and release between two places, given as shares of the figure's width and height."""
    drawn = tab.locator(f"#figure-{figure} svg")
    drawn.scroll_into_view_if_needed()
    box = drawn.bounding_box()
    assert box is not None
    first, last = ((box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in (start, end))
    tab.mouse.move(*first)
    tab.mouse.down()
    tab.mouse.move(*last, steps=5)
    tab.mouse.up()


@pytest.mark.real
def test_the_report_opens_without_error_or_request_and_is_small(tab: Page, report: Path) -> None:
    errors: list[str] = []
    requests: list[str] = []
    tab.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    tab.on("pageerror", lambda error: errors.append(str(error)))
    tab.on("request", lambda request: requests.append(request.url))
    tab.goto(report.as_uri())
    assert tab.locator(".figure svg").count() == 9
    assert tab.locator("h1").inner_text() == "Evader captured by pursuer 3 after 12.3 s"
    assert errors == []
    assert requests == [report.as_uri()]
    assert report.stat().st_size < 3_000_000


@pytest.mark.real
def test_the_scene_plays_the_flight_and_marks_the_same_instant_in_the_figures(
    tab: Page, report: Path
) -> None:
    run = read_run(report.parent)
    tab.goto(f"{report.as_uri()}?smooth")
    for since in (2.0, 5.5, 1.0):
        shown = tab.evaluate("t => { playback.move(t); return playback.t; }", since)
        assert shown == pytest.approx(since)
        for id, flown in run.flown.items():
            east, up, south = tab.evaluate("id => playback.scene.where.get(id)", id)
            place = [np.interp(since, flown.t, flown.position[:, axis]) for axis in range(3)]
            assert [-south, east, -up] == pytest.approx(place, abs=0.5)
        cursor = tab.locator("#figure-distances line.cursor").first.evaluate("e => +e.getAttribute('x1')")
        ends = [
            tab.evaluate("n => panels.find(p => p.name === 'distances').toX(n)", at)
            for at in (since, since + 1.0)
        ]
        assert abs(cursor - ends[0]) < 0.1 * abs(ends[1] - ends[0])
    drawn = tab.evaluate("playback.scene.drawn")
    tab.locator("#time button", has_text="play").click()
    until = time.monotonic() + patience(10.0)
    while tab.evaluate("playback.t") <= 1.1 and time.monotonic() < until:
        tab.wait_for_timeout(50)
    assert tab.evaluate("playback.t") > 1.1
    assert tab.evaluate("playback.scene.drawn") > drawn
    tab.locator("#time button", has_text="pause").click()
    tab.locator("#stage").scroll_into_view_if_needed()
    shades = Image.open(BytesIO(tab.locator("#stage").screenshot())).convert("RGB").getcolors(1 << 20)
    assert shades is not None
    assert len(shades) > 50, "there is something in the scene"


@pytest.mark.real
def test_paper_gets_the_drawing_in_the_scenes_place(tab: Page, report: Path) -> None:
    tab.goto(report.as_uri())
    assert not tab.locator("#figure-space").is_visible()
    tab.emulate_media(media="print")
    assert tab.locator("#figure-space").is_visible()
    assert not tab.locator("#stage").is_visible()


@pytest.mark.real
def test_the_pointer_asks_what_was_when(tab: Page, report: Path) -> None:
    tab.goto(report.as_uri())
    box = tab.locator("#figure-distances svg").bounding_box()
    assert box is not None
    tab.locator("#figure-distances svg").hover(position={"x": 0.5 * box["width"], "y": 0.4 * box["height"]})
    time, *told = tab.locator("#tip").inner_text().split("\n")
    at = float(time.removesuffix(" s"))
    gaps = {gap.id: gap for gap in read_run(report.parent).gaps()}
    assert len(told) == 2
    for line in told:
        who, value = line.split(": ")
        gap = gaps[int(who.split()[1])]
        truth = float(np.interp(at, gap.t, gap.distance))
        assert float(value.removesuffix(" m")) == pytest.approx(truth, abs=0.5)
    assert tab.locator(".cursor").count() == 9, "one line in each row of axes over time"
    assert tab.locator("#figure-plan circle").count() == 3
    assert tab.evaluate("playback.t") == pytest.approx(at, abs=0.01), "the scene goes along"


@pytest.mark.real
def test_a_part_can_be_enlarged_in_all_figures_over_time_at_once(tab: Page, report: Path) -> None:
    tab.goto(report.as_uri())
    drag(tab, "speeds", (0.5, 0.2), (0.6, 0.3))
    ticks = {
        name: tab.locator(f"#figure-{name} .ticks text").all_inner_texts() for name in ("speeds", "links")
    }
    assert len(ticks["speeds"]) >= 4
    assert ticks["speeds"] == ticks["links"]
    assert tab.locator("#figure-plan .ticks").count() == 0, "the plan keeps its own part"
    drag(tab, "plan", (0.3, 0.3), (0.6, 0.5))
    assert tab.locator("#figure-plan .ticks text").count() >= 6
    tab.locator("#figure-speeds svg").dblclick()
    assert tab.locator("#figure-speeds .ticks, #figure-links .ticks").count() == 0
    assert tab.locator("#figure-plan .ticks").count() == 1


@pytest.mark.real
@pytest.mark.parametrize("width", [800, 1240])
def test_no_text_of_a_figure_lies_on_another(browser: Browser, report: Path, width: int) -> None:
    tab = browser.new_page(viewport={"width": width, "height": 900})
    tab.goto(report.as_uri())
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing sticks out"
    for figure in tab.locator(".figure").all():
        texts = figure.locator("svg text")
        words, boxes = texts.all_inner_texts(), texts.evaluate_all(BOXES)
        frame = figure.locator("svg").evaluate_all(BOXES)[0]
        for (a, first), (b, second) in itertools.combinations(zip(words, boxes, strict=True), 2):
            wide = min(first[2], second[2]) - max(first[0], second[0])
            high = min(first[3], second[3]) - max(first[1], second[1])
            assert wide < 1.0 or high < 3.0, f"{a} and {b}"  # lines of text have room above and below
        for word, (left, _, right, bottom) in zip(words, boxes, strict=True):
            assert frame[0] - 1 <= left <= right <= frame[2] + 1, word
            assert bottom <= frame[3] + 3, word


@pytest.mark.real
def test_who_prefers_the_dark_gets_it_and_paper_stays_white(browser: Browser, report: Path) -> None:
    tab = browser.new_page(color_scheme="dark")
    tab.goto(report.as_uri())
    background = "getComputedStyle(document.body).backgroundColor"
    ink = "getComputedStyle(document.querySelector('#figure-plan text')).fill"
    assert tab.evaluate(background) == "rgb(13, 17, 23)"
    dark = tab.evaluate(ink)
    tab.emulate_media(media="print")
    assert tab.evaluate(background) == "rgb(255, 255, 255)"
    assert tab.evaluate(ink) != dark


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


@pytest.mark.real
def test_the_scene_becomes_a_gif_that_moves(
    report: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    browser_path()
    monkeypatch.setattr(moving, "FRAMES", 6)
    told: list[float] = []
    with ThreadPoolExecutor(1) as apart:  # a browser of other tests has its loop in this thread
        drawn = apart.submit(
            moving.write_gif, report, tmp_path / "run.gif", lambda share, what: told.append(share)
        )
        gif = drawn.result()
    with Image.open(gif) as picture:
        assert picture.size == moving.SIZE
        assert 4 <= picture.n_frames <= 6  # equal ones are one, shown longer
        frames = []
        for number in range(picture.n_frames):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGB"), dtype=float))
    assert all(np.abs(a - b).max() > 50.0 for a, b in itertools.pairwise(frames)), "everybody moves"
    assert frames[0][-60:, 150:].std() > 1.0, "the scene fills the picture to its lower edge"
    assert told == sorted(told)
    monkeypatch.setattr(moving, "BROWSERS", ("/nowhere",))
    with pytest.raises(ConfigError, match="--gif: found no Chromium"):
        moving.write_gif(report, tmp_path / "none.gif")
