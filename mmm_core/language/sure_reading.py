"""Whether a sentence is read by the rules alone, and which of their readings and commands are sure."""

from __future__ import annotations

import re
from collections import Counter

from mmm_core.language.alternatives import is_for_any_other
from mmm_core.language.clause_patterns import LIMB_FIRST
from mmm_core.language.commands import Reading
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.denial_patterns import ANYTHING_BUT, SOMETHING_ELSE
from mmm_core.language.known_phrases import BESIDE, CAPTION_SUBJECT, is_known_phrase, key_of
from mmm_core.language.limbs import begins_with_a_verb, is_gesture_verb, limbs_of

_JOINS = re.compile(
    r"[,;:.]|\b(?:and|then|while|but|before|after|once (?:you|the|they|it|he|she|i|we|that)|when|as|so|that|if|because|for)\b"
)
"""Marks and words of which a single command seldom has one: more than one command, a reason or a story may be left in it."""
_NOUN_FIRST = re.compile(r"(?:an?|one|two|three|\w+) \w+")
_IS_CAPTION = re.compile(CAPTION_SUBJECT)
_LONGEST_SURE = 9
"""Words of a command that the rules are sure of, at most."""
_DENIES_TWO = re.compile(r"\b(?:or|nor|and no)\b")
_LONGEST_DENIED = 6
"""Words of a denied act, at most, in which no command is sought."""
_MOST_BESIDE_DENIED = 6
"""Words beside the denied acts, at most, in which no command is sought."""
_WORD = re.compile(r"[a-z']+")
_OF_ORDER_OR_DENIAL = frozenset(
    "and after before but do does don't dont finally first have never next not now please then you your the".split()
)
_BEFORE_AND_AFTER = re.compile(r"(?!before\b|after\b)\w+\b.*?(?:\bbefore\b.*\bafter\b|\bafter\b.*\bbefore\b)")
"""An act between two others: "bow before you clap but after you nod", which the networks put last."""
_COMPARES = re.compile(r"\b(?:as if|as though|like)\b")
_MOST_TOLD_TERSELY = 4
"""Words of a sentence of several commands, at most, that the rules read alone: "jab, uppercut"."""
_MOST_LEARNT = 4
"""Commands in turn that the networks learnt to find, at most."""
_MOST_LEFT_OUT = 4
"""Words that a sentence has beyond those of its command, at most, without being looked at for words of manner."""

_DIVIDED_WRONGLY = re.compile(
    r"\b(?:i mean(?:t)?|i said|wait|sorry|oops|scratch that|actually|make that|rather|er|erm|um|uh)\b|"
    r"[,.;:-] ?no\b(?=\W*$|[,.;:!]| (?:wait|sorry|i|not|the|your|to|left|right|make|that|it)\b)|"
    r"\b(?:while|whilst|as you|at the same time|together|before|after|prior|having|until)\b"
)
"""Words of correction, of doing things at once and of order.

Writers who had not seen the rules wrote 1,453 sentences that these read surely. 485 had such a word or things done at once: 42
of these were divided wrongly by the rules alone and rightly with the networks, 5 the other way round. Words of repetition, of both
sides and of denial gained nothing.
"""


def is_sure(reading: Reading) -> bool:
    """Whether the rules divided it rightly in all likelihood.

    Each command is a phrase of the corpus, or is short, begins as a command does, and has no word that joins commands.
    """
    commands = [command.text.lower() for step in reading.steps for command in step]
    if not commands:
        others = len(reading.text.split()) - sum(len(what.split()) for what in reading.denied)
        return bool(reading.denied) and (
            (others <= _MOST_BESIDE_DENIED and all(len(what.split()) <= _LONGEST_DENIED for what in reading.denied))
            or any(map(_DENIES_TWO.search, reading.denied))
        )
    if len(commands) == 1 and _IS_CAPTION.match(commands[0]):
        return True
    return all(is_known_phrase(BESIDE.sub("", command)) or _is_simple(command) for command in commands)


def needs_tags(reading: Reading) -> bool:
    """Whether the rules are not sure, or the sentence has words that they often divide wrongly or that may say a manner.

    A sentence that denies something beside a command needs tags as well, since the command may be only a reason: "no carrying,
    you'll drop it". Of 3,205 sentences by seven writers, networks mend 12 such that the rules read surely, and spoil 3.
    Words that may say a manner are in a command that is no phrase of the corpus, or in a comparison that was left out. The
    networks would leave out some of more than four commands, so the rules alone read such a sentence if they are sure of it,
    and one of several commands that says nothing else.
    """
    commands = [BESIDE.sub("", command.text.lower()) for step in reading.steps for command in step]
    if len(commands) == 1 and _IS_CAPTION.match(commands[0]):
        return False
    if len(reading.steps) > _MOST_LEARNT and is_sure(reading):
        return False
    says_nothing_else = len(reading.steps) > 1 and _says_nothing_else(reading)
    if says_nothing_else and _BEFORE_AND_AFTER.match(reading.text.lower()):
        return False
    if _may_be_divided_wrongly(reading) or (reading.denied and reading.steps and not says_nothing_else):
        return True
    known = len(reading.steps) > _MOST_LEARNT or all(key_of(c) is None or is_known_phrase(c) for c in commands)
    compares = _COMPARES.search(reading.text) is not None and not any(map(_COMPARES.search, commands))
    return compares or not (known and is_sure(reading))


def _says_nothing_else(reading: Reading) -> bool:
    """Whether all words of a sentence are those of its commands, which are sure, of what it denies, of order and of denial.

    The networks left the bow out of "wave, then bow, do not clap, finally nod".
    """
    said = " ".join((reading.words, *reading.denied)).lower()
    left = Counter(map(base_of, _WORD.findall(reading.text.lower())))
    left.subtract(map(base_of, _WORD.findall(said)))
    return is_sure(reading) and all(word in _OF_ORDER_OR_DENIAL for word, n in left.items() if n > 0)


def _may_be_divided_wrongly(reading: Reading) -> bool:
    """Whether a sentence has words of `_DIVIDED_WRONGLY`, commands at once, or different ones in turn in other words.

    A phrase of the corpus is not divided wrongly, and no network changes a sentence that asks for nothing. Of 328 sentences of
    several commands in turn, by 20 writers who had not seen the rules, these read 221 rightly; networks mend 48 and spoil 5 of 254
    that have more than four words and differ, all but 10 and 2 of which have a command that the rules had put in other words.
    """
    if not reading.steps or is_known_phrase(reading.text):
        return False
    text = reading.text.lower()
    commands = [command.text.lower() for step in reading.steps for command in step]
    differ = 1 < len(commands) == len(set(commands)) and len(text.split()) > _MOST_TOLD_TERSELY
    return (
        (differ and len(reading.steps) <= _MOST_LEARNT and any(command not in text for command in commands))
        or _DIVIDED_WRONGLY.search(text) is not None
        or any(len(step) > 1 for step in reading.steps)
    )


def _asks_for_any_other(reading: Reading) -> bool:
    """Whether a sentence asks for any act but a denied one, so that no word of it names the act: "do anything but nod"."""
    text = reading.text.lower()
    said = [command.text for step in reading.steps for command in step]
    is_chosen_freely = len(said) == 1 and is_for_any_other(said[0]) and said[0] not in text
    return bool(reading.denied) and is_chosen_freely and any(p.search(text) for p in (ANYTHING_BUT, SOMETHING_ELSE))


def leaves_words_out(reading: Reading) -> bool:
    """Whether a sentence of one command has so many other words that some of them may say its manner."""
    said = [command.text for step in reading.steps for command in step]
    return len(said) == 1 and len(reading.text.split()) - len(said[0].split()) > _MOST_LEFT_OUT


def needs_networks(reading: Reading) -> bool:
    """Whether a sentence is read with tagger, classifier and parser, not by the rules alone."""
    return not _asks_for_any_other(reading) and (needs_tags(reading) or leaves_words_out(reading))


def unknown_commands(reading: Reading) -> list[str]:
    """The words of the commands that are no phrases of the corpus, each once; short ones that begin with a gesture's verb are."""
    said = [command.text for step in reading.steps for command in step]
    return [text for text in dict.fromkeys(said) if not _is_known(BESIDE.sub("", text.lower()))]


def _is_known(command: str) -> bool:
    return is_gesture_verb(command.partition(" ")[0]) if key_of(command) is None else is_known_phrase(command)


def _is_simple(command: str) -> bool:
    words = command.split()
    if len(words) > _LONGEST_SURE or _JOINS.search(command.rstrip(" .")):
        return False
    begins = begins_with_a_verb(command) or LIMB_FIRST.match(command) is not None
    return begins or (_NOUN_FIRST.match(command) is not None and bool(limbs_of(command)))
