"""The web page in a browser, for tests: a whole daemon with simulated servos, `mmmd view`, and what a person does on the page."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.browser import Browser
from tests.support.harness import MMMD, RunningDaemon, free_ports

OUT = Path("out/page")
"""Where pictures of the page are kept."""
SOON_S = 30.0


class Page:
    """A daemon, `mmmd view` for it, and the page in a browser."""

    def __init__(self, daemon: RunningDaemon, browser: Browser, url: str) -> None:
        self.daemon, self.browser, self.url = daemon, browser, url

    def load(self) -> None:
        """Open the page and wait until it shows the robot."""
        self.browser.open(self.url)
        self.browser.wait(lambda: self.browser.js("globalThis.mmmd?.frames > 0 && !!mmmd.capable"), "the page", SOON_S)

    def say(self, text: str) -> None:
        self.browser.js("document.querySelector('#text').focus()")
        self.browser.type(text)
        self.browser.key("Enter", "Enter", 13, "\r")

    def until(self, *states: str) -> None:
        """Wait until the page says that the robot is in one of these states."""
        try:
            self.browser.wait(lambda: self.browser.text("#state") in states, f"{states} on the page", SOON_S)
        except AssertionError as error:
            error.add_note(self.browser.js("document.body.innerText")[-2000:])  # the log comes last
            raise

    def until_passed(self, state: str, since: int) -> None:
        """Wait until the page has shown a state, among those after the first `since` of them."""
        self.browser.wait(
            lambda: state in self.browser.js(f"mmmd.passed.slice({since})"), f"{state} on the page", SOON_S
        )

    def rest(self) -> None:
        """Make the robot stand still under torque, from whatever state, and scroll to the top."""
        with self.daemon.armed():
            pass
        self.until("idle", "holding")
        self.browser.js("scrollTo(0, 0)")

    def moving(self) -> None:
        """Make the robot move for long, from whatever state."""
        self.rest()
        self.browser.js("mmmd.halt = null; document.querySelector('#halted').textContent = ''")
        self.browser.js(
            "document.querySelector('#hold').checked = false; document.querySelector('#loop').checked = true"
        )
        self.say("wave with your right hand")
        self.until("moving")


@contextmanager
def served_page(folder: Path) -> Iterator[Page]:
    """The page of a new daemon, which logs to a folder; at the end the page must have complained of nothing."""
    (port,) = free_ports(1)
    daemon = RunningDaemon("--log", str(folder / "run.mcap"))
    log = (daemon.folder / "view").open("wb")
    served = subprocess.Popen(
        [*MMMD, "view", "--http", f"127.0.0.1:{port}", *daemon.at], stdout=log, stderr=log, start_new_session=True
    )
    try:
        with Browser() as browser:
            daemon.until_ready()
            page = Page(daemon, browser, f"http://127.0.0.1:{port}/")
            page.load()
            yield page
            assert browser.errors == []
        served.terminate()
        assert served.wait(10) == 0
    finally:
        served.kill()
        served.wait()
        log.close()
        daemon.close()
