"""Acts that a text sets aside, forbids or replaces without a plain "not", each with what looks like it and denies nothing."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read


def said(text: str) -> str:
    """The commands that are read and what is denied, as one line: "wave | not: bow"."""
    reading = read(text)
    return "; ".join(reading.sentences) + (f" | not: {', '.join(reading.denied)}" if reading.denied else "")


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
        # and what looks like it
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
