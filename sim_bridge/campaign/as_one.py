"""A kernel compiled as one: what it calls becomes machine code within the kernel alone.

Numba compiles each function that another calls as if Python would call it, too: it optimises it with all
that it calls in turn, makes machine code of it, and then inlines it once more. A kernel of many functions
spends half its compile time so, for code that nobody runs. Here the functions of a kernel are linked as
they are, and the whole is optimised once. What is computed is the same to the last bit.

This reaches into numba. Where its release is not the one that this was written for (`RELEASE`), a kernel is
compiled as numba does by itself, in twice the time.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from typing import Any

import numba
from numba.core import codegen, cpu

RELEASE = "0.68"  # of numba, that of locks/all.lock
KNOWN = ".".join(numba.__version__.split(".")[:2]) == RELEASE

_Library: Any = codegen.JITCodeLibrary
_Context: Any = cpu.CPUContext
_make_function: Any = vars(cpu)["_dynfunc"].make_function if KNOWN else None

# Where the address of a function that nobody calls is wanted: called all the same, it raises MemoryError.
_NOBODY = ctypes.cast(ctypes.pythonapi.PyErr_NoMemory, ctypes.c_void_p).value


class _Compiling(threading.local):
    """What this thread compiles as one."""

    def __init__(self) -> None:
        self.kernel: Callable[..., Any] | None = None
        self.library: Any = None  # of the kernel itself, once it is lowered


_compiling = _Compiling()
_finalize: Callable[[Any], None] = _Library.finalize
_get_executable: Callable[..., Any] = _Context.get_executable


def as_one(machine: Any) -> None:
    """Have a dispatcher of numba's compile its function so; as numba does where its release is not known."""
    if not KNOWN:
        return
    compiler = machine._compiler
    compile_it, function = compiler.compile, machine.py_func

    def compile_as_one(arguments: Any, result: Any) -> Any:
        before = _compiling.kernel, _compiling.library
        _compiling.kernel, _compiling.library = function, None
        try:
            return compile_it(arguments, result)
        finally:
            _compiling.kernel, _compiling.library = before

    compiler.compile = compile_as_one


def _finalized(library: Any) -> None:
    """Link what a library calls; optimise it and make machine code of it only where it is run."""
    if _compiling.kernel is None or library is _compiling.library:
        _finalize(library)
        return
    library._raise_if_finalized()
    for part in dict.fromkeys(library._linking_libraries):
        library._reload_init.update(part._reload_init)
        library._final_module.link_in(part._get_module_for_linking(), preserve=True)
    library._final_module.verify()
    library._finalize_dynamic_globals()
    library._finalized = True


def _executable(context: Any, library: Any, described: Any, environment: Any) -> Any:
    """What Python calls of a compiled function: of one that is part of a kernel, nothing that works."""
    kernel = _compiling.kernel
    if kernel is not None:
        if (described.modname, described.qualname) != (kernel.__module__, kernel.__qualname__):
            name = described.qualname.split(".")[-1]
            module = described.lookup_module()
            return _make_function(module, name, "part of a kernel", _NOBODY, environment, (library,))
        _compiling.library = library
    return _get_executable(context, library, described, environment)


if KNOWN:
    _Library.finalize = _finalized
    _Context.get_executable = _executable
