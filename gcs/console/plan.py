"""The field seen from above, drawn with characters: north is up. Pure.

Lines, trails and circles are braille dots, two across and four down in each character, so that a dot is
about as wide as it is high. Everything that colour says is said by a sign as well.
"""

from __future__ import annotations

from math import atan2, ceil, cos, floor, hypot, log10, pi, remainder, sin
from typing import NamedTuple

from gcs.console.vehicle_table import GRADE_WORDS, STYLES, Grade, grades
from gcs.picture.current import MOTION_OLD_S, current
from gcs.picture.values import Picture, Presence, VehicleView
from onboard.game import palette, sides
from onboard.wire.bus.messages import Role, Setup

Run = tuple[str, str]  # text, style
ARROWS = "↑↗→↘↓↙←↖"
BRAILLE = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))  # [row][column]
MOST_DOTS = 2000  # of one line or circle
FAR = 1e9  # [dots] what lies farther off is not drawn: Apollonius circles have no greatest radius
FAINT = palette.FAINT.dark  # of those that are on no side
NAME_MOST = 12  # characters of a zone's name
MARGIN = 0.15  # share of the view kept free when it is fitted


class View(NamedTuple):
    """Which part of the field is shown."""

    north: float  # centre [m]
    east: float
    scale: float  # [m] per dot


class Options(NamedTuple):
    """What the plan shows beside the vehicles."""

    trails: bool = True
    circles: bool = True


START = View(0.0, 0.0, 2.0)
ALL = Options()


def points(picture: Picture) -> list[tuple[float, float]]:
    """What a fitted view must show: vehicles there, tracks, the target."""
    found = [v.position[:2] for v in picture.vehicles if v.position and v.presence is not Presence.EXPECTED]
    found += [t.track.position[:2] for t in picture.tracks]
    if found:
        found += [goal.place[:2] for goal in picture.game.targets]
    if not found and picture.game.setup:
        found = [member.start[:2] for member in picture.game.setup.roster]
    return found


def fitted(view: View, picture: Picture, width: int, height: int) -> View:
    """The view itself while all is in it and not lost in its middle; else one that fits, in round steps."""
    places = points(picture)
    if not places or width < 2 or height < 2:
        return view
    low_n, high_n = min(p[0] for p in places), max(p[0] for p in places)
    low_e, high_e = min(p[1] for p in places), max(p[1] for p in places)
    half_e, half_n = width * view.scale, 2 * height * view.scale
    inside = (
        low_e >= view.east - 0.95 * half_e and high_e <= view.east + 0.95 * half_e
        and low_n >= view.north - 0.95 * half_n and high_n <= view.north + 0.95 * half_n
    )  # fmt: skip
    need = max((high_e - low_e) / (2 * width), (high_n - low_n) / (4 * height)) / (1 - 2 * MARGIN)
    if inside and need > view.scale / 4:
        return view
    return View((low_n + high_n) / 2, (low_e + high_e) / 2, round_up(max(need, 0.05)))


def round_up(value: float) -> float:
    """The next of 1, 2, 5, 10 …"""
    power = 10.0 ** floor(log10(value))
    for step in (1.0, 2.0, 5.0):
        if value <= step * power * 1.000001:
            return step * power
    return 10.0 * power


def zoomed(view: View, closer: bool) -> View:
    """One round step closer or farther, within a centimetre and 10 km a dot."""
    scale = round_up(view.scale * 1.01) if not closer else round_up(view.scale / 2.51)
    return view._replace(scale=min(1e4, max(0.01, scale)))


class _Canvas:
    def __init__(self, width: int, height: int, view: View) -> None:
        self.width, self.height, self.view = width, height, view
        self.dots = [[0] * width for _ in range(height)]
        self.signs: list[list[str]] = [[""] * width for _ in range(height)]
        self.styles = [[""] * width for _ in range(height)]

    def place(self, north: float, east: float) -> tuple[float, float]:
        """Dot coordinates: right, down."""
        v = self.view
        return (east - v.east) / v.scale + self.width, (v.north - north) / v.scale + 2 * self.height

    def dot(self, x: float, y: float, style: str) -> None:
        """A braille dot at dot coordinates; nothing outside the view."""
        if 0 <= x < 2 * self.width and 0 <= y < 4 * self.height:
            column, row = int(x), int(y)
            self.dots[row // 4][column // 2] |= BRAILLE[row % 4][column % 2]
            self.styles[row // 4][column // 2] = style

    def line(self, a: tuple[float, float], b: tuple[float, float], style: str, gap: int = 1) -> None:
        """A line between two places (north, east), every `gap`-th dot."""
        start, end = self.place(*a), self.place(*b)
        if not all(abs(x) < FAR for x in (*start, *end)):
            return
        ends = _clipped(start, end, 2.0 * self.width, 4.0 * self.height)
        if ends is None:
            return
        (x0, y0), (x1, y1) = ends
        steps = max(1, min(MOST_DOTS, ceil(max(abs(x1 - x0), abs(y1 - y0)))))
        for step in range(0, steps + 1, gap):
            self.dot(x0 + (x1 - x0) * step / steps, y0 + (y1 - y0) * step / steps, style)

    def circle(self, north: float, east: float, radius: float, style: str) -> None:
        """A circle about a place [m], unless it is too small or too large to be seen as one."""
        r = radius / self.view.scale
        if not 1.5 <= r < FAR:
            return
        x, y = self.place(north, east)
        count = min(MOST_DOTS, ceil(2 * pi * r))
        for step in range(count):
            angle = 2 * pi * step / count
            self.dot(x + r * sin(angle), y - r * cos(angle), style)

    def text(self, column: int, row: int, text: str, style: str) -> None:
        """Text from a character cell on to the right; what leaves the view is cut off."""
        if not 0 <= row < self.height:
            return
        for offset, sign in enumerate(text):
            if 0 <= column + offset < self.width:
                self.signs[row][column + offset] = sign
                self.styles[row][column + offset] = style

    def sign(self, north: float, east: float, text: str, style: str) -> None:
        """Text whose first character stands at a place; moved left where it would leave the view."""
        x, y = self.place(north, east)
        if 0.0 <= x < 2 * self.width and 0.0 <= y < 4 * self.height:
            column, row = floor(x / 2), floor(y / 4)
            self.text(max(0, min(column, self.width - len(text))), row, text, style)

    def rows(self) -> list[list[Run]]:
        """All rows from the top, each as runs of one style."""
        rows = []
        for signs, dots, styles in zip(self.signs, self.dots, self.styles, strict=True):
            runs: list[Run] = []
            text, style = "", ""
            for sign, dot, own in zip(signs, dots, styles, strict=True):
                here = sign or (chr(0x2800 + dot) if dot else " ")
                if own != style and text:
                    runs.append((text, style))
                    text = ""
                text, style = text + here, own
            runs.append((text, style))
            rows.append(runs)
        return rows


def _clipped(
    a: tuple[float, float], b: tuple[float, float], width: float, height: float
) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """The part of a line inside the canvas (Liang and Barsky)."""
    low, high = 0.0, 1.0
    dx, dy = b[0] - a[0], b[1] - a[1]
    for p, q in ((-dx, a[0]), (dx, width - a[0]), (-dy, a[1]), (dy, height - a[1])):
        if p == 0.0:
            if q < 0.0:
                return None
        elif p < 0.0:
            low = max(low, q / p)
        else:
            high = min(high, q / p)
    if low > high:
        return None
    return (a[0] + low * dx, a[1] + low * dy), (a[0] + high * dx, a[1] + high * dy)


def plan(
    picture: Picture, view: View, width: int, height: int, selected: int | None, options: Options = ALL
) -> list[list[Run]]:
    """Rows of styled text, `height` of them, each `width` wide."""
    canvas = _Canvas(width, height, view)
    setup = picture.game.setup
    if setup is not None:
        _limits(canvas, setup)
    chosen = picture.vehicle(selected) if selected is not None else None
    now, shades = current(picture), {id: c.dark for id, c in sides.colours(picture.roles).items()}
    if options.circles:
        _circles(canvas, now, chosen, shades)
    if options.trails:
        _trails(canvas, picture, shades)
    _chases(canvas, now, selected, shades)
    active = None if chosen is None else now.vehicle(chosen.id)
    if active is not None and active.decision is not None and active.position is not None:
        aim = active.decision.aim
        canvas.line(active.position[:2], aim[:2], "bold", gap=3)
        canvas.sign(aim[0], aim[1], "×", "bold")
    several = len(sides.evaders(picture.roles)) > 1
    for goal in picture.game.targets:
        name = f"◎{goal.evader}" if several else "◎"
        canvas.sign(*goal.place[:2], name, f"bold {palette.TARGET.dark}")
    own = {v.id for v in now.vehicles if v.position}
    for track in now.tracks:
        if track.id not in own:
            canvas.sign(*track.track.position[:2], f"+{track.id}", shades.get(track.id, FAINT))
    graded = grades(picture)
    for vehicle in sorted(picture.vehicles, key=lambda v: v.id == selected):
        if vehicle.position is not None:
            colour = shades.get(vehicle.id, FAINT)
            grade = graded[vehicle.id] if vehicle.state_age_s <= MOTION_OLD_S else Grade.LOST
            label, style = _label(vehicle, grade, vehicle.id == selected, colour)
            fate = picture.game.fate_of(vehicle.id) if several else None
            if fate is not None and fate.out:
                label, style = f"{label} {fate.verdict.value}", f"dim {colour}"
            canvas.sign(vehicle.position[0], vehicle.position[1], label, style)
    _scale(canvas)
    return canvas.rows()


def _limits(canvas: _Canvas, setup: Setup) -> None:
    """The fence in dots, zones in lines."""
    edges = [(setup.fence.polygon, "dim", 2)] if setup.fence is not None else []
    edges += [(zone.polygon, palette.ZONE.dark, 1) for zone in setup.zones]
    for corners, style, gap in edges:
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            canvas.line(a, b, style, gap=gap)
    for zone in setup.zones:
        north, east = (sum(axis) / len(zone.polygon) for axis in zip(*zone.polygon, strict=True))
        canvas.sign(north, east, zone.name[:NAME_MOST], f"dim {palette.ZONE.dark}")


def _chases(canvas: _Canvas, picture: Picture, selected: int | None, shades: dict[int, str]) -> None:
    """Thin lines between the selected vehicle and those that are after it, or whom it is after."""
    at = {v.id: v.position[:2] for v in picture.vehicles if v.position is not None}
    at = {track.id: track.track.position[:2] for track in picture.tracks} | at
    for pursuer, evader in picture.game.quarries:
        if selected in (pursuer, evader) and pursuer in at and evader in at:
            canvas.line(at[pursuer], at[evader], f"dim {shades.get(evader, FAINT)}", gap=6)


def _circles(canvas: _Canvas, picture: Picture, chosen: VehicleView | None, shades: dict[int, str]) -> None:
    if picture.game.setup is not None:
        for vehicle in picture.vehicles:
            if vehicle.role is Role.PURSUER and vehicle.position is not None:
                style = f"dim {shades.get(vehicle.id, FAINT)}"
                canvas.circle(*vehicle.position[:2], picture.game.setup.rules.R, style)
    if chosen is not None and chosen.decision is not None and chosen.decision_age_s <= MOTION_OLD_S:
        for north, east, _, radius in chosen.decision.circles:
            canvas.circle(north, east, radius, palette.APOLLONIUS.dark)


def _trails(canvas: _Canvas, picture: Picture, shades: dict[int, str]) -> None:
    seen = set()
    for vehicle in picture.vehicles:
        seen.add(vehicle.id)
        style = shades.get(vehicle.id, FAINT)
        for a, b in zip(vehicle.trail, vehicle.trail[1:], strict=False):
            canvas.line(a[:2], b[:2], style)
    for track in picture.tracks:
        if track.id not in seen:
            for place in track.trail:
                canvas.dot(*canvas.place(*place[:2]), shades.get(track.id, FAINT))


def _label(vehicle: VehicleView, grade: Grade, selected: bool, colour: str) -> tuple[str, str]:
    """The sign of a vehicle, and its style: what is wrong with it, else its own colour."""
    assert vehicle.state is not None
    name = f"E{vehicle.id}" if vehicle.role is Role.EVADER else str(vehicle.id)
    if selected:
        name = f"[{name}]"
    if grade is Grade.LOST:
        return f"✕{name}", STYLES[grade]
    north, east, _ = vehicle.state.velocity
    course = atan2(east, north) if hypot(north, east) > 0.5 else vehicle.state.yaw
    arrow = ARROWS[round(remainder(course, 2 * pi) / (pi / 4)) % 8]
    alarm = "!" if grade in (Grade.ERROR, Grade.WARN) else ""
    return f"{arrow}{name}{alarm}", STYLES[grade] if alarm else f"bold {colour}"


def _scale(canvas: _Canvas) -> None:
    """A scale bar, and which way is north."""
    if canvas.width < 16 or canvas.height < 3:
        return
    length = round_up(canvas.view.scale * 2 * canvas.width / 8)
    cells = max(2, round(length / (2 * canvas.view.scale)))
    unit = f"{length / 1000:g} km" if length >= 1000 else f"{length:g} m"
    canvas.text(0, canvas.height - 1, f"├{'─' * (cells - 2)}┤ {unit}", "dim")
    canvas.text(canvas.width - 2, 0, "N↑", "dim")


LEGEND = (
    ("↗2", "pursuer 2 and its course"),
    ("E1", "an evader; one that is out of the game says how"),
    ("[2]", "the selected vehicle, with its line to its aim × and its Apollonius circles"),
    ("2!", f"an alert about it ({GRADE_WORDS[Grade.WARN]} or {GRADE_WORDS[Grade.ERROR]})"),
    ("✕2", "where it was last: lost, or its position is old"),
    ("+1", "a track of somebody who does not speak here"),
    ("⣏⣹", "a zone, with its name: everybody keeps out; the fence is dotted"),
    ("◎", "the evader's target; of several evaders with its id"),
)
