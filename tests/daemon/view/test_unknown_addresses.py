"""The web server's answers to unknown addresses (404), missing methods (405) and requests that are too large (413).

No daemon is needed.
"""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPResponse

from daemon.network.web_access import Access
from daemon.settings.config import Endpoints
from daemon.view.server import WebServer
from daemon.view.web_state import MOST_BYTES

TOKEN = "a-token-of-many-characters"


def answer(folder: Path, path: str, *, page: bool = False, token: str = "", body: bytes | None = None) -> HTTPResponse:
    """The response to a GET, or to a POST where there is a body."""

    async def ask() -> HTTPResponse:
        ends = Endpoints(*(f"ipc://{folder}/{name}" for name in ("cmd", "ctl", "pub")))
        server = WebServer(Access("127.0.0.1", 0, token), ends, {}, page=page)
        server.bind()
        serving = asyncio.create_task(server.serve())
        try:
            url = f"http://127.0.0.1:{server.access.port}{path}"
            method = "GET" if body is None else "POST"
            return await AsyncHTTPClient(force_instance=True).fetch(url, method=method, body=body, raise_error=False)
        finally:
            serving.cancel()
            await asyncio.gather(serving, return_exceptions=True)

    return asyncio.run(ask())


@pytest.mark.parametrize("path", ["/nothing", "/v1", "/v1/cmd/", "/v1/say", "/v2/cmd"])
@pytest.mark.parametrize("body", [None, b"bow"])
def test_an_unknown_address_lists_those_that_are_served(tmp_path: Path, path: str, body: bytes | None) -> None:
    """The answer said "Not Found" alone, which tells nobody that `/v1/say` is `POST /v1/cmd`."""
    found = answer(tmp_path, path, body=body)
    said = json.loads(found.body)
    assert found.code == 404 and said["code"] == "unknown_address" and said["asked"] == path
    for address in ("POST or WebSocket /v1/cmd", "/v1/ctl", "WebSocket /v1/pub", "GET /v1/openapi.json"):
        assert address in said["found"]


def test_without_the_page_its_address_says_who_serves_it(tmp_path: Path) -> None:
    assert "`mmmd run --view`" in json.loads(answer(tmp_path, "/").body)["found"]


def test_with_the_page_an_unknown_address_names_it(tmp_path: Path) -> None:
    found = answer(tmp_path, "/index.htm", page=True)
    assert found.code == 404 and "GET / (the page)" in json.loads(found.body)["found"]
    assert answer(tmp_path, "/", page=True).code == 200


def test_a_stranger_without_the_token_is_told_no_address(tmp_path: Path) -> None:
    found = answer(tmp_path, "/nothing", token=TOKEN)
    assert found.code == 401 and b"/v1/cmd" not in found.body


def test_a_method_that_is_not_served_is_told_which_are(tmp_path: Path) -> None:
    found = answer(tmp_path, "/v1/openapi.json", body=b"bow")
    assert found.code == 405 and found.headers["Allow"] == "GET"
    assert "allowed: GET" in json.loads(found.body)["found"]


@pytest.mark.parametrize("kind", ["cmd", "ctl"])
def test_a_request_that_is_too_large_is_told_how_large_it_may_be(tmp_path: Path, kind: str) -> None:
    """The answer was an empty 400."""
    found = answer(tmp_path, f"/v1/{kind}", body=b"w" * (MOST_BYTES + 1))
    said = json.loads(found.body)
    assert found.code == 413 and said["code"] == "too_large" and f"{MOST_BYTES:,}" in said["found"]
