"""The core's assessment of a situation, from what the picture knows."""

from __future__ import annotations

from gcs.picture.values import AssessmentView, GameView, Presence, ProspectView, TrackView, VehicleView
from onboard.core.geometry import assessment
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec, distance, sub
from onboard.wire.bus.messages import Member, Role

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
    if not setup.rules.planar and len(pursuers) > MOST_IN_SPACE:
        place = evader.position
        pursuers = sorted(pursuers, key=lambda p: distance(p[1].position, place))[:MOST_IN_SPACE]
    target = ZERO if game.target is None else Vec(*game.target)
    mates = tuple(vehicle for _, vehicle in pursuers)
    found = assessment.assess(
        evader, mates, setup.rules.rho, game.target is not None, target, setup.rules.planar
    )
    return AssessmentView(
        encircled=found.encircled,
        gaps=tuple((gap.start, gap.width) for gap in found.gaps),
        largest_gap=found.largest_gap if setup.rules.planar else found.cap.radius * 2.0,
        target_denied=found.target_denied,
        prospects=tuple(
            ProspectView(id=i, intercepts=p.intercepts, time_s=p.time, denies_target=p.denies_target)
            for (i, _), p in zip(pursuers, found.prospects, strict=True)
        ),
    )


def _own(view: VehicleView, member: Member) -> Vehicle:
    assert view.state is not None
    air = sub(Vec(*view.state.velocity), Vec(*view.state.wind))
    return Vehicle(Vec(*view.state.position), air, member.speed)
