"""The web page in a real browser, on a whole daemon with simulated servos: what a person types, presses and sees."""

from __future__ import annotations

import json
import os
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest

from retarget.robot.description import load_description, mujoco
from retarget.robot.loading import load_robot
from tests.support.browser import Browser
from tests.support.harness import MMMD, RunningDaemon, free_ports
from tests.support.live_page import OUT, SOON_S, Page

pytestmark = pytest.mark.realtime

SPACE = (" ", "Space", 32, " ")


@pytest.mark.long
def test_a_text_moves_the_arm_on_the_page(page: Page) -> None:
    browser = page.browser
    assert browser.text("#kind") == "SIMULATOR"
    page.until("limp")
    assert "torque is off" in browser.text("#needs")
    before, since = browser.js("[mmmd.state.present_rad, mmmd.passed.length]")
    still = browser.picture(OUT / "limp.png")
    browser.js("document.querySelector('#hold').checked = true")
    page.say("raise your right arm")
    page.until_passed("moving", since)
    browser.wait(
        lambda: max(abs(a - b) for a, b in zip(browser.js("mmmd.state.present_rad"), before, strict=True)) > 0.5,
        "the arm",
        SOON_S,
    )
    assert browser.picture(OUT / "moving.png") != still
    browser.wait(
        lambda: "understood" in browser.text("#answer") or "shown" in browser.text("#answer"), "the answer", SOON_S
    )
    browser.wait(lambda: "well" in browser.text("#well"), "the servos' health", SOON_S)
    browser.wait(lambda: browser.text("#servos").count("°C") == 16, "every servo's temperature", SOON_S)


@pytest.mark.long
def test_a_robot_at_rest_is_not_drawn_again(page: Page) -> None:
    """Drawing took a whole core of a computer without a GPU, also where nothing moved, and made every first motion later."""
    browser, states = page.browser, "mmmd.history.rows.length"
    with page.daemon.armed():
        pass
    page.until("idle", "holding")
    browser.js(f"{states} = 0")
    browser.wait(lambda: browser.js(states) > 20, "a second at rest", SOON_S)
    before = browser.js("mmmd.frames")
    browser.wait(lambda: browser.js(states) > 40, "another second", SOON_S)
    assert browser.js("mmmd.frames") == before
    page.moving()
    browser.wait(lambda: browser.js("mmmd.frames") > before + 5, "the motion", SOON_S)


def test_the_page_places_bodies_as_mujoco_does(page: Page) -> None:
    robot = load_robot("reference")
    low, high = robot.position_min_rad, robot.position_max_rad
    q_rad = low + np.random.default_rng(3).random(robot.n_joints) * (high - low)
    model = load_description(robot)
    data = mujoco.MjData(model)
    data.qpos[[model.joint(name).qposadr[0] for name in robot.joint_names]] = q_rad
    mujoco.mj_kinematics(model, data)
    places = np.array(page.browser.js(f"mmmd.robot.places({q_rad.tolist()}).map((m) => [...m])")).reshape(-1, 4, 4)
    np.testing.assert_allclose(places[:, 3, :3], data.xpos, atol=1e-5)
    np.testing.assert_allclose(places[:, :3, :3].swapaxes(1, 2), data.xmat.reshape(-1, 3, 3), atol=1e-5)


@pytest.mark.long
@pytest.mark.parametrize("way", ["button", "space", "escape while typing"])
def test_stop_brakes(page: Page, way: str) -> None:
    page.moving()
    if way == "button":
        page.browser.press("#stop")
    elif way == "space":
        page.browser.key(*SPACE)
    else:
        page.browser.js("document.querySelector('#text').focus()")
        page.browser.key("Escape", "Escape", 27)
    page.until("holding")
    page.browser.wait(lambda: page.browser.js("mmmd.halt.done"), "that the stop was carried out", SOON_S)


@pytest.mark.long
def test_space_in_the_text_box_is_a_space(page: Page) -> None:
    page.moving()
    page.browser.js("document.querySelector('#text').focus()")
    page.browser.key(*SPACE)
    assert page.browser.js("mmmd.halt") is None
    assert page.browser.js("document.querySelector('#text').value") == " "
    page.browser.press("#stop")
    page.until("holding")


@pytest.mark.long
def test_gestures_are_buttons(page: Page) -> None:
    with page.daemon.armed():
        page.browser.js("document.querySelector('#loop').checked = true")  # so that it still plays when STOP is pressed
        page.browser.js(
            "[...document.querySelectorAll('#gestures button')].find((b) => b.textContent === 'bow').click()"
        )
        page.until("moving")
        page.browser.press("#stop")
        page.until("holding")


@pytest.mark.long
def test_a_frozen_and_a_dead_daemon_are_told_apart_from_a_live_one(page: Page) -> None:
    browser, front = page.browser, page.daemon.process
    os.kill(front.pid, signal.SIGSTOP)
    try:
        browser.wait(
            lambda: (
                "does not answer" in browser.text("#lost") and browser.js("!document.querySelector('#lost').hidden")
            ),
            "loss",
            SOON_S,
        )
        assert browser.text("#state") == "unknown"
        browser.picture(OUT / "lost.png")
    finally:
        os.kill(front.pid, signal.SIGCONT)
    browser.wait(lambda: browser.js("document.querySelector('#lost').hidden"), "the daemon again", SOON_S)
    assert json.loads(browser.js("JSON.stringify(mmmd.state)"))["robot"] == "reference"
    front.kill()
    browser.wait(lambda: browser.js("!document.querySelector('#lost').hidden"), "loss", SOON_S)


@pytest.mark.long
def test_a_recorded_run_is_scrubbed_through(page: Page) -> None:
    """The daemon of the run was killed: a log that was cut off is shown as far as it goes."""
    (port,) = free_ports(1)
    browser = page.browser
    log = a_killed_run(browser, page.daemon.folder / "killed.mcap")
    with (page.daemon.folder / "recorded").open("wb") as out:
        served = subprocess.Popen(
            [*MMMD, "view", log, "--http", f"127.0.0.1:{port}"], stdout=out, stderr=out, start_new_session=True
        )
    try:
        browser.wait(lambda: b"page at" in (page.daemon.folder / "recorded").read_bytes(), "the page's server", SOON_S)
        browser.open(f"http://127.0.0.1:{port}/")
        browser.wait(lambda: browser.js("!!globalThis.mmmd?.run && mmmd.frames > 0"), "the run", SOON_S)
        assert browser.text("#kind") == "RECORDED"
        assert browser.js("getComputedStyle(document.querySelector('#halts')).display") == "none"
        poses = browser.js(
            "[...Array(50).keys()].map((i) => { const at = document.querySelector('#at'); at.value = i / 50 * at.max;"
            " at.dispatchEvent(new Event('input')); return [...mmmd.run.frame().q]; })"
        )
        assert np.ptp(poses, axis=0).max() > 0.1
        browser.js("const at = document.querySelector('#at'); at.value = 0; at.dispatchEvent(new Event('input'))")
        before = browser.text("#time")
        browser.press("#play")  # from the beginning: from near its end the run is over before anybody looks
        browser.wait(lambda: browser.text("#time") != before, "the run goes on", SOON_S)
    finally:
        served.terminate()
        served.wait(10)


def a_killed_run(browser: Browser, log: Path) -> str:
    """Record a robot that waves, kill its daemon in the middle of it, and give the log's path."""
    daemon = RunningDaemon("--log", str(log))
    try:
        daemon.until_ready()
        with daemon.armed() as robot:
            before = robot.status()
            robot.gesture("wave_right", loop=True, wait=False)
            browser.wait(
                lambda: np.ptp([robot.status().present_rad, before.present_rad], axis=0).max() > 0.5, "the arm", SOON_S
            )
            recorded = Path(before.recording)
            browser.wait(recorded.is_file, "the log", SOON_S)  # the recorder may be the last process to start
            n_bytes = recorded.stat().st_size
            browser.wait(lambda: recorded.stat().st_size > n_bytes, "that the log holds it", SOON_S)
        daemon.process.kill()
    finally:
        daemon.close()
    return before.recording
