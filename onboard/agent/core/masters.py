"""Whom an agent follows: one master at a time, by its lease; the clocks of two masters are never compared.

The first whose word is heard leads. Another one leads only after its lease has ended; in a running game only
if, moreover, a person took the game over by the old master's name.
"""

from __future__ import annotations

from collections import OrderedDict
from enum import Enum

from onboard.core.math.constants import NEVER
from onboard.wire.bus.messages import Master

MASTERS_MAX = 8
LEASE_LEAST_S, LEASE_MOST_S = 0.1, 60.0
QUOTED_S = 5.0  # an order that sets off may quote what the master said so long ago
WORDS_KEPT = 64  # of the leader's: more than are said in that time

Who = tuple[str, int]  # name and nonce of a master's process


class Hearing(Enum):
    """What a master's word means; the value says it of the master, before the leader's name."""

    LEADS = "is"
    SECOND_MASTER = "says that it is the master, and so does"
    NOT_TAKEN_OVER = "says that it is the master, but nobody has taken over the running game of"
    OVERFLOW = "is one of too many beside"


class Words:
    """Numbered words of one sender, and when each was first heard (or said) by the agent's own clock."""

    def __init__(self) -> None:
        self._at: OrderedDict[tuple[int, int], float] = OrderedDict()

    def add(self, nonce: int, number: int, now: float) -> None:
        """A word was heard, or said, at `now` [s, monotonic]; heard again it is not newer."""
        self._at.setdefault((nonce, number), now)
        while len(self._at) > WORDS_KEPT:
            self._at.popitem(last=False)

    @property
    def last(self) -> tuple[int, int] | None:
        """Nonce and number of the newest word; None where there is none."""
        return next(reversed(self._at), None)

    def until(self, nonce: int, number: int) -> float:
        """Until when that word may be quoted [s, monotonic]: `QUOTED_S` after it was heard (or said)."""
        return self._at.get((nonce, number), NEVER) + QUOTED_S


def certified(name: str, member: str) -> bool:
    """Whether a master of this name may be the member of a field who alone may write as the master.

    A name is the member's, or `MEMBER/…` where the program adds which process it is. "" = any may.
    """
    return not member or name.partition("/")[0] == member


class Masters:
    """Leases of masters, in the order in which they began. Instants are the agent's own [s, monotonic]."""

    def __init__(self) -> None:
        self.leader: Who | None = None
        self.game_runs = False  # the leader's last phase is a running game
        self._leases: OrderedDict[Who, float] = OrderedDict()  # until when
        self._words = Words()

    @property
    def name(self) -> str:
        """The leader's name; "nobody" where none was heard."""
        return "nobody" if self.leader is None else self.leader[0]

    def holds(self, now: float) -> bool:
        """Whether the leader's lease still runs."""
        return self.leader is not None and self._leases.get(self.leader, NEVER) >= now

    @property
    def last(self) -> tuple[int, int] | None:
        """Nonce and number of the leader's newest word; None where nobody leads."""
        return self._words.last

    def hear(self, master: Master, now: float) -> Hearing:
        """Take a master's word at `now`."""
        who = (master.name, master.nonce)
        for other in [other for other, until in self._leases.items() if until < now]:
            del self._leases[other]
        if who not in self._leases and len(self._leases) >= MASTERS_MAX:
            return Hearing.OVERFLOW
        lease = min(max(master.lease_s, LEASE_LEAST_S), LEASE_MOST_S)
        first = next(iter(self._leases), who)
        if who != self.leader:
            if self.leader is not None and self.game_runs and master.takes_over != self.leader[0]:
                return Hearing.NOT_TAKEN_OVER
            if self.holds(now) or first != who:
                self._leases[who] = now + lease
                return Hearing.SECOND_MASTER
            self.leader, self.game_runs = who, False
            self._words = Words()
        self._leases[who] = now + lease
        self._words.add(master.nonce, master.number, now)
        return Hearing.LEADS

    def quoted_until(self, nonce: int, number: int) -> float:
        """Until when that word of the leader may be quoted [s, monotonic]."""
        return self._words.until(nonce, number)
