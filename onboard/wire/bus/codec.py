"""Encodes and decodes one type of message: MessagePack of the pair [SCHEMA, message]."""

from __future__ import annotations

from collections import Counter
from typing import Generic, TypeVar

import msgspec

from onboard.config.undecodable import UNDECODABLE
from onboard.wire.bus.messages import SCHEMA, Message
from onboard.wire.finite import finite_check

M = TypeVar("M", bound=Message)


class Codec(Generic[M]):
    """Encodes and decodes one type of message. A bad payload gives None and is counted by its cause.

    The causes: `undecodable`, `schema` (of another version), `not_finite` (a number is NaN or infinite).
    A payload that several hear in one process, the same object, is decoded once: messages do not change.
    """

    def __init__(self, kind: type[M]) -> None:
        self._decoder = msgspec.msgpack.Decoder(tuple[int, kind])  # type: ignore[valid-type]
        self._version = msgspec.msgpack.Decoder(tuple[int, msgspec.Raw])
        self._finite = finite_check(kind)
        self._encoder = msgspec.msgpack.Encoder()
        self._latest: tuple[bytes, M] | None = None  # the last good payload and what it says

    def encode(self, message: M) -> bytes:
        """The payload of a message."""
        return self._encoder.encode((SCHEMA, message))

    def decode(self, payload: bytes, drops: Counter[str]) -> M | None:
        """The message of a payload; None (and one more in `drops`) for a bad one."""
        latest = self._latest
        if latest is not None and latest[0] is payload:
            return latest[1]
        try:
            version, message = self._decoder.decode(payload)
        except UNDECODABLE:
            drops["schema" if self._other_version(payload) else "undecodable"] += 1
            return None
        if version != SCHEMA:
            drops["schema"] += 1
            return None
        if not self._finite(message):
            drops["not_finite"] += 1
            return None
        if type(payload) is bytes:  # which cannot change
            self._latest = payload, message
        return message

    def _other_version(self, payload: bytes) -> bool:
        try:
            version, _ = self._version.decode(payload)
        except UNDECODABLE:
            return False
        return version != SCHEMA
