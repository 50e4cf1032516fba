"""Divides a text into commands in order of execution: "clap before you bow, then nod" -> clap, bow, nod.

A rule, not a model: English says the order of two actions with a small, closed set of words
(`mmm_core.language.clause_patterns`), while a text encoder of this size hardly keeps it (docs/model.md). A clause that
leans on the command before it ("and hold it there", "then with the right") stays with that command; between actions done
at the same time only words of order divide.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise

from mmm_core.language import clause_patterns as words
from mmm_core.language.at_once import are_at_once, goes_on
from mmm_core.language.count_words import NUMBERS, SAID_TIMES
from mmm_core.language.ellipsis import OTHER, completed, is_manner
from mmm_core.language.ellipsis_patterns import KEEPS_ON, ONLY_SIDE, THING
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.requests import everyday

MOST_WORDS = 60
"""Largest number of words in a text that is divided; a longer text stays one command."""
_ALL_AGAIN = re.compile(
    r"(?:and )?(?:repeat|again|(?:do|repeat) (?:it|that|them|all|everything|the lot)(?: all)?(?: again)?|the same again|and again)"
)
_ALL_WITH = re.compile(
    r"(?:and )?(?:do )?(?:the (?:very )?same|likewise|(?:repeat|do) (?:it|that|this|all of (?:it|that)|everything)(?: again)?)(?: again)? "
    r"(?:with|using|for|on) (?:the |your )?(left|right|other)(?: (?:hand|arm|one|side))?"
)
"""'Raise your right arm, lower it, then do the same with the left.'"""
_THE_SAME = re.compile(
    r"(?:(?:do )?(?:the same|likewise|it|so|that)|one|another|another one|one more)\b(?: (?:with|using|for|on)\b|$)"
)
_ONCE_MORE = re.compile(r"once (?:more|again)|(?:one|another) more time|another time")
"""Pattern of words without a verb that "and" may join to a command: "wave and once more"."""
_NOUN = re.compile(
    rf"(?:an?|another|{'|'.join(NUMBERS)}) (?:\w+ )?(?:nod|bow|wave|clap|shrug|salute|punch|jab|hook|uppercut|yawn|stretch|twist|head ?shake|cheer|hug)(?:e?s)?\b"
)
_READS = re.compile(r"[A-Za-z]{2,}")


@dataclass(frozen=True)
class _Span:
    start: int
    end: int

    def of(self, text: str) -> str:
        return text[self.start : self.end]


def commands_in_turn(text: str) -> list[str]:
    """The commands of a text in the order of their execution; a text of one command is returned whole."""
    if len(text.split(None, MOST_WORDS)) > MOST_WORDS:
        return [text]
    bare = [_bare(c) for c in _in_turn(" ".join(text.split()))]
    readable = all(_READS.search(c) for c in bare)
    return bare if len(bare) > 1 and readable else [text]


def _in_turn(text: str) -> list[str]:
    for form in (words.BEFORE_B_A, words.B_BEFORE_THAT_A):
        found = form.fullmatch(text)
        if found and words.SPEAKS_OF_AN_ACT.search(found[1]) and _both_stand(found[1], found[2]):
            return [*_in_turn(found[2]), *_in_turn(found[1])]
    return [c for part in _divided(text) for c in _reordered(part)]


def _divided(text: str) -> list[str]:
    """Parts of a text between words of order; a clause that leans on a part stays with it."""
    spans = _spans(text, _Span(0, len(text)), words.DIVIDES)
    spans = [s for s in spans if _READS.search(_bare(s.of(text)))]
    if len(spans) == 1:
        late = words.ENDS_IN_ORDER.search(ended := text.rstrip(" .!")) and words.A_FIRST_B_LATER.fullmatch(ended)
        if late and (whole := completed(_bare(late[2]), _bare(late[1]))):
            return [late[1], whole]
        if late and not _leans(late[2]):
            return [late[1], late[2]]
    if not words.AT_ONCE.search(text) and not words.NOT.search(text):
        spans = [finer for span in spans for finer in _listed(text, span)]
    parts: list[str] = []
    for i, span in enumerate(spans):
        clause = span.of(text)
        if len(parts) > 1 and _ALL_AGAIN.fullmatch(_bare(clause)):
            return parts * 2
        if (
            len(parts) > 1
            and (again := _ALL_WITH.fullmatch(_bare(clause)))
            and (others := _other_side(parts, again[1]))
        ):
            return [*parts, *others]
        whole = completed(_bare(clause), _bare(parts[-1])) if parts else None
        if whole is None and len(parts) > 1 and _leans(clause):  # "it" may be a limb that was named before
            whole = completed(_bare(clause), ", ".join(map(_bare, parts)))
        if whole is not None and _is_manner_alone(clause) and not text[spans[i - 1].end : span.start].strip(" .,;!"):
            parts[-1] = whole  # "nod. slowly."
        elif whole is not None:
            parts.append(whole)
        elif parts and _leans(clause):
            parts[-1] += text[spans[i - 1].end : span.end]
        else:
            parts.append(clause)
    return parts


def _is_manner_alone(clause: str) -> bool:
    """Whether a clause has only words of manner and asks for nothing more: "slowly", but not "slower"."""
    return is_manner(_bare(clause)) and re.search(r"\b(?:\w+er|more|less)\b", clause) is None


def _other_side(parts: list[str], wanted: str) -> list[str]:
    """Commands of one side, transferred to the other; empty if they name no side, both sides, or already the wanted side."""
    sides = {side for part in parts for side in re.findall(r"\b(?:left|right)\b", part)}
    if len(sides) != 1 or sides == {wanted}:
        return []
    return [re.sub(r"\b(?:left|right)\b", lambda m: OTHER[m[0]], part) for part in parts]


def _spans(text: str, whole: _Span, between: re.Pattern[str]) -> list[_Span]:
    """The spans of a text between the matches of a pattern."""
    spans, start = [], whole.start
    for found in between.finditer(text, whole.start, whole.end):
        spans.append(_Span(start, found.start()))
        start = found.end()
    return [*spans, _Span(start, whole.end)]


def _listed(text: str, whole: _Span) -> list[_Span]:
    """The parts of 'wave, nod and bow' if each begins with a verb or, after a comma, omits the verb; else the whole span."""
    spans = _spans(text, whole, words.AND)
    parts = [_bare(s.of(text)) for s in spans]
    if len(parts) == 2 and _THE_SAME.match(parts[1]) and completed(parts[1], parts[0]):
        return spans
    if len(parts) == 2 and goes_on(*parts):
        return [whole]
    if (
        len(parts) == 2
        and not _are_counted(parts)
        and not (ONLY_SIDE.match(parts[1]) and "and" not in text[spans[0].end : spans[1].start])
        and are_at_once(*parts, joined="and" in text[spans[0].end : spans[1].start])
    ):
        return [whole]
    wholes: list[str] = []  # the parts, each with what it leaves out
    verbs: list[object] = []
    for i, part in enumerate(parts):
        after_comma = i and "," in text[spans[i - 1].end : spans[i].start]
        leaves_out = after_comma or (i and _ONCE_MORE.fullmatch(part))
        is_other = is_manner(part) or THING.match(part)  # "wave to the man, the tall one"
        filled = completed(part, wholes[-1]) if leaves_out and not is_other else None
        verbs.append(
            words.BEGINS_WITH_A_VERB.match(part)
            or _is_of_the_same_limb(parts, i)
            or (i > 0 and _takes_an_arm(part, parts[i - 1]))
            or (i == 0 and len(parts) > 1 and words.LIMB_AND_WAY.match(part) and completed(parts[1], part))
            or filled
            or everyday(part)
            or (len(parts) > 2 and is_gesture_verb(part))
            or (i > 1 and _ALL_AGAIN.fullmatch(part))
        )
        wholes.append(filled or (wholes[-1] if i and KEEPS_ON.match(part) else part))
    if _are_counted(parts) or (len(parts) > 2 and all(map(_NOUN.match, parts))):
        return spans
    if len(parts) > 2 and all(map(words.LIMB_ALONE.match, parts)):
        return spans
    if not all(verbs) or any(a == b for a, b in pairwise(parts)):
        return [whole]
    prepares = len(spans) == 2 and words.PREPARES.match(parts[0]) and not words.POSES_ANEW.match(parts[1])
    return [whole] if prepares else spans


def _are_counted(parts: list[str]) -> bool:
    """Whether each part has a number, or is a gesture with an article beside one with a number: "two claps, a nod" is in turn."""
    if len(parts) > 1 and all(words.BEGINS_WITH_A_VERB.match(part) and SAID_TIMES.search(part) for part in parts):
        return True
    return len(parts) > 1 and all(map(_NOUN.match, parts)) and not all(re.match(r"an? ", part) for part in parts)


def _is_of_the_same_limb(parts: list[str], i: int) -> bool:
    """Whether a part without a verb moves the limb of its neighbour, so that it cannot be done with it: "head up, head down"."""
    if len(parts) < 2:
        return False
    neighbour = parts[i - 1] if i else parts[1]
    ours, theirs = words.LIMB_FIRST.match(parts[i]), words.LIMB_FIRST.match(neighbour)
    return bool(ours and theirs and ours[0] == theirs[0] and parts[i] != neighbour)


def _takes_an_arm(part: str, before: str) -> bool:
    """Whether a part without a verb takes one of both arms to another place: "hands up, left hand on your heart"."""
    both = words.BOTH_ARMS_POSED.match(before)
    return bool(both and words.ONE_ARM_PLACED.match(part))


def _reordered(part: str) -> list[str]:
    """'B after A' -> A, B."""
    opened = words.OPENING.sub("", part).strip()
    for form, text, first, second in (
        (words.AFTER_A_B, part.strip(), 1, 2), (words.A_BEFORE_B, opened, 1, 2), (words.B_AFTER_A, opened, 2, 1)
    ):  # fmt: skip
        found = form.fullmatch(text)
        other = 1 if form is words.AFTER_A_B else 2
        if found and words.SPEAKS_OF_AN_ACT.search(found[other]) and _both_stand(found[1], found[2]):
            return [*_reordered(found[first]), *_reordered(found[second])]
    return [part]


def _both_stand(*pair: str) -> bool:
    """Whether both texts are complete commands."""
    return not any(words.NO_COMMAND.match(p.strip()) or _leans(p) or not _READS.search(_bare(p)) for p in pair)


def _leans(clause: str) -> bool:
    bare = _bare(clause)
    return bool(words.LEANS.search(words.SUBJECT.sub("", bare)))


def _bare(clause: str) -> str:
    """A clause without the words of order around it."""
    bare = clause.strip()
    while (shorter := words.CLOSING.sub("", words.OPENING.sub("", bare)).strip()) != bare:
        bare = shorter
    return bare
