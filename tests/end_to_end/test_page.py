"""The web page in a real browser, on a whole daemon with simulated servos: what a person types, presses and sees."""

from __future__ import annotations

import json
import os
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from retarget.robot.description import load_description, mujoco
from retarget.robot.loading import load_robot
from tests.support.browser import Browser
from tests.support.harness import MMMD, RunningDaemon, free_ports

pytestmark = pytest.mark.realtime

OUT = Path("out/page")
SOON_S = 30.0
SPACE = (" ", "Space", 32, " ")
WATCH_PLACES = """
{
  const watched = [...document.querySelectorAll("#verbs button, #halts button, #say button, #gestures")];
  document.documentElement.style.overflowAnchor = "none"; // Safari does not keep in place what is in sight
  globalThis.places = watched.map(() => new Set());
  globalThis.look = () => watched.forEach((b, k) => places[k].add(JSON.stringify(b.getBoundingClientRect())));
  const on = () => { look(); globalThis.watch = requestAnimationFrame(on); };
  on();
}"""
"""The page keeps in `places` where each button has been in any frame."""


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


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    (port,) = free_ports(1)
    daemon = RunningDaemon("--log", str(tmp_path_factory.mktemp("log") / "run.mcap"))
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


def test_estop_and_reset_on_a_phone(page: Page) -> None:
    browser = page.browser
    browser.size(390, 844, phone=True)
    try:
        page.moving()
        browser.js("document.querySelectorAll('details').forEach((d) => { d.open = true; }); scrollTo(0, 1e6)")
        for button in ("#stop", "#estop"):
            place = browser.js(f"JSON.stringify(document.querySelector('{button}').getBoundingClientRect())")
            left, top, right, bottom = (json.loads(place)[side] for side in ("left", "top", "right", "bottom"))
            assert 0 <= top < bottom <= 844 and 0 <= left < right <= 390 and bottom - top >= 48
        assert browser.js("document.documentElement.scrollWidth") <= 390
        browser.picture(OUT / "phone.png")
        browser.press("#estop")
        page.until("estop")
        assert "reset" in browser.text("#needs")
        browser.js("document.querySelector('[data-verb=reset]').scrollIntoView({ block: 'center' })")
        browser.press("[data-verb=reset]")
        page.until("limp")
    finally:
        browser.size(1280, 800)


@pytest.mark.parametrize("screen", ["phone", pytest.param("desktop", marks=pytest.mark.long)])
def test_no_button_moves_when_the_page_tells_something(page: Page, screen: str) -> None:
    """What moves between press and release is not pressed: a reset after an e-stop was lost when the text above became shorter."""
    browser = page.browser
    if screen == "phone":
        browser.size(390, 844, phone=True)
    try:
        page.moving()
        browser.js("document.querySelector('#verbs').scrollIntoView({ block: 'center' })")
        browser.js(WATCH_PLACES)
        page.say("raise your right arm as high as you can, then wave with it, nod twice, and cross your arms")
        browser.wait(lambda: "nod" in browser.text("#running"), "a long text", SOON_S)
        browser.press("#stop")
        page.until("holding")
        browser.press("#estop")
        page.until("estop")
        browser.press("[data-verb=arm]")
        browser.wait(lambda: "reset" in browser.text("#answer"), "what it needs first", SOON_S)
        browser.js("lost.hidden = false; lost.textContent = 'Lost. '.repeat(30); look()")
        browser.press("[data-verb=reset]")
        page.until("limp")
        for places in browser.js("places.map((p) => [...p])"):
            assert len(places) == 1, places
    finally:
        browser.js("cancelAnimationFrame(globalThis.watch); document.documentElement.style.overflowAnchor = ''")
        browser.size(1280, 800)


def test_the_page_tells_what_became_of_a_verb(page: Page) -> None:
    browser = page.browser
    page.rest()

    def until_told(verb: str, told: str) -> None:
        browser.press(f"[data-verb={verb}]")
        browser.wait(lambda: told in browser.text("#answer"), told, SOON_S)

    until_told("torque", "torque off: carried out, the robot is limp")
    until_told("arm", "arm: carried out, the robot is idle")
    until_told("park", "park: carried out, the robot is limp")
    browser.press("#estop")
    page.until("estop")
    until_told("arm", "arm: the robot is in e-stop")
    assert browser.js("document.querySelector('#answer').className") == "bad"
    until_told("reset", "reset: carried out, the robot is limp")


def test_a_verb_goes_by_a_second_way_when_its_connection_is_lost(page: Page) -> None:
    browser = page.browser
    page.rest()
    browser.js("mmmd.ctl.connect = () => {}; mmmd.ctl.socket.close()")
    try:
        browser.press("[data-verb=torque]")
        told = "torque off: carried out, the robot is limp"
        browser.wait(lambda: browser.text("#answer") == told, "the answer by POST", SOON_S)
        browser.js("globalThis.kept = fetch; globalThis.fetch = async () => { throw new TypeError(); }")
        browser.press("[data-verb=arm]")
        browser.wait(lambda: "arm: NO ANSWER" in browser.text("#answer"), "that nothing got through", SOON_S)
    finally:
        browser.js("globalThis.fetch = globalThis.kept ?? fetch; delete mmmd.ctl.connect; mmmd.ctl.connect()")
    browser.wait(lambda: browser.js("mmmd.ctl.open"), "the connection again", SOON_S)


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
            n_bytes = Path(before.recording).stat().st_size
            browser.wait(lambda: Path(before.recording).stat().st_size > n_bytes, "that the log holds it", SOON_S)
        daemon.process.kill()
    finally:
        daemon.close()
    return before.recording
