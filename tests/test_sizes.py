"""Files and functions of the product stay small enough to hold in the head."""

from __future__ import annotations

import ast
from pathlib import Path

from tests.support.paths import ROOT

LINES_OF_A_FILE = 400
LINES_OF_A_FUNCTION = 60
LONG = {("onboard/core/geometry/edges.py", "by_pairs")}  # the kernel written out for speed


def sources() -> list[Path]:
    """Every Python file of the product."""
    return [file for room in ("onboard", "gcs", "sim_bridge") for file in sorted((ROOT / room).rglob("*.py"))]


def test_no_file_is_too_long() -> None:
    lengths = {str(file.relative_to(ROOT)): file.read_text().count("\n") for file in sources()}
    assert len(lengths) > 200
    assert {name: length for name, length in lengths.items() if length > LINES_OF_A_FILE} == {}


def test_no_function_is_too_long() -> None:
    found = set()
    for file in sources():
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                assert node.end_lineno is not None
                if node.end_lineno - node.lineno + 1 > LINES_OF_A_FUNCTION:
                    found.add((str(file.relative_to(ROOT)), node.name))
    assert found == LONG
