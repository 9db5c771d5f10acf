"""`gcs page` and `gcs --page` as programs: their address opens, wrong settings are told in one line."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import aiohttp
import pytest

from gcs.page.program import guarded
from gcs.settings import PageSettings
from onboard.config.strict import ConfigError
from tests.support.bus_stages import free_port

pytestmark = pytest.mark.real


def started(*options: str) -> subprocess.Popen[str]:
    command = [
        sys.executable,
        "-m",
        "gcs.cli",
        *options,
        "--no-record",
        "--bus",
        f"tcp/127.0.0.1:{free_port()}",
    ]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def line_with(process: subprocess.Popen[str], word: str) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        if word in line:
            return line
    raise AssertionError(f"ended without {word!r}")


async def test_the_address_it_prints_opens_and_it_ends_when_told():
    process = started("page", "--port", "0", "--control")
    try:
        url = re.search(r"http://\S+", line_with(process, "page: ")).group()
        async with aiohttp.ClientSession() as client, client.get(url) as answer:
            assert answer.status == 200
            assert "<title>Apollonius</title>" in await answer.text()
    finally:
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")


async def test_beside_the_console_the_page_shows_and_its_address_stands_in_the_log(tmp_path: Path):
    port = free_port()
    settings = tmp_path / "gcs.toml"
    settings.write_text(f"[page]\nport = {port}\n", encoding="utf-8")
    process = started("--plain", "--page", "--config", str(settings))
    try:
        line = line_with(process, "page: ")
        assert f"http://localhost:{port}/ (shows only" in line
        async with aiohttp.ClientSession() as client, client.get(f"http://localhost:{port}/") as answer:
            assert answer.status == 200
    finally:
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
    assert process.returncode == 0


def test_a_port_that_is_taken_is_told():
    port = free_port()
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", port))
        taken.listen()
        process = started("page", "--port", str(port))
        _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert err.startswith(f"gcs: page.port: found 127.0.0.1:{port}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"tls_key": "x"}, "page.tls_key: found without page.tls_certificate"),
        ({"tls_clients": "x"}, "page.tls_clients: found without page.tls_certificate"),
        ({"host": "0.0.0.0", "control": True}, "expected one: without TLS the token can be read"),
        ({"tls_certificate": "/nowhere.pem"}, "/nowhere.pem: not a certificate and key in PEM"),
        ({"token_file": "/nowhere"}, "/nowhere: token of the page"),
    ],
)
def test_wrong_settings_are_told_in_one_line(settings, words):
    with pytest.raises(ConfigError, match=re.escape(words)) as caught:
        guarded(PageSettings(**settings))
    assert "\n" not in str(caught.value)


def test_a_token_of_ones_own_is_long_and_nobody_elses(tmp_path: Path):
    file = tmp_path / "token"
    file.write_text("short\n")
    file.chmod(0o600)
    with pytest.raises(ConfigError, match="found a token of 5 characters, expected 16"):
        guarded(PageSettings(token_file=str(file)))
    file.write_text("long enough, surely\n")
    assert guarded(PageSettings(token_file=str(file)))[0].token == "long enough, surely"
    file.chmod(0o644)
    with pytest.raises(ConfigError, match="others may read it"):
        guarded(PageSettings(token_file=str(file)))
