"""Whether this machine reckons as the one did on which was recorded.

The guard compares floats bit by bit. The last bit of a sine or of a matrix product depends on the processor
and on the mathematics library, and a game amplifies it. The probe tells such a machine from a product that
has changed.
"""

from __future__ import annotations

import math
import platform
from hashlib import sha256
from typing import Any

import numpy as np


def probe() -> dict[str, Any]:
    """Versions, and a digest of what functions and products give on this machine."""
    rng = np.random.default_rng(1)
    digest = sha256()
    numbers = rng.uniform(-20.0, 20.0, 4000)
    for function in (math.sin, math.cos, math.tan, math.atan, math.tanh):
        digest.update(np.array([function(x) for x in numbers]).tobytes())
    for function in (math.exp, math.sqrt, math.log):
        digest.update(np.array([function(abs(x) + 1e-3) for x in numbers]).tobytes())
    digest.update(np.array([math.atan2(a, b) for a, b in zip(numbers, numbers[::-1], strict=True)]).tobytes())
    for array in (np.sin(numbers), np.cos(numbers), np.exp(numbers), np.tanh(numbers), np.arctan(numbers)):
        digest.update(array.tobytes())
    for rows, inner in ((6, 6), (12, 20), (64, 30)):
        a, b = rng.standard_normal((rows, inner)), rng.standard_normal((inner, rows))
        digest.update((a @ b).tobytes() + (a[0] @ b).tobytes())
        digest.update((a.astype(np.float32) @ b.astype(np.float32)).tobytes())
    square = rng.standard_normal((9, 9)) + 9.0 * np.eye(9)
    digest.update(np.linalg.inv(square).tobytes() + np.linalg.solve(square, square[0]).tobytes())
    version = ".".join(platform.python_version_tuple()[:2])
    return {"python": version, "numpy": np.__version__, "digest": digest.hexdigest()[:16]}
