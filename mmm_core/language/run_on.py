"""Inserts punctuation between run-on commands: "wave bow clap" -> "wave, bow, clap", "once you have waved bow".

Transcripts of speech and hasty messages have no commas. A command ends where a word that may end one ("left", "twice", a gesture)
stands before a verb that begins one, or before a limb of its own ("left arm up right arm up").
"""

from __future__ import annotations

import re
from itertools import groupby

from mmm_core.language.word_tables import LIMB, any_of

_ENDS, _BEGINS = any_of("run_on", "ends"), any_of("run_on", "begins")
_LIMB = any_of("run_on", "limb")
_ANY_LIMB = re.compile(rf"\b(?:{LIMB}|head|shoulders)\b")
_BETWEEN = re.compile(rf"(?<![-\w])(?P<end>{_ENDS}) (?={_BEGINS}\b(?!-))")
_LIMB_NEXT = re.compile(rf"\b(?P<end>{any_of('run_on', 'limb ends')}) (?={_LIMB} {any_of('run_on', 'limb goes')}\b)")
_BARE_LIMB = re.compile(
    rf"(?:^|.*(?:[,.;:]|\b(?:then|and)) )(?:(?:with|using|use|your|the|both|left|right|other) )*(?:{LIMB}|head|shoulders)$"
)
_WAY = r"(?:left|right|up|down|forward|back)"
_WAYS = re.compile(
    rf"(?P<act>\b{any_of('run_on', 'to a way')})(?:e?s)?[,:]? (?P<ways>{_WAY}(?: {_WAY}){{2,}})"
    r"(?:(?P<and>,? and)(?= \w)|(?=$|[,.;]| (?:then|with|slowly|quickly|fast)\b))"
)
"""Directions in turn without any mark: "punch left left right"."""
_TIMES = {1: "once", 2: "twice", 3: "three times", 4: "four times"}
_NO_VERB = re.compile(rf"\b{any_of('run_on', 'noun follows')} (?:\w+ )?$")
_COMMAND = re.compile(
    rf"(?:^|[,.;:]\s*|\b(?:then|and|please|robot|now|ok|first) )(?:{_BEGINS}|{_LIMB}|{any_of('run_on', 'after')})\b"
)


def with_marks(said: str) -> str:
    """A sentence in lower case with commas between commands that follow each other without a word or mark.

    >>> with_marks("wave bow clap"), with_marks("look left look right"), with_marks("give me a head shake")
    ('wave, bow, clap', 'look left, look right', 'give me a head shake')
    >>> with_marks("punch left left right"), with_marks("punch left")
    ('punch left twice, then right once', 'punch left')
    >>> with_marks("left arm up right arm up"), with_marks("hold up your left hand to say stop")
    ('left arm up, right arm up', 'hold up your left hand to say stop')
    """
    said = _WAYS.sub(lambda m: f"{m['act']} {_listed(m['ways'].split())}{', then' if m['and'] else ''}", said)
    if not _COMMAND.match(said):
        return said
    for pattern in (_BETWEEN, _LIMB_NEXT):
        marked, at = "", 0
        for found in pattern.finditer(said):
            before = said[: found.end("end")]
            is_particle = pattern is _LIMB_NEXT and not _ANY_LIMB.search(said[at : found.start("end")])
            if not is_particle and not _NO_VERB.search(said[: found.start("end")]) and not _BARE_LIMB.match(before):
                marked += f"{said[at : found.end('end')]},"
                at = found.end("end")
        said = marked + said[at:]
    return said


def _listed(ways: list[str]) -> str:
    """Directions in turn, each with the number of times it is said in a row."""
    found = [(way, len(list(same))) for way, same in groupby(ways)]
    if len(found) == len(ways):
        return ", then ".join(ways)
    return ", then ".join(f"{way} {_TIMES.get(n, f'{n} times')}" for way, n in found)
