"""What is asked before an order that ends a flight is given: the same for the console and the page. Pure."""

from __future__ import annotations

from gcs.console.command_parser import Do, Order, names
from gcs.picture.command_book import ENDS_A_FLIGHT
from gcs.picture.values import Picture
from onboard.core.math.constants import NS_PER_S

CONFIRM_S = 8.0  # how long a question waits for its answer


class Questions:
    """One person's open question: an order, or leaving. At most one is open."""

    def __init__(self) -> None:
        self.asked: Order | Do | None = None
        self._asked_ns = 0

    def put(self, order: Order, picture: Picture) -> str:
        """"" where the order is to be given now, else the question that is now open.

        Only orders that end a flight are asked about; the same one again is a yes.
        """
        again, self.asked = self.asked == order, None
        if again or order.kind not in ENDS_A_FLIGHT:
            return ""
        self.ask(order, picture.now_ns)
        return f"{order.kind.value} {names(order.ids, picture)}?"

    def ask(self, what: Order | Do, now_ns: int) -> None:
        """Open a question about this."""
        self.asked, self._asked_ns = what, now_ns

    def yes(self) -> Order | Do | None:
        """What was asked about, now to be done; None where nothing was."""
        asked, self.asked = self.asked, None
        return asked

    def no(self) -> bool:
        """Close the question; whether one was open."""
        asked, self.asked = self.asked, None
        return asked is not None

    def lapsed(self, now_ns: int) -> bool:
        """Whether the open question has waited too long; it is closed then."""
        late = self.asked is not None and now_ns - self._asked_ns > CONFIRM_S * NS_PER_S
        return late and self.no()
