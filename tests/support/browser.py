"""A headless Chromium, led by the Chrome DevTools Protocol: a page as a person has it, with keys, pointer and pictures."""

from __future__ import annotations

import asyncio
import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tornado.websocket import WebSocketClientConnection, websocket_connect

FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--mute-audio",
    "--disable-extensions", "--in-process-gpu", "--no-zygote", "--disable-breakpad", "--remote-debugging-port=0",
    "--hide-scrollbars",
)  # fmt: skip
START_S, CALL_S = 30.0, 60.0
_LOOKS = 5
"""Looks, 0.05 s apart, at which a button has to be in the same place: what moves between press and release is not pressed."""
_PAGE_IS_GONE = "Inspected target navigated or closed"


def chromium() -> str:
    """Path of Chromium; the test is skipped where there is none."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        pytest.skip("no Chromium; on Debian `apt install chromium`")
    return found


class Browser:
    """One page in one browser, which ends with the block."""

    def __init__(self, width: int = 1280, height: int = 800) -> None:
        program = chromium()
        self._folder = tempfile.TemporaryDirectory(prefix="mmmd-chromium-", ignore_cleanup_errors=True)
        command = [
            program,
            *FLAGS,
            f"--user-data-dir={self._folder.name}",
            f"--window-size={width},{height}",
            "about:blank",
        ]
        self._process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
        )
        self._loop = asyncio.new_event_loop()
        self._calls = 0
        self.errors: list[str] = []
        port_file = Path(self._folder.name) / "DevToolsActivePort"
        self.wait(lambda: port_file.exists() and len(port_file.read_text().split()) > 1, "Chromium", START_S)
        port = port_file.read_text().split()[0]
        pages = self.wait(lambda: [p for p in self._pages(port) if p["type"] == "page"], "a page", START_S)
        self._socket = self._loop.run_until_complete(_connected(pages[0]["webSocketDebuggerUrl"]))
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")
        self.size(width, height)

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.run_until_complete(_closed(self._socket))
        self._loop.close()
        self._process.terminate()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait(5)
        self._folder.cleanup()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """One call of the protocol; what the page complains of meanwhile is kept in `errors`."""
        return self._loop.run_until_complete(asyncio.wait_for(self._call(method, parameters), CALL_S))

    def js(self, expression: str) -> Any:
        """The value of an expression in the page; promises are waited for."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def open(self, url: str) -> None:
        self.call("Page.navigate", url=url)

    def size(self, width: int, height: int, *, phone: bool = False) -> None:
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)

    def text(self, selector: str) -> str:
        return self.js(f"document.querySelector({selector!r})?.textContent ?? ''")

    def type(self, text: str) -> None:
        self.call("Input.insertText", text=text)

    def key(self, key: str, code: str, number: int, text: str = "") -> None:
        common: dict[str, Any] = {"key": key, "code": code, "windowsVirtualKeyCode": number}
        self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **common)
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def press(self, selector: str) -> None:
        """Press where a person sees the element, once it stands still; fails when it is covered or out of sight."""
        find = (
            f"(() => {{ const e = document.querySelector({selector!r}), r = e.getBoundingClientRect(), x = r.x + r.width / 2,"
            " y = r.y + r.height / 2, hit = document.elementFromPoint(x, y); return [x, y, e === hit || e.contains(hit)]; })()"
        )
        looks: list[list[Any]] = []

        def stands() -> bool:
            looks.append(self.js(find))
            return len(looks) >= _LOOKS and all(look == looks[-1] for look in looks[-_LOOKS:])

        self.wait(stands, f"{selector} stands still", CALL_S)
        x, y, hit = looks[-1]
        assert hit, f"{selector} at {x:.0f}, {y:.0f} is not in sight"
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def wait(self, condition: Callable[[], Any], what: str, timeout_s: float) -> Any:
        """The first true value of a condition."""
        end_s = time.monotonic() + timeout_s
        while not (value := condition()):
            assert time.monotonic() < end_s, f"{what}: not within {timeout_s:g} s"
            time.sleep(0.05)
        return value

    def picture(self, file: Path) -> bytes:
        """A PNG of what is seen, kept in a file."""
        png = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(png)
        return png

    def pixels(self, selector: str) -> str:
        """What a canvas shows, as a data URL."""
        return self.js(f"document.querySelector({selector!r}).toDataURL()")

    @staticmethod
    def _pages(port: str) -> list[dict[str, Any]]:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=5) as reply:
            return json.load(reply)

    async def _call(self, method: str, parameters: dict[str, Any]) -> dict[str, Any]:
        self._calls += 1
        await self._socket.write_message(json.dumps({"id": self._calls, "method": method, "params": parameters}))
        while True:
            message = await self._socket.read_message()
            assert message is not None, "Chromium has closed"
            answer: dict[str, Any] = json.loads(message)
            if answer.get("method") == "Runtime.exceptionThrown":
                self.errors.append(json.dumps(answer["params"]["exceptionDetails"])[:500])
            elif answer.get("method") == "Log.entryAdded" and answer["params"]["entry"]["level"] == "error":
                self.errors.append(
                    str(answer["params"]["entry"].get("text")) + str(answer["params"]["entry"].get("url"))
                )
            elif answer.get("id") == self._calls:
                if answer.get("error", {}).get("message") == _PAGE_IS_GONE:
                    return {"result": {}}  # the expression was of the page before
                assert "error" not in answer, answer["error"]
                return answer.get("result", {})


async def _connected(url: str) -> WebSocketClientConnection:
    return await websocket_connect(url, max_message_size=64 << 20)


async def _closed(socket: WebSocketClientConnection) -> None:
    """Close a connection within its own event loop: outside of one, Tornado looks for the thread's, which may be gone."""
    socket.close()
