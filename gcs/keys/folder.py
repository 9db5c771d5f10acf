"""The folder of a field's keys: the authority, and for each member what it takes to its computer.

    authority.key, authority.pem     stay where they were made
    roster.toml                      the roster they were made from
    MEMBER/zenoh.json5               the bus: certificate, private key, and the listener's access rules
    MEMBER/browser.p12               certificate and private key for a browser, no password
    MEMBER/mavlink.key               MAVLink signing key (vehicles)
    MEMBER/member.json               who the member is, until when, and the keys of its datagrams

Every file is 0600, every folder 0700. Nothing in a member's folder names a place on a disk: copy it anywhere.
"""

from __future__ import annotations

import base64
import json
import secrets
import shutil
from datetime import datetime, timedelta
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from cryptography import x509

from gcs.keys.authority import Authority, common_name, fingerprint, for_browser, pem
from onboard.config.strict import ConfigError
from onboard.game import access, field_roster
from onboard.game.access import Use
from onboard.game.field_roster import FieldRoster, Member
from onboard.runtime.membership import MEMBER_FILE, Membership, Peer
from onboard.runtime.secret_files import make_private_folder, read_secret, write_secret
from onboard.runtime.signing_keys import read_key
from onboard.wire.bus.topics import Party

ZENOH_FILE = "zenoh.json5"
MAVLINK_FILE = "mavlink.key"
AUTHORITY_FILE = "authority.pem"
BROWSER_FILE = "browser.p12"
ROSTER_FILE = "roster.toml"
KEY_BYTES = 32


class Issued(NamedTuple):
    """A member as its folder has it."""

    member: Member
    ends: datetime
    fingerprint: str  # SHA-256 of the certificate, the first 16 hexadecimal digits
    mavlink: str  # SHA-256 of the MAVLink key, the first 8 hexadecimal digits; "" = none
    made: bool = False  # by this very call


def init(roster: FieldRoster, roster_text: bytes, folder: Path, now: datetime) -> list[Issued]:
    """Make what is missing in a field's folder, and take away what the roster no longer has.

    A certificate stays while its name (which holds the key's number) is in the roster and half its time is
    left; the rules and everything else are written anew. Raises ConfigError.
    """
    make_private_folder(folder)
    authority = _authority(roster, folder, now)
    members = roster.members
    listener, others = members[0], members[1:]
    pairs, issued, datagrams = {}, [], {}
    for member in members:
        place = folder / member.name
        make_private_folder(place)
        pairs[member.name], made = _certificate(authority, roster, member, place, now)
        if member.vehicle is not None and (made or not (place / MAVLINK_FILE).exists()):
            write_secret(place / MAVLINK_FILE, secrets.token_bytes(KEY_BYTES).hex().encode() + b"\n")
        if made or not (place / BROWSER_FILE).exists():
            write_secret(place / BROWSER_FILE, for_browser(member.certificate, *pairs[member.name]))
        datagrams[member.name] = _datagram_key(place, made)
        issued.append(_issued(place, member, pairs[member.name][0], made))
    for member, entry in zip(members, issued, strict=True):
        if member == listener:
            peers = tuple(
                Peer(other.name, _keys(other, roster, Use.WRITE), _keys(other, roster, Use.READ),
                     datagrams[other.name])
                for other in others
            )  # fmt: skip
        else:  # the listener passes on what the member may read, and takes what it may write
            peers = (Peer(listener.name, _keys(member, roster, Use.READ), _keys(member, roster, Use.WRITE),
                          datagrams[member.name]),)  # fmt: skip
        membership = Membership(
            field=roster.game,
            name=member.name,
            certificate=member.certificate,
            ends_s=int(entry.ends.timestamp()),
            listens=member == listener,
            host=roster.host,
            port=roster.port,
            key=datagrams[member.name],
            peers=peers,
            master=next((m.name for m in members if Party.MASTER in m.parties), ""),
        )
        write_secret(folder / member.name / MEMBER_FILE, membership.encoded())
        config = _zenoh(roster, member, pairs[member.name], pem(authority.certificate))
        write_secret(folder / member.name / ZENOH_FILE, (json.dumps(config, indent=1) + "\n").encode())
    _forget(folder, {member.name for member in members})
    write_secret(folder / ROSTER_FILE, roster_text)
    return issued


def show(folder: Path) -> tuple[FieldRoster, list[Issued]]:
    """The roster of a folder and what each member has. Raises ConfigError where something is missing."""
    roster = field_roster.load(folder / ROSTER_FILE)
    issued = []
    for member in roster.members:
        certificate, _ = _read_pair(folder / member.name)
        issued.append(_issued(folder / member.name, member, certificate, False))
    return roster, issued


def _authority(roster: FieldRoster, folder: Path, now: datetime) -> Authority:
    key, certificate = folder / "authority.key", folder / AUTHORITY_FILE
    if key.exists() or certificate.exists():
        try:
            found = Authority.load(
                read_secret(key, "authority's key"), read_secret(certificate, "authority's certificate")
            )
        except ValueError as error:
            raise ConfigError(f"{folder}: authority: {error}") from None
        if found.certificate.not_valid_after_utc > now + timedelta(days=roster.days):
            return found
    made = Authority.new(roster.game, now, roster.days)
    write_secret(key, made.key_pem())
    write_secret(certificate, pem(made.certificate))
    return made


def _certificate(
    authority: Authority, roster: FieldRoster, member: Member, place: Path, now: datetime
) -> tuple[tuple[bytes, bytes], bool]:
    """A member's (certificate, private key), and whether they are new."""
    listens = member == roster.members[0]
    if (place / ZENOH_FILE).exists():
        pair = _read_pair(place)
        found = x509.load_pem_x509_certificate(pair[0])
        lasting = found.not_valid_after_utc > now + timedelta(days=roster.days) / 2
        own = common_name(found) == member.certificate and authority.signed(found)
        if own and lasting and (not listens or _answers_at(found, roster.host)):
            return pair, False
    hosts = (roster.host, "127.0.0.1", "localhost") if listens else ()
    return authority.issue(member.certificate, hosts, now, roster.days), True


def _answers_at(certificate: x509.Certificate, host: str) -> bool:
    names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    return host in {str(name.value) for name in names}


def _read_pair(place: Path) -> tuple[bytes, bytes]:
    path = place / ZENOH_FILE
    try:
        tls = json.loads(read_secret(path, "bus keys"))["transport"]["link"]["tls"]
        certificate = base64.b64decode(tls["connect_certificate_base64"])
        key = base64.b64decode(tls["connect_private_key_base64"])
        x509.load_pem_x509_certificate(certificate)
        return certificate, key
    except (ValueError, KeyError, TypeError):  # of JSON, Base64 or the certificate
        raise ConfigError(f"{path}: found damaged content, expected what gcs keys init wrote") from None


def _datagram_key(place: Path, made: bool) -> str:
    path = place / MEMBER_FILE
    if made or not path.exists():
        return secrets.token_hex(KEY_BYTES)
    return Membership.decoded(read_secret(path, "membership"), str(path)).key


def _issued(place: Path, member: Member, certificate: bytes, made: bool) -> Issued:
    found = x509.load_pem_x509_certificate(certificate)
    mavlink = ""
    if member.vehicle is not None:
        mavlink = sha256(read_key(place / MAVLINK_FILE)).hexdigest()[:8]
    return Issued(member, found.not_valid_after_utc, fingerprint(found), mavlink, made)


def _forget(folder: Path, names: set[str]) -> None:
    """Remove the folders of members that the roster no longer has."""
    for place in folder.iterdir():
        ours = place.is_dir() and not place.is_symlink() and (place / MEMBER_FILE).exists()
        if ours and place.name not in names:
            shutil.rmtree(place)


def _keys(member: Member, roster: FieldRoster, use: Use) -> tuple[str, ...]:
    """The keys of datagrams that a member may use so."""
    return tuple(
        grant.topic.key(roster.game, id)
        for grant in access.grants(member, roster)
        if grant.use is use and grant.topic in access.BY_DATAGRAM
        for id in grant.ids
    )


def _zenoh(
    roster: FieldRoster, member: Member, pair: tuple[bytes, bytes], authority: bytes
) -> dict[str, Any]:
    certificate, key = (base64.b64encode(part).decode() for part in pair)
    tls: dict[str, Any] = {
        "root_ca_certificate_base64": base64.b64encode(authority).decode(),
        "enable_mtls": True,
        "verify_name_on_connect": True,
        "close_link_on_expiration": True,
        "connect_certificate_base64": certificate,
        "connect_private_key_base64": key,
    }
    config: dict[str, Any] = {
        "metadata": {"member": member.certificate, "field": roster.game},
        "mode": "client",
        "connect": {"endpoints": [roster.endpoint]},
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {"link": {"protocols": ["tls"], "tls": tls}},
    }
    if member == roster.members[0]:
        tls |= {"listen_certificate_base64": certificate, "listen_private_key_base64": key}
        config |= {
            "mode": "router",
            "connect": {"endpoints": []},
            "listen": {"endpoints": [f"tls/{'[::]' if ':' in roster.host else '0.0.0.0'}:{roster.port}"]},
            "access_control": access.access_control(roster),
            "low_pass_filter": access.low_pass(),
            "downsampling": access.downsampling(roster),
        }
    return config

