"""From configuration and setup to the supervisor's policy and the strategy's limits."""

from __future__ import annotations

from math import asin, inf, nan, pi, radians, sin, tan

from onboard.agent.config import POLICY_ALONE, POLICY_KEYS, AgentConfig
from onboard.autopilot.flight_limits import FlightLimits
from onboard.config.derive import core_from
from onboard.core.game.rules import NO_TARGET, Control, Target
from onboard.core.geometry.zones import NO_ZONES
from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.core.safety.fence import fits
from onboard.core.safety.field_profile import capture_in_space_refused, field_policy, layers
from onboard.core.safety.policy import Envelope, Fence, Policy
from onboard.pilot.setup import GameSetup, Goals, Player, Side
from onboard.wire.bus.messages import EvaderTargets, Member, Role, Setup
from onboard.wire.bus.zone_messages import core_zones, no_zone

Places = tuple[Vec, ...]  # [m; NED]

_DEFAULT = Policy()
GROUND = 1.0  # [m] above the origin; a start below it is one on the ground
COAST = 3.0  # [s] GUID_TIMEOUT as ArduCopter has it
SAME = 0.02  # of a speed by which two count as alike
UNKNOWN_LIMITS = FlightLimits()  # of an autopilot that has not said any


def envelope_of(
    config: AgentConfig, member: Member | None, hovers: bool, own: FlightLimits = UNKNOWN_LIMITS
) -> Envelope:
    """What the vehicle may be asked to do: the configuration's word, else the setup's, else caution.

    Where the autopilot's own limits are tighter, they count.
    """
    e = config.envelope
    declared_max = member.speed if member is not None and member.speed > 0.0 else 10.0
    speed_max = e.speed_max if e.speed_max is not None else declared_max
    limits = member.limits if member is not None else VehicleLimits(pitch_min=-pi / 6, pitch_max=pi / 6)
    speed_min = e.speed_min if e.speed_min is not None else limits.speed_min
    speed_max = _least(speed_max, own.speed_max)
    speed_min = speed_min if own.speed_min is None else max(speed_min, own.speed_min)
    if own.cruise is not None and not hovers:
        speed_min = speed_max = own.cruise
    up, down = limits.pitch_max, -limits.pitch_min
    climb = e.climb_max if e.climb_max is not None else max(0.5, speed_max * sin(max(0.0, up)))
    sink = e.sink_max if e.sink_max is not None else max(0.5, speed_max * sin(max(0.0, down)))
    climb, sink = _least(climb, own.climb_max), _least(sink, own.sink_max)
    bank = _least(radians(e.bank_max_deg), own.bank_max)
    turn = radians(e.turn_rate_deg) if e.turn_rate_deg is not None else 0.0
    if turn == 0.0:
        turn = limits.turn_rate
    coordinated = STANDARD_GRAVITY * tan(bank) / max(speed_max, 1.0)
    if turn <= 0.0:
        turn = coordinated
    radius = e.turn_radius if e.turn_radius is not None else speed_max / max(1e-3, min(turn, coordinated))
    lean = STANDARD_GRAVITY * tan(own.bank_max) if hovers and own.bank_max is not None else inf
    return Envelope(
        hovers=hovers,
        speed_min=0.0 if hovers else min(speed_min, speed_max),
        speed_max=speed_max,
        climb_max=climb,
        sink_max=sink,
        turn_rate=turn,
        acceleration=min(e.acceleration, lean),
        deceleration=min(e.deceleration, lean),
        turn_radius=radius,
    )


def _coast(hovers: bool, own: FlightLimits) -> float:
    """For how long a dead agent's last velocity is flown on [s]; unknown counts as ArduCopter's default."""
    if not hovers:
        return 0.0  # a plane flies on until its failsafe, whatever was asked last: its rule is the circle
    return COAST if own.coast is None else own.coast


def _least(value: float, own: float | None) -> float:
    return value if own is None else min(value, own)


def policy_of(
    config: AgentConfig, setup: Setup | None, hovers: bool, own: FlightLimits = UNKNOWN_LIMITS
) -> Policy:
    """The supervisor's policy in a game (or with none)."""
    s = config.safety
    member = member_of(setup, config.id)
    fences: list[Fence] = []
    if s.fence is not None:
        fences.append(Fence(s.fence.polygon, s.fence.height_min, s.fence.height_max))
    if setup is not None and setup.fence is not None:
        fences.append(Fence(setup.fence.polygon, setup.fence.altitude_min, setup.fence.altitude_max))
    separation = setup.rules.separation if setup is not None else 0.0
    if s.separation is not None:
        separation = s.separation
    given = {name: getattr(_DEFAULT, name) for name in POLICY_ALONE} | {
        "envelope": envelope_of(config, member, hovers, own),
        "fences": tuple(fences),
        "zones": core_zones(setup.zones) if setup is not None else NO_ZONES,
        "separation": separation,
        "coast": _coast(hovers, own),
        "heartbeat_alone": max(s.heartbeat_age_s, s.heartbeat_alone_s),
        "track_action": s.track_action.action(),
        "ground_action": s.ground_action.action(),
    }
    policy = core_from(s, Policy, POLICY_KEYS, **given)
    if setup is not None and setup.field_profile and member is not None:
        starts = (-one.start[2] for one in setup.roster)
        heights = layers(tuple(up if up >= GROUND else config.take_off_height for up in starts))
        place = next(index for index, one in enumerate(setup.roster) if one.id == config.id)
        policy = field_policy(policy, heights[place])
    return policy


def member_of(setup: Setup | None, id: int) -> Member | None:
    """The roster's entry of a vehicle."""
    return next((one for one in setup.roster if one.id == id), None) if setup is not None else None


def contradiction(
    config: AgentConfig, setup: Setup, hovers: bool | None, own: FlightLimits = UNKNOWN_LIMITS
) -> str:
    """Why this agent cannot play a setup, in words; '' if it can. `hovers` None: no autopilot known yet."""
    if setup.game != config.game:
        return f"the setup is of game '{setup.game}', this agent plays '{config.game}'"
    ids = [one.id for one in setup.roster]
    if len(set(ids)) != len(ids):
        return "two vehicles of the roster have one id"
    member = member_of(setup, config.id)
    if member is None:
        return f"vehicle {config.id} is not in the roster"
    if member.role is not config.role:
        return f"the setup says {member.role.value}, the configuration says {config.role.value}"
    rules = setup.rules
    if not rules.R > 0.0 or rules.rho < rules.R:
        return f"R = {rules.R:g} m and ρ = {rules.rho:g} m do not fit"
    if found := no_zone(setup.zones):
        return found
    if setup.fence is not None and (
        len(setup.fence.polygon) < 3 or setup.fence.altitude_min >= setup.fence.altitude_max
    ):
        return "the fence is no area"
    most, least = config.envelope.speed_max, config.envelope.speed_min
    if most is not None and member.speed > most:
        return f"the setup wants {member.speed:g} m/s, this vehicle is configured for {most:g} m/s"
    if least is not None and member.speed < least:
        return f"the setup wants {member.speed:g} m/s, this vehicle flies at least {least:g} m/s"
    if hovers is False and own.speed_min is not None and member.speed < own.speed_min:
        return f"the setup wants {member.speed:g} m/s, the autopilot flies at least {own.speed_min:g} m/s"
    if hovers is False and own.speed_max is not None and member.speed > own.speed_max:
        return f"the setup wants {member.speed:g} m/s, the autopilot flies at most {own.speed_max:g} m/s"
    if hovers is False and own.cruise is not None and abs(member.speed - own.cruise) > SAME * own.cruise:
        return (
            f"the setup wants {member.speed:g} m/s, and the autopilot flies {own.cruise:g} m/s whatever is "
            "asked (FW_AIRSPD_TRIM): make the two alike"
        )
    if config.field and not setup.flat and capture_in_space_refused(rules.R, setup.track_sigma):
        return (
            f"capture in space with R = {rules.R:g} m and a stated position error of "
            f"{setup.track_sigma:g} m: R must be five times as large, or the setup use the field profile"
        )
    if hovers is False:
        policy = policy_of(config, setup, False, own)
        e = policy.envelope
        if not all(fits(fence, e, policy.fence_margin, 0.2 * e.speed_max) for fence in policy.fences):
            return f"the fence leaves no room to turn with a radius of {e.turn_radius:.0f} m"
    return ""


def game_setup(
    config: AgentConfig, setup: Setup, targets: Places, hovers: bool, own: FlightLimits = UNKNOWN_LIMITS
) -> GameSetup:
    """The game as the pilot is told it. Climb limits of the own vehicle narrow its pitch band.

    `targets` are the evader's by its brief; a pursuer knows targets from the setup, where the rules say so.
    """
    envelope = envelope_of(config, member_of(setup, config.id), hovers, own)
    players: list[Player] = []
    for member in setup.roster:
        if member.role is Role.TRACKER:
            continue
        limits = member.limits.core()
        if member.id == config.id and member.speed > 0.0:
            high = asin(min(1.0, envelope.climb_max / member.speed))
            low = -asin(min(1.0, envelope.sink_max / member.speed))
            limits = limits._replace(
                pitch_min=max(limits.pitch_min, low), pitch_max=min(limits.pitch_max, high)
            )
        side = Side.EVADER if member.role is Role.EVADER else Side.PURSUER
        height = -member.start[2]
        if height < GROUND:  # a ground start: who does not take off was given no height, and keeps its own
            height = config.take_off_height if config.may_arm else nan
        players.append(Player(member.id, side, member.speed, limits, height))
    game = GameSetup(
        roster=tuple(players),
        rules=setup.core_rules()._replace(planar=setup.flat),
        control=Control(1.0 / config.control_rate_hz, config.lookahead_s),
    )
    if config.role is not Role.PURSUER:
        return game.with_targets(config.id, targets)
    if not setup.rules.target_known:
        return game
    only = NO_TARGET if setup.target is None else Target(True, Vec(*setup.target))
    return game._replace(target=only, goals=tuple(goals_of(one) for one in setup.targets))


def goals_of(told: EvaderTargets) -> Goals:
    """One evader's targets as the pilot is told them."""
    return Goals(told.id, tuple(Target(True, Vec(*place)) for place in told.targets))


def only_limits(before: Policy, after: Policy) -> bool:
    """Whether a policy differs from another in the vehicle's own limits alone."""
    return before.envelope != after.envelope and before._replace(envelope=after.envelope) == after
