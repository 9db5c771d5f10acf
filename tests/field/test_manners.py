"""Commands keep their manners: a share in every run of the suite, the whole matrix among the long tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.field.manners import Command, Ended, commands, ctrl_c_faults, faults, file_faults, free_endpoint

pytestmark = pytest.mark.real
SHARE = [
    Command(("sim_bridge.cli", "list", "autopilots")),
    Command(("onboard.cli", "--help")),
]


@pytest.mark.parametrize("command", SHARE, ids=lambda command: command.words[0])
def test_no_terminal_full_disk_closed_pipe_and_poor_encodings(command: Command, tmp_path: Path) -> None:
    assert list(faults(command, tmp_path, whole=False)) == []


def test_ctrl_c_ends_with_one_line_while_importing_and_later(tmp_path: Path) -> None:
    waits = Command(("gcs.cli", "status", "--wait", "60", "--bus", free_endpoint()))
    assert list(ctrl_c_faults(waits, tmp_path, Ended(1, "", ""), (0.1, 0.3, 3.0))) == []


def test_a_wrong_file_costs_one_line(tmp_path: Path) -> None:
    assert list(file_faults(Command(("sim_bridge.cli", "scenario", "check", "X"), "X"), tmp_path)) == []


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_the_whole_matrix(tmp_path: Path) -> None:
    def told() -> Iterator[str]:
        for command in commands(tmp_path):
            yield from (f"{command.line}: {fault}" for fault in faults(command, tmp_path))

    assert list(told()) == []
