"""One BLAS thread, as every program sets it; the same examples every time; time limits that fit the machine;
programs that are started buffer what they print, as a user's do.

With more threads small matrices take ten times as long. With `HYPOTHESIS_PROFILE=long` (`make check-long`)
the examples are others with each `--hypothesis-seed`.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from pathlib import Path

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
os.environ.pop("PYTHONUNBUFFERED", None)  # few users have it: programs must do without

import pytest  # noqa: E402  (threads are set before NumPy is imported)
from hypothesis import settings  # noqa: E402

from tests.support.interrupts import hear_interrupts  # noqa: E402
from tests.support.real_time import slowness  # noqa: E402

hear_interrupts()

settings.register_profile("ci", derandomize=True, deadline=None, print_blob=True)
settings.register_profile("long", deadline=None, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))


def pytest_configure(config: pytest.Config) -> None:
    """Of several workers each begins to read at another place: what one has compiled the others load. In a
    tree that was never tested all of them would compile all of it, twenty seconds of processor time each."""
    place = Path(__file__).parent
    worker = os.environ.get("PYTEST_XDIST_WORKER", "")
    count = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if worker.startswith("gw") and [Path(config.rootpath, word) for word in config.args] == [place]:
        files = sorted(place.rglob("test_*.py"))
        rooms = sorted({place / file.relative_to(place).parts[0] for file in files})
        number = int(worker[2:]) % count  # one that takes a dead one's place has a number of its own
        begun = files[len(files) * number // count].relative_to(place).parts[0]
        first = rooms.index(place / begun)
        config.args[:] = [str(room) for room in (*rooms[first:], *rooms[:first])]


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """By files, wherever a worker began; but what may take longer than usual first: no worker is left with
    it alone at the end, and kernels that several need are compiled before another worker waits for them."""
    usual_s = float(config.getini("timeout"))

    def short(item: pytest.Item) -> bool:
        own = item.get_closest_marker("timeout")
        return own is None or float(own.args[0]) <= usual_s

    items.sort(key=lambda item: (short(item), item.path))  # otherwise as they were


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Give the test its time limit times the slowness of the machine, before the limit begins to run."""
    asked = item.config.getoption("timeout")
    usual_s = float(item.config.getini("timeout") if asked is None else asked)
    own = item.get_closest_marker("timeout")
    limit_s = float(own.args[0]) if own is not None else usual_s
    item.add_marker(pytest.mark.timeout(limit_s * max(2.0, slowness())), append=False)
    return (yield)
