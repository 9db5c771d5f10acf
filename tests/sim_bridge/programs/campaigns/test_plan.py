"""A plan's shards hold every game once; their keys tell every difference that matters; when it is enough."""

from __future__ import annotations

import shutil
from collections import Counter
from itertools import pairwise
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binomtest

from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.runtime.resources import configs
from sim_bridge.programs.campaigns import fingerprint as prints
from sim_bridge.programs.campaigns.command import Options, Played, all_of, plan_of, ways_of
from sim_bridge.programs.campaigns.plan import Plan, chosen
from sim_bridge.programs.campaigns.play import drawn, simple_games, turned
from sim_bridge.programs.campaigns.run import part_of
from sim_bridge.programs.campaigns.until import Until, enough, parse, wilson
from tests.support.campaign_runs import duel

PLAN = plan_of(Options((Path("row01"), Path("five")), evaders=("paper", "straight")), until=False)


def sized(cells: int, games: int, shard_games: int, first: int = 1) -> Plan:
    """A plan of so many cells, which need not be played."""
    points = [{"evader.speed": float(k)} for k in range(cells)]
    return msgspec.structs.replace(
        PLAN, scenarios=PLAN.scenarios[:1], pairs=PLAN.pairs[:1], points=points, games=games,
        shard_games=shard_games, first_seed=first,
    )  # fmt: skip


@given(st.integers(1, 40), st.integers(1, 60), st.integers(1, 200), st.integers(0, 2**40))
def test_every_game_lies_in_one_shard(cells: int, games: int, shard_games: int, first: int) -> None:
    plan = sized(cells, games, shard_games, first)
    held = Counter((c, s) for shard in plan.shards() for c in shard.cells for s in shard.seeds)
    assert held == Counter((c, s) for c in range(cells) for s in range(first, first + games))
    assert [shard.number for shard in plan.shards()] == list(range(len(plan.shards())))
    assert max(shard.games for shard in plan.shards()) <= max(2 * shard_games, 1)


def test_more_games_keep_the_whole_shards_of_before() -> None:
    fewer, more = sized(3, 50, 30), sized(3, 73, 30)
    before = [fewer.key(shard) for shard in fewer.shards()]
    assert [more.key(shard) for shard in more.shards()][: len(before)] == before


def test_a_shards_key_tells_whatever_its_games_follow_from() -> None:
    base = PLAN.key(PLAN.shards()[0])
    data = msgspec.to_builtins(PLAN)

    def key_with(change: object) -> str:
        plan = msgspec.convert(change, Plan)
        return plan.key(plan.shards()[0])

    def changed(*path: object, to: object) -> dict[str, object]:
        copy = msgspec.json.decode(msgspec.json.encode(data))
        place = copy
        for step in path[:-1]:
            place = place[step]
        assert place[path[-1]] != to
        place[path[-1]] = to
        return copy

    others = [
        changed("scenarios", 0, "data", "evader", "speed", to=5.5),
        changed("scenarios", 0, "data", "seed", to=77),
        changed("pairs", 0, "evader", to="straight"),
        changed("first_seed", to=2),
        changed("games", to=7),
        changed("flown", to=True),
        changed("fingerprint", "sources", to="0"),
        changed("fingerprint", "versions", "numpy", to="1.0"),
        changed("fingerprint", "plugins", to={"mine": "1"}),
        changed("points", 0, to={"evader.speed": 5.25}),
    ]
    keys = [key_with(other) for other in others]
    assert base == key_with(data)
    assert len({base, *keys}) == len(others) + 1


def test_other_sources_have_another_fingerprint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = prints.sources(prints.COMPUTED)
    copy = tmp_path / "copy"
    for part in prints.COMPUTED:
        place = prints.ROOT / part
        for file in [place] if place.is_file() else place.rglob("*.py"):
            target = copy / file.relative_to(prints.ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(file.read_bytes())
    monkeypatch.setattr(prints, "ROOT", copy)
    prints.sources.cache_clear()
    try:
        assert prints.sources(prints.COMPUTED) == before
        victim = copy / "onboard/core/strategy/pursuit.py"
        victim.write_text(victim.read_text("utf-8") + "\nX = 1\n", "utf-8")
        prints.sources.cache_clear()
        assert prints.sources(prints.COMPUTED) != before
        monkeypatch.undo()
        aircraft = tmp_path / "configs" / "aircraft"
        shutil.copytree(configs() / "aircraft", aircraft)
        monkeypatch.setattr(prints, "configs", lambda: tmp_path / "configs")
        for edited in (False, True):
            text = (aircraft / "nose.toml").read_text("utf-8")
            (aircraft / "nose.toml").write_text(text + "\n" * edited, "utf-8")
            prints.sources.cache_clear()
            assert (prints.sources(prints.COMPUTED) != before) == edited
    finally:
        prints.sources.cache_clear()


@given(st.integers(1, 5000), st.data())
def test_wilsons_interval_is_scipys(games: int, data: st.DataObject) -> None:
    count = data.draw(st.integers(0, games))
    theirs = binomtest(count, games).proportion_ci(method="wilson")
    assert wilson(count, games) == pytest.approx((theirs.low, theirs.high), abs=1e-12)


def test_it_is_enough_where_every_cell_is_known_well_enough() -> None:
    rule = parse("ci(arrived) < 0.05")
    assert rule == Until("arrived", 0.05)
    known, unknown = Counter(arrived=500, captured=500), Counter(arrived=50, captured=50)
    assert enough(rule, {0: known})
    assert not enough(rule, {0: known, 1: unknown})
    assert not enough(parse("ci<0.03"), {0: known})


NO_RULES = ("", "ci", "ci<", "ci<0", "ci<1", "ci>0.1", "ci(won)<0.1", "ci<nan", "ci<0.1x")


@pytest.mark.parametrize("text", NO_RULES)
def test_a_rule_that_says_nothing_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="--until: found"):
        parse(text)


@pytest.mark.parametrize("text", ["", "1", "0/2", "3/2", "a/b", "1/0", "-1/2", "1/2/3"])
def test_a_part_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="--shard: found"):
        part_of(text)


def test_options_that_exclude_each_other_are_refused() -> None:
    for played in (Played(workers=2, dask="tcp://x"), Played(shard="1/2", until="ci<0.1")):
        with pytest.raises(ConfigError, match="found with"):
            ways_of(played)
    with pytest.raises(ConfigError, match="--games: found with --until"):
        plan_of(Options((Path("row01"),), games=5), until=True)
    with pytest.raises(ConfigError, match="row01 twice"):
        plan_of(Options((Path("row01"), Path("row01"))), until=False)
    with pytest.raises(ConfigError, match="did you mean"):
        plan_of(Options((Path("row01"),), evaders=("papr",)), until=False)


def test_all_strategies_are_each_once() -> None:
    for role, known in (("evader", EVADERS), ("pursuer", PURSUERS)):
        names = all_of(role)
        played = [known[name].decide for name in names if name in known]
        assert len(played) == len(set(played))
        assert {strategy.decide for strategy in known.values()} == set(played)


def test_a_wind_that_was_recorded_is_no_campaigns(tmp_path: Path) -> None:
    from onboard.game.scenario import load

    path = tmp_path / "windy.toml"
    text = (prints.ROOT / "configs/scenarios/flight/one-on-one.toml").read_text("utf-8")
    path.write_text(text + '\n[flight.wind]\nrecorded = "wind.csv"\n', "utf-8")
    with pytest.raises(ConfigError, match="expected a modelled wind"):
        chosen("windy", load(path))


@given(st.integers(2, 40), st.integers(1, 60), st.integers(1, 200))
def test_shards_are_played_from_places_apart(cells: int, games: int, shard_games: int) -> None:
    """Each of its cells once; of two that follow each other the first few have nothing in common."""
    shards = sized(cells, games, shard_games).shards()
    for shard in shards:
        assert sorted(turned(shard)) == list(shard.cells)
    for one, other in pairwise(shards):
        if one.cells == other.cells and len(one.cells) >= 16:
            few = len(one.cells) // 8 + 1
            assert not set(turned(one)[:few]) & set(turned(other)[:few])


@pytest.mark.parametrize("below", [0, 1])
def test_no_game_has_a_seed_beyond_the_last(below: int, tmp_path: Path) -> None:
    """The scenario's own seed counts too: the world's is their sum, and `fly` writes it into a file."""
    options = Options((duel(tmp_path),), games=20, seed=2**63 - 1 - 19 - 5 + below)  # the duel's seed is 5
    if below:
        with pytest.raises(ConfigError, match=rf"--seed: found {options.seed}, expected at most"):
            plan_of(options, until=False)
        return
    [shard] = plan_of(options, until=False).shards()
    cell = plan_of(options, until=False).cell(0)
    assert drawn(cell, shard.seeds[-1]).seed == 2**63 - 1
    assert simple_games(cell, shard.seeds[-1:])[0].seed == shard.seeds[-1]


def test_a_file_given_twice_is_named_as_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    duel(tmp_path)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigError, match=r"SCENARIO: found \./duel twice"):
        plan_of(Options((Path("duel.toml"), Path("duel.toml"))), until=False)
