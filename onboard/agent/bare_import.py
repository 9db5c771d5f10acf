"""Modules without the docstrings of their functions: two megabytes that nobody reads in flight.

As `python -OO` does, which has to be typed, drops assertions too and compiles every module anew where an
installation has none compiled for it. Packages that an agent itself does not bring are imported whole:
a strategy of somebody else's may read its own words.
"""

from __future__ import annotations

import sys
from importlib.machinery import (
    BYTECODE_SUFFIXES,
    EXTENSION_SUFFIXES,
    SOURCE_SUFFIXES,
    ExtensionFileLoader,
    FileFinder,
    SourceFileLoader,
    SourcelessFileLoader,
)
from opcode import opmap
from types import CodeType

OURS = frozenset({"onboard", "numpy", "pymavlink", "msgspec", "zenoh", "uvloop", "serial", "fastcrc"})
# Modules that hold nothing but the docstrings of compiled code.
WORDS = frozenset({"numpy._core._add_newdocs", "numpy._core._add_newdocs_scalars"})
_FUNCTION = 0x1  # of a code's flags: CO_OPTIMIZED
_HAS_DOCSTRING = 0x4000000  # of Python 3.14: CO_HAS_DOCSTRING
_READ = tuple(bytes((opmap[name], 0)) for name in ("LOAD_CONST", "RETURN_CONST") if name in opmap)


class BareLoader(SourceFileLoader):
    """Loads a module from its source or what is compiled of it, as ever, without docstrings of functions."""

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the module's code."""
        if fullname in WORDS:
            return compile("", self.path, "exec")
        code = super().get_code(fullname)
        return bare(code) if code is not None and is_ours(fullname) else code


def is_ours(module: str) -> bool:
    """Whether a module is of a package that an agent itself brings, or of Python's library."""
    top = module.partition(".")[0]
    return top in OURS or top in sys.stdlib_module_names


def import_bare() -> None:
    """From now on, for the rest of this process."""
    if any(getattr(hook, "bare", False) for hook in sys.path_hooks):
        return
    hook = FileFinder.path_hook(
        (ExtensionFileLoader, EXTENSION_SUFFIXES),
        (BareLoader, SOURCE_SUFFIXES),
        (SourcelessFileLoader, BYTECODE_SUFFIXES),
    )
    hook.bare = True  # type: ignore[attr-defined]
    sys.path_hooks.insert(0, hook)
    sys.path_importer_cache.clear()


def bare(code: CodeType) -> CodeType:
    """The same code, the docstrings of its functions gone; what a function computes does not change."""
    constants = tuple(bare(one) if isinstance(one, CodeType) else one for one in code.co_consts)
    if _documented(code):
        constants = (None, *constants[1:])
    elif all(new is old for new, old in zip(constants, code.co_consts, strict=True)):
        return code
    return code.replace(co_consts=constants)


def _documented(code: CodeType) -> bool:
    """Whether the first constant is a docstring and nothing but that."""
    if not (code.co_consts and isinstance(code.co_consts[0], str) and code.co_flags & _FUNCTION):
        return False
    if sys.version_info >= (3, 14):
        told = bool(code.co_flags & _HAS_DOCSTRING)
    else:  # a function without one has None there; what stands in a comprehension is used
        told = not code.co_name.startswith("<")
    return told and not any(pair in code.co_code for pair in _READ)
