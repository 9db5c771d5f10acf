"""PX4 multicopter: OFFBOARD follows velocity and position targets for as long as they stream."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, isfinite

from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot import default_parameters as tables
from sim_bridge.vehicle.autopilot.command import ACCEPTED, DENIED, Command
from sim_bridge.vehicle.autopilot.multicopter import Leg, Multicopter, Speeds
from sim_bridge.vehicle.autopilot.px4 import BY_HAND, M, Px4
from sim_bridge.vehicle.autopilot.resting import AWAKE, FOR_EVER
from sim_bridge.vehicle.motion import Demand

FAR = 1e5  # [m] a take-off to a place beyond this never leaves the ground
STICK_DEAD_ZONE = 0.1  # of the throttle stick's travel, on either side of the middle
SINK_WITHOUT_STICKS = 0.8  # [m/s] in modes flown by hand where nobody does


class Px4Multicopter(Px4, Multicopter):
    """PX4 1.16 on a quadrotor."""

    table = tables.PX4
    starts_by_velocity = True
    armed_text = "Armed by external command"

    def own_parameters(self) -> dict[str, float]:
        fast = self.setup.speed_max
        return {
            "MPC_XY_VEL_MAX": max(12.0, fast),
            "MPC_Z_VEL_MAX_UP": max(3.0, fast),
            "MPC_Z_VEL_MAX_DN": max(1.5, fast),
        }

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        return super()._command_handlers() | {dialect.MAV_CMD_DO_CHANGE_SPEED: self._do_change_speed}

    @property
    def speeds(self) -> Speeds:
        p = self.parameters
        return Speeds(
            p["MPC_XY_CRUISE"],
            min(3.0, p["MPC_Z_VEL_MAX_UP"]),
            min(1.5, p["MPC_Z_VEL_MAX_DN"]),
            p["MPC_LAND_SPEED"],
        )

    @property
    def linger_s(self) -> float:
        return max(0.0, self.parameters["RTL_LAND_DELAY"])

    @property
    def idle_disarm_s(self) -> float:
        return max(0.0, self.parameters["COM_DISARM_PRFLT"])

    def enter(self, now_ns: int, mode: int) -> None:
        if self.landed and mode != M["TAKEOFF"]:
            self.fly(Leg.HOLD, now_ns)
        elif mode == M["RTL"]:
            self.fly_home(now_ns, self.parameters["RTL_RETURN_ALT"])
        elif mode == M["LAND"]:
            self.land_here(now_ns)
        elif mode == M["TAKEOFF"]:
            p, height = self.motion.position, self.parameters["MIS_TAKEOFF_ALT"]
            self.fly(Leg.TAKEOFF, now_ns, Vec(p.x, p.y, min(p.z, self.home_position.z - height)))
        else:
            self.fly(Leg.HOLD, now_ns)

    def taken_off(self, now_ns: int) -> None:
        place = self.target
        self.request_mode(now_ns, M["HOLD"])
        self.target, self._held = place, True

    def go_to(self, now_ns: int, place: Vec) -> None:
        self.fly(Leg.GOTO, now_ns, place)

    def take_off_to(self, now_ns: int, place: Vec) -> None:
        p = self.motion.position
        far = hypot(place.x - p.x, place.y - p.y) > FAR
        self.fly(Leg.HOLD if far else Leg.TAKEOFF, now_ns, place)

    def guide(self, now_ns: int, dt: float) -> Demand:
        if self.is_mode("OFFBOARD"):
            target, velocity, yaw = self._setpoint
            if target is not None:
                self.fly(Leg.GOTO, now_ns, target)
                self.feed_forward = velocity or ZERO
            elif velocity is not None:
                self.fly_velocity(self._clipped(velocity), now_ns, yaw)
        elif self.mode in BY_HAND and not self.landed:
            self._by_hand(now_ns)
        return super().guide(now_ns, dt)

    def steady_until(self, now_ns: int) -> int:
        steady = self.leg == Leg.VELOCITY and self.is_mode("OFFBOARD") and self._setpoint.position is None
        return FOR_EVER if steady else AWAKE

    def _by_hand(self, now_ns: int) -> None:
        """POSCTL and its like: the sticks, or where nobody holds them a slow sinking."""
        throttle = self.transmitter.throttle
        drift = None if self.is_mode("POSCTL") or self.positioned(now_ns) else self.air.wind
        if throttle is None:
            self.fly_by_stick(now_ns, -SINK_WITHOUT_STICKS, drift)
            return
        share = self.transmitter.climb_share(STICK_DEAD_ZONE)
        most = self.speeds.up if share > 0.0 else self.speeds.down
        if share != 0.0 or drift is not None:
            self.fly_by_stick(now_ns, share * most, drift)
        elif self.leg == Leg.STICK:
            self.fly(Leg.HOLD, now_ns)

    def _clipped(self, v: Vec) -> Vec:
        """A velocity within MPC_XY_VEL_MAX and MPC_Z_VEL_MAX_…"""
        p = self.parameters
        most = p["MPC_XY_VEL_MAX"]
        flat = (v.x * v.x + v.y * v.y) ** 0.5
        k = most / flat if flat > most else 1.0
        return Vec(v.x * k, v.y * k, max(-p["MPC_Z_VEL_MAX_UP"], min(p["MPC_Z_VEL_MAX_DN"], v.z)))

    def _do_change_speed(self, now_ns: int, command: Command) -> int:
        if not isfinite(command.p2) or command.p2 <= 0.0:
            return DENIED
        self.parameters.put("MPC_XY_CRUISE", command.p2)
        return ACCEPTED
