"""Numbers that every room shares. The Earth's ellipsoid is in `onboard.wire.geodesy`."""

from __future__ import annotations

from math import inf

NS_PER_S = 1_000_000_000  # nanoseconds in a second
STANDARD_GRAVITY = 9.80665  # g_n [m/s²], the conventional value of the 3rd CGPM (1901)
NEVER = -inf  # the instant [s] of what has not happened: the time since then is infinite
