"""Who a program is on a field's bus: `member.json` beside its Zenoh configuration, from `gcs keys init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from onboard.config.strict import ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.runtime.secret_files import read_secret

MEMBER_FILE = "member.json"
WARN_S = 3 * 86400  # a certificate that ends within three days is worth a warning

KeyHex = Annotated[str, Meta(pattern=r"\A[0-9a-f]{64}\Z", description="64 hexadecimal digits")]


class Peer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Somebody a member exchanges datagrams with."""

    name: str
    writes: tuple[str, ...]  # keys of the bus that the peer may put (of a request: ask)
    reads: tuple[str, ...]  # keys of the bus that the peer may hear (of a request: answer)
    key: KeyHex  # shared with this peer alone


class Membership(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A member of a field."""

    field: str  # the game's name
    name: str
    certificate: str  # its common name
    ends_s: int  # when the certificate ends [s since the epoch]
    listens: bool  # whether the others connect to this member
    host: str
    port: int  # TCP for TLS, UDP for datagrams
    key: KeyHex  # of the own datagrams
    peers: tuple[Peer, ...]
    master: str = ""  # the member whose word counts as the master's; "" = the roster names none

    @property
    def endpoint(self) -> str:
        """Where the members meet."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"tls/{host}:{self.port}"

    def encoded(self) -> bytes:
        """As JSON."""
        return msgspec.json.format(msgspec.json.encode(self), indent=1) + b"\n"

    @staticmethod
    def decoded(content: bytes, name: str) -> Membership:
        """The membership of a file's content; `name` stands for it in errors. Raises ConfigError."""
        try:
            return msgspec.json.decode(content, type=Membership)
        except UNDECODABLE as error:
            raise ConfigError(f"{name}: {error}; expected what gcs keys init wrote") from None

    def lock(self, now_s: float) -> str:
        """The state of the lock in a few words."""
        left = self.ends_s - now_s
        until = f"{left / 86400:.0f} days left" if left > 0 else "EXPIRED"
        return f"locked: {self.certificate} in field {self.field}, {until}"


def membership_of(config_file: Path | None) -> Membership | None:
    """Who the owner of a Zenoh configuration is; None where none of `gcs keys` lies beside it.

    Raises ConfigError where the file is damaged or others may read it.
    """
    if config_file is None:
        return None
    path = config_file.parent / MEMBER_FILE
    if not path.exists():
        return None
    return Membership.decoded(read_secret(path, "membership"), str(path))
