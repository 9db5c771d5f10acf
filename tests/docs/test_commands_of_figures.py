"""Every page of figures names in its head the command that makes it, and that command is there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.docs.test_commands_of_pages import PAGES, taken
from tests.support.paths import ROOT
from tests.support.real_time import patience

FIGURES = sorted((ROOT / "benchmarks" / "results").glob("*.md"))
TARGETS = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
BEFORE = re.compile(r"(?:nice -n -?\d+ |[A-Z_]+=\S+ |\S+/(?=python|pytest|sim-bridge|gcs))*")
HEAD = 6  # lines
RUN = re.compile(r"python -m ((?:tests|sim_bridge|gcs|onboard)[\w.]*)")


def command_of(page: Path) -> str:
    """The first words in a page's head that are a command's."""
    spans = re.findall(r"`([^`]+)`", "\n".join(page.read_text("utf-8").splitlines()[:HEAD]))
    found = [BEFORE.sub("", span, count=1) for span in spans]
    return next((line for line in found if re.match(r"(?:python -m|make|sim-bridge|gcs|pytest) ", line)), "")


def fault(line: str) -> str:
    """What of a command is not there, "" where all of it is."""
    program, *words = shlex.split(line)
    if program == "make":
        return "" if words[0] in TARGETS else f"no target {words[0]}"
    if program == "pytest":
        return "" if (ROOT / words[0]).exists() else f"no file {words[0]}"
    if program == "python":
        return _of_module(words[1], [word for word in words[2:] if word.startswith("--")])
    try:
        taken(program, words)
    except (Exception, SystemExit) as error:
        return repr(error)
    return ""


def _of_module(module: str, options: list[str]) -> str:
    file = _file_of(f"{module}.__main__") or _file_of(module)
    if file is None:
        return f"no module {module}"
    text = file.read_text("utf-8")
    if file.name != "__main__.py" and '__name__ == "__main__"' not in text:
        return f"{module} is no program"
    text += "".join(one.read_text("utf-8") for one in file.parent.glob("*.py"))
    unknown = [option for option in options if f'"{option.partition("=")[0]}"' not in text]
    if unknown:  # it may put their names together
        told = subprocess.run(
            [sys.executable, "-m", module, "--help"], capture_output=True, text=True, timeout=patience(40.0),
            cwd=ROOT, check=False,
        ).stdout  # fmt: skip
        unknown = [option for option in unknown if not re.search(rf"{option}\b", told)]
    return f"{module} knows no {unknown}" if unknown else ""


def _file_of(module: str) -> Path | None:
    try:
        spec = find_spec(module)
    except ModuleNotFoundError:
        return None
    return Path(spec.origin) if spec is not None and spec.origin is not None else None


@pytest.mark.parametrize("page", FIGURES, ids=lambda page: page.name)
def test_a_page_of_figures_can_be_made_again(page: Path) -> None:
    line = command_of(page)
    assert line, f"{page.name} names no command in its first {HEAD} lines"
    assert fault(line) == "", line


def test_the_modules_that_pages_have_run_are_there() -> None:
    for page in (*PAGES, *FIGURES, ROOT / "Makefile", ROOT / "ARCHITECTURE.md"):
        named = RUN.findall(page.read_text("utf-8"))
        assert [module for module in named if _of_module(module.rstrip("."), [])] == [], page.name


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("python -m tests.benchmarks.no_such", "no module"),
        ("python -m tests.support.paths", "is no program"),
        ("python -m tests.benchmarks.several_flown --sedes 5", "knows no"),
        ("make no-such", "no target"),
        ("pytest tests/benchmarks/bench_none.py -n 0", "no file"),
        ("sim-bridge campaign study gammes", "No such command"),
    ],
)
def test_a_command_that_is_gone_is_seen(line: str, said: str) -> None:
    assert said in fault(line)
