"""What an agent's process does without: it stays in memory for a whole flight on a small computer.

`begin` is for a program's first line, `lean` for before anything else of an agent's is imported: what is
freed early is used again by what comes.
"""

from __future__ import annotations

import contextlib
import gc
import sys
from importlib import import_module
from types import ModuleType
from typing import Any, ForwardRef, NoReturn

TRIM_THRESHOLD, ARENA_MAX = -1, -8  # of mallopt(3)


def begin() -> None:
    """Leave out docstrings, and typing's words for older interpreters, which only msgspec would ask for."""
    from onboard.agent.bare_import import import_bare

    import_bare()
    _without("typing_extensions", None, "msgspec")


def lean() -> None:
    """Leave out OpenSSL, and of the MAVLink dialect what no agent reads or writes; share one heap.
    Called again it does nothing."""
    begin()
    _one_heap()
    _without("ssl", None, "asyncio")  # an agent's only TLS is Zenoh's own
    _without("ssl", _NoTls("ssl"), "uvloop")
    _without("_hashlib", None, "hashlib", "hmac")  # the interpreter's own SHA-256 signs frames as well
    from onboard.wire.mavlink.spare import let_go

    let_go()


def settle() -> None:
    """Once everything is imported: our classes and modules lose their docstrings as well, and fields of named
    tuples keep the words of their types, as the source has them, not what typing has compiled of each word:
    who asks for the types gets the same."""
    from onboard.agent.bare_import import is_ours

    for kind in filter(_is_class, gc.get_objects()):
        with contextlib.suppress(AttributeError, TypeError):  # of the interpreter itself
            if is_ours(kind.__module__):
                kind.__doc__ = None
    for name, module in list(sys.modules.items()):
        if is_ours(name):
            module.__doc__ = None
    for kind in tuple.__subclasses__():
        said = vars(kind).get("__annotations__", {})
        said.update({name: one.__forward_arg__ for name, one in said.items() if isinstance(one, ForwardRef)})


def _is_class(one: object) -> bool:
    """Unlike `isinstance`, it asks no object for its own opinion."""
    return issubclass(type(one), type)


def _one_heap() -> None:
    """glibc gives each of Zenoh's threads a heap of its own, and keeps more of what was freed the more was
    allocated at once: an agent's threads allocate too little for that. Other C libraries have no such
    settings."""
    import ctypes

    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(ARENA_MAX, 1)
        mallopt(TRIM_THRESHOLD, 128 * 1024)


def _without(missing: str, instead: ModuleType | None, *modules: str) -> None:
    """Import modules as they are where another is missing (None) or has another in its place; nothing where
    that one is there already, and no further than they can be imported.

    Who needs it imports it later all the same, as who asks why a bus with keys does not open."""
    if missing in sys.modules or any(name in sys.modules for name in modules):
        return
    sys.modules[missing] = instead  # type: ignore[assignment]
    try:
        for name in modules:
            import_module(name)
    except ImportError:
        pass  # uvloop is an extra, and may not fit this interpreter: who needs it tries again, and tells
    finally:
        del sys.modules[missing]


class _NoTls(ModuleType):
    """Names of `ssl` for who takes hold of them when it is imported: uvloop, which uses them only where it is
    given a context of TLS."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name.startswith("SSL_ERROR_"):
            return -1
        return type(name, (OSError,) if name.endswith("Error") else (), {"__init__": _no_tls})


def _no_tls(*_: object, **__: object) -> NoReturn:
    raise RuntimeError("found TLS on an agent's event loop, expected none: its process is without OpenSSL")
