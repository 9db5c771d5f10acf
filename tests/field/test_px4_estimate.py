"""PX4's estimate as its recordings show it: sound at rest on the ground, lost some seconds after the GPS."""

from __future__ import annotations

from onboard.wire.mavlink.telemetry import decode
from onboard.wire.mavlink.values import EkfStatus
from tests.support.recorded import recorded

CONST_POS_MODE = 128  # ESTIMATOR_CONST_POS_MODE


def reports(name: str) -> list[EkfStatus]:
    """What is read of the estimator in a recording, in order."""
    read = [decode(message) for _, message in recorded(name).own("ESTIMATOR_STATUS")]
    return [report for report in read if isinstance(report, EkfStatus)]


def test_at_rest_on_the_ground_the_estimate_is_sound() -> None:
    at_rest = [one for one in reports("px4-ground-start-never-climbs") if one.flags & CONST_POS_MODE]
    assert at_rest
    assert all(report.ok for report in at_rest)


def test_after_the_loss_of_gps_in_the_air_the_estimate_is_lost() -> None:
    found = reports("px4-default-params-posctl-to-offboard-gpsloss")
    lost = [index for index, report in enumerate(found) if not report.ok]
    assert len(lost) >= 20
    assert lost == list(range(lost[0], lost[0] + len(lost)))  # one loss, without a sound report in between
    assert all(report.ok for report in found[: lost[0]])
    assert not any(found[index].flags & CONST_POS_MODE for index in lost)  # the needed flags alone tell of it
