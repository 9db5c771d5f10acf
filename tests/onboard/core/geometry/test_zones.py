"""Zones: inside, entered, tangents and ways round, against dense sampling, hulls and a visibility graph."""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import combinations, pairwise
from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from onboard.core.geometry.cones import NOTHING, Cone, is_free
from onboard.core.geometry.zone_rays import (
    Look,
    Stand,
    blocked_arc,
    free_ray_beside,
    looking,
)
from onboard.core.geometry.zone_ways import way_round
from onboard.core.geometry.zones import (
    MISSES,
    Prism,
    Zones,
    bent_in,
    clearance,
    entry,
    in_any,
    way_out_of,
    zones_of,
)
from onboard.core.math.states import FREE, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, along, direction, distance, dot, sub, unit

Corner = tuple[float, float]
Corners = tuple[Corner, ...]


def hull(rng: np.random.Generator, centre: tuple[float, float], size: float) -> Corners:
    """A random convex polygon of 3 to 12 corners about a place."""
    while True:
        points = rng.normal(scale=size, size=(rng.integers(3, 13), 2)) + centre
        found = points[ConvexHull(points).vertices]
        if 3 <= len(found) <= 12:
            return tuple((float(x), float(y)) for x, y in found)


def fields(count: int, heights: bool = False) -> list[tuple[Zones, list[Prism]]]:
    """Random fields of one to three zones about (200, 0) … (600, 0)."""
    made = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        prisms = [
            Prism(hull(rng, (200.0 * (k + 1), float(rng.uniform(-60, 60))), 40.0),
                  *((30.0, 30.0 + float(rng.uniform(20, 200))) if heights else (-1e9, 1e9)))
            for k in range(int(rng.integers(1, 4)))
        ]  # fmt: skip
        made.append((zones_of(prisms), prisms))
    return made


def grown(zones: Zones, prism: Prism, margin: float) -> list[tuple[float, float, float, float]]:
    """Half-planes n·p ≤ c of a polygon grown by a margin, from its hull's equations."""
    made = ConvexHull(np.array(prism.polygon))
    return [(a, b, -c + margin, 0.0) for a, b, c in made.equations]


def test_a_place_is_inside_where_the_hull_says_so() -> None:
    for zones, prisms in fields(30):
        rng = np.random.default_rng(7)
        for x, y in rng.uniform((50, -250), (750, 250), (200, 2)):
            place = Vec(x, y, 0.0)
            for area, prism in zip(zones.areas, prisms, strict=True):
                worst = max(a * x + b * y - c for a, b, c, _ in grown(zones, prism, 0.0))
                assert clearance(zones, area, place, True) == pytest.approx(worst, abs=1e-9)
            out = [way_out_of(zones, area, place, True) for area in zones.areas]
            assert in_any(zones, place, True) == any(one.clearance < 0 for one in out)
            for area, way in zip(zones.areas, out, strict=True):
                if way.clearance < 0:
                    left = along(place, way.outward, -way.clearance)
                    assert clearance(zones, area, left, True) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("planar", [True, False])
def test_a_way_enters_where_it_is_first_found_inside(planar: bool) -> None:
    hits = 0
    for seed, (zones, _prisms) in enumerate(fields(40, heights=True)):
        rng = np.random.default_rng(seed)
        a, b = (Vec(*rng.uniform((0, -150, -250), (700, 150, 0))) for _ in range(2))
        margin = float(rng.uniform(0, 10))
        for area in zones.areas:
            share = entry(zones, area, margin, a, b, planar)
            steps = np.linspace(0.0, 1.0, 2001)
            within = [
                clearance(zones, area, along(a, sub(b, a), float(t)), planar) < margin - 1e-3 for t in steps
            ]
            if any(within):
                hits += 1
                assert share == pytest.approx(steps[int(np.argmax(within))], abs=1e-3)
            elif share != MISSES:  # too short a stay for the steps
                assert clearance(zones, area, along(a, sub(b, a), share), planar) < margin
    assert hits > 15


def test_a_bent_polygon_is_told_by_its_corner() -> None:
    square = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
    assert bent_in(square) == bent_in(square[::-1]) == -1
    assert bent_in((*square[:2], (1.0, 1.0), *square[2:])) in (1, 2, 3)
    star = tuple((cos(4 * pi * k / 5), sin(4 * pi * k / 5)) for k in range(5))
    assert bent_in(star) >= 0
    for seed in range(200):
        corners = hull(np.random.default_rng(seed), (0.0, 0.0), 5.0)
        assert bent_in(corners) == -1


def look_at(
    zones: Zones, position: Vec, aim: Vec, planar: bool, wind: Vec = ZERO, margin: float = 5.0
) -> Look:
    """A look at 15 m/s."""
    stand = Stand(zones, position, aim, margin, planar)
    return looking(stand, 15.0, wind, distance(position, aim))


@pytest.mark.parametrize("wind", [ZERO, Vec(4.0, -7.0, 0.0)])
def test_the_blocked_arc_is_that_of_the_rays_that_enter_within_reach(wind: Vec) -> None:
    """Brute force: 3600 headings, each flown over ground for the reach."""
    met = 0
    for seed, (zones, _prisms) in enumerate(fields(25)):
        rng = np.random.default_rng(seed)
        place = Vec(0.0, float(rng.uniform(-100, 100)), 0.0)
        aim = Vec(float(rng.uniform(100, 700)), float(rng.uniform(-200, 200)), 0.0)
        look = look_at(zones, place, aim, True, wind)
        for index, area in enumerate(zones.areas):
            arc = blocked_arc(area, index, look)
            for k in range(3600):
                u = direction(0.0, 2 * pi * k / 3600)
                ground = unit(along(wind, u, look.speed), u)
                end = along(place, ground, look.reach)
                touched = entry(zones, area, look.margins[index] - 0.02, place, end, True) <= 1.0
                near = entry(zones, area, look.margins[index] + 0.02, place, end, True) <= 1.0
                met += touched
                if touched == near:
                    assert is_free(u, (arc,)) == (not touched), (seed, index, k)
    assert met > 1000


def cones_at(rng: np.random.Generator, planar: bool) -> tuple[Cone, ...]:
    """Two random cones."""
    found = []
    for _ in range(2):
        half = float(rng.uniform(0.1, 0.6))
        pitch = 0.0 if planar else float(rng.uniform(-0.3, 0.3))
        found.append(Cone(direction(pitch, float(rng.uniform(-1.0, 1.0))), cos(half), sin(half)))
    return tuple(found)


def test_the_free_ray_in_the_plane_is_the_nearest_of_a_fine_search() -> None:
    for seed, (zones, _prisms) in enumerate(fields(30)):
        rng = np.random.default_rng(seed)
        place, aim = Vec(0.0, float(rng.uniform(-60, 60)), 0.0), Vec(800.0, 0.0, 0.0)
        look = look_at(zones, place, aim, True)
        cones = cones_at(rng, True)
        goal = unit(sub(aim, place), aim)
        found = free_ray_beside(goal, cones, FREE, look)
        best = -2.0
        for k in range(20000):
            u = direction(0.0, 2 * pi * k / 20000)
            if dot(u, goal) > best and is_free(u, cones):
                end = along(place, u, look.reach)
                shares = (
                    entry(zones, a, m, place, end, True)
                    for a, m in zip(zones.areas, look.margins, strict=True)
                )
                if min(shares) > 1.0:
                    best = dot(u, goal)
        assert found.exists
        assert found.closeness >= best - 1e-12
        assert found.closeness <= best + 4e-4


@pytest.mark.parametrize("wind", [ZERO, Vec(3.0, 5.0, -1.0)])
def test_the_free_ray_in_space_is_the_nearest_of_a_fine_search(wind: Vec) -> None:
    """The zones lie nearer than the aim, whole: what counts is whether a ray's line meets them."""
    rng = np.random.default_rng(3)
    n = 12000  # directions spread over the sphere (Fibonacci), denser ones about the best
    k = np.arange(n) + 0.5
    pitch, yaw = np.arcsin(1 - 2 * k / n), pi * (1 + 5**0.5) * k
    sphere = [direction(float(p), float(y)) for p, y in zip(pitch, yaw, strict=True)]
    turned = 0
    for zones, _prisms in fields(8, heights=True):
        place = Vec(0.0, float(rng.uniform(-60, 60)), -float(rng.uniform(10, 120)))
        aim = Vec(2000.0, 0.0, -60.0)
        look = look_at(zones, place, aim, False, wind)
        cones = cones_at(rng, False)
        goal = unit(sub(aim, place), aim)
        found = free_ray_beside(goal, cones, FREE, look)

        def allowed(u: Vec, slack: float, look: Look = look, cones: tuple[Cone, ...] = cones) -> bool:
            ground = unit(along(look.wind, u, look.speed), u)
            end = along(look.position, ground, look.reach)
            return is_free(u, cones) and all(
                entry(look.zones, area, margin - slack, look.position, end, False) > 1.0
                for area, margin in zip(look.zones.areas, look.margins, strict=True)
            )

        assert found.exists
        assert allowed(found.direction, 1e-3), "the answer enters no zone"
        turned += found.closeness < 1.0
        best = goal
        most = -2.0
        for u in sphere:
            if dot(u, goal) > most and allowed(u, 0.0):
                best, most = u, dot(u, goal)
        wide = 0.03
        for _ in range(8):  # closer and closer about the best so far
            for _ in range(150):
                u = unit(along(best, Vec(*rng.normal(size=3)), wide), best)
                if dot(u, goal) > most and allowed(u, 0.0):
                    best, most = u, dot(u, goal)
            wide *= 0.5
        assert found.closeness >= most - 1e-9
        assert found.closeness <= most + 2e-3
    assert turned >= 4


def test_what_lies_behind_the_aim_is_not_in_the_way() -> None:
    wall = zones_of([Prism(((100.0, -80.0), (110.0, -80.0), (110.0, 80.0), (100.0, 80.0)))])
    north = Vec(1.0, 0.0, 0.0)
    for planar in (True, False):
        before = look_at(wall, ZERO, Vec(90.0, 0.0, 0.0), planar)
        assert free_ray_beside(north, (NOTHING,), FREE, before).direction == north
        behind = look_at(wall, ZERO, Vec(200.0, 0.0, 0.0), planar)
        assert free_ray_beside(north, (NOTHING,), FREE, behind).closeness < 0.9


def test_in_space_a_low_wall_is_flown_over_and_a_high_one_round() -> None:
    polygon = ((100.0, -80.0), (110.0, -80.0), (110.0, 80.0), (100.0, 80.0))
    here, aim = Vec(0.0, 0.0, -50.0), Vec(200.0, 0.0, -50.0)
    goal = unit(sub(aim, here), aim)
    low = look_at(zones_of([Prism(polygon, -1e9, 60.0)]), here, aim, False, margin=0.0)
    over = free_ray_beside(goal, (NOTHING,), FREE, low).direction
    assert -over.z / over.x == pytest.approx(10.0 / 100.0, rel=1e-6), "over the near rim"
    level = VehicleLimits(pitch_max=0.05, pitch_min=-0.05)
    flat = free_ray_beside(goal, (NOTHING,), level, low).direction
    assert abs(flat.y) / flat.x >= 0.75, "who cannot climb so steeply goes round"
    assert way_round(low, aim).to.z == pytest.approx(-60.0)
    high = look_at(zones_of([Prism(polygon, -1e9, 500.0)]), here, aim, False, margin=0.0)
    beside = free_ray_beside(goal, (NOTHING,), FREE, high).direction
    assert (abs(beside.y) / beside.x, beside.z) == (pytest.approx(0.8), pytest.approx(0.0, abs=1e-9))
    floating = look_at(zones_of([Prism(polygon, 45.0, 500.0)]), here, aim, False, margin=0.0)
    assert free_ray_beside(goal, (NOTHING,), FREE, floating).direction.z == pytest.approx(0.05, rel=0.01)


def shortest(polygons: list[list[Corner]], a: Corner, b: Corner) -> float:
    """The length of the shortest way by a visibility graph over the corners (Dijkstra)."""
    nodes = [a, b, *(corner for ring in polygons for corner in ring)]

    def crosses(p: Corner, q: Corner) -> bool:
        """Whether a segment runs through the inside of a polygon: sampled at its cuts' middles."""
        for ring in polygons:
            cuts = [0.0, 1.0]
            for (x1, y1), (x2, y2) in zip(ring, [*ring[1:], ring[0]], strict=True):
                dx, dy, ex, ey = q[0] - p[0], q[1] - p[1], x2 - x1, y2 - y1
                bottom = dx * ey - dy * ex
                if abs(bottom) > 1e-12:
                    cuts.append(((x1 - p[0]) * ey - (y1 - p[1]) * ex) / bottom)
            cuts = sorted(t for t in cuts if 0.0 <= t <= 1.0)
            for s, t in pairwise(cuts):
                x, y = (p[k] + (q[k] - p[k]) * 0.5 * (s + t) for k in range(2))
                sides = [
                    (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
                    for (x1, y1), (x2, y2) in zip(ring, [*ring[1:], ring[0]], strict=True)
                ]
                if t - s > 1e-9 and (min(sides) > 1e-6 or max(sides) < -1e-6):
                    return True
        return False

    far = [inf] * len(nodes)
    far[0] = 0.0
    queue = [(0.0, 0)]
    while queue:
        length, i = heappop(queue)
        if length > far[i]:
            continue
        for j, node in enumerate(nodes):
            step = hypot(node[0] - nodes[i][0], node[1] - nodes[i][1])
            if length + step < far[j] and not crosses(nodes[i], node):
                far[j] = length + step
                heappush(queue, (far[j], j))
    return far[1]


def flown(zones: Zones, start: Vec, aim: Vec) -> float:
    """The length of the way flown leg by leg to each corner."""
    here, length = start, 0.0
    for _ in range(60):
        way = way_round(look_at(zones, here, aim, True, margin=0.0), aim)
        length += distance(here, way.to)
        here = way.to
        if not way.round:
            return length
        here = along(here, unit(sub(here, start), here), 1e-7)  # a hair on: the corner is passed
    return inf


def test_round_one_zone_the_way_is_the_shortest_there_is() -> None:
    turned = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        corners = hull(rng, (200.0, float(rng.uniform(-40, 40))), 50.0)
        zones = zones_of([Prism(corners)])
        start, aim = Vec(0.0, float(rng.uniform(-60, 60)), 0.0), Vec(420.0, float(rng.uniform(-60, 60)), 0.0)
        if min(clearance(zones, zones.areas[0], place, True) for place in (start, aim)) < 1.0:
            continue
        length = shortest([list(corners)], (start.x, start.y), (aim.x, aim.y))
        turned += length > distance(start, aim) + 1e-6
        assert flown(zones, start, aim) == pytest.approx(length, rel=1e-5), seed
    assert turned > 20


def test_round_several_zones_the_way_is_seldom_much_longer() -> None:
    """Each zone by its own shorter side is no visibility graph: what that costs is bounded here."""
    costs = []
    for seed, (zones, prisms) in enumerate(fields(40)):
        rng = np.random.default_rng(seed)
        start, aim = Vec(0.0, float(rng.uniform(-60, 60)), 0.0), Vec(850.0, float(rng.uniform(-60, 60)), 0.0)
        near = min(clearance(zones, area, place, True) for area in zones.areas for place in (start, aim))
        apart = all(
            entry(zones_of([a]), zones_of([a]).areas[0], 0.0, Vec(*p, 0.0), Vec(*q, 0.0), True) > 1.0
            for a, b in [*combinations(prisms, 2), *((y, x) for x, y in combinations(prisms, 2))]
            for p, q in zip(b.polygon, [*b.polygon[1:], b.polygon[0]], strict=True)
        )
        if near < 1.0 or not apart:
            continue
        length = shortest([list(one.polygon) for one in prisms], (start.x, start.y), (aim.x, aim.y))
        costs.append(flown(zones, start, aim) / length)
    assert len(costs) > 20
    assert max(costs) < 1.15
    assert np.median(costs) < 1.001
