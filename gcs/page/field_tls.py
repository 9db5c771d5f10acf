"""TLS of the page by a field's keys: its certificate is the listener's, the roster's stations are let in."""

from __future__ import annotations

import base64
import json
import ssl
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from onboard.config.strict import ConfigError
from onboard.runtime.membership import MEMBER_FILE, Membership
from onboard.runtime.secret_files import read_secret, write_secret
from onboard.wire.bus.topics import COMMAND, everything

BUS_FILE = "zenoh.json5"


class FieldKeys(NamedTuple):
    """What the listener's folder says."""

    tls: ssl.SSLContext
    members: dict[str, bool]  # who is let in, by its certificate's common name → whether to order
    host: str  # at which the certificate holds


def field_keys(folder: Path) -> FieldKeys:
    """The keys of the listener's folder, as `gcs keys init` wrote it. Raises ConfigError with one line."""
    path = folder / BUS_FILE
    content = read_secret(path, "bus keys")
    who = folder / MEMBER_FILE
    membership = Membership.decoded(read_secret(who, "membership"), str(who))
    if not membership.listens:
        raise ConfigError(
            f"page.tls_keys: {folder}: found the keys of {membership.name}, expected those of the listener,"
            " which alone has the roster's rules"
        )
    try:
        config = json.loads(content)
        members = _members(config["access_control"], membership.field)
        tls = _context(config["transport"]["link"]["tls"])
    except (ValueError, KeyError, TypeError, ssl.SSLError):  # of JSON, Base64 or the certificate
        raise ConfigError(f"{path}: found damaged content, expected what gcs keys init wrote") from None
    return FieldKeys(tls, members, membership.host)


def name_in(certificate: dict[str, Any] | None) -> str:
    """The common name in a certificate that TLS has checked; "" without one."""
    for part in (certificate or {}).get("subject", ()):
        for name, value in part:
            if name == "commonName":
                return str(value)
    return ""


def _members(control: dict[str, Any], game: str) -> dict[str, bool]:
    """Who may hear the whole game by the rules of the bus, and who may order besides."""
    before, _, after = COMMAND.key(game).partition("*")
    hearing, ordering = set(), set()
    for rule in control["rules"]:
        if rule["permission"] != "allow" or "ingress" not in rule["flows"]:
            continue
        if "declare_subscriber" in rule["messages"] and everything(game) in rule["key_exprs"]:
            hearing.add(rule["id"])
        orders = (key.startswith(before) and key.endswith(after) for key in rule["key_exprs"])
        if "query" in rule["messages"] and any(orders):
            ordering.add(rule["id"])
    rules = {
        subject: set(policy["rules"]) for policy in control["policies"] for subject in policy["subjects"]
    }
    return {
        name: bool(rules[subject["id"]] & ordering)
        for subject in control["subjects"]
        for name in subject["cert_common_names"]
        if rules[subject["id"]] & hearing
    }


def _context(tls: dict[str, str]) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    names = ("listen_certificate_base64", "listen_private_key_base64")
    pair = b"".join(base64.b64decode(tls[name]) for name in names)
    with TemporaryDirectory() as place:  # mode 0700; ssl reads a key from a file alone
        write_secret(Path(place) / "pair.pem", pair, durable=False)
        context.load_cert_chain(Path(place) / "pair.pem")
    context.load_verify_locations(cadata=base64.b64decode(tls["root_ca_certificate_base64"]).decode())
    context.verify_mode = ssl.CERT_REQUIRED
    return context
