"""Commands that the speaker corrects to another side or direction: "raise your left arm. No, not that arm, the other one"."""

from __future__ import annotations

import re

from mmm_core.language.ellipsis import completed

_BUT_NOW = re.compile(
    r"^(?P<before>.+?)(?:[.,;!]+|\.\.\.)\s*(?:(?:no(?=[,.])|hm+|oh|ah|er|um|wait|sorry|well|actually|rather|i mean|or|wrong (?:one|arm|hand|side|way)|scratch that|my mistake|correction|oops|my bad)[,. ]+)+"
    r"(?:not (?:that|this|with that|the)(?: (?:arm|hand|one|side|way|left|right))?[,.]? )?(?:but )?(?:(?:just|only|make (?:that|it)|i mean|i meant|use|with) )*"
    r"(?P<now>(?:your |the )?(?:left|right|other)(?: one| arm| hand| side| way)?|both(?: arms| hands)?)(?: please)?\W*$"
)

_I_SAID = re.compile(
    r"^(?:(?P<before>.+?)[.,;!]+ )??(?:(?:no|hey|oi|wait|sorry|robot|but)[,.! ]+)*"
    r"(?:(?:i (?:said|say|mean|meant|want(?:ed)?|asked for)|it is|that is|(?:the |your )?)[, ]*)?(?P<now>(?:the |your |to the |with your |with the )?(?:left|right|other)(?: one| arm| hand| side)?)"
    r"[,.]? (?:and )?not (?:the |your |to the |with your |with the )?(?:left|right|other)(?: one| arm| hand| side)?\W*$"
)
"""'I said left, not right', with or without the command that is put right."""


def corrected(said: str) -> str:
    """A sentence with its correction applied; the sentence itself where it contains no correction.

    >>> corrected("raise your right arm, I said left, not right".lower())
    'raise your left arm'
    >>> corrected("raise your left arm. no, not that arm, the other one"), corrected("raise both arms. actually just the left")
    ('raise your right arm', 'raise your left arm')
    """
    found = _BUT_NOW.match(said) or _I_SAID.match(said)
    if found is None:
        return said
    if not found["before"]:
        return found["now"]
    return completed(found["now"], found["before"]) or said
