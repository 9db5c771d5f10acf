"""`gcs page`: the page of a live game, or of recordings. Returns an exit code."""

from __future__ import annotations

import asyncio
import secrets
import signal
import ssl
import sys
from collections.abc import AsyncIterator
from contextlib import ExitStack, asynccontextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from gcs.page.access import Doors, loopback
from gcs.picture.thresholds import Thresholds
from gcs.session import Session, on_air
from gcs.settings import PageSettings, Settings
from onboard.config.strict import ConfigError
from onboard.config.version import version
from onboard.runtime.clock import RealClock
from onboard.runtime.off_loop import off_loop
from onboard.runtime.progress import Progress
from onboard.runtime.secret_files import read_secret
from onboard.wire.bus.messages import Severity

if TYPE_CHECKING:
    from gcs.page.hub import Hub
    from gcs.page.replay import PageReplay

TOKEN_BYTES = 24
TOKEN_LEAST = 16  # characters of a user's own


async def live(settings: Settings) -> int:
    """Serve the page of what is on the bus, until ctrl-C or SIGTERM."""
    doors, tls = guarded(settings.page)
    record = settings.recording.enabled
    async with on_air(settings, listen=settings.bus.listen, record=record) as session:
        try:
            async with _serving(session, settings.page, doors, tls) as address:
                print(address, flush=True)
                await _told_to_stop()
        finally:
            if session.farewell():
                print(session.farewell(), flush=True)
    return 0


async def replay(settings: Settings, runs: tuple[Path, ...]) -> int:
    """Serve the page of one recording, or of two beside each other, until ctrl-C or SIGTERM."""
    from gcs.page.hub import Hub

    if settings.page.control:
        raise ConfigError("page.control: found with a recording, which nobody can command")
    doors, tls = guarded(settings.page)
    with ExitStack() as stack:
        hubs = []
        for run in runs:
            source = await off_loop(partial(_source, run, settings.alerts, stack))
            hubs.append(Hub(source, version(), source))
        async with _hubs_served(hubs, settings.page, doors, tls) as address:
            print(address, flush=True)
            await _told_to_stop()
    return 0


def _source(run: Path, limits: Thresholds, stack: ExitStack) -> PageReplay:
    """The recording of a run, played through once; it is read long after, until `stack` closes it."""
    from gcs.page.replay import PageReplay, marks_of, opened
    from gcs.replay.source import open_run
    from gcs.report.program import read_run

    recording = open_run(run)
    stack.callback(recording.close)
    for remark in recording.remarks:
        print(f"gcs: {remark}", file=sys.stderr)
    with Progress("gcs") as progress:
        found = opened(recording, limits, version(), lambda share: progress.show(share, "reading"))
    told = marks_of(recording, found, read_run(run, limits, version()))
    return PageReplay(found.player, run.resolve().name, RealClock().monotonic_ns, told)


async def _told_to_stop() -> None:
    """Return at ctrl-C or SIGTERM."""
    stop, loop = asyncio.Event(), asyncio.get_running_loop()
    numbers = (signal.SIGINT, signal.SIGTERM)
    for number in numbers:
        loop.add_signal_handler(number, stop.set)
    try:
        await stop.wait()
    finally:
        for number in numbers:
            loop.remove_signal_handler(number)


@asynccontextmanager
async def beside(session: Session, settings: PageSettings) -> AsyncIterator[None]:
    """Serve the page of a session beside its console within the block, where the settings ask for it.

    Its address is a line of the log, which everybody may read: so the token of one that commands comes from a
    file.
    """
    if not settings.enabled:
        yield
        return
    far = not loopback(settings.host)
    if not settings.token_file and not settings.tls_keys and (settings.control or far):
        raise ConfigError(
            "page.token_file: found none, expected one for a page beside the console that commands"
        )
    async with _serving(session, settings, *guarded(settings)) as address:
        session.station.remark(Severity.INFO, "page", address)
        yield


@asynccontextmanager
async def _serving(
    session: Session, settings: PageSettings, doors: Doors, tls: ssl.SSLContext | None
) -> AsyncIterator[str]:
    from gcs.page.hub import Hub

    async with _hubs_served([Hub(session, version())], settings, doors, tls) as address:
        yield address


@asynccontextmanager
async def _hubs_served(
    hubs: list[Hub], settings: PageSettings, doors: Doors, tls: ssl.SSLContext | None
) -> AsyncIterator[str]:
    """Serve one hub or two within the block; it yields the line that tells the address."""
    from gcs.page.server import Address, PageServer, served
    from gcs.page.tiles import opened_map

    map = await off_loop(partial(opened_map, Path(settings.map))) if settings.map else None
    server = PageServer(hubs[0], doors, hubs[1] if len(hubs) > 1 else None, map)
    async with (
        served(server, Address(settings.host, settings.port, tls)) as port,
        asyncio.TaskGroup() as tasks,
    ):
        feeding = [tasks.create_task(hub.run(), name="page") for hub in hubs]
        try:
            yield address_line(settings, doors, port)
        finally:
            for task in feeding:
                task.cancel()


def address_line(settings: PageSettings, doors: Doors, port: int) -> str:
    """Where the page is, for people; with the token where it is needed."""
    host = "localhost" if loopback(settings.host) else settings.host
    scheme = "https" if settings.tls_certificate or settings.tls_keys else "http"
    needed = (settings.control or not loopback(settings.host)) and doors.members is None
    query = f"/?token={doors.token}" if needed and not settings.token_file else "/"
    what = "shows and commands" if settings.control else "shows only; --control lets it command"
    return f"page: {scheme}://{host}:{port}{query} ({what})"


def guarded(settings: PageSettings) -> tuple[Doors, ssl.SSLContext | None]:
    """Who is let in, and the encryption. Raises ConfigError."""
    if settings.tls_keys:
        return _by_field_keys(settings)
    far = not loopback(settings.host)
    if settings.token_file:
        token = read_secret(Path(settings.token_file), "token of the page").decode("ascii", "replace").strip()
        if len(token) < TOKEN_LEAST:
            raise ConfigError(
                f"{settings.token_file}: found a token of {len(token)} characters,"
                f" expected {TOKEN_LEAST} at least"
            )
    else:
        token = secrets.token_urlsafe(TOKEN_BYTES)
    if (settings.tls_key or settings.tls_clients) and not settings.tls_certificate:
        given = "tls_key" if settings.tls_key else "tls_clients"
        raise ConfigError(f"page.{given}: found without page.tls_certificate, expected with it")
    if far and not settings.tls_certificate and settings.control:
        raise ConfigError(
            f"page.control at {settings.host}: found no page.tls_certificate, expected one:"
            " without TLS the token can be read on its way"
        )
    return Doors(token, settings.control, settings.host, (), bool(settings.tls_clients)), _tls(settings)


def _by_field_keys(settings: PageSettings) -> tuple[Doors, ssl.SSLContext]:
    from gcs.page.field_tls import field_keys

    for other in ("tls_certificate", "tls_key", "tls_clients", "token_file"):
        if getattr(settings, other):
            raise ConfigError(f"page.tls_keys: found with page.{other}, expected one of the two")
    keys = field_keys(Path(settings.tls_keys))
    return Doors("", settings.control, settings.host, (keys.host,), True, keys.members), keys.tls


def _tls(settings: PageSettings) -> ssl.SSLContext | None:
    if not settings.tls_certificate:
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(settings.tls_certificate, settings.tls_key or None)
        if settings.tls_clients:
            context.load_verify_locations(settings.tls_clients)
            context.verify_mode = ssl.CERT_REQUIRED
    except (OSError, ssl.SSLError) as error:
        words = error.strerror or str(error)
        raise ConfigError(f"{settings.tls_certificate}: not a certificate and key in PEM ({words})") from None
    return context
