"""Draws the texts that the gesture classifier learns from, each with what it asks for: a gesture, tempo and size, or nothing."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

import numpy as np

from mmm_core.corpus.denials import MEANT, NOTHING, OTHER, denial_patterns, draw_denial
from mmm_core.corpus.forms import REQUESTS
from mmm_core.corpus.marked_sentences import (
    TaggedSentence,
    asked_in,
    joined,
    load_manner_sentences,
    load_marked_sentences,
)
from mmm_core.corpus.outside import OUTSIDE as OUTSIDE_TEXTS
from mmm_core.corpus.outside import WRITTEN_OUTSIDE, outside_texts
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.corpus.written_phrases import load_written_phrases
from mmm_core.language.inflection import gerund
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, gestures, plain_command
from mmm_core.language.tagged_words import BEGINS, DENIED, NO_MANNER
from mmm_core.language.tagged_words import OUTSIDE as NO_COMMAND
from mmm_core.training.drawn_text import SHARES, Drawn, Shares
from mmm_core.training.slips import slip

SEED = 0
"""Seed of the texts that are built from patterns."""
_SHARE_WRITTEN = 0.5
"""Share of texts in words of the writers; others are phrases of the corpus, or built from patterns where they are no gesture."""
_SHARE_REQUESTED, _SHARE_ENDED, _SHARE_SLIPS, _SHARE_LOWER, _SHARE_PUNCTUATED = 0.12, 0.12, 0.1, 0.12, 0.24
"""Shares of gestures in a request, with a courtesy at the end, with a slip, in lower case, and with capital and full stop."""
_SHARE_SIDED, _SHARE_BEFORE, _SHARE_BEHIND = 0.12, 0.06, 0.16
"""Shares of gestures with a hand named at their end, and of texts with other words before the gesture and behind it."""
_SHARE_GERUND = 0.3
"""Share of joined texts that name their second gesture by a gerund: "bow while clapping"."""
_HALF = 0.5
_N_WORDS_BESIDE = range(2, 10)
"""Numbers of words that may stand beside a gesture."""
_N_OUTSIDE = 8000
_JOINS_GERUND = (" while ", ", ", " and keep ", " with your hands ", " as you go on ")
_JOINS = (" and ", ", then ", " and then ", ", ", " while you ", " after that ", ", and finally ", " but first ")
_ENDS = (" please", " for me", " now", " for us")
_MARKS = (".", "!", "?")
_SIDE = re.compile(r"\b(?:left|right|both|hands|arms)\b")


class Texts:
    """Draws texts of all classes, each gesture equally often.

    Attributes:
        shares: shares of the kinds of texts.
        commands: plain phrases of each gesture that begin with a verb.
    """

    def __init__(self, rng: random.Random, shares: Shares = SHARES) -> None:
        self._rng, self.shares = rng, shares
        self._written = load_written_phrases()
        self._corpus = {gesture: [p for _, p in plain_phrases(*_named(gesture))] for gesture in gestures()}
        self._built = [*OUTSIDE_TEXTS, *outside_texts(_N_OUTSIDE, np.random.default_rng(SEED))]
        marked = load_marked_sentences()
        self._marked = [
            (joined(one.words), not _has_commands(one))
            for one in marked
            if sum(tag in BEGINS for tag in one.tags) > 1 or DENIED in one.tags
        ]
        self._parts = [part for one in marked for part in asked_in(one)]
        self._denials = denial_patterns()
        self.commands = {
            g: [plain_command(g, ""), *filter(_is_imperative, (p.replace(" {n}", "") for p in self._corpus[g]))]
            for g in gestures()
        }
        self._before = [words for one in marked if (words := _outside(one.words, one.tags))]
        self._behind = [words for one in marked if (words := _outside(one.words[::-1], one.tags[::-1], -1))]
        self._in_manner = load_manner_sentences()
        self._manners = [phrase for one in self._in_manner for phrase in _phrases_of_manner(one)]

    def draw(self) -> Drawn:
        """A text with its class and its manners."""
        rng, shares = self._rng, self.shares
        kinds = (self.outside, self._marked_sentence, self._in_some_manner, self._denial, self._part, self._joined)
        drawn = rng.random()
        for kind, share in zip(kinds, shares, strict=False):
            if drawn < share:
                return kind()
            drawn -= share
        return self.gesture()

    def outside(self) -> Drawn:
        """A text that is no gesture."""
        rng = self._rng
        return Drawn(rng.choice(WRITTEN_OUTSIDE if rng.random() < _SHARE_WRITTEN else self._built), OUTSIDE)

    def _in_some_manner(self) -> Drawn:
        one = self._rng.choice(self._in_manner)
        return Drawn(joined(one.words), None, frozenset(one.manners) - {NO_MANNER})

    def _joined(self) -> Drawn:
        one, other = self.gesture(), self.gesture()
        return one if one.name == other.name else _both(one, other, self._rng, self.shares.joined_parts)

    def _part(self) -> Drawn:
        """A command of a marked sentence."""
        rng = self._rng
        sentence, name, part = rng.choice(self._parts)
        return Drawn(sentence.lower() if rng.random() < _SHARE_LOWER else sentence, name, part=part)

    def _marked_sentence(self) -> Drawn:
        said, is_denied = self._rng.choice(self._marked)
        return Drawn(said, SEVERAL, None, is_denied)

    def _denial(self) -> Drawn:
        """A sentence with a negative word, or one of its gestures; what is denied is no gesture that is asked for.

        Where the sentence denies none of two gestures, its class is that of the one.
        """
        rng = self._rng
        gesture, other = rng.sample(gestures(), 2)
        said, kind, slots = draw_denial(
            rng, self._denials, rng.choice(self.commands[gesture]), rng.choice(self.commands[other])
        )
        if rng.random() < _SHARE_LOWER:
            said = said.lower()
        if slots and rng.random() < _HALF:
            slot = rng.choice(slots)
            is_asked = kind == MEANT or (kind == OTHER and slot.is_other)
            name = (other if slot.is_other else gesture) if is_asked else OUTSIDE
            return Drawn(said, name, None, kind == NOTHING, (slot.start, slot.end))
        return Drawn(said, gesture if kind == MEANT else SEVERAL, None, kind == NOTHING)

    def gesture(self) -> Drawn:
        """A phrase of a gesture, all gestures equally often."""
        rng = self._rng
        gesture = rng.choice(gestures())
        written = self._written.get(gesture, ())
        said = rng.choice(written if written and rng.random() < _SHARE_WRITTEN else self._corpus[gesture])
        said = said.replace("{S}", rng.choice(("left", "right"))).replace("{D}", _named(gesture)[1])
        said = said.replace("{N}", rng.choice(("two", "three", "four")))
        said = " ".join(said.replace("{n}", rng.choice(("", "", "twice", "three times"))).split())
        said, manners = self._beside(self._sided(said, gesture))
        share = rng.random()
        if share < _SHARE_REQUESTED:
            said = rng.choice(REQUESTS).replace("{v}", said)
        elif share < _SHARE_REQUESTED + _SHARE_ENDED:
            said += rng.choice(_ENDS)
        if rng.random() < _SHARE_SLIPS:
            words = said.split()
            i = rng.randrange(len(words))
            words[i] = slip(words[i], rng)
            said = " ".join(words)
        share = rng.random()
        if share < _SHARE_LOWER:
            said = said.lower()
        elif share < _SHARE_LOWER + _SHARE_PUNCTUATED:
            said = said[0].upper() + said[1:] + rng.choice(_MARKS)
        return Drawn(said, gesture, manners, is_denied=False)

    def _sided(self, said: str, gesture: str) -> str:
        """A phrase, or now and then the phrase with a hand behind it, if the gesture has one and the phrase names no side."""
        if self._rng.random() >= _SHARE_SIDED or not plain_command(gesture, "your left hand") or _SIDE.search(said):
            return said
        return f"{said.rstrip('.!?')} with your {self._rng.choice(('left', 'right'))} hand"

    def _beside(self, said: str) -> tuple[str, frozenset[str]]:
        """A phrase, or now and then the phrase with a reason, an address or a manner beside it; and its manners."""
        rng = self._rng
        if rng.random() < _SHARE_BEFORE:
            said = f"{rng.choice(self._before)} {said[0].lower()}{said[1:]}"
        share = rng.random()
        if share >= _SHARE_BEHIND:
            return said, frozenset()
        behind, manner = rng.choice(self._manners) if share < _SHARE_BEHIND / 2 else (rng.choice(self._behind), "")
        said = f"{said.rstrip('.!?')}{'' if behind[0] in ',.;:!?' else ' '}{behind}"
        return said, frozenset({manner} - {""})


def _has_commands(one: TaggedSentence) -> bool:
    return any(tag in BEGINS for tag in one.tags)


def _is_imperative(phrase: str) -> bool:
    """Whether a phrase of the corpus begins with a gesture's verb and has no slot."""
    return "{" not in phrase and is_gesture_verb(phrase.partition(" ")[0])


def _outside(words: Sequence[str], tags: Sequence[str], step: int = 1) -> str:
    """The words outside commands that a sentence begins with; empty if these are few or many. With step -1 all is reversed."""
    n = next((i for i, tag in enumerate(tags) if tag != NO_COMMAND), 0)
    said = joined(words[:n][::step])
    return said if n in _N_WORDS_BESIDE and '"' not in said else ""


def _phrases_of_manner(one: TaggedSentence) -> list[tuple[str, str]]:
    """The words of each manner of a sentence, with the manner, unless these are few or many."""
    phrases = {
        manner: [word for word, of in zip(one.words, one.manners, strict=True) if of == manner]
        for manner in sorted({*one.manners} - {NO_MANNER})
    }
    return [(joined(words), manner) for manner, words in phrases.items() if len(words) in _N_WORDS_BESIDE]


def _both(one: Drawn, other: Drawn, rng: random.Random, share_of_parts: float) -> Drawn:
    """Two gestures joined to one text: several gestures, or a part of the text with its gesture."""
    first, second = one.text.rstrip("".join(_MARKS)), other.text[0].lower() + other.text[1:]
    if rng.random() < _SHARE_GERUND and second.partition(" ")[0].isalpha():
        join, second = rng.choice(_JOINS_GERUND), gerund(second, None)
    else:
        join = rng.choice(_JOINS)
    said = first + join + second
    if rng.random() >= share_of_parts:
        return Drawn(said, SEVERAL, None, is_denied=False)
    if rng.random() < _HALF:
        return Drawn(said, one.name, None, is_denied=False, part=(0, len(first)))
    return Drawn(said, other.name, None, is_denied=False, part=(len(said) - len(second), len(said)))


def _named(gesture: str) -> tuple[str, str]:
    """Family and direction of a gesture."""
    family, _, direction = gesture.partition("/")
    return family, direction
