"""The pursuers' rules (3.4.2, and those of the earlier paper [37]) and their tables.

The pursuers know the evader's direction (2.2). "Moving away" is cos φ ≤ 0.
"""

from __future__ import annotations

from math import atan2, cos, sin, sqrt

from onboard.core.game.views import PursuerView
from onboard.core.geometry.apollonius import closest_approach, intercept
from onboard.core.geometry.free_ray import within
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.each import new
from onboard.core.math.vectors import TINY, Vec, add, along, cross, distance, dot, scale, sub, unit
from onboard.core.strategy.denial import hold_line, keep_goal
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent

NAVIGATION_GAIN = 3.0  # N of proportional navigation
TURNING = 1.0  # [s] of turning that a decision of parallel pursuit reckons with


def heading_for(view: PursuerView, aim: Vec, rule: RuleId, time: float, miss: float) -> Decision:
    """The decision to head for `aim` [m; NED], within the limits; there after `time` [s], `miss` [m] away."""
    (x, y, z), _velocity, speed = view.own
    x = aim.x - x
    y = aim.y - y
    z = aim.z - z
    far = sqrt(x * x + y * y + z * z)
    k = 1.0 / far if far > TINY else 0.0
    ahead = view.heading if far <= TINY else new(Vec, (x * k, y * k, z * k))
    return new(Decision, (True, within(ahead, view.limits, view.rules.planar), speed, rule, aim, time, miss))


def keep_off_mate(view: PursuerView) -> Decision:
    """Figure 8b: a team mate is nearer than the separation: outwards, and past it towards the evader."""
    own = view.own
    if not view.mate.exists:
        return silent(view.heading, own.position)
    apart = sub(own.position, view.mate.position)
    if dot(apart, apart) >= view.rules.separation * view.rules.separation:
        return silent(view.heading, own.position)
    out = unit(apart, view.heading)
    wanted = unit(sub(view.evader.position, own.position), view.heading)
    past = along(wanted, out, -dot(wanted, out))
    ahead = within(unit(add(out, past), out), view.limits, view.rules.planar)
    aim = along(own.position, ahead, view.rules.separation)
    return new(Decision, (True, ahead, own.speed, RuleId.KEEP_OFF_MATE, aim, 0.0, 0.0))


def exact_intercept(view: PursuerView) -> Decision:
    """Rule 4 of 3.4.2: the evader's ray meets the sphere, so to the point of (11)–(12)."""
    place, _velocity, speed = view.evader
    own = view.own
    # "Comes closer" needs no test of its own: a faster evader with cos φ ≤ 0 is never met.
    exists, time, point, _miss = intercept(place, view.heading, speed, own.position, own.speed)
    if not exists:
        return silent(view.heading, place)
    return heading_for(view, point, RuleId.INTERCEPT, time, 0.0)


def greatest_approach(view: PursuerView) -> Decision:
    """Rule 5 of 3.4.2: the evader comes closer but cannot be met, so along (19)–(20)."""
    e = view.evader
    meeting = closest_approach(e.position, view.heading, e.speed, view.own.position, view.own.speed)
    if not meeting.exists:
        return silent(view.heading, e.position)
    return heading_for(view, meeting.point, RuleId.CLOSEST_APPROACH, meeting.time, meeting.miss)


def parallel(view: PursuerView) -> Decision:
    """Rule 6 of 3.4.2: the evader moves away, so parallel to it."""
    own = view.own
    ahead = within(view.heading, view.limits, view.rules.planar)
    aim = along(own.position, ahead, own.speed)
    left = distance(own.position, view.evader.position)
    return new(Decision, (True, ahead, own.speed, RuleId.PARALLEL, aim, 1.0, left))


def predicted_place(view: PursuerView) -> Decision:
    """Rule 6's alternative: the evader moves away, so to the place predicted k steps ahead."""
    if not view.has_prediction:
        return silent(view.heading, view.evader.position)
    left = distance(view.prediction, view.own.position) - view.own.speed * view.control.lookahead
    return heading_for(view, view.prediction, RuleId.PREDICTED_PLACE, view.control.lookahead, max(0.0, left))


def straight_at_evader(view: PursuerView) -> Decision:
    """[37]: no intercept, so straight at the evader."""
    return heading_for(view, view.evader.position, RuleId.STRAIGHT_AT_EVADER, 0.0, 0.0)


def pure_pursuit(view: PursuerView) -> Decision:
    """For comparison: the velocity always points at the evader."""
    return heading_for(view, view.evader.position, RuleId.PURE_PURSUIT, 0.0, 0.0)


def parallel_pursuit(view: PursuerView) -> Decision:
    """Parallel pursuit (constant bearing, [7]): u = v⊥ + ℓ·sqrt(v_p² − |v⊥|²).

    The evader's velocity across the line of sight ℓ is matched, so that the line keeps its direction, and
    what is left of the speed closes along it. Where the evader crosses faster than that, all of it goes
    across. The course changes by no more than the vehicle turns within TURNING.
    """
    own = view.own
    e = view.evader
    motion = scale(view.heading, e.speed)
    ahead = within(lead(own.position, own.speed, e.position, motion), view.limits, view.rules.planar)
    ahead = turned(own.velocity, ahead, view.limits.turn_rate * TURNING)
    sight = unit(sub(e.position, own.position), view.heading)
    rate = own.speed * dot(ahead, sight) - dot(motion, sight)
    far = distance(e.position, own.position)
    time = far / rate if rate > TINY else 0.0
    aim = along(own.position, ahead, own.speed * time)
    return new(Decision, (True, ahead, own.speed, RuleId.PARALLEL_PURSUIT, aim, time, 0.0))


def turned(velocity: Vec, ahead: Vec, most: float) -> Vec:
    """The direction nearest to `ahead` (unit) whose course is at most `most` [rad] from that of a velocity.

    0 or less is no limit, and a vehicle that does not move level has no course.
    """
    level = sqrt(ahead.x * ahead.x + ahead.y * ahead.y)
    if most <= 0.0 or level <= TINY or velocity.x * velocity.x + velocity.y * velocity.y <= TINY:
        return ahead
    course = atan2(velocity.y, velocity.x)
    turn = wrap(atan2(ahead.y, ahead.x) - course)
    if abs(turn) <= most:
        return ahead
    course += most if turn > 0.0 else -most
    return new(Vec, (level * cos(course), level * sin(course), ahead.z))


def proportional_navigation(view: PursuerView) -> Decision:
    """For comparison: the heading turns at N times the rate of the line of sight (true PN, N = 3)."""
    own = view.own
    e = view.evader
    line = sub(e.position, own.position)
    square = dot(line, line)
    sight = unit(line, view.heading)
    ahead = unit(own.velocity, sight)
    if square > TINY * TINY:
        motion = sub(scale(view.heading, e.speed), scale(ahead, own.speed))
        turn = scale(cross(line, motion), NAVIGATION_GAIN * view.control.dt / square)
        ahead = unit(add(ahead, cross(turn, ahead)), ahead)
    ahead = within(ahead, view.limits, view.rules.planar)
    aim = along(own.position, ahead, own.speed)
    return new(Decision, (True, ahead, own.speed, RuleId.PROPORTIONAL_NAVIGATION, aim, 1.0, 0.0))


_KEEP_OFF: Rule[PursuerView] = Rule(
    RuleId.KEEP_OFF_MATE,
    "a team mate is nearer than the separation (off at 0)",
    "outwards, sliding past it towards the evader",
    "Figure 8b",
    Module.INTELLIGENT,
    keep_off_mate,
)
_INTERCEPT: Rule[PursuerView] = Rule(
    RuleId.INTERCEPT,
    "the evader comes closer and its ray meets the Apollonius sphere",
    "to the point of convergence (11)–(12)",
    "3.4.2, rule 4",
    Module.GEOMETRIC,
    exact_intercept,
)
_APPROACH: Rule[PursuerView] = Rule(
    RuleId.CLOSEST_APPROACH,
    "the evader comes closer (cos φ > 0) but its ray misses the sphere",
    "in the direction of the maximum approach (19)–(20)",
    "3.4.2, rule 5",
    Module.GEOMETRIC,
    greatest_approach,
)
_PARALLEL: Rule[PursuerView] = Rule(
    RuleId.PARALLEL,
    "the evader moves away (cos φ ≤ 0)",
    "parallel to the evader",
    "3.4.2, rule 6",
    Module.INTELLIGENT,
    parallel,
)
_PREDICTED: Rule[PursuerView] = Rule(
    RuleId.PREDICTED_PLACE,
    "the evader moves away and a prediction is known",
    "to the place predicted k steps ahead",
    "3.4.2, rule 6, alternative",
    Module.INTELLIGENT,
    predicted_place,
)
_STRAIGHT: Rule[PursuerView] = Rule(
    RuleId.STRAIGHT_AT_EVADER,
    "there is no intercept",
    "straight at the evader",
    "[37]",
    Module.INTELLIGENT,
    straight_at_evader,
)

_PARALLEL_PURSUIT: Rule[PursuerView] = Rule(
    RuleId.PARALLEL_PURSUIT,
    "always",
    "across with the evader, with the rest of the speed along the line of sight",
    "[7], parallel pursuit",
    Module.GEOMETRIC,
    parallel_pursuit,
)
_KEEP_GOAL: Rule[PursuerView] = Rule(
    RuleId.KEEP_GOAL,
    "the target is known, the evader has a free ray, and this pursuer is first at the target",
    "onto the target, or before it in a circle",
    "time to block: |p − g| / v_p ≤ |e − g| / v_e",
    Module.INTELLIGENT,
    keep_goal,
)
_BLOCK: Rule[PursuerView] = Rule(
    RuleId.HOLD_LINE,
    "the target is kept by another, the evader has a free ray, and this pursuer is in time",
    "beside the keeper across the corridor, so near that their cones overlap",
    "time to block; overlap of cones",
    Module.INTELLIGENT,
    hold_line,
)

PURSUER: tuple[Rule[PursuerView], ...] = (_KEEP_OFF, _INTERCEPT, _APPROACH, _PARALLEL)
PURSUER_PREDICTIVE: tuple[Rule[PursuerView], ...] = (_KEEP_OFF, _INTERCEPT, _APPROACH, _PREDICTED, _PARALLEL)
PURSUER_EARLIER: tuple[Rule[PursuerView], ...] = (_KEEP_OFF, _INTERCEPT, _STRAIGHT)
PURSUER_PARALLEL: tuple[Rule[PursuerView], ...] = (_KEEP_OFF, _PARALLEL_PURSUIT)
PURSUER_KEEPER: tuple[Rule[PursuerView], ...] = (
    _KEEP_OFF,
    _KEEP_GOAL,
    _INTERCEPT,
    _APPROACH,
    _PARALLEL_PURSUIT,
)
PURSUER_LINE: tuple[Rule[PursuerView], ...] = (
    _KEEP_OFF,
    _KEEP_GOAL,
    _BLOCK,
    _INTERCEPT,
    _APPROACH,
    _PARALLEL_PURSUIT,
)


def _comparison(rule: RuleId, then: str, apply: object) -> tuple[Rule[PursuerView], ...]:
    return (_KEEP_OFF, Rule(rule, "always", then, "for comparison", Module.GEOMETRIC, apply))  # type: ignore[arg-type]


PURE = _comparison(RuleId.PURE_PURSUIT, "straight at the evader", pure_pursuit)
NAVIGATION = _comparison(
    RuleId.PROPORTIONAL_NAVIGATION, "turn at N times the sight line's rate", proportional_navigation
)

pursuer = fold(PURSUER)
pursuer_predictive = fold(PURSUER_PREDICTIVE)
pursuer_earlier = fold(PURSUER_EARLIER)
pursuer_pure = fold(PURE)
pursuer_parallel = fold(PURSUER_PARALLEL)
pursuer_keeper = fold(PURSUER_KEEPER)
pursuer_line = fold(PURSUER_LINE)
pursuer_navigation = fold(NAVIGATION)
