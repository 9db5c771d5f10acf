"""Keys of a field as a person makes them: by one command, for copying, for revoking, and never for others."""

from __future__ import annotations

import stat
import subprocess
import sys
from pathlib import Path

import pytest
from cryptography import x509

from gcs import settings
from gcs.keys import program
from gcs.page.program import guarded
from onboard.agent.config import AgentConfig
from onboard.agent.opening import refuse_open_bus, security
from onboard.config.strict import ConfigError
from onboard.game import field_roster
from onboard.runtime.bus_security import Lock, security_of
from onboard.runtime.secret_files import write_secret
from onboard.runtime.signing_keys import read_key
from tests.support.field_keys import Field, expired
from tests.support.real_time import patience


def test_one_command_makes_everything_and_nobody_else_may_read_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    field = Field(tmp_path / "keys")
    roster = tmp_path / "range.toml"
    roster.write_text(field.text)
    command = [sys.executable, "-m", "gcs.cli", "keys", "init", str(roster)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=patience(20.0), check=False)
    assert (run.returncode, run.stderr) == (0, "")
    made = tmp_path / "range-keys"
    files = [path for path in made.rglob("*") if path.is_file()]
    assert {stat.S_IMODE(path.stat().st_mode) for path in files} == {0o600}
    assert {stat.S_IMODE(p.stat().st_mode) for p in (made, *made.rglob("*")) if p.is_dir()} == {0o700}
    signing = {path.parent.name: read_key(path) for path in files if path.name == "mavlink.key"}
    assert set(signing) == {"vehicle-1", "vehicle-2", "vehicle-3"}
    assert len(set(signing.values())) == 3
    assert not any(str(tmp_path).encode() in path.read_bytes() for path in files)  # copy it anywhere
    assert program.show(made) == 0
    assert program.sheet(made) == 0
    said = capsys.readouterr().out
    assert 'zenoh = "vehicle-2/zenoh.json5"' in said
    assert "vehicle-3.1" in said


def test_the_listeners_lines_are_settings_that_open_the_page_and_stations_learn_of_their_browsers_keys(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    roster, keys = tmp_path / "range.toml", tmp_path / "range-keys"
    roster.write_text(Field(tmp_path / "keys").text)
    assert program.init(roster, keys) == 0
    assert "browser.p12" in capsys.readouterr().out
    assert program.sheet(keys) == 0
    listener, *others = capsys.readouterr().out.split("\n\n")[1:]
    (keys / "gcs.toml").write_text("\n".join(line for line in listener.split("\n") if line[:1] != "#"))
    monkeypatch.chdir(keys)
    found = settings.load(Path("gcs.toml"))
    doors, tls = guarded(found.page)
    assert found.bus.listen
    assert tls is not None
    assert doors.members
    looking = {name.rpartition(".")[0] for name in doors.members}
    assert looking == {"ground", "second"}
    for part in (listener, *others):
        name = part.partition(":")[0].removeprefix("# ")
        assert (f"import {name}/browser.p12" in part) == (name in looking), part
        assert (keys / name / "browser.p12").is_file()


def test_a_member_out_of_the_roster_loses_its_keys_and_a_raised_number_makes_new_ones(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    before = {entry.member.name: entry for entry in field.issued}
    field.change("id = 3\nrole", "id = 4\nrole")
    field.change("id = 2\n", "id = 2\nkey = 2\n")
    field.make()
    after = {entry.member.name: entry for entry in field.issued}
    assert not (field.folder / "vehicle-3").exists()
    assert after["vehicle-1"].fingerprint == before["vehicle-1"].fingerprint
    assert after["vehicle-1"].mavlink == before["vehicle-1"].mavlink
    assert after["vehicle-2"].fingerprint != before["vehicle-2"].fingerprint
    assert after["vehicle-2"].mavlink != before["vehicle-2"].mavlink
    rules = field.config("ground").read_text()
    assert '"vehicle-2.2"' in rules
    assert '"vehicle-2.1"' not in rules
    assert '"vehicle-3.1"' not in rules


def test_a_certificate_that_has_ended_is_shown_and_made_anew(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make(expired())
    assert program.show(field.folder) == 1
    found = security_of(None, field.config("vehicle-1"), field.issued[0].ends.timestamp() + 1.0)
    assert found.words.endswith("EXPIRED")
    field.make()
    assert all(entry.made for entry in field.issued)
    assert program.show(field.folder) == 0


def test_every_certificate_carries_its_members_name_and_is_no_authority(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    authority = x509.load_pem_x509_certificate((field.folder / "authority.pem").read_bytes())
    for entry in field.issued:
        certificate = x509.load_pem_x509_certificate(_certificate_of(field, entry.member.name))
        certificate.verify_directly_issued_by(authority)
        assert certificate.subject.rfc4514_string() == f"CN={entry.member.certificate}"
        constraints = certificate.extensions.get_extension_for_class(x509.BasicConstraints)
        assert constraints.critical
        assert not constraints.value.ca


def _certificate_of(field: Field, member: str) -> bytes:
    import base64
    import json

    tls = json.loads(field.config(member).read_text())["transport"]["link"]["tls"]
    return base64.b64decode(tls["connect_certificate_base64"])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("id = 3", "id = 2", "vehicles.id: found [1, 2, 2], expected ids that differ"),
        ('"second"', '"ground"', "names that differ"),
        ('"second"', '"vehicle-9"', "no name that vehicles have"),
        ('name = "second"', 'name = "second"\nparts = ["master"]', "one master at most"),
        ('"127.0.0.1"', '"a/b"', "a host name or an IP address"),
        ("commands = false", "commands = false\nspeed = 1", "speed"),
    ],
)
def test_a_wrong_roster_is_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    field = Field(tmp_path / "keys")
    file = tmp_path / "roster.toml"
    assert old in field.text
    file.write_text(field.text.replace(old, new, 1))
    with pytest.raises(ConfigError) as caught:
        field_roster.load(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("place", ["plain", "red\x1b[31m", "latin\udce9", "turned\u202e"])
@pytest.mark.parametrize("damaged", ["", "ground", "vehicle-2"])
def test_what_is_said_of_keys_is_printable_whatever_files_and_names_hold(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], place: str, damaged: str
) -> None:
    """A folder's name may hold anything but NUL and /, and a damaged file anything at all."""
    roster = tmp_path / place / "range.toml"
    roster.parent.mkdir()
    roster.write_text(Field(tmp_path / "keys").text)
    assert program.init(roster, None) == 0
    made = program.folder_of(roster)
    if damaged:
        member = made / damaged / "member.json"
        member.write_text(member.read_text().replace('"name"', '"\x85na\\u001b]0;x\\u202eme"', 1))
        with pytest.raises(ConfigError, match=r"unknown field `.na·") as caught:
            program.init(roster, None)
        assert str(caught.value).isprintable()
    assert program.show(made) == 0
    assert program.sheet(made) == 0
    said = capsys.readouterr().out
    assert "6 members of field range" in said
    assert all(line.isprintable() for line in said.split("\n"))


def test_a_secret_file_follows_no_link_and_replaces_in_one_piece(tmp_path: Path) -> None:
    victim, link = tmp_path / "victim", tmp_path / "key"
    victim.write_text("untouched")
    link.symlink_to(victim)
    write_secret(link, b"secret")
    assert victim.read_text() == "untouched"
    assert not link.is_symlink()
    assert stat.S_IMODE(link.stat().st_mode) == 0o600
    assert [path.name for path in tmp_path.iterdir()].count("key") == 1
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("name", ["zenoh.json5", "member.json"])
def test_keys_that_others_may_read_are_refused(tmp_path: Path, name: str) -> None:
    from onboard.runtime.zenoh_config import sessions_of

    field = Field(tmp_path / "keys").make()
    (field.folder / "vehicle-2" / name).chmod(0o644)
    with pytest.raises(ConfigError, match="found mode 0644, expected 0600"):
        sessions_of(None, False, field.config("vehicle-2"))


def test_in_the_field_an_open_bus_is_refused_unless_told(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    plain = tmp_path / "plain.json5"
    plain.write_text('{ mode: "client", connect: { endpoints: ["tcp/192.168.10.1:7447"] } }')
    one_sided = tmp_path / "one-sided.json5"
    one_sided.write_text('{ mode: "client", connect: { endpoints: ["tls/192.168.10.1:7447"] } }')
    open_ones = [
        AgentConfig(field=True, bus="tcp/192.168.10.1:7447"),
        AgentConfig(field=True, bus="udp/10.0.0.1:7447"),
        AgentConfig(field=True, zenoh=str(plain)),
        AgentConfig(field=True, zenoh=str(one_sided)),
        AgentConfig(field=True, zenoh=str(field.config("vehicle-2")), bus="tcp/192.168.10.1:7447"),
    ]
    for config in open_ones:
        assert security(config).lock is Lock.OPEN
        with pytest.raises(ConfigError, match=r"^zenoh: found a bus that is OPEN.*open_bus = true"):
            refuse_open_bus(config, security(config))
    told = AgentConfig(field=True, open_bus=True, bus="tcp/192.168.10.1:7447")
    refuse_open_bus(told, security(told))
    locked = AgentConfig(field=True, zenoh=str(field.config("vehicle-2")))
    assert security(locked).words == "locked: vehicle-2.1 in field range, 30 days left"
    refuse_open_bus(locked, security(locked))
    beside = AgentConfig(field=True)
    assert security(beside).lock is Lock.LOOPBACK
    refuse_open_bus(beside, security(beside))
