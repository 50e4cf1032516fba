"""Reads a sentence with the help of tags: they divide it into commands, the rules read each command.

Rules alone (`mmm_core.language.reading`) divide sentences in phrasings that their tables have; a tagger learnt it from sentences of
many writers. Each command that the tags mark is completed with the words that it omits and read by the rules, or said in the plain
words of the gesture that it means in its sentence.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise

from mmm_core.language.clause_patterns import LIMB_FIRST
from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading
from mmm_core.language.completed_at_once import beside_each_other
from mmm_core.language.denial import denied_side, with_other_side
from mmm_core.language.ellipsis import OTHER, completed
from mmm_core.language.known_phrases import is_known_phrase
from mmm_core.language.one_arm import of_one_arm
from mmm_core.language.plain_gestures import (
    SEVERAL,
    Meant,
    in_plain_words_of,
    is_sure_of,
    said_plainly,
    without_unasked,
)
from mmm_core.language.reading import command_of, read
from mmm_core.language.requests import without_request
from mmm_core.language.spelling import mended
from mmm_core.language.sure_reading import begins_with_a_verb, is_sure, names_acts, unknown_commands
from mmm_core.language.tagged_words import BEFORE, BEGINS, INSIDE, THEN, WITH, MarkedCommands, marked_commands, words_of

_AND = re.compile(r"\band\b ?")
_SIDE_AND_WAY = re.compile(
    r"(?:and |your |the )*(?P<side>left|right|other)(?: one)? "
    r"(?P<way>(?:up|down|out|forwards?|backwards?|back|in|on|at|behind|over|to|by|across|overhead|sideways|straight|high|low)\b.*)"
)
_SIDED_LIMB = re.compile(
    r"(?P<your>\b(?:your|the) )?\b(?P<side>left|right) (?P<limb>hand|arm|fist|palm|elbow|wrist|shoulder|thumb)\b"
)
_HAND_BEFORE = re.compile(
    r"(?:and )?(?:with )?(?:the |your )?(?:left|right)(?: (?:hand|arm))?,? (?:you(?: are|'re|'ll| will)? )?"
)
_MAY_DENY = re.compile(r"\b(?:not(?! that\W*$)|never|none|nor|neither|without|instead|rather|avoid|no need)\b|n't\b")
"""Words of a denial; tags that mark no denial may have missed it."""
_IS_LEFT_OVER = re.compile(r"(?:,? (?:with|and|while|as|then|but|so))+$")
"""Words at the end of a command that belong to the one after it."""
_LIKELY = 0.75
"""Probability from which words that name no act are taken for a command."""
_ALL = re.compile(r"^(?:all(?: of (?:it|them|that))?|both|everything|each)\b ?")


@dataclass(frozen=True)
class Meanings:
    """What a classifier understands by the words of a sentence. A reader without a classifier uses the defaults.

    Attributes:
        how_likely: the least probability with which a command of a reading is a gesture.
        in_sentence: the gestures that marked commands mean in their sentence, in the order of the steps.
        whole: what the whole sentence means.
    """

    how_likely: Callable[[Reading], float] = lambda _: 0.0
    in_sentence: Callable[[MarkedCommands], Sequence[Meant]] = lambda _: ()
    whole: Meant = Meant(SEVERAL, 0.0)  # noqa: RUF009


def read_with_tags(by_rules: Reading, tags: Sequence[str], meanings: Meanings = Meanings()) -> Reading:
    """The commands of a sentence that the rules are not sure of (`is_sure`).

    Args:
        by_rules: the sentence as the rules read it. It stands where the tags divide the sentence in the same way, mark no command,
            or mark words that are none, unless its commands are unlikely to be gestures and those of the tags likely.
        tags: a tag for each of the sentence's words (`mmm_core.language.tagged_words`).
        meanings: what the sentence's words mean.
    """
    marked = marked_commands(by_rules.text, _without_splits(by_rules.text, tags))
    if not _can_be_read(marked):
        return by_rules
    meant = meanings.in_sentence(marked)
    by_tags = without_unasked(said_plainly(_read_marked(by_rules.text, marked), meant), meant)
    if by_rules.denied and not by_tags.denied:  # what is denied must not be done
        return by_rules
    if not by_rules.denied and _n_gestures(meant) > sum(map(len, by_rules.steps)):
        return by_tags
    divides_alike = _shape(by_rules) == _shape(by_tags) and not (by_rules.denied and is_sure(by_tags))
    if names_acts(by_tags) and not divides_alike and not _splits_one(by_rules, by_tags, meanings.whole):
        return by_tags
    if divides_alike:
        by_rules = _with_plain_words(by_rules, marked, meant)
    if _MAY_DENY.search(by_rules.text.lower()) or by_tags.denied or not _has_words_enough(by_tags):
        return by_rules
    is_better = meanings.how_likely(by_rules) < _LIKELY <= meanings.how_likely(by_tags)
    return _with_manner_of(by_rules, by_tags) if is_better else by_rules


def _with_plain_words(by_rules: Reading, marked: MarkedCommands, meant: Sequence[Meant]) -> Reading:
    """The rules' reading, whose unknown commands are said as the marked command means that shares most words with each."""
    unknown = unknown_commands(by_rules)
    if not meant or not unknown:
        return by_rules
    words = [set(said.lower().split()) for step in marked.steps for said in step]

    def plain(command: PlainCommand) -> PlainCommand:
        shared = [len(said & set(command.text.lower().split())) for said in words]
        best = max(range(len(words)), key=lambda i: shared[i])
        return in_plain_words_of(command, meant[best]) if command.text in unknown and shared[best] else command

    return replace(by_rules, steps=tuple(tuple(map(plain, step)) for step in by_rules.steps))


def _splits_one(by_rules: Reading, by_tags: Reading, whole: Meant) -> bool:
    """Whether the tags alone divide a sentence that surely means one gesture."""
    return is_sure_of(whole) and _shape(by_rules)[0] == [1] != _shape(by_tags)[0]


def _n_gestures(meant: Sequence[Meant]) -> int:
    """Number of different gestures that commands surely mean in their sentence."""
    return len({one.name for one in meant if is_sure_of(one)})


def _has_words_enough(reading: Reading) -> bool:
    return all(is_known_phrase(text) or " " in text for text in unknown_commands(reading))


def _with_manner_of(by_rules: Reading, by_tags: Reading) -> Reading:
    """The tags' reading, with the manner that the rules found where the only command has none."""
    found = [command.manner for step in by_rules.steps for command in step if not command.manner.plain]
    if len(found) != 1 or _shape(by_tags)[0] != [1] or not by_tags.steps[0][0].manner.plain:
        return by_tags
    return replace(by_tags, steps=((replace(by_tags.steps[0][0], manner=found[0]),),))


def _without_splits(text: str, tags: Sequence[str]) -> list[str]:
    """Tags in which a command that follows another one without any word between begins with the verb of a gesture.

    Such a beginning is more often an error of the tagger ("shrug | your shoulders") than a list without marks ("nod shrug wave").
    """
    found, spans = _with_hands(text, tags), words_of(text)
    for i, ((start, _end), (before, tag)) in enumerate(zip(spans[1:], pairwise(tags), strict=True), 1):
        follows = before == INSIDE or before in BEGINS
        if follows and tag in (THEN, WITH, BEFORE) and not begins_with_a_verb(text[start:].lower()):
            found[i] = INSIDE
    return found


def _with_hands(text: str, tags: Sequence[str]) -> list[str]:
    """Tags in which a hand alone belongs to the command after it: "with the left | you hold a cup"."""
    found, spans = list(tags), words_of(text)
    begins = [i for i, tag in enumerate(tags) if tag in BEGINS]
    for i, k in pairwise(begins):
        if _HAND_BEFORE.fullmatch(text[spans[i][0] : spans[k][0]].lower()):
            found[i + 1 : k + 1] = [INSIDE] * (k - i)
    return found


def _can_be_read(marked: MarkedCommands) -> bool:
    sizes = [len(step) for step in marked.steps]
    return bool(sizes) and len(sizes) <= MOST_STEPS and max(sizes) <= MOST_AT_ONCE


def _shape(reading: Reading) -> tuple[list[int], bool]:
    return [len(step) for step in reading.steps], bool(reading.denied)


def _read_marked(text: str, marked: MarkedCommands) -> Reading:
    for_all = _AND.sub("", " ".join(_ALL.sub("", _plain(words)) for words in marked.for_all))
    verb_of_all = begins_with_a_verb(for_all)
    steps: list[list[str]] = []
    before = ""
    for step in marked.steps:
        commands: list[str] = []
        for words in step:
            said = _IS_LEFT_OVER.sub("", without_request(_plain(words)))
            if verb_of_all and not (begins_with_a_verb(said) or LIMB_FIRST.match(said)):
                said = f"{for_all} {said}"
            before = (_of_the_other_limb(said, before) or completed(said, before) or said) if before else said
            commands.append(before)
        steps.append(beside_each_other(commands) if len(commands) > 1 else commands)
    beside = f" {for_all}" if for_all and not verb_of_all else ""
    side = next(filter(None, (denied_side(_plain(what)) for what in marked.denied)), "")
    with_arms = iter(of_one_arm([with_other_side(c + beside, side) for c in chain.from_iterable(steps)]))
    return Reading(text, tuple(tuple(_one_command(next(with_arms)) for _ in step) for step in steps), marked.denied)


def _plain(words: str) -> str:
    return mended(words).strip(" ,.!?;:")


def _of_the_other_limb(said: str, before: str) -> str:
    """A command that names a side and a way alone, with verb and limb of the command before: "the left one back"; else empty."""
    found, last = _SIDE_AND_WAY.fullmatch(said), _SIDED_LIMB.search(before)
    if found is None or last is None:
        return ""
    side = found["side"] if found["side"] != "other" else OTHER[last["side"]]
    return f"{before[: last.start()]}{last['your'] or ''}{side} {last['limb']} {found['way']}"


def _one_command(words: str) -> PlainCommand:
    """The command of words that the tags hold to be one command."""
    steps = read(words).steps
    return steps[0][0] if [len(step) for step in steps] == [1] else command_of(words)
