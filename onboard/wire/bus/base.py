"""What all messages of the bus are made of; see `messages`."""

from __future__ import annotations

import msgspec

Triple = tuple[float, float, float]


class Message(msgspec.Struct, frozen=True, array_like=True):
    """Base of all messages of the bus."""
