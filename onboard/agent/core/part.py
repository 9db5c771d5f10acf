"""What a part to be played is: a vehicle's share in a game, or a route to be followed."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from onboard.agent.core.events import Instant
from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Policy
from onboard.core.strategy.knowledge import Decision
from onboard.pilot.pilot import PilotDecision, Question
from onboard.pilot.setup import Own, Side


class PartState(NamedTuple):
    """Where a part stands at one moment."""

    engaged: bool = False  # there is something to fly
    near: bool = False  # it is about to begin, or on: control should be taken
    on: bool = False  # it is on: the vehicle is flown by decisions
    late: bool = False  # it runs without this vehicle until the master lets it act
    over: bool = False  # it has ended
    resumed: bool = False  # the master alone let this process in: it flies what it finds guided, no more


class Way(NamedTuple):
    """How to fly to the place where a part begins."""

    velocity: Vec  # [m/s]; a multicopter's over ground, a plane's through the air
    heading: float | None  # [rad] where a multicopter looks; None: any


class Part(Protocol):
    """One thing that an agent can do with its vehicle."""

    side: Side
    policy: Policy  # of the supervisor, for this part
    strategy: str  # name of the strategy that answers questions

    def follow(self, now: Instant) -> None:
        """Take in what bus and vehicle have told since the last control step."""
        ...

    def let_in(self) -> None:
        """A person lets this process act."""
        ...

    def withdraw(self) -> None:
        """The person's word that let it in came to nothing: all is as it was before."""
        ...

    def state(self, wall_ns: int) -> PartState:
        """Where the part stands."""
        ...

    def approach(self, now: Instant, own: Own) -> Way | None:
        """How to fly to the place where the part begins; None where there is none, or no instant for it."""
        ...

    def place_s(self, now: Instant) -> float:
        """Time that the vehicle needs to that place [s]; once its instant is fixed, by which it is late."""
        ...

    def ask(self, now: Instant, own: Own) -> Question | PilotDecision:
        """What the strategy is to be asked; or a decision, where none needs to be asked.

        May fail in any way."""
        ...

    def conclude(self, question: Question, decision: Decision) -> PilotDecision:
        """What the strategy's answer means."""
        ...

    def obstacles(self, now: float) -> tuple[Mate, ...]:
        """What the supervisor keeps off beside team mates, at `now` [s, monotonic]."""
        ...

    def lacks(self, now: Instant) -> tuple[str, ...]:
        """What is missing before the part can begin, in words a person can act on."""
        ...

    def time(self, wall_ns: int) -> float:
        """Seconds since the part began; 0 before."""
        ...

    def train(self, wall_ns: int) -> None:
        """Spend a little time on learning."""
        ...
