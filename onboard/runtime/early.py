"""Ctrl-C while a program is still importing: one line and exit 130, as later on.

Imports nothing but what the interpreter has loaded anyway: it is the first line of every program.
"""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

INTERRUPTED = 130  # as a shell reports SIGINT
_name = ""
_program = False


def one_line_interrupts(name: str, module: str) -> None:
    """End on ctrl-C with one line, until `onboard.runtime.program.run` takes over.

    `name` is the program's, `module` the caller's `__name__`. Does nothing where the module is only imported,
    or where whoever started the program has it ignore ctrl-C.
    """
    global _name, _program
    _program = started = module == "__main__" or os.path.basename(sys.argv[0]) == name
    if started and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        _name = name
        signal.signal(signal.SIGINT, _end)


def program() -> bool:
    """Whether this process is one of the programs, not one that only imports them."""
    return _program


def take_over() -> None:
    """From here on ctrl-C is a KeyboardInterrupt."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def leave() -> None:
    """From here on, while the interpreter takes itself down, ctrl-C ends it without a word."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def _end(number: int, frame: FrameType | None) -> None:
    try:
        os.write(2, f"{_name}: interrupted\n".encode())
    finally:
        os._exit(INTERRUPTED)
