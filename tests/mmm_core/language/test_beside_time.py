"""Times, talk and pauses that are no holds and no commands, and what looks like these."""

from __future__ import annotations

import pytest

from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("we start the show in a second, and when I give the sign you raise your left hand", "raise your left hand"),
        ("nod within two seconds", "nod within two seconds"),
        ("no need to wave, a nod is plenty", "a nod"),
        ("let them know you can't hear", "cup your right ear"),
        ("let him know you saw him", "nod your head"),
        ("knock on the door twice, wait, and once more", "knock on the door twice > knock on the door once"),
        ("I don't know if you can do this but try leaning to your right", "lean to the right"),
        ("bring your right hand to your mouth, cough, and lower it",
         "bring your right hand to your mouth > cough with your right hand > lower your right hand"),
        ("before you wave at me give us a nod", "give us a nod > wave your right hand"),
        ("my teacher says robots can't dance but I bet you can, so show her", "dance with one arm after the other"),
        ("we saw my grandmother, she is a bit shy, so maybe just nod at her", "nod"),
        ("show them where the exit is, it's to your right", "point to the right"),
        ("wave at them but make it quick", "wave (1.6 times as fast)"),
        ("throw your arms out as wide as they'll go", "throw your arms out (1.4 times as large)"),
        # and what these rules must leave alone
        ("hold your right arm up for a second", "raise your right arm up (for 1 s)"),
        ("nod and stay so for two seconds", "nod (for 2 s)"),
        ("do not wave, a nod is not enough", ""),
        ("hammer in the left hand, bang", "hammer in the left hand, bang"),
    ],
)  # fmt: skip
def test_what_is_said_beside_a_command(text: str, read_as: str) -> None:
    assert " > ".join(read(text).sentences) == read_as
