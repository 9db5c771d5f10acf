"""The core's assessment of each evader's situation, from what the picture knows.

Every evader sees all pursuers, so its band is that between the cones of all of them. The bound on the number
and the odds are of a game against one evader: of several they are told of those who are after it.
"""

from __future__ import annotations

from msgspec.structs import astuple

from gcs.picture.several import evaders_of
from gcs.picture.values import AssessmentView, GameView, Presence, ProspectView, TrackView, VehicleView
from onboard.core.game.rules import NO_TARGET, Target, goal_disc
from onboard.core.geometry import assessment
from onboard.core.geometry.apollonius import in_time
from onboard.core.geometry.assessment import NO_GOAL, Goal
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec, direction, distance, scale, sub
from onboard.core.strategy.registry import DEFAULT
from onboard.core.strategy.team.plan_types import Heights, Member, Situation
from onboard.game.odds import engagement, headline, odds, one_each
from onboard.wire.bus.messages import Member as Declared
from onboard.wire.bus.messages import Role, Setup

MOST_IN_SPACE = 12  # pursuers: the largest free cap costs their number to the fourth power
MOST_OF_EACH = 8  # pursuers in space, where there are several evaders
MOST_JUDGED = 8  # evaders
OLD_S = 2.0  # positions older than this are no ground for a judgement
SEVERAL = "no odds: whom each pursuer is after is not told"
Players = tuple[Vehicle, list[tuple[int, Vehicle]]]  # an evader; the pursuers with their ids


def assess(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...]
) -> tuple[AssessmentView, ...]:
    """The assessments of the evaders that are in the game; none while they or all pursuers are unknown.

    An evader's own state counts, and its track where there is none; speeds are the declared ones. In
    space only the nearest pursuers are judged.
    """
    setup = game.setup
    if setup is None:
        return ()
    everybody = evaders_of(setup)
    found = []
    for evader in [id for id in everybody if not _out(game, id)][:MOST_JUDGED]:
        known = players(game, vehicles, tracks, evader)
        if known is not None:
            found.append(_assessed(game, evader, known, alone=len(everybody) == 1))
    return tuple(found)


def _out(game: GameView, evader: int) -> bool:
    """Whether of several evaders this one is out of the game."""
    fate = game.fate_of(evader)
    return fate is not None and fate.out and len(evaders_of(game.setup)) > 1


def _assessed(game: GameView, id: int, known: Players, alone: bool) -> AssessmentView:
    assert game.setup is not None
    rules = game.setup.rules
    evader, pursuers = known
    most = MOST_IN_SPACE if alone else MOST_OF_EACH
    many = not rules.planar and len(pursuers) > most
    if many:
        place = evader.position
        pursuers = sorted(pursuers, key=lambda p: distance(p[1].position, place))[:most]
    goal = _nearest(game.targets_of(id), evader.position)
    found = assessment.assess(
        evader, tuple(vehicle for _, vehicle in pursuers), rules.rho,
        NO_GOAL if goal is None else Goal(True, goal, goal_disc(game.setup.core_rules())), rules.planar,
    )  # fmt: skip
    word, why, captured = _odds(game, id, known, alone, many)
    return AssessmentView(
        evader=id,
        encircled=found.encircled,
        gaps=tuple((gap.start, gap.width) for gap in found.gaps),
        largest_gap=found.largest_gap if rules.planar else found.cap.radius * 2.0,
        target_denied=found.target_denied and _all_denied(game, id, known),
        prospects=tuple(
            ProspectView(id=i, intercepts=p.intercepts, time_s=p.time, denies_target=p.denies_target)
            for (i, _), p in zip(pursuers, found.prospects, strict=True)
        ),
        captured=captured,
        word=word,
        why=why,
        alone=alone,
    )


def _all_denied(game: GameView, id: int, known: Players) -> bool:
    """Whether each of an evader's targets is denied: somebody can be there first."""
    evader, pursuers = known
    assert game.setup is not None
    disc = goal_disc(game.setup.core_rules())
    e = evader
    return all(
        any(in_time(Vec(*goal), p.position, p.speed, e.position, e.speed, disc) for _, p in pursuers)
        for goal in game.targets_of(id)
    )


def _nearest(goals: tuple[tuple[float, float, float], ...], place: Vec) -> Vec | None:
    """The goal nearest to a place."""
    return min((Vec(*goal) for goal in goals), key=lambda goal: distance(goal, place), default=None)


def _odds(
    game: GameView, id: int, known: Players, alone: bool, many: bool
) -> tuple[str, str, tuple[float, float, float] | None]:
    """Go or no-go, why, and the chance of capture against the evader of the paper, None where the table does
    not reach: it is of games with one evader that has one target."""
    if alone and many:
        return "", "", None
    if not alone:
        hunters = game.hunters_of(id)
        known = known[0], [pair for pair in known[1] if pair[0] in hunters]
        if not 0 < len(known[1]) <= MOST_IN_SPACE:
            return "", "nobody is after it" if game.quarries and not known[1] else SEVERAL, None
    situation = _situation(game, id, known)
    found = odds(situation, changes=False, beyond=beyond_one(game, id))
    chance = found.chances.get(DEFAULT)
    share = None if chance is None else (chance.captured.p, chance.captured.low, chance.captured.high)
    word, why = headline(situation, found)
    return word, why if alone else f"by those after it: {why}", share


def beyond_one(game: GameView, id: int) -> str:
    """Why the table of odds says nothing of an evader's game; "" where it has one evader with one target."""
    return one_each(len(evaders_of(game.setup)), len(game.targets_of(id)))


def players(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...], evader: int
) -> Players | None:
    """An evader, and the pursuers with their ids, as far as they are known now."""
    if game.setup is None:
        return None
    seen = {v.id: v for v in vehicles if v.presence is Presence.PRESENT and v.state_age_s < OLD_S}
    pursuers = [
        (member.id, _own(seen[member.id], member))
        for member in game.setup.roster
        if member.role is Role.PURSUER and member.id in seen
    ]
    member = next((m for m in game.setup.roster if m.id == evader), None)
    track = next((t.track for t in tracks if t.id == evader and t.age_s < OLD_S), None)
    if member is None or not pursuers:
        return None
    if evader in seen:
        return _own(seen[evader], member), pursuers
    if track is None:
        return None
    return Vehicle(Vec(*track.position), Vec(*track.velocity), member.speed), pursuers


def engagements_in(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...]
) -> dict[int, Situation]:
    """Each evader's situation as the odds need it, by id: as it is heard, else of the setup's places; none
    without a setup. Of several evaders it is that of those who are after it, of all where nobody says so."""
    setup = game.setup
    if setup is None or {member.role for member in setup.roster} < {Role.EVADER, Role.PURSUER}:
        return {}
    found = {}
    for id in evaders_of(setup):
        if _out(game, id):
            continue
        evader, team = players(game, vehicles, tracks, id) or _placed(setup, id)
        hunters = game.hunters_of(id)
        found[id] = _situation(game, id, (evader, [p for p in team if not hunters or p[0] in hunters]))
    return found


def _situation(game: GameView, id: int, known: Players) -> Situation:
    """The engagement of these with an evader."""
    setup = game.setup
    assert setup is not None
    evader, team = known
    limits = {member.id: VehicleLimits(*astuple(member.limits)) for member in setup.roster}
    goal = _nearest(game.targets_of(id), evader.position)
    fence = setup.fence
    return engagement(
        Member(evader, limits[id], True),
        tuple(Member(vehicle, limits[id], True) for id, vehicle in team),
        NO_TARGET if goal is None else Target(True, goal),
        setup.core_rules(),
        Heights() if fence is None else Heights(fence.altitude_min, fence.altitude_max),
        setup.track_sigma,
    )


def _placed(setup: Setup, evader: int) -> Players:
    """An evader and the pursuers at the places and on the headings of the setup."""
    at = {
        m.id: Vehicle(Vec(*m.start), scale(direction(0.0, m.heading or 0.0), m.speed), m.speed)
        for m in setup.roster
    }
    return at[evader], [(m.id, at[m.id]) for m in setup.roster if m.role is Role.PURSUER]


def _own(view: VehicleView, member: Declared) -> Vehicle:
    assert view.state is not None
    air = sub(Vec(*view.state.velocity), Vec(*view.state.wind))
    return Vehicle(Vec(*view.state.position), air, member.speed)
