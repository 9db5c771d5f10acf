"""The supervisor's one state machine: every decision becomes a setpoint, or a refusal with its cause.

Graver actions take hold at once; milder ones return when the cause has been gone for `settle`
seconds; what is latched stays until control is handed back. The drawing is in docs/safety.md.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.core.math.states import Mate
from onboard.core.math.vectors import ZERO, Vec, add, along, clamp, is_finite, norm, sub
from onboard.core.safety.envelope import believable, bounded, slewed
from onboard.core.safety.fence import Fenced, brake, keep_height, outside_by, turn
from onboard.core.safety.field_profile import keep_layer
from onboard.core.safety.health import HealthAction, health
from onboard.core.safety.policy import Action, Cause, Command, Policy, SupervisorInput
from onboard.core.safety.separation import kept_apart
from onboard.core.safety.zones_ahead import Asked, kept_clear, slowed_before

PROTECTIVE = (
    Cause.FENCE_AHEAD,
    Cause.CEILING_AHEAD,
    Cause.FLOOR_AHEAD,
    Cause.OUTSIDE_FENCE,
    Cause.SEPARATION,
    Cause.LAYER,
    Cause.ZONE_AHEAD,
    Cause.INSIDE_ZONE,
)


FIRST_STEP = 0.05  # [s] for which a velocity is judged that follows no other


class SupervisorState(NamedTuple):
    """The supervisor's memory from step to step."""

    action: Action = Action.PASS  # in force
    cause: Cause = Cause.NONE
    since: float = 0.0  # monotonic [s]
    urged: float = NEVER  # when the action in force was last demanded [s]
    named: float = NEVER  # when the cause in force was last demanded [s]
    floor: Action = Action.PASS  # latched: nothing milder until control is handed back
    floor_cause: Cause = Cause.NONE
    demand: Vec = ZERO  # last setpoint, relative to the air [m/s]
    stamp: float = NEVER  # when that was [s]


class SupervisorOutput(NamedTuple):
    """What becomes of one decision."""

    action: Action
    cause: Cause
    command: Command  # what the adapter is to do
    stream: bool  # whether `ground` goes out; False: hold, return, land or end without it
    ground: Vec  # setpoint [m/s; over ground]; ZERO unless `stream`
    air: Vec  # the same relative to the air [m/s]
    state: SupervisorState
    changed: bool  # a transition happened: publish it
    at: float  # the step that was judged [s, monotonic]: the verdict is good for no other one
    wind: Vec  # that the setpoint reckons with [m/s]


class Allowed(NamedTuple):
    """The nearest allowed velocity, and the rule that changed it."""

    air: Vec  # [m/s; relative to the air]
    cause: Cause


class Flying(NamedTuple):
    """A vehicle as it flies now."""

    now: float  # monotonic [s]
    id: int
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]


class Before(NamedTuple):
    """The last setpoint."""

    demand: Vec  # [m/s; relative to the air]
    stamp: float  # when [s]; NEVER = none


def supervise(wanted: Vec, seen: SupervisorInput, policy: Policy, state: SupervisorState) -> SupervisorOutput:
    """One step: the decision's velocity `wanted` [m/s; relative to the air] through all rules."""
    demand = health(seen, policy, _far_outside(seen, policy))
    allowed = new(Allowed, (ZERO, Cause.NONE))
    wind = ZERO if policy.envelope.hovers or not believable(ZERO, seen.wind) else seen.wind
    if demand.action < Action.HOLD:
        finite = is_finite(wanted)
        if finite:
            age = clamp(seen.telemetry_age, 0.0, policy.telemetry_age)
            flying = new(Flying, (seen.now, seen.id, along(seen.position, seen.velocity, age), seen.velocity))
            before = new(Before, (state.demand, state.stamp))
            allowed = allow(wanted, wind, flying, seen.mates, policy, before)
        if not finite or not is_finite(allowed.air):
            demand = new(HealthAction, (Action.HOLD, Cause.NOT_FINITE, False))
        elif allowed.cause != Cause.NONE:
            demand = new(HealthAction, (Action.CLIP, allowed.cause, False))
    after = advance(state, demand, seen.now, policy.settle)
    changed = after.action != state.action or after.cause != state.cause
    if after.action >= Action.HOLD:
        after = after._replace(demand=ZERO, stamp=NEVER)
        command = commanded(after.action, after.cause, seen.order, policy.envelope.hovers)
        return new(SupervisorOutput, (
            after.action, after.cause, command, False, ZERO, ZERO, after, changed, seen.now, wind
        ))
    after = SupervisorState(*after[:-2], allowed.air, seen.now)
    ground = add(allowed.air, wind)
    command = Command.STREAM
    return new(SupervisorOutput, (
        after.action, after.cause, command, True, ground, allowed.air, after, changed, seen.now, wind
    ))


def reachable(wanted: Vec, seen: SupervisorInput, policy: Policy, state: SupervisorState) -> Vec:
    """What of a wanted velocity [m/s; relative to the air] the vehicle can reach within this step.

    By its turn rate and acceleration alone: a velocity beyond its speeds is left as it is, to `supervise`,
    for which that is a clip, as are fences and mates.
    """
    e = policy.envelope
    wind = ZERO if e.hovers or not believable(ZERO, seen.wind) else seen.wind
    running = follows(seen.now, state.stamp)
    if not is_finite(wanted) or not (running or believable(seen.position, seen.velocity)):
        return wanted
    before = state.demand if running else bounded(sub(seen.velocity, wind), wanted, e).velocity
    if bounded(wanted, before, e).cause != Cause.NONE:
        return wanted
    return slewed(wanted, before, seen.now - state.stamp if running else FIRST_STEP, e).velocity


def follows(now: float, stamp: float) -> bool:
    """Whether there is a last setpoint, of `stamp` [s], from which velocities go on `now` [s]."""
    return 0.0 <= now - stamp <= 1.0


def commanded(action: Action, cause: Cause, order: Action, hovers: bool) -> Command:
    """What the adapter is to do where no decision goes out.

    Against a pilot's hands, and the autopilot's own failsafe, nothing is asked for. An order from the ground
    leaves the guided mode even where a fault ends the stream: of an order and a graver rule that also leaves
    it, the graver one is followed.
    A multicopter's autopilot stops by itself when the stream ends; a plane's flies on: it is left to loiter.
    """
    if cause in (Cause.PILOT, Cause.FAILSAFE):
        return Command.HANDS_OFF
    release = max(order, action) if action < Action.END else order
    if release == Action.LAND:
        return Command.RELEASE_TO_LAND
    if release == Action.RETURN:
        return Command.RELEASE_TO_RETURN
    if release == Action.HOLD:
        released = order >= Action.HOLD or cause == Cause.OVER or not hovers
        return Command.RELEASE_TO_HOLD if released else Command.HOVER
    return Command.END_STREAM if hovers else Command.RELEASE_TO_HOLD


def reordered(state: SupervisorState) -> SupervisorState:
    """The state once another order is given: it need not wait until the last one has settled."""
    return state._replace(urged=NEVER)


def in_another_game(state: SupervisorState) -> SupervisorState:
    """The state once a game with other thresholds begins: what is latched stays, all else begins anew."""
    return SupervisorState(floor=state.floor, floor_cause=state.floor_cause)


def handed_back(state: SupervisorState) -> SupervisorState:
    """The state once pilot or ground give control back: nothing is latched, and nothing need settle."""
    return state._replace(floor=Action.PASS, floor_cause=Cause.NONE, urged=NEVER)


def advance(state: SupervisorState, demand: HealthAction, now: float, settle: float) -> SupervisorState:
    """The state machine alone: what is in force after a demand."""
    floor = state.floor
    floor_cause = state.floor_cause
    if demand.latched and demand.action >= floor:
        floor = demand.action
        floor_cause = demand.cause
    action = demand.action
    cause = demand.cause
    if floor > action:
        action = floor
        cause = floor_cause
    urged = now
    if action < state.action and now - state.urged < settle:
        action = state.action
        cause = state.cause
        urged = state.urged
    named = urged
    other = action == Action.CLIP and state.action == Action.CLIP and cause != state.cause
    graver = cause in PROTECTIVE and state.cause not in PROTECTIVE
    if other and not graver and now - state.named < settle:
        cause = state.cause  # one event for a clip of many reasons, not one a step
        named = state.named
    since = state.since if action == state.action and cause == state.cause else now
    return new(SupervisorState, (
        action, cause, since, urged, named, floor, floor_cause, state.demand, state.stamp
    ))


def allow(
    wanted: Vec, wind: Vec, flying: Flying, mates: tuple[Mate, ...], policy: Policy, last: Before
) -> Allowed:
    """Clip by limits, then give way to team mates, then keep inside the fences: the later rule outranks.

    Kernel style: the compiled games fly by it.
    """
    e = policy.envelope
    position = flying.position
    running = follows(flying.now, last.stamp)
    before = last.demand if running else bounded(sub(flying.velocity, wind), wanted, e).velocity
    dt = flying.now - last.stamp if running else FIRST_STEP
    asked = wanted
    if policy.layered:
        wanted = keep_layer(wanted, position, policy)
    limited = bounded(wanted, before, e)
    cause = limited.cause
    if policy.layered and abs(policy.layer + position.z) > policy.layer_band:
        cause = Cause.LAYER
    slow = slewed(limited.velocity, before, dt, e)
    if cause == Cause.NONE:  # the way to a layer was not asked for: what was asked is judged without it
        judged = slewed(bounded(asked, before, e).velocity, before, dt, e) if policy.layered else slow
        cause = judged.cause
    ground = add(bounded(slow.velocity, before, e).velocity, wind)
    if policy.separation > 0.0:
        apart = kept_apart(ground, position, flying.velocity, flying.id, mates, policy)
        ground = apart.velocity
        if apart.changed:
            cause = Cause.SEPARATION
    answers = policy.reaction + policy.coast
    for fence in policy.fences:
        height = keep_height(ground, position, fence, policy.height_margin, answers, e)
        ground = height.velocity
        if height.cause != Cause.NONE:
            cause = height.cause
    ground = add(bounded(sub(ground, wind), before, e).velocity, wind)
    clear = kept_clear(new(Asked, (ground, position, policy)))
    ground = clear.velocity
    if clear.cause != Cause.NONE:
        cause = clear.cause
    if e.hovers:
        walls = brake(ground, position, policy)
        walls = new(Fenced, (slowed_before(new(Asked, (walls.velocity, position, policy))), walls.cause))
    else:
        walls = turn(ground, position, flying.velocity, norm(wind), policy)
    if walls.cause != Cause.NONE:
        cause = walls.cause
    return new(Allowed, (bounded(sub(walls.velocity, wind), before, e).velocity, cause))


def _far_outside(seen: SupervisorInput, policy: Policy) -> bool:
    if not believable(seen.position, seen.velocity):
        return False
    for fence in policy.fences:  # noqa: SIM110 - a generator costs a call for each
        if outside_by(seen.position, fence) > policy.fence_far:
            return True
    return False
