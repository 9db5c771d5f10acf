"""What msgspec raises for bytes that are not as expected: no UTF-8, nested deep, of another kind."""

from __future__ import annotations

import msgspec

UNDECODABLE = (msgspec.MsgspecError, UnicodeDecodeError, RecursionError)
