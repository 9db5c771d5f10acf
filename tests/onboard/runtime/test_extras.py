"""Whatever an installation may lack is named with the extra that brings it."""

from __future__ import annotations

import re
import sys
from importlib import metadata

import pytest

from onboard.runtime.extras import lacking
from tests.support.paths import ROOT

BASE = {"numpy", "pymavlink", "serial", "zenoh", "typer", "msgspec"}  # of every installation
ASKED_FOR = {"pandas"}  # by a caller in Python, who has it
IMPORT = re.compile(
    r"^\s*(?:from (\w+)[\w.]* import|import (\w+)[\w.]*(?: as \w+)?(?:  #.*)?$)", re.MULTILINE
)
OWN = {"onboard", "gcs", "sim_bridge"}


def imported() -> set[str]:
    """Top names of all modules that the three programs import, wherever they do."""
    texts = (path.read_text("utf-8") for package in OWN for path in (ROOT / package).rglob("*.py"))
    found = {first or second for text in texts for first, second in IMPORT.findall(text)}
    return found - set(sys.stdlib_module_names) - OWN


def test_every_module_beyond_the_base_names_its_extra() -> None:
    extras = metadata.metadata("apollonius").get_all("Provides-Extra") or []
    beyond = imported() - BASE - ASKED_FOR
    assert {"mcap", "numba", "gymnasium", "distributed"} <= beyond
    for module in beyond:
        told = lacking(f"{module}.part")
        assert told.startswith(f"found no {module}, expected: pip install 'apollonius["), module
        assert told.split("apollonius[")[1].split("]")[0] in extras


@pytest.mark.parametrize("module", ["", "onboard.nowhere", "numpy", "antigravity"])
def test_nothing_is_promised_of_others(module: str) -> None:
    assert lacking(module) == ""
