"""Configurations of Zenoh sessions: this product's defaults, a file of the user's, what was asked for."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import NamedTuple

import zenoh

from onboard.config.printable import words_of
from onboard.config.strict import ConfigError
from onboard.runtime.membership import Membership, membership_of
from onboard.runtime.rate_limit import PAYLOAD_MAX
from onboard.runtime.secret_files import read_secret

DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
IP_ENDPOINT = re.compile(r"(?:tcp|tls|udp|quic|ws)/(?P<host>.*):(?P<port>\d+)(?:[?#].*)?\Z")
PORT_MAX = 65535
MESSAGE_MAX = 2 * PAYLOAD_MAX  # bytes put together from fragments: more is dropped before it is whole
LEASE_MS = 2000  # a silent partner is given up after this
ALWAYS: dict[str, object] = {
    "timestamping/enabled": True,
    "transport/link/tx/lease": LEASE_MS,
    "transport/link/rx/max_message_size": MESSAGE_MAX,
    "connect/retry": {"period_init_ms": 500, "period_max_ms": 500, "period_increase_factor": 1},
    "connect/timeout_ms": 0,
    "connect/exit_on_failure": True,
    "transport/shared_memory/enabled": False,  # payloads are bytes of this process; 0.3 MB
}
NO_SCOUTING: dict[str, object] = {"scouting/multicast/enabled": False, "scouting/gossip/enabled": False}


class Candidate(NamedTuple):
    """A session that may be opened."""

    how: str  # what it then is: `listening`, `joined` or `client`
    config: zenoh.Config


def sessions_of(endpoint: str | None, listen: bool, config_file: Path | None) -> list[Candidate]:
    """The sessions to try, in order, for the arguments of `open_zenoh`. Raises ConfigError."""
    member = membership_of(config_file)
    if member is not None and endpoint is None:
        return _sessions_of_member(member, listen, config_file)
    if config_file is not None and endpoint is None:
        return [Candidate("client", _config(config_file, ALWAYS))]
    where = endpoint or DEFAULT_ENDPOINT
    if (named := IP_ENDPOINT.match(where)) and (not named["host"] or int(named["port"]) > PORT_MAX):
        expected = f"a host and a port up to {PORT_MAX}, as {DEFAULT_ENDPOINT}"
        raise ConfigError(f"bus: found {where!r}, expected {expected}")
    common = ALWAYS | NO_SCOUTING
    client = {"mode": "client", "connect/endpoints": [where], "listen/endpoints": []}
    sessions = [Candidate("joined" if listen else "client", _config(config_file, common | client))]
    if listen:
        router = {"mode": "router", "listen/endpoints": [where], "connect/endpoints": []}
        sessions.insert(0, Candidate("listening", _config(config_file, common | router)))
    return sessions


def of_zenoh(error: BaseException) -> bool:
    """Whether an exception that a call of Zenoh raised is its own: an error, or the panic of its Rust code,
    which is no `Exception`: for example where the process has no descriptor left."""
    return isinstance(error, Exception) or type(error).__name__ == "PanicException"


def endpoint_of(endpoint: str | None, config_file: Path | None) -> str:
    """Where the bus is, for people, and for who asks it why it does not open. Raises ConfigError."""
    if endpoint is not None:
        return endpoint
    member = membership_of(config_file)
    if member is not None:
        return member.endpoint
    return DEFAULT_ENDPOINT if config_file is None else str(config_file)


def _sessions_of_member(member: Membership, listen: bool, config_file: Path | None) -> list[Candidate]:
    """As the keys have it: the listener listens; another program of its own computer joins it."""
    if not member.listens:
        return [Candidate("client", _config(config_file, ALWAYS))]
    client = {
        "mode": "client",
        "connect/endpoints": [f"tls/127.0.0.1:{member.port}"],
        "listen/endpoints": [],
        "access_control": {"enabled": False},
    }
    sessions = [Candidate("joined" if listen else "client", _config(config_file, ALWAYS | client))]
    if listen:
        sessions.insert(0, Candidate("listening", _config(config_file, ALWAYS)))
    return sessions


def first_sentence(error: BaseException) -> str:
    """An error of Zenoh's for people: without the line of its source, which follows ` at /`."""
    words = words_of(error).split(" at /")[0].strip()
    return "nobody answers there" if words.startswith("Unable to connect to any of") else words


def _config(file: Path | None, settings: dict[str, object]) -> zenoh.Config:
    """The file's configuration (None: Zenoh's own) with `settings` over it."""
    try:
        if file is not None and membership_of(file) is not None:
            read_secret(file, "bus keys")  # nobody else may
        config = zenoh.Config.from_file(str(file)) if file else zenoh.Config()
    except zenoh.ZError as error:
        raise ConfigError(f"{file}: {first_sentence(error)}") from None
    for name, value in settings.items():
        try:
            config.insert_json5(name, json.dumps(value))
        except zenoh.ZError:
            raise ConfigError(f"bus: {name}: found {value!r}, expected e.g. {DEFAULT_ENDPOINT}") from None
    return config
