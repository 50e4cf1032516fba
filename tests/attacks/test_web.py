"""HTTP and WebSocket beside ZeroMQ: one `curl` for a text and for a stop, and what strangers, other sites and floods get."""

from __future__ import annotations

import asyncio
import json
import re
import socket
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator

import pytest
from tornado.httpclient import HTTPRequest
from tornado.websocket import WebSocketClientConnection, websocket_connect

from daemon.errors import ConfigError
from daemon.network.web_access import Access
from daemon.scheduling.command_queue import SHADOW_S
from daemon.view.relay import MOST_KEPT, Reader
from daemon.view.server import MOST_BYTES
from daemon.view.web_state import BURST, MOST_SOCKETS
from tests.support.harness import RunningDaemon, running_daemon

pytestmark = pytest.mark.realtime


class Web:
    """The web server of a running daemon."""

    def __init__(self, daemon: RunningDaemon) -> None:
        self.daemon = daemon
        end_s = time.monotonic() + 30
        while not (found := re.search(r"at http://127\.0\.0\.1:(\d+)/", daemon.said)):
            assert time.monotonic() < end_s, daemon.said
            time.sleep(0.05)
        self.port = int(found[1])

    def ask(self, path: str, body: bytes | None = None, **headers: str) -> tuple[int, bytes]:
        """Status and body of a GET, or of a POST where there is a body."""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", body, headers)
        try:
            with urllib.request.urlopen(request, timeout=30) as reply:
                return reply.status, reply.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read()

    def event(self, kind: str, request: object) -> dict[str, object]:
        body = request.encode() if isinstance(request, str) else json.dumps(request).encode()
        return json.loads(self.ask(f"/v1/{kind}", body)[1])


@pytest.fixture(scope="module")
def web() -> Iterator[Web]:
    with running_daemon("--http", "127.0.0.1:0") as daemon:
        yield Web(daemon)


def test_a_text_and_a_stop_by_one_post_each(web: Web) -> None:
    accepted = web.event("cmd", "wave with your right hand")
    assert accepted["type"] == "accepted" and accepted["text"] == "wave with your right hand"
    with web.daemon.client() as client:
        client.wait_for("moving", timeout_s=20)
        stopped = web.event("ctl", "stop")
        assert stopped["type"] == "ack" and stopped["verb"] == "stop"
        client.wait_for("holding", timeout_s=10)
    time.sleep(
        2 * SHADOW_S
    )  # a message without a time of sending that comes at once counts as one from before the stop


def test_a_request_nested_too_deeply_is_one_error(web: Web) -> None:
    """The server itself decodes a request, to see whether it is a stop."""
    for kind in ("cmd", "ctl"):
        found, event = web.ask(f"/v1/{kind}", b'{"x": ' + b"[" * 5000 + b"]" * 5000 + b"}")
        assert found == 400 and json.loads(event)["type"] == "error"


def test_all_events_of_a_command_one_a_line(web: Web) -> None:
    status, lines = web.ask(
        "/v1/cmd?until=end", json.dumps({"type": "gesture", "name": "nod", "tempo": 2, "id": "n"}).encode()
    )
    events = [json.loads(line) for line in lines.splitlines()]
    assert status == 200 and [events[0]["type"], events[-1]["type"]] == ["accepted", "done"]
    assert {e["id"] for e in events} == {"n"}


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({"type": "gesture", "name": "no_such_gesture"}, 409, "unknown_gesture"),
        ({"type": "fly"}, 400, None),
        ({"type": "say", "text": ""}, 400, None),
        ({"type": "stop"}, 400, None),
    ],
)
def test_what_is_refused_says_so_by_its_status(web: Web, body: dict[str, str], status: int, code: str | None) -> None:
    found, event = web.ask("/v1/cmd", json.dumps(body).encode())
    assert found == status and json.loads(event)["found"]
    assert code in (None, json.loads(event)["code"])


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("/v1/cmd", "curl -d bow http://127.0.0.1"),
        ("/v1/ctl", "curl -d stop http://127.0.0.1"),
        ("/v1/pub", "connect to ws://127.0.0.1"),
        ("/v1/stream", "connect to ws://127.0.0.1"),
    ],
)
def test_a_get_where_a_websocket_is_says_how_to_connect(web: Web, path: str, says: str) -> None:
    """A browser or `curl` without a body got 400 and `Can "Upgrade" only to "WebSocket".`, which told nobody what to send."""
    status, body = web.ask(path)
    assert status == 426 and json.loads(body)["code"] == "upgrade_required"
    assert says in json.loads(body)["found"]


def test_the_description_names_every_request(web: Web) -> None:
    document = json.loads(web.ask("/v1/openapi.json")[1])
    assert {"Say", "Story", "Gesture", "Stop", "Estop", "Done", "StateEvent"} <= document["components"][
        "schemas"
    ].keys()
    assert set(document["paths"]) == {"/v1/cmd", "/v1/ctl", "/v1/pub", "/v1/stream"}


@pytest.mark.parametrize(
    "headers",
    [{"Origin": "http://evil.example"}, {"Host": "evil.example"}, {"Origin": "null"}, {"Origin": "http://127.0.0.1:1"}],
)
@pytest.mark.parametrize("path", ["/v1/cmd", "/v1/ctl"])
def test_pages_of_other_sites_are_refused(web: Web, path: str, headers: dict[str, str]) -> None:
    assert web.ask(path, b"status", **headers)[0] == 403


def test_a_page_of_another_site_gets_no_websocket(web: Web) -> None:
    async def connect() -> None:
        await websocket_connect(
            HTTPRequest(f"ws://127.0.0.1:{web.port}/v1/ctl", headers={"Origin": "http://evil.example"})
        )

    with pytest.raises(Exception, match="403"):
        asyncio.run(connect())


def test_files_outside_the_page_are_not_served(web: Web) -> None:
    for path in ("/", "/page.js", "/../server.py", "/%2e%2e/server.py", "/v1/robot/../../../etc/passwd"):
        assert web.ask(path)[0] in (400, 404), path


def test_a_body_that_is_too_long_is_not_read(web: Web) -> None:
    with pytest.raises(OSError), socket.create_connection(("127.0.0.1", web.port), 10) as s:
        s.sendall(b"POST /v1/cmd HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % (MOST_BYTES * 100))
        for _ in range(MOST_BYTES):
            s.sendall(b"x" * 1024)
    assert web.event("ctl", "status")["type"] == "state"


@pytest.mark.long
def test_a_stop_gets_through_a_flood(web: Web) -> None:
    """Requests beyond the limit are dropped before they reach the daemon; a stop among them is not."""
    ends, statuses = threading.Event(), []

    def flood() -> None:
        while not ends.is_set():
            statuses.append(web.ask("/v1/cmd", b'{"type": "capabilities"}')[0])

    with web.daemon.armed() as client:
        client.gesture("wave_right", wait=False, loop=True)
        client.wait_for("moving", timeout_s=20)
        threads = [threading.Thread(target=flood) for _ in range(8)]
        for thread in threads:
            thread.start()
        try:
            end_s = time.monotonic() + 20
            while 429 not in statuses and len(statuses) < 4 * BURST and time.monotonic() < end_s:
                time.sleep(0.01)
            assert web.event("ctl", "stop")["verb"] == "stop"
        finally:
            ends.set()
            for thread in threads:
                thread.join()
        client.wait_for("holding", timeout_s=10)
    assert set(statuses) <= {200, 429}


async def ended(connection: WebSocketClientConnection) -> None:
    """Close a WebSocket and wait until both sides have."""
    connection.close()
    while await connection.read_message() is not None:
        pass


@pytest.mark.long
def test_websockets_are_counted_and_given_back(web: Web) -> None:
    async def many() -> int:
        url, opened = f"ws://127.0.0.1:{web.port}/v1/pub", []
        try:
            while len(opened) <= MOST_SOCKETS:
                opened.append(await websocket_connect(url))
        except Exception as error:
            assert "503" in str(error)
        for connection in opened:
            await ended(connection)
        return len(opened)

    assert asyncio.run(many()) == MOST_SOCKETS

    async def one() -> str:
        async with asyncio.timeout(10):
            while True:
                try:
                    connection = await websocket_connect(f"ws://127.0.0.1:{web.port}/v1/pub")
                except Exception:
                    await asyncio.sleep(0.05)
                    continue
                message = await connection.read_message()
                await ended(connection)
                return str(message)

    assert json.loads(asyncio.run(one()))["type"] in ("state", "health")


def test_a_slow_reader_costs_bounded_memory() -> None:
    reader = Reader()
    for k in range(10 * MOST_KEPT):
        reader.give(b"v1/state", b"state %d" % k)
        reader.give(b"v1/event", b"event %d" % k)

    async def all_kept() -> list[bytes]:
        return [await reader.take() for _ in range(MOST_KEPT + 1)]

    kept = asyncio.run(all_kept())
    assert kept[0] == b"event %d" % (9 * MOST_KEPT) and kept[-1] == b"state %d" % (10 * MOST_KEPT - 1)
    assert reader.dropped == 9 * MOST_KEPT


TOKEN = "a-token-of-many-characters"


@pytest.mark.parametrize(
    ("access", "headers", "query", "status"),
    [
        (Access("127.0.0.1", 80), {"Host": "localhost:80"}, "", None),
        (Access("127.0.0.1", 80), {"Host": "[::1]:80"}, "", None),
        (Access("127.0.0.1", 80), {"Host": "127.0.0.1.evil.example"}, "", 403),
        (Access("127.0.0.1", 80), {}, "", 403),
        (Access("127.0.0.1", 80), {"Host": "localhost:80", "Origin": "http://localhost:80"}, "", None),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot"}, "", 401),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot", "Authorization": f"Bearer {TOKEN}"}, "", None),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot", "Authorization": f"Basic {TOKEN}"}, "", 401),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot"}, TOKEN, None),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot"}, TOKEN + "x", 401),
        (Access("0.0.0.0", 80, TOKEN), {"Host": "robot", "Origin": "http://evil.example"}, TOKEN, 403),
    ],
)
def test_who_is_served(access: Access, headers: dict[str, str], query: str, status: int | None) -> None:
    refused = access.refusal(headers, query)
    assert (refused and refused[0]) == status


@pytest.mark.parametrize("token", ["", "short"])
def test_beyond_this_machine_a_token_is_needed(token: str) -> None:
    with pytest.raises(ConfigError):
        Access("0.0.0.0", 5880, token)
