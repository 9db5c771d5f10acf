"""Figure 8b's choice inside pursuit: (30) or (31), by the situation. Kernel style.

Strategy 2 (31) heads for where the evader's ray of this moment meets the own sphere, anew at every
decision. Strategy 1 (30) corrects towards a fixed control point at its time: here the meeting point that
(31) found last, a point of the moving air. The paper lets the intelligent module choose "in unstable
conditions ... in accordance with the current situation": while gusts carry the vehicle off the speed that
it orders, and as long as the new meeting point lies close to the old one, what moves it is disturbance, and
the point is kept; once the evader has really turned, or the meeting is near, it is found anew.
"""

from __future__ import annotations

from onboard.core.game.views import Held, PursuerView
from onboard.core.geometry.apollonius import closest_approach, intercept
from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, along, distance, norm
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent
from onboard.core.strategy.pursuit import PURSUER, heading_for

UNSTEADY = 2.0  # [m/s] between flown and ordered airspeed, above which conditions are unstable
STEADY = 1.0  # [m/s] below which they are calm again
STRAY = 0.05  # of the distance, by which the meeting point may have moved: 3° of course
NEAR = 3.5  # [s] before a meeting it is found anew at every decision


def held_after(rule: int, aim: Vec, time: float, since: float, wind: Vec) -> Held:
    """What a decision leaves to the next one: `since` [s] ago it headed for `aim` [m; NED], there after
    `time` [s]; the `wind` [m/s] has carried that point on."""
    corrected = rule == RuleId.POINT_BY_POINT
    exists = corrected or rule == RuleId.INTERCEPT or rule == RuleId.CLOSEST_APPROACH
    return new(Held, (exists, corrected, along(aim, wind, since), time - since))


def point_by_point(view: PursuerView) -> Decision:
    """(30): conditions are unstable and the evader flies on as it did, so to the point held."""
    held = view.held
    own = view.own
    e = view.evader
    if not held.exists or held.left < NEAR:
        return silent(view.heading, e.position)
    exists, _time, point, _miss = intercept(e.position, view.heading, e.speed, own.position, own.speed)
    if not exists:
        meeting = closest_approach(e.position, view.heading, e.speed, own.position, own.speed)
        if not meeting.exists:
            return silent(view.heading, e.position)
        point = meeting.point
    if distance(held.place, point) > STRAY * distance(point, own.position):
        return silent(view.heading, e.position)
    off = abs(norm(own.velocity) - own.speed)
    if off < STEADY or (off < UNSTEADY and not held.corrected):
        return silent(view.heading, e.position)
    return heading_for(view, held.place, RuleId.POINT_BY_POINT, held.left, 0.0)


POINT_BY_POINT: Rule[PursuerView] = Rule(
    RuleId.POINT_BY_POINT,
    f"the airspeed is more than {UNSTEADY:g} m/s off the ordered (until less than {STEADY:g}), the last "
    f"meeting point within {STRAY:g} of its distance of the new one and due in {NEAR:g} s or later",
    "(30): to the last meeting point at its time; else (31), a new one",
    "Figure 8b, 3.6 (30)",
    Module.INTELLIGENT,
    point_by_point,
)

PURSUER_CHOOSING: tuple[Rule[PursuerView], ...] = (PURSUER[0], POINT_BY_POINT, *PURSUER[1:])
pursuer_choosing = fold(PURSUER_CHOOSING)
