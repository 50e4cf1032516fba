"""A daemon with the web page, a client and a headless Chromium, for what is measured of the page."""

from __future__ import annotations

import tempfile
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from daemon.client import Client
from daemon.demo.main_job import child, free_endpoints, wait_until_ready
from tests.support.browser import Browser
from tests.support.harness import free_ports

SIZE_PX = (1280, 800)


@dataclass(frozen=True)
class PageRig:
    """One daemon and the browser before its page.

    Attributes:
        client: of the daemon.
        browser: headless Chromium of `SIZE_PX`.
        url: of the page.
    """

    client: Client
    browser: Browser
    url: str

    def open_page(self) -> None:
        """Open the page and wait until it draws the robot."""
        self.browser.open(self.url)
        self.browser.wait(lambda: self.browser.js("globalThis.mmmd?.frames > 0 && !!mmmd.capable"), "the page", 60)


@contextmanager
def page_rig() -> Generator[PageRig]:
    """A simulated robot that is not armed yet."""
    with tempfile.TemporaryDirectory() as name:
        folder, ends, (port,) = Path(name), free_endpoints(), free_ports(1)
        at = ["--cmd", ends.cmd, "--ctl", ends.ctl, "--pub", ends.pub]
        log = folder / "daemon.log"
        with child(["run", "--view", "--http", f"127.0.0.1:{port}", *at], log) as daemon, Client(ends) as client:
            wait_until_ready(client, daemon, log)
            with Browser(*SIZE_PX) as browser:
                yield PageRig(client, browser, f"http://127.0.0.1:{port}/")
