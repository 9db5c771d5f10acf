"""A vehicle that flies what the supervisor lets through."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, pi, sin

from onboard.core.math.vectors import ZERO, Vec, add, norm, sub
from onboard.core.safety.policy import Envelope, Fence, Policy, SupervisorInput
from onboard.core.safety.supervisor import SupervisorOutput, SupervisorState, handed_back, supervise

DT = 0.05
SQUARE = Fence(((-100.0, -100.0), (100.0, -100.0), (100.0, 100.0), (-100.0, 100.0)), 10.0, 60.0)
FIELD = Fence(
    ((-1500.0, -1500.0), (1500.0, -1500.0), (1500.0, 1500.0), (-1500.0, 1500.0)), 50.0, 300.0
)  # for planes
COPTER = Policy(Envelope(speed_max=5.0), fences=(SQUARE,))
PLANE = Policy(
    Envelope(
        hovers=False, speed_min=15.0, speed_max=25.0, climb_max=4.0, sink_max=4.0, turn_rate=0.6,
        acceleration=3.0, deceleration=1.0, turn_radius=80.0,
    ),
    fences=(FIELD,),
    fence_margin=20.0,
)


class SupervisedVehicle:
    """A point vehicle under supervision: braking, or turning, as its envelope says."""

    def __init__(self, policy: Policy, position: Vec, velocity: Vec = ZERO, wind: Vec = ZERO) -> None:
        self.policy = policy
        self.seen = SupervisorInput(now=100.0, id=2, position=position, velocity=velocity, wind=wind)
        self.state = SupervisorState()
        self.transitions: list[tuple[str, str]] = []
        self.verdict: SupervisorOutput | None = None

    def step(self, wanted: Vec, **what: object) -> SupervisorOutput:
        """One control step: supervise, then move for 50 ms."""
        self.seen = self.seen._replace(**what)  # type: ignore[arg-type]
        verdict = supervise(wanted, self.seen, self.policy, self.state)
        self.state = verdict.state
        self.verdict = verdict
        if verdict.changed:
            self.transitions.append((verdict.action.name, verdict.cause.name))
        velocity = self._answer(verdict)
        position = add(self.seen.position, Vec(velocity.x * DT, velocity.y * DT, velocity.z * DT))
        self.seen = self.seen._replace(now=self.seen.now + DT, position=position, velocity=velocity)
        return verdict

    def hand_back(self) -> None:
        """Pilot or ground give control back."""
        self.state = handed_back(self.state)

    def fly(self, seconds: float, wanted: Vec | Callable[[float], Vec], **what: object) -> SupervisorOutput:
        """Let time pass."""
        verdict = None
        for n in range(round(seconds / DT)):
            verdict = self.step(wanted(n * DT) if callable(wanted) else wanted, **what)
            if verdict.stream:
                assert_within(verdict, self.policy)
        assert verdict is not None
        return verdict

    def _answer(self, verdict: SupervisorOutput) -> Vec:
        e = self.policy.envelope
        ground = verdict.ground if verdict.stream else ZERO
        if e.hovers:
            gap = sub(ground, self.seen.velocity)
            most = 4.0 * DT  # brakes twice as hard as the supervisor counts on
            k = min(1.0, most / max(norm(gap), 1e-9))
            return add(self.seen.velocity, Vec(gap.x * k, gap.y * k, gap.z * k))
        air = sub(self.seen.velocity, self.seen.wind)
        speed = max(e.speed_min, min(e.speed_max, norm(air)))
        heading = atan2(air.y, air.x)
        if verdict.stream:
            turn = atan2(verdict.air.y, verdict.air.x) - heading
            turn = (turn + pi) % (2.0 * pi) - pi
            most = speed / e.turn_radius * DT
            heading += max(-most, min(most, turn))
            speed += max(-1.0 * DT, min(1.0 * DT, norm(verdict.air) - speed))
        z = air.z + max(-2.0 * DT, min(2.0 * DT, (verdict.air.z if verdict.stream else 0.0) - air.z))
        return add(Vec(speed * cos(heading), speed * sin(heading), z), self.seen.wind)


def assert_within(verdict: SupervisorOutput, policy: Policy) -> None:
    """The setpoint keeps the limits of speed and climb."""
    e = policy.envelope
    assert norm(verdict.air) <= e.speed_max * (1.0 + 1e-6)
    assert norm(verdict.air) >= e.speed_min * (1.0 - 1e-6)
    assert -e.climb_max - 1e-6 <= verdict.air.z <= e.sink_max + 1e-6
