"""Figures of the web page in a headless Chromium, as JSON, and the picture of it in the README.

First paint, frames a second while the robot moves, and milliseconds from a press of STOP to the reply that a bus cycle has
carried it out: `python -m docs.tools.page_figures docs/pictures/page.png`. It takes a machine that is otherwise idle.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from docs.tools.page_rig import PageRig, page_rig

STOPS = 20
PAINT_TIMEOUT_S = 20.0
"""Seconds for the first paint, which on a busy machine comes after the page's first messages."""
WATCHED_S = 5.0


def main(picture: Path | None) -> None:
    """Start a daemon with the page, measure, print, and keep a picture of the page in mid-motion."""
    with page_rig() as rig:
        sys.stdout.write(json.dumps(_measured(rig, picture), indent=1) + "\n")


def _measured(rig: PageRig, picture: Path | None) -> dict[str, Any]:
    browser, client = rig.browser, rig.client
    rig.open_page()
    paint = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime"
    paint_ms = browser.wait(lambda: browser.js(paint), "the first paint", PAINT_TIMEOUT_S)
    client.arm()
    client.say("wave with your right hand", wait=False, loop=True)
    client.wait_for("moving", timeout_s=20)
    before, began_s = browser.js("mmmd.frames"), time.monotonic()
    time.sleep(WATCHED_S)
    rate_hz = (browser.js("mmmd.frames") - before) / (time.monotonic() - began_s)
    if picture is not None:
        browser.js(
            "{ const j = document.querySelector('#joint'); j.value = 11; j.dispatchEvent(new Event('change')); scrollTo(0, 0); }"
        )
        browser.js("document.querySelector('#loop').checked = false; document.querySelector('#text').focus()")
        browser.type("salute with your right hand")
        browser.key("Enter", "Enter", 13, "\r")
        time.sleep(1.5)
        browser.js("mmmd.scene.keepUp = () => {}; mmmd.scene.dense = 2; mmmd.scene.dirty = true")
        time.sleep(0.5)
        browser.picture(picture)
    stops_ms: list[float] = []
    for _ in range(STOPS):
        client.gesture("wave_right", wait=False, loop=True)
        client.wait_for("moving", timeout_s=20)
        time.sleep(0.3)
        browser.js("mmmd.halt = null")
        browser.press("#stop")
        browser.wait(lambda: browser.js("mmmd.halt?.ackMs"), "the reply", 10)
        assert "carried out" in browser.text("#halted")
        stops_ms.append(browser.js("mmmd.halt.ackMs - mmmd.halt.pressedMs"))
        client.wait_for("holding", "idle", timeout_s=10)
        time.sleep(0.2)  # a command so soon after a stop would count as one from before it
    return {
        "first_paint_ms": round(paint_ms), "frames_per_s": round(rate_hz, 1), "stop_p50_ms": round(float(np.median(stops_ms)), 1),
        "stop_p95_ms": round(float(np.percentile(stops_ms, 95)), 1), "n": STOPS, "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
    }  # fmt: skip


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
