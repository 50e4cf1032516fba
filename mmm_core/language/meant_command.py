"""A command that the speaker takes back at once for another one: "look around, I mean type on a keyboard"."""

from __future__ import annotations

import re

from mmm_core.language.limbs import begins_with_a_verb

_I_MEAN = re.compile(
    r"(?:^|(?<=[,.;] ))(?P<before>[^,.;!?]{2,60})[,.;!]* (?:(?:no|sorry|wait|oops|erm?),? )*"
    r"i (?:actually |really )?(?:mean|meant)(?: to say)?[,:]? (?P<now>[^,.;!?]+)"
)


def with_meant_command(said: str) -> str:
    """A text in lower case without a command that is taken back for another; the text itself where there is none.

    >>> with_meant_command("bow, then look around, i mean type on a keyboard")
    'bow, type on a keyboard'
    >>> with_meant_command("raise your left arm, i mean your right one")
    'raise your left arm, i mean your right one'
    """
    return _I_MEAN.sub(_meant, said) if "i " in said and "mean" in said else said


def _meant(found: re.Match[str]) -> str:
    before = found["before"].removeprefix("then ").removeprefix("and ")
    return found["now"] if begins_with_a_verb(before) and begins_with_a_verb(found["now"]) else found[0]
