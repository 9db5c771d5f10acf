"""Polygons as fences are: whether their edges cross, and how much they hold."""

from __future__ import annotations

from math import sqrt

Corner = tuple[float, float]


def area(polygon: tuple[Corner, ...]) -> float:
    """The area inside [m² of metres]; of a crossed polygon parts count against each other."""
    twice = 0.0
    px, py = polygon[-1]
    for qx, qy in polygon:
        twice += px * qy - qx * py
        px, py = qx, qy
    return 0.5 * abs(twice)


def extent(polygon: tuple[Corner, ...]) -> Corner:
    """How far it reaches along each of its two axes."""
    xs = [corner[0] for corner in polygon]
    ys = [corner[1] for corner in polygon]
    return max(xs) - min(xs), max(ys) - min(ys)


def width(polygon: tuple[Corner, ...]) -> float:
    """How far its corners lie off the line from the first one to the one farthest from it."""
    a = polygon[0]
    b, length = a, 0.0
    for c in polygon:
        gap = sqrt((c[0] - a[0]) * (c[0] - a[0]) + (c[1] - a[1]) * (c[1] - a[1]))
        if gap > length:
            b, length = c, gap
    return max(abs(_turn(a, b, c)) for c in polygon) / length if length > 0.0 else 0.0


def without_repeats(polygon: tuple[Corner, ...]) -> tuple[Corner, ...]:
    """The corners with those left out that repeat the one before, the first one again at the end included."""
    kept = [corner for index, corner in enumerate(polygon) if index == 0 or corner != polygon[index - 1]]
    return tuple(kept[:-1] if len(kept) > 1 and kept[0] == kept[-1] else kept)


def crossing(polygon: tuple[Corner, ...]) -> tuple[int, int]:
    """Two edges that cross or touch, by the numbers of the corners where they begin; (−1, −1) for none.

    Edges that follow each other share a corner, and touch otherwise only where the second leads back.
    """
    n = len(polygon)
    for i in range(n):
        a, b = polygon[i], polygon[(i + 1) % n]
        after = polygon[(i + 2) % n]
        if _turn(a, b, after) == 0.0 and _along(a, b, after) < 0.0:
            return i, (i + 1) % n
        for j in range(i + 2, n):
            if (j + 1) % n != i and _meet(a, b, polygon[j], polygon[(j + 1) % n]):
                return i, j
    return -1, -1


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    """Twice the signed area of a triangle: 0 where its corners lie on a line."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _along(a: Corner, b: Corner, c: Corner) -> float:
    """How much of b–c leads on in the direction of a–b."""
    return (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1])


def _within(a: Corner, b: Corner, c: Corner) -> bool:
    """Whether c, on the line through a and b, lies between them."""
    return min(a[0], b[0]) <= c[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= c[1] <= max(a[1], b[1])


def _meet(a: Corner, b: Corner, c: Corner, d: Corner) -> bool:
    """Whether the segments a–b and c–d have a point in common."""
    abc, abd, cda, cdb = _turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b)
    if abc * abd < 0.0 and cda * cdb < 0.0:
        return True
    touching = ((abc, a, b, c), (abd, a, b, d), (cda, c, d, a), (cdb, c, d, b))
    return any(turn == 0.0 and _within(p, q, r) for turn, p, q, r in touching)
