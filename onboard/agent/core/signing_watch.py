"""Whether the frames that arrive and the key that is set fit, in words: for the check and the running agent.

An autopilot that wants signatures ignores what comes without, and says nothing: its silence looks like a slow
link, or like a wrong system id. What arrives tells.
"""

from __future__ import annotations

from onboard.agent.core.journal import Journal
from onboard.agent.core.mavlink_radio import Radio
from onboard.core.math.constants import NEVER

SIGNING_REMEDY = "set [signing] key to the key of this vehicle's autopilot"
HEARD_S = 2.5  # [s] after which an autopilot that beats once a second is not heard
MANY = 5  # frames that do not fit, before they are a cause
WITHOUT_KEY = "its frames are signed and no key is set: what is sent to it unsigned may be ignored"
MISFITS = {
    "signature_wrong": "frames arrive signed with another key than the one that is set: none of them counts",
    "signature_unsigned": "frames arrive unsigned while a key is set: none of them counts",
    "signature_stale": "signatures arrive that are older than a minute: the clocks of both sides differ",
    "signature_future": "signatures arrive from the future: the clocks of both sides differ",
    "signature_replayed": "signatures arrive that came before: a clock fell back, or somebody repeats frames",
}


class SigningWatch:
    """Looks at what a radio counts."""

    def __init__(self, radio: Radio) -> None:
        self._radio = radio
        self._before: dict[str, int] = {}
        self._told = ""

    def trouble(self, now: float, heartbeat_at: float) -> str:
        """Return why frames that came since the last look do not fit the key, or ""; instants in [s]."""
        causes = self._radio.causes
        new = {
            cause: causes[cause] - self._before.get(cause, 0) for cause in ("signed_without_key", *MISFITS)
        }
        if not self._radio.signed:
            found = WITHOUT_KEY if new["signed_without_key"] else ""
        elif heartbeat_at != NEVER and now - heartbeat_at <= HEARD_S:
            found = ""  # the autopilot is heard: somebody else's frames do not fit
        else:
            most = max(MISFITS, key=lambda cause: new[cause])
            found = MISFITS[most] if new[most] >= MANY else ""
            if not found and any(new[cause] for cause in MISFITS):
                return self._told
        self._before.update({cause: causes[cause] for cause in new})
        return found

    def tell(self, now: float, heartbeat_at: float, journal: Journal) -> None:
        """Say what is wrong, once."""
        found = self.trouble(now, heartbeat_at)
        if found and found != self._told:
            journal.error("signing", f"{found}: {SIGNING_REMEDY}")
            self._told = found
