"""Who may look at the page and who may command, asked with a client of aiohttp that sends what it likes."""

from __future__ import annotations

import asyncio
import json

import aiohttp
import pytest

from gcs.page.hub import BROWSERS_MOST, NOT_ALLOWED
from gcs.page.server import MESSAGE_MAX
from onboard.wire.bus.messages import CommandKind
from tests.support.page_stage import TOKEN, stage
from tests.support.real_time import until

pytestmark = pytest.mark.real
ABORT = json.dumps({"do": "abort"})


async def said(socket: aiohttp.ClientWebSocketResponse, what: str = "said") -> str:
    """The next answer of a kind."""
    async for message in socket:
        if message.type is aiohttp.WSMsgType.TEXT:
            found = json.loads(message.data)
            if found["what"] == what:
                return found["text"]
    raise AssertionError("the page closed")


def orders(made) -> list[CommandKind]:
    return [command.kind for command in made.station.picture().commands]


@pytest.mark.parametrize(
    ("headers", "token", "status"),
    [
        ({}, "", 200),
        ({}, TOKEN, 303),
        ({}, "guessed", 403),
        ({"Host": "evil.example:80"}, "", 403),  # a stranger's name that leads to this machine
        ({"Host": "evil.example"}, TOKEN, 403),
        ({"Origin": "http://evil.example"}, "", 403),
        ({"Host": ""}, "", 403),
    ],
)
async def test_the_page_opens_for_whom_it_should(headers, token, status):
    async with stage(1) as made, aiohttp.ClientSession() as client:
        query = {"token": token} if token else {}
        async with client.get(made.url, headers=headers, params=query, allow_redirects=False) as answer:
            assert answer.status == status
            if status == 303:
                cookie = answer.headers["Set-Cookie"]
                assert "HttpOnly" in cookie
                assert "SameSite=Strict" in cookie
                assert answer.headers["Location"] == "/"
            if status == 200:
                assert "script-src 'self'" in answer.headers["Content-Security-Policy"]
                assert TOKEN not in await answer.text()


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://localhost:1"])
async def test_a_page_from_elsewhere_in_the_same_browser_opens_no_socket(origin):
    async with stage(1) as made, aiohttp.ClientSession(cookies={"apollonius": TOKEN}) as client:
        with pytest.raises(aiohttp.WSServerHandshakeError):
            await client.ws_connect(made.url + "live", headers={"Origin": origin})


@pytest.mark.parametrize(
    ("control", "cookie"),
    [(True, ""), (False, TOKEN), (False, "")],
    ids=["no token", "no control", "neither"],
)
async def test_who_may_not_command_commands_nothing_whatever_is_sent(control, cookie):
    async with stage(2, control=control) as made:
        cookies = {"apollonius": cookie} if cookie else {}
        async with aiohttp.ClientSession(cookies=cookies) as client:
            socket = await client.ws_connect(made.url + "live")
            for order in (
                {"do": "abort"}, {"do": "give", "kind": "land", "ids": [1], "named": True}, {"do": "yes"},
                {"do": "line", "text": "hold all"}, {"do": "acknowledge", "name": ""},
            ):  # fmt: skip
                await socket.send_str(json.dumps(order))
                assert await said(socket) == NOT_ALLOWED
            await socket.close()
        assert orders(made) == []
        assert made.agents[0].obeyed == []


async def test_with_the_token_the_same_message_commands():
    async with stage(2) as made, aiohttp.ClientSession(cookies={"apollonius": TOKEN}) as client:
        socket = await client.ws_connect(made.url + "live")
        await socket.send_str(ABORT)
        await until(lambda: all(agent.obeyed for agent in made.agents))
        await socket.close()


@pytest.mark.parametrize(
    "bad",
    [
        "", "[]", "{", '{"do": "launch"}', '{"do": "give", "kind": "arm", "ids": [1]}', "null",
        '{"do": "give", "kind": "land", "ids": []}', '{"do": "select", "id": "1"}', "[" * 3000,
        '{"do": "give", "kind": "land", "ids": [1], "more": 1}', '{"do": "seek", "at_ms": 1e400}',
    ],
)  # fmt: skip
async def test_what_is_not_understood_is_told_and_does_nothing(bad):
    async with stage(1) as made, aiohttp.ClientSession(cookies={"apollonius": TOKEN}) as client:
        socket = await client.ws_connect(made.url + "live")
        await socket.send_str(bad)
        assert await said(socket)
        await socket.send_str(ABORT)  # and the page goes on
        await until(lambda: orders(made) == [CommandKind.ABORT])
        await socket.close()


async def test_a_browser_that_says_too_much_or_reads_nothing_costs_the_others_nothing():
    async with stage(1) as made, aiohttp.ClientSession(cookies={"apollonius": TOKEN}) as client:
        deaf = await client.ws_connect(made.url + "live")  # never read from
        loud = await client.ws_connect(made.url + "live")
        for _ in range(300):
            await loud.send_str('{"do": "select", "id": 1}')
        assert "too many" in await said(loud)
        huge = await client.ws_connect(made.url + "live")
        await huge.send_str("x" * (MESSAGE_MAX + 1))
        await until(lambda: len(made.hub.browsers) == 2)
        good = await client.ws_connect(made.url + "live")
        await good.send_str(ABORT)
        await until(lambda: orders(made) == [CommandKind.ABORT])
        await asyncio.sleep(1.0)
        for browser in made.hub.browsers:
            assert len(browser._latest) <= 6
        for socket in (deaf, loud, huge, good):
            await socket.close()


async def test_there_are_never_too_many_browsers():
    async with stage(1) as made, aiohttp.ClientSession() as client:
        sockets = [await client.ws_connect(made.url + "live") for _ in range(BROWSERS_MOST)]
        one_more = await client.ws_connect(made.url + "live")
        assert (await one_more.receive()).type is aiohttp.WSMsgType.CLOSE
        for socket in sockets:
            await socket.close()
        await until(lambda: not made.hub.browsers)


async def test_files_are_the_pages_own_alone():
    async with stage(1) as made, aiohttp.ClientSession() as client:
        for name, status in (
            ("app.js", 200),
            ("index.html", 404),
            ("three.LICENSE", 404),
            ("..%2fserver.py", 404),
        ):
            async with client.get(made.url + name) as answer:
                assert answer.status == status, name
