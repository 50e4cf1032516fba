"""Reads sentences: by rules, and where these do not know every word, with a tagger and a classifier above the text encoder.

The tagger divides the sentence and finds its manner, the classifier tells which gestures its words mean. Both are given a
sentence or its mirror image, whichever names the right first, so that a mirrored sentence is understood as its mirror image.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.own_layers_file import load_classifier, load_tagger
from mmm_core.language.commands import Reading
from mmm_core.language.hard_phrases import without_hard_phrases
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.plain_gestures import Meant, in_plain_words, is_gesture, is_lost, is_sure_of
from mmm_core.language.reading import read
from mmm_core.language.tagged_manner import manner_phrases, with_left_manner, with_plain_manner
from mmm_core.language.tagged_reading import (
    is_sure,
    leaves_words_out,
    names_acts,
    needs_tags,
    read_with_tags,
    unknown_commands,
    without_asides,
)
from mmm_core.language.tagged_words import likeliest_tags, words_of
from mmm_core.model.gesture_classifier import GestureClassifier, likeliest, likeliest_of_states
from mmm_core.model.sentence_tagger import SentenceTagger, WordStates, log_probability, word_states
from mmm_core.model.text import MAX_WORD_PIECES, MiniLm, strip_emoji

_FIRST_SENTENCE = "nod, and once you have done that, wave to the people who are waiting"
"""A sentence for the tagger, read when it is loaded: the first one takes several times as long as the others."""


@dataclass(frozen=True)
class _Encoded:
    """States of a sentence, or of its mirror image if `is_image`; the image has the same words but for left and right."""

    words: WordStates
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
        words = strip_emoji(text)
        without_emoji = read(words)
        if not 0 < len(words_of(words)) <= MAX_WORD_PIECES:
            return by_rules
        if not needs_tags(without_emoji):
            return self._with_manner_of_other_words(words, by_rules)
        states = self._states(words)
        found = replace(self._divided(words, without_emoji, states), text=text)
        return self._in_plain_words(found, states)

    def _with_manner_of_other_words(self, words: str, by_rules: Reading) -> Reading:
        """The reading of rules that are sure, with a manner that they left out as words that are not needed."""
        if not leaves_words_out(by_rules):
            return by_rules
        phrases = manner_phrases(words, self._tagged(self._states(words))[1])
        return with_left_manner(by_rules, words, phrases)

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
            if not loses_an_act and not is_lost(self._meant(states), self._meant(states_of_plain)):
                return in_plain if is_sure(in_plain) else read_with_tags(in_plain, self._tagged(states_of_plain)[0])
        return by_rules if is_sure(by_rules) else read_with_tags(by_rules, tags)

    def _in_plain_words(self, found: Reading, states: _Encoded) -> Reading:
        """The reading in plain words where it is likely which gestures are meant."""
        unknown = unknown_commands(found)
        if not unknown:
            return found
        whole = self._meant(states)
        if sum(map(len, found.steps)) == 1 and not found.denied and is_sure_of(whole):  # it may name what is denied
            return in_plain_words(found, whole, {unknown[0]: whole})
        images = [canonical(text) for text in unknown]
        classes = likeliest(self._classifier, self._encoder, [image for image, _ in images])
        meant = [
            _seen_in_mirror(what) if mirrored else what for what, (_, mirrored) in zip(classes, images, strict=True)
        ]
        by_text = dict(zip(unknown, meant, strict=True))
        acts = {text: probability if is_gesture(name) else 0.0 for text, (name, probability) in by_text.items()}
        return in_plain_words(without_asides(found, acts), whole, by_text)

    def _meant(self, states: _Encoded) -> Meant:
        """The gesture that a sentence most likely asks for, with its probability."""
        words = states.words.states
        mask = torch.ones(1, len(words), dtype=torch.bool)
        (meant,) = likeliest_of_states(self._classifier, words[None], mask)
        return _seen_in_mirror(meant) if states.is_image else meant

    def _states(self, sentence: str) -> _Encoded:
        image, is_image = canonical(sentence)
        if len(words_of(image)) != len(words_of(sentence)):  # tags are of the sentence's own words
            image, is_image = sentence, False
        words = [image[start:end] for start, end in words_of(image)]
        return _Encoded(word_states(self._encoder, self._tagger.config.n_shared, [words])[0], is_image)

    def _tagged(self, states: _Encoded) -> tuple[list[str], NDArray[np.float32]]:
        """The likeliest tags of a sentence's words, and the (N, 5) log-probabilities of their manners."""
        tags, manners = log_probability(self._tagger, states.words)
        return likeliest_tags(tags.numpy()), manners.numpy()


def _seen_in_mirror(meant: Meant) -> Meant:
    return mirror_words(meant[0]), meant[1]
