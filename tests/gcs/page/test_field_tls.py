"""The page by a field's keys, before real TLS clients: the roster's stations get in, nobody else."""

from __future__ import annotations

import base64
import json
import ssl
from contextlib import asynccontextmanager
from pathlib import Path

import aiohttp
import pytest
from cryptography.hazmat.primitives.serialization import pkcs12

from gcs.keys.folder import BROWSER_FILE
from gcs.page.hub import NOT_ALLOWED
from gcs.page.program import address_line, guarded
from gcs.settings import PageSettings
from onboard.config.strict import ConfigError
from tests.gcs.page.test_doors import ABORT, orders, said
from tests.support.field_keys import Field
from tests.support.page_stage import stage
from tests.support.real_time import until

pytestmark = pytest.mark.real


def client_of(field: Field, member: str | None) -> ssl.SSLContext:
    """A client that trusts the field's authority and shows a member's certificate, or none."""
    context = ssl.create_default_context(cafile=str(field.folder / "authority.pem"))
    if member is not None:
        tls = json.loads(field.config(member).read_text())["transport"]["link"]["tls"]
        pair = field.folder.parent / f"{member}.pem"
        names = ("connect_certificate_base64", "connect_private_key_base64")
        pair.write_bytes(b"".join(base64.b64decode(tls[name]) for name in names))
        context.load_cert_chain(pair)
    return context


@asynccontextmanager
async def guarded_page(field: Field):
    listener = field.roster.members[0].name
    settings = PageSettings(tls_keys=str(field.folder / listener), control=True, host="127.0.0.1")
    doors, tls = guarded(settings)
    assert address_line(settings, doors, 1).startswith("page: https://localhost:1/ (")
    async with stage(2, doors=doors, tls=tls) as made:
        yield made, f"https://localhost:{made.port}/"


async def test_stations_get_in_and_order_as_the_roster_has_them(tmp_path: Path):
    field = Field(tmp_path / "keys").make()
    field.change('parts = ["master"]', 'parts = ["master"]\ncommands = false')
    field.make()
    async with guarded_page(field) as (made, url), aiohttp.ClientSession() as client:
        for member, may in (("ground", False), ("second", True)):
            context = client_of(field, member)
            async with client.get(url, ssl=context) as answer:
                assert answer.status == 200
                assert "<title>Apollonius</title>" in await answer.text()
            socket = await client.ws_connect(url.replace("https", "wss") + "live", ssl=context)
            await socket.send_str(ABORT)
            if may:
                await until(lambda: len(orders(made)) == 1)
            else:
                assert await said(socket) == NOT_ALLOWED
                assert orders(made) == []
            await socket.close()


async def test_without_a_certificate_or_with_a_strangers_nobody_gets_in(tmp_path: Path):
    field = Field(tmp_path / "keys").make()
    (tmp_path / "other").mkdir()
    other = Field(tmp_path / "other" / "keys").make()
    stranger = client_of(other, "vehicle-2")
    stranger.load_verify_locations(field.folder / "authority.pem")
    async with guarded_page(field) as (_, url), aiohttp.ClientSession() as client:
        for context in (client_of(field, None), stranger):
            with pytest.raises(aiohttp.ClientError):
                async with client.get(url, ssl=context) as answer:
                    await answer.read()
        with pytest.raises(aiohttp.ClientError):  # nor does anybody without TLS
            async with client.get(url.replace("https", "http")) as answer:
                await answer.read()


async def test_a_certificate_whose_key_was_raised_is_refused(tmp_path: Path):
    field = Field(tmp_path / "keys").make()
    shut_out = [client_of(field, member) for member in ("second", "vehicle-1", "radar")]
    field.change('name = "second"', 'name = "second"\nkey = 2')
    field.make()
    async with guarded_page(field) as (_, url), aiohttp.ClientSession() as client:
        for context in shut_out:  # a vehicle and a sensor may not hear the whole game
            async with client.get(url, ssl=context) as answer:
                assert answer.status == 403
                assert "is no station of the roster" in await answer.text()
        async with client.get(url, ssl=client_of(field, "second")) as answer:
            assert answer.status == 200


def test_a_browser_gets_its_certificate_as_a_file(tmp_path: Path):
    field = Field(tmp_path / "keys").make()
    for member in field.roster.members:
        content = (field.folder / member.name / BROWSER_FILE).read_bytes()
        key, certificate, _ = pkcs12.load_key_and_certificates(content, None)
        assert key.public_key() == certificate.public_key()
        assert member.certificate in certificate.subject.rfc4514_string()


@pytest.mark.parametrize(
    ("member", "settings", "words"),
    [
        ("vehicle-2", {}, "found the keys of vehicle-2, expected those of the listener"),
        ("nobody", {}, "bus keys: no such file"),
        ("", {"tls_certificate": "x"}, "page.tls_keys: found with page.tls_certificate"),
    ],
)
def test_keys_that_do_not_serve_are_told_in_one_line(tmp_path: Path, member, settings, words):
    field = Field(tmp_path / "keys").make()
    folder = field.folder / (member or field.roster.members[0].name)
    with pytest.raises(ConfigError, match=words) as caught:
        guarded(PageSettings(tls_keys=str(folder), **settings))
    assert "\n" not in str(caught.value)
