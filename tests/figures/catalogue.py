"""The committed figures: what makes each, and what each measures."""

from __future__ import annotations

from dataclasses import dataclass

from tests.support.paths import RESULTS, ROOT

CAMPAIGN = ("-m", "sim_bridge.cli", "campaign", "study")
INTO = ("--out", "benchmarks/results")


@dataclass(frozen=True)
class Figure:
    """A page of `benchmarks/results/` that a command writes."""

    page: str
    """Name of the page."""

    command: tuple[str, ...]
    """Arguments of the Python that writes the page into `benchmarks/results/` of the current folder."""

    modules: tuple[str, ...]
    """Modules that are measured; what they import is measured too."""

    files: tuple[str, ...] = ()
    """Other files that are measured, as patterns from the project's root."""

    def text(self) -> str:
        """The committed page."""
        return (RESULTS / self.page).read_text(encoding="utf-8")


FIGURES = (
    Figure(
        "encircled.md",
        (*CAMPAIGN, "encircled", "--games", "400", "--seed", "1", *INTO),
        ("sim_bridge.campaign.encircled",),
    ),
    Figure(
        "games.md",
        (*CAMPAIGN, "games", "--seeds", "200", "--figures", "docs/pictures", *INTO),
        ("sim_bridge.campaign.spatial_campaign", "sim_bridge.campaign.figures"),
        ("configs/scenarios/spatial/five.toml", "configs/scenarios/spatial/six.toml"),
    ),
    Figure(
        "tracking.md",
        (*CAMPAIGN, "tracking", "--seeds", "50", *INTO),
        ("sim_bridge.campaign.tracking",),
        ("configs/routes/twenty_km.toml",),
    ),
    Figure(
        "starts.md",
        ("-m", "tests.benchmarks.starts", "--seeds", "40"),
        ("onboard.pilot.approach", "sim_bridge.campaign.aboard", "sim_bridge.vehicle.wind.estimate"),
        ("tests/benchmarks/starts.py", "tests/onboard/pilot/test_approach.py"),
    ),
    Figure(
        "choice-in-pursuit.md",
        ("-m", "tests.benchmarks.choice_in_pursuit", "--seeds", "40"),
        ("sim_bridge.campaign.spatial_campaign", "onboard.core.strategy.choosing"),
        ("configs/scenarios/spatial/six.toml", "tests/benchmarks/choice_in_pursuit.py"),
    ),
    Figure(
        "classic.md",
        ("-m", "tests.benchmarks.classic", "--starts", "20", "--feints", "5"),
        ("sim_bridge.programs.classic",),
        ("configs/scenarios/classic/*.toml", "tests/benchmarks/classic.py"),
    ),
    Figure(
        "team-planning.md",
        ("-m", "tests.benchmarks.team_planning"),
        ("onboard.core.strategy.team",),
        ("tests/benchmarks/team_planning.py",),
    ),
    Figure(
        "predictor.md",
        ("-m", "tests.benchmarks.predictor"),
        ("onboard.pilot.predictor", "onboard.core.game.advance", "onboard.core.strategy"),
        ("tests/benchmarks/predictor/*.py",),
    ),
    Figure(
        "predictor-by-family.md",
        ("-m", "tests.benchmarks.predictor.by_family"),
        ("onboard.pilot.predictor", "onboard.core.game.advance", "onboard.core.strategy"),
        ("tests/benchmarks/predictor/by_family.py", "tests/benchmarks/predictor/families.py"),
    ),
)


def missing(figure: Figure) -> list[str]:
    """Patterns of `figure` that name no file: they would measure nothing."""
    return [pattern for pattern in figure.files if not any(ROOT.glob(pattern))]
