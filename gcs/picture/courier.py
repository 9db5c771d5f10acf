"""The courier of the command book: sends the requests that are due and brings the answers."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable

from gcs.picture.command_book import RETRY_NS, CommandBook, Due
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Bus
from onboard.wire.bus.messages import CommandReply
from onboard.wire.bus.topics import COMMAND

REQUEST_TIMEOUT_S = 0.5


class Courier:
    """Carries what the book wants sent, and brings the answers: the thin shell around it."""

    def __init__(
        self,
        bus: Bus,
        game: str,
        book: CommandBook,
        now_ns: Callable[[], int],
        on_reply: Callable[[CommandReply], None],
        on_found: Callable[[str, int], None],
    ) -> None:
        self._bus = bus
        self._game = game
        self._book = book
        self._now_ns = now_ns
        self._on_reply = on_reply
        self._on_found = on_found  # (command id, vehicle that answered a call)
        self._wake = asyncio.Event()
        self.drops: Counter[str] = Counter()

    def wake(self) -> None:
        """Something new is in the book."""
        self._wake.set()

    async def run(self) -> None:
        """Send until cancelled."""
        async with asyncio.TaskGroup() as requests:
            while True:
                if not self._book.busy(self._now_ns()):
                    self._wake.clear()
                    await self._wake.wait()
                for due in self._book.due(self._now_ns()):
                    requests.create_task(self._ask(due))
                await asyncio.sleep(RETRY_NS / NS_PER_S / 4)

    async def _ask(self, due: Due) -> None:
        key = COMMAND.key(self._game, due.id)
        payload = COMMAND.encode(due.command)
        for answer in await self._bus.request(key, payload, REQUEST_TIMEOUT_S):
            reply = COMMAND.decode_reply(answer, self.drops)
            if reply is not None and due.id is None:
                self._on_found(due.command.command_id, reply.id)  # what it says counts under its own key
            elif reply is not None and reply.id == due.id:
                self._on_reply(reply)
