"""Reads sentences: by rules, and where these do not know every word, with a tagger and a classifier above the text encoder.

The tagger divides the sentence and finds its manner, the classifier tells which gestures its words mean. Both are given a
sentence or its mirror image, whichever names the right first, so that a mirrored sentence is understood as its mirror image.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.own_layers_file import load_classifier, load_tagger
from mmm_core.language.asides import without_asides
from mmm_core.language.commands import Reading
from mmm_core.language.hard_phrases import without_hard_phrases
from mmm_core.language.joined import with_parted_commands
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.plain_gestures import (
    OUTSIDE,
    Meant,
    in_plain_words,
    is_gesture,
    is_lost,
    is_sure_of,
    without_denied_acts,
)
from mmm_core.language.positions import in_said_order
from mmm_core.language.reading import read
from mmm_core.language.said_at_once import said_at_once, without_repeats
from mmm_core.language.spelling import mended
from mmm_core.language.sure_reading import is_sure, leaves_words_out, names_acts, needs_tags, unknown_commands
from mmm_core.language.tagged_manner import manner_phrases, with_left_manner, with_likely_manner, with_plain_manner
from mmm_core.language.tagged_reading import Meanings, read_with_tags
from mmm_core.language.tagged_words import MarkedCommands, likeliest_tags, words_of
from mmm_core.language.word_tables import REMEMBERED
from mmm_core.model.gesture_classifier import GestureClassifier, meant_by, meant_by_parts, meant_by_states
from mmm_core.model.sentence_tagger import SentenceTagger, WordStates, log_probability, pieces_of, word_states
from mmm_core.model.text import MAX_WORD_PIECES, MiniLm, strip_emoji

_FIRST_SENTENCE = "nod, and once you have done that, wave to the people who are waiting"
"""A sentence for the tagger, read when it is loaded: the first one takes several times as long as the others."""


@dataclass(frozen=True)
class _Encoded:
    """A sentence for tagger and classifier.

    Attributes:
        words: states of the sentence's words, or of those of its mirror image, which are the same but for left and right.
        meant: what the sentence most likely asks for.
        is_image: whether the states are those of the mirror image.
    """

    words: WordStates
    meant: Meant
    is_image: bool


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
        if by_rules.text != text or not (needs_tags(by_rules) or leaves_words_out(by_rules)):
            return by_rules
        words = _in_order(strip_emoji(text))
        without_emoji = read(words)
        if not 0 < len(words_of(words)) <= MAX_WORD_PIECES:
            return by_rules
        divides = needs_tags(without_emoji)
        if not divides and not leaves_words_out(by_rules):
            return by_rules
        states = self._states(words)
        if divides:
            found = self._in_plain_words(replace(self._divided(words, without_emoji, states), text=text), states)
        else:
            found = with_left_manner(by_rules, words, manner_phrases(words, self._tagged(states)[1]))
        found = said_at_once(without_repeats(found))
        whole = states.meant
        outside = whole.probability if whole.name == OUTSIDE else 0.0
        return replace(without_denied_acts(with_likely_manner(found, whole.manners), whole), outside=outside)

    def _divided(self, words: str, by_rules: Reading, states: _Encoded) -> Reading:
        """The sentence with its words of manner understood, divided into commands."""
        tags, manners = self._tagged(states)
        phrases = manner_phrases(words, manners)
        divided = self._in_plain_manner(words, by_rules, states, tags, with_plain_manner(words, phrases))
        return with_left_manner(divided, words, phrases) if phrases else divided

    def _in_plain_manner(self, words: str, by_rules: Reading, states: _Encoded, tags: list[str], plain: str) -> Reading:
        """The sentence divided, in its plain manner (`with_plain_manner`) unless that loses an act."""
        if plain != words:
            in_plain, states_of_plain = read(plain), self._states(plain)
            loses_an_act = names_acts(by_rules) and not names_acts(in_plain)
            if not loses_an_act and not is_lost(states.meant, states_of_plain.meant):
                of_plain = self._tagged(states_of_plain)[0]
                return in_plain if is_sure(in_plain) else self._by_tags(in_plain, of_plain, states_of_plain)
        return by_rules if is_sure(by_rules) else self._by_tags(by_rules, tags, states)

    def _by_tags(self, by_rules: Reading, tags: list[str], states: _Encoded) -> Reading:
        return read_with_tags(
            by_rules, tags, Meanings(self._how_likely, partial(self._meant_in_sentence, states), states.meant)
        )

    def _meant_in_sentence(self, states: _Encoded, marked: MarkedCommands) -> list[Meant]:
        parts = pieces_of(states.words, marked.numbers)
        found = [Meant(*one) for one in meant_by_parts(self._classifier, states.words.states, parts)]
        return list(map(_seen_in_mirror, found)) if states.is_image else found

    def _how_likely(self, reading: Reading) -> float:
        """The least probability with which a command of a reading is a gesture; 1 for phrases of the corpus."""
        classes = self._classes(unknown_commands(reading)).values()
        return min((one.probability if is_gesture(one.name) else 0.0 for one in classes), default=1.0)

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
            images = [canonical(text) for text in new]
            found = meant_by(self._classifier, self._encoder, [image for image, _ in images])
            for text, one, (_, mirrored) in zip(new, found, images, strict=True):
                self._classified[text] = _seen_in_mirror(Meant(*one)) if mirrored else Meant(*one)
        return {text: self._classified[text] for text in commands}

    def _states(self, sentence: str) -> _Encoded:
        image, is_image = canonical(sentence)
        if len(words_of(image)) != len(words_of(sentence)):  # tags are of the sentence's own words
            image, is_image = sentence, False
        words = [image[start:end] for start, end in words_of(image)]
        states = word_states(self._encoder, self._tagger.config.n_shared, [words])[0]
        mask = torch.ones(1, len(states.states), dtype=torch.bool)
        meant = Meant(*meant_by_states(self._classifier, states.states[None], mask)[0])
        return _Encoded(states, _seen_in_mirror(meant) if is_image else meant, is_image)

    def _tagged(self, states: _Encoded) -> tuple[list[str], NDArray[np.float32]]:
        """The likeliest tags of a sentence's words, and the (N, 5) log-probabilities of their manners."""
        tags, manners = log_probability(self._tagger, states.words)
        return likeliest_tags(tags.numpy()), manners.numpy()


def _in_order(words: str) -> str:
    """A sentence whose clauses stand in the order in which they are to be done, which the tagger does not know to find."""
    said = mended(words)
    ordered = in_said_order(said)
    return words if ordered == said else ordered


def _seen_in_mirror(meant: Meant) -> Meant:
    return meant._replace(name=mirror_words(meant.name))
