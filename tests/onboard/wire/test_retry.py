"""The one policy of trying again, as a receiver that hears, refuses or stays silent would see it."""

from __future__ import annotations

from onboard.wire.retry import CommandRetry, RetryPolicy

POLICY = RetryPolicy(100, patience=5, slow=1000, after_accepted=2000, after_refused=500)  # [ms]


def sent(retry: CommandRetry, start: int, end: int) -> list[int]:
    """When it is sent, asked every 50 ms [ms]."""
    return [now for now in range(start, end, 50) if retry.due(now)]


def test_quick_until_patience_ends_then_slow_without_end() -> None:
    retry = CommandRetry(POLICY)
    assert sent(retry, 0, 4000) == [0, 100, 200, 300, 400, 1400, 2400, 3400]
    assert retry.unanswered
    assert retry.tries == 8


def test_each_wait_may_be_longer_than_the_one_before() -> None:
    retry = CommandRetry(POLICY._replace(growth=2.0, patience=9))
    assert sent(retry, 0, 4000) == [0, 100, 300, 700, 1500, 2500, 3500]


def test_no_more_tries_than_allowed() -> None:
    retry = CommandRetry(RetryPolicy(100, most=3))
    assert sent(retry, 0, 5000) == [0, 100, 200]


def test_what_was_accepted_waits_and_asks_for_its_proof() -> None:
    retry = CommandRetry(POLICY)
    assert retry.due(0)
    assert not retry.proof_due(0)
    retry.accepted(50)
    assert not retry.unanswered
    assert [now for now in (50, 100, 150, 300) if retry.proof_due(now)] == [50, 150, 300]
    assert sent(retry, 100, 2500) == [2050, 2150, 2250, 2350]  # then slowly


def test_a_refusal_waits_and_each_reason_is_new_once() -> None:
    retry = CommandRetry(POLICY)
    assert retry.due(0)
    assert [retry.refused(50, reason) for reason in (4, 4, 1, 4)] == [True, False, True, True]
    assert sent(retry, 100, 800) == [550, 650, 750]


def test_the_unit_of_time_is_the_callers() -> None:
    retry = CommandRetry(RetryPolicy(80_000_000))
    begin = 1_800_000_000_123_456_789
    assert retry.due(begin)
    assert not retry.due(begin + 79_999_999)
    assert retry.due(begin + 80_000_000)
