"""Authenticated datagrams of the bus: what must come through a lossy network without waiting for TCP.

One datagram carries one message between two members who share a key. Layout, big-endian:

    magic "APD1" | key id 8 | process 8 | number 8 | challenge 8 | answer 8 | kind 1 | request 4
    | length of the key 2 | key of the bus | payload | HMAC-SHA256 of all before, its first 16 bytes

Freshness needs no clock of another's: a datagram has an effect only if its `answer` repeats the challenge
that this end drew for the sender's process, and its number grows. Who was silent for `SILENT_S` is challenged
anew. So nothing recorded can be played back, over restarts too. Each direction has a key of its own, so
nothing can be thrown back at its sender. Several processes of one member, a console and a command beside it,
each have their own exchange.
"""

from __future__ import annotations

import hmac
import struct
from collections import Counter, OrderedDict
from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

SIZE_MAX = 1200  # [bytes] fits every path without fragments
_MAGIC = b"APD1"
_HEAD = struct.Struct(">4s8sQQQQBIH")
_TAG = 16  # [bytes]
SILENT_S = 3.0  # after so long the other end must answer a new challenge
PROCESSES_MAX = 8  # of one member at a time
HEAD_SIZE = _HEAD.size + _TAG


class Kind(IntEnum):
    """What a datagram is."""

    BEAT = 0  # nothing but the echo of what was heard
    PUT = 1
    ASK = 2
    REPLY = 3


class Content(NamedTuple):
    """What a datagram says."""

    kind: Kind
    request: int = 0  # number of the request that is asked or answered, 32 bits
    key: str = ""  # of the bus
    payload: bytes = b""


class Opened(NamedTuple):
    """What came of a good datagram."""

    content: Content
    process: int  # the sender's
    first: bool  # of an exchange


class Challenge(NamedTuple):
    """What is to be sent back at once to who must first show that it hears us now."""

    data: bytes


class _Process:
    """The exchange with one process of the other member."""

    def __init__(self, challenge: int, now: float) -> None:
        self.challenge = challenge  # ours, which it must repeat
        self.answer = 0  # its challenge, which we repeat
        self.number = 0  # the highest of its datagrams that counted
        self.proved = False
        self.at = now  # when it was heard last [s]


class Pair:
    """One end of the exchanges between two members. Without I/O; `now` is the caller's steady time [s].

    `draw` gives random numbers of 64 bits, never 0; `listens` tells the two ends apart.
    """

    def __init__(self, key: bytes, *, listens: bool, draw: Callable[[], int]) -> None:
        out, back = (b"from listener", b"to listener") if listens else (b"to listener", b"from listener")
        self._out = hmac.digest(key, out, "sha256")
        self._back = hmac.digest(key, back, "sha256")
        self.id = hmac.digest(key, b"id", "sha256")[:8]
        self.causes: Counter[str] = Counter()  # datagrams that had no effect, by cause
        self._draw = draw
        self._own = draw()
        self._number = 0
        self._processes: OrderedDict[int, _Process] = OrderedDict()

    def hearing(self, now: float) -> list[int]:
        """The processes of the other member that have lately shown that they hear this one."""
        return [p for p, state in self._processes.items() if state.proved and now - state.at <= SILENT_S]

    def hello(self) -> bytes:
        """A datagram for somebody who was not heard yet."""
        return self._sealed(Content(Kind.BEAT), 0, 0)

    def seal(self, content: Content, process: int) -> bytes | None:
        """The datagram of a content for a process heard; None where it would be longer than `SIZE_MAX`."""
        if HEAD_SIZE + len(content.key) + len(content.payload) > SIZE_MAX:
            self.causes["too_long"] += 1
            return None
        state = self._processes.get(process)
        return self._sealed(content, state.challenge, state.answer) if state is not None else None

    def open(self, data: bytes, now: float) -> Opened | Challenge | None:
        """What a datagram says; a challenge where it is not shown to be new; None for a bad one.

        Bad are the damaged, the forged and the repeated: counted by cause.
        """
        if len(data) < HEAD_SIZE or len(data) > SIZE_MAX or data[:4] != _MAGIC:
            self.causes["undecodable"] += 1
            return None
        _, id, process, number, challenge, answer, kind, request, length = _HEAD.unpack_from(data)
        tag = hmac.digest(self._back, data[:-_TAG], "sha256")[:_TAG]
        if id != self.id or not hmac.compare_digest(tag, data[-_TAG:]):
            self.causes["forged"] += 1
            return None
        body = data[_HEAD.size : -_TAG]
        try:
            content = Content(Kind(kind), request, body[:length].decode("ascii"), bytes(body[length:]))
        except ValueError:
            length = len(body) + 1
        if length > len(body):
            self.causes["undecodable"] += 1
            return None
        state = self._state(process, now)
        if answer != state.challenge:
            self.causes["unproved"] += 1
            if not state.proved:
                state.answer = challenge
            return Challenge(self._sealed(Content(Kind.BEAT), state.challenge, challenge))
        if number <= state.number:
            self.causes["repeated"] += 1
            return None
        first = not state.proved
        state.proved, state.number, state.at, state.answer = True, number, now, challenge
        return Opened(content, process, first)

    def _state(self, process: int, now: float) -> _Process:
        state = self._processes.get(process)
        if state is None or now - state.at > SILENT_S:
            state = self._processes[process] = _Process(self._draw(), now)
            if len(self._processes) > PROCESSES_MAX:  # who was heard longest ago
                del self._processes[min(self._processes, key=lambda p: self._processes[p].at)]
        return state

    def _sealed(self, content: Content, challenge: int, answer: int) -> bytes:
        key = content.key.encode("ascii")
        self._number += 1
        head = _HEAD.pack(_MAGIC, self.id, self._own, self._number, challenge, answer,
                          content.kind, content.request, len(key))  # fmt: skip
        data = head + key + content.payload
        return data + hmac.digest(self._out, data, "sha256")[:_TAG]


def key_id(data: bytes) -> bytes:
    """Whose key a datagram was made with, as it says itself; b"" where it is none."""
    return data[4:12] if data[:4] == _MAGIC and len(data) >= HEAD_SIZE else b""
