"""`gcs page`: the page of a live game, or of recordings. Returns an exit code."""

from __future__ import annotations

import asyncio
import secrets
import signal
import ssl
from contextlib import AsyncExitStack
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from gcs.page.access import Doors, loopback
from gcs.session import Session, on_air
from gcs.settings import Settings
from onboard.config.strict import ConfigError
from onboard.config.version import version
from onboard.runtime.secret_files import read_secret

if TYPE_CHECKING:
    from gcs.page.hub import Hub

TOKEN_BYTES = 24
TOKEN_LEAST = 16  # characters of a user's own


class PageOptions(NamedTuple):
    """How a page is served."""

    host: str = "127.0.0.1"
    port: int = 8765
    control: bool = False
    token_file: Path | None = None
    certificate: Path | None = None  # PEM, its key beside it or in it
    key: Path | None = None
    clients: Path | None = None  # PEM of the authority whose client certificates are let in


async def live(settings: Settings, options: PageOptions) -> int:
    """Serve the page of what is on the bus, until ctrl-C or SIGTERM."""
    doors, tls = guarded(options)
    record = settings.recording.enabled
    async with on_air(settings, listen=settings.bus.listen, record=record) as session:
        try:
            return await beside(session, options, doors, tls)
        finally:
            if session.farewell():
                print(session.farewell(), flush=True)


async def beside(session: Session, options: PageOptions, doors: Doors, tls: ssl.SSLContext | None) -> int:
    """Serve the page of a session that somebody else owns, until ctrl-C or SIGTERM."""
    from gcs.page.hub import Hub

    return await _serve(Hub(session, version()), options, doors, tls)


async def _serve(hub: Hub, options: PageOptions, doors: Doors, tls: ssl.SSLContext | None) -> int:
    from gcs.page.server import Address, PageServer, served

    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    async with AsyncExitStack() as stack:
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, stop.set)
            stack.callback(loop.remove_signal_handler, number)
        server = PageServer(hub, doors)
        port = await stack.enter_async_context(served(server, Address(options.host, options.port, tls)))
        feeding = loop.create_task(hub.run(), name="page")
        stack.callback(feeding.cancel)
        print(address_line(options, doors, port), flush=True)
        stopped = loop.create_task(stop.wait())
        await asyncio.wait({feeding, stopped}, return_when=asyncio.FIRST_COMPLETED)
        if feeding.done():
            feeding.result()
    return 0


def address_line(options: PageOptions, doors: Doors, port: int) -> str:
    """Where the page is, for people; with the token where it is needed."""
    host = "localhost" if loopback(options.host) else options.host
    scheme = "https" if options.certificate else "http"
    needed = options.control or not loopback(options.host)
    query = f"/?token={doors.token}" if needed and options.token_file is None else "/"
    what = "shows and commands" if options.control else "shows only; --control lets it command"
    return f"page: {scheme}://{host}:{port}{query} ({what})"


def guarded(options: PageOptions) -> tuple[Doors, ssl.SSLContext | None]:
    """Who is let in, and the encryption. Raises ConfigError."""
    far = not loopback(options.host)
    if options.token_file is not None:
        token = read_secret(options.token_file, "token of the page").decode("ascii", "replace").strip()
        if len(token) < TOKEN_LEAST:
            raise ConfigError(
                f"{options.token_file}: found a token of {len(token)} characters,"
                f" expected {TOKEN_LEAST} at least"
            )
    else:
        token = secrets.token_urlsafe(TOKEN_BYTES)
    if (options.key or options.clients) and options.certificate is None:
        given = "--tls-key" if options.key else "--tls-clients"
        raise ConfigError(f"{given}: found without --tls-certificate, expected with it")
    if far and options.certificate is None and options.control:
        raise ConfigError(
            f"--control at {options.host}: found no --tls-certificate, expected one:"
            " without TLS the token can be read on its way"
        )
    return Doors(token, options.control, options.host, (), options.clients is not None), _tls(options)


def _tls(options: PageOptions) -> ssl.SSLContext | None:
    if options.certificate is None:
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        context.load_cert_chain(options.certificate, options.key)
        if options.clients is not None:
            context.load_verify_locations(options.clients)
            context.verify_mode = ssl.CERT_REQUIRED
    except (OSError, ssl.SSLError) as error:
        words = error.strerror or str(error)
        raise ConfigError(f"{options.certificate}: not a certificate and key in PEM ({words})") from None
    return context
