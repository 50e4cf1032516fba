"""A number said once for all commands is the number of each."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("clap and bow three times each", ("clap 3 times", "bow 3 times")),
        ("clap and bow, three of each", ("clap 3 times", "bow 3 times")),
        ("clap, then bow, each twice", ("clap 2 times", "bow 2 times")),
        ("wave, nod and bow once each", ("wave once", "nod once", "bow once")),
        ("clap twice and bow, three times each.", ("clap twice", "bow 3 times")),
        ("clap and bow, sixteen times each", ("clap 16 times", "bow 16 times")),
        ("clap and bow, and do 2 of each of them", ("clap 2 times", "bow 2 times")),
        ("wave with each hand twice", ("wave with both hands twice",)),
    ],
)  # fmt: skip
def test_each_command_has_the_number(text: str, sentences: tuple[str, ...]) -> None:
    assert read(text).sentences == sentences
