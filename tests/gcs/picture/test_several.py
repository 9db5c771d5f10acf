"""Several evaders and several targets in the picture, the console and the words of the page."""

from __future__ import annotations

from itertools import takewhile

import pytest
from msgspec.structs import replace

from gcs.console import plan
from gcs.console.detail import detail
from gcs.console.plain_lines import status
from gcs.console.status_line import alert_lines, known_lines, log_lines, situation_in_words, status_line
from gcs.console.vehicle_table import rows
from gcs.page import documents
from gcs.picture import knowledge
from gcs.picture.assessment import assess as assessments
from gcs.picture.assessment import beyond_one, engagements_in
from gcs.picture.reducer import PictureReducer
from gcs.picture.values import Picture
from gcs.programs import assess_file
from onboard.core.geometry.assessment import NO_GOAL, assess
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, sub
from onboard.game import palette, sides
from onboard.game.go_or_no_go import lines
from onboard.game.knowledge_words import goal_in_words
from onboard.runtime.resources import configs
from onboard.wire.bus.knowledge_messages import (
    Knowledge,
    KnowledgeEdge,
    KnowledgeNode,
    NodeKind,
    PlannedGoal,
    TeamGoal,
)
from onboard.wire.bus.messages import EvaderOutcome, OutcomeResult, Phase, Role, Setup
from onboard.wire.bus.team_messages import TeamPlan
from tests.support.chase_messages import EPOCH_NS
from tests.support.sample_messages import Tower, decision, phase, setup, state
from tests.support.three_on_ten import AFTER, EVADERS, TARGETS, R, flight
from tests.support.three_on_ten import setup as flight_setup


def at(since_t0_s: float) -> Picture:
    """The picture then."""
    reducer, end_ns = PictureReducer("field"), EPOCH_NS + round((2.0 + since_t0_s) * NS_PER_S)
    for item in flight():
        if item.stamp_ns > end_ns:
            break
        reducer.apply(*item)
    return reducer.picture(end_ns)


@pytest.fixture(scope="module")
def early() -> Picture:
    return at(5.0)


@pytest.fixture(scope="module")
def late() -> Picture:
    """Evader 1 is captured."""
    return at(14.0)


@pytest.fixture(scope="module")
def over() -> Picture:
    return at(60.0)


def test_every_evader_has_its_own_targets_and_hunters(early: Picture) -> None:
    game = early.game
    assert {id: game.targets_of(id) for id in EVADERS} == TARGETS
    assert dict(game.quarries) == AFTER
    assert game.hunters_of(13) == (9, 10, 11)
    assert game.quarry_of(1) is None


def test_every_evader_is_judged_against_all_pursuers(early: Picture) -> None:
    """By the core's own judgement of the states that were heard; in space of the eight nearest."""
    rules = early.game.setup.rules
    moving = {
        v.id: Vehicle(Vec(*v.state.position), sub(Vec(*v.state.velocity), Vec(*v.state.wind)),
                      12.0 if v.id in EVADERS else 9.0)
        for v in early.vehicles
    }  # fmt: skip
    assert [found.evader for found in early.assessments] == list(EVADERS)
    for found in early.assessments:
        evader = moving[found.evader]
        nearest = sorted(AFTER, key=lambda id: _apart(early, id, found.evader))[:8]
        team = tuple(moving[id] for id in nearest)
        alone = assess(evader, team, rules.rho, NO_GOAL, bool(rules.planar))
        assert found.largest_gap == pytest.approx(2.0 * alone.cap.radius)
        assert {p.id for p in found.prospects} == set(nearest)


def test_an_evader_that_is_out_is_hunted_and_judged_no_more(late: Picture) -> None:
    fate = late.game.fate_of(1)
    assert fate is not None
    assert (fate.out, fate.words) == (True, f"captured by 2 at {fate.time_s:.1f} s")
    assert [found.evader for found in late.assessments] == [12, 13]
    assert 1 not in {quarry for _, quarry in late.game.quarries}
    assert set(dict(late.game.quarries)) == set(AFTER), "who was after it is after another one"
    assert any("evader 1 captured by 2" in line[0][0] for line in log_lines(late))
    assert not any(alert.kind == "track_stale" for alert in late.alerts)


def test_a_track_that_ends_is_missed_of_those_alone_that_are_in_the_game() -> None:
    tower = Tower()
    roles = {1: Role.EVADER, 4: Role.EVADER}
    roster = [replace(m, role=roles.get(m.id, Role.PURSUER)) for m in setup(4).roster]
    several = replace(setup(4), roster=tuple(roster))
    running = phase(Phase.RUNNING, tower.now_ns)
    tower.hear(several, running)
    tower.fly(3.0, 1, 2, 3, 4)
    assert {"track_stale:1", "track_stale:4"} <= tower.alerts()
    tower.hear(replace(running, out=(EvaderOutcome(1, OutcomeResult.CAPTURED, 1.0, 2, 1.0),)))
    tower.fly(6.0, 1, 2, 3, 4)
    assert "track_stale:1" not in tower.alerts()
    assert "no track of evader 4" in next(a.text for a in tower.picture.alerts if a.id == 4)


def test_the_table_names_whom_each_is_after(early: Picture, late: Picture) -> None:
    told = {row.id: row.cells for row in rows(early, "role", False)}
    assert told[6][1] == "→12"
    assert float(told[6][10]) == pytest.approx(_apart(early, 6, 12), abs=0.6)
    order = [row.id for row in rows(early, "role", False)]
    assert order == [1, 12, 13, *(id for quarry in EVADERS for id in AFTER if AFTER[id] == quarry)]
    assert {row.id: row.cells for row in rows(late, "id", False)}[1][11].startswith("captured by 2 at ")


def _apart(picture: Picture, a: int, b: int) -> float:
    places = [picture.vehicle(id).position for id in (a, b)]
    return sum((x - y) ** 2 for x, y in zip(*places, strict=True)) ** 0.5


def test_the_words_keep_evaders_apart(early: Picture, late: Picture, over: Picture) -> None:
    head = status_line(late, "", "", 300)[0][0]
    assert "E1 captured; E12 gap " in head
    assert "plan of 2: E12 way out" in head
    assert "3 evaders: 1 captured, 1 arrived, 1 escaped" in status_line(over, "", "", 300)[0][0]
    assert any(text.startswith("after it: ") for text, _ in detail(late, 13))
    assert any(text == "after evader 12" for text, _ in detail(early, 6))
    assert any(text.startswith("evader 12 ") and "closing" in text for text, _ in detail(early, 6))
    assert any(text.startswith("targets ") and text.count(",") == 1 for text, _ in detail(early, 12))
    assert any("E12 way out" in line for line in status(late))


def test_where_the_odds_say_nothing_they_say_why(early: Picture) -> None:
    """The table's games have one evader: the bound is told of those who are after it, a chance is not."""
    for found in early.assessments:
        assert found.captured is None
        assert found.why.startswith("by those after it: bound: ")
    judged = engagements_in(early.game, early.vehicles, early.tracks)
    assert {id: len(situation.team) for id, situation in judged.items()} == {1: 4, 12: 3, 13: 3}
    told = lines(judged[12], beyond_one(early.game, 12))
    assert told[1].endswith("says nothing here: evaders: found 3, the table's games have 1")
    silent = replace(early, game=replace(early.game, quarries=()))
    told = assessments(silent.game, silent.vehicles, silent.tracks)
    assert {found.why for found in told} == {"no odds: whom each pursuer is after is not told"}


def test_the_map_of_the_console_has_all_of_them(late: Picture) -> None:
    view = plan.fitted(plan.START, late, 100, 40)
    drawn = plan.plan(late, view, 100, 40, None)
    text = "\n".join("".join(part for part, _ in row) for row in drawn)
    for sign in ("E12", "E13", "captured", "◎12", "◎13", "◎1"):
        assert sign in text, sign
    assert sum(palette.ZONE.dark in style for row in drawn for _, style in row) > 4
    assert text.count("◎12") == 2


def test_two_evaders_too_near_each_other_are_an_alert() -> None:
    tower = Tower()
    both = replace(setup(3, separation=10.0), roster=tuple(
        replace(member, role=Role.PURSUER if member.id == 3 else Role.EVADER) for member in setup(3).roster
    ))  # fmt: skip
    tower.hear(both)
    for id, east in ((1, 0.0), (2, 6.0), (3, 3.0)):
        role = Role.PURSUER if id == 3 else Role.EVADER
        tower.hear(state(id, tower.now_ns, role=role, position=(0.0, east, -50.0)))
    tower.wait(0.2)
    assert {name for name in tower.alerts() if name.startswith("separation")} == {"separation:1:2"}


def test_colours_tell_evaders_apart() -> None:
    roles = {id: Role.EVADER for id in EVADERS} | {id: Role.PURSUER for id in AFTER} | {99: None}
    found = sides.colours(roles)
    assert found[1] == palette.EVADER
    assert len({found[id] for id in EVADERS}) == 3
    assert not {found[id] for id in EVADERS} & {found[id] for id in AFTER}
    assert found[99] == palette.FAINT
    assert sides.colours({7: Role.EVADER})[7] == palette.EVADER, "the only one has the same, whatever its id"


def test_the_page_is_told_all_of_it(late: Picture, over: Picture) -> None:
    field, board = documents.field(late), documents.board(late, "")
    assert [goal["evader"] for goal in field["targets"]] == [1, 12, 12, 13]
    assert [zone["name"] for zone in field["zones"]] == ["mast", "village"]
    assert [(zone["floor"], zone["ceiling"]) for zone in field["zones"]] == [(None, 90.0), (None, None)]
    assert [found["evader"] for found in board["situation"]["evaders"]] == [12, 13]
    assert board["situation"]["words"].startswith("evader 1 captured; evader 12 widest way out ")
    assert board["game"]["out"] == [{"id": 1, "word": "captured"}]
    assert {row["id"]: row["cells"][1] for row in board["vehicles"]}[6] == "after 12"
    assert documents.board(over, "")["game"]["outcome"]["words"].startswith("3 evaders: ")
    assert over.game.setup.rules.R == R


def test_what_pursuers_know_of_targets_counts_where_no_brief_was_heard() -> None:
    tower = Tower()
    known: Setup = replace(setup(3), target=(500.0, 0.0, -50.0))
    tower.hear(known)
    assert [(goal.evader, goal.place) for goal in tower.picture.game.targets] == [(1, (500.0, 0.0, -50.0))]


def test_what_the_team_knows_is_told_with_its_goal_and_strengths(early: Picture, late: Picture) -> None:
    """The planner's own words: of each evader in the game, while its plan is the one that is flown."""
    assert [word.quarry for word in early.game.knowledge] == [1, 12, 13]
    assert [word.quarry for word in late.game.knowledge] == [12, 13], "evader 1 is out"
    word = early.game.knowledge[1]
    told = known_lines(early)
    start = told.index(f"evader 12: {goal_in_words(word.goal)}")
    shown = list(takewhile(lambda line: line.startswith("  "), told[start + 1 :]))
    said = {f"  {edge.words} ({edge.strength:.2f})": edge for edge in word.edges}
    assert set(shown) <= set(said)
    threats = [edge for edge in word.edges if edge.relation == "threatens"]
    assert threats, "it can reach a target before the horizon"
    assert sum("threatens" in line for line in shown) == len(threats)
    covers = [edge for edge in word.edges if edge.relation == "covers"]
    for target in {edge.sink for edge in covers}:
        best = max((edge for edge in covers if edge.sink == target), key=lambda edge: edge.strength)
        assert f"  {best.words} ({best.strength:.2f})" in shown
    assert not any("slower" in line for line in shown)


def test_a_goal_is_a_line_of_the_console(early: Picture) -> None:
    told = [line[0][0] for line in alert_lines(early, 100, 8)]
    assert [line for line in told if line.startswith("goal ")] == [
        f"goal E{word.quarry}: {goal_in_words(word.goal)}" for word in early.game.knowledge
    ]
    assert alert_lines(early, 100, 1) == [[("no alerts", "dim")]], "alerts go before goals"
    assert any(text.startswith("the team's goal: ") for text, _ in detail(early, 6))
    assert any(text.startswith("the pursuers' goal: ") for text, _ in detail(early, 12))
    assert any(" STATUS goal E12: " in line for line in status(early))


def test_a_word_counts_while_it_is_fresh_and_of_the_planner_alone() -> None:
    tower = Tower()
    tower.hear(setup(3), phase(Phase.RUNNING))
    goal = PlannedGoal(1, TeamGoal.RING, 0, "ring", "there are enough")
    word = Knowledge(2, tower.now_ns, 1.0, 1, (), (), goal)
    tower.hear(word, replace(word, id=3, goal=replace(goal, goal=TeamGoal.CHASE)))
    assert tower.picture.game.knowledge == (), "nobody plans"
    plan = TeamPlan(2, tower.now_ns, 1.0, (), False, 0.5, 0.0, 0.0)
    tower.hear(plan)
    assert tower.picture.game.knowledge == (word,)
    for _ in range(60):
        tower.wait(0.1)
        tower.hear(plan)
    assert tower.picture.game.knowledge == (), "the last word is six seconds old"


def test_a_users_own_relation_is_told_and_who_is_after_another_evader_is_not_lost() -> None:
    nodes = (
        KnowledgeNode(NodeKind.EVADER, 1, "evader 1", (0.0, 0.0, 0.0)),
        KnowledgeNode(NodeKind.PURSUER, 2, "pursuer 2", (50.0, 0.0, 0.0)),
    )
    edges = (
        KnowledgeEdge("slower", 1, 0, 0.9, 0.5, "pursuer 2 is slower"),
        KnowledgeEdge("lost", 1, 0, 1.0, 0.0, "pursuer 2 is lost to the team"),
        KnowledgeEdge("sun_behind", 1, 0, 0.7, 0.7, "pursuer 2 has the sun behind it"),
    )
    word = Knowledge(2, 0, 1.0, 1, nodes, edges, PlannedGoal(1, TeamGoal.NONE, 0, "", ""))
    own = "pursuer 2 has the sun behind it"
    assert [edge.words for edge in knowledge.told(word, {})] == ["pursuer 2 is lost to the team", own]
    assert [edge.words for edge in knowledge.told(word, {2: 12})] == [own], "it is after another evader"
    (arc,) = knowledge.arcs(word, {2: 12})
    assert (arc.source, arc.ends, arc.words) == (2, ((50.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "sun_behind 0.70")


def test_many_evaders_are_counted_not_listed(early: Picture) -> None:
    (first, *_) = early.assessments
    many = tuple(replace(first, evader=id, encircled=id < 5, largest_gap=0.1 * id) for id in range(1, 9))
    said = situation_in_words(replace(early, assessments=many))
    assert said == "evaders: 4 encircled, 4 with a way out, the widest 46° of 8"


def test_a_scenario_of_several_evaders_is_assessed_each_by_each(capsys: pytest.CaptureFixture[str]) -> None:
    code = assess_file(configs() / "scenarios" / "flight" / "three-on-ten.toml")
    told = capsys.readouterr().out.splitlines()
    assert [line for line in told if line.startswith("evader ")] == ["evader 1", "evader 12", "evader 13"]
    words = [line.partition(":")[0] for line in told[1::3]]
    assert len(words) == 3
    assert code == (1 if "no-go" in words else 0)
    assert sum("the table's games have 1" in line for line in told) == 3


def test_of_those_who_cover_a_target_the_best_is_told_whatever_their_order() -> None:
    nodes = (
        KnowledgeNode(NodeKind.TARGET, 1, "target 1", (0.0, 0.0, 0.0)),
        *(KnowledgeNode(NodeKind.PURSUER, id, f"pursuer {id}", (10.0 * id, 0.0, 0.0)) for id in (2, 3, 4)),
    )
    strengths = (0.4, 0.9, 0.2)
    edges = [KnowledgeEdge("covers", k, 0, s, 1.0, f"{s}") for k, s in enumerate(strengths, 1)]
    for order in (edges, edges[::-1]):
        word = Knowledge(2, 0, 1.0, 1, nodes, tuple(order), PlannedGoal(1, TeamGoal.NONE, 0, "", ""))
        assert [edge.words for edge in knowledge.told(word, {})] == ["0.9"]


def test_nobody_is_after_an_evader_that_is_out_though_old_words_say_so() -> None:
    several = flight_setup("test")
    told = decision(2, quarry=1), decision(6, quarry=12)
    tower = Tower()
    running = phase(Phase.RUNNING, tower.now_ns)
    tower.hear(several, running, *told)
    assert tower.picture.game.quarries == ((2, 1), (6, 12))
    tower.hear(replace(running, out=(EvaderOutcome(1, OutcomeResult.CAPTURED, 1.0, 2, 1.0),)))
    assert tower.picture.game.quarries == ((6, 12),)
