"""Compiled kernels kept on disk: what was compiled once starts within a second.

Numba's own cache does not notice a change in a called function. Here a kernel's file is named by a hash of
everything that it contains (`fingerprint`), of how it is compiled, of the types it is compiled for, and of
Python, numba, llvmlite, NumPy and the processor. So a file never goes stale; one that has not been used for
long goes when room is needed. Files are written whole or not at all, and of two processes that need the same
kernel at once the second waits for the first. To load one, numba's implementations of functions (and SciPy
behind some of them) are not imported, unless the kernel calls into one of them.

Where the folder (`kernel_folder`) cannot be written every start compiles anew.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import inspect
import logging
import os
import pickle
import platform
import sys
from collections.abc import Callable
from functools import cache
from importlib import metadata
from pathlib import Path
from time import sleep
from types import FunctionType
from typing import IO, Any, Literal

import numba
from llvmlite import binding
from numba.core import compiler, serialize
from numba.core.caching import NullCache
from numba.core.runtime.nrt import rtsys

from sim_bridge.campaign.as_one import as_one
from sim_bridge.campaign.fingerprint import UnknownContentError, fingerprint
from sim_bridge.campaign.kernel_folder import folder

ROOM = 500_000_000  # bytes that the files may take together
PATIENCE = 300.0  # [s] at most to wait for a kernel that another process compiles
LOOK = 0.05  # [s] between two looks whether it is done
# How functions are registered and compiled is part of every kernel.
MAKERS = (
    "sim_bridge.campaign.as_one",
    "sim_bridge.campaign.compiled",
    "sim_bridge.campaign.each_compiled",
    "sim_bridge.campaign.fingerprint",
    "sim_bridge.campaign.reached",
    __name__,
)

_dumps: Callable[[Any], bytes] = serialize.dumps
_rebuilt: Callable[..., Any] = compiler.CompileResult._rebuild

ErrorModel = Literal["python", "numpy"]
log = logging.getLogger(__name__)


def kernel(
    function: Callable[..., Any], counted: bool = True, error_model: ErrorModel = "python"
) -> Callable[..., Any]:
    """A function in kernel style compiled at its first call, or taken from disk; holds no interpreter lock.

    What it calls must be registered (`sim_bridge.campaign.compiled.register`). With `counted` False it counts
    no references to arrays and may make neither arrays nor lists: worth it where it handles many arrays. By
    the error model `python` a division by zero raises ZeroDivisionError; by that of `numpy` it is inf or
    NaN, and loops can become vector instructions.
    """
    options: Any = {"nogil": True, "error_model": error_model}
    if not counted:
        options["_nrt"] = False
    machine: Any = numba.njit(**options)(function)
    if isinstance(function, FunctionType) and hasattr(machine, "_cache"):  # not with NUMBA_DISABLE_JIT
        as_one(machine)
        machine._cache = KernelCache(function, repr(options))
    found: Callable[..., Any] = machine
    return found


def kept(machine: Any, *arguments: Any) -> bool:
    """Whether a kernel for arguments of these types is in memory or on disk: a call will not compile."""
    cached = getattr(machine, "_cache", None)
    if not isinstance(cached, KernelCache):
        return False
    kinds = tuple(machine.typeof_pyval(argument) for argument in arguments)
    if kinds in machine.overloads:
        return True
    path = cached._path(kinds, machine.targetctx.codegen())
    return path is not None and path.exists()


class KernelCache(NullCache):
    """What numba asks before it compiles a function, and tells afterwards."""

    def __init__(self, function: FunctionType, options: str) -> None:
        """`function` as written, not compiled; `options` in words, by which it is compiled."""
        self._function = function
        self._options = options
        self._lock: IO[bytes] | None = None
        self._named: str | None = None

    @property
    def cache_path(self) -> str:
        """The folder of the files, as numba's statistics show it."""
        return str(folder() or "")

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The function compiled for a signature; None where it has to be compiled."""
        self._unlock()
        path = self._path(sig, target_context.codegen())
        if path is None:
            return None
        found = self._read(path, sig, target_context)
        if found is None and self._wait(path):
            found = self._read(path, sig, target_context)
        if found is not None:
            self._unlock()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature."""
        try:
            path = self._path(sig, data.library.codegen)
            lasting = not data.lifted and not data.library.has_dynamic_globals
            if path is not None and lasting:
                _write(path, _dumps((sig, _called(data.library), data._reduce())))
                _make_room(path)
        except OSError as error:
            _tell(f"{folder()}: {(error.strerror or str(error)).lower()}")
        except (pickle.PicklingError, TypeError, AttributeError, NotImplementedError) as error:
            log.debug("%s is not kept: %s", self._function.__qualname__, error)
        finally:
            self._unlock()

    def _path(self, sig: Any, codegen: Any) -> Path | None:
        """The file of a signature; None where none can be."""
        home = folder()
        if home is None:
            return None
        try:
            if self._named is None:
                self._named = fingerprint(self._function)
        except UnknownContentError as error:
            log.debug("%s is not kept: it contains %s", self._function.__qualname__, error)
            return None
        parts = (self._named, self._options, _surroundings(), repr(codegen.magic_tuple()), str(sig))
        name = hashlib.sha256("\0".join(parts).encode()).hexdigest()
        return home / f"{self._function.__name__}-{name[:40]}.kernel"

    def _read(self, path: Path, sig: Any, target_context: Any) -> Any:
        try:
            data = path.read_bytes()
            if hashlib.sha256(data[32:]).digest() != data[:32]:
                return None
            made_for, called, reduced = pickle.loads(memoryview(data)[32:])
            if made_for != sig:  # another type of the same name
                return None
            os.utime(path)
            rtsys.initialize(target_context)
            if any(binding.address_of_symbol(name) is None for name in called):
                target_context.refresh()
            return _rebuilt(target_context, *reduced)
        except (OSError, ImportError, AttributeError, pickle.UnpicklingError):
            return None

    def _wait(self, path: Path) -> bool:
        """Whether another process was compiling this kernel and is done; else it is ours to compile."""
        try:
            path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._lock = path.with_suffix(".lock").open("wb")
        except OSError:
            return False
        if _locked(self._lock):
            return path.exists()  # made between a look and the lock
        for _ in range(round(PATIENCE / LOOK)):
            if _locked(self._lock):
                return True
            sleep(LOOK)
        return False

    def _unlock(self) -> None:
        if self._lock is not None:
            with contextlib.suppress(OSError):
                os.unlink(self._lock.name)
            self._lock.close()
            self._lock = None


def _called(library: Any) -> tuple[str, ...]:
    """What compiled code takes from elsewhere, by name: of C, of Python, and of numba's implementations."""
    module = library._final_module
    parts = (*module.functions, *module.global_variables)
    return tuple(part.name for part in parts if part.is_declaration and not part.name.startswith("llvm."))


def _locked(file: IO[bytes]) -> bool:
    """Whether the lock is ours now; where there are no locks, always."""
    try:
        import fcntl
    except ImportError:
        return True
    try:
        fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _write(path: Path, data: bytes) -> None:
    part = path.with_suffix(f".{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part.write_bytes(hashlib.sha256(data).digest() + data)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def _make_room(newest: Path) -> None:
    """Remove the files that were not used for the longest time, but never the newest."""
    found = []
    for path in newest.parent.glob("*.kernel"):
        try:
            status = path.stat()
        except OSError:
            continue  # another process removed it
        found.append((path != newest, -status.st_mtime, status.st_size, path))
    taken = 0
    for old, _age, size, path in sorted(found):
        taken += size
        if old and taken > ROOM:
            path.unlink(missing_ok=True)


@cache
def _tell(why: str) -> None:
    log.warning("kernels are compiled anew at every start: %s", why)


@cache
def _surroundings() -> str:
    """Everything but the kernel itself that decides what is compiled."""
    settings = [f"{k}={v}" for k, v in sorted(os.environ.items()) if k.startswith("NUMBA_")]
    makers = [inspect.getsource(importlib.import_module(name)) for name in MAKERS]
    libraries = [metadata.version(name) for name in ("numba", "llvmlite", "numpy")]
    versions = (sys.version, platform.machine(), *libraries)
    return "\0".join((*versions, *settings, *makers))
