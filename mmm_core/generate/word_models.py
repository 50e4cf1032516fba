"""Runs the networks above the text encoder, tagger, gesture classifier and parser, on one encoding of a sentence.

All three are given a sentence or its mirror image, whichever names the right first, and what they say is mirrored back, so that a
mirrored sentence is understood as its mirror image.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
import torch
from numpy.typing import NDArray

from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.onednn_linear import Packing, pack
from mmm_core.inference.own_layers_file import PARSER_FILE, load_classifier, load_parser, load_tagger
from mmm_core.language.gesture_steps import GestureSteps, in_every_order, mirrored, steps_of, token_ids, tokens
from mmm_core.language.mirroring import canonical, mirror_words
from mmm_core.language.plain_gestures import Meant, gesture_of
from mmm_core.language.tagged_words import MarkedCommands, words_of
from mmm_core.language.word_tables import REMEMBERED
from mmm_core.model.gesture_classifier import GestureClassifier, meant_by, meant_by_parts, meant_by_states
from mmm_core.model.parsing import likeliest, log_likelihoods, memory_of, number_probabilities
from mmm_core.model.sentence_parser import SentenceParser
from mmm_core.model.sentence_tagger import SentenceTagger, WordStates, log_probability, pieces_of, word_states
from mmm_core.model.text import MiniLm


@dataclass(frozen=True)
class Encoded:
    """A sentence as the networks see it.

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


class WordModels:
    """The networks that read sentences.

    Args:
        encoder: the text encoder whose lower layers they use.
        tagger: marks commands and manner.
        classifier: tells which gesture is meant.
        parser: tells which gestures a sentence asks for, step by step.
    """

    def __init__(
        self, encoder: MiniLm, tagger: SentenceTagger, classifier: GestureClassifier, parser: SentenceParser
    ) -> None:
        self._encoder, self._tagger, self._classifier, self._parser = encoder, tagger, classifier, parser
        self._classified: dict[str, Meant] = {}

    @classmethod
    def load(cls, encoder: MiniLm | None = None, precision: Packing = "fp32") -> WordModels:
        """The packed networks.

        Args:
            encoder: text encoder that is loaded already; the packed one when None.
            precision: of their own layers.

        Raises:
            CheckpointError: a file is missing or does not fit.
        """
        tagger, classifier, parser = load_tagger(), load_classifier(), load_parser()
        if parser.config.tokens != tokens():
            raise CheckpointError(
                PARSER_FILE,
                "tokens",
                "other gestures",
                "those of plain_gestures.txt; make a new one: mmmd train parser",
            )
        for one in (tagger, classifier, parser):
            pack(one, precision)
        return cls(encoder or load_text_encoder(), tagger, classifier, parser)

    def encode(self, sentence: str, meant: Meant | None = None) -> Encoded:
        """A sentence with its tags and manners; it means `meant` if that is given."""
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
        return Encoded(states, meant, is_image, tags.numpy(), manners.numpy())

    def parse(self, sentence: Encoded) -> Parse:
        """The parser's answers and probabilities for a sentence."""
        return Parse(self._parser, sentence)

    def classes(self, commands: Sequence[str]) -> dict[str, Meant]:
        """The gesture that each command most likely asks for by itself, with its probability."""
        if new := [text for text in commands if text not in self._classified]:
            if len(self._classified) > REMEMBERED:
                self._classified = {text: self._classified[text] for text in commands if text not in new}
            self._classified |= {text: Meant(gesture, 1.0) for text in new if (gesture := gesture_of(text))}
            if others := [text for text in new if text not in self._classified]:
                self._classify(others)
        return {text: self._classified[text] for text in commands}

    def classes_in_sentence(self, sentence: Encoded, divisions: Sequence[MarkedCommands]) -> list[list[Meant]]:
        """The gestures that the commands of each division mean in their sentence."""
        numbers = list(dict.fromkeys(chain.from_iterable(marked.numbers for marked in divisions)))
        if not numbers:
            return [[] for _ in divisions]
        parts = pieces_of(sentence.words, numbers)
        found = [Meant(*one) for one in meant_by_parts(self._classifier, sentence.words.states, parts)]
        seen = map(_seen_in_mirror, found) if sentence.is_image else found
        by_numbers = dict(zip(numbers, seen, strict=True))
        return [[by_numbers[one] for one in marked.numbers] for marked in divisions]

    def _classify(self, commands: Sequence[str]) -> None:
        images = [canonical(text) for text in commands]
        found = meant_by(self._classifier, self._encoder, [image for image, _ in images])
        for text, one, (_, is_image) in zip(commands, found, images, strict=True):
            self._classified[text] = _seen_in_mirror(Meant(*one)) if is_image else Meant(*one)


class Parse:
    """Gives the parser's answers for one sentence, and the probability of any answer.

    Args:
        parser: the parser.
        sentence: the sentence.
    """

    def __init__(self, parser: SentenceParser, sentence: Encoded) -> None:
        self._parser, self._is_image, self._first_pieces = parser, sentence.is_image, sentence.words.first_pieces
        self._memory = memory_of(parser, sentence.words.states)

    def likeliest(self, n: int) -> list[GestureSteps]:
        """The likeliest answers, n at most, the likeliest first."""
        found = [steps_of(one.ids) for one in likeliest(self._parser, self._memory, n)]
        return [self._seen(steps) for steps in found if steps is not None]

    def log_likelihoods(self, answers: Sequence[GestureSteps]) -> list[float]:
        """The logarithm of the probability of each answer; of what is done at the same time, in the likeliest order.

        An answer that is longer than any that the parser has learnt from is impossible.
        """
        orders = [[token_ids(one) for one in in_every_order(self._seen(answer))] for answer in answers]
        fitting = [ids for some in orders for ids in some if len(ids) <= self._parser.config.longest]
        logs = iter(log_likelihoods(self._parser, self._memory, fitting) if fitting else ())
        return [
            max((next(logs) for ids in some if len(ids) <= self._parser.config.longest), default=-math.inf)
            for some in orders
        ]

    def number_probabilities(self, places: Sequence[int], answer: GestureSteps) -> NDArray[np.float32] | None:
        """(N, K) probabilities that the words at N places say how often each of the K gestures of an answer is to be done.

        None for an answer that is longer than any that the parser has learnt from.
        """
        ids = token_ids(self._seen(answer))
        if len(ids) > self._parser.config.longest:
            return None
        pieces = self._first_pieces[list(places)].tolist()
        return number_probabilities(self._parser, self._memory, pieces, ids).numpy()

    def _seen(self, steps: GestureSteps) -> GestureSteps:
        return mirrored(steps) if self._is_image else steps


def _seen_in_mirror(meant: Meant) -> Meant:
    return meant._replace(name=mirror_words(meant.name))
