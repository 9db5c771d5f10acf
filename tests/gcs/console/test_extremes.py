"""Whatever finite numbers the bus brings, picture, alerts and every panel bear them."""

from __future__ import annotations

import msgspec
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gcs.console import plan
from gcs.console.detail import detail
from gcs.console.plain_lines import PlainLines
from gcs.console.status_line import alert_lines, log_lines, status_line, whole_text
from gcs.console.vehicle_table import line, rows
from gcs.picture.json_document import to_json
from onboard.wire.bus import messages
from onboard.wire.bus.messages import Phase, Role
from tests.support.sample_messages import START_NS, Tower, decision, health, phase, setup, state, track

number = st.floats(allow_nan=False, allow_infinity=False) | st.sampled_from([0.0, 1e-300, 1.7e308, -1.7e308])
triple = st.tuples(number, number, number)
four = st.tuples(number, number, number, number)
whole = st.integers(-(2**62), 2**62)
words = st.text(max_size=12)
fence = st.builds(messages.Fence, st.lists(st.tuples(number, number), max_size=4).map(tuple), number, number)
said = st.one_of(
    st.fixed_dictionaries({
        "position": triple, "velocity": triple, "wind": triple, "airspeed": number, "yaw": number,
    }).map(lambda d: state(2, **d)),
    st.fixed_dictionaries({"position": triple, "velocity": triple, "role": st.just(Role.EVADER)}).map(
        lambda d: state(1, **d)
    ),
    st.fixed_dictionaries({
        "battery": number, "link_quality": number, "clock_offset_s": number, "telemetry_age_s": number,
        "telemetry_rate_hz": number, "stage": st.sampled_from(messages.AgentStage),
        "counters": st.dictionaries(words, whole, max_size=3),
    }).map(lambda d: health(2, **d)),
    st.fixed_dictionaries({
        "aim": triple, "time_to_aim": number, "miss": number, "rule": words,
        "supervisor": st.sampled_from(messages.SupervisorAction),
        "circles": st.lists(four, max_size=2).map(tuple), "predictor_sigma": number, "predictor": words,
    }).map(lambda d: decision(2, **d)),
    st.fixed_dictionaries({"position": triple, "velocity": triple}).map(lambda d: track(1, **d)),
    st.fixed_dictionaries({
        "R": number, "rho": number, "separation": number, "fence": st.none() | fence,
        "planar": st.booleans(), "pursuer_speed": number,
    }).map(lambda d: setup(3, **d)),
    st.builds(messages.Outcome, st.sampled_from(messages.OutcomeResult), number, whole, number, whole),
    st.builds(messages.EvaderBrief, triple, whole),
    st.builds(messages.PhaseChange, st.sampled_from(Phase), whole, whole),
    st.builds(messages.Master, words, whole, number, whole),
    st.builds(messages.Event, st.just(2), whole, whole, st.sampled_from(messages.Severity), words, words),
)  # fmt: skip


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(said, min_size=1, max_size=12), st.integers(1, 3))
def test_no_finite_message_breaks_the_picture_or_a_panel(told, selected):
    tower = Tower()
    tower.hear(setup(3), phase(Phase.RUNNING, START_NS))
    tower.hear(state(1), state(2), state(3), health(2), decision(2))
    for message in told:
        tower.hear(message)
        tower.wait(0.15)
    picture = tower.picture
    assert len(picture.vehicles) == 3
    view = plan.fitted(plan.START, picture, 60, 12)
    assert len(plan.plan(picture, view, 60, 12, selected)) == 12
    for row in rows(picture, "distance", True):
        assert len(line(row.cells, 80)) == 80
    assert detail(picture, selected)
    assert alert_lines(picture, 80, 5)
    assert log_lines(picture)
    assert whole_text(picture, selected, detail(picture, selected))
    assert status_line(picture, "live", "", 80)
    assert PlainLines().lines(picture)
    assert msgspec.json.decode(to_json(picture))
