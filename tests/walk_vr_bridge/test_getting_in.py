# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Every way in that is not the right one, tried: it leads nowhere."""

import asyncio
import datetime
import hashlib
import logging
import socket
import ssl

import aiohttp
import pytest
from bridge_server import receive, serving
from cryptography import x509

from walk_vr_bridge.security.access import Access
from walk_vr_bridge.security.addresses import lan_addresses
from walk_vr_bridge.security.certificate import certificate
from walk_vr_bridge.security.origin import Hosts, same_origin
from walk_vr_bridge.security.pairing import RENEW_S, TRIES, VALID_S, Pairing

PROTECTED = ["/building.json", "/building.glb", "/miniature.glb", "/importance.json", "/importance.bin"]


async def status(request):
    async with request as response:
        return response.status


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


def test_viewers_change_nothing(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            token = served.door.access.tokens["viewer"]
            async with served.ws(f"/ws?token={token}") as ws:
                await ws.send_json({"op": "subscribe", "topic": "/walk/edit_results"})
                edit = {"marker_name": "1", "event_type": 5, "header": {"stamp": {"sec": 7}}}
                await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
                answer = await receive(ws)
                assert answer["msg"]["message"].startswith("publish on /walk/keypoint_edits")
                assert {"key": "edit_stamp_ns", "value": "7000000000"} in answer["msg"]["values"]
                assert (await receive(ws))["op"] == "status"
                for topic in ("playback/seek", "playback/speed", "study_events"):
                    await ws.send_json({"op": "publish", "topic": "/walk/" + topic, "msg": {}})
                    assert (await receive(ws))["level"] == "error"
                for service in (
                    "undo",
                    "redo",
                    "replan",
                    "play",
                    "trajopt/set_parameters",
                    "trajopt/set_parameters_atomically",
                ):
                    await ws.send_json({"op": "call_service", "service": "/walk/" + service, "id": "1"})
                    assert (await receive(ws))["result"] is False
                await ws.send_json({"op": "call_service", "service": "/walk/trajopt/list_parameters", "id": "1"})
                assert (await receive(ws))["result"] is True
            assert not served.graph.published
            assert [name for name, _ in served.graph.called] == ["/walk/trajopt/list_parameters"]

    run(scene())


def test_editors_reach_only_what_is_on_the_list(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws() as ws:
            for topic in (
                "/walk/path",
                "/walk/keypoints",
                "/rosout",
                "/walk/../rosout",
                "/walk/viewpoint",
                "/parameter_events",
            ):
                await ws.send_json({"op": "publish", "topic": topic, "msg": {}})
                assert (await receive(ws))["op"] == "status"
            for topic in ("/rosout", "/walk/keypoint_edits", "/parameter_events"):
                await ws.send_json({"op": "subscribe", "topic": topic})
                assert (await receive(ws))["op"] == "status"
            for service in (
                "/walk/trajopt/get_parameter_types",
                "/other/undo",
                "/walk/sequencer/../trajopt/set_parameters",
            ):
                await ws.send_json({"op": "call_service", "service": service})
                assert (await receive(ws))["result"] is False
            for name in (
                "building",
                "load.doors",
                "cache_dir",
                "state_dir",
                "keypoints_file",
                "bridge.lan",
                "bridge.hosts",
                "use_sim_time",
            ):
                value = {"type": 4, "string_value": "/etc/passwd"}
                for service in ("set_parameters", "set_parameters_atomically"):
                    args = {"parameters": [{"name": name, "value": value}]}
                    await ws.send_json({"op": "call_service", "service": f"/walk/trajopt/{service}", "args": args})
                    answer = await receive(ws)
                    assert answer["result"] is False
                    assert name in answer["values"]
            assert not served.graph.published
            assert not served.graph.called

    run(scene())


def test_nobody_edits_in_another_name(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served, served.ws("/ws?client=0123456789abcdef") as ws:
            edit = {"marker_name": "1", "event_type": 4, "client_id": "somebody else"}
            await ws.send_json({"op": "publish", "topic": "/walk/keypoint_edits", "msg": edit})
            await ws.send_json({"op": "subscribe", "topic": "/walk/bridge/session"})
            answer = await receive(ws)
            (msg,) = served.graph.on("/walk/keypoint_edits")
            assert msg.client_id in answer["msg"]["data"]
            assert msg.client_id.startswith("web-")

    run(scene())


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/assets/../../secret.txt",
        "/assets/%2e%2e%2f%2e%2e%2fsecret.txt",
        "//secret.txt",
        "/..%5csecret.txt",
        "/.hidden",
        "/assets/app-1.js%00.html",
        "/certificate/key.pem",
        "/etc/passwd",
        "/%2fetc/passwd",
    ],
)
def test_no_file_beside_the_page_is_served(run, tmp_path, path):
    async def raw(port):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        answer = await reader.read()
        writer.close()
        return answer

    async def scene():
        async with serving(tmp_path) as served:
            (tmp_path / "page" / ".hidden").write_text("hidden")
            answer = await raw(served.port)
            assert b" 200 " not in answer.split(b"\r\n")[0]
            assert b"secret beside" not in answer
            assert b"root:" not in answer

    run(scene())


def test_every_answer_forbids_what_the_page_does_not_need(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            for path in ("/", "/assets/app-1.js", "/api/session", "/nothing", "/building.json"):
                async with served.get(path) as response:
                    policy = response.headers["Content-Security-Policy"]
                    assert "default-src 'none'" in policy
                    assert "unsafe" not in policy
                    assert "http" not in policy
                    assert response.headers["X-Content-Type-Options"] == "nosniff"
                    assert response.headers["Cross-Origin-Resource-Policy"] == "same-origin"
                    assert "Python" not in response.headers["Server"]

    run(scene())


def test_large_requests_are_refused(run, tmp_path):
    async def scene():
        async with serving(tmp_path) as served:
            async with served.ws() as ws:
                await ws.send_str('{"op": "publish", "topic": "' + "x" * 300_000 + '"}')
                assert await receive(ws) == aiohttp.WSCloseCode.MESSAGE_TOO_BIG
            assert await status(served.post("/api/login", {"token": "x" * 100_000})) == 413

    run(scene())


def test_lan_has_no_plain_port(run, tmp_path):
    async def scene():
        async with serving(tmp_path, lan=True) as served:
            reader, writer = await asyncio.open_connection("127.0.0.1", served.port)
            writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            answer = await reader.read()
            writer.close()
            assert b"the page" not in answer
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            context.maximum_version = ssl.TLSVersion.TLSv1_2
            _, secure = await asyncio.open_connection("127.0.0.1", served.port, ssl=context)
            assert secure.get_extra_info("cipher")[1] == "TLSv1.2"
            secure.close()

    run(scene())


def test_no_secret_is_logged(run, tmp_path, caplog, capsys):
    caplog.set_level(logging.DEBUG)

    async def scene():
        async with serving(tmp_path, lan=True) as served:
            token = served.door.access.tokens["editor"]
            code = served.code()
            await status(served.get(f"/building.json?token={token}"))
            await status(served.get(f"/x?token={token}", headers={"Host": "evil"}))
            await status(served.post("/api/login", {"token": token}))
            await status(served.post("/api/pair", {"code": code}))
            async with served.ws(f"/ws?token={token}") as ws:
                await ws.send_str("{" + token)
                await receive(ws)
            return token, code

    secrets = run(scene())
    heard = caplog.text + "".join(capsys.readouterr())
    assert not any(secret in heard for secret in secrets)


def test_the_certificate_names_the_machine_and_lasts_as_long_as_browsers_accept(tmp_path):
    names = ["192.0.2.7", "localhost", "::1", "study-room.local"]
    made = certificate(tmp_path, names)
    found = x509.load_pem_x509_certificate(made.certificate.read_bytes())
    own = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    assert {str(name.value) for name in own} == set(names)
    assert found.not_valid_after_utc - found.not_valid_before_utc <= datetime.timedelta(days=397)
    assert made.key.stat().st_mode & 0o777 == 0o600
    assert tmp_path.joinpath("key.pem").read_bytes().startswith(b"-----BEGIN PRIVATE KEY")
    digest = ssl.PEM_cert_to_DER_cert(made.certificate.read_text())
    assert made.fingerprint.replace(":", "") == hashlib.sha256(digest).hexdigest().upper()


def test_the_certificate_is_kept_until_the_machine_has_another_address(tmp_path):
    first = certificate(tmp_path, ["192.0.2.7", "localhost"])
    assert certificate(tmp_path, ["localhost"]).fingerprint == first.fingerprint
    moved = certificate(tmp_path, ["192.0.2.8", "localhost"])
    assert moved.fingerprint != first.fingerprint
    (tmp_path / "key.pem").write_text("damaged")
    assert certificate(tmp_path, ["192.0.2.8", "localhost"]).fingerprint != moved.fingerprint


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
