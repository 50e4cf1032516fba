"""Acts that a text sets aside, forbids or replaces without a plain "not", each with what looks like it and denies nothing."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read
from tests.support.readings import said


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("swap the wave for a bow", "a bow | not: wave"),
        ("could you replace the nod with a salute", "a salute | not: nod"),
        ("wave? no, bow", "bow | not: wave"),
        ("clap? Never! Shrug your shoulders", "shrug your shoulders | not: clap"),
        ("save the bow for later, now wave", "wave | not: bow"),
        ("give the drumming a rest", " | not: drumming"),
        ("the clapping can wait, bow first", "bow | not: clapping"),
        ("bowing is not necessary, only nod", "nod | not: bowing"),
        ("permission to wave denied", " | not: wave"),
        ("resist the urge to clap", " | not: clap"),
        ("hold off on the waving, nod", "nod | not: the waving"),
        ("put a lid on the drumming", " | not: the drumming"),
        ("ease up on the nodding", " | not: the nodding"),
        ("be sure not to bow", " | not: bow"),
        ("drop the bow and clap your hands", "clap your hands | not: the bow"),
        ("this is no time for dancing, bow", "bow"),
        ("you are not allowed to wave", " | not: wave"),
        ("instead of that zombie thing do the robot", "do the robot | not: that zombie thing"),
        ("a bow is what I asked for, not a nod", "a bow | not: a nod"),
        ("I asked for a nod. I didn't ask for a hug.", "a nod | not: a hug"),
        ("keep your hands off your hips and fold your arms", "fold your arms | not: put your hands on your hips"),
        ("No no, don't do anything, grandpa is just taking a picture.", " | not: do anything"),
        ("don't do anything, wave", "wave | not: do anything"),
        ("left hand up, don't do anything", "raise your left hand | not: do anything"),
        ("replace the nod with both arms up", "raise both hands up | not: nod"),
        ("swap the wave with one clap", "one clap | not: wave"),
        ("swap handshakes with the captain of the other team with your left hand",
         "swap handshakes with the captain of the other team with your left hand"),
        ("swap handshakes for hugs", "hugs | not: handshakes"),
        ("trade the wave for a bow", "a bow | not: wave"),
        ("exchange a high five with one hand", "exchange a high five with one hand"),
        ("trade fist bumps with me, then nod", "trade fist bumps with me; nod"),
        ("give up with drooping shoulders", "give up with drooping shoulders"),
        ("give up with the waving", " | not: the waving"),
        ("zip it with your left hand", "zip it with your left hand"),
        ("zip it with the waving", " | not: the waving"),
        ("don't do anything but nod", "nod | not: do anything"),
        ("do not do anything except wave", "wave"),
        ("beckon, don't point, it's rude to point at people", "beckon with a hand | not: point"),
        ("with your left please, and not your right, wave at grandma", "wave with your left hand"),
        ("clap your hands. No, don't. Wave", "wave | not: clap your hands"),
        ("wave, no, bow", "bow | not: wave"),
        ("wave, no, not wave, bow", "bow | not: wave"),
        ("a wave yes, a hug no", "a wave | not: a hug"),
        ("I'd sooner you played the violin than the flute", "play the violin | not: the flute"),
        ("it's not a wave I want, it's a bow", "a bow | not: a wave"),
        ("not the bow, I said wave", "wave | not: the bow"),
        ("forget archery, tennis it is", "tennis | not: archery"),
        ("we don't bow in this country, a wave is fine", "a wave | not: bow in this country"),
        ("put the sword away and bow", "bow | not: sword"),
        ("leave the throwing to your brother and catch the ball", "catch the ball | not: throwing"),
        ("spare me the guitar and nod", "nod | not: the guitar"),
        ("fine, don't clap then", " | not: clap then"),
        ("rather than hug, high-five", "high-five | not: hug"),
        ("stick your left arm out, the right one stays put", "stick your left arm out"),
        ("punch, the left takes a break", "punch with your right hand | not: the left arm"),
        # and what looks like it
        ("pretend to knock, wait, and nod", "pretend to knock; nod"),
        ("shake your head, no, no, no", "shake your head"),
        ("why not wave", "wave"),
        ("don't quit playing the guitar", "play the guitar"),
        ("no harm in a wave", "no harm in a wave"),
        ("swap hands and wave", "swap hands and wave"),
        ("drop your arms", "drop your arms"),
        ("drop your head", "look down"),
        ("put a hand on your hip", "put a hand on your hip"),
        ("scrub the window", "scrub the window"),
        ("hold back the crowd with your left arm", "hold back the crowd with your left arm"),
    ],
)  # fmt: skip
def test_what_is_set_aside_is_not_done(text: str, read_as: str) -> None:
    assert said(text) == read_as


@pytest.mark.parametrize(
    "text", ["the bowing must wait until the clapping is over", "leave the bow till the end, first nod"]
)
def test_what_is_put_off_is_not_denied(text: str) -> None:
    assert "bow" not in " ".join(read(text).denied)
