"""Puts clauses in the order that their words say: "the violin comes second; open with the flute" -> the flute, then the violin.

Each clause may say its place among the others, before its command ("finish on a flex") or after it ("a nod to kick off"). Only a
sentence whose clauses are out of their order is changed; words of order between clauses in order are read by `clauses`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from itertools import permutations

from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.word_tables import phrases

_PLACES = {"first": 0, "between": 1, "last": 2}
"""The places that a clause may say, in order."""
_UNSAID = 1
"""Place of a clause that says none: between the first and the last."""
_BY = r"(?:by|with|on|in|from|off with)(?: you| your)?"
_PARTS = re.compile(r"\s*[;.!:]+\s+|\s*,\s+(?:(?:and|but)\s+)?|\s+(?:and|but|yet)\s+", re.IGNORECASE)
_DENIES = re.compile(r"\b(?:not|never|nor|neither|without|instead|no)\b|n't\b", re.IGNORECASE)
_HAVE_TO_DO = re.compile(
    r"^(?:you (?:will|have(?: got)?(?: to)?|are(?: going)? to|can|should)|there (?:is|are)|you) | to do$", re.IGNORECASE
)
_ADDRESSED = re.compile(
    r"(?:my|dear|love|please|folks|mate|sir|madam|guys|everyone|ok|okay|lad|lads|friends?)\b", re.IGNORECASE
)
_SIDE_ALONE = re.compile(
    r"(?:(?:with|to|on|using) )?(?:the |your )?(?:left|right|other)(?: (?:hand|arm|fist|one|side|shoulder))?",
    re.IGNORECASE,
)
"""Hands and ways of one command, which are no clauses of their own."""
_NO_CLAUSE = re.compile(r"(?:to|with|on|from|in|at|then)\b")
"""Beginnings of words that belong to the clause before them."""
_PLURAL = re.compile(r"\w+s")
_ARTICLES = re.compile(r"\b(?:the|an?|your) ")
_MOST_CLAUSES = 4
"""Clauses of a sentence that is put in order, at most."""


def in_said_order(sentence: str) -> str:
    """A sentence with its clauses in the order that their words say, or the sentence itself.

    >>> in_said_order("finish on a flex; open with two punches"), in_said_order("clap, and bow first")
    ('two punches, then a flex', 'bow, then clap')
    """
    if _DENIES.search(sentence):
        return sentence
    found: list[tuple[int | None, str]] = []
    announced: int | None = None
    for clause in _PARTS.split(sentence.strip(" .!")):
        if (alone := _place_alone(clause)) is not None:
            announced = alone
            continue
        place, words = _placed(clause)
        place, announced = announced if place is None else place, None
        if _NO_CLAUSE.match(words) or _SIDE_ALONE.fullmatch(words):
            return sentence
        if found and place is None and (_ADDRESSED.match(words) or found[-1][0] == _PLACES["last"]):
            found[-1] = found[-1][0], f"{found[-1][1]}, {words}"
        elif found and found[-1][0] is None and _PLURAL.fullmatch(words) and not is_gesture_verb(words):
            found[-1] = place, f"{found[-1][1]} and {words}"
        else:
            found.append((place, words))
    places = [_UNSAID if place is None else place for place, _ in found]
    if places == sorted(places) or not 1 < len(found) <= _MOST_CLAUSES or _is_said_twice([words for _, words in found]):
        return sentence
    in_order = sorted(range(len(found)), key=places.__getitem__)
    return ", then ".join(found[i][1] for i in in_order)


def _place_alone(clause: str) -> int | None:
    """The place that a clause says of the clause after it: "to finish off, bow"."""
    return next((place for kind, place in _PLACES.items() if _patterns(kind)[0].fullmatch(f"{clause}, ")), None)


def _is_said_twice(clauses: Sequence[str]) -> bool:
    """Whether the words of a clause are all in another one: "wave and bow, but the bow first"."""
    words = [set(_ARTICLES.sub("", clause).split()) for clause in clauses]
    return any(a <= b for a, b in permutations(words, 2))


def _placed(clause: str) -> tuple[int | None, str]:
    """The place that a clause says, and the clause without these words."""
    for kind, place in _PLACES.items():
        before, after = _patterns(kind)
        words = after.sub("", before.sub("", clause, count=1))
        if words and words != clause:
            return place, _HAVE_TO_DO.sub("", words)
    return None, clause


@cache
def _patterns(kind: str) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Patterns of the words for a place, before a command and after it."""
    before, after = (
        "|".join(phrases("positions", f"{kind} {where}")).replace("@BY", _BY) for where in ("before", "after")
    )
    return re.compile(rf"^(?:{before})", re.IGNORECASE), re.compile(rf"(?:{after})$", re.IGNORECASE)
