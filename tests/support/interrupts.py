"""Ctrl-C for the programs that tests start."""

from __future__ import annotations

import signal


def hear_interrupts() -> None:
    """Hear ctrl-C from here on: a background job of a shell ignores it, and all that it starts would, too."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
