"""The buttons of the web page in a real browser: each press counts, and the page tells what became of it."""

from __future__ import annotations

import json

import pytest

from daemon.front.late_requests import OLDEST_STATE_S
from tests.support.live_page import OUT, SOON_S, Page

pytestmark = pytest.mark.realtime

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
HOLD_BACK = """
{
  const socket = mmmd.LINE.socket;
  globalThis.held = [];
  socket.send = (frame) => held.push(frame);
  globalThis.letGo = () => { delete socket.send; held.forEach((frame) => socket.send(frame)); };
}"""
"""A connection (LINE: cmd or ctl) stalls: it stays open, and what is sent lies in `held` until `letGo`."""
SAY_ON = """
    mmmd.state = STATE;
    document.querySelector('#text').value = 'TEXT';
    document.querySelector('#say').requestSubmit()"""
"""A text is sent while STATE is the newest that the page has."""
HELD_FOR_S = "mmmd.state.t_mono - JSON.parse(held[0]).state_t_mono"


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
    """A button that moves while a person presses it takes no press: so a reset after an e-stop was lost."""
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


def test_an_arm_that_a_stalled_connection_held_back_is_refused(page: Page) -> None:
    """A Wi-Fi hole: the connection still counts as open, and what was pressed arrives when nobody expects it any more."""
    browser = page.browser
    page.rest()
    browser.press("[data-verb=torque]")
    page.until("limp")
    browser.js(HOLD_BACK.replace("LINE", "ctl"))
    since = browser.js("mmmd.passed.length")
    browser.press("[data-verb=arm]")
    browser.wait(lambda: "arm: NO ANSWER" in browser.text("#answer"), "that nothing got through", SOON_S)
    browser.wait(lambda: browser.js(HELD_FOR_S) > OLDEST_STATE_S, "a frame held back for longer than the limit", SOON_S)
    assert browser.js("JSON.parse(held[0]).type") == "arm"
    browser.js("letGo()")
    browser.wait(lambda: "arm: the newest state" in browser.text("#answer"), "the refusal", SOON_S)
    assert "s old when it arrived; not carried out: look at the robot" in browser.text("#answer")
    with page.daemon.client() as client:
        assert client.status().state == "limp"
    assert browser.js(f"mmmd.passed.slice({since})") == []
    browser.press("[data-verb=arm]")
    told = "arm: carried out, the robot is idle"
    browser.wait(lambda: browser.text("#answer") == told, "a new press counts", SOON_S)


def test_a_text_that_a_stalled_connection_held_back_arms_nothing(page: Page) -> None:
    """A text arms a limp robot by itself, so it must not arrive when nobody expects it any more."""
    browser = page.browser
    page.rest()
    browser.press("[data-verb=park]")
    page.until("limp")
    browser.js("document.querySelector('#hold').checked = false; document.querySelector('#loop').checked = true")
    browser.js(HOLD_BACK.replace("LINE", "cmd"))
    since = browser.js("mmmd.passed.length")
    page.say("wave with your right hand")
    browser.wait(lambda: browser.js("held.length === 1"), "the text", SOON_S)
    browser.wait(lambda: browser.js(HELD_FOR_S) > OLDEST_STATE_S, "a frame held back for longer than the limit", SOON_S)
    browser.js("letGo()")
    browser.wait(lambda: "'wave with your right hand': the newest" in browser.text("#answer"), "the refusal", SOON_S)
    assert "s old when it arrived; not carried out: look at the robot" in browser.text("#answer")
    with page.daemon.client() as client:
        assert (client.status().state, client.status().waiting) == ("limp", [])
    assert browser.js(f"mmmd.passed.slice({since})") == []
    page.say("wave with your right hand")
    page.until("moving")
    old = "{ ...mmmd.state, t_mono: mmmd.state.t_mono - 60 }"
    browser.js(SAY_ON.replace("STATE", old).replace("TEXT", "stop moving"))
    page.until("holding")


def test_a_page_without_a_state_sets_nothing_going(page: Page) -> None:
    browser = page.browser
    page.rest()
    since = browser.js("mmmd.passed.length")
    gesture = "mmmd.state = null; document.querySelector('#gestures button').click()"
    assert "gesture: not sent" in browser.js(f"{gesture}; document.querySelector('#answer').textContent")
    say = SAY_ON.replace("STATE", "null")
    browser.js(say.replace("TEXT", "wave with your right hand"))
    browser.wait(lambda: "is from before this daemon's start" in browser.text("#answer"), "the refusal", SOON_S)
    browser.js(say.replace("TEXT", "please stop"))
    browser.wait(lambda: "means to stop" in browser.text("#answer"), "a stop all the same", SOON_S)
    page.until("holding")
    assert set(browser.js(f"mmmd.passed.slice({since})")) <= {"idle", "holding"}


def test_a_page_without_a_new_state_cannot_arm_by_either_way(page: Page) -> None:
    browser = page.browser
    page.rest()
    browser.press("[data-verb=torque]")
    page.until("limp")
    browser.js("mmmd.state = null; document.querySelector('[data-verb=arm]').click()")
    assert "arm: not sent" in browser.text("#answer")
    page.until("limp")
    browser.wait(lambda: browser.js("!!mmmd.state"), "a state", SOON_S)
    press_on_an_old_state = """
        mmmd.state = { ...mmmd.state, t_mono: mmmd.state.t_mono - 60 };
        document.querySelector('#answer').textContent = '';
        document.querySelector('[data-verb=arm]').click()"""
    try:
        for way in ("WebSocket", "POST"):
            if way == "POST":
                browser.js("mmmd.ctl.connect = () => {}; mmmd.ctl.socket.close()")
            browser.js(press_on_an_old_state)
            browser.wait(lambda: "not carried out: look" in browser.text("#answer"), f"the refusal by {way}", SOON_S)
        browser.wait(lambda: browser.js("true") and browser.errors, "Chromium's own line of the answer 409", SOON_S)
        assert ["409" in line for line in browser.errors] == [True]
        browser.errors.clear()
    finally:
        browser.js("delete mmmd.ctl.connect; mmmd.ctl.open || mmmd.ctl.connect()")
    browser.wait(lambda: browser.js("mmmd.ctl.open"), "the connection again", SOON_S)
    with page.daemon.client() as client:
        assert client.status().state == "limp"
