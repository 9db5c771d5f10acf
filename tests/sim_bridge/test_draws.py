"""Random numbers by counter, against the published vectors and against SciPy."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from scipy import stats

from sim_bridge import draws
from sim_bridge.campaign.compiled import register
from sim_bridge.draws import WORD, Key, Purpose, Stream, key_of, normal, normals, rows, threefry, uniform
from sim_bridge.vehicle.wind.dryden import gust_noise

# Random123's kat_vectors: "threefry2x32 20", counter and key, and what comes out.
KNOWN = [
    ((0x00000000, 0x00000000), (0x00000000, 0x00000000), (0x6B200159, 0x99BA4EFE)),
    ((0xFFFFFFFF, 0xFFFFFFFF), (0xFFFFFFFF, 0xFFFFFFFF), (0x1CB996FC, 0xBB002BE7)),
    ((0x243F6A88, 0x85A308D3), (0x13198A2E, 0x03707344), (0xC4923A9C, 0x483DF7A0)),
]


@pytest.mark.parametrize(("counter", "key", "out"), KNOWN)
def test_the_published_vectors(counter: tuple[int, int], key: tuple[int, int], out: tuple[int, int]) -> None:
    assert threefry(*key, *counter) == out
    arrays = threefry(*key, *(np.full(3, word, np.int64) for word in counter))
    assert [a.tolist() for a in arrays] == [[out[0]] * 3, [out[1]] * 3]


def test_interpreted_compiled_and_in_blocks_to_the_bit() -> None:
    register((draws.__name__,))
    key, count = key_of(3, 2, Purpose.GUST), 40_000

    @numba.njit
    def compiled(key: Key, count: int) -> np.ndarray:
        out = np.empty((count, 2))
        for step in range(count):
            a, b = threefry(key.a, key.b, step, 0)
            out[step, 0] = normal(a)
            out[step, 1] = normal(b)
        return out

    words = rows(key, 0, count, 2)
    found = normals(words)
    assert np.array_equal(compiled(key, count), found)
    assert [normal(word) for word in words[:3000].ravel().tolist()] == found[:3000].ravel().tolist()
    assert np.abs(found).max() > 4.0  # the tails are among them


def test_the_normal_numbers_are_the_inverse_of_the_distribution() -> None:
    words = np.unique(np.concatenate([np.arange(0, WORD, 200_003), [0, 1, 2, WORD - 1, WORD]]))
    expected = stats.norm.ppf((words + 0.5) / 2.0**32)
    expected[-2:] = -stats.norm.ppf((WORD - words[-2:] + 0.5) / 2.0**32)  # ppf itself is rough close to 1
    np.testing.assert_allclose(normals(words), expected, rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("purpose", Purpose)
def test_simple_statistics(purpose: Purpose) -> None:
    words = rows(key_of(11, 1, purpose), 0, 20_000, 6)
    p = [stats.kstest(uniform(words[:, column]), "uniform").pvalue for column in range(6)]
    assert min(p) > 1e-4
    numbers = normals(words)
    correlation = np.corrcoef(np.concatenate([numbers[1:], numbers[:-1]], axis=1).T)
    assert np.abs(correlation - np.eye(12)).max() < 5.0 / np.sqrt(20_000)


def test_every_key_and_step_has_numbers_of_its_own() -> None:
    keys = {key_of(seed, id, p) for seed in (0, 1, 2**32, 2**40 + 1) for id in (1, 2, 255) for p in Purpose}
    assert len(keys) == 4 * 3 * len(Purpose)
    assert len({tuple(row) for key in keys for row in rows(key, 0, 500, 2).tolist()}) == 500 * len(keys)


def test_a_stream_may_be_asked_in_any_order() -> None:
    key = key_of(5, 3, Purpose.SENSOR)
    forwards, other = Stream(key, 7, 1), Stream(key, 7, 1)
    said = {step: forwards.at(step) for step in range(600)}
    for step in (599, 3, 258, 3, 0):
        assert other.at(step) == said[step]
    assert 0.0 < said[0][0] < 1.0
    assert len(said[0]) == 7


def test_a_flight_and_a_compiled_game_are_driven_by_the_same_gusts() -> None:
    key = key_of(7, 4, Purpose.GUST)
    stream = Stream(key, 5)
    assert [list(gust_noise(key, tick)) for tick in range(300)] == [stream.at(tick) for tick in range(300)]


def test_how_many_steps_are_drawn_at_once_changes_no_number() -> None:
    key = key_of(5, 2, Purpose.PLACE)
    one, many = Stream(key, 4, 1, block=1), Stream(key, 4, 1)
    for step in (0, 1, 255, 256, 3):
        assert one.at(step) == many.at(step)
