"""Who plays the shards: this process, processes beside it, or a Dask cluster.

All of them give a shard's bytes; only the campaign's own process writes.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache
from multiprocessing import resource_tracker
from multiprocessing.connection import wait as wait_for
from types import FrameType
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.progress import Tell, silent
from sim_bridge.programs.campaigns.plan import Plan, Shard, checked
from sim_bridge.programs.campaigns.play import rows
from sim_bridge.programs.campaigns.shards import encoded, manifest

RETRIES = 3  # of a shard whose worker died
AHEAD = 2  # shards a worker that wait or are played

Played = Iterator[tuple[Shard, bytes]]


def play_here(plan: Plan, shards: list[Shard], tell: Tell = silent) -> Played:
    """In this process, in order."""
    for shard in shards:
        yield shard, encoded(plan, shard, rows(plan, shard, tell))


def shard_bytes(plan: bytes, number: int) -> bytes:
    """A shard of a plan (as its manifest writes it): what a worker is asked for."""
    found = _plan_of(plan)
    shard = found.shard(number)
    return encoded(found, shard, rows(found, shard))


@lru_cache(2)
def _plan_of(manifest: bytes) -> Plan:
    """A plan, read once a worker."""
    return checked(manifest, "plan")


# ---------------------------------------------------------------- processes


def play_in_processes(plan: Plan, shards: list[Shard], workers: int) -> Played:
    """In so many processes, in the order in which they end. A worker's death costs its shard's time alone.

    Raises ConfigError where a shard's workers died time and again.
    """
    waiting, deaths = list(shards), 0
    while waiting:
        pool = _pool(workers)
        try:
            for shard, data in _through(pool, plan, waiting, workers):
                waiting.remove(shard)
                deaths = 0
                yield shard, data
            pool.shutdown()
        except BrokenProcessPool:
            deaths += 1
            _end(pool)
            if deaths > RETRIES:
                raise ConfigError(
                    f"--workers: found workers that died {deaths} times (no memory?); try fewer"
                ) from None
        except BaseException:
            _end(pool)
            raise


def _pool(workers: int) -> ProcessPoolExecutor:
    resource_tracker.ensure_running()  # as it starts it would let interrupts in again
    return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), initializer=_begin)


def _begin() -> None:
    """In a worker: ctrl-C is the parent's business, and without a parent there is nothing to do."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        wait_for([sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True, name="parent").start()


def _through(pool: ProcessPoolExecutor, plan: Plan, shards: list[Shard], workers: int) -> Played:
    told = manifest(plan)
    running: dict[Future[bytes], Shard] = {}
    queue = iter(list(shards))
    while True:
        for shard in queue:
            with _interrupts_held_back():  # what starts a worker: it shall not hear ctrl-C either
                running[pool.submit(shard_bytes, told, shard.number)] = shard
            if len(running) >= AHEAD * workers:
                break
        if not running:
            return
        done, _rest = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            yield running.pop(future), future.result()


@contextlib.contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Ctrl-C waits until it is over; a process that is started meanwhile does not hear it at all.

    The mask is for the process that is started: of this one another thread may take the signal.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[tuple[int, FrameType | None]] = []
    heard = signal.signal(signal.SIGINT, lambda number, frame: came.append((number, frame)))
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, heard)
        if came and callable(heard):
            heard(*came[0])  # whatever else went wrong


def _end(pool: ProcessPoolExecutor) -> None:
    """End a pool now: what its workers are at is lost."""
    workers: Any = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for worker in workers:
        worker.terminate()
    for worker in workers:
        worker.join()


# ---------------------------------------------------------------- a Dask cluster


def play_on_dask(plan: Plan, shards: list[Shard], address: str) -> Played:
    """On a Dask cluster, whose workers have this distribution; a shard whose worker died is played again.

    Raises ConfigError where nobody answers there, or a worker has other sources.
    """
    try:
        import distributed
        from distributed.comm.addressing import get_address_host_port
    except ImportError:
        raise ConfigError("--dask: found no Dask here, expected: pip install 'apollonius[cluster]'") from None
    make: Any = distributed.Client
    completed: Any = distributed.as_completed
    located: Callable[..., Any] = get_address_host_port
    try:
        located(address, strict=True)  # for a client of a misspelt address tells it a second time as it goes
        client: Any = make(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise ConfigError(f"--dask: {address}: found {error}, expected a scheduler of Dask") from None
    with client:
        told = manifest(plan)
        asked: Callable[..., Any] = dask_bytes
        numbered = [shard.number for shard in shards]
        futures = client.map(asked, numbered, plan=told, pure=False, retries=RETRIES)
        numbers = {future.key: shard for future, shard in zip(futures, shards, strict=True)}
        try:
            for future, found in completed(futures, loop=client.loop, with_results=True):
                sources, data = found
                if sources != plan.fingerprint.sources:
                    raise ConfigError(f"--dask: {address}: found a worker with other sources, expected these")
                yield numbers[future.key], data
                future.release()
        finally:
            client.cancel(futures)


def dask_bytes(number: int, plan: bytes) -> tuple[str, bytes]:
    """A shard of a plan, and the sources that a worker of the cluster has played it by."""
    from sim_bridge.programs.campaigns.fingerprint import COMPUTED, FLOWN, sources

    return sources(FLOWN if _plan_of(plan).flown else COMPUTED), shard_bytes(plan, number)
