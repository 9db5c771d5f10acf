"""The UDP side of a simulated autopilot: one socket, several peers, as PX4's simulation has it."""

from __future__ import annotations

import socket
from collections.abc import Hashable, Iterable

from onboard.config.strict import ConfigError
from onboard.runtime.protocols import Receiver
from onboard.runtime.udp_link import UdpLink

AGENT_BASE = 14539  # the autopilot of vehicle n sends to this port + n, where its agent listens
GROUND_STATIONS = 14550
LAST_NUMBERED = GROUND_STATIONS - AGENT_BASE - 1  # the last vehicle whose port is given by its number
CALLERS_MAX = 8  # peers that spoke up by themselves, the least recently heard forgotten first


class Radio:
    """A link that sends to all its peers: the fixed ones, and whoever has sent to it."""

    def __init__(self, link: UdpLink, peers: Iterable[tuple[str, int]]) -> None:
        self._link = link
        self._fixed = tuple(peers)
        self._callers: dict[Hashable, None] = {}
        self._receiver: Receiver | None = None

    @property
    def name(self) -> str:
        """The socket's address for people, as udp://host:port."""
        return f"udp://{self.address[0]}:{self.address[1]}"

    @property
    def address(self) -> tuple[str, int]:
        """Where the autopilot's socket is."""
        return self._link.address

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To one peer, or to all."""
        if peer is not None:
            self._link.send(data, peer)
            return
        for address in self._fixed:
            self._link.send(data, address)
        for caller in self._callers:
            self._link.send(data, caller)

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, peer)."""
        self._receiver = receiver
        self._link.receive(self._arrived)

    def counters(self) -> dict[str, int]:
        """Counters of the UDP socket, by cause."""
        return self._link.counters()

    def close(self) -> None:
        """Close the UDP socket."""
        self._link.close()

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        if peer not in self._fixed:
            self._callers.pop(peer, None)
            self._callers[peer] = None
            if len(self._callers) > CALLERS_MAX:
                self._callers.pop(next(iter(self._callers)))
        if self._receiver is not None:
            self._receiver(data, peer)


def agent_ports(ids: Iterable[int], host: str) -> dict[int, int]:
    """Where each vehicle's agent listens: 14539 + n up to the tenth, then free ports.

    Raises ConfigError where the host has no free port or is none of this machine's.
    """
    ports = {id: AGENT_BASE + id for id in ids if id <= LAST_NUMBERED}
    others = [id for id in ids if id > LAST_NUMBERED]
    probes = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in others]
    try:
        for id, probe in zip(others, probes, strict=True):
            probe.bind((host, 0))
            ports[id] = int(probe.getsockname()[1])
    except OSError as error:
        raise ConfigError(f"host: found {host}, {(error.strerror or str(error)).lower()}") from None
    finally:
        for probe in probes:
            probe.close()
    return ports
