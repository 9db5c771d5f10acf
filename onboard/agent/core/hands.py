"""Whose hands a vehicle is in, and what must be said before this agent's may take it."""

from __future__ import annotations

from onboard.agent.config import AgentConfig
from onboard.agent.core.command_book import SETS_OFF, Orders
from onboard.agent.core.part import PartState
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.autopilot.base import Pilot, Stage
from onboard.core.math.constants import NEVER
from onboard.core.safety.policy import Action
from onboard.wire.bus.messages import Command
from onboard.wire.mavlink.modes import Kind

CRITICAL = 5  # MAV_STATE of a vehicle in a failsafe, and of worse
GIVEN_S = 5.0  # so long after control was given back the agent sets off, if the supervisor lets it
ON_GROUND = 1  # MAV_LANDED_STATE
HOMEWARD = frozenset(("RTL", "SMART_RTL", "AUTO_RTL", "LAND", "AUTOLAND", "PRECLAND", "QRTL", "QLAND"))


class Hands:
    """Who gave this process leave to fly its vehicle. Instants are local monotonic seconds."""

    def __init__(self, config: AgentConfig, vehicle: VehicleLink, orders: Orders) -> None:
        self.took = False  # this process has entered the guided mode, or has played
        self._config, self._vehicle, self._orders = config, vehicle, orders
        self._state = PartState()
        self._given_at = NEVER  # when control was given back, and the guided mode is not asked for yet
        self._by_pilot = False  # a pilot's switch gave it to this process

    def follow(self, state: PartState) -> None:
        """Hear where the part stands now."""
        self._state = state

    def give(self, now: float) -> None:
        """Control is given: the guided mode may be asked for, for some seconds."""
        self._given_at = now

    def entered(self) -> None:
        """What was given is used, or withdrawn."""
        self._given_at = NEVER

    def given(self, now: float) -> bool:
        """Whether control was given, and is not taken yet; a pilot's moving sticks end it."""
        if self._flown:
            self._given_at = NEVER
        return now - self._given_at < GIVEN_S

    @property
    def _flown(self) -> bool:
        """Whether a pilot's sticks move a vehicle that this agent does not fly."""
        adapter = self._vehicle.adapter
        ours = self._vehicle.stage not in (Stage.TAKEN, Stage.IDLE)
        return adapter is not None and not ours and adapter.pilot(self._vehicle.now) is Pilot.FLYING

    def taken(self) -> None:
        """Other hands took the vehicle: leave must be given anew."""
        self._given_at, self._by_pilot = NEVER, False
        self._orders.taken()

    def handed_back(self) -> None:
        """A pilot's switch gave the vehicle."""
        adapter = self._vehicle.adapter
        self._by_pilot = self._by_pilot or (adapter is not None and adapter.handed)
        self._orders.handed_back()

    @property
    def trusted(self) -> bool:
        """Whether the configuration lets this process take control of what it began with."""
        return self._config.take_control and not self._state.resumed

    @property
    def leave(self) -> bool:
        """Whether this process may fly the vehicle in the guided mode in which it is.

        A guided mode alone is no leave: a ground station or another companion may have chosen it. Leave is a
        person's word, the pilot's switch, the master that saw this agent in control, or the configuration.
        """
        if self._orders.granted or self._by_pilot:
            return True
        state = self._state
        trusted = self._config.take_control or state.resumed
        return trusted and not state.late and (state.engaged or self.took)

    @property
    def may_control(self) -> bool:
        """Whether this agent may enter the guided mode, by a person's word since its start or by itself.

        By itself it ends neither a way home nor a failsafe, takes nothing from moving sticks, and where it
        was started while the game runs it enters nothing: then it flies a vehicle that it finds in the guided
        mode.
        """
        t, orders = self._vehicle.telemetry, self._orders
        bound = t.mode in HOMEWARD or t.status >= CRITICAL
        let = orders.granted or (self.trusted and not bound)
        return let and not (orders.blocked or self._flown)

    def objection(self, now: float, command: Command) -> str:
        """Why the hands that fly now stand against a command; "" where they do not.

        From a pilot who holds his sticks nothing is taken: he gives it. Who takes a vehicle out of a way
        home, a landing or a failsafe must have named it alone and seen its mode: one word to all does not do.
        What this agent was ordered itself it may be ordered out of.
        """
        t, vehicle = self._vehicle.telemetry, self._vehicle
        adapter = vehicle.adapter
        taken = vehicle.stage is Stage.TAKEN
        pilot = Pilot.NONE if adapter is None else adapter.pilot(now)
        ours = vehicle.stage not in (Stage.TAKEN, Stage.IDLE)
        if command.kind not in SETS_OFF:
            flown = taken or (not ours and pilot is Pilot.FLYING)
            return self.whose(f"it, in {t.mode}") if flown else ""
        if not t.armed and not self._config.may_arm:
            where = "stands on the ground" if t.landed_state == ON_GROUND else "is not armed"
            return f"it {where}, disarmed: arm it and bring it up first, or let the agent (may_arm)"
        at_rest = not (taken or self._state.late)  # before a game resting sticks may be taken over
        if not ours and (pilot is Pilot.FLYING or (pilot is Pilot.PRESENT and not at_rest)):
            px4 = t.kind in (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)  # no OFFBOARD without targets
            way = "HOLD, and then `resume`" if px4 or adapter is None else adapter.guided_mode
            return f"a pilot with live sticks flies it, in {t.mode}: he gives it over by choosing {way}"
        failsafe = t.status >= CRITICAL or vehicle.by_failsafe
        bound = failsafe or (t.mode in HOMEWARD and self._orders.order is Action.PASS)
        if not bound or command.mode == t.mode:
            return ""
        why = f"{t.mode}, by a failsafe" if failsafe else t.mode
        shown = f" (it was shown in {command.mode})" if command.mode else ""
        return f"it is in {why}{shown}: resume this vehicle alone, by its id"

    def whose(self, what: str) -> str:
        """Who flies a vehicle that was taken: in words."""
        return f"{'its own failsafe' if self._vehicle.by_failsafe else 'a pilot'} flies {what}"
