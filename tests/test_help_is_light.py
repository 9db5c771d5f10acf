"""`--help` of every program and every command answers at once: what it imports is counted, not the clock.

0.07 CPU-seconds (onboard-agent), 0.12 to 0.19 (gcs, sim-bridge: start.md). Pydantic, by which
typer turns words into types, is a tenth of a second: see `onboard.runtime.options`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from tests.support.paths import ROOT
from tests.support.real_time import patience

HEAVY = {
    "numpy", "scipy", "numba", "llvmlite", "zenoh", "pymavlink", "serial", "asyncio", "multiprocessing",
    "rich", "textual", "mcap", "matplotlib", "PIL", "pyarrow", "aiohttp", "control", "cryptography", "mavsdk",
    "pydantic",
}  # fmt: skip
OWN = 55  # modules of this project for a program's words and types; 48 today
ALL = 380  # and with Python's own and typer's; 330 today

# In one process: a module that any of the commands imports stays to be seen.
WALK = """
import contextlib, importlib, io, json, sys
name = sys.argv[1]
program = importlib.import_module(name)
seen = []
def helped(words):
    said = io.StringIO()
    sys.argv = [name, *words, "--help"]
    with contextlib.redirect_stdout(said), contextlib.suppress(SystemExit):
        if hasattr(program, "app"):
            program.app(args=[*words, "--help"], prog_name=name)
        else:
            program.main()
    assert "sage:" in said.getvalue(), words
    seen.append(" ".join(words))
def walk(words, command):
    helped(words)
    for word, inner in getattr(command, "commands", {}).items():
        walk([*words, word], inner)
if hasattr(program, "app"):
    import typer
    walk([], typer.main.get_command(program.app))
else:
    helped([])
    helped(["check"])
json.dump({"commands": seen, "modules": sorted(sys.modules)}, sys.stdout)
"""


@pytest.mark.parametrize(
    ("program", "commands"), [("onboard.cli", 2), ("gcs.cli", 18), ("sim_bridge.cli", 20)]
)
def test_no_help_imports_what_only_the_work_needs(program: str, commands: int) -> None:
    run = subprocess.run(
        [sys.executable, "-c", WALK, program], capture_output=True, text=True, check=True,
        timeout=patience(60.0), env={**os.environ, "PYTHONPATH": str(ROOT)}, cwd=ROOT,
    )  # fmt: skip
    found = json.loads(run.stdout)
    assert len(found["commands"]) >= commands, found["commands"]
    modules = found["modules"]
    assert sorted({name.split(".")[0] for name in modules} & HEAVY) == []
    own = [name for name in modules if name.split(".")[0] in ("onboard", "gcs", "sim_bridge")]
    assert len(own) <= OWN, own
    assert len(modules) <= ALL, modules
