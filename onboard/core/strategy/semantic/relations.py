"""What holds between players, targets and regions: one pure function a relation, one table.

A strength is 0 where a relation does not hold and 1 where it could not hold more; a value is in the unit that
the words say. Kernel style.
"""

from __future__ import annotations

from math import acos, asin, atan2, pi

from onboard.core.geometry.apollonius import disc_margin
from onboard.core.geometry.cones import Seen, blocked_cone
from onboard.core.math.vectors import NORTH, TINY, clamp, distance, dot, sub, unit
from onboard.core.strategy.denial import LATE, spare, stands
from onboard.core.strategy.semantic.graph import NONE, Apply, Held, Node, Relation, Scene
from onboard.core.strategy.team.closure import past, pitch_band, sight_cone
from onboard.core.strategy.team.plan_types import target_at

# Numbers of the table's own relations; those of users are `CUSTOM` and above.
FREE, ENCLOSES, SUFFICES, FLANKS, SLOWER, FASTER, LOST, THREATENS = 1, 2, 3, 4, 5, 6, 7, 8
COVERS, REACHES, DENIES, BLOCKS, HOLDS, INSIDE, CONFINES = 9, 10, 11, 12, 13, 14, 15
CUSTOM = 100


def free(scene: Scene, _evader: int, _band: int) -> Held:
    """The evader has a way out: its width as a share of all headings."""
    if scene.way.closed:
        return NONE
    return Held(max(0.0, scene.way.gap) / (2.0 * pi), max(0.0, scene.way.gap) * 180.0 / pi)


def encloses(scene: Scene, _team: int, _evader: int) -> Held:
    """The team closes the band: 1 less the widest way out as a share of all headings."""
    gap = 0.0 if scene.way.closed else max(0.0, scene.way.gap)
    return Held(1.0 - gap / (2.0 * pi), -scene.way.gap * 180.0 / pi)


def half_closed(scene: Scene, index: int) -> float:
    """Half the heading that a member closes at its distance, were it in the right direction [rad]."""
    s = scene.situation
    steepest = 0.0
    if not s.rules.planar:
        band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
        steepest = max(band.pitch_max, -band.pitch_min)
    own = s.team[index].vehicle
    far = max(distance(own.position, s.evader.position), TINY)
    half = sight_cone(own.speed / max(s.evader.speed, TINY), steepest)
    return clamp(half + asin(clamp(s.rules.R / far, 0.0, 1.0)), 0.0, pi)


def suffices(scene: Scene, _team: int, _evader: int) -> Held:
    """Those who can still meet the evader could close the band, each in the right direction: Σ halves ≥ π.

    Who would not meet it before the horizon though both flew at each other counts for nothing.
    """
    s = scene.situation
    left = s.rules.horizon - max(0.0, s.now - s.t0)
    total = 0.0
    for i in range(len(s.team)):
        own = s.team[i].vehicle
        meets = distance(own.position, s.evader.position) / max(own.speed + s.evader.speed, TINY)
        if s.team[i].fit and meets <= left:
            total += half_closed(scene, i)
    return Held(clamp(total / pi - 1.0, 0.0, 1.0), (total - pi) * 180.0 / pi)


def flanks(scene: Scene, index: int, _band: int) -> Held:
    """The pursuer is one of the two beside the widest way out."""
    if scene.way.closed or not scene.situation.team[index].fit:
        return NONE
    if index == scene.way.left or index == scene.way.right:
        return Held(1.0, max(0.0, scene.way.gap) * 180.0 / pi)
    return NONE


def slower(scene: Scene, index: int, _evader: int) -> Held:
    """The pursuer is slower than the evader, by this share of its speed."""
    gamma = scene.situation.team[index].vehicle.speed / max(scene.situation.evader.speed, TINY)
    return Held(max(0.0, 1.0 - gamma), gamma)


def faster(scene: Scene, index: int, _evader: int) -> Held:
    """The pursuer is faster than the evader: by this share of its own speed."""
    gamma = scene.situation.team[index].vehicle.speed / max(scene.situation.evader.speed, TINY)
    return Held(1.0 - 1.0 / gamma, gamma) if gamma > 1.0 else NONE


def lost(scene: Scene, index: int, _team: int) -> Held:
    """Nothing is heard of the pursuer, or it cannot fly on."""
    return NONE if scene.situation.team[index].fit else Held(1.0, 0.0)


def threatens(scene: Scene, _evader: int, target: int) -> Held:
    """The evader can be at the target before the horizon: the share of the time that is left it has over."""
    s = scene.situation
    far = distance(s.evader.position, target_at(s, target).position) - s.rules.epsilon_min
    time = max(0.0, far) / max(s.evader.speed, TINY)
    left = s.rules.horizon - max(0.0, s.now - s.t0)
    if time >= left:
        return NONE
    return Held(1.0 - time / left, time)


def kept_as_point(scene: Scene, index: int) -> bool:
    """Whether who stands on a target, or orbits it, keeps it: the evader has to come within R.

    Else a target is the disc of radius ε_min, and the whole of it must be kept.
    """
    rules = scene.situation.rules
    return rules.epsilon_min <= rules.R or not stands(scene.situation.team[index].limits)


def covers(scene: Scene, index: int, target: int) -> Held:
    """The pursuer is at the target before the evader: the share of the evader's time that it has over."""
    s = scene.situation
    member, place = s.team[index], target_at(s, target).position
    far = distance(s.evader.position, place)
    its = far / max(s.evader.speed, TINY)
    if not member.fit or its <= TINY:
        return NONE
    own = member.vehicle
    over = spare(own, s.evader, place)
    if not kept_as_point(scene, index):
        e = s.evader
        over = disc_margin(place, s.rules.epsilon_min, own.position, own.speed, e.position, e.speed)
        over /= max(e.speed, TINY)
    return Held(clamp(over / its, 0.0, 1.0), over)


def reaches(scene: Scene, index: int, target: int) -> Held:
    """The pursuer is at the target before the evader or so little after it that going there is worth it."""
    s = scene.situation
    member, place = s.team[index], target_at(s, target).position
    its = distance(s.evader.position, place) / max(s.evader.speed, TINY)
    if not member.fit or its <= TINY:
        return NONE
    over = spare(member.vehicle, s.evader, place)
    return Held(clamp((over + LATE * its) / ((1.0 + LATE) * its), 0.0, 1.0), over)


def denies(scene: Scene, _team: int, target: int) -> Held:
    """The team keeps the target: as strongly as the member that covers it best."""
    best = NONE
    for i in range(len(scene.situation.team)):
        held = covers(scene, i, target)
        if held.strength > best.strength:
            best = held
    return best


def blocks(scene: Scene, index: int, target: int) -> Held:
    """The straight way to the target leads through the pursuer's cone: by the share of its half-angle."""
    s = scene.situation
    if not s.team[index].fit:
        return NONE
    cone = blocked_cone(s.team[index].vehicle, 0, Seen(s.evader.position, s.evader.speed, s.rules.rho))
    if cone.cos < -1.0:
        return Held(1.0, 180.0)
    ahead = unit(sub(target_at(s, target).position, s.evader.position), NORTH)
    half = atan2(cone.sin, cone.cos)
    inside = half - acos(clamp(dot(ahead, cone.axis), -1.0, 1.0))
    return Held(clamp(inside / max(half, TINY), 0.0, 1.0), inside * 180.0 / pi)


def holds(scene: Scene, index: int, target: int) -> Held:
    """All of the target lies in the pursuer's Apollonius region: by the share of the evader's distance."""
    s = scene.situation
    if not s.team[index].fit:
        return NONE
    own, e = s.team[index].vehicle, s.evader
    place = target_at(s, target).position
    margin = disc_margin(place, s.rules.epsilon_min, own.position, own.speed, e.position, e.speed)
    return Held(clamp(margin / max(distance(e.position, place), TINY), 0.0, 1.0), margin)


def inside(scene: Scene, index: int, side: int) -> Held:
    """The pursuer is on the target's safe side, the disc |x − g| ≤ γ |e − g|: the share that it is deep."""
    s = scene.situation
    if not s.team[index].fit:
        return NONE
    own, place = s.team[index].vehicle, target_at(s, side).position
    radius = own.speed / max(s.evader.speed, TINY) * distance(s.evader.position, place)
    deep = radius - distance(own.position, place)
    return Held(clamp(deep / max(radius, TINY), 0.0, 1.0), deep)


def confines(scene: Scene, _fence: int, _evader: int) -> Held:
    """Floor and ceiling take this share of the evader's pitch before it is past the pursuers."""
    s = scene.situation
    if s.rules.planar:
        return NONE
    band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
    whole = s.evader_limits.pitch_max - s.evader_limits.pitch_min
    left = band.pitch_max - band.pitch_min
    if whole <= TINY:
        return NONE
    return Held(clamp(1.0 - left / whole, 0.0, 1.0), left * 180.0 / pi)


def _row(id: int, words: str, source: Node, sink: Node, apply: Apply) -> Relation:
    return Relation(id, apply.__name__, words, source, sink, apply)


RELATIONS: tuple[Relation, ...] = (
    _row(FREE, "{a} has a way out of {value:.0f}°", Node.EVADER, Node.BAND, free),
    _row(ENCLOSES, "{a} encloses {b}", Node.TEAM, Node.EVADER, encloses),
    _row(SUFFICES, "{a} could enclose {b}, with {value:.0f}° over", Node.TEAM, Node.EVADER,
         suffices),
    _row(FLANKS, "{a} is beside {b}", Node.PURSUER, Node.BAND, flanks),
    _row(SLOWER, "{a} is slower than {b}: γ = {value:.2f}", Node.PURSUER, Node.EVADER, slower),
    _row(FASTER, "{a} is faster than {b}: γ = {value:.2f}", Node.PURSUER, Node.EVADER, faster),
    _row(LOST, "{a} is lost to {b}", Node.PURSUER, Node.TEAM, lost),
    _row(THREATENS, "{a} threatens {b}: there in {value:.0f} s", Node.EVADER, Node.TARGET,
         threatens),
    _row(COVERS, "{a} covers {b}: there {value:.1f} s before the evader", Node.PURSUER,
         Node.TARGET, covers),
    _row(REACHES, "{a} reaches {b} {value:+.1f} s before the evader", Node.PURSUER, Node.TARGET,
         reaches),
    _row(DENIES, "{a} denies {b}, {value:.1f} s to spare", Node.TEAM, Node.TARGET, denies),
    _row(BLOCKS, "{a} blocks the straight way to {b}, {value:.0f}° inside its cone", Node.PURSUER,
         Node.TARGET, blocks),
    _row(HOLDS, "{a} holds all of {b}, {value:.0f} m to spare", Node.APOLLONIUS, Node.TARGET,
         holds),
    _row(INSIDE, "{a} is {value:.0f} m inside {b}", Node.PURSUER, Node.SAFE_SIDE, inside),
    _row(CONFINES, "{a} leaves {b} {value:.0f}° of pitch", Node.FENCE, Node.EVADER, confines),
)  # fmt: skip
