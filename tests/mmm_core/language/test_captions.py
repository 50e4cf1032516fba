"""Which texts may be captions of people, and that no known command is one."""

from __future__ import annotations

import pytest

from mmm_core.corpus.heldout import PROBES
from mmm_core.corpus.plain_commands import known_commands
from mmm_core.language.captions import may_be_of_people


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a person dribbles a basketball", True),
        ("A man is washing a window.", True),
        ("someone directs traffic with both arms", False),
        ("a young woman dances the salsa with a partner", True),
        ("person is dancing around", True),
        ("a person slowly walks down some stairs", True),
        ("a person jumps", True),
        ("a person waves", False),
        ("someone is clapping", False),
        ("a figure punches", False),
        ("a person waves with their right hand", False),
        ("a person claps three times", False),
        ("dribble a basketball", False),
        ("someone's at the door, wave to them", False),
        ("somebody here owes me a fist bump", False),
        ("show the person your right hand", False),
        ("", False),
    ],
)
def test_captions_of_people(text: str, expected: bool) -> None:
    assert may_be_of_people(text) == expected


def test_no_known_command_may_be_one() -> None:
    said = [*known_commands(1), *(probe.text for probe in PROBES)]
    assert len(said) > 1000
    assert [text for text in said if may_be_of_people(text)] == []
