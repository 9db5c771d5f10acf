"""A plain hand-written numba kernel of the spatial game's aircraft: arrays, no NamedTuples, nothing shared.

The measure for the compiled campaign: the same equations of six aircraft of the `nose` model (pitch and yaw
axes with their loops and servos, speed, gust drift), Dryden gusts every second sample, wind shear, and a
20 Hz decision of the same kind (cones with the free ray, intercept or closest approach), written as one
would by hand for one purpose. Parameters arrive as flat arrays (see `test_flight.py`).
"""

from __future__ import annotations

from math import asin, atan2, cos, exp, floor, log, pi, sin, sqrt
from typing import Any

import numba
import numpy as np


@numba.njit
def _clip(x: float, low: float, high: float) -> float:
    return low if x < low else (high if x > high else x)


@numba.njit
def _free(x: float, y: float, z: float, ax: Any, cosines: Any, sines: Any, n: int) -> bool:
    for k in range(n):  # noqa: SIM110
        if x * ax[k, 0] + y * ax[k, 1] + z * ax[k, 2] > cosines[k] + 1e-9 * sines[k]:
            return False
    return True


@numba.njit
def play(
    state: Any, pitch: Any, yaw: Any, pitch_law: Any, yaw_law: Any, speeds: Any, declared: Any, wind: Any,
    sigma: float, gusts: Any, tracks: Any, noise: Any, target: Any, rho: float, steps: int,
    pitch_limit: float,
) -> Any:  # fmt: skip
    """Fly `steps` decisions of five samples each; `state` (players, 29) is changed in place.

    Columns: 0–2 position, 3–5 velocity, 6 speed, 7 thrust, 8 its integral, 9–14 pitch axis (x1, x2, angle,
    rate, surface, integral), 15–20 yaw axis, 21–23 drift, 24–28 gust filters.
    """
    players = state.shape[0]
    n = players - 1
    dt = 0.01
    ax = np.empty((n, 3))
    cosines = np.empty(n)
    sines = np.empty(n)
    course = np.empty(players)
    climb = np.empty(players)
    axis = np.empty(6)
    tick = 0
    sample = 0
    smallest = 1e300
    for step in range(steps):
        # decisions
        sx = state[0, 0]
        sy = state[0, 1]
        sz = state[0, 2]
        gx, gy, gz = target[0] - sx, target[1] - sy, target[2] - sz
        far = sqrt(gx * gx + gy * gy + gz * gz)
        fx, fy, fz = gx / far, gy / far, gz / far
        for k in range(n):
            x = state[k + 1, 0] + noise[0] * tracks[step, k + 1, 0] - sx
            y = state[k + 1, 1] + noise[0] * tracks[step, k + 1, 1] - sy
            z = state[k + 1, 2] + noise[0] * tracks[step, k + 1, 2] - sz
            d = sqrt(x * x + y * y + z * z)
            smallest = min(smallest, d)
            ax[k, 0], ax[k, 1], ax[k, 2] = x / d, y / d, z / d
            sa = declared[k + 1] / declared[0]
            ca = sqrt(max(0.0, 1.0 - sa * sa))
            sb = min(1.0, rho / d)
            cb = sqrt(max(0.0, 1.0 - sb * sb))
            cosines[k] = ca * cb - sa * sb
            sines[k] = sa * cb + ca * sb
        ux, uy, uz = fx, fy, fz
        if not _free(fx, fy, fz, ax, cosines, sines, n):
            best = -2.0
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
                    for w in (r, -r):
                        x = ax[i, 0] * a + ax[j, 0] * b + cx * w
                        y = ax[i, 1] * a + ax[j, 1] * b + cy * w
                        z = ax[i, 2] * a + ax[j, 2] * b + cz * w
                        near = fx * x + fy * y + fz * z
                        if near > best and _free(x, y, z, ax, cosines, sines, n):
                            best, ux, uy, uz = near, x, y, z
        course[0] = atan2(uy, ux)
        climb[0] = _clip(asin(_clip(-uz, -1.0, 1.0)), -pitch_limit, pitch_limit)
        ex = sx + noise[0] * tracks[step, 0, 0]
        ey = sy + noise[0] * tracks[step, 0, 1]
        ez = sz + noise[0] * tracks[step, 0, 2]
        hx = state[0, 3] + noise[1] * tracks[step, 0, 3] - wind[0]
        hy = state[0, 4] + noise[1] * tracks[step, 0, 4] - wind[1]
        hz = state[0, 5] + noise[1] * tracks[step, 0, 5] - wind[2]
        m = sqrt(hx * hx + hy * hy + hz * hz)
        hx, hy, hz = hx / m, hy / m, hz / m
        v_e = declared[0]
        for k in range(1, players):
            x, y, z = state[k, 0] - ex, state[k, 1] - ey, state[k, 2] - ez
            dd = x * x + y * y + z * z
            s = x * hx + y * hy + z * hz
            px, py, pz = hx, hy, hz
            if s > 0.0:
                v_p = declared[k]
                a = v_e * v_e - v_p * v_p
                inside = v_e * s * v_e * s - a * dd
                if inside >= 0.0:
                    T = dd / (v_e * s + sqrt(inside))
                else:
                    gamma = v_p / v_e
                    cx, cy, cz = hy * z - hz * y, hz * x - hx * z, hx * y - hy * x
                    h = sqrt(cx * cx + cy * cy + cz * cz)
                    T = (s + h * gamma / sqrt(1.0 - gamma * gamma)) / v_e
                px, py, pz = hx * v_e * T - x, hy * v_e * T - y, hz * v_e * T - z
                m = sqrt(px * px + py * py + pz * pz)
                px, py, pz = px / m, py / m, pz / m
            course[k] = atan2(py, px)
            climb[k] = _clip(asin(_clip(-pz, -1.0, 1.0)), -pitch_limit, pitch_limit)
        # five samples of every aircraft
        for _ in range(5):
            fresh = sample % 2 == 0 and sample > 0
            if fresh:
                tick += 1
            for k in range(players):
                row = state[k]
                height = -row[2]
                if fresh:
                    h = max(height / 0.3048, 10.0)
                    if h >= 2000.0:
                        lu = lw = 1750.0 * 0.3048
                    elif h > 1000.0:
                        lu = lw = (1000.0 + 0.75 * (h - 1000.0)) * 0.3048
                    else:
                        lu = h / (0.177 + 0.000823 * h) ** 1.2 * 0.3048
                        lw = h * 0.3048
                    v = max(row[6], 1.0)
                    e = exp(-v * 0.02 / lu)
                    row[24] = e * row[24] + sqrt(max(0.0, 1.0 - e * e)) * gusts[tick, k, 0]
                    for pair in range(2):
                        r = v * 0.02 / (lu if pair == 0 else lw)
                        e = exp(-r)
                        e2 = e * e
                        q11 = 0.5 * (1.0 - e2)
                        q12 = 0.25 - e2 * (0.5 * r + 0.25)
                        q22 = 0.25 - e2 * (0.5 * r * r + 0.5 * r + 0.25)
                        if r < 0.02:
                            q12 = r * r * (0.5 - 2.0 * r / 3.0)
                            q22 = r * r * r * (1.0 / 3.0 - 0.5 * r)
                        l11 = sqrt(q11)
                        l21 = q12 / l11
                        l22 = sqrt(max(0.0, q22 - l21 * l21))
                        at = 25 + 2 * pair
                        first = row[at]
                        row[at] = e * first + l11 * gusts[tick, k, 1 + 2 * pair]
                        row[at + 1] = (
                            e * (row[at + 1] + r * first)
                            + l21 * gusts[tick, k, 1 + 2 * pair]
                            + l22 * gusts[tick, k, 2 + 2 * pair]
                        )
                gust_u = sigma * row[24]
                gust_v = sigma * (sqrt(3.0) * row[25] + (1.0 - sqrt(3.0)) * row[26])
                gust_w = sigma * (sqrt(3.0) * row[27] + (1.0 - sqrt(3.0)) * row[28])
                share = _clip((height - 304.8) / 304.8, 0.0, 1.0)
                c, s = cos(row[17]), sin(row[17])
                nose, level = sin(row[11]), cos(row[11])
                forward = gust_u * level + gust_w * nose
                g_n = (1.0 - share) * (gust_u * wind[3] - gust_v * wind[4]) + share * (
                    forward * c - gust_v * s
                )
                g_e = (1.0 - share) * (gust_u * wind[4] + gust_v * wind[3]) + share * (
                    forward * s + gust_v * c
                )
                gust_w = (1.0 - share) * gust_w + share * (gust_w * level - gust_u * nose)
                shear = log(_clip(height, 0.9144, 304.8) / 0.6096) / log(10.0)
                psi = row[17]
                c, s = cos(psi), sin(psi)
                along, across = g_n * c + g_e * s, g_e * c - g_n * s
                error = course[k] - psi
                error -= 2.0 * pi * floor((error + pi) / (2.0 * pi))
                for which in range(2):
                    at = 9 + 6 * which
                    model = pitch if which == 0 else yaw
                    law = pitch_law if which == 0 else yaw_law
                    miss = climb[k] - row[11] if which == 0 else error
                    w1 = along if which == 0 else across
                    w2 = -gust_w if which == 0 else 0.0
                    for q in range(6):
                        axis[q] = row[at + q]
                    rate = _clip(law[0] * miss, -law[1], law[1])
                    asked = law[2] * (rate - axis[3]) + axis[5]
                    given = _clip(_clip(asked, -law[5], law[5]), axis[4] - law[7], axis[4] + law[7])
                    u = axis[4]
                    row[at] = (
                        model[0] * axis[0] + model[1] * axis[1] + model[4] * u + model[6] * w1 + model[8] * w2
                    )
                    row[at + 1] = (
                        model[2] * axis[0] + model[3] * axis[1] + model[5] * u + model[7] * w1 + model[9] * w2
                    )
                    row[at + 2] = axis[2] + (
                        model[15] * axis[0]
                        + model[16] * axis[1]
                        + model[17] * u
                        + model[18] * w1
                        + model[19] * w2
                    )
                    row[at + 4] = u + law[6] * (given - u)
                    row[at + 3] = (
                        model[10] * row[at]
                        + model[11] * row[at + 1]
                        + model[12] * row[at + 4]
                        + model[13] * w1
                        + model[14] * w2
                    )
                    row[at + 5] = axis[5] + law[3] * (rate - axis[3]) + law[4] * (given - asked)
                    if which == 0:
                        theta0, rate0 = axis[2], axis[3]
                gain, keep, lowest, highest, lag, lead, drag, gravity, trim = speeds
                weight = gravity * sin(theta0)
                short = declared[k] - row[6]
                asked = (
                    gain * short
                    + row[8]
                    + drag * (declared[k] - trim)
                    + weight
                    + lead * gravity * cos(theta0) * rate0
                )
                given = _clip(asked, lowest, highest)
                if given == asked:
                    row[8] += keep * short
                row[7] += lag * (given - row[7])
                row[6] = max(0.0, row[6] + dt * (row[7] - drag * (row[6] - trim) - weight))
                d_n, d_e = row[21], row[22]
                p_a = wind[5] * (along - (d_n * c + d_e * s))
                p_c = wind[6] * (across - (d_e * c - d_n * s))
                row[21] = d_n + p_a * c - p_c * s
                row[22] = d_e + p_a * s + p_c * c
                row[23] += wind[7] * (gust_w - row[23])
                level = row[6] * cos(row[11])
                v_n = level * cos(row[17]) + wind[0] * shear + row[21]
                v_e_ = level * sin(row[17]) + wind[1] * shear + row[22]
                v_d = -row[6] * sin(row[11]) + row[23]
                row[0] += 0.5 * dt * (row[3] + v_n)
                row[1] += 0.5 * dt * (row[4] + v_e_)
                row[2] += 0.5 * dt * (row[5] + v_d)
                row[3], row[4], row[5] = v_n, v_e_, v_d
            sample += 1
    return smallest
