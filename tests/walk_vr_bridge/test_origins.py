# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Other names, other origins, other addresses: who asks from elsewhere is refused."""

import socket

import aiohttp
import pytest
from bridge_server import receive, serving, status

from walk_vr_bridge.security.addresses import lan_addresses
from walk_vr_bridge.security.origin import Hosts, same_origin


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8765", "localhost.evil.example", "127.0.0.1@evil", "", "a b"]
)
@pytest.mark.parametrize("lan", [False, True])
def test_another_host_name_is_a_rebound_one(run, tmp_path, host, lan):
    async def scene():
        async with serving(tmp_path, lan=lan) as served:
            assert await status(served.get("/", headers={"Host": host})) in (400, 421)
            assert await status(served.get("/api/session", headers={"Host": host})) in (400, 421)

    run(scene())


def test_a_page_from_elsewhere_can_do_nothing(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            origins = [
                "https://evil.example",
                "null",
                f"http://localhost:{served.port + 1}",
                f"http://127.0.0.1:{served.port}",
            ]
            origins += [f"https://localhost:{served.port}", f"http://localhost:{served.port}.evil.example"]
            for origin in origins:
                headers = {"Origin": origin}
                assert await status(served.get("/building.json", headers=headers)) == 403
                assert await status(served.post("/api/login", {}, headers=headers)) == 403
                for path in ("/", "/ws"):
                    with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
                        await served.ws(path, headers=headers)
            assert await status(served.get("/building.json", headers={"Sec-Fetch-Site": "cross-site"})) == 403
            async with served.ws(headers={"Origin": served.url}) as ws:
                await ws.send_json({"op": "subscribe", "topic": "/walk/bridge/session"})
                assert (await receive(ws))["op"] == "publish"

    run(scene())


def test_loopback_is_not_heard_from_outside(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            for address in lan_addresses():
                with socket.socket() as probe:
                    probe.settimeout(1)
                    assert probe.connect_ex((address, served.port)) != 0

    run(scene())


def test_names_of_the_bridge():
    hosts = Hosts(["localhost", "127.0.0.1", "::1", "Study.local"])
    for good in ("localhost", "LOCALHOST:1", "127.0.0.1:8765", "[::1]:80", "study.local.:443"):
        assert hosts.knows(good)
    for bad in ("localhost:x", "localhost/", "::1", "127.0.0.1.evil", "localhost:123456", "x@localhost"):
        assert not hosts.knows(bad)
    assert same_origin(None, "localhost", tls=True)
    assert same_origin("HTTPS://Localhost:1", "localhost:1", tls=True)
    assert not same_origin("https://localhost:1", "localhost:2", tls=True)
    # Behind a proxy that has the certificate.
    assert same_origin("https://study.example.org", "study.example.org", tls=False)
    assert not same_origin("https://evil.example.org", "study.example.org", tls=False)
    assert not same_origin("ftp://study.example.org", "study.example.org", tls=False)
