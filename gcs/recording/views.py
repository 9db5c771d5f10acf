"""Derives, from the recorded stream, what generic viewers can show: scene, poses, places on Earth, log.

Five times a second of the stream's own time, from the newest message of each vehicle; so the cost does
not grow with the rates on the bus, and the same stream gives the same bytes.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterator
from math import pi, sqrt, tan
from typing import Any, NamedTuple

import msgspec

from gcs.picture.several import goals, named, verdict_in_words
from gcs.picture.station_journal import HEARD_HERE, REMARK, SENT, Remark, Sent
from gcs.recording import foxglove as fox
from gcs.recording.schemas import Layout
from onboard.core.geometry.zones import ENDLESS
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    DecisionReport,
    EvaderBrief,
    Event,
    Outcome,
    OwnBrief,
    PhaseChange,
    Role,
    Setup,
    Severity,
    State,
)
from onboard.wire.geodesy import Frame

STEP_NS = NS_PER_S // 5
SILENT_NS = 3 * NS_PER_S  # a vehicle not heard for this long is no longer drawn anew
TRAIL_STEPS = 60  # of one second
TRAIL_NS = 5 * NS_PER_S  # trails are drawn anew so often: they are most of a scene's bytes
CONE_LENGTH = 25.0  # [m] blocked cones are drawn so far
MOST_DRAWN = 250

SCENE, TRANSFORMS = fox.layout(fox.SceneUpdate), fox.layout(fox.FrameTransforms)
POSE, PLACE, LOG = fox.layout(fox.PoseInFrame), fox.layout(fox.LocationFix), fox.layout(fox.Log)

COLORS = {
    Role.EVADER: fox.Color(0.90, 0.62, 0.0),
    Role.PURSUER: fox.Color(0.0, 0.45, 0.70),
    Role.TRACKER: fox.Color(0.5, 0.5, 0.5),
}
TARGET = fox.Color(0.0, 0.62, 0.45)
FENCE = fox.Color(0.8, 0.47, 0.65)
ZONE = fox.Color(0.61, 0.24, 0.21)
ENDLESS_DRAWN_M = 200.0  # height of a zone without end
INFO = 2
LEVELS = {Severity.INFO: INFO, Severity.WARNING: 3, Severity.ERROR: 4}
FOREVER = fox.Time(0, 0)


class View(NamedTuple):
    """One message for viewers."""

    topic: str
    layout: Layout
    payload: bytes


class _Line(NamedTuple):
    """One line of the viewers' log."""

    level: int
    text: str
    name: str  # who says it


class _Drawn:
    """The newest of one vehicle."""

    __slots__ = ("decision", "heard_ns", "state", "trail")

    def __init__(self) -> None:
        self.state = b""
        self.decision = b""
        self.heard_ns = 0
        self.trail: deque[fox.Vector3] = deque(maxlen=TRAIL_STEPS)


class Views:
    """Feed it with every message; take what `due` and `said` give."""

    def __init__(self) -> None:
        self.roles: dict[int, Role] = {}  # of the vehicles drawn so far
        self._vehicles: dict[int, _Drawn] = {}
        self._setup: Setup | None = None
        self._frame: Frame | None = None
        self._brief: EvaderBrief | None = None
        self._own_briefs: dict[int, OwnBrief] = {}
        self._changed = False  # what does not move
        self.next_ns = 0
        self._drops: Counter[str] = Counter()
        self._encode = msgspec.json.Encoder().encode

    def note(self, key: str, payload: bytes, stamp_ns: int) -> View | None:
        """Take a message in; what is to be written at once (a line of the log), None for most."""
        place = HEARD_HERE.find(key)
        if place is None:
            return None
        topic = place.topic
        if topic is topics.STATE or topic is topics.DECISION:  # decoded when they are drawn
            drawn = self._vehicles.get(place.id or 0) or self._new(place.id)
            if topic is topics.DECISION:
                drawn.decision = payload
            else:
                drawn.state, drawn.heard_ns = payload, stamp_ns
            return None
        take = _TAKERS.get(topic)
        if take is None:
            return None
        heard = HEARD_HERE.heard(key, payload, self._drops)
        line = take(self, heard.message) if heard is not None else None
        if line is None:
            return None
        log = fox.Log(fox.time_of(stamp_ns), line.level, line.text, line.name)
        return View("/log", LOG, self._encode(log))

    def _new(self, id: int | None) -> _Drawn:
        """Of a vehicle that was not heard before; one that is not drawn is kept nowhere."""
        drawn = _Drawn()
        if id is not None and id <= MOST_DRAWN:
            self._vehicles[id] = drawn
        return drawn

    def _on_setup(self, setup: Setup) -> None:
        self._setup, self._changed = setup, True
        self._frame = Frame(setup.origin.latitude_deg, setup.origin.longitude_deg, setup.origin.altitude_m)

    def _on_brief(self, brief: EvaderBrief) -> None:
        self._brief, self._changed = brief, True

    def _on_own_brief(self, brief: OwnBrief) -> None:
        self._own_briefs[brief.id], self._changed = brief, True

    def _on_event(self, event: Event) -> _Line:
        return _Line(LEVELS[event.severity], event.text, f"vehicle-{event.id}")

    def _on_phase(self, phase: PhaseChange) -> _Line:
        why = f": {phase.reason}" if phase.reason else ""
        return _Line(INFO, f"game {phase.phase.value}{why}", "game")

    def _on_outcome(self, outcome: Outcome) -> _Line:
        return _Line(INFO, f"{verdict_in_words(outcome)} after {outcome.time:.1f} s", "game")

    def _on_remark(self, remark: Remark) -> _Line:
        return _Line(LEVELS[remark.severity], remark.text, "station")

    def _on_sent(self, sent: Sent) -> _Line:
        to = ", ".join(map(str, sent.ids))
        return _Line(INFO, f"{sent.command.kind.value} to {to} by {sent.command.sender}", "station")

    def due(self, stamp_ns: int) -> Iterator[tuple[int, View]]:
        """What the stream's time reaching `stamp_ns` asks for, with the instant it is of."""
        if self.next_ns == 0:
            self.next_ns = -(-stamp_ns // STEP_NS) * STEP_NS
        if stamp_ns < self.next_ns:
            return
        at_ns = stamp_ns // STEP_NS * STEP_NS  # after a silence: the newest instant alone
        self.next_ns = at_ns + STEP_NS
        for view in self._draw(at_ns):
            yield at_ns, view

    def _draw(self, at_ns: int) -> Iterator[View]:
        at = fox.time_of(at_ns)
        entities: list[fox.Entity] = []
        transforms: list[fox.FrameTransform] = []
        if self._changed:
            entities += self._still(at)
            self._changed = False
        whole_second = at_ns % NS_PER_S == 0
        trails = at_ns % TRAIL_NS == 0
        for vehicle_id, drawn in sorted(self._vehicles.items()):
            if not drawn.state or at_ns - drawn.heard_ns > SILENT_NS:
                continue
            state = topics.STATE.decode(drawn.state, self._drops)
            if state is None:
                continue
            self.roles[vehicle_id] = state.role
            place, turn = fox.enu(state.position), fox.attitude(state.roll, state.pitch, state.yaw)
            name = f"vehicle-{vehicle_id}"
            transforms.append(fox.FrameTransform(at, fox.WORLD, name, place, turn))
            pose = fox.PoseInFrame(at, fox.WORLD, fox.Pose(place, turn))
            yield View(f"/position/{vehicle_id}", POSE, self._encode(pose))
            if self._frame is not None:
                spot = self._frame.geodetic_from_ned(Vec(*state.position))
                place_on_earth = (round(spot.latitude_deg, 8), round(spot.longitude_deg, 8))
                fix = fox.LocationFix(at, name, *place_on_earth, round(spot.altitude_m, 3))
                yield View(f"/location/{vehicle_id}", PLACE, self._encode(fix))
            decision = topics.DECISION.decode(drawn.decision, self._drops) if drawn.decision else None
            entities.append(self._vehicle(at, name, state, decision, fox.Pose(place, turn)))
            if whole_second:
                drawn.trail.append(place)
            if trails and drawn.trail:
                entities.append(_trail(at, name, tuple(drawn.trail), COLORS[state.role]))
        if transforms:
            yield View("/tf", TRANSFORMS, self._encode(fox.FrameTransforms(tuple(transforms))))
        if entities:
            yield View("/scene", SCENE, self._encode(fox.SceneUpdate(tuple(entities))))

    def _vehicle(
        self, at: fox.Time, name: str, state: State, decision: DecisionReport | None, pose: fox.Pose
    ) -> fox.Entity:
        color = COLORS[state.role]
        spheres: tuple[fox.Sphere, ...] = ()
        if self._setup is not None and state.role is Role.PURSUER:
            across = 2.0 * self._setup.rules.R
            faint = fox.Color(color.r, color.g, color.b, 0.2)
            spheres = (fox.Sphere(fox.Pose(pose.position), fox.Vector3(across, across, across), faint),)
        rule = f" {decision.rule}" if decision is not None and decision.rule else ""
        above = fox.Pose(fox.Vector3(pose.position.x, pose.position.y, round(pose.position.z + 2.0, 3)))
        lines: tuple[fox.Line, ...] = ()
        cylinders: tuple[fox.Cylinder, ...] = ()
        if decision is not None:
            aim = (pose.position, fox.enu(decision.aim))
            lines = (fox.Line(0, fox.Pose(fox.Vector3(0, 0, 0)), 1.0, True, aim, color),)
            cylinders = tuple(_cone(pose.position, *cone) for cone in decision.cones)
        return fox.Entity(
            timestamp=at,
            id=name,
            lifetime=fox.Time(3, 0),
            metadata=(fox.KeyValuePair("role", state.role.value), fox.KeyValuePair("mode", state.mode)),
            arrows=(fox.Arrow(pose, 2.0, 0.3, 0.8, 0.8, color),),
            spheres=spheres,
            cylinders=cylinders,
            lines=lines,
            texts=(fox.Text(above, True, 14.0, True, color, f"{state.id}{rule}"),),
        )

    def _still(self, at: fox.Time) -> Iterator[fox.Entity]:
        """What does not move: targets, fence and zones."""
        for number, (name, goal) in enumerate(named(goals(self._setup, self._brief, self._own_briefs))):
            place = fox.Pose(fox.enu(goal))
            ball = fox.Sphere(place, fox.Vector3(2.0, 2.0, 2.0), TARGET)
            text = fox.Text(place, True, 14.0, True, TARGET, name)
            id = f"target-{number}" if number else "target"
            yield fox.Entity(timestamp=at, id=id, lifetime=FOREVER, spheres=(ball,), texts=(text,))
        if self._setup is None:
            return
        if self._setup.fence is not None:
            fence = self._setup.fence
            loops = _loops(fence.polygon, (fence.altitude_min, fence.altitude_max), FENCE)
            yield fox.Entity(timestamp=at, id="fence", lifetime=FOREVER, lines=loops)
        for number, zone in enumerate(self._setup.zones):
            low, high = max(0.0, zone.low), zone.high if zone.high < ENDLESS else ENDLESS_DRAWN_M
            edges = (
                _line(0, (fox.Vector3(e, n, low), fox.Vector3(e, n, high)), ZONE) for n, e in zone.polygon
            )
            lines = (*_loops(zone.polygon, (low, high), ZONE), *edges)
            north, east = zone.polygon[0]
            place = fox.Pose(fox.Vector3(east, north, high))
            text = fox.Text(place, True, 14.0, True, ZONE, zone.name)
            yield fox.Entity(timestamp=at, id=f"zone-{number}", lifetime=FOREVER, lines=lines, texts=(text,))


def _loops(
    polygon: tuple[tuple[float, float], ...], heights: tuple[float, ...], color: fox.Color
) -> tuple[fox.Line, ...]:
    """The outline of a polygon at these heights."""
    rings = [tuple(fox.Vector3(east, north, height) for north, east in polygon) for height in heights]
    return tuple(_line(1, ring, color) for ring in rings)


def _line(kind: int, points: tuple[fox.Vector3, ...], color: fox.Color) -> fox.Line:
    """A strip (0) or a loop (1) of lines."""
    return fox.Line(kind, fox.Pose(fox.Vector3(0, 0, 0)), 1.0, True, points, color)


def _trail(at: fox.Time, name: str, points: tuple[fox.Vector3, ...], color: fox.Color) -> fox.Entity:
    line = fox.Line(0, fox.Pose(fox.Vector3(0, 0, 0)), 1.5, True, points, color)
    return fox.Entity(timestamp=at, id=f"trail-{name}", lifetime=FOREVER, lines=(line,))


def _cone(apex: fox.Vector3, north: float, east: float, down: float, half_angle: float) -> fox.Cylinder:
    """A blocked cone as a cylinder that has its point at the apex."""
    length = CONE_LENGTH
    half = length / 2 / (sqrt(north * north + east * east + down * down) or 1.0)
    middle = fox.Vector3(
        round(apex.x + east * half, 3), round(apex.y + north * half, 3), round(apex.z - down * half, 3)
    )
    across = 2.0 * length * tan(min(max(half_angle, 0.0), pi / 2 - 0.1))
    turn = fox.turn_to((north, east, down))
    return fox.Cylinder(
        fox.Pose(middle, turn), fox.Vector3(across, across, length), 0.0, 1.0, fox.Color(0.8, 0.2, 0.2, 0.15)
    )


_TAKERS: dict[topics.Topic[Any], Callable[[Views, Any], _Line | None]] = {
    topics.SETUP: Views._on_setup,
    topics.EVADER_BRIEF: Views._on_brief,
    topics.OWN_BRIEF: Views._on_own_brief,
    topics.EVENTS: Views._on_event,
    topics.PHASE: Views._on_phase,
    topics.OUTCOME: Views._on_outcome,
    REMARK: Views._on_remark,
    SENT: Views._on_sent,
}
