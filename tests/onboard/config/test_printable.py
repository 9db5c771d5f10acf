"""Words of strangers in a line."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from onboard.config.printable import LENGTH_MAX, named, printable, words_of


@given(st.text())
def test_no_text_can_steer_a_terminal_or_forge_a_line(text: str) -> None:
    shown = printable(text)
    assert shown.isprintable()
    assert len(shown) == len(text)
    assert printable(shown) == shown


def test_plain_words_stay() -> None:
    assert printable("Höhe 30 m, ψ = 5°") == "Höhe 30 m, ψ = 5°"
    assert printable("\x1b[2J\nok\u202e") == "·[2J·ok·"


def test_an_exception_says_its_words_in_one_line() -> None:
    assert words_of(ValueError("a\nb  c")) == "a b c"
    assert words_of(ValueError()) == "ValueError"
    assert named(KeyError("x")) == "KeyError: 'x'"
    assert named(ValueError()) == "ValueError"
    assert len(named(ValueError("x" * 10**6))) <= LENGTH_MAX


def test_an_exception_whose_words_fail_is_told_by_its_type() -> None:
    class Bad(BaseException):
        def __str__(self) -> str:
            raise SystemExit(3)

    assert named(Bad()) == "Bad"
    assert named(type("\x1b[31mRed", (Exception,), {})("hot")) == "·[31mRed: hot"
