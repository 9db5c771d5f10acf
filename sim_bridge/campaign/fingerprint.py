"""What a kernel contains, as a hash: its own code, that of every function it reaches, every constant in them.

Numba freezes global values into what it compiles, so that a changed constant is a changed kernel as much as a
changed function is. Names of variables, comments, docstrings and line numbers are none of it.
"""

from __future__ import annotations

import hashlib
from enum import Enum
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

LIBRARIES = ("builtins", "cmath", "math", "numba", "numpy", "operator")  # told apart by their versions
PLAIN = (int, float, complex, bool, str, bytes, type(None), type(Ellipsis))
GENERATED = frozenset({"__new__", "_make", "_replace", "__repr__", "_asdict", "__getnewargs__"})


class UnknownContentError(Exception):
    """A kernel reaches a value of which it cannot be told whether it changed."""


def fingerprint(function: FunctionType) -> str:
    """SHA-256 (hexadecimal) of a function and of everything that it reaches.

    Raises UnknownContentError where it reaches a value that is neither a number, text, tuple, array, enum,
    NamedTuple, function nor module.
    """
    walk = _Walk()
    walk.value(function)
    return walk.hash.hexdigest()


class _Walk:
    """One hash over everything that is reached, each function and class once."""

    def __init__(self) -> None:
        self.hash = hashlib.sha256()
        self._known: dict[int, int] = {}
        self._kept: list[object] = []  # so that no identity is given twice

    def word(self, *words: object) -> None:
        """Add words, told apart."""
        for word in words:
            text = word if isinstance(word, bytes) else str(word).encode()
            self.hash.update(b"%d:" % len(text))
            self.hash.update(text)

    def value(self, value: Any) -> None:
        """Add a value that a kernel uses."""
        value = getattr(value, "py_func", value)  # of what numba itself has compiled
        if isinstance(value, Enum):
            self.word("member", type(value).__qualname__, value.name)
            self.value(value.value)
        elif isinstance(value, PLAIN):
            self.word(type(value).__name__, repr(value))
        elif isinstance(value, (tuple, frozenset)):
            items = sorted(value, key=repr) if isinstance(value, frozenset) else value
            self.word(type(value).__qualname__, len(value))
            for item in items:
                self.value(item)
        elif isinstance(value, (np.ndarray, np.generic)):
            array = np.asarray(value)
            self.word("array", array.dtype.str, array.shape, array.tobytes())
        elif isinstance(value, BuiltinFunctionType | ModuleType | np.ufunc):
            self.word("named", getattr(value, "__module__", ""), value.__name__)
        elif isinstance(value, FunctionType | type):
            self._once(value)
        elif _of_library(value):
            self.word("library", getattr(value, "__module__", ""), getattr(value, "__qualname__", ""))
        else:
            raise UnknownContentError(f"a value of {type(value)}")

    def _once(self, value: FunctionType | type) -> None:
        number = self._known.get(id(value))
        if number is not None:
            self.word("again", number)
            return
        self._known[id(value)] = len(self._known)
        self._kept.append(value)
        if _of_library(value):
            self.word("library", value.__module__, value.__qualname__)
        elif isinstance(value, FunctionType):
            self._function(value)
        else:
            self._class(value)

    def _function(self, function: FunctionType) -> None:
        self.word("function", function.__qualname__)
        self.value(function.__defaults__ or ())
        for name, default in sorted((function.__kwdefaults__ or {}).items()):
            self.word(name)
            self.value(default)
        self._code(function.__code__, function.__doc__, function.__globals__)
        for cell in function.__closure__ or ():
            self.value(cell.cell_contents)

    def _code(self, code: CodeType, doc: str | None, names: dict[str, Any]) -> None:
        self.word("code", code.co_code, code.co_argcount, code.co_kwonlyargcount, code.co_flags)
        constants = code.co_consts
        for constant in constants[1:] if constants and constants[0] == doc else constants:
            if isinstance(constant, CodeType):
                self._code(constant, None, names)
            else:
                self.value(constant)
        for name in code.co_names:
            self.word("name", name)
            if name not in names:
                continue  # of a field, or of Python itself
            self.value(names[name])
            if isinstance(names[name], ModuleType) and not _of_library(names[name]):
                self._module(names[name], code.co_names)

    def _module(self, module: ModuleType, names: tuple[str, ...]) -> None:
        """What a function may use of a module that it has by its name."""
        for name in names:
            if hasattr(module, name):
                self.word("of module", module.__name__, name)
                self.value(getattr(module, name))

    def _class(self, kind: type) -> None:
        self.word("class", kind.__qualname__)
        if issubclass(kind, Enum):
            for member in kind:
                self.word(member.name)
                self.value(member.value)
            return
        if not issubclass(kind, tuple) and kind is not object:
            raise UnknownContentError(f"{kind}")
        self.word(*getattr(kind, "_fields", ()))
        for name, default in sorted(getattr(kind, "_field_defaults", {}).items()):
            self.word(name)
            self.value(default)
        for name, method in sorted(vars(kind).items()):
            found = getattr(method, "fget", None) or getattr(method, "__func__", method)
            if isinstance(found, FunctionType) and name not in GENERATED:
                self.word(name)
                self.value(found)


def _of_library(value: object) -> bool:
    home = value.__name__ if isinstance(value, ModuleType) else getattr(value, "__module__", None)
    return isinstance(home, str) and home.partition(".")[0] in LIBRARIES
