# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The web server: HTTP and WebSocket on one port. The only file that knows which library does it."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import ssl
from collections import Counter
from collections.abc import Awaitable, Callable
from math import inf
from typing import Any

import orjson
from aiohttp import WSCloseCode, WSMsgType, web

from walk_vr_bridge.client import Client
from walk_vr_bridge.content import Content, as_answered
from walk_vr_bridge.errors import PortError
from walk_vr_bridge.files import Missing
from walk_vr_bridge.letting_in import Reply, log_in, objection, pair
from walk_vr_bridge.limits import MAX_CLIENTS, MAX_CLIENTS_PER_ADDRESS, MAX_MESSAGE, SILENCE_S, Bucket
from walk_vr_bridge.model.scene import PROTOCOL
from walk_vr_bridge.operations import parse
from walk_vr_bridge.security.origin import HEADERS
from walk_vr_bridge.site import COOKIE, Door, Site, identity, silent_logger

_log = logging.getLogger(__name__)
_HEARTBEAT_S = 10.0
_AUTH_S = 5.0
_API_BYTES = 4096
_SECRETS_PER_S = 2.0
"""Tokens and codes that may be tried a second, by all clients together."""

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class WebServer:
    """Serves one site through one door, until it is stopped."""

    def __init__(self, site: Site, door: Door) -> None:
        self._site = site
        self._door = door
        self._connections: Counter[str] = Counter()
        self._tries = Bucket(_SECRETS_PER_S)
        self._sockets: set[web.WebSocketResponse] = set()
        app = web.Application(middlewares=[self._guard], client_max_size=_API_BYTES)
        app.router.add_get("/api/session", self._session)
        app.router.add_post("/api/pair", self._pair)
        app.router.add_post("/api/login", self._login)
        app.router.add_post("/api/logout", self._logout)
        app.router.add_get("/ws", self._socket)
        app.router.add_get("/{path:.*}", self._file)
        self._runner = web.AppRunner(
            app, access_log=None, logger=silent_logger(), handle_signals=False, shutdown_timeout=1.0,
            max_line_size=4096, max_field_size=4096, keepalive_timeout=30.0,
        )  # fmt: skip

    async def start(self, host: str, port: int) -> int:
        """Listens; returns the port.

        Raises:
            PortError: The port cannot be listened on.
        """
        await self._runner.setup()
        context = None
        if self._door.tls is not None:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.minimum_version = ssl.TLSVersion.TLSv1_2
            context.load_cert_chain(self._door.tls.certificate, self._door.tls.key)
        try:
            tcp = web.TCPSite(self._runner, host, port, ssl_context=context, backlog=256)
            await tcp.start()
        except OSError as error:
            await self._runner.cleanup()
            raise PortError(host, port, error.strerror or str(error)) from error
        return int(self._runner.addresses[0][1])

    async def stop(self) -> None:
        """Closes all connections and the port."""
        closing = [ws.close(code=WSCloseCode.GOING_AWAY, message=b"the bridge ends") for ws in list(self._sockets)]
        if closing:
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(asyncio.gather(*closing, return_exceptions=True), 1.0)
        await self._runner.cleanup()

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        try:
            response = self._refuse(request) or await handler(request)
        except web.HTTPException as error:
            response = _error(error.status, error.reason)
        except (ConnectionError, asyncio.CancelledError):
            raise
        except Exception as error:  # a bug must not show a client more than that there is one
            _log.error("a request failed: %s: %s", type(error).__name__, error)
            response = _error(500, "the bridge could not answer; its log says why")
        if not response.prepared:
            response.headers.update(HEADERS)
        return response

    def _refuse(self, request: web.Request) -> web.Response | None:
        headers = request.headers
        site = headers.get("Sec-Fetch-Site", "")
        found = objection(self._door, headers.getall("Host", []), headers.getall("Origin", []), site, request.path)
        return None if found is None else _json(found.body, found.status)

    def _role(self, request: web.Request) -> str:
        scheme, _, bearer = request.headers.get("Authorization", "").partition(" ")
        token = bearer if scheme.lower() == "bearer" else request.query.get("token", "")
        return self._door.role(token=token, cookie=request.cookies.get(COOKIE, ""))

    async def _file(self, request: web.Request) -> web.StreamResponse:
        if request.path == "/" and request.headers.get("Upgrade", "").lower() == "websocket":
            return await self._socket(request)
        found = self._site.files.get(request.path, request.query.get("revision"))
        if found is not None:
            if not self._role(request):
                return _error(401, "not let in yet: pair first, or give the token")
            return _file(request, found)
        page = self._site.page.get(request.match_info["path"])
        return _file(request, page) if page is not None else _error(404, "there is no such file")

    async def _session(self, request: web.Request) -> web.Response:
        return _json(
            {
                "protocol": PROTOCOL,
                "role": self._role(request) or None,
                "lan": self._door.lan,
                "namespace": self._site.hub.allowed.namespace,
                "building": self._site.files.told()["building"] if self._role(request) else "",
            }
        )

    async def _pair(self, request: web.Request) -> web.Response:
        return self._let_in(pair(self._door, await self._body(request)))

    async def _login(self, request: web.Request) -> web.Response:
        return self._let_in(log_in(self._door, await self._body(request)))

    async def _logout(self, request: web.Request) -> web.Response:
        self._door.access.close_session(request.cookies.get(COOKIE, ""))
        response = web.Response(status=204)
        response.del_cookie(COOKIE, path="/", secure=True, httponly=True, samesite="Strict")
        return response

    def _let_in(self, reply: Reply) -> web.Response:
        response = _json(reply.body, reply.status)
        if reply.let_in:
            value = self._door.access.open_session(reply.let_in)
            response.set_cookie(COOKIE, value, path="/", secure=True, httponly=True, samesite="Strict")
        return response

    async def _body(self, request: web.Request) -> dict[str, Any]:
        if not self._tries.take(1, asyncio.get_running_loop().time()):
            raise web.HTTPTooManyRequests(reason="too many tries; wait some seconds")
        try:
            body = orjson.loads(await request.read())
        except ValueError:
            body = None
        if not isinstance(body, dict):
            raise web.HTTPBadRequest(reason="the body is no JSON object")
        return body

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        address = request.remote or ""
        # On loopback all clients have one address.
        crowded = self._door.lan and self._connections[address] >= MAX_CLIENTS_PER_ADDRESS
        if crowded or len(self._sockets) >= MAX_CLIENTS:
            return _error(503, "too many clients")
        ws = web.WebSocketResponse(heartbeat=_HEARTBEAT_S, max_msg_size=MAX_MESSAGE, compress=False, timeout=2.0)
        if not ws.can_prepare(request).ok:
            return _error(400, "this address speaks WebSocket")
        ws.headers.update(HEADERS)
        self._sockets.add(ws)
        self._connections[address] += 1
        try:
            await ws.prepare(request)
            role = self._role(request) or await self._auth(ws)
            if role:
                await self._serve(request, ws, Client(identity(request.query.get("client")), role))
        except (ConnectionError, asyncio.IncompleteReadError):
            pass
        finally:
            self._sockets.discard(ws)
            self._connections[address] -= 1
        return ws

    async def _auth(self, ws: web.WebSocketResponse) -> str:
        """Returns the role that a client's first message gives it; closes the connection where it gives none."""
        role = ""
        with contextlib.suppress(Exception):  # whatever it is, it is no token
            first = await ws.receive(_AUTH_S)
            if first.type in (WSMsgType.TEXT, WSMsgType.BINARY) and len(first.data) <= _API_BYTES:
                said = parse(first.data)
                token = said.get("token") or said.get("mac")
                if said.get("op") == "auth" and self._tries.take(1, asyncio.get_running_loop().time()):
                    role = self._door.role(token=str(token)[:200])
        if not role:
            await ws.close(code=WSCloseCode.POLICY_VIOLATION, message=b"not let in: no token, or a wrong one")
        return role

    async def _serve(self, request: web.Request, ws: web.WebSocketResponse, client: Client) -> None:
        self._site.hub.clients.add(client)
        sender = asyncio.create_task(self._send(ws, client))
        watch = asyncio.create_task(self._watch(request, client))
        try:
            await self._receive(ws, client)
        finally:
            sender.cancel()
            watch.cancel()
            client.close()
            self._site.hub.clients.discard(client)
            if not self._site.hub.of(client.identity):
                self._site.operations.desk.forget(client)
            with contextlib.suppress(asyncio.CancelledError, ConnectionError):
                await sender

    async def _receive(self, ws: web.WebSocketResponse, client: Client) -> None:
        loop = asyncio.get_running_loop()
        async for message in ws:
            if message.type not in (WSMsgType.TEXT, WSMsgType.BINARY):
                continue
            now_s = loop.time()
            if client.intake.admits(len(message.data), now_s):
                self._site.operations.receive(client, message.data)
                # Whoever has much to say does not keep the others waiting.
                await asyncio.sleep(0)
            else:
                if client.intake.may_tell(now_s):
                    client.status("warning", "too many messages: some are dropped; at most 240 a second")
                # Not read meanwhile: the sender's own buffers fill up.
                await asyncio.sleep(0.01)
            if client.too_many_errors or client.intake.too_long(now_s):
                reason = "too many errors" if client.too_many_errors else "too fast for too long"
                await ws.close(code=WSCloseCode.POLICY_VIOLATION, message=reason.encode())
                return

    async def _send(self, ws: web.WebSocketResponse, client: Client) -> None:
        loop = asyncio.get_running_loop()
        try:
            while True:
                frame = await client.outbox.get()
                kind = WSMsgType.TEXT if frame.text else WSMsgType.BINARY
                client.sending_since_s = loop.time()
                await ws.send_frame(frame.data, kind)
                client.sending_since_s = inf
        except (ConnectionError, RuntimeError):
            return  # it has gone; the receiving side notices

    async def _watch(self, request: web.Request, client: Client) -> None:
        """Cuts a client off that takes nothing any more, without a farewell, which would wait just as long."""
        loop = asyncio.get_running_loop()
        while request.transport is not None:
            if loop.time() - client.sending_since_s > SILENCE_S:
                request.transport.abort()
                return
            await asyncio.sleep(SILENCE_S / 10)


def _json(values: dict[str, Any], status: int = 200) -> web.Response:
    headers = {"Cache-Control": "no-store"}
    return web.Response(body=orjson.dumps(values), status=status, content_type="application/json", headers=headers)


def _error(status: int, reason: str) -> web.Response:
    return _json({"error": reason}, status)


def _file(request: web.Request, found: Content | Missing) -> web.Response:
    if isinstance(found, Missing):
        response = _error(found.status, found.reason)
        if found.status == 503:
            response.headers["Retry-After"] = "1"
        return response
    asked = request.headers
    status, body, headers = as_answered(found, asked.get("If-None-Match", ""), asked.get("Accept-Encoding", ""))
    return web.Response(body=body, status=status, headers=headers)
