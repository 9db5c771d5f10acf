"""Bytes that are nothing end nowhere in a traceback: what msgspec raises for them is named in one place."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest

from onboard.config.strict import ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.runtime.membership import MEMBER_FILE, membership_of
from onboard.runtime.signing_keys import StampFile
from tests.support.field_keys import Field
from tests.support.paths import ROOT

NO_TEXT = b"\xd1\xff\x00"


class Named(msgspec.Struct):
    name: str


@pytest.mark.parametrize("content", [b'{"name": "\xd1"}', b"[" * 100_000, b"", b"{}", NO_TEXT])
def test_whatever_is_not_json_of_a_kind_is_undecodable(content: bytes) -> None:
    with pytest.raises(UNDECODABLE):
        msgspec.json.decode(content, type=Named)


@pytest.mark.parametrize("content", [b"\x81\xa4name\xa1\xd1", b"\x91" * 100_000, b"", b"\x80", NO_TEXT])
def test_whatever_is_not_msgpack_of_a_kind_is_undecodable(content: bytes) -> None:
    with pytest.raises(UNDECODABLE):
        msgspec.msgpack.decode(content, type=Named)


def test_a_membership_that_a_disk_has_damaged_is_one_line(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    file = field.config("vehicle-2").parent / MEMBER_FILE
    whole = file.read_bytes()
    for damaged in (whole.replace(b"vehicle-2", b"vehicle\xd12"), whole[:100], NO_TEXT, b"[" * 100_000):
        file.write_bytes(damaged)
        with pytest.raises(ConfigError, match="expected what gcs keys init wrote") as caught:
            membership_of(field.config("vehicle-2"))
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("content", [b'{"\xd1": 1}', NO_TEXT, b"[" * 100_000])
def test_stamps_that_a_disk_has_damaged_are_an_error_in_words(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "stamps"
    file.write_bytes(content)
    file.chmod(0o600)
    with pytest.raises(ConfigError, match="damaged content") as caught:
        StampFile(file).load()
    assert str(file) in str(caught.value)


def test_nobody_names_a_part_of_what_msgspec_raises() -> None:
    part = re.compile(r"(except|suppress\().*msgspec\.(MsgspecError|DecodeError)")
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for room in ("onboard", "gcs", "sim_bridge")
        for path in (ROOT / room).rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if part.search(line)
    ]
    assert found == []
