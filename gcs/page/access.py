"""Who may look at the page, and who may command. Pure: what a request brings in, a verdict out.

From another machine nobody gets in without the token (or a client certificate, which TLS has checked before).
Looking from this machine needs nothing; commanding needs the page's own address with the token, so that no
other user of the machine, and no page from elsewhere in the same browser, commands vehicles.
"""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from ipaddress import ip_address
from typing import NamedTuple
from urllib.parse import urlsplit

COOKIE = "apollonius"
LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]", "::1"})


class Rights(NamedTuple):
    """What a request may do. `reason` says why it may not look."""

    look: bool
    command: bool
    reason: str = ""


class Doors(NamedTuple):
    """How a page is guarded."""

    token: str  # who brings it may do all that the page offers
    control: bool  # whether the page offers commands
    host: str  # that it listens at
    names: tuple[str, ...] = ()  # under which it may also be asked for: of this computer
    certificates: bool = False  # TLS asks for client certificates and has checked them
    members: Mapping[str, bool] | None = None  # of a field's keys: whom they let in, and whether to order


def loopback(host: str) -> bool:
    """Whether a host, as it is written in options, is this machine alone."""
    try:
        return host == "localhost" or ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


def rights(doors: Doors, headers: Mapping[str, str], token: str, peer: str, member: str = "") -> Rights:
    """The rights of a request with these headers and this token, from this address; `member`: the name in the
    client's certificate, which TLS has checked.

    A name in `Host` that is not the page's own is refused (a stranger's name that leads here), and so is an
    `Origin` other than the page itself (a stranger's page in the user's browser).
    """
    host = headers.get("Host", "")
    name = (urlsplit(f"//{host}").hostname or "").lower()
    if not _own_name(name, doors):
        return Rights(False, False, f"the page is not known under the name {name[:80]!r}")
    origin = headers.get("Origin")
    if origin is not None and urlsplit(origin).netloc.lower() != host.lower():
        return Rights(False, False, "another page asked")
    if doors.members is not None:
        if member not in doors.members:
            return Rights(False, False, f"{member[:80]!r} is no station of the roster that hears the game")
        return Rights(True, doors.control and doors.members[member])
    known = hmac.compare_digest(token.encode(), doors.token.encode()) or doors.certificates
    if known:
        return Rights(True, doors.control)
    if token:
        return Rights(False, False, "this token is not the page's")
    if loopback(peer) and loopback(doors.host):
        return Rights(True, False)
    return Rights(False, False, "a token is needed: the address that the page said at its start")


def _own_name(name: str, doors: Doors) -> bool:
    if name in LOOPBACK_NAMES or name in doors.names or name == doors.host.strip("[]").lower():
        return True
    try:
        ip_address(name)  # an address cannot be a stranger's name
    except ValueError:
        return False
    return True
