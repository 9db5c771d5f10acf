"""A serial port as a link: opened and closed by threads, read by the event loop, reopened when unplugged.

To open or close a device whose driver hangs may take half a minute.
"""

from __future__ import annotations

import asyncio
import errno
import os
import threading
from collections import Counter, deque
from collections.abc import Hashable
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Receiver

BACKLOG_MAX = 16384  # bytes that wait for the port before the next message is dropped
REOPEN_S = 1.0
_CHUNK = 4096


class SerialLink:
    """A byte stream; its one peer is the device. POSIX only (a file descriptor in the event loop)."""

    def __init__(self, name: str, device: str, baud: int) -> None:
        self._name = name
        self._device = device
        self._baud = baud
        self._counts: Counter[str] = Counter()
        self._receiver: Receiver | None = None
        self._port: Any = None
        self._fd = -1
        self._backlog: deque[bytes] = deque()
        self._backlog_bytes = 0
        self._reopen: asyncio.Task[None] | None = None
        self._closed = False

    @classmethod
    async def open(cls, name: str, device: str, baud: int, timeout_s: float = 5.0) -> SerialLink:
        """Open a device. Raises ConfigError: no such device, in use, no permission, a wrong baud rate, or a
        device that does not answer within `timeout_s`."""
        link = cls(name, device, baud)
        try:
            async with asyncio.timeout(timeout_s):
                await link._open()
        except TimeoutError:
            raise ConfigError(f"link: {name}: {device} does not open within {timeout_s:g} s") from None
        except OSError as error:
            raise ConfigError(f"link: {name}: {_reason(error, device)}") from None
        except ValueError:
            raise ConfigError(f"link: {name}: found baud rate {baud}, expected one the device has") from None
        return link

    @property
    def name(self) -> str:
        """For people: the URL."""
        return self._name

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, device)."""
        self._receiver = receiver

    def counters(self) -> dict[str, int]:
        """sent, received (chunks), overflow, unplugged, reopened …"""
        return dict(self._counts)

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """Write whole messages or nothing: what does not fit the backlog is dropped and counted."""
        if self._closed:
            self._counts["closed"] += 1
        elif self._fd < 0:
            self._counts["unplugged_drop"] += 1
        elif self._backlog_bytes + len(data) > BACKLOG_MAX:
            self._counts["overflow"] += 1
        else:
            self._counts["sent"] += 1
            self._backlog.append(data)
            self._backlog_bytes += len(data)
            if len(self._backlog) == 1:
                self._flush()

    def close(self) -> None:
        """Let go of the port."""
        self._closed = True
        if self._reopen is not None:
            self._reopen.cancel()
        self._release()

    async def _open(self) -> None:
        self._attach(await off_loop(self._opened, _close))

    def _opened(self) -> Any:
        """The port. For any thread; raises OSError or ValueError."""
        import serial

        try:
            port = serial.Serial(self._device, self._baud, timeout=0, write_timeout=0, exclusive=True)
        except serial.SerialException as error:
            raise OSError(error.errno or errno.EIO, str(error)) from None
        os.set_blocking(port.fileno(), False)
        return port

    def _attach(self, port: Any) -> None:
        if self._closed:
            _close(port)
            return
        self._port, self._fd = port, port.fileno()
        asyncio.get_running_loop().add_reader(self._fd, self._readable)

    def _release(self) -> None:
        if self._fd >= 0:
            loop = asyncio.get_running_loop()
            loop.remove_reader(self._fd)
            loop.remove_writer(self._fd)
            self._fd = -1
            _close(self._port)
        self._backlog.clear()
        self._backlog_bytes = 0

    def _readable(self) -> None:
        try:
            data = os.read(self._fd, _CHUNK)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._unplugged()
            return
        self._counts["received"] += 1
        if self._receiver is None:
            self._counts["unheard"] += 1
        else:
            self._receiver(data, self._device)

    def _flush(self) -> None:
        loop = asyncio.get_running_loop()
        while self._backlog:
            head = self._backlog[0]
            try:
                written = os.write(self._fd, head)
            except BlockingIOError:
                written = 0
            except OSError:
                self._unplugged()
                return
            self._backlog_bytes -= written
            if written < len(head):
                self._backlog[0] = head[written:]
                loop.add_writer(self._fd, self._flush)
                return
            self._backlog.popleft()
        loop.remove_writer(self._fd)

    def _unplugged(self) -> None:
        self._counts["unplugged"] += 1
        self._release()
        self._try_later()

    def _try_later(self) -> None:
        if not self._closed:
            self._reopen = asyncio.get_running_loop().create_task(self._try_again())  # ended by close

    async def _try_again(self) -> None:
        while not self._closed:
            await asyncio.sleep(REOPEN_S)
            try:
                await self._open()
            except (OSError, ValueError):
                continue
            self._counts["reopened"] += 1
            return


def _close(port: Any) -> None:
    """Close a port on a thread: a driver may wait until what was written has gone out."""
    threading.Thread(target=port.close, name="serial-close", daemon=True).start()


def _reason(error: OSError, device: str) -> str:
    if error.errno == errno.ENOENT:
        return f"no such device {device}"
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"permission denied on {device} (is the user in the group dialout?)"
    if error.errno in (errno.EBUSY, errno.EAGAIN):
        return f"{device} is in use by another program"
    if error.errno == errno.ENOTTY:
        return f"{device} is not a serial device"
    return f"cannot open {device}: {(error.strerror or str(error)).lower()}"
