"""The field profile: vehicles in layers of height, capture judged from above, noise that R can bear."""

from __future__ import annotations

from itertools import pairwise

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, clamp
from onboard.core.safety.policy import Action, Policy

SPACING = 20.0  # least distance between two layers [m]
GROUND_RETURN = 60.0  # of the master's silence [s], after which everybody flies home
TRUST = 5.0  # R in space must be this many times the stated position error


def layers(heights: tuple[float, ...], spacing: float = SPACING) -> tuple[float, ...]:
    """One height above the origin for each member of the roster [m].

    The starting heights where each pair of them lies `spacing` apart; otherwise layers from the lowest up,
    in the roster's order. Everybody computes the same from the same setup.
    """
    ordered = sorted(heights)
    if all(b - a >= spacing for a, b in pairwise(ordered)):
        return heights
    return tuple([ordered[0] + spacing * index for index in range(len(heights))])


def capture_in_space_refused(R: float, sigma: float) -> bool:
    """Whether a capture radius R [m] in space is too small for the stated position error [m]."""
    return TRUST * sigma > R


def field_policy(policy: Policy, layer: float) -> Policy:
    """The policy of a game in the field profile: a layer of one's own, lost tracks make one break off.

    Silence of the game's master makes one hold, and after a minute fly home.
    """
    return policy._replace(
        layered=True,
        layer=layer,
        track_latched=True,
        track_action=max(policy.track_action, Action.HOLD),
        ground_action=max(policy.ground_action, Action.HOLD),
        ground_return=GROUND_RETURN,
    )


def keep_layer(v: Vec, position: Vec, policy: Policy) -> Vec:
    """The velocity with the vertical part that leads to the layer."""
    rise = clamp(0.5 * (policy.layer + position.z), -policy.envelope.sink_max, policy.envelope.climb_max)
    return new(Vec, (v.x, v.y, -rise))
