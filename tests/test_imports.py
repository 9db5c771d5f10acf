"""No file knows a file that knows it: the imports of the three packages have no circles."""

from __future__ import annotations

import grimp
import pytest

PACKAGES = ("onboard", "gcs", "sim_bridge")


def circles(graph: grimp.ImportGraph) -> set[frozenset[str]]:
    """The strongly connected components of more than one file, by Tarjan's algorithm."""
    index: dict[str, int] = {}
    lowest: dict[str, int] = {}
    path: list[str] = []
    found: set[frozenset[str]] = set()

    def visit(file: str) -> None:
        index[file] = lowest[file] = len(index)
        path.append(file)
        for imported in sorted(graph.find_modules_directly_imported_by(file)):
            if imported not in index:
                visit(imported)
                lowest[file] = min(lowest[file], lowest[imported])
            elif imported in path:
                lowest[file] = min(lowest[file], index[imported])
        if lowest[file] == index[file]:
            members = path[path.index(file) :]
            del path[path.index(file) :]
            if len(members) > 1:
                found.add(frozenset(members))

    for file in sorted(graph.modules):
        if file not in index:
            visit(file)
    return found


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    """All imports, those inside functions and those for the type checker alone included: whoever reads a file
    has to know what it names, whenever it is loaded."""
    return grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False)


def test_there_are_no_circles_between_files(graph: grimp.ImportGraph) -> None:
    assert circles(graph) == set()


def test_a_circle_would_be_seen(graph: grimp.ImportGraph) -> None:
    assert len(graph.modules) > 200
    copy = grimp.build_graph("sim_bridge", cache_dir=None)
    before = circles(copy)
    copy.add_import(importer="sim_bridge.vehicle.motion", imported="sim_bridge.world.world")
    new = circles(copy) - before
    assert len(new) == 1
    assert {"sim_bridge.vehicle.motion", "sim_bridge.world.world"} <= next(iter(new))
