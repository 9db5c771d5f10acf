"""An adapter is the machine of modes and an encoder of setpoints: this joins the two."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple, Protocol

from onboard.autopilot.base import Note, Pilot, ReleaseMode, Setpoint, Stage, Step, Telemetry
from onboard.autopilot.mode_machine import ModeMachine, ModeStep
from onboard.autopilot.pilot_hands import flown_by_hand, live
from onboard.autopilot.release_modes import Release, chain, positioned
from onboard.core.math.each import new
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, Target
from onboard.wire.mavlink.ids import MessageId
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.values import CommandAck

LARGEST = 1e38  # a number beyond it does not fit a 32-bit float of MAVLink
FAULTS = {
    "not_finite": "a setpoint that is no number was not sent",
    "no_direction": "a plane cannot stand still: give no setpoint, or leave to loiter",
}


class Traits(NamedTuple):
    """What an encoder says of itself."""

    name: str  # in configuration: a key of `choose.SCHEMES`
    kind: Kind  # the autopilot it is made for
    guided_mode: str  # the mode in which setpoints count, in the autopilot's words
    hold_mode: str = ""  # the mode to hold in that is configured; "": as `release_modes` says
    holds_airspeed: bool = False  # a constant speed means airspeed


class SetpointEncoder(Protocol):
    """Setpoints → messages, for one way of flying one kind of autopilot."""

    @property
    def traits(self) -> Traits:
        """What it is made for."""
        ...

    def ready(self, now: float) -> bool:
        """Return whether the guided mode may be asked for: PX4 wants to see setpoints before."""
        ...

    def sends_in(self, stage: Stage) -> bool:
        """Return whether setpoints are sent in a stage."""
        ...

    def fault(self, setpoint: Setpoint) -> str:
        """Return the key into `FAULTS` of what is wrong with a setpoint; "" where nothing is."""
        ...

    def encode(self, now: float, telemetry: Telemetry, setpoint: Setpoint) -> list[Outgoing]:
        """Return the messages that are due for a setpoint without fault."""
        ...

    def acknowledge(self, ack: CommandAck) -> list[Note]:
        """Hear the answer to a command; return what a person should know of it."""
        ...

    def restart(self) -> None:
        """Hear that the stream of setpoints has ended: the next one begins a new stream."""
        ...


class GuidedAdapter:
    """See `base.Adapter`."""

    def __init__(
        self,
        to: Target,
        encoder: SetpointEncoder,
        *,
        may_arm: bool = False,
        parameters: Mapping[str, float] = MappingProxyType({}),
    ) -> None:
        """`parameters` are the autopilot's as far as read: what is read later is seen when it counts."""
        traits = encoder.traits
        self.name = traits.name
        self.kind = traits.kind
        self.guided_mode = traits.guided_mode
        self.holds_airspeed = traits.holds_airspeed
        self._to = to
        self._encoder = encoder
        self._machine = ModeMachine(to.system, traits.guided_mode, may_arm=may_arm)
        self._release = Release(traits.kind, parameters, to.system, traits.hold_mode)
        self._telemetry = Telemetry()  # of the last step
        self._told = False  # to leave, since then
        self._notes: list[Note] = []
        self._fault = ""  # of the newest setpoint

    @property
    def stage(self) -> Stage:
        """Who flies."""
        return self._machine.stage

    @property
    def failsafe(self) -> bool:
        """Whether the autopilot's own failsafe took it."""
        return self._machine.failsafe

    @property
    def handed(self) -> bool:
        """Whether the pilot's switch chose the guided mode."""
        return self._machine.handed

    def pilot(self, now: float) -> Pilot:
        """Whether a pilot flies by his sticks."""
        hands = self._machine.hands
        if not flown_by_hand(self._telemetry) or not live(
            now, self._telemetry, self._release.parameters, hands
        ):
            return Pilot.NONE
        return Pilot.FLYING if hands.moving(now) else Pilot.PRESENT

    def enter(self, now: float) -> None:
        """Ask for the guided mode; give setpoints meanwhile (zero to hover)."""
        self._machine.enter()

    def leave(self, now: float, mode: ReleaseMode) -> None:
        """End the setpoints; ask for a mode that the autopilot holds alone."""
        self._machine.leave(mode, chain(mode, now, self._telemetry, self._release))
        self._told = True

    def _see(self, now: float, telemetry: Telemetry) -> None:
        """Take what is known now: where it is left to is chosen in its light, for a fix may just be lost."""
        self._telemetry = telemetry
        told, self._told = self._told, False
        if self._machine.stage is Stage.LEAVING and (told or not positioned(telemetry)):
            self._machine.choose_among(chain(self._machine.leaving_by, now, telemetry, self._release))

    def forget(self, now: float) -> None:
        """Ask for the guided mode, and for arming, no more."""
        self._machine.give_up()

    def end(self, now: float) -> None:
        """End the stream: the next setpoint begins a new one."""
        self._encoder.restart()

    def arm(self, now: float) -> bool:
        """Ask for arming, if made with `may_arm`."""
        return self._machine.arm()

    def close(self) -> None:
        """Nothing to release."""

    def answers_in(self, took: float) -> None:
        """Hear how long the autopilot took to answer another command [s]."""
        self._machine.answers_in(took)

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear the answer to a command."""
        self._machine.acknowledge(now, ack)
        self._notes += self._encoder.acknowledge(ack)

    def step(self, now: float, telemetry: Telemetry, setpoint: Setpoint | None) -> Step:
        """Return mode commands that are due, and the setpoint's messages where setpoints count."""
        self._see(now, telemetry)
        asked = self._machine.step(now, telemetry, ready=self._encoder.ready(now))
        messages = [*self._mode_messages(asked), *self._arming(asked)]
        notes = [*asked.notes, *self._notes]
        self._notes = []
        sound = self._sound(setpoint, notes)
        if sound is not None:
            messages += self._encoder.encode(now, telemetry, sound)
        return new(Step, (tuple(messages), tuple(notes)))

    def _sound(self, setpoint: Setpoint | None, notes: list[Note]) -> Setpoint | None:
        """The setpoint, if it may be sent now; a fault is told once, until another setpoint."""
        if setpoint is None or not self._encoder.sends_in(self._machine.stage):
            return None
        fault = self._encoder.fault(setpoint)
        if fault and fault != self._fault:
            notes.append(Note("error", fault, FAULTS[fault]))
        self._fault = fault
        return None if fault else setpoint

    def _mode_messages(self, asked: ModeStep) -> list[Outgoing]:
        messages: list[Outgoing] = []
        if asked.mode:
            number, px4 = MODES[self.kind][asked.mode], self.kind in (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)
            command = commands.set_mode(self._to, number, px4=px4)
            messages.append(command._replace(confirmation=asked.mode_tries - 1))
        if asked.prove:
            messages.append(commands.request_message(self._to, MessageId.HEARTBEAT))
        return messages

    def _arming(self, asked: ModeStep) -> list[Outgoing]:
        if not asked.arm_tries:
            return []
        return [commands.arm(self._to)._replace(confirmation=asked.arm_tries - 1)]
