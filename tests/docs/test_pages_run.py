"""The commands of docs/sitl.md and docs/first-flight.md, read out of the pages and run in their order.

They run in a network of their own (`unshare -rn`), so that the ports everybody knows are free; a simulated
autopilot stands at the end of every line.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.paths import ROOT
from tests.support.real_time import patience

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
BENCH = """
name = "bench"
[evader]
id = 9
position = [400, 0]
speed = 1
[[pursuers]]
id = 2
position = [0, 0]
speed = 5
[flight]
height = 50
[flight.simulated.parameters]
FS_GCS_ENABLE = 1
SYSID_MYGCS = 2
"""


class Page(NamedTuple):
    """What a page tells to do."""

    commands: list[str]
    files: dict[str, str]  # name → content


def read(name: str) -> Page:
    """The commands of a page in their order, and the files that it has one write."""
    commands: list[str] = []
    files: dict[str, str] = {}
    for language, content in BLOCK.findall((ROOT / "docs" / name).read_text(encoding="utf-8")):
        if language == "sh":
            commands += [line for line in content.splitlines() if line.strip()]
        elif language in ("toml", "csv"):
            title, _, rest = content.partition("\n")
            files[title.removeprefix("# ")] = rest
    return Page(commands, files)


def isolated() -> bool:
    """Whether this computer gives a network of its own to who asks for it."""
    if shutil.which("unshare") is None or shutil.which("ip") is None:
        return False
    try_it = ["unshare", "-rn", "ip", "link", "set", "lo", "up"]
    return subprocess.run(try_it, capture_output=True, check=False).returncode == 0


def run(page: Page, folder: Path, replaced: dict[str, str], before: str = "") -> str:
    """All commands in one shell; what they said, each with its exit code. Whatever is left is ended."""
    for name, content in page.files.items():
        for one, other in replaced.items():
            content = content.replace(one, other)
        (folder / name).write_text(content, encoding="utf-8")
    lines = ["exec 2>&1", "ip link set lo up", before]
    for command in page.commands:
        for one, other in replaced.items():
            command = command.replace(one, other)
        quoted = command.replace("'", "'\\''")
        lines += [f"echo '@@ {quoted}'", command, "echo @@rc $?"]
    lines.append("kill $(jobs -p) 2>/dev/null; sleep 0.5; kill -9 $(jobs -p) 2>/dev/null; true")
    environment = {
        "PATH": f"{Path(sys.executable).parent}:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
        "PYTHONPATH": str(ROOT), "HOME": str(folder), "PYTHONUNBUFFERED": "1",
    }  # fmt: skip
    with (folder / "said.txt").open("wb") as said:
        subprocess.run(
            ["unshare", "-rn", "--pid", "--fork", "bash", "-c", "\n".join(lines)],
            cwd=folder, env=environment, timeout=patience(150.0), check=False,
            stdin=subprocess.DEVNULL, stdout=said,
        )  # fmt: skip
    return (folder / "said.txt").read_text(encoding="utf-8", errors="replace")


def codes(said: str) -> dict[str, int]:
    """The exit code of each command."""
    found, command = {}, ""
    for line in said.splitlines():
        if line.startswith("@@ "):
            command = line.removeprefix("@@ ")
        elif line.startswith("@@rc "):
            found[command] = int(line.removeprefix("@@rc "))
    return found


needs_network = pytest.mark.skipif(not isolated(), reason="no network namespace for who is not root")


@needs_network
@pytest.mark.long
@pytest.mark.timeout(600)
def test_the_page_of_simulated_autopilots_from_the_ground_to_the_capture_and_home(tmp_path: Path) -> None:
    page = read("sitl.md")
    said = run(page, tmp_path, {})
    assert {command: code for command, code in codes(said).items() if code} == {}, said
    assert len(codes(said)) == len(set(page.commands)) >= 9
    assert "vehicle 2: at its place" in said
    assert "evader captured by 2" in said
    assert "confirmed RTL" in said


@needs_network
@pytest.mark.long
@pytest.mark.timeout(600)
def test_the_page_of_the_first_flight_in_its_order(tmp_path: Path) -> None:
    page = read("first-flight.md")
    (tmp_path / "bench.toml").write_text(BENCH)
    serve = "sim-bridge serve bench.toml --no-referee > served.txt &"
    said = run(page, tmp_path, {"serial:///dev/ttyAMA0:57600": "udpin://127.0.0.1:14541"}, serve)
    assert {command: code for command, code in codes(said).items() if code} == {}, said
    assert len(codes(said)) == len(set(page.commands)) >= 14
    assert "system 2 (ArduCopter): unsigned" in said
    assert "hold: 1 of 1 confirmed" in said
    assert re.search("evader (escaped|captured)", said)
    assert "ended: escaped" in said


def test_the_pages_name_commands_and_files_that_there_are() -> None:
    """In every run, without flying: each command is one of ours, each file is written by the page."""
    for name in ("sitl.md", "first-flight.md"):
        page = read(name)
        words = [word for command in page.commands for word in command.split()]
        for file in {w for w in words if w.endswith((".toml", ".csv"))}:
            assert file in page.files, f"{name}: {file}"
        ours = [c for c in page.commands if not re.match(r"(\w+=\S+|kill .*|wait .*|while .*)$", c)]
        assert all(c.split()[0] in ("gcs", "sim-bridge", "onboard-agent") for c in ours), name
