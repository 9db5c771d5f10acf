"""Text from the network on a terminal."""

from __future__ import annotations

from onboard.config.printable import printable

__all__ = ["printable"]
