"""Requests for modes that are on their way: whose answer an answer is, and which change of mode is our own.

An autopilot may answer after seconds, and then obeys an older request after a newer one (recorded: 0.4 to
3 s). Its answer names the command alone, so answers belong to the oldest open request.
"""

from __future__ import annotations

LATE = 3.5  # [s] after which a request is not obeyed any more
MOST = 64  # requests remembered
SMOOTH = 0.5  # weight of a new round trip that is shorter than known


class AnswerTimes:
    """How long an autopilot takes to answer commands of any kind. Instants are local monotonic seconds."""

    def __init__(self) -> None:
        self._open: dict[int, list[float]] = {}  # command → when it was sent, the oldest first

    def sent(self, now: float, command: int) -> None:
        """Hear that a command goes out."""
        times = self._open.setdefault(command, [])
        times.append(now)
        del times[:-MOST]

    def answered(self, now: float, command: int) -> float:
        """Hear an answer; return how long it took [s], 0.0 where no command is known that it answers."""
        times = [at for at in self._open.get(command, ()) if now - at <= LATE]
        self._open[command] = times[1:]
        return now - times[0] if times else 0.0


class _Request:
    def __init__(self, at: float, mode: str) -> None:
        self.at, self.mode = at, mode
        self.open = True  # not answered


class ModeRequests:
    """The requests of the last seconds. Instants are local monotonic seconds."""

    def __init__(self) -> None:
        self.round_trip = 0.0  # [s] from a request to its answer, as lately measured; 0: not measured
        self._requests: list[_Request] = []
        self._shown = ""  # the mode last reported

    def learn(self, took: float) -> None:
        """Hear how long the answer to another command took [s]: modes are not asked for faster than that."""
        self.round_trip = max(self.round_trip, min(took, LATE))

    def sent(self, now: float, mode: str) -> None:
        """Hear that a mode is asked for."""
        self._forget(now)
        self._requests.append(_Request(now, mode))
        del self._requests[:-MOST]

    def answered(self, now: float, *, accepted: bool) -> str:
        """Hear an answer; return the mode whose request it answers, "" for none that is known."""
        self._forget(now)
        for request in self._requests:
            if request.open:
                took = now - request.at
                longer = took > self.round_trip
                self.round_trip = took if longer else self.round_trip + SMOOTH * (took - self.round_trip)
                request.open = False
                if not accepted:
                    self._requests.remove(request)
                return request.mode
        return ""

    def echoed(self, now: float, mode: str, *, wanted: bool) -> bool:
        """Hear a reported mode; return whether a request of ours explains that it is new.

        Where it is `wanted` its first request is done, and repetitions without an answer may yet be obeyed.
        Otherwise all of them explain this one change: a second one into the same mode is somebody else's.
        """
        self._forget(now)
        if mode == self._shown:
            return False
        self._shown = mode
        own = [request for request in self._requests if request.mode == mode]
        done = [one for one in own if not one.open] or own[:1] if wanted else own
        self._requests = [request for request in self._requests if request not in done]
        return bool(own)

    def _forget(self, now: float) -> None:
        self._requests = [request for request in self._requests if now - request.at <= LATE]
