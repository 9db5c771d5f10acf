"""Alerts on what an agent counts: refused signatures, floods, records that were not written. Pure."""

from __future__ import annotations

from collections.abc import Iterator

from gcs.picture.alerts import Finding
from gcs.picture.values import VehicleView
from onboard.wire.bus.messages import LinkLock, Severity

CLOCKS = "set both clocks (chrony, NTP, GPS), then start the autopilot's link again"
SIGNATURES = {  # cause → how grave, what is said of the frames, what to do
    "stale": (Severity.ERROR, "are stamped more than a minute in the past", CLOCKS),
    "future": (Severity.ERROR, "are stamped more than a minute in the future", CLOCKS),
    "replayed": (Severity.WARNING, "come again with old stamps", "a link repeats them, or a clock runs back"),
    "wrong": (Severity.WARNING, "are signed with another key", "give both the same key (docs/security.md)"),
    "unsigned": (Severity.WARNING, "are not signed", "give the autopilot the agent's key (docs/security.md)"),
    "crowded": (Severity.WARNING, "come from too many senders", "find who sends them"),
}


def troubles(vehicle: VehicleView) -> Iterator[Finding]:
    """What of an agent's counters grows, an alert for each kind."""
    name = f"vehicle {vehicle.id}"
    refused = vehicle.health is not None and vehicle.health.link_lock is LinkLock.REFUSED
    limited, lost = [], []
    for counter, number in vehicle.growing:
        cause = counter.removeprefix("signature_")
        if counter.startswith("signature_") and cause in SIGNATURES:
            severity, words, advice = SIGNATURES[cause]
            deaf = ": its autopilot is not heard" if refused else ""
            yield Finding(
                counter, vehicle.id, Severity.ERROR if refused else severity,
                f"frames on {name}'s link {words} ({number} refused){deaf}", advice,
            )  # fmt: skip
        elif "limited_" in counter:
            limited.append(f"{counter.replace('limited_', '').replace('_', ' ')} {number}")
        else:
            lost.append(f"{counter.replace('_', ' ')} {number}")
    if limited:
        yield Finding(
            "flooded", vehicle.id, Severity.WARNING,
            f"more comes to {name} than may: {', '.join(limited)} left out",
            "find who sends it; revoke its key (docs/security.md)",
        )  # fmt: skip
    if lost:
        yield Finding(
            "records_lost", vehicle.id, Severity.WARNING, f"{name} does not record all: {', '.join(lost)}",
            "its disk does not keep up, or is full: make room",
        )  # fmt: skip
