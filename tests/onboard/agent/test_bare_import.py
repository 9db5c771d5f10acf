"""Modules without docstrings compute what they did; what is no docstring stays."""

from __future__ import annotations

import dis
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from types import CodeType

import pytest

from onboard.agent.bare_import import bare
from tests.support.paths import ROOT
from tests.support.real_time import patience

SAID = '''
"""A module's words stay."""
def told(x):
    """Words."""
    def inner():
        """More words."""
        return x
    return inner()
def untold(x):
    return "first" if x else "second"
def returned():
    """Both docstring and value."""
    return "Both docstring and value."
def yields():
    """Words."""
    yield "Words"
many = [str("in a list") for _ in range(2)]
short = lambda: "in a lambda"
lazy = tuple("in a generator" for _ in range(2))
class Kind:
    """A class keeps its own."""
    def method(self):
        """Words."""
        return "method"
async def waits():
    """Words."""
    return "waited"
'''


def test_docstrings_go_and_every_value_stays() -> None:
    space: dict[str, object] = {}
    exec(bare(compile(SAID, "said.py", "exec")), space)
    check = """
assert told.__doc__ is None and told(3) == 3 and untold(1) == "first" and untold(0) == "second"
assert returned() == "Both docstring and value."
assert list(yields()) == ["Words"] and yields.__doc__ is None and waits.__doc__ is None
assert many == ["in a list"] * 2 and short() == "in a lambda" and lazy == ("in a generator",) * 2
assert Kind.__doc__ == "A class keeps its own." and Kind.method.__doc__ is None
assert Kind().method() == "method"
assert __doc__ == "A module's words stay."
"""
    exec(check, space)


def functions(code: CodeType) -> Iterator[CodeType]:
    """A code and all that is defined within it."""
    yield code
    for one in code.co_consts:
        if isinstance(one, CodeType):
            yield from functions(one)


def loaded(code: CodeType) -> list[object]:
    """Every constant that an instruction loads."""
    found = [one.argval for one in dis.get_instructions(code) if one.opcode in dis.hasconst]
    return [one for one in found if not isinstance(one, CodeType)]


def sources() -> list[Path]:
    """Of what an agent imports: our own, and large modules of the library and of NumPy."""
    named = (
        "argparse",
        "asyncio.base_events",
        "inspect",
        "typing",
        "numpy.lib._function_base_impl",
        "msgspec.inspect",
    )
    found = [spec.origin for spec in map(find_spec, named) if spec is not None and spec.origin is not None]
    return [*map(Path, found), *sorted((ROOT / "onboard").rglob("*.py"))]


def test_no_instruction_of_what_an_agent_imports_reads_what_went() -> None:
    """By the interpreter's own disassembler: every constant that an instruction loads is still the same."""
    gone = 0
    for path in sources():
        whole = compile(path.read_text("utf-8"), str(path), "exec")
        for before, after in zip(functions(whole), functions(bare(whole)), strict=True):
            assert before.co_code == after.co_code
            assert loaded(before) == loaded(after), (path, before.co_name)
            gone += before.co_consts[:1] != after.co_consts[:1] and isinstance(before.co_consts[0], str)
    assert gone > 1000


PLUGIN = """
import sys
sys.path.insert(0, sys.argv[1])
from onboard.agent.lean import lean
lean()
import theirs, onboard.core.game.advance as ours, numpy, json
print(theirs.speak.__doc__, ours.advance.__doc__, numpy.sort.__doc__, json.dumps.__doc__, sep="|")
"""


def test_a_plugin_keeps_its_words(tmp_path: Path) -> None:
    (tmp_path / "theirs.py").write_text('def speak():\n    """Mine."""\n', encoding="utf-8")
    told = subprocess.run(
        [sys.executable, "-c", PLUGIN, str(tmp_path)], capture_output=True, text=True, check=True,
        timeout=patience(30.0), cwd=ROOT,
    ).stdout  # fmt: skip
    assert told.strip() == "Mine.|None|None|None"


@pytest.mark.parametrize("name", ["_add_newdocs", "_add_newdocs_scalars"])
def test_the_words_of_compiled_code_are_where_they_are_looked_for(name: str) -> None:
    assert find_spec(f"numpy._core.{name}") is not None
