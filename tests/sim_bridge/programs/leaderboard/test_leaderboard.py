"""The leaderboard: ratings that an independent fit gives, intervals that hold, one page of equal bytes."""

from __future__ import annotations

import json
from html import escape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize

from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.programs.campaigns.show import results
from sim_bridge.programs.leaderboard.command import Options, bench, seeds_of
from sim_bridge.programs.leaderboard.ratings import ELO, PRIOR, board, fit
from tests.support.campaign_runs import duel
from tests.support.paths import ROOT

pytestmark = pytest.mark.timeout(240)


def chances(evaders: np.ndarray, pursuers: np.ndarray, scenarios: np.ndarray) -> np.ndarray:
    """How often each evader wins against each of the pursuers in each scenario."""
    logit = scenarios[:, None, None] + evaders[None, :, None] - pursuers[None, None, :]
    return 1.0 / (1.0 + np.exp(-logit))


def test_ratings_are_those_that_a_general_optimiser_finds() -> None:
    mean = np.random.default_rng(3).uniform(0.0, 1.0, (4, 3, 5))

    def cost(weights: np.ndarray) -> float:
        chance = chances(weights[:3], weights[3:8], weights[8:])
        likelihood = mean * np.log(chance) + (1.0 - mean) * np.log1p(-chance)
        return float(0.5 * PRIOR * weights @ weights - likelihood.sum())

    found = minimize(cost, np.zeros(12), method="BFGS", options={"gtol": 1e-9}).x
    wanted = np.concatenate([found[:3] - found[:3].mean(), found[3:8] - found[3:8].mean()])
    assert fit(mean) == pytest.approx(ELO * wanted, abs=0.01)


def test_known_strengths_come_back_in_their_order_and_a_constant_winner_stays_finite() -> None:
    evaders, pursuers = np.array([1.0, 0.0, -1.0]), np.array([-0.8, 0.1, 0.7])
    mean = chances(evaders, pursuers, np.linspace(-1.0, 1.0, 40))
    ratings = fit(mean)
    assert np.argsort(ratings[:3]).tolist() == [2, 1, 0]
    assert ratings[:3] == pytest.approx(ELO * evaders, rel=0.1, abs=5.0)
    assert ratings[3:] == pytest.approx(ELO * pursuers, rel=0.1, abs=5.0)
    always = np.zeros((3, 2, 2))
    always[:, 0] = 1.0
    assert np.all(np.isfinite(fit(always)))


class Whole(HTMLParser):
    """Collects the tags of a page, and what it would fetch."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.fetched: list[str] = []
        self.cells: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.fetched += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in ("meta", "line", "circle", "p", "html", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in ("p", "html", "line", "circle"):
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "td":
            self.cells.append(data)


def test_a_small_leaderboard_twice_gives_the_same_bytes_and_counts_as_its_games_do(tmp_path: Path) -> None:
    told = Options((duel(tmp_path),), ("paper", "straight"), ("paper",), games=60, workers=1)
    first = bench(told._replace(out=tmp_path / "a"), print)
    again = bench(told._replace(out=tmp_path / "b"), print)
    assert first.page.read_bytes() == again.page.read_bytes()
    assert first.data.read_bytes() == again.data.read_bytes()
    found = results(tmp_path / "a" / "games")
    shares = {one.cell: one.share("captured")[0] / 60 for one in found.cells}
    data = json.loads(first.data.read_bytes())
    assert data["captured"] == [[[pytest.approx(shares[0], abs=1e-6)], [pytest.approx(shares[1], abs=1e-6)]]]
    page = Whole(first.page.read_text("utf-8"))
    assert page.open == []
    assert page.fetched == []
    assert f"{shares[1]:.0%}" in page.cells
    text = first.page.read_text("utf-8")
    for words in ("1 strategy of the pursuers × 2 strategies of the evader × 1 scenario × 60 games = 120",
                  EVADERS["straight"].words, PURSUERS["paper"].words, "duel: a duel"):  # fmt: skip
        assert escape(words) in text
    compared = board(found)
    assert [score.name for score in compared.evader_scores] == ["paper", "straight"]
    for score in compared.evader_scores:
        assert score.low <= score.rating <= score.high
        assert score.high - score.low > 5.0
    points = {
        name: np.mean([{"arrived": 1.0, "escaped": 0.5}.get(v, 0.0) for v in one.verdicts])
        for name, one in zip(("paper", "straight"), found.cells, strict=True)
    }
    assert {score.name: score.share for score in compared.evader_scores} == pytest.approx(points)


@pytest.mark.long
def test_the_strategy_of_another_distribution_is_ranked_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "examples" / "strategy-plugin"))
    info = tmp_path / "site" / "apollonius_flank-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: apollonius-flank\nVersion: 1.0\n", "utf-8")
    points = "[apollonius.strategies]\nflank = apollonius_flank:FLANK\n"
    (info / "entry_points.txt").write_text(points, "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path / "site"))
    told = Options((duel(tmp_path),), ("paper",), ("paper", "flank"), games=10, out=tmp_path / "b", workers=2)
    made = bench(told, print)
    assert {score.name for score in made.board.pursuer_scores} == {"paper", "flank"}
    assert "flank (apollonius-flank 1.0)" in made.page.read_text("utf-8")


def test_a_key_hides_the_seeds_and_proves_them(tmp_path: Path) -> None:
    (tmp_path / "key").write_text("a secret of the organisers\n", "utf-8")
    (tmp_path / "other").write_text("another secret of theirs", "utf-8")
    first, commitment = seeds_of(tmp_path / "key")
    assert seeds_of(tmp_path / "key") == (first, commitment)
    assert seeds_of(tmp_path / "other")[0] != first
    assert 0 <= first < 2**62
    assert "secret" not in commitment
    assert len(commitment) == 64
    assert seeds_of(None) == (1, "")
    (tmp_path / "short").write_text("pin", "utf-8")
    with pytest.raises(ConfigError, match="found 3 characters, expected 16 or more"):
        seeds_of(tmp_path / "short")
    with pytest.raises(ConfigError, match=r"--key: .* no such file"):
        seeds_of(tmp_path / "none")
