"""The core's assessment of a situation, from what the picture knows."""

from __future__ import annotations

from msgspec.structs import astuple

from gcs.picture.values import AssessmentView, GameView, Presence, ProspectView, TrackView, VehicleView
from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.geometry import assessment
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, direction, distance, scale, sub
from onboard.core.strategy.registry import DEFAULT
from onboard.core.strategy.team.plan_types import Heights, Member, Situation
from onboard.game.odds import engagement, headline, odds
from onboard.wire.bus.messages import Member as Declared
from onboard.wire.bus.messages import Role, Setup

MOST_IN_SPACE = 12  # pursuers: the largest free cap costs their number to the fourth power
OLD_S = 2.0  # positions older than this are no ground for a judgement


def assess(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...]
) -> AssessmentView | None:
    """The assessment, or None while the evader or all pursuers are unknown.

    The evader's own state counts, and its track where there is none; speeds are the declared ones. In
    space only the twelve nearest pursuers are judged.
    """
    setup = game.setup
    known = _players(game, vehicles, tracks)
    if setup is None or known is None:
        return None
    evader, pursuers = known
    many = len(pursuers) > MOST_IN_SPACE
    if not setup.rules.planar and many:
        place = evader.position
        pursuers = sorted(pursuers, key=lambda p: distance(p[1].position, place))[:MOST_IN_SPACE]
    target = ZERO if game.target is None else Vec(*game.target)
    mates = tuple(vehicle for _, vehicle in pursuers)
    found = assessment.assess(
        evader, mates, setup.rules.rho, game.target is not None, target, setup.rules.planar
    )
    word, why, captured = _odds(None if many else engagement_in(game, vehicles, tracks))
    return AssessmentView(
        encircled=found.encircled,
        gaps=tuple((gap.start, gap.width) for gap in found.gaps),
        largest_gap=found.largest_gap if setup.rules.planar else found.cap.radius * 2.0,
        target_denied=found.target_denied,
        prospects=tuple(
            ProspectView(id=i, intercepts=p.intercepts, time_s=p.time, denies_target=p.denies_target)
            for (i, _), p in zip(pursuers, found.prospects, strict=True)
        ),
        captured=captured,
        word=word,
        why=why,
    )


def _odds(situation: Situation | None) -> tuple[str, str, tuple[float, float, float] | None]:
    """Go or no-go, why, and the chance of capture against the evader of the paper, None where the table does
    not reach."""
    if situation is None:
        return "", "", None
    found = odds(situation, changes=False)
    chance = found.chances.get(DEFAULT)
    share = None if chance is None else (chance.captured.p, chance.captured.low, chance.captured.high)
    return *headline(situation, found), share


def _players(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...]
) -> tuple[Vehicle, list[tuple[int, Vehicle]]] | None:
    """The evader, and the pursuers with their ids, as far as they are known now."""
    setup = game.setup
    if setup is None:
        return None
    seen = {v.id: v for v in vehicles if v.presence is Presence.PRESENT and v.state_age_s < OLD_S}
    evader: Vehicle | None = None
    pursuers: list[tuple[int, Vehicle]] = []
    for member in setup.roster:
        view = seen.get(member.id)
        if member.role is Role.PURSUER and view is not None:
            pursuers.append((member.id, _own(view, member)))
        elif member.role is Role.EVADER and view is not None:
            evader = _own(view, member)
        elif member.role is Role.EVADER:
            track = next((t.track for t in tracks if t.id == member.id and t.age_s < OLD_S), None)
            if track is not None:
                evader = Vehicle(Vec(*track.position), Vec(*track.velocity), member.speed)
    if evader is None or not pursuers:
        return None
    return evader, pursuers


def engagement_in(
    game: GameView, vehicles: tuple[VehicleView, ...], tracks: tuple[TrackView, ...]
) -> Situation | None:
    """The situation as the odds need it: as it is heard, else of the setup's places; None without a setup."""
    setup = game.setup
    if setup is None or {member.role for member in setup.roster} < {Role.EVADER, Role.PURSUER}:
        return None
    evader, team = _players(game, vehicles, tracks) or _placed(setup)
    limits = {member.id: VehicleLimits(*astuple(member.limits)) for member in setup.roster}
    evading = next(member.id for member in setup.roster if member.role is Role.EVADER)
    target = NO_TARGET if game.target is None else Target(True, Vec(*game.target))
    fence = setup.fence
    heights = Heights() if fence is None else Heights(fence.altitude_min, fence.altitude_max)
    return engagement(
        Member(evader, limits[evading], True),
        tuple(Member(vehicle, limits[id], True) for id, vehicle in team),
        target, setup.core_rules(), heights, setup.track_sigma,
    )  # fmt: skip


def _placed(setup: Setup) -> tuple[Vehicle, list[tuple[int, Vehicle]]]:
    """Evader and pursuers at the places and on the headings of the setup."""
    at = {
        m.id: Vehicle(Vec(*m.start), scale(direction(0.0, m.heading or 0.0), m.speed), m.speed)
        for m in setup.roster
    }
    evader = next(m.id for m in setup.roster if m.role is Role.EVADER)
    return at[evader], [(m.id, at[m.id]) for m in setup.roster if m.role is Role.PURSUER]


def _own(view: VehicleView, member: Declared) -> Vehicle:
    assert view.state is not None
    air = sub(Vec(*view.state.velocity), Vec(*view.state.wind))
    return Vehicle(Vec(*view.state.position), air, member.speed)
