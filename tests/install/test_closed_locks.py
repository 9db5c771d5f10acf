"""The check of the locks finds every kind of hole, and names package, requirement, environment and find."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from locks import closed

ROOT = Path(__file__).parents[2]
HASH = " --hash=sha256:" + 64 * "0"
LOCK = ("asking==1.0", "asked==1.5", "third==3.0")
KNOWN: dict[str, dict[str, Any]] = {
    "asking==1.0": {"requires": ["asked[more]>=1"], "extras": [], "python": ">=3.8"},
    "asked==1.5": {"requires": ["third>=3; extra == 'more'"], "extras": ["more"], "python": ""},
    "third==3.0": {"requires": [], "extras": [], "python": ""},
}


def said(root: Path, capsys: pytest.CaptureFixture[str], lock: tuple[str, ...] = LOCK, **changed: Any) -> str:
    """Give what the check prints of a project that asks for `asking`; it fails unless it says "closed"."""
    (root / "locks").mkdir(exist_ok=True)
    (root / "pyproject.toml").write_text(
        "[build-system]\nrequires = []\n[project]\ndependencies = []\n"
        '[dependency-groups]\ndev = ["asking"]\nbuild = []\n', encoding="utf-8",
    )  # fmt: skip
    for name in ("base.lock", "mavproxy.lock", "mavproxy.in"):
        (root / "locks" / name).write_text("", encoding="utf-8")
    (root / "locks/all.lock").write_text("".join(f"{line}{HASH}\n" for line in lock), encoding="utf-8")
    known = {key: KNOWN[key] | changed.get(key.split("==")[0], {}) for key in KNOWN}
    known = {key: value for key, value in known.items() if value["requires"] is not None}
    (root / "locks/requires.json").write_text(json.dumps(known | changed.get("more", {})), encoding="utf-8")
    status = closed.main(["--root", str(root)])
    printed = capsys.readouterr().out
    assert status == (0 if "closed in 8 environments" in printed else 1)
    return printed


def test_a_closed_lock(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert said(tmp_path, capsys) == "the locks are closed in 8 environments\n"


@pytest.mark.parametrize(
    ("lock", "changed", "sentence"),
    [
        (LOCK, {"third": {"requires": ["fourth"]}}, "requires fourth; found nothing (every environment)"),
        (LOCK, {"asked": {"requires": ["third>=4"]}}, "asked==1.5 requires third>=4; found third==3.0"),
        (LOCK, {"asked": {"requires": ["fourth; extra == 'more'"]}},
         'asked==1.5[more] requires fourth; extra == "more"; found nothing (every'),
        (LOCK, {"asked": {"extras": []}}, "found asked==1.5, which has no extra 'more'"),
        (LOCK, {"third": {"requires": ["late; python_version >= '3.14' and platform_machine == 'aarch64'"]}},
         "found nothing (Python 3.14 on aarch64)"),
        ((*LOCK[:2], "third==3.0 ; python_full_version < '3.13'"), {},
         'found only third==3.0 ; python_full_version < "3.13" '
         "(Python 3.13 on x86_64, Python 3.13 on aarch64, Python 3.14 on x86_64, Python 3.14 on aarch64)"),
        (LOCK[1:], {"asking": {"requires": None}}, "the project requires asking; found nothing"),
        (LOCK, {"third": {"requires": None}}, "requires an entry in requires.json; found none"),
        (LOCK, {"more": {"third==2.0": KNOWN["third==3.0"]}}, "requires.json: third==2.0 is in no lock"),
        (LOCK, {"third": {"python": ">=3.12"}},
         "requires Python >=3.12; found an older Python (Python 3.11 on x86_64, Python 3.11 on aarch64)"),
        ((*LOCK, "third==3.0"), {}, "the lock requires third==3.0; found third==3.0 as well"),
        (("third>=3.0",), {}, "has no pin or no hash; expected name==version"),
        (("--index-url https://index.example/simple",), {}, "names an index or address"),
    ],
)  # fmt: skip
def test_each_kind_of_hole(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    lock: tuple[str, ...],
    changed: dict[str, Any],
    sentence: str,
) -> None:
    assert sentence in said(tmp_path, capsys, lock, **changed)


def test_what_only_windows_needs_is_no_hole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    only = {"third": {"requires": ["colours; sys_platform == 'win32'"]}}
    assert "closed" in said(tmp_path, capsys, (*LOCK, "colours==1 ; sys_platform == 'win32'"), **only)


def test_the_projects_own_locks_are_closed_and_each_package_is_missed(tmp_path: Path) -> None:
    assert closed.check(ROOT) == []
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    shutil.copytree(ROOT / "locks", tmp_path / "locks")
    entries = closed.read_lock(ROOT / "locks/base.lock")
    for left_out in ("pymavlink", "fastcrc", "pydantic-core", "typing-extensions"):
        kept = "\n".join(entry.text for entry in entries if entry.name != left_out)
        (tmp_path / "locks/base.lock").write_text(kept, encoding="utf-8")
        holes = closed.check(tmp_path)
        assert holes
        assert all(hole.startswith("base.lock: ") and left_out in hole.replace("_", "-") for hole in holes)
