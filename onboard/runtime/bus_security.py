"""How a bus is protected, in words, and why a protected one does not open."""

from __future__ import annotations

import base64
import json
import socket
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import zenoh

from onboard.config.strict import ConfigError
from onboard.runtime.membership import Membership, membership_of
from onboard.runtime.zenoh_config import DEFAULT_ENDPOINT

if TYPE_CHECKING:
    import ssl

PROBE_S = 2.0  # for one look at why a session does not open
LOOPBACK = ("127.", "[::1]", "localhost")


class Lock(Enum):
    """What keeps strangers off the bus."""

    KEYS = "locked"  # certificates on both sides
    LOOPBACK = "this computer alone"
    OPEN = "OPEN"  # whoever reaches the port takes part


class BusSecurity(NamedTuple):
    """The state of a bus's lock."""

    lock: Lock
    words: str  # for people
    member: Membership | None = None

    @property
    def short(self) -> str:
        """For a status line: "" on this computer alone."""
        if self.lock is Lock.LOOPBACK:
            return ""
        left = self.words.rpartition(", ")[2]  # "30 days left", "EXPIRED"
        return f"{self.lock.value}, {left}" if self.member is not None else self.lock.value


def security_of(endpoint: str | None, config_file: Path | None, now_s: float) -> BusSecurity:
    """The protection of the bus that `open_zenoh` opens for the same arguments. Raises ConfigError.

    `now_s` is the wall instant [s since the epoch], for the days that a certificate has left.
    """
    member = membership_of(config_file)
    if member is not None and (endpoint is None or endpoint.startswith("tls/")):
        return BusSecurity(Lock.KEYS, member.lock(now_s), member)
    where = endpoint or DEFAULT_ENDPOINT
    if config_file is not None:
        if not config_file.exists():
            raise ConfigError(f"{config_file}: found no such file, expected a Zenoh configuration")
        try:
            config = zenoh.Config.from_file(str(config_file))
            tls = json.loads(config.get_json("transport/link/tls"))
            places = [where] if endpoint else _places(config)
        except (zenoh.ZError, ValueError):
            return BusSecurity(Lock.OPEN, f"OPEN: {config_file} tells of no keys")
        if tls.get("enable_mtls") and places and all(place.startswith("tls/") for place in places):
            return BusSecurity(Lock.KEYS, f"locked by {config_file}")
        if endpoint is None:
            return BusSecurity(Lock.OPEN, f"OPEN: {config_file} demands no certificates over tls/")
    if where.partition("/")[2].startswith(LOOPBACK):
        return BusSecurity(Lock.LOOPBACK, f"{Lock.LOOPBACK.value}: {where}")
    return BusSecurity(Lock.OPEN, f"OPEN: whoever reaches {where} takes part; gcs keys init makes keys")


def why_not(member: Membership, config_file: Path) -> str:
    """Ask the listener with a handshake of TLS why a session does not open; "" where it would. Blocks.

    The words tell a certificate that has ended, another authority, a name that the listener does not have,
    and a place where nobody answers.
    """
    import ssl

    try:
        context = _context(config_file)
    except (OSError, ValueError, KeyError, TypeError) as error:
        return f"{config_file}: keys cannot be read: {error}"
    try:
        with socket.create_connection((member.host, member.port), PROBE_S) as plain:
            plain.settimeout(PROBE_S)
            with context.wrap_socket(plain, server_hostname=member.host) as probe:
                probe.recv(1)  # with TLS 1.3 the listener's verdict on our certificate comes only now
    except ssl.SSLCertVerificationError as error:
        return f"the listener's certificate is refused here: {error.verify_message}"
    except ssl.SSLError as error:
        return _REASONS.get(error.reason or "", f"TLS: {error.reason or error}")
    except TimeoutError:
        return ""  # it waits for more: the handshake went well
    except OSError as error:
        return f"{member.host}:{member.port}: {(error.strerror or str(error)).lower()}"
    return ""


_REASONS = {
    "SSLV3_ALERT_CERTIFICATE_EXPIRED": "the own certificate has expired: gcs keys init, and copy it again",
    "TLSV1_ALERT_UNKNOWN_CA": "the own certificate is of another authority than the listener's",
    "TLSV1_ALERT_DECRYPT_ERROR": "the own certificate is of another authority than the listener's",
    "SSLV3_ALERT_BAD_CERTIFICATE": "the listener refuses the own certificate: is it of another authority?",
    "TLSV13_ALERT_CERTIFICATE_REQUIRED": "the listener demands a certificate",
    "WRONG_VERSION_NUMBER": "the listener speaks no TLS: it runs without keys",
}


def _places(config: zenoh.Config) -> list[str]:
    """The endpoints that a configuration connects to and listens at."""
    found: list[str] = []
    for name in ("connect/endpoints", "listen/endpoints"):
        places = json.loads(config.get_json(name))
        for value in places.values() if isinstance(places, dict) else [places]:
            found += value if isinstance(value, list) else []
    return found


def _context(config_file: Path) -> ssl.SSLContext:
    import ssl  # 5 MB that a process without keys does without
    from tempfile import TemporaryDirectory

    tls = json.loads(config_file.read_text(encoding="utf-8"))["transport"]["link"]["tls"]
    root = base64.b64decode(tls["root_ca_certificate_base64"]).decode("ascii")
    context = ssl.create_default_context(cadata=root)
    if "connect_certificate_base64" not in tls:
        return context
    with TemporaryDirectory() as place:  # mode 0700; ssl takes its own keys from files alone
        pair = Path(place, "pair.pem")
        pair.touch(0o600)
        pair.write_bytes(
            base64.b64decode(tls["connect_certificate_base64"])
            + base64.b64decode(tls["connect_private_key_base64"])
        )
        context.load_cert_chain(pair)
    return context
