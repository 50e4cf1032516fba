"""Reads a sentence with the help of tags: they divide it into commands, the rules read each command.

Rules alone (`mmm_core.language.reading`) divide sentences in phrasings that their tables have; a tagger learnt it from sentences of
many writers. Each command that the tags mark is completed with the words that it omits and read by the rules.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import chain, pairwise

from mmm_core.language.clause_patterns import BEGINS_WITH_A_VERB, LIMB_FIRST
from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading
from mmm_core.language.completed_at_once import beside_each_other
from mmm_core.language.denial import denied_side, with_other_side
from mmm_core.language.ellipsis import OTHER, completed
from mmm_core.language.known_phrases import CAPTION_SUBJECT, is_known_phrase, key_of
from mmm_core.language.limbs import is_gesture_verb, limbs_of
from mmm_core.language.one_arm import of_one_arm
from mmm_core.language.reading import command_of, read
from mmm_core.language.requests import without_request
from mmm_core.language.spelling import mended
from mmm_core.language.stop_words import means_stop
from mmm_core.language.tagged_words import BEFORE, BEGINS, INSIDE, THEN, WITH, MarkedCommands, marked_commands, words_of

_JOINS = re.compile(
    r"[,;:.]|\b(?:and|then|while|but|before|after|once (?:you|the|they|it|he|she|i|we|that)|when|as|so|that|if|because|for)\b"
)
"""Marks and words of which a single command seldom has one: more than one command, a reason or a story may be left in it."""
_LIMB_ALONE = re.compile(
    r"^(?:(?:and |with )*(?:your |both |the )?(?:left |right )?(?:hands?|arms?|head|fists?|palms?|shoulders?|elbows?)(?: one)?|"
    r"(?:the |your )?eyes|that)$"
)
_STOPS = re.compile(r"^(?:then )?stop\b(?! sign)")
_IS_OPEN = re.compile(
    r"\b(?:to|as|as if|like|how|that|who|then|an?|the|with|without|of|for|from|and)$|"
    r"^(?:mime|pretend|act|make|do|does|with)\b(?: \w+)?$"
)
_NOUN_FIRST = re.compile(r"(?:an?|one|two|three|\w+) \w+")
_AND = re.compile(r"\band\b ?")
_SIDE_AND_WAY = re.compile(
    r"(?:and |your |the )*(?P<side>left|right|other)(?: one)? "
    r"(?P<way>(?:up|down|out|forwards?|backwards?|back|in|on|at|behind|over|to|by|across|overhead|sideways|straight|high|low)\b.*)"
)
_SIDED_LIMB = re.compile(
    r"(?P<your>\b(?:your|the) )?\b(?P<side>left|right) (?P<limb>hand|arm|fist|palm|elbow|wrist|shoulder|thumb)\b"
)
_IS_CAPTION = re.compile(CAPTION_SUBJECT)
_BESIDE = re.compile(
    r"(?:,? (?:exactly|just|only))* (?:(?:\w+ times?|a single time)(?: in a row)?|once|twice)\b|"
    r"(?: with| using) (?:the|your|their|his|her|its|both) (?:left |right )?(?:arm|hand)s?\b"
)
"""Number of strokes and hand of a command."""
_LONGEST_SURE = 9
"""Words of a command that the rules are sure of, at most."""
_HAND_BEFORE = re.compile(
    r"(?:and )?(?:with )?(?:the |your )?(?:left|right)(?: (?:hand|arm))?,? (?:you(?: are|'re|'ll| will)? )?"
)
_MAY_DENY = re.compile(r"\b(?:not(?! that\W*$)|never|none|nor|neither|without|instead|rather|avoid|no need)\b|n't\b")
"""Words of a denial; tags that mark no denial may have missed it."""
_IS_LEFT_OVER = re.compile(r"(?:,? (?:with|and|while|as|then|but|so))+$")
"""Words at the end of a command that belong to the one after it."""
HowLikely = Callable[[Reading], float]
_LIKELY = 0.75
"""Probability from which words that name no act are taken for a command."""
_DENIES_TWO = re.compile(r"\b(?:or|nor|and no)\b")
_LONGEST_DENIED = 6
"""Words of a denied act, at most, in which no command is sought."""
_COMPARES = re.compile(r"\b(?:as if|as though|like)\b")
_MOST_LEFT_OUT = 4
"""Words that a sentence has beyond those of its command, at most, without being looked at for words of manner."""
_ALL = re.compile(r"^(?:all(?: of (?:it|them|that))?|both|everything|each)\b ?")


def is_sure(reading: Reading) -> bool:
    """Whether the rules divided it rightly in all likelihood.

    Each command is a phrase of the corpus, or is short, begins as a command does, and has no word that joins commands.
    """
    commands = [command.text.lower() for step in reading.steps for command in step]
    if not commands:
        return bool(reading.denied) and all(
            len(what.split()) <= _LONGEST_DENIED or _DENIES_TWO.search(what) for what in reading.denied
        )
    if len(commands) == 1 and _IS_CAPTION.match(commands[0]):
        return True
    return all(is_known_phrase(_BESIDE.sub("", command)) or _is_simple(command) for command in commands)


def needs_tags(reading: Reading) -> bool:
    """Whether the rules are not sure, or the sentence has words that the corpus does not know and that may say a manner.

    Such words are in a command that is no phrase of the corpus, or in a comparison that was left out as not needed.
    """
    commands = [_BESIDE.sub("", command.text.lower()) for step in reading.steps for command in step]
    if len(commands) == 1 and _IS_CAPTION.match(commands[0]):
        return False
    known = all(key_of(command) is None or is_known_phrase(command) for command in commands)
    compares = _COMPARES.search(reading.text) is not None and not any(map(_COMPARES.search, commands))
    return compares or not (known and is_sure(reading))


def leaves_words_out(reading: Reading) -> bool:
    """Whether a sentence of one command has so many other words that some of them may say its manner."""
    said = [command.text for step in reading.steps for command in step]
    return len(said) == 1 and len(reading.text.split()) - len(said[0].split()) > _MOST_LEFT_OUT


def unknown_commands(reading: Reading) -> list[str]:
    """The words of the commands that are no phrases of the corpus, each once; short ones that begin with a gesture's verb are."""
    said = [command.text for step in reading.steps for command in step]
    return [text for text in dict.fromkeys(said) if not _is_known(_BESIDE.sub("", text.lower()))]


def _is_known(command: str) -> bool:
    return is_gesture_verb(command.partition(" ")[0]) if key_of(command) is None else is_known_phrase(command)


def names_acts(reading: Reading) -> bool:
    """Whether each command begins with a verb or names a limb, or is a phrase of the corpus."""
    return all(_stands_alone(command.text.lower()) for step in reading.steps for command in step)


def _is_simple(command: str) -> bool:
    words = command.split()
    if len(words) > _LONGEST_SURE or _JOINS.search(command.rstrip(" .")):
        return False
    begins = begins_with_a_verb(command) or LIMB_FIRST.match(command) is not None
    return begins or (_NOUN_FIRST.match(command) is not None and bool(limbs_of(command)))


def read_with_tags(by_rules: Reading, tags: Sequence[str], how_likely: HowLikely = lambda _: 0.0) -> Reading:
    """The commands of a sentence that the rules are not sure of (`is_sure`).

    Args:
        by_rules: the sentence as the rules read it. It stands where the tags divide the sentence in the same way, mark no command,
            or mark words that are none, unless its commands are unlikely to be gestures and those of the tags likely.
        tags: a tag for each of the sentence's words (`mmm_core.language.tagged_words`).
        how_likely: the least probability with which a command of a reading is a gesture; without it the rules are believed.
    """
    marked = marked_commands(by_rules.text, _without_splits(by_rules.text, tags))
    if not _can_be_read(marked):
        return by_rules
    by_tags = _read_marked(by_rules.text, marked)
    if by_rules.denied and not by_tags.denied:  # what is denied must not be done
        return by_rules
    divides_alike = _shape(by_rules) == _shape(by_tags) and not (by_rules.denied and is_sure(by_tags))
    if names_acts(by_tags) and not divides_alike:
        return by_tags
    if _MAY_DENY.search(by_rules.text.lower()) or by_tags.denied or not _has_words_enough(by_tags):
        return by_rules
    is_better = how_likely(by_rules) < _LIKELY <= how_likely(by_tags)
    return _with_manner_of(by_rules, by_tags) if is_better else by_rules


def _has_words_enough(reading: Reading) -> bool:
    return all(is_known_phrase(text) or " " in text for text in unknown_commands(reading))


def _with_manner_of(by_rules: Reading, by_tags: Reading) -> Reading:
    """The tags' reading, with the manner that the rules found where the only command has none."""
    found = [command.manner for step in by_rules.steps for command in step if not command.manner.plain]
    if len(found) != 1 or _shape(by_tags)[0] != [1] or not by_tags.steps[0][0].manner.plain:
        return by_tags
    return replace(by_tags, steps=((replace(by_tags.steps[0][0], manner=found[0]),),))


def _stands_alone(command: str) -> bool:
    """Whether words are a command: they begin with a verb, or name a limb and more than the limb, and do not say to stop."""
    if means_stop(command) or any(pattern.search(command) for pattern in (_STOPS, _LIMB_ALONE, _IS_OPEN)):
        return False
    return begins_with_a_verb(command) or bool(limbs_of(command)) or is_known_phrase(command)


def begins_with_a_verb(words: str) -> bool:
    """Whether words in lower case begin as a command does."""
    return BEGINS_WITH_A_VERB.match(words) is not None or is_gesture_verb(words.partition(" ")[0])


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
