"""The page's memory: an hour of what a daemon publishes, given to the page as fast as it takes it."""

from __future__ import annotations

import itertools
import json
import statistics
import subprocess
import sys
import time
import urllib.request

import msgspec
import pytest

from daemon.demo.main_job import free_endpoints
from daemon.wire.status import HealthEvent, ServoHealth, StateEvent
from retarget.robot.loading import load_robot
from tests.support.browser import Browser
from tests.support.harness import free_ports

pytestmark = pytest.mark.realtime

HOUR_S, RATE_HZ = 3600, 20
PART_S = 300
"""Seconds of messages in one call of the browser."""
GROWTH_BYTES = 200_000
"""Growth of the heap in half an hour that counts as a leak."""
AN_HOUR = """
globalThis.hour = (from, seconds, rate, state, health) => {
  for (let k = 0; k < seconds * rate; k++) {
    const t = from + k / rate, s = structuredClone(state);
    s.t_mono = t; s.uptime_s = t; s.seq = Math.round(t * rate); s.present_rad = s.present_rad.map((_, j) => 0.3 * Math.sin(t + j));
    s.goal_rad = s.present_rad.map((q) => q + 0.02); s.state = t % 8 < 4 ? "moving" : "idle";
    mmmd.heard(s);
    if (k % rate === 0) {
      mmmd.heard(structuredClone(health));
      mmmd.heard({ type: "log", level: "info", process: "front", text: `line ${k} of ${from}` });
      mmmd.heard({ type: "done", id: `c${t}`, shown: "waves", seen: "waves" });
    }
    if (k % (60 * rate) === 0) { mmmd.paint(); mmmd.plots(); }
  }
  return mmmd.history.rows.length;
};"""


@pytest.mark.long
def test_an_hour_leaves_the_page_as_large_as_some_minutes_do():
    robot = load_robot("reference")
    names = robot.joint_names
    state = StateEvent(
        robot="reference", bus="sim://", state="idle", must_arm=False, reason="", command=None, generator="ready",
        joint_names=list(names), goal_rad=[0.0] * len(names), present_rad=[0.0] * len(names), queued_ms=0.0, bus_info={},
        recording="", uptime_s=0.0, person_m=[0.1 * (k % 7) for k in range(66)], person_faces=[0.0, 0.0, 1.0],
        effort=[1.0] * len(names),
    )  # fmt: skip
    servos = [
        ServoHealth(id=k, joint=name, state="ok", temperature_c=40, effort_unit="mA") for k, name in enumerate(names, 1)
    ]
    health = HealthEvent(robot="reference", servos=servos, silent_ms=0.0)
    given = ", ".join(msgspec.json.encode(event).decode() for event in (state, health))
    ends, (port,) = free_endpoints(), free_ports(1)
    at = ["--cmd", ends.cmd, "--ctl", ends.ctl, "--pub", ends.pub]
    command = [sys.executable, "-m", "daemon.cli", "view", "--robot", "reference", "--http", f"127.0.0.1:{port}", *at]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        _until_served(port)
        with Browser() as browser:
            browser.open(f"http://127.0.0.1:{port}/")
            browser.wait(lambda: browser.js("!!globalThis.mmmd?.heard"), "the page", 30)
            browser.js(AN_HOUR)
            heap, nodes = [], []
            for from_s in range(0, HOUR_S, PART_S):
                rows = browser.js(f"hour({from_s + 1}, {PART_S}, {RATE_HZ}, {given})")
                assert 0 < rows <= 600
                browser.call("HeapProfiler.collectGarbage")
                heap.append(browser.call("Runtime.getHeapUsage")["usedSize"])
                nodes.append(browser.js("document.querySelectorAll('*').length"))
            assert browser.js("mmmd.robot !== null && mmmd.frames > 0"), "nothing was drawn"
            assert not browser.errors, browser.errors
        half = len(heap) // 2
        assert _growth(heap) * half < GROWTH_BYTES, json.dumps(heap)
        assert nodes[-1] == nodes[half], nodes
    finally:
        server.terminate()
        server.wait(10)


def _growth(sizes: list[int]) -> float:
    """Growth from one size to the next: the median slope of all pairs (Theil and Sen).

    What the browser keeps for itself, such as compiled code, comes and goes in steps, which move it little.
    """
    pairs = itertools.combinations(enumerate(sizes), 2)
    return statistics.median((b - a) / (j - i) for (i, a), (j, b) in pairs)


def test_a_leak_shows_whatever_the_browser_keeps_for_itself():
    # Sizes of a page that leaked nothing, in kB.
    kilobytes = [int(size) for size in "2065 1466 1584 1771 1615 1605 1657 1657 1657 1657 2270 2270".split()]
    once = [1000 * size for size in kilobytes]
    half = len(once) // 2
    assert _growth(once) * half < GROWTH_BYTES
    leaking = [size + k * GROWTH_BYTES // half for k, size in enumerate(once)]
    assert _growth(leaking) * half >= GROWTH_BYTES


def _until_served(port: int) -> None:
    end_s = time.monotonic() + 60
    while time.monotonic() < end_s:
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=2).close()
        except OSError:
            time.sleep(0.2)
        else:
            return
    raise AssertionError("`mmmd view` does not serve within 60 s")
