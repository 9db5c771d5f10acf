"""What an agent's process does without: it stays in memory for a whole flight on a small computer.

To be called before anything else of an agent's is imported: what is freed early is used again by what comes.
"""

from __future__ import annotations

import ctypes
import sys
from importlib import import_module

TRIM_THRESHOLD, ARENA_MAX = -1, -8  # of mallopt(3)


def lean() -> None:
    """Leave out OpenSSL, and of the MAVLink dialect what no agent reads or writes; share one heap."""
    _one_heap()
    _without("ssl", "asyncio")  # an agent's only TLS is Zenoh's own
    _without("_hashlib", "hashlib", "hmac")  # the interpreter's own SHA-256 signs frames as well
    from onboard.wire.mavlink.spare import let_go

    let_go()


def _one_heap() -> None:
    """glibc gives each of Zenoh's threads a heap of its own, and keeps more of what was freed the more was
    allocated at once: an agent's threads allocate too little for that. Other C libraries have no such
    settings."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(ARENA_MAX, 1)
        mallopt(TRIM_THRESHOLD, 128 * 1024)


def _without(missing: str, *modules: str) -> None:
    """Import modules as they are where another is missing; nothing where that one is there already.

    Who needs it imports it later all the same: uvloop, and who asks why a bus with keys does not open."""
    if missing in sys.modules or any(name in sys.modules for name in modules):
        return
    sys.modules[missing] = None  # type: ignore[assignment]
    try:
        for name in modules:
            import_module(name)
    finally:
        del sys.modules[missing]
