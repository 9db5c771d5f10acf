"""The well-known messages of Foxglove's viewers that a recording carries, as JSON.

Names and fields as the published schemas `foxglove.SceneUpdate`, `FrameTransforms`, `PoseInFrame`,
`LocationFix` and `Log` have them. Their world is x east, y north, z up [m]; the frame is called `field`.
"""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import Any

import msgspec

from gcs.recording.schemas import Layout, as_bytes, inlined
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Triple

WORLD = "field"


class ViewerMessage(msgspec.Struct, frozen=True):
    """Base of all messages for viewers and of their parts."""


class Time(ViewerMessage, frozen=True):
    """An instant since the epoch, or a duration: whole seconds and the nanoseconds beyond."""

    sec: int
    nsec: int


class Vector3(ViewerMessage, frozen=True):
    """A place [m], a direction or a size [m] in the viewers' world."""

    x: float
    y: float
    z: float


class Quaternion(ViewerMessage, frozen=True):
    """An orientation as a unit quaternion, scalar last."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


class Pose(ViewerMessage, frozen=True):
    """Place and orientation."""

    position: Vector3
    orientation: Quaternion = Quaternion()


class Color(ViewerMessage, frozen=True):
    """Red, green, blue and opacity, each 0…1."""

    r: float
    g: float
    b: float
    a: float = 1.0


class KeyValuePair(ViewerMessage, frozen=True):
    """A named word that a viewer shows beside an entity."""

    key: str
    value: str


class Arrow(ViewerMessage, frozen=True):
    """An arrow along the x axis of its pose; lengths and diameters [m]."""

    pose: Pose
    shaft_length: float
    shaft_diameter: float
    head_length: float
    head_diameter: float
    color: Color


class Cube(ViewerMessage, frozen=True):
    """A box centred on its pose."""

    pose: Pose
    size: Vector3
    color: Color


class Sphere(ViewerMessage, frozen=True):
    """An ellipsoid centred on its pose."""

    pose: Pose
    size: Vector3
    color: Color


class Cylinder(ViewerMessage, frozen=True):
    """A cylinder along the z axis of its pose; the scales (0…1) narrow its ends to a cone."""

    pose: Pose
    size: Vector3
    bottom_scale: float
    top_scale: float
    color: Color


class Line(ViewerMessage, frozen=True):
    """Points joined by lines; `thickness` in pixels where `scale_invariant`, otherwise [m]."""

    type: int  # 0 strip, 1 loop, 2 list
    pose: Pose
    thickness: float
    scale_invariant: bool
    points: tuple[Vector3, ...]
    color: Color
    colors: tuple[Color, ...] = ()
    indices: tuple[int, ...] = ()


class Triangles(ViewerMessage, frozen=True):
    """A surface of triangles."""

    pose: Pose
    points: tuple[Vector3, ...]
    color: Color
    colors: tuple[Color, ...] = ()
    indices: tuple[int, ...] = ()


class Text(ViewerMessage, frozen=True):
    """Words at a place; `font_size` in pixels where `scale_invariant`, otherwise [m]."""

    pose: Pose
    billboard: bool
    font_size: float
    scale_invariant: bool
    color: Color
    text: str


class Model(ViewerMessage, frozen=True):
    """A 3-D model from a URL or from embedded data."""

    pose: Pose
    scale: Vector3
    color: Color
    override_color: bool
    url: str
    media_type: str
    data: str


class Entity(ViewerMessage, frozen=True, kw_only=True):
    """Everything drawn under one id; a later entity of that id replaces it."""

    timestamp: Time
    frame_id: str = WORLD
    id: str
    lifetime: Time
    frame_locked: bool = False
    metadata: tuple[KeyValuePair, ...] = ()
    arrows: tuple[Arrow, ...] = ()
    cubes: tuple[Cube, ...] = ()
    spheres: tuple[Sphere, ...] = ()
    cylinders: tuple[Cylinder, ...] = ()
    lines: tuple[Line, ...] = ()
    triangles: tuple[Triangles, ...] = ()
    texts: tuple[Text, ...] = ()
    models: tuple[Model, ...] = ()


class Deletion(ViewerMessage, frozen=True):
    """Removes the entity of an id (`type` 0) or all entities (1)."""

    timestamp: Time
    type: int
    id: str


class SceneUpdate(ViewerMessage, frozen=True):
    """What changes in the scene."""

    entities: tuple[Entity, ...]
    deletions: tuple[Deletion, ...] = ()


class FrameTransform(ViewerMessage, frozen=True):
    """Where a frame (a vehicle's body) lies in its parent."""

    timestamp: Time
    parent_frame_id: str
    child_frame_id: str
    translation: Vector3
    rotation: Quaternion


class FrameTransforms(ViewerMessage, frozen=True):
    """Several transforms of one instant."""

    transforms: tuple[FrameTransform, ...]


class PoseInFrame(ViewerMessage, frozen=True):
    """A pose in a named frame."""

    timestamp: Time
    frame_id: str
    pose: Pose


class LocationFix(ViewerMessage, frozen=True):
    """A place on Earth: WGS-84 and height above mean sea level."""

    timestamp: Time
    frame_id: str
    latitude: float  # [deg]
    longitude: float  # [deg]
    altitude: float  # [m]
    position_covariance: tuple[float, ...] = (0.0,) * 9
    position_covariance_type: int = 0  # unknown


class Log(ViewerMessage, frozen=True):
    """One line of the log panel."""

    timestamp: Time
    level: int  # 1 debug, 2 info, 3 warning, 4 error
    message: str
    name: str
    file: str = ""
    line: int = 0


def layout(kind: type[ViewerMessage]) -> Layout:
    """The channel layout of one of the messages above."""
    schema = inlined(msgspec.json.schema(kind), {})
    return Layout(f"foxglove.{kind.__name__}", "json", as_bytes(_plain(schema)))


def _plain(node: Any) -> Any:
    """Tuples as arrays of items (viewers know no `prefixItems`), and no defaults."""
    if isinstance(node, list):
        return [_plain(item) for item in node]
    if not isinstance(node, dict):
        return node
    return {key: _plain(value) for key, value in node.items() if key != "default"}


def time_of(stamp_ns: int) -> Time:
    """An instant, or a duration of zero or more."""
    return Time(stamp_ns // NS_PER_S, stamp_ns % NS_PER_S)


def enu(position: Triple) -> Vector3:
    """A place of the game frame (north, east, down) in the viewers' world, to the millimetre."""
    return Vector3(round(position[1], 3), round(position[0], 3), round(-position[2], 3))


def attitude(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Orientation of a body (x ahead, y left, z up) from its attitude in the game frame [rad].

    In the viewers' world yaw counts from east to north and a nose up is a negative turn about y.
    """
    half_yaw, half_pitch, half_roll = (1.5707963267948966 - yaw) / 2, -pitch / 2, roll / 2
    cy, sy, cp, sp = cos(half_yaw), sin(half_yaw), cos(half_pitch), sin(half_pitch)
    cr, sr = cos(half_roll), sin(half_roll)
    return Quaternion(
        round(sr * cp * cy - cr * sp * sy, 5),
        round(cr * sp * cy + sr * cp * sy, 5),
        round(cr * cp * sy - sr * sp * cy, 5),
        round(cr * cp * cy + sr * sp * sy, 5),
    )


def turn_to(axis: Triple) -> Quaternion:
    """The turn that takes the world's z axis to a direction of the game frame (north, east, down)."""
    x, y, z = axis[1], axis[0], -axis[2]
    length = sqrt(x * x + y * y + z * z)
    if length < 1e-9:
        return Quaternion()
    x, y, z = x / length, y / length, z / length
    w, qx, qy = 1.0 + z, -y, x
    size = sqrt(w * w + qx * qx + qy * qy)
    if size < 1e-6:  # straight down: half a turn about any level axis
        return Quaternion(1.0, 0.0, 0.0, 0.0)
    return Quaternion(round(qx / size, 5), round(qy / size, 5), 0.0, round(w / size, 5))
