"""Strategies on real time: the core's own at once, those of other distributions from a child process.

A child that does not answer within 0.1 s, or that ends, is over: the question is answered by its failure,
which makes the supervisor end the stream at once. It is started again a few times, never at once.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from math import inf

import msgspec

from onboard.agent.core.events import Answered, Load, Loaded, Think
from onboard.agent.strategy_process import HEAD, EvaderQuestion, PursuerQuestion, packed
from onboard.agent.thinker import Thinker, is_own
from onboard.config.printable import printable
from onboard.config.undecodable import UNDECODABLE
from onboard.core.game.views import EvaderView
from onboard.pilot.setup import Side
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Clock

ANSWER_S = 0.1  # for an answer
LOAD_S = 10.0  # for loading a strategy
AGAIN_S = 5.0  # from the end of a child to its next start
STARTS_MAX = 4  # of one strategy's child, while the agent lives
MESSAGE_MAX = 65536  # bytes of an answer
ERROR_MAX = 300  # characters of an error

Heard = Callable[[Loaded | Answered], None]


class StrategyChild:
    """One strategy in a process of its own. For the loop's thread alone; nothing here waits."""

    def __init__(self, wanted: Load, heard: Heard, clock: Clock) -> None:
        self.starts = 0
        self._wanted = wanted
        self._heard = heard
        self._clock = clock
        self._process: subprocess.Popen[bytes] | None = None
        self._rest = b""
        self._ready = False  # the strategy is loaded
        self._told = False  # `Loaded` was passed on
        self._asked: tuple[int, int] | None = None  # number of the open question, when it was asked [ns]
        self._limit: asyncio.TimerHandle | None = None
        self._again: asyncio.TimerHandle | None = None
        self._starting: asyncio.Task[None] | None = None
        self._why = ""  # why there is no child
        self._decoder = msgspec.msgpack.Decoder(Loaded | Answered)
        self._start()

    @property
    def pid(self) -> int | None:
        """The child's process id, while there is one."""
        return None if self._process is None else self._process.pid

    def ask(self, question: Think) -> None:
        """Pass a question on; `heard` gets the answer, or the failure within `ANSWER_S`."""
        if self._process is None or not self._ready:
            self._fail(question.number, self._why or "its process is being started")
            return
        view = question.view
        whole = EvaderQuestion if isinstance(view, EvaderView) else PursuerQuestion
        data = packed(whole(question.number, view))  # type: ignore[arg-type]
        self._asked = (question.number, self._clock.monotonic_ns())
        try:
            assert self._process.stdin is not None
            sent = os.write(self._process.stdin.fileno(), data)
        except OSError:
            sent = 0
        if sent < len(data):
            self._over("its process takes no question")
            return
        self._set_limit(ANSWER_S, f"no answer within {ANSWER_S:g} s")

    def close(self) -> None:
        """End the child, and all that it has started, at once; idempotent."""
        if self._again is not None:
            self._again.cancel()
        self.starts = STARTS_MAX
        self._end()

    def _start(self) -> None:
        self._again = None
        self.starts += 1
        self._starting = asyncio.create_task(self._launch(), name="strategy's process")
        self._set_limit(LOAD_S, f"does not load within {LOAD_S:g} s")

    async def _launch(self) -> None:
        """Start the process on a thread: a disk that hangs may hold it up."""
        command = [sys.executable, "-m", "onboard.agent.strategy_process",
                   self._wanted.side.value, self._wanted.strategy]  # fmt: skip
        pipe = subprocess.PIPE

        def start() -> subprocess.Popen[bytes]:
            return subprocess.Popen(
                command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, bufsize=0, start_new_session=True
            )

        try:
            process = await off_loop(start, abandoned=_ended, then=_outlive)
        except OSError as error:
            self._starting = None
            self._over(f"its process does not start: {(error.strerror or str(error)).lower()}")
            return
        self._starting = None
        assert process.stdin is not None
        assert process.stdout is not None
        self._process, self._rest = process, b""
        for end in (process.stdin, process.stdout):
            os.set_blocking(end.fileno(), False)
        asyncio.get_running_loop().add_reader(process.stdout.fileno(), self._readable)

    def _readable(self) -> None:
        process = self._process
        if process is None or process.stdout is None:
            return
        try:
            data = os.read(process.stdout.fileno(), MESSAGE_MAX)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._over("its process has ended")
            return
        self._rest += data
        while len(self._rest) >= HEAD and self._process is process:
            size = int.from_bytes(self._rest[:HEAD], "little")
            if size > MESSAGE_MAX:
                self._over("its process does not keep to the protocol")
                return
            if len(self._rest) < HEAD + size:
                return
            body, self._rest = self._rest[HEAD : HEAD + size], self._rest[HEAD + size :]
            try:
                message = self._decoder.decode(body)
            except (*UNDECODABLE, ValueError):
                self._over("its process does not keep to the protocol")
                return
            self._said(message)

    def _said(self, message: Loaded | Answered) -> None:
        if isinstance(message, Loaded):
            self._set_limit(None, "")
            if message.error:
                self.starts = STARTS_MAX  # what cannot be loaded is not tried again
                self._over(message.error)
            else:
                self._ready, self._why = True, ""
                self._tell_loaded("")
            return
        asked = self._asked
        if asked is None or message.number != asked[0]:
            self._over("its process does not keep to the protocol")
            return
        self._set_limit(None, "")
        self._asked = None
        took = (self._clock.monotonic_ns() - asked[1]) / 1e9  # by the own clock, whatever the child says
        error = printable(message.error)[:ERROR_MAX]
        self._heard(Answered(asked[0], message.decision, error, took))

    def _over(self, why: str) -> None:
        """The child is over: end it, tell it, and start another one later."""
        self._why = printable(why)[:ERROR_MAX]
        self._end()
        if self.starts < STARTS_MAX:
            self._again = asyncio.get_running_loop().call_later(AGAIN_S, self._start)
        asked, self._asked = self._asked, None
        if asked is not None:
            self._fail(asked[0], self._why)
        self._tell_loaded(self._why)

    def _fail(self, number: int, why: str) -> None:
        self._heard(Answered(number, None, f"{self._wanted.strategy}: {why}", inf))

    def _tell_loaded(self, error: str) -> None:
        if not self._told:
            self._told = True
            self._heard(Loaded(self._wanted.strategy, error))

    def _set_limit(self, seconds: float | None, why: str) -> None:
        if self._limit is not None:
            self._limit.cancel()
            self._limit = None
        if seconds is not None:
            self._limit = asyncio.get_running_loop().call_later(seconds, self._over, why)

    def _end(self) -> None:
        self._set_limit(None, "")
        self._ready = False
        if self._starting is not None:
            self._starting.cancel()
            self._starting = None
        process, self._process = self._process, None
        if process is None:
            return
        if process.stdout is not None:
            with contextlib.suppress(ValueError, OSError):
                asyncio.get_running_loop().remove_reader(process.stdout.fileno())
        _ended(process)
        if process.poll() is None:
            asyncio.get_running_loop().call_later(1.0, process.poll)


def _outlive(process: subprocess.Popen[bytes]) -> None:
    """Wait for the end of a process, without reaping it: it is killed when the thread that began it ends."""
    with contextlib.suppress(ChildProcessError):
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)


def _ended(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and all that it has started, and close its pipes."""
    with contextlib.suppress(OSError):
        os.killpg(process.pid, signal.SIGKILL)  # before it is waited for: the number is still its own
    for end in (process.stdin, process.stdout):
        if end is not None:
            end.close()


class ApartThinker:
    """A `Thinker` whose strategies of other distributions answer from child processes."""

    def __init__(self, thinker: Thinker, heard: Heard, clock: Clock) -> None:
        self.children: dict[tuple[Side, str], StrategyChild] = {}
        self._thinker, self._heard, self._clock = thinker, heard, clock

    def load(self, wanted: Load) -> None:
        """Look a strategy up; `heard` gets the result, sooner or later."""
        if is_own(wanted.side, wanted.strategy):
            self._heard(self._thinker.load(wanted))
        elif (wanted.side, wanted.strategy) not in self.children:
            child = StrategyChild(wanted, self._heard, self._clock)
            self.children[wanted.side, wanted.strategy] = child

    def answer(self, question: Think) -> None:
        """Ask a strategy; `heard` gets the answer."""
        child = self.children.get((question.side, question.strategy))
        if child is None:
            self._heard(self._thinker.answer(question))
        else:
            child.ask(question)

    def close(self) -> None:
        """End all children."""
        for child in self.children.values():
            child.close()
