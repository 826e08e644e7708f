# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What may not get out: files beside the page, secrets in logs, plain text; and the certificate against it."""

import asyncio
import datetime
import hashlib
import logging
import ssl

import aiohttp
import pytest
from bridge_server import receive, serving, status
from cryptography import x509

from walk_vr_bridge.security.certificate import certificate


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
                    assert response.headers["Cross-Origin-Embedder-Policy"] == "require-corp"
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
