"""Which sentences the rules read alone."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read
from mmm_core.language.sure_reading import needs_networks


@pytest.mark.parametrize(
    "text",
    [
        "wave with your right hand",
        "bow, then nod",
        "turn left, then right",
        "shake your head no",
        "nod twice",
        "shake hands with both hands, then wave",
        "don't shrug",
        "don\u2019t shrug",
        "do not wave with your right hand",
        "don't bow or clap",
        "do not shrug before I say so",
        "first nod, then shake your head, then shrug, then cross your arms and finally bow deeply",
        "raise your right arm, lower it, clap twice, bow and then wave with your left hand",
    ],
)
def test_the_rules_alone_read_what_they_read_surely(text: str) -> None:
    assert not needs_networks(read(text))


@pytest.mark.parametrize("n", [5, 8])
def test_no_command_of_a_list_is_left_out(n: int) -> None:
    """Networks and rules for more than two commands knew four at most, and left out the others without a word."""
    said = ["nod", "bow", "wave", "clap", "shrug", "salute", "point up", "cross your arms"][:n]
    reading = read(", ".join(said))
    assert [command.text for step in reading.steps for command in step] == said and not needs_networks(reading)


@pytest.mark.parametrize(
    "text",
    [
        "lean forward, oops, I meant back",
        "turn your head to the left - sorry, to the right",
        "lean back, no, forward",
        "clap, and after you bow",
        "wave with your left hand while you nod",
        "throw the ball with the left and then catch it with the right",  # which the rules take for things done at once
        "put the kettle on",
        "cross your arms. No shrugging",
        "no carrying, you'll drop it",
    ],
)
def test_where_the_rules_may_divide_wrongly_the_networks_are_asked(text: str) -> None:
    assert needs_networks(read(text))


@pytest.mark.parametrize(
    "text",
    ["don't shrug", "do not wave with your right hand", "don't you dare raise your left hand", "don't bow or clap",
     "do not shrug before I say so", "throw a ball... no, never mind", "salute - actually, no, don't"],
)  # fmt: skip
def test_what_is_surely_denied_is_read_without_them(text: str) -> None:
    reading = read(text)
    assert not reading.steps and reading.denied
    assert not needs_networks(reading)


@pytest.mark.parametrize(
    "text",
    [
        "wave then bow, do not clap, finally nod",
        "clap. bow. Do not wave. Nod.",
        "bow before you clap but after you nod",
    ],
)
def test_the_rules_alone_read_what_says_nothing_else(text: str) -> None:
    """The networks left the bow of the first of these out."""
    assert not needs_networks(read(text))


@pytest.mark.parametrize(
    "text", ["no carrying, you will drop it", "wave, and do not bow while he looks", "clap before the show"]
)
def test_other_words_need_the_networks(text: str) -> None:
    reading = read(text)
    assert needs_networks(reading) or not reading.steps
