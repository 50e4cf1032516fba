"""Texts of many commands: all of them are carried out, or none, and then the refusal says why."""

from __future__ import annotations

import pytest

from mmm_core.generate.motion_model import nothing_to_do
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.commands import MOST_STEPS, Reading
from mmm_core.language.reading import read

GESTURES = (
    "wave", "clap", "bow", "nod", "salute", "point up", "shrug", "punch", "knock", "beckon", "cheer", "yawn",
    "cross your arms", "play the guitar", "raise both arms", "look left",
)  # fmt: skip


def _words(reading: Reading) -> list[str]:
    return [" + ".join(command.text for command in step) for step in reading.steps]


@pytest.fixture(scope="module")
def reader() -> SentenceReader:
    return SentenceReader.load()


@pytest.mark.parametrize("between", [", ", " then ", ", and then ", ". "])
@pytest.mark.parametrize("n", [9, MOST_STEPS])
def test_as_many_as_a_text_may_have_are_all_read(reader: SentenceReader, n: int, between: str) -> None:
    found = reader.read(between.join(GESTURES[:n]))
    assert len(found.steps) == n and not found.too_many
    assert [said.split()[0] for said in _words(found)] == [said.split()[0] for said in GESTURES[:n]]


@pytest.mark.parametrize("n", [1, 5, 14])
def test_more_are_refused_with_their_number(reader: SentenceReader, n: int) -> None:
    found = reader.read(", ".join([*GESTURES, *GESTURES[:n]]))
    assert not found.steps and found.too_many == MOST_STEPS + n
    verdict = nothing_to_do(found)
    assert verdict.status == "rejected"
    assert f"{MOST_STEPS + n} commands" in verdict.reason and str(MOST_STEPS) in verdict.reason


def test_a_denial_beside_many_commands_takes_none_of_the_others_away(reader: SentenceReader) -> None:
    found = reader.read("wave, bow, nod, salute, shrug, knock and don't clap")
    assert _words(found) == ["wave", "bow", "nod", "salute", "shrug", "knock"] and found.denied == ("clap",)


@pytest.mark.parametrize("again", ["repeat it all", "repeat", "do it all again"])
def test_a_list_may_end_with_its_repetition(again: str) -> None:
    assert _words(read(f"wave, clap, bow and {again}")) == ["wave", "clap", "bow"] * 2
    assert read(f"{', '.join(GESTURES[:9])} and {again}").too_many == 18
