# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Tokens, codes and cookies: every way in that is not the right one, tried, leads nowhere."""

import asyncio

import aiohttp
from bridge_server import receive, serving, status

from walk_vr_bridge.security.access import Access
from walk_vr_bridge.security.pairing import RENEW_S, TRIES, VALID_S, Pairing

PROTECTED = ["/building.json", "/building.glb", "/miniature.glb", "/importance.json", "/importance.bin"]


def test_without_a_token_only_the_page_is_served(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            for path in PROTECTED:
                assert await status(served.get(path)) == 401
            assert await status(served.get("/")) == 200
            async with served.get("/api/session") as response:
                assert (await response.json())["role"] is None
            for token in ("", "x" * 32, served.door.access.tokens["editor"][:-1]):
                assert await status(served.get("/building.json?token=" + token)) == 401
                assert await status(served.post("/api/login", {"token": token})) == 403

    run(scene())


def test_a_socket_without_a_token_is_closed_and_hears_nothing(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            for first in ({"op": "subscribe", "topic": "/walk/path"}, {"op": "auth", "token": "wrong"}, {"op": "auth"}):
                async with served.ws() as ws:
                    await ws.send_json(first)
                    assert await receive(ws) == aiohttp.WSCloseCode.POLICY_VIOLATION
            assert not served.site.hub.clients
            assert not served.graph.published

    run(scene())


def test_the_token_opens_as_query_header_and_first_message(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            token = served.door.access.tokens["editor"]
            for path, headers, first in (
                (f"/ws?token={token}", {}, None),
                ("/ws", {"Authorization": f"Bearer {token}"}, None),
                ("/ws", {}, {"op": "auth", "token": token}),
                ("/ws", {}, {"op": "auth", "mac": token}),
            ):
                async with served.ws(path, headers=headers) as ws:
                    if first:
                        await ws.send_json(first)
                    await ws.send_json({"op": "subscribe", "topic": "/walk/bridge/session"})
                    assert '"role":"editor"' in (await receive(ws))["msg"]["data"]

    run(scene())


def test_a_code_is_good_once_and_gives_a_cookie_that_scripts_cannot_read(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            async with served.post("/api/pair", {"code": served.code()}) as response:
                assert response.status == 200
                cookie = response.headers["Set-Cookie"]
            for word in ("HttpOnly", "Secure", "SameSite=Strict", "Path=/"):
                assert word in cookie
            value = cookie.split(";")[0]
            # 503: let in, but nothing is loaded yet.
            assert await status(served.get("/building.json", headers={"Cookie": value})) == 503
            assert await status(served.post("/api/pair", {"code": served.code()})) == 410
            assert await status(served.get("/building.json", headers={"Cookie": value[:-2] + "AA"})) == 401
            assert await status(served.post("/api/logout", {}, headers={"Cookie": value})) == 204
            assert await status(served.get("/building.json", headers={"Cookie": value})) == 401

    run(scene())


def test_guessing_ends_after_five_tries(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            right = served.code()
            wrong = f"{(int(right) + 1) % 10**8:08d}"
            seen = []
            for _ in range(TRIES + 1):
                seen.append(await status(served.post("/api/pair", {"code": wrong})))
                await asyncio.sleep(0.55)  # as fast as the bridge lets anybody try
            assert seen == [403] * TRIES + [410]
            assert await status(served.post("/api/pair", {"code": right})) == 410
            await asyncio.sleep(0.55)
            assert await status(served.post("/api/pair", {"renew": True})) == 429

    run(scene())


def test_secrets_cannot_be_tried_in_bulk(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            tries = [status(served.post("/api/login", {"token": str(n)})) for n in range(40)]
            seen = await asyncio.gather(*tries)
            assert seen.count(429) >= 30

    run(scene())


def test_a_code_dies_with_time():
    clock, shown = [0.0], []
    pairing = Pairing(lambda: clock[0], shown.append)
    clock[0] = VALID_S + 1
    assert not pairing.use(shown[0])
    assert pairing.renew()
    assert pairing.use(shown[1])
    clock[0] += RENEW_S - 1
    assert not pairing.renew()


def test_every_start_has_its_own_tokens():
    one, other = Access(lambda: 0.0), Access(lambda: 0.0)
    assert len({*one.tokens.values(), *other.tokens.values()}) == 4
    assert min(map(len, one.tokens.values())) >= 32
    assert other.role_of_token(one.tokens["editor"]) == ""


def test_cookies_end_with_the_day():
    clock = [0.0]
    access = Access(lambda: clock[0])
    value = access.open_session("viewer")
    assert access.role_of_session(value) == "viewer"
    clock[0] = 13 * 3600.0
    assert access.role_of_session(value) == ""
