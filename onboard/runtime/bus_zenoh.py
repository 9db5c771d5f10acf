"""Opens the bus over Zenoh: a session alone, or where there are keys one with datagrams beside it."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from onboard.runtime import bus_security
from onboard.runtime.bus_field import FieldBus
from onboard.runtime.membership import membership_of
from onboard.runtime.zenoh_config import endpoint_of, sessions_of
from onboard.runtime.zenoh_session import ZenohBus

__all__ = ["ZenohBus", "open_zenoh"]

FIRST_ATTEMPT_S = 2.0  # `open_zenoh` returns at the latest after this, connected or not


async def open_zenoh(
    endpoint: str | None = None, *, listen: bool = False, config_file: Path | None = None
) -> ZenohBus:
    """Open the bus at `endpoint`, as a client or, with `listen`, as the one the others connect to.

    It returns after the first attempt, connected or not, and goes on trying: `status()` tells. Asked to
    listen where the port is taken, it joins as a client (`how` is then `joined`). `config_file` is a Zenoh
    configuration (JSON5) for TLS, access control, a router elsewhere; without an `endpoint` its own
    endpoints and mode stay. Raises ConfigError for a file or an endpoint that cannot be.
    """
    sessions = sessions_of(endpoint, listen, config_file)
    member = membership_of(config_file)
    where = endpoint_of(endpoint, config_file)
    if member is None or config_file is None or endpoint is not None:
        bus = ZenohBus(sessions, where)
    else:
        bus = FieldBus(sessions, where, partial(bus_security.why_not, member, config_file), member, listen)
        await bus.open_datagrams()
    await bus.first_attempt(FIRST_ATTEMPT_S)
    return bus
