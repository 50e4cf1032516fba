"""Reads sentences: by rules, and where these do not know every word, with a tagger and a classifier above the text encoder.

The tagger divides the sentence and finds its manner, the classifier tells which gestures its words mean. Both are given a
sentence or its mirror image, whichever names the right first, so that a mirrored sentence is understood as its mirror image.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.own_layers_file import load_classifier, load_tagger
from mmm_core.language.asides import without_asides
from mmm_core.language.candidates import Candidate, Ways, chosen, commands_of, in_sentence, merged
from mmm_core.language.commands import Reading
from mmm_core.language.denial import surely_denies
from mmm_core.language.hard_phrases import without_hard_phrases
from mmm_core.language.joined import with_parted_commands
from mmm_core.language.manner_words import likely_manners
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.plain_gestures import (
    OUTSIDE,
    Meant,
    alternates,
    gesture_of,
    in_plain_words,
    is_likely_outside,
    is_sure_of,
    may_deny,
    without_denied_acts,
)
from mmm_core.language.positions import in_said_order
from mmm_core.language.reading import read
from mmm_core.language.said_at_once import said_at_once, without_repeats
from mmm_core.language.spelling import mended
from mmm_core.language.sure_reading import is_sure, leaves_words_out, needs_tags, unknown_commands
from mmm_core.language.tagged_manner import manner_phrases, with_left_manner, with_likely_manner, with_plain_manner
from mmm_core.language.tagged_reading import can_be_read, reading_of, without_splits
from mmm_core.language.tagged_words import MANNERS, MarkedCommands, likely_tags, marked_commands, words_of
from mmm_core.language.word_tables import REMEMBERED
from mmm_core.model.gesture_classifier import GestureClassifier, meant_by, meant_by_parts, meant_by_states
from mmm_core.model.sentence_tagger import SentenceTagger, WordStates, log_probability, pieces_of, word_states
from mmm_core.model.text import MAX_WORD_PIECES, MiniLm, strip_emoji

_DIVISIONS = 8
"""Sequences of tags that are looked at, at most."""
_FIRST_SENTENCE = "nod, and once you have done that, wave to the people who are waiting"
"""A sentence for the tagger, read when it is loaded: the first one takes several times as long as the others."""


@dataclass(frozen=True)
class _Encoded:
    """A sentence for tagger and classifier.

    Attributes:
        words: states of the sentence's words, or of those of its mirror image, which are the same but for left and right.
        meant: what the sentence most likely asks for.
        is_image: whether the states are those of the mirror image.
        tags: (N, 8) log-probabilities of the tags of the sentence's N words.
        manners: (N, 5) log-probabilities of their manners.
    """

    words: WordStates
    meant: Meant
    is_image: bool
    tags: NDArray[np.float32]
    manners: NDArray[np.float32]


class SentenceReader:
    """Reads texts into plain commands.

    Args:
        encoder: the text encoder whose lower layers tagger and classifier use.
        tagger: marks commands and manner.
        classifier: tells which gesture is meant.
    """

    def __init__(self, encoder: MiniLm, tagger: SentenceTagger, classifier: GestureClassifier) -> None:
        self._encoder, self._tagger, self._classifier = encoder, tagger, classifier
        self._classified: dict[str, Meant] = {}

    @classmethod
    def load(cls, encoder: MiniLm | None = None, precision: Packing = "fp32") -> SentenceReader:
        """The reader with the packed tagger and classifier.

        Args:
            encoder: text encoder that is loaded already; the packed one when None.
            precision: of the own layers of tagger and classifier.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        tagger, classifier = load_tagger(), load_classifier()
        pack(tagger, precision)
        pack(classifier, precision)
        reader = cls(encoder or load_text_encoder(), tagger, classifier)
        reader.read(_FIRST_SENTENCE)
        return reader

    def read(self, text: str) -> Reading:
        """The commands of a text."""
        return without_hard_phrases(text, self._read(text))

    def _read(self, text: str) -> Reading:
        by_rules = read(text)
        words = self._words_to_understand(by_rules, text)
        if not words:
            return by_rules
        states = self._states(words)
        if ways := self._ways(text, words, states):
            found = chosen(ways)
        else:
            found = with_left_manner(by_rules, words, manner_phrases(words, states.manners))
            found = said_at_once(without_repeats(found))
        whole = states.meant
        outside = whole.probability if whole.name == OUTSIDE else 0.0
        manners = likely_manners(words, whole.manners, _of_tags(states))
        return replace(without_denied_acts(with_likely_manner(found, manners), whole), outside=outside)

    def manner_evidence(self, text: str) -> tuple[Mapping[str, float], Mapping[str, float]]:
        """The probability of each tempo and size by what a text means as a whole, and the greatest one of any of its words."""
        states = self._states(_in_order(strip_emoji(text)))
        return states.meant.manners, _of_tags(states)

    def ways_to_read(self, text: str) -> Ways | None:
        """The ways to read a text among which one is chosen; None where the rules are sure or no way is known."""
        words = self._words_to_understand(read(text), text)
        return self._ways(text, words, self._states(words)) if words else None

    def _words_to_understand(self, by_rules: Reading, text: str) -> str:
        """The words of a text with which tagger and classifier help; empty where they do not."""
        if by_rules.text != text or not (needs_tags(by_rules) or leaves_words_out(by_rules)):
            return ""
        words = _in_order(strip_emoji(text))
        return words if 0 < len(words_of(words)) <= MAX_WORD_PIECES else ""

    def _ways(self, text: str, words: str, states: _Encoded) -> Ways | None:
        """The ways to read the words of a text, by the rules and by tags, also with its manner in plain words."""
        by_rules = read(words)
        is_denial = not by_rules.steps and surely_denies(words)
        if is_denial or not needs_tags(by_rules) or (not by_rules.denied and is_likely_outside(states.meant)):
            return None
        phrases = manner_phrases(words, states.manners)
        found: list[Candidate] = []
        plain = with_plain_manner(words, phrases)
        if plain != words and 0 < len(words_of(plain)) <= MAX_WORD_PIECES:
            of_plain = self._states(plain, states.meant)
            found += [replace(one, by_rules=False, sure_rules=False) for one in self._candidates(plain, of_plain)]
        found += self._candidates(words, states)
        if by_rules.denied:  # what is denied must not be done
            found = [one for one in found if one.reading.denied]
        if alternates(by_rules):  # tags take the arms of one command for commands
            found = [one for one in found if one.by_rules]
        readings = [replace(one.reading, text=text) for one in found]
        self._classes(list(dict.fromkeys(chain.from_iterable(map(unknown_commands, readings)))))  # all in one pass
        finished = [self._in_plain_words(with_left_manner(one, words, phrases), states) for one in readings]
        candidates = merged(
            replace(one, reading=said_at_once(without_repeats(reading)))
            for one, reading in zip(found, finished, strict=True)
        )
        return Ways(candidates, self._classes(commands_of(candidates)), states.meant)

    def _candidates(self, words: str, states: _Encoded) -> list[Candidate]:
        """The readings of words by the rules and by each likely sequence of tags."""
        divisions: dict[MarkedCommands, float] = {}
        for sequence, log in likely_tags(states.tags, _DIVISIONS):
            marked = marked_commands(words, without_splits(words, sequence))
            if can_be_read(marked) and (may_deny(words) or not marked.denied):
                divisions.setdefault(marked, log)
        meant = self._meant_in_sentence(states, list(divisions))
        best = max(divisions.values(), default=0.0)
        by_rules = read(words)
        found = [Candidate(by_rules, by_rules=True, sure_rules=is_sure(by_rules))]
        for (marked, log), means in zip(divisions.items(), meant, strict=True):
            reading = reading_of(words, marked, means)
            found.append(Candidate(reading, in_sentence=in_sentence(means), log_share=log - best))
        return found

    def _meant_in_sentence(self, states: _Encoded, divisions: Sequence[MarkedCommands]) -> list[list[Meant]]:
        """The gestures that the commands of each division mean in their sentence."""
        numbers = list(dict.fromkeys(chain.from_iterable(marked.numbers for marked in divisions)))
        if not numbers:
            return [[] for _ in divisions]
        parts = pieces_of(states.words, numbers)
        found = [Meant(*one) for one in meant_by_parts(self._classifier, states.words.states, parts)]
        by_numbers = dict(zip(numbers, map(_seen_in_mirror, found) if states.is_image else found, strict=True))
        return [[by_numbers[one] for one in marked.numbers] for marked in divisions]

    def _in_plain_words(self, found: Reading, states: _Encoded) -> Reading:
        """The reading in plain words where it is likely which gestures are meant."""
        unknown = unknown_commands(found)
        if not unknown:
            return found
        whole = states.meant
        if sum(map(len, found.steps)) == 1 and not found.denied and is_sure_of(whole):  # it may name what is denied
            return in_plain_words(found, whole, {unknown[0]: whole})
        by_text = self._classes(unknown)
        parted = with_parted_commands(found, by_text, self._classes)
        if parted is not found:
            return self._in_plain_words(parted, states)
        by_words = {text: one.manners for text, one in by_text.items()}
        return in_plain_words(with_likely_manner(without_asides(found, by_text), {}, by_words), whole, by_text)

    def _classes(self, commands: Sequence[str]) -> dict[str, Meant]:
        """The gesture that each command most likely asks for, with its probability."""
        if new := [text for text in commands if text not in self._classified]:
            if len(self._classified) > REMEMBERED:
                self._classified = {text: self._classified[text] for text in commands if text not in new}
            self._classified |= {text: Meant(gesture, 1.0) for text in new if (gesture := gesture_of(text))}
            if others := [text for text in new if text not in self._classified]:
                self._classify(others)
        return {text: self._classified[text] for text in commands}

    def _classify(self, commands: Sequence[str]) -> None:
        images = [canonical(text) for text in commands]
        found = meant_by(self._classifier, self._encoder, [image for image, _ in images])
        for text, one, (_, mirrored) in zip(commands, found, images, strict=True):
            self._classified[text] = _seen_in_mirror(Meant(*one)) if mirrored else Meant(*one)

    def _states(self, sentence: str, meant: Meant | None = None) -> _Encoded:
        """States of a sentence, which means `meant` if that is given."""
        image, is_image = canonical(sentence)
        if len(words_of(image)) != len(words_of(sentence)):  # tags are of the sentence's own words
            image, is_image = sentence, False
        words = [image[start:end] for start, end in words_of(image)]
        states = word_states(self._encoder, self._tagger.config.n_shared, [words])[0]
        if meant is None:
            mask = torch.ones(1, len(states.states), dtype=torch.bool)
            meant = Meant(*meant_by_states(self._classifier, states.states[None], mask)[0])
            meant = _seen_in_mirror(meant) if is_image else meant
        tags, manners = log_probability(self._tagger, states)
        return _Encoded(states, meant, is_image, tags.numpy(), manners.numpy())


def _of_tags(states: _Encoded) -> dict[str, float]:
    """The greatest probability of each manner among the words of a sentence."""
    return dict(zip(MANNERS, np.exp(states.manners.max(0)).tolist(), strict=True))


def _in_order(words: str) -> str:
    """A sentence whose clauses stand in the order in which they are to be done, which the tagger does not know to find."""
    said = mended(words)
    ordered = in_said_order(said)
    return words if ordered == said else ordered


def _seen_in_mirror(meant: Meant) -> Meant:
    return meant._replace(name=mirror_words(meant.name))
