"""Notification of a service manager (sd_notify): ready, alive, stopping; silent where there is none."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Mapping

from onboard.runtime.protocols import Clock


class Notifier:
    """Speaks to the socket in `NOTIFY_SOCKET`; the watchdog is fed at most four times in its interval."""

    def __init__(self, clock: Clock, environment: Mapping[str, str] | None = None) -> None:
        environment = os.environ if environment is None else environment
        path = environment.get("NOTIFY_SOCKET", "")
        self._address = "\0" + path[1:] if path.startswith("@") else path
        interval = environment.get("WATCHDOG_USEC", "")
        owner = environment.get("WATCHDOG_PID", "") or str(os.getpid())
        mine = owner == str(os.getpid()) and interval.isascii() and interval.isdigit()
        self._every_ns = int(interval) * 1000 // 4 if mine else 0
        self._clock = clock
        self._fed_ns = -(1 << 62)
        self._socket: socket.socket | None = None
        if self._address:
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
            self._socket.setblocking(False)

    @property
    def active(self) -> bool:
        """Whether somebody listens."""
        return self._socket is not None

    def ready(self) -> None:
        """The service is up."""
        self._say("READY=1")

    def status(self, text: str) -> None:
        """One line for `systemctl status`."""
        self._say(f"STATUS={text}".replace("\n", " "))

    def stopping(self) -> None:
        """The service goes down."""
        self._say("STOPPING=1")

    def alive(self) -> None:
        """Feed the watchdog, where there is one; call it as often as you like."""
        if self._every_ns == 0:
            return
        now = self._clock.monotonic_ns()
        if now - self._fed_ns >= self._every_ns:
            self._fed_ns = now
            self._say("WATCHDOG=1")

    def close(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _say(self, text: str) -> None:
        if self._socket is not None:
            with contextlib.suppress(OSError):  # a manager that does not listen must not stop a flight
                self._socket.sendto(text.encode(), self._address)
