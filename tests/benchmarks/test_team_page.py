"""The team benchmark's page counts pairs only, says how near pursuers came, and never mixes kernels."""

from __future__ import annotations

import json
from pathlib import Path

from tests.benchmarks import team
from tests.benchmarks.team_cases import demand
from tests.benchmarks.team_page import Row, flown_table, games_table, honesty, separation


def row(seed: int, way: str, verdict: str, **other: object) -> Row:
    base: Row = {
        "case": "ring-4", "seed": seed, "way": way, "flown": False, "verdict": verdict, "time": 60.0,
        "smallest": 20.0, "apart": 120.0, "separation": 100.0, "closed": True, "near": False, "cpu": 0.1,
    }  # fmt: skip
    return base | other


def test_a_case_is_told_by_its_pairs() -> None:
    rows = [
        row(1, "paper", "ARRIVED"), row(1, "team", "CAPTURED"),
        row(2, "paper", "CAPTURED"), row(2, "team", "CAPTURED", apart=99.0),
        row(3, "paper", "CAPTURED"),  # the team's is still to be played
    ]  # fmt: skip
    [line] = [line for line in games_table(rows) if line.startswith("| closed ring of 4")]
    cells = [cell.strip() for cell in line.split("|")[1:-1]]
    assert cells[1] == "2"
    assert cells[2].startswith("1 = 50 %")
    assert cells[4].startswith("2 = 100 %")
    assert cells[6].startswith("1, 0;")
    assert cells[7].startswith("1, 0;")
    told = " ".join(honesty(rows))
    assert "100 m they keep apart in 1 of 2 games" in told
    assert "least 99.0 m (ring-4, seed 2)" in told


def test_a_distance_kept_to_the_last_is_no_breach() -> None:
    assert "in 0 of 1 games" in separation("All", [row(1, "team", "ESCAPED", apart=100.0)])


def test_flights_are_told_beside_what_was_computed() -> None:
    seen = {"flown": True, "computed": "CAPTURED", "computed_time": 61.0, "computed_smallest": 24.0}
    rows = [row(1, "team", "CAPTURED", **seen), row(2, "team", "ARRIVED", **seen)]
    told = flown_table(rows)
    assert any(line.startswith("| closed ring of 4, 2 km, random phase | 2 | 1 | 1 | 1 |") for line in told)
    assert any(line.startswith("- ring-4, seed 2: flown arrived") for line in told)


def test_rows_of_another_kernel_are_played_again(tmp_path: Path) -> None:
    path = tmp_path / "rows.jsonl"
    both = [row(1, "team", "CAPTURED", sources=team.sources()), row(2, "team", "CAPTURED", sources="0" * 16)]
    path.write_text("\n".join(map(json.dumps, both)) + "\n", encoding="utf-8")
    assert [r["seed"] for r in team.read(path)] == [1]


def test_every_case_has_as_many_seeds_when_it_stops_early() -> None:
    cases = [demand("ring-4"), demand("shipped-6")]
    jobs = list(team.jobs_of(cases, 2 * team.SHARE, 1))
    assert len(jobs) == 2 * 2 * 2 * team.SHARE + 2
    half = jobs[: 2 * 2 * team.SHARE]
    assert {job.seed for job in half} == set(range(1, team.SHARE + 1))
    assert {job.case.name for job in half} == {"ring-4", "shipped-6"}
    assert [job.flown for job in jobs[-2:]] == [True, True]
