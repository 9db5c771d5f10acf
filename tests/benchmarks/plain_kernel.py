"""A plain hand-written numba kernel of the spatial game: arrays, no NamedTuples, nothing shared.

The measure for the compiled core: the same mathematics (free ray exact with pairwise edge
intersections, resultant force, the pursuers' three rules, the referee over the whole step),
written as one would by hand for one purpose.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numba
import numpy as np


@numba.njit
def _free(x: float, y: float, z: float, ax: Any, cosines: Any, sines: Any, n: int) -> bool:
    for k in range(n):  # noqa: SIM110
        if x * ax[k, 0] + y * ax[k, 1] + z * ax[k, 2] > cosines[k] + 1e-9 * sines[k]:
            return False
    return True


@numba.njit
def play(
    e: Any, v_e: float, p: Any, v_p: Any, target: Any, R: float, rho: float, lam: float, beta: float,
    epsilon: float, dt: float, horizon: float,
) -> Any:  # fmt: skip
    """Play one game in place; returns (steps, verdict, time, smallest distance)."""
    n = p.shape[0]
    ax = np.empty((n, 3))
    cosines = np.empty(n)
    sines = np.empty(n)
    new = np.empty((n, 3))
    t = 0.0
    smallest = 1e300
    steps = 0
    while True:
        gx, gy, gz = target[0] - e[0], target[1] - e[1], target[2] - e[2]
        far = sqrt(gx * gx + gy * gy + gz * gz)
        fx, fy, fz = gx / far, gy / far, gz / far
        closed = False
        for k in range(n):
            x, y, z = p[k, 0] - e[0], p[k, 1] - e[1], p[k, 2] - e[2]
            d = sqrt(x * x + y * y + z * z)
            ax[k, 0], ax[k, 1], ax[k, 2] = x / d, y / d, z / d
            sa = v_p[k] / v_e
            if sa >= 1.0:
                closed = True
                continue
            ca = sqrt(max(0.0, 1.0 - sa * sa))
            sb = min(1.0, rho / d)
            cb = sqrt(max(0.0, 1.0 - sb * sb))
            cosines[k] = ca * cb - sa * sb
            sines[k] = sa * cb + ca * sb
        ux, uy, uz = fx, fy, fz
        if closed or not _free(fx, fy, fz, ax, cosines, sines, n):
            best = -2.0
            if not closed:
                for i in range(n):
                    pa = fx * ax[i, 0] + fy * ax[i, 1] + fz * ax[i, 2]
                    x, y, z = fx - pa * ax[i, 0], fy - pa * ax[i, 1], fz - pa * ax[i, 2]
                    m = max(sqrt(x * x + y * y + z * z), 1e-12)
                    near = pa * cosines[i] + m * sines[i]
                    if near > best:
                        s = sines[i] / m
                        x, y, z = (
                            ax[i, 0] * cosines[i] + x * s,
                            ax[i, 1] * cosines[i] + y * s,
                            ax[i, 2] * cosines[i] + z * s,
                        )
                        if _free(x, y, z, ax, cosines, sines, n):
                            best, ux, uy, uz = near, x, y, z
                    if near <= best:
                        continue
                    for j in range(i):
                        c = ax[i, 0] * ax[j, 0] + ax[i, 1] * ax[j, 1] + ax[i, 2] * ax[j, 2]
                        q = 1.0 - c * c
                        if q <= 1e-12:
                            continue
                        a = (cosines[i] - cosines[j] * c) / q
                        b = (cosines[j] - cosines[i] * c) / q
                        square = 1.0 - a * a - b * b - 2.0 * a * b * c
                        if square < 0.0:
                            continue
                        r = sqrt(square / q)
                        cx = ax[i, 1] * ax[j, 2] - ax[i, 2] * ax[j, 1]
                        cy = ax[i, 2] * ax[j, 0] - ax[i, 0] * ax[j, 2]
                        cz = ax[i, 0] * ax[j, 1] - ax[i, 1] * ax[j, 0]
                        pb = fx * ax[j, 0] + fy * ax[j, 1] + fz * ax[j, 2]
                        level = a * pa + b * pb
                        rise = r * (fx * cx + fy * cy + fz * cz)
                        if level + abs(rise) <= best:
                            continue
                        bx = ax[i, 0] * a + ax[j, 0] * b
                        by = ax[i, 1] * a + ax[j, 1] * b
                        bz = ax[i, 2] * a + ax[j, 2] * b
                        w = r if rise >= 0.0 else -r
                        if _free(bx + cx * w, by + cy * w, bz + cz * w, ax, cosines, sines, n):
                            best = level + abs(rise)
                            ux, uy, uz = bx + cx * w, by + cy * w, bz + cz * w
                        elif level - abs(rise) > best and _free(
                            bx - cx * w, by - cy * w, bz - cz * w, ax, cosines, sines, n
                        ):
                            best = level - abs(rise)
                            ux, uy, uz = bx - cx * w, by - cy * w, bz - cz * w
            if best < -1.5:
                w = (beta + 1.0 / far) / far
                ux, uy, uz = w * gx, w * gy, w * gz
                for k in range(n):
                    x, y, z = e[0] - p[k, 0], e[1] - p[k, 1], e[2] - p[k, 2]
                    d = sqrt(x * x + y * y + z * z)
                    w = lam / max(d - 2.0 * R, 1e-3) / d
                    ux += w * x
                    uy += w * y
                    uz += w * z
                m = sqrt(ux * ux + uy * uy + uz * uz)
                ux, uy, uz = ux / m, uy / m, uz / m
        ex, ey, ez = e[0] + ux * v_e * dt, e[1] + uy * v_e * dt, e[2] + uz * v_e * dt
        capture = 2.0
        for k in range(n):
            x, y, z = p[k, 0] - e[0], p[k, 1] - e[1], p[k, 2] - e[2]
            dd = x * x + y * y + z * z
            s = x * ux + y * uy + z * uz
            hx, hy, hz = ux, uy, uz
            if s > 0.0:
                a = v_e * v_e - v_p[k] * v_p[k]
                inside = v_e * s * v_e * s - a * dd
                if inside >= 0.0:
                    T = dd / (v_e * s + sqrt(inside))
                else:
                    gamma = v_p[k] / v_e
                    cx, cy, cz = uy * z - uz * y, uz * x - ux * z, ux * y - uy * x
                    h = sqrt(cx * cx + cy * cy + cz * cz)
                    T = (s + h * gamma / sqrt(1.0 - gamma * gamma)) / v_e
                hx, hy, hz = ux * v_e * T - x, uy * v_e * T - y, uz * v_e * T - z
                m = sqrt(hx * hx + hy * hy + hz * hz)
                hx, hy, hz = hx / m, hy / m, hz / m
            new[k, 0] = p[k, 0] + hx * v_p[k] * dt
            new[k, 1] = p[k, 1] + hy * v_p[k] * dt
            new[k, 2] = p[k, 2] + hz * v_p[k] * dt
            rx, ry, rz = new[k, 0] - ex - x, new[k, 1] - ey - y, new[k, 2] - ez - z
            aa = rx * rx + ry * ry + rz * rz
            bb = x * rx + y * ry + z * rz
            when = min(1.0, max(0.0, -bb / max(aa, 1e-300)))
            d = sqrt(max(0.0, dd + when * (2.0 * bb + when * aa)))
            smallest = min(smallest, d)
            if d <= R:
                entry = 0.0
                if dd > R * R:
                    entry = (-bb - sqrt(max(0.0, bb * bb - aa * (dd - R * R)))) / aa
                capture = min(capture, entry)
        steps += 1
        rx, ry, rz = ex - e[0], ey - e[1], ez - e[2]
        aa = rx * rx + ry * ry + rz * rz
        bb = -(gx * rx + gy * ry + gz * rz)
        when = min(1.0, max(0.0, -bb / max(aa, 1e-300)))
        arrival = 2.0
        if sqrt(max(0.0, far * far + when * (2.0 * bb + when * aa))) <= epsilon:
            arrival = (-bb - sqrt(max(0.0, bb * bb - aa * (far * far - epsilon * epsilon)))) / aa
        e[0], e[1], e[2] = ex, ey, ez
        for k in range(n):
            p[k, 0], p[k, 1], p[k, 2] = new[k, 0], new[k, 1], new[k, 2]
        if capture <= 1.0 and capture <= arrival:
            return steps, 1, t + capture * dt, smallest
        if arrival <= 1.0:
            return steps, 2, t + arrival * dt, smallest
        if horizon - t <= dt * (1.0 + 1e-9):
            return steps, 3, horizon, smallest
        t += dt
