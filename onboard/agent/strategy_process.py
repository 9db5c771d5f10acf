"""The process in which a strategy of another distribution answers, fed through two pipes.

It may exit, loop, eat memory or fork: all that is lost is its answer. What it prints goes nowhere; its
memory, files and children are bounded; and it dies with the agent.

    python -m onboard.agent.strategy_process pursuer NAME
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import signal
import sys
from pathlib import Path

import msgspec

from onboard.agent.core.events import Answered, Load, Loaded, Think
from onboard.agent.thinker import Thinker
from onboard.core.game.views import EvaderView, PursuerView
from onboard.pilot.setup import Side
from onboard.runtime.clock import RealClock

MEMORY = 2 << 30  # bytes of address space
FILES = 64  # descriptors
FILE_SIZE = 64 << 20  # bytes that one file may grow to
HEAD = 4  # bytes of a message's length, little-endian
NICE = 5  # the agent's loop goes first
_PR_SET_PDEATHSIG = 1


class EvaderQuestion(msgspec.Struct, frozen=True, array_like=True):
    """A `Think` for the evader."""

    number: int
    view: EvaderView


class PursuerQuestion(msgspec.Struct, frozen=True, array_like=True):
    """A `Think` for a pursuer."""

    number: int
    view: PursuerView


Question = EvaderQuestion | PursuerQuestion


def packed(message: msgspec.Struct) -> bytes:
    """A message as it goes through a pipe."""
    body = msgspec.msgpack.encode(message)
    return len(body).to_bytes(HEAD, "little") + body


def bound() -> None:
    """Bound what this process may use, and let it die with its parent."""
    for what, most in (
        (resource.RLIMIT_AS, MEMORY),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NOFILE, FILES),
        (resource.RLIMIT_FSIZE, FILE_SIZE),
    ):
        with contextlib.suppress(OSError, ValueError):  # a limit that is lower already stays
            resource.setrlimit(what, (most, most))
    with contextlib.suppress(OSError):
        os.nice(NICE)
    with contextlib.suppress(OSError):  # where memory runs out, this process is ended first
        Path("/proc/self/oom_score_adj").write_text("1000", encoding="ascii")
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)


def serve(side: Side, strategy: str, source: int, sink: int) -> None:
    """Load a strategy, say how that went, and answer questions until `source` (a descriptor) ends."""
    thinker = Thinker(RealClock())
    loaded: Loaded = thinker.load(Load(side, strategy))
    _write(sink, packed(loaded))
    if loaded.error:
        return
    with contextlib.suppress(OSError, ValueError):  # whoever is root is not bound by this one
        resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))
    kind = EvaderQuestion if side is Side.EVADER else PursuerQuestion
    decoder: msgspec.msgpack.Decoder[Question] = msgspec.msgpack.Decoder(kind)
    while head := _read(source, HEAD):
        question = decoder.decode(_read(source, int.from_bytes(head, "little")))
        answer: Answered = thinker.answer(Think(question.number, side, strategy, question.view))
        _write(sink, packed(answer))


def main() -> None:
    """Run as a process: its standard input and output are the pipes, and the strategy sees neither."""
    bound()
    source, sink = os.dup(0), os.dup(1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nowhere, number)
    serve(Side(sys.argv[1]), sys.argv[2], source, sink)


def _read(source: int, size: int) -> bytes:
    """Exactly `size` bytes; empty at the end."""
    data = b""
    while len(data) < size:
        piece = os.read(source, size - len(data))
        if not piece:
            return b""
        data += piece
    return data


def _write(sink: int, data: bytes) -> None:
    while data:
        data = data[os.write(sink, data) :]


if __name__ == "__main__":
    with contextlib.suppress(BrokenPipeError, KeyboardInterrupt):
        main()
