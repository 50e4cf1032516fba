"""Draws the sentences that the sentence parser learns from, each with the gestures that it asks for, step by step."""

from __future__ import annotations

import random
import re
from itertools import chain
from typing import NamedTuple

from mmm_core.corpus.denials import MEANT, NOTHING, denial_patterns, draw_denial
from mmm_core.corpus.labelled_sentences import LabelledSentence, load_labelled_sentences
from mmm_core.corpus.marked_sentences import TaggedSentence, joined, load_marked_sentences
from mmm_core.language.count_words import count_asked
from mmm_core.language.gesture_steps import NO_GESTURE, ArmGesture, arm_of, is_all_gestures
from mmm_core.language.inflection import gerund
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.number_words import number_words
from mmm_core.language.plain_gestures import gestures, may_deny, plain_command
from mmm_core.language.tagged_words import AGAIN, BEGINS, DENIED, FOR_ALL, INSIDE, marked_commands
from mmm_core.training.gesture_texts import Texts
from mmm_core.training.slips import slip

_SHARE_WITHOUT_MARKS, _SHARE_WITH_SLIPS, _SHARE_LOWER = 0.2, 0.2, 0.25
"""Shares of sentences as a recogniser hears them, with a slip, and in lower case."""
_SHARE_OF_CORPUS, _SHARE_SIDED = 0.6, 0.3
"""Shares of gestures put into marked sentences in a phrase of the corpus instead of the plain command, and with a hand."""
_MARKS = (
    ", ", ", ", "; ", " then ", ", then ", ". ", " and then ", " and ", ", and ", " after that ", ", and finally ", "! ",
)  # fmt: skip
"""Marks and words that join two gestures."""
_SHARE_ONE_MARK, _SHARE_SHORT = 0.5, 0.4
"""Share of sentences whose gestures are all joined by the same mark, and of gestures in them that a writer's sentence asks for."""
_LONGEST_PART = 7
"""Words of such a sentence, at most."""
_HOLDS_MORE = frozenset({AGAIN, FOR_ALL, DENIED})
"""Tags of words that belong to more than one command, or to none: other gestures would not fit beside them."""
_ORDERS = re.compile(r"\b(?:first|second|last|then|before|after|again|other|same)\b", re.IGNORECASE)
_SHORTEST_GERUND = 6
"""Letters of a gerund, at least: "bring" is none."""


_NEWEST = ("writers_90_to_96.txt",)
"""Files of labelled sentences that the shipped parser learnt last: seven writers, nine in ten of whose sentences deny something."""


class Shares(NamedTuple):
    """Shares of the kinds of sentences that are drawn; all others are single gestures.

    Attributes:
        labelled: sentences of writers.
        newest: those of `_NEWEST`, beside their part of the sentences of all writers.
        refilled: marked sentences with other gestures in the place of theirs.
        denial: sentences with a negative word.
        joined: two to four gestures, one after another.
        outside: texts that are no gesture.
    """

    labelled: float = 0.5
    newest: float = 0.0
    refilled: float = 0.15
    denial: float = 0.05
    joined: float = 0.07
    outside: float = 0.05


class ParserTexts:
    """Draws sentences of all kinds.

    Args:
        rng: its random numbers.
        shares: how often each kind is drawn.
    """

    def __init__(self, rng: random.Random, shares: Shares | None = None) -> None:
        self._rng, self._texts, self._shares = rng, Texts(rng), shares or Shares()
        self._labelled = load_labelled_sentences()
        self._newest = [one for name in _NEWEST for one in load_labelled_sentences(files=name)]
        self._short = [one for one in self._labelled if _is_short(one)]
        self._patterns = [(one, places) for one in load_marked_sentences() if (places := _places(one))]
        self._denials = denial_patterns()

    def draw(self) -> LabelledSentence:
        """A sentence with what it asks for."""
        rng = self._rng
        kinds = (
            self._labelled_sentence,
            self._newest_sentence,
            self.refilled,
            self._denial,
            self._joined,
            self._outside,
        )
        drawn = rng.random()
        for kind, share in zip(kinds, self._shares, strict=True):
            if drawn < share:
                return kind()
            drawn -= share
        return self._gesture()

    def _labelled_sentence(self) -> LabelledSentence:
        return self._spoilt(self._rng.choice(self._labelled))

    def _newest_sentence(self) -> LabelledSentence:
        return self._spoilt(self._rng.choice(self._newest))

    def _outside(self) -> LabelledSentence:
        """A text that is no gesture."""
        return LabelledSentence(self._texts.outside().text, NO_GESTURE)

    def _gesture(self) -> LabelledSentence:
        """A phrase of a gesture."""
        drawn = self._texts.gesture()
        name = drawn.name
        assert name, "a phrase of a gesture names it"
        steps = ((ArmGesture(arm_of(drawn.text, name), name),),)
        count = count_asked(drawn.text)
        is_known = count is not None or not number_words(drawn.text.split())
        return LabelledSentence(drawn.text, steps, counts=(count,) if is_known else None)

    def _joined(self) -> LabelledSentence:
        """Two to four gestures, one after another, between marks."""
        rng = self._rng
        parts = [self._part() for _ in range(rng.choice((2, 2, 3, 3, 4)))]
        said = parts[0].text.rstrip(".!?")
        marks = (rng.choice(_MARKS),) if rng.random() < _SHARE_ONE_MARK else _MARKS
        for part in parts[1:]:
            said += rng.choice(marks) + part.text.rstrip(".!?")
        known = [one.counts for one in parts if one.counts is not None]
        counts = tuple(chain.from_iterable(known)) if len(known) == len(parts) else None
        return self._spoilt(LabelledSentence(said, tuple(one.steps[0] for one in parts), counts=counts))

    def _part(self) -> LabelledSentence:
        """A gesture among several: a phrase, or a writer's short sentence for one gesture."""
        return self._rng.choice(self._short) if self._rng.random() < _SHARE_SHORT else self._gesture()

    def _denial(self) -> LabelledSentence:
        """A sentence with a negative word, which asks for nothing, for another gesture, or for the gesture nevertheless."""
        rng = self._rng
        gesture, other = rng.sample(gestures(), 2)
        commands = [rng.choice(self._texts.commands[name]) for name in (gesture, other)]
        said, kind, slots = draw_denial(rng, self._denials, *commands)
        asked = [] if kind == NOTHING else [(commands[0], gesture)] if kind == MEANT else [(commands[1], other)]
        if kind == MEANT and any(slot.is_other for slot in slots):  # which of both is asked for first, nobody has said
            return self._gesture()
        return self._spoilt(LabelledSentence(said, tuple((ArmGesture(arm_of(c, g), g),) for c, g in asked)))

    def refilled(self) -> LabelledSentence:
        """A marked sentence with other gestures in the place of its commands."""
        rng = self._rng
        one, places = rng.choice(self._patterns)
        words = list(one.words)
        put: dict[int, ArmGesture] = {}
        for start, end, is_gerund in places:
            gesture = rng.choice(gestures())
            said = (
                rng.choice(self._texts.commands[gesture])
                if rng.random() < _SHARE_OF_CORPUS
                else plain_command(gesture, "")
            )
            if rng.random() < _SHARE_SIDED:
                side = rng.choice(("left", "right"))
                said = plain_command(gesture, f"{side} hand") or said
            put[start] = ArmGesture(arm_of(said, gesture), gesture)
            words[start:end] = [gerund(said, None) if is_gerund else said] + [""] * (end - start - 1)
        marked = marked_commands(" ".join(f"w{i}" for i in range(len(one.tags))), one.tags)  # only the order matters
        numbers = iter(marked.numbers)
        steps = tuple(tuple(put[next(numbers)[0]] for _ in step) for step in marked.steps)
        return self._spoilt(LabelledSentence(joined([word for word in words if word]), steps))

    def _spoilt(self, one: LabelledSentence) -> LabelledSentence:
        """A sentence as people type or a recogniser hears it."""
        rng, text = self._rng, one.text
        if rng.random() < _SHARE_WITHOUT_MARKS:
            text = " ".join(re.sub(r"[^\w\s'-]", " ", text).split()).lower() or text
        elif rng.random() < _SHARE_LOWER:
            text = text.lower()
        if rng.random() < _SHARE_WITH_SLIPS:
            words = text.split(" ")
            i = rng.randrange(len(words))
            words[i] = slip(words[i], rng)
            text = " ".join(words)
        return one._replace(text=text)


def _is_short(one: LabelledSentence) -> bool:
    """Whether a sentence asks for one gesture in a few words, none of which denies or orders anything."""
    is_one = [len(step) for step in one.steps] == [1] and is_all_gestures(one.steps)
    return (
        is_one
        and len(one.text.split()) <= _LONGEST_PART
        and not may_deny(one.text)
        and _ORDERS.search(one.text) is None
    )


def _places(one: TaggedSentence) -> list[tuple[int, int, bool]]:
    """First word and end of each command, and whether it begins with a gerund; none if one of them begins with anything else."""
    if not _HOLDS_MORE.isdisjoint(one.tags):
        return []
    found: list[tuple[int, int, bool]] = []
    for i, tag in enumerate(one.tags):
        if tag in BEGINS:
            end = next((k for k in range(i + 1, len(one.tags)) if one.tags[k] != INSIDE), len(one.tags))
            word = one.words[i].lower()
            is_gerund = word.endswith("ing") and len(word) >= _SHORTEST_GERUND
            if not is_gerund and not is_gesture_verb(word):
                return []
            found.append((i, end, is_gerund))
    return found
