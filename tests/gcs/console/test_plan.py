"""The plan view and the command line's language, as values."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.console import command_parser, plan
from gcs.console.vehicle_table import COLUMNS, age, column_at, heading, line
from gcs.picture.values import Picture
from onboard.wire.bus import messages
from onboard.wire.bus.messages import CommandKind
from tests.support.sample_messages import START_NS, Tower, decision, setup, state, track


def field(*places: tuple[float, float], **more: object) -> Picture:
    """Vehicles 1 … n at (north, east)."""
    tower = Tower()
    tower.hear(setup(len(places), **more))
    for i, (north, east) in enumerate(places, start=1):
        tower.hear(state(i, position=(north, east, -50.0)))
    return tower.picture


def text(
    picture: Picture, view: plan.View, width: int = 60, height: int = 20, selected: int | None = None
) -> list[str]:
    drawn = plan.plan(picture, view, width, height, selected)
    return ["".join(run for run, _ in row) for row in drawn]


def where(rows: list[str], sign: str) -> tuple[int, int]:
    """Row and column of a sign."""
    found = [(y, row.index(sign)) for y, row in enumerate(rows) if sign in row]
    assert len(found) == 1, f"{sign} in {rows}"
    return found[0]


def test_north_is_up_and_east_is_right():
    picture = field((0.0, 0.0), (200.0, 0.0), (0.0, 200.0))
    rows = text(picture, plan.fitted(plan.START, picture, 60, 20))
    y1, x1 = where(rows, "↑E1")
    y2, x2 = where(rows, "↑2")
    y3, x3 = where(rows, "↑3")
    assert (y2 < y1, x2 == x1) == (True, True)
    assert (y3 == y1, x3 > x1) == (True, True)


def test_arrows_point_where_vehicles_go():
    tower = Tower()
    courses = {2: (5.0, 5.0, "↗"), 3: (0.0, 5.0, "→"), 4: (-5.0, 0.0, "↓"), 5: (0.0, -5.0, "←")}
    for i, (north, east, _) in courses.items():
        tower.hear(state(i, position=(50.0 * i, 0.0, 0.0), velocity=(north, east, 0.0)))
    rows = text(tower.picture, plan.fitted(plan.START, tower.picture, 60, 20))
    for i, (_, _, arrow) in courses.items():
        where(rows, f"{arrow}{i}")


def test_target_aim_fence_circles_tracks_and_trails_are_drawn():
    tower = Tower()
    fence = messages.Fence(((-90.0, -90.0), (90.0, -90.0), (90.0, 190.0), (-90.0, 190.0)), 0.0, 100.0)
    tower.hear(setup(3, fence=fence), messages.EvaderBrief((60.0, 60.0, 0.0), START_NS))
    tower.hear(state(2, position=(0.0, 0.0, -50.0)), track(1, position=(0.0, 150.0, -50.0)))
    view = plan.fitted(plan.START, tower.picture, 60, 20)
    plain = text(tower.picture, view)
    where(plain, "◎")
    where(plain, "+1")
    assert "⠤" in "".join(plain) or "⠂" in "".join(plain)  # the fence
    tower.hear(decision(2, aim=(30.0, 120.0, -50.0), circles=((0.0, 100.0, -50.0, 30.0),)))
    chosen = text(tower.picture, view, selected=2)
    where(chosen, "×")
    assert sum(map(dots, chosen)) > sum(map(dots, plain)) + 20


def dots(row: str) -> int:
    """Braille dots in a row."""
    return sum((ord(sign) - 0x2800).bit_count() for sign in row if 0x2800 < ord(sign) < 0x2900)


def test_the_view_stands_still_while_all_is_in_it_and_follows_when_it_is_not():
    picture = field((0.0, 0.0), (100.0, 100.0))
    view = plan.fitted(plan.START, picture, 60, 20)
    assert plan.fitted(view, field((5.0, 0.0), (100.0, 110.0)), 60, 20) == view
    assert plan.fitted(view, field((0.0, 0.0), (900.0, 900.0)), 60, 20) != view
    assert plan.fitted(view, field((0.0, 0.0), (1.0, 1.0)), 60, 20).scale < view.scale


def test_zoom_steps_are_round_and_come_back():
    view = plan.START
    seen = [view.scale]
    for _ in range(4):
        view = plan.zoomed(view, closer=False)
        seen.append(view.scale)
    assert seen == [2.0, 5.0, 10.0, 20.0, 50.0]
    for _ in range(4):
        view = plan.zoomed(view, closer=True)
    assert view.scale == 2.0


numbers = st.floats(-1e7, 1e7)


@settings(max_examples=150, deadline=None)
@given(
    st.lists(st.tuples(numbers, numbers), min_size=1, max_size=6),
    st.integers(0, 90), st.integers(0, 40), st.floats(0.01, 1e4), st.integers(1, 6),
)  # fmt: skip
def test_whatever_is_on_the_field_the_plan_has_its_size(places, width, height, scale, selected):
    fence = messages.Fence(((-1e6, 0.0), (5.0, 1e6), (0.0, 0.0)), 0.0, 1.0)
    picture = field(*places, fence=fence)
    view = plan.fitted(plan.View(0.0, 0.0, scale), picture, width, height)
    for look in (view, plan.START):
        rows = text(picture, look, width, height, selected)
        assert len(rows) == height
        assert all(len(row) == width for row in rows)


def test_a_fitted_view_shows_every_vehicle():
    picture = field((-4000.0, 20.0), (3000.0, 900.0), (0.0, -7000.0), (10.0, 10.0))
    rows = "\n".join(text(picture, plan.fitted(plan.START, picture, 40, 9), 40, 9))
    assert all(name in rows for name in ("E1", "2", "3", "4"))


def test_rows_have_their_width_and_columns_can_be_clicked():
    cells = tuple("x" * 30 for _ in COLUMNS)
    for width in (10, 80, 120):
        assert len(line(cells, width)) == len(heading("battery", True, width)) == width
    assert column_at(0, 80).sort == "id"
    assert column_at(heading("id", False, 80).index("batt") + 1, 80).sort == "battery"
    ages = {0.04: "<1", 1.0: "1.0", 9.96: "10", 75.0: "75", 6000.0: "100m", float("inf"): "–"}
    assert {seconds: age(seconds) for seconds in ages} == ages


@settings(max_examples=300, deadline=None)
@given(st.text(max_size=40) | st.from_regex(r"(hold|land|select|sort|ack) [a-z0-9\- ,]{0,9}", fullmatch=True))
def test_no_line_raises_and_orders_name_only_known_vehicles(typed):
    picture = field((0.0, 0.0), (1.0, 1.0), (2.0, 2.0))
    meaning = command_parser.parse(typed, picture, 2)
    if isinstance(meaning, command_parser.Order):
        assert meaning.ids
        assert set(meaning.ids) <= {1, 2, 3}
    elif isinstance(meaning, command_parser.Wrong):
        assert meaning.reason or not typed.replace(",", " ").split()


def test_every_command_of_the_bus_can_be_typed():
    picture = field((0.0, 0.0), (1.0, 1.0))
    for kind in CommandKind:
        assert command_parser.parse(f"{kind.value} 1-2", picture, None) == command_parser.Order(kind, (1, 2))
    assert isinstance(command_parser.parse("hold", picture, None), command_parser.Wrong)
    assert command_parser.parse("abort", picture, 2) == command_parser.Order(CommandKind.ABORT, (1, 2))
    assert command_parser.names((1, 2), picture) == "all 2"


def test_only_an_id_or_the_selected_vehicle_is_named():
    """Out of RTL, LAND or a failsafe a resume must name its vehicle: `all` of one vehicle does not."""
    picture = field((0.0, 0.0))
    told = (("resume 1", True), ("resume", True), ("resume all", False), ("resume evader", False))
    for typed, named in told:
        order = command_parser.parse(typed, picture, 1)
        assert isinstance(order, command_parser.Order)
        assert (order.ids, order.named) == ((1,), named), typed
