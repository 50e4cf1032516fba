"""The buttons of the web page in a real browser: each press counts, and the page tells what became of it."""

from __future__ import annotations

import json

import pytest

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
