"""The report: what it says of a flight, with whatever a run folder still holds."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
import shutil
from base64 import b64encode
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path

import matplotlib.image
import msgspec
import numpy as np
import pytest

from gcs.recording.recorder import Recorder
from gcs.report import theme
from gcs.report.data import Run
from gcs.report.drawing import Drawing, svg
from gcs.report.figures import NAMES, figures, heights
from gcs.report.hindsight import missed_captures
from gcs.report.page import facts_table
from gcs.report.program import read_run, write_report
from onboard.config.strict import ConfigError
from onboard.core.route.choice import TrackRule
from onboard.core.strategy.knowledge import RuleId
from onboard.game import palette
from onboard.wire.bus import messages, topics
from tests.support.chase_messages import EPOCH_NS, Item, chase
from tests.support.run_folders import flight, make_run, make_tlogs

FIGURES = ["plan", "space", "distances", "rules", "speeds", "heights", "wind", "links", "latencies"]


class Page(HTMLParser):
    """Attributes, ids and text of a page, scripts and styles apart."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.attributes: list[tuple[str, str, str]] = []
        self.scripts: list[str] = []
        self.styles: list[str] = []
        self.words: list[str] = []
        self._inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._inside = tag
        self.attributes += [(tag, name, value or "") for name, value in attrs]

    def handle_endtag(self, tag: str) -> None:
        self._inside = ""

    def handle_data(self, data: str) -> None:
        target = {"script": self.scripts, "style": self.styles}.get(self._inside, self.words)
        target.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = make_run(tmp_path_factory.mktemp("runs") / "run")
    write_report(folder)
    return folder


@pytest.fixture(scope="module")
def values(run: Path) -> Run:
    return read_run(run)


@pytest.fixture(scope="module")
def drawings(values: Run) -> list[Drawing]:
    return figures(values)


@pytest.fixture
def copy(run: Path, tmp_path: Path) -> Path:
    """The run's folder as it was before the report: a test may change it."""
    written = shutil.ignore_patterns("figures", "report.html")
    return Path(shutil.copytree(run, tmp_path / "run", ignore=written))


@pytest.fixture(scope="module")
def page(run: Path) -> Page:
    return Page((run / "report.html").read_text(encoding="utf-8"))


def test_the_page_tells_the_outcome_and_what_led_to_it(page: Page) -> None:
    assert "Evader captured by pursuer 3 after 12.3 s" in page.text
    for told in (
        "capture radius R",
        "vehicle 2 is lost",  # the alert
        "decision clipped: pitch",  # the event
        "1 confirmed in 0.25 s",  # the command's legs
        "smallest distance, by the referee",
        "p50 ms",  # timing.json
        "sent 5, lost 0",  # summary.json
    ):
        assert told in page.text, told
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert [i for i in ids if i.startswith("figure-")] == [f"figure-{name}" for name in FIGURES]
    links = {value[1:] for _, name, value in page.attributes if name == "href" and value.startswith("#")}
    assert links <= set(ids)


def test_the_page_refers_to_nothing_outside_itself(page: Page) -> None:
    fetching = {"src", "srcset", "href", "data", "action", "poster", "background", "xlink:href", "formaction"}
    for tag, name, value in page.attributes:
        if name in fetching:
            assert value.startswith("#") or value == "data:,", (tag, name, value)
    for style in page.styles:
        assert not re.search(r"url\(|@import", style)
    policy = next(value for _, name, value in page.attributes if name == "content" and "default-src" in value)
    assert policy.startswith("default-src 'none'")
    assert "http" not in policy
    data, scene, own = page.scripts
    assert not re.search(r"https?:|//[a-z]", own)
    digests = [b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in (scene, own)]
    only = " ".join(f"'sha256-{digest}'" for digest in digests)
    assert f"script-src {only};" in policy, "these two scripts may run, and no other"
    assert [figure["name"] for figure in json.loads(data)["figures"]] == [n for n in FIGURES if n != "space"]


def test_the_scenes_script_is_made_from_todays_modules() -> None:
    """`make three` puts them together; its first line has their hash."""
    folder = files("gcs.page") / "static"
    script = (folder.parent / "three" / "report.mjs").read_text(encoding="utf-8")
    names = json.loads(re.search(r"const names = (\[.*\]);", script)[1])
    made = hashlib.sha256(b"".join((folder / f"{name}.js").read_bytes() for name in names)).hexdigest()
    assert made in (folder / "report.js").read_text(encoding="utf-8")[:200]


def test_every_colour_of_a_figure_has_a_twin_for_dark_screens(drawings: list[Drawing], page: Page) -> None:
    sheet = page.styles[0]
    light, dark = sheet.split("@media screen", 1)
    used = set()
    for drawing in drawings:
        text = svg(drawing)
        assert not re.search(r"#[0-9a-f]{3,8}\b|rgb", text.replace('href="#', ""))
        used |= set(re.findall(r"var\((--c[0-9a-f]{6})\)", text))
    assert len(used) > 12
    for name in used:
        assert f"{name}: #" in light, name
        assert f"{name}: #" in dark, name


def test_the_palette_tells_colours_apart() -> None:
    colours = palette.every_colour()
    assert len({colour.light for colour in colours}) == len(colours)
    assert palette.vehicle(1, evader=True) == palette.EVADER
    assert [palette.vehicle(i, evader=False) for i in (2, 3, 10)] == [
        palette.PURSUERS[0], palette.PURSUERS[1], palette.PURSUERS[0],
    ]  # fmt: skip
    actions = {action.value for action in messages.SupervisorAction} - {"ok"}
    assert actions <= set(palette.ACTIONS)
    assert actions <= set(theme.ACTIONS)


@pytest.mark.parametrize("rule", [r for r in (*RuleId, *TrackRule) if r.name not in ("NONE", "CUSTOM")])
def test_every_rule_has_one_colour_and_a_sentence(rule: RuleId | TrackRule) -> None:
    name = rule.name.lower()
    assert name in palette.RULES
    sentence, source = theme.explained(name)
    assert sentence.startswith(("When ", "Always: "))
    assert source not in ("", "plug-in")


def test_the_page_explains_the_rules_that_were_in_force(page: Page) -> None:
    assert "intercept When the evader comes closer and its ray meets the Apollonius sphere" in page.text
    assert "close in A rule of a strategy that this program does not hold. plug-in" in page.text


def test_what_was_played_on_virtual_time_says_so(page: Page, copy: Path) -> None:
    assert "virtual" not in page.text
    assert "began 2025-10-09 08:53:22 UTC" in page.text
    (copy / "timing.json").write_text('{"virtual_s": 24.0, "wall_s": 2.0}', encoding="utf-8")
    write_report(copy)
    found = Page((copy / "report.html").read_text(encoding="utf-8"))
    assert "played on virtual time" in found.text
    assert "virtual time since the start of the game [s]" in found.text
    assert "began" not in found.text


def test_equal_links_do_not_hide_each_other(values: Run, drawings: list[Drawing]) -> None:
    (panel,) = next(d for d in drawings if d.name == "links").panels
    lines = {line.get_gid(): line for line in panel.axes.lines}
    for series in panel.series:
        vehicle, what = int(series.name.split(":")[0].split()[1]), series.name.split(": ")[1]
        link = values.links[vehicle]
        share = link.quality if what == "link" else link.battery
        told = series.scale * (lines[series.gid].get_ydata() - series.zero)
        assert told[np.isfinite(told)] == pytest.approx(100 * share)
        assert abs(series.zero - 0.4 - sorted(values.links).index(vehicle)) < 1e-9, "a row of its own"


def test_silence_breaks_a_curve(drawings: list[Drawing]) -> None:
    drawing = next(d for d in drawings if d.name == "speeds")
    breaks = {
        line.get_label(): int(np.isnan(line.get_ydata()).sum())
        for line in drawing.panels[0].axes.lines if line.get_gid()
    }  # fmt: skip
    assert breaks == {"evader 1": 0, "pursuer 2": 1, "pursuer 3": 0}


def test_a_legend_of_sixty_vehicles_keeps_five_rows(tmp_path: Path) -> None:
    values = read_run(make_run(tmp_path / "many", list(chase(3.0, vehicles=60))))
    for drawing in figures(values):
        for legend in drawing.figure.legends:
            told = [text.get_text() for text in legend.get_texts()]
            assert len(told) <= 5 * legend._ncols
            if drawing.name == "plan":
                assert told[-1] == "target"
                assert any(text.endswith("… 60") for text in told)


def test_the_figures_are_pictures_with_something_in_them(run: Path) -> None:
    pictures = sorted(p.name for p in (run / "figures").iterdir())
    assert pictures == sorted(f"{name}.png" for name in FIGURES)
    assert sorted(NAMES) == sorted(FIGURES)  # and those of evaders that were not captured
    for picture in (run / "figures").iterdir():
        pixels = matplotlib.image.imread(picture)
        assert pixels.shape[1] == 1800 or picture.name == "plan.png"
        ink = np.argwhere((pixels[:, :, :3] < 0.98).any(axis=2))
        share = np.ptp(ink, axis=0) / pixels.shape[:2]
        assert share.min() > 0.85, f"{picture}: white margins"
        assert len(np.unique(pixels[::3, ::3].reshape(-1, pixels.shape[2]), axis=0)) > 25, picture


def test_distances_are_those_that_were_flown(values: Run) -> None:
    assert values.outcome is not None
    nearest = {gap.id: gap.distance.min() for gap in values.gaps()}
    assert min(nearest.values()) == pytest.approx(values.outcome.smallest_distance, abs=0.2)
    gap = values.gaps()[0]
    assert gap.distance[0] == pytest.approx(260.2, abs=0.5)
    assert values.span == pytest.approx((-2.02, 21.93), abs=0.05)


def test_rules_are_bands_in_order_without_gaps(values: Run) -> None:
    bands = values.rules[3]
    assert {band.rule for band in bands} == {"intercept", "close_in"}
    assert all(a.end == pytest.approx(b.start) and a.rule != b.rule for a, b in itertools.pairwise(bands))
    silent = values.rules[2]
    breaks = [(a.end, b.start) for a, b in itertools.pairwise(silent) if b.start - a.end > 1.0]
    assert breaks == [(pytest.approx(5.9, abs=0.2), pytest.approx(9.0, abs=0.2))], "silence is not a rule"


def test_the_same_run_gives_the_same_report(run: Path, tmp_path: Path) -> None:
    before = {p.name: p.read_bytes() for p in (run / "figures").iterdir()}
    html = (run / "report.html").read_bytes()
    write_report(run)
    assert (run / "report.html").read_bytes() == html
    assert {p.name: p.read_bytes() for p in (run / "figures").iterdir()} == before


def test_without_a_recording_the_logs_and_the_scenario_speak(tmp_path: Path, values: Run) -> None:
    folder = make_tlogs(make_run(tmp_path / "run", recording=False))
    written = write_report(folder)
    assert any("no such file" in note for note in written.notes)
    assert any("no decisions" in note for note in written.notes)
    found = read_run(folder)
    assert [figure.name for figure in figures(found)] == ["plan", "space", "distances", "speeds", "heights"]
    assert found.capture_radius == 5.0
    assert [goal.place for goal in found.targets] == [(400.0, 100.0, -60.0)]
    for vehicle, flown in found.flown.items():
        known = values.flown[vehicle]
        assert flown.role is known.role
        assert np.abs(flown.position - known.position).max() < 0.05
    text = Page((folder / "report.html").read_text(encoding="utf-8")).text
    assert "Outcome: captured" in text, "summary.json still tells it"
    assert "Please note" in text


def test_a_cut_recording_is_reported_up_to_the_cut(copy: Path) -> None:
    data = (copy / "recording.mcap").read_bytes()
    (copy / "recording.mcap").write_bytes(data[: len(data) // 3])
    written = write_report(copy)
    assert len(written.notes) == 1
    assert "cut in the record at byte" in written.notes[0]
    assert 3.0 < read_run(copy).span[1] < 20.0


def test_a_recording_alone_is_enough(copy: Path) -> None:
    for name in ("scenario.toml", "summary.json", "timing.json"):
        (copy / name).unlink()
    assert write_report(copy / "recording.mcap").page == copy / "report.html"


def test_an_evader_known_by_tracks_alone_still_has_distances(tmp_path: Path) -> None:
    unseen = [item for item in flight() if not item.key.endswith("vehicles/1/state")]
    values = read_run(make_run(tmp_path / "run", unseen))
    assert [evader.source for evader in values.evaders] == ["track"]
    assert min(gap.distance.min() for gap in values.gaps()) < 5.0


def test_bad_files_beside_it_are_notes(copy: Path) -> None:
    (copy / "summary.json").write_text("{", encoding="utf-8")
    (copy / "scenario.toml").write_text("name = 3", encoding="utf-8")
    notes = write_report(copy).notes
    assert len(notes) == 2
    assert "summary.json: not valid JSON" in "\n".join(notes)
    assert "scenario.toml: " in "\n".join(notes)


@pytest.mark.parametrize(
    ("contents", "said"),
    [
        (None, "no such file"),
        (b"", "empty"),
        (b"PK12345678", "no MCAP file"),
        (b"\x89MCAP", "without a message"),
    ],
)
def test_a_folder_with_nothing_to_tell_is_refused_in_one_line(
    tmp_path: Path, contents: bytes | None, said: str
) -> None:
    if contents is not None:
        (tmp_path / "recording.mcap").write_bytes(contents)
    with pytest.raises(ConfigError, match=said) as caught:
        write_report(tmp_path)
    assert "\n" not in str(caught.value)
    with pytest.raises(ConfigError, match="no such run"):
        write_report(tmp_path / "missing")


def test_words_from_the_network_cannot_become_markup(tmp_path: Path) -> None:
    evil = "</script><img src=http://x/y onerror=alert(1)>"
    event = messages.Event(2, 1, EPOCH_NS, messages.Severity.ERROR, evil, evil)
    report = messages.DecisionReport(
        2,
        EPOCH_NS,
        0.0,
        messages.DecisionLevel.TACTICAL,
        messages.DecisionModule.GEOMETRIC,
        evil,
        evil,
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
        0.0,
        0.0,
    )
    items = [
        *flight(3.0),
        Item(topics.EVENTS.key("field", 2), topics.EVENTS.encode(event), EPOCH_NS + 4 * 10**9),
        Item(topics.DECISION.key("field", 2), topics.DECISION.encode(report), EPOCH_NS + 4 * 10**9 + 1),
    ]
    folder = make_run(tmp_path / "run", items)
    (folder / "summary.json").write_text(json.dumps({evil: evil}), encoding="utf-8")
    write_report(folder)
    found = Page((folder / "report.html").read_text(encoding="utf-8"))
    assert "onerror" in found.text, "it is shown as text"
    assert not [a for a in found.attributes if a[0] == "img"]
    assert len(found.scripts) == 3, "the data, the scene and the own one"
    assert evil in json.dumps(json.loads(found.scripts[0]), ensure_ascii=False).replace("_", " ")


def test_a_recording_of_states_alone_and_one_of_commands_alone_work(tmp_path: Path) -> None:
    states = [item for item in flight(3.0) if item.key.endswith("/state")]
    values = read_run(make_run(tmp_path / "states", states))
    assert [figure.name for figure in figures(values)] == [
        "plan", "space", "distances", "speeds", "heights", "wind", "latencies",
    ]  # fmt: skip
    journal = [item for item in flight() if "/gcs/" in item.key]
    written = write_report(make_run(tmp_path / "journal", journal))
    assert any("no state and no track" in note for note in written.notes)


def test_a_long_flight_is_thinned(tmp_path: Path) -> None:
    payloads = [item for item in flight(3.0) if item.key.endswith("vehicles/1/state")]
    state = topics.STATE.decode(payloads[0].payload, {})  # type: ignore[arg-type]
    assert state is not None
    recorder = Recorder(tmp_path / "recording.mcap", "field")
    for step in range(9000):
        stamp_ns = EPOCH_NS + step * 50_000_000
        later = msgspec.structs.replace(state, stamp_ns=stamp_ns, position=(float(step), 0.0, -50.0))
        recorder.record(payloads[0].key, topics.STATE.encode(later), stamp_ns)
    recorder.close()
    flown = read_run(tmp_path).flown[1]
    assert len(flown.t) == 4000
    assert flown.position[-1, 0] == 8999.0


def test_records_within_records_have_a_table_of_their_own() -> None:
    """Counters in one cell stood one word a line in a narrow window, and pushed the last column out."""
    records = [{"id": n, "counters": {"bus_received": 7 * n}, "events": 5} for n in (1, 2)]
    first, second = facts_table({"vehicles": records}).split("<table>")[1:]
    assert "<th>id</th><th>events</th>" in first
    assert "bus" not in first
    assert "<th>id</th><th>bus received</th>" in second
    assert ">14<" in second


def test_a_fence_far_away_does_not_flatten_the_heights(values: Run) -> None:
    """The curves fill the figure; a ceiling a kilometre above is told in words."""
    climbed = {
        i: f._replace(position=f.position + np.outer(np.linspace(0.0, 30.0, len(f.t)), (0.0, 0.0, -1.0)))
        for i, f in values.flown.items()
    }
    assert values.setup is not None
    fence = msgspec.structs.replace(values.setup.fence, altitude_min=0.0, altitude_max=1500.0)
    run = values._replace(flown=climbed, setup=msgspec.structs.replace(values.setup, fence=fence))
    drawn = heights(run)
    assert drawn is not None
    low, high = drawn.panels[0].axes.get_ylim()
    flown = np.concatenate([-f.position[:, 2] for f in climbed.values()])
    assert low < flown.min()
    assert high > flown.max()
    assert np.ptp(flown) > 0.3 * (high - low)
    assert "ceiling, 1500 m, is far outside" in drawn.note


def test_a_report_says_why_the_evader_was_not_captured(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A chase that is told to have ended without capture: when the last chance was, or that none was."""
    run = read_run(make_run(tmp_path / "run"))
    assert run.outcome is not None
    assert missed_captures(run) == [], "captured"
    fate = msgspec.structs.replace(run.fates[0], verdict=messages.OutcomeResult.ESCAPED, captor=0)
    (drawing,) = missed_captures(run._replace(fates=(fate,)))
    assert "could have met the evader on the way it flew" in drawing.note
    assert "<svg" in svg(drawing)
    assert not caplog.messages, "the library complained of what it was asked"
