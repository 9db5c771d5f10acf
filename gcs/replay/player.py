"""Plays a recording: the recorded stream through the same reducer as live, so the same picture and alerts.

A plain class: real time comes in through `advance`. Pause, speed, seek and step change nothing about
what is seen at an instant of the recording.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator

from gcs.picture.reducer import GRID_NS, PictureReducer
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Picture
from gcs.recording.reader import Entry, Recording
from onboard.core.math.constants import NS_PER_S

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)
CHECKPOINT_NS = 2 * NS_PER_S  # a jump plays at most so much again
CHECKPOINTS = 400  # at most, however long the recording


class Player:
    """A recording with a place in it. It begins at the first message, playing, at speed 1.

    `limits` and `version` as the live station had them: they decide about alerts.
    """

    def __init__(self, recording: Recording, limits: Thresholds | None = None, version: str = "") -> None:
        self.recording = recording
        self.paused = False
        self.speed = 1.0
        self._new = PictureReducer(recording.game, limits, version)
        self._every_ns = max(CHECKPOINT_NS, (recording.end_ns - recording.start_ns) // CHECKPOINTS)
        self.checkpoints: list[tuple[int, bytes]] = []  # by place, rising: copies, as bytes that unpack fast
        self._remainder = 0.0  # [ns] of recorded time not yet played
        self._place(recording.start_ns - 1, pickle.dumps(self._new))
        self._run_to(recording.start_ns)

    @property
    def start_ns(self) -> int:
        """Where the recording begins."""
        return self.recording.start_ns

    @property
    def end_ns(self) -> int:
        """Where it ends."""
        return self.recording.end_ns

    @property
    def at_ns(self) -> int:
        """The instant that is shown."""
        return self._at_ns

    @property
    def ended(self) -> bool:
        """Whether the end is shown."""
        return self._at_ns >= self.end_ns

    def advance(self, elapsed_ns: int) -> None:
        """Let real time pass; at the end the recording pauses."""
        if self.paused or elapsed_ns <= 0:
            return
        self._remainder += elapsed_ns * self.speed
        whole = int(self._remainder)
        self._remainder -= whole
        self._run_to(min(self._at_ns + whole, self.end_ns))
        self.paused = self.paused or self.ended

    def pause(self, paused: bool = True) -> None:
        """Pause or go on; going on at the end begins anew."""
        self.paused = paused
        if not paused and self.ended:
            self.seek(self.start_ns)

    def faster(self, steps: int = 1) -> float:
        """The next speed up (down where `steps` is negative); the new speed."""
        nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - self.speed))
        self.speed = SPEEDS[max(0, min(len(SPEEDS) - 1, nearest + steps))]
        return self.speed

    def seek(self, at_ns: int) -> None:
        """Go to an instant (the nearest there is), from the checkpoint before it."""
        at_ns = max(self.start_ns, min(at_ns, self.end_ns))
        self._remainder = 0.0
        place_ns, reducer = self.start_ns - 1, b""
        for checkpoint_ns, saved in self.checkpoints:
            if checkpoint_ns <= at_ns:
                place_ns, reducer = checkpoint_ns, saved
        if at_ns < self._at_ns or place_ns > self._at_ns:
            self._place(place_ns, reducer or pickle.dumps(self._new))
        self._run_to(at_ns)

    def index(self, told: Callable[[float, Picture], None] = lambda share, picture: None) -> Picture:
        """Play through once, so that every later jump is a short one; the picture at the end, then back.

        `told` is called each second of the recording with the share that is done and the picture there.
        """
        back_ns, length_ns = self._at_ns, max(1, self.end_ns - self.start_ns)
        while not self.ended:
            self._run_to(min(self._at_ns + NS_PER_S, self.end_ns))
            told((self._at_ns - self.start_ns) / length_ns, self.picture())
        last = self.picture()
        self.seek(back_ns)
        return last

    def step(self, steps: int = 1) -> None:
        """Pause, and move by steps of 0.1 s: the grid on which alerts are judged."""
        self.paused = True
        self.seek((self._at_ns // GRID_NS + steps) * GRID_NS)

    def picture(self) -> Picture:
        """The picture at the instant shown: what the live station showed then."""
        return self._reducer.picture(self._at_ns)

    def _place(self, at_ns: int, packed: bytes) -> None:
        """Stand at `at_ns`, which the packed reducer has seen all of."""
        self._at_ns = at_ns
        self._reducer: PictureReducer = pickle.loads(packed)
        self._ahead: Iterator[Entry] = self.recording.entries(at_ns + 1)
        self._next: Entry | None = next(self._ahead, None)

    def _run_to(self, at_ns: int) -> None:
        while self._next is not None and self._next.stamp_ns <= at_ns:
            self._save(self._next.stamp_ns)
            self._reducer.apply(*self._next)
            self._next = next(self._ahead, None)
        self._reducer.tick(at_ns)
        self._at_ns = at_ns

    def _save(self, next_ns: int) -> None:
        """Keep a checkpoint before the message of `next_ns` where the last one is long ago."""
        last_ns = self.checkpoints[-1][0] if self.checkpoints else self.start_ns
        if next_ns - last_ns > self._every_ns:
            self.checkpoints.append((next_ns - 1, pickle.dumps(self._reducer)))
