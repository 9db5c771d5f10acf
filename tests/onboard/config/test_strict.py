"""Configuration files as people get them wrong: one line that names file, key, found and expected."""

from __future__ import annotations

import contextlib
from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Meta

from onboard.config import strict
from onboard.config.bounds import Latitude, Seed, Share, Speed
from onboard.config.names import GameName, game_name
from onboard.config.strict import ConfigError, StrictConfig, demand


class Shape(Enum):
    ROUND = "round"
    FLAT = "flat"


class Inner(StrictConfig, frozen=True):
    low: Speed = 0.0
    high: Speed | None = None
    where: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if self.high is not None:
            demand(self.low <= self.high, "low", self.low, f"at most high = {self.high:g}")


class Outer(StrictConfig, frozen=True):
    seed: Seed = 0
    share: Share = 0.5
    name: GameName = "game"
    shape: Shape = Shape.ROUND
    on: bool = True
    inner: Inner = Inner()
    list: Annotated[tuple[Inner, ...], Meta(max_length=3)] = ()
    bare: Annotated[float, Meta(gt=0, le=3)] = 1.0
    text: Annotated[str, Meta(min_length=2)] = "ab"


def refused(text: str) -> str:
    with pytest.raises(ConfigError) as error:
        strict.parse(text, Outer, "a.toml")
    line = str(error.value)
    assert line.startswith("a.toml: ")
    assert "\n" not in line
    return line.removeprefix("a.toml: ")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("seed = -1", "seed: found -1, expected a whole number from 0 to 2^63 − 1"),
        (f"seed = {2**63}", f"seed: found {2**63}, expected a whole number from 0 to 2^63 − 1"),
        ("seed = 1.0", "seed: found 1.0, expected a whole number from 0 to 2^63 − 1"),
        ("share = 1e300", "share: found 1e+300, expected a share in [0, 1]"),
        ("share = nan", "share: found nan, expected a finite number"),
        ("share = true", "share: found true, expected a number: a share in [0, 1]"),
        (f"share = 1{'0' * 400}", f"share: found 1{'0' * 59}…, expected a share in [0, 1]"),
        ("share = 1979-05-27", "share: found 1979-05-27, expected a number: a share in [0, 1]"),
        ("name = 'my game'", "name: found 'my game', expected a name without / * $ # ? @ or blanks"),
        ("name = ''", "name: found '', expected a name without"),
        ("shape = 'square'", "shape: found 'square', expected one of: round, flat"),
        ("on = 1", "on: found 1, expected true or false"),
        ("bare = 0", "bare: found 0, expected a number in (0, 3]"),
        ("text = 'a'", "text: found 'a', expected text of 2 or more characters"),
        ("nothing = 1", "nothing: unknown key"),
        ("inner.nothing = 1", "inner.nothing: unknown key"),
        ("inner = 3", "inner: found 3, expected a table"),
        ("inner = {low = 5, high = 3}", "inner.low: found 5.0, expected at most high = 3"),
        ("inner.high = -3", "inner.high: found -3, expected zero or more [m/s], at most 1000"),
        ("inner.where = [1.0]", "inner.where: found [1.0], expected 2 values"),
        ("inner.where = [1.0, 'x']", "inner.where[1]: found 'x', expected a number"),
        ("list = [{}, {low = 5, high = 3}]", "list[1].low: found 5.0, expected at most high = 3"),
        ("list = [{}, {low = -5}]", "list[1].low: found -5, expected zero or more [m/s], at most 1000"),
        ("list = [{}, {}, {}, {}, {}]", "list: found 5 values, expected a list of 0 to 3 values"),
        ("list = [{}, {}, {}, inf]", "list[3]: found inf, expected a finite number"),
        ("seed = [", "not valid TOML: "),
        ("seed = 1\nseed = 2", "not valid TOML: "),
        (f"seed = {'9' * 5000}", "not valid TOML: "),
        (f"list = {'[' * 10_000}{']' * 10_000}", "nested too deeply"),
        (f"list{'.a' * 10_000} = 1", "nested too deeply"),
        (f"[inner{'.a' * 10_000}]", "nested too deeply"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_in_one_line(text: str, told: str) -> None:
    assert refused(text).startswith(told)


def test_a_value_at_the_edge_of_its_range_is_taken() -> None:
    found = strict.parse(f"seed = {2**63 - 1}\nshare = 1\ninner = {{low = 3, high = 3}}", Outer, "a.toml")
    assert (found.seed, found.share, found.inner.low) == (2**63 - 1, 1.0, 3.0)


def test_a_single_value_is_checked_by_the_same_type() -> None:
    assert strict.convert(47.4, Latitude, "--latitude") == 47.4
    with pytest.raises(ConfigError) as error:
        strict.convert(90.0, Latitude, "--latitude")
    assert str(error.value) == "--latitude: found 90.0, expected a latitude between −90 and 90 deg, no pole"


def test_options_over_a_file_are_checked_with_it(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text("inner = {low = 5, high = 4}")
    found = strict.load(path, Outer, {"seed": 7, "inner.low": 2.0, "name": None})
    assert (found.seed, found.inner, found.name) == (7, Inner(low=2.0, high=4.0), "game")
    with pytest.raises(ConfigError, match=r"a\.toml: inner\.low: found 5\.0, expected at most high = 4"):
        strict.load(path, Outer, {"inner.low": None})
    path.write_text("inner = 3")
    with pytest.raises(ConfigError, match=r"a\.toml: inner: found 3, expected a table"):
        strict.load(path, Outer, {"inner.low": 2.0})


def test_options_alone_are_laid_over_the_defaults() -> None:
    assert strict.load(None, Outer, {}) == Outer()
    assert strict.load(None, Outer, {"inner.high": 3.0}).inner.high == 3.0
    for options, told in (
        ({"seed": -7}, "options: seed: found -7, expected a whole number"),
        ({"unknown": 1}, "options: unknown: unknown key"),
    ):
        with pytest.raises(ConfigError) as error:
            strict.load(None, Outer, options)
        assert str(error.value).startswith(told)


def test_a_struct_that_a_program_made_is_checked_too() -> None:
    assert strict.checked(Outer(share=0.25), "made") == Outer(share=0.25)
    with pytest.raises(ConfigError, match=r"^made: share: found 7\.0, expected a share"):
        strict.checked(Outer(share=7.0), "made")


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"\xff\xfe", "not UTF-8 text"),
        (b"#" * (strict.FILE_MAX + 1), "found more than 1048576 bytes, expected a configuration file"),
        (b"seed = 1\r\n", ""),
    ],
)
def test_any_file_is_read_or_refused(tmp_path: Path, content: bytes, told: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(content)
    if not told:
        assert strict.read(path, Outer).seed == 1
        return
    with pytest.raises(ConfigError) as error:
        strict.read(path, Outer)
    assert str(error.value) == f"{path}: {told}"


def test_what_is_no_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such file or directory"):
        strict.read(tmp_path / "missing.toml", Outer)
    with pytest.raises(ConfigError, match="is a directory"):
        strict.read(tmp_path, Outer)


_KEYS = st.sampled_from([*Outer.__struct_fields__, "x"])
_INNER_KEYS = st.sampled_from([*Inner.__struct_fields__, "x"])
_LEAF = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5) | st.dates()
_TABLE = st.dictionaries(_INNER_KEYS, _LEAF | st.lists(_LEAF, max_size=3), max_size=3)


@given(st.dictionaries(_KEYS, _LEAF | _TABLE | st.lists(_LEAF | _TABLE, max_size=4), max_size=3))
def test_no_data_raises_anything_else(data: dict[str, Any]) -> None:
    with contextlib.suppress(ConfigError):
        assert isinstance(strict.convert(data, Outer, "a.toml"), Outer)


@pytest.mark.parametrize("name", ["game", "game-1", "Wettkampf_2", "a.b", "игра"])
def test_a_name_that_can_be_a_key_of_the_bus_is_taken(name: str) -> None:
    assert game_name(name) == name


@pytest.mark.parametrize(
    "name", ["", "my game", "a/b", "*", "a**", "$x", "a#b", "a?b", "@x", "a\n", "a\tb", "a\x00", "a" * 65]
)
def test_a_name_that_cannot_is_refused(name: str) -> None:
    with pytest.raises(ConfigError, match=r"^--game: found .*expected a name without / "):
        game_name(name, "--game")
