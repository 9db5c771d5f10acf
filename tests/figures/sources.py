"""What a figure was made from: a hash of the code and files that it measures, and the line that says so."""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Iterable
from functools import cache
from importlib.metadata import version
from pathlib import Path

import grimp

from tests.figures.catalogue import Figure
from tests.support.benchmark_record import machine
from tests.support.paths import ROOT

PACKAGES = ("onboard", "gcs", "sim_bridge")
WORDS = ("onboard.config", "onboard.runtime", "onboard.wire.bus")  # no figure measures these rooms
STAMP = re.compile(r"^Made by `make figures` on \S+ .*; sources `(?P<sources>[0-9a-f]{16})`\.$", re.M)


@cache
def imports() -> grimp.ImportGraph:
    """Which module of the product imports which."""
    return grimp.build_graph(*PACKAGES, cache_dir=None)


def measured(modules: Iterable[str]) -> list[str]:
    """The modules and all that they import of the product but the rooms of WORDS, in order of name.

    Raises for a module that does not exist."""
    graph, found = imports(), set[str]()
    for module in modules:
        package = bool(graph.find_children(module))
        found |= {module, *graph.find_upstream_modules(module, as_package=package)}
        found |= graph.find_descendants(module)
    return sorted(module for module in found if not module.startswith(WORDS))


def place(module: str) -> Path:
    """The file of a module of the product."""
    path = ROOT.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def code(text: str) -> str:
    """What a source says to the interpreter: no comment, no docstring, no layout."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [part for part in body if not _is_text(part)]  # type: ignore[attr-defined]
    return ast.dump(tree)


def _is_text(node: ast.AST) -> bool:
    """Is it a string that stands alone?"""
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def fingerprint(figure: Figure) -> str:
    """Sixteen hexadecimal digits of what `figure` measures and how it is made."""
    found = hashlib.sha256(" ".join(figure.command).encode())
    for module in measured(figure.modules):
        found.update(f"\n{module}\n{code(place(module).read_text(encoding='utf-8'))}".encode())
    for pattern in figure.files:
        for path in sorted(ROOT.glob(pattern)):
            text = path.read_bytes()
            found.update(f"\n{path.relative_to(ROOT).as_posix()}\n".encode())
            found.update(code(text.decode()).encode() if path.suffix == ".py" else text)
    return found.hexdigest()[:16]


def stamp(figure: Figure, day: str) -> str:
    """The line under a page that was made now."""
    made = f"Made by `make figures` on {day} with apollonius {version('apollonius')} on {machine()}"
    return f"{made}; sources `{fingerprint(figure)}`."


def stamped(text: str) -> str | None:
    """The hash that a page bears, or None where it bears none."""
    found = STAMP.search(text)
    return found["sources"] if found else None
