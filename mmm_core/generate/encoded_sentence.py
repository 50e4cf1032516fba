"""A sentence as the networks above the text encoder see it: tagger, gesture classifier and parser, on one encoding.

Each network runs at most once on a sentence, when its output is first needed. All three are given the sentence or its mirror
image, whichever names the right first, and what they say is mirrored back, so that a mirrored sentence is understood as its mirror
image.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.language.gesture_steps import GestureSteps, in_every_order, mirrored, steps_of, token_ids
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.plain_gestures import Meant
from mmm_core.language.tagged_words import MarkedCommands
from mmm_core.model.gesture_classifier import GestureClassifier, meant_by_parts, meant_by_states, own_states
from mmm_core.model.parsing import likeliest, log_likelihoods, memory_of, number_probabilities
from mmm_core.model.sentence_parser import SentenceParser
from mmm_core.model.sentence_tagger import SentenceTagger, WordStates, log_probability, pieces_of


class Networks(NamedTuple):
    """The networks that read sentences.

    Attributes:
        tagger: marks commands and manner.
        classifier: tells which gesture is meant.
        parser: tells which gestures a sentence asks for, step by step.
    """

    tagger: SentenceTagger
    classifier: GestureClassifier
    parser: SentenceParser


@dataclass(frozen=True, eq=False)
class Encoded:
    """A sentence and what the networks say of it.

    Attributes:
        words: states of the sentence's words, or of those of its mirror image, which are the same but for left and right.
        is_image: whether the states are those of the mirror image.
        networks: the networks that read it.
    """

    words: WordStates
    is_image: bool
    networks: Networks

    @cached_property
    def meant(self) -> Meant:
        """The gesture that the classifier takes the whole sentence for, with its probability, manners and denial."""
        found = Meant(*meant_by_states(self.networks.classifier, *self._classified)[0])
        return seen_in_mirror(found) if self.is_image else found

    @property
    def tags(self) -> NDArray[np.float32]:
        """(N, 8) log-probabilities of the tags of the sentence's N words."""
        return self._tagged[0]

    @property
    def manners(self) -> NDArray[np.float32]:
        """(N, 5) log-probabilities of their manners."""
        return self._tagged[1]

    @cached_property
    def parse(self) -> Parse:
        """The parser's answers and probabilities for the sentence."""
        return Parse(self.networks.parser, self.words, self.is_image)

    def classes(self, divisions: Sequence[MarkedCommands]) -> list[list[Meant]]:
        """The gestures that the commands of each division mean in the sentence."""
        numbers = list(dict.fromkeys(chain.from_iterable(marked.numbers for marked in divisions)))
        if not numbers:
            return [[] for _ in divisions]
        states, _ = self._classified
        found = [
            Meant(*one) for one in meant_by_parts(self.networks.classifier, states, pieces_of(self.words, numbers))
        ]
        seen = map(seen_in_mirror, found) if self.is_image else found
        by_numbers = dict(zip(numbers, seen, strict=True))
        return [[by_numbers[one] for one in marked.numbers] for marked in divisions]

    @cached_property
    def _classified(self) -> tuple[Tensor, Tensor]:
        """The classifier's own states (1, W, D) of the sentence, and their mask (1, W)."""
        mask = torch.ones(1, len(self.words.states), dtype=torch.bool)
        return own_states(self.networks.classifier, self.words.states[None], mask), mask

    @cached_property
    def _tagged(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        tags, manners = log_probability(self.networks.tagger, self.words)
        return tags.numpy(), manners.numpy()


class Parse:
    """Gives the parser's answers for one sentence, and the probability of any answer.

    Args:
        parser: the parser.
        words: states of the words of the sentence or of its mirror image.
        is_image: whether they are those of the mirror image.
    """

    def __init__(self, parser: SentenceParser, words: WordStates, is_image: bool) -> None:
        self._parser, self._first_pieces, self._is_image = parser, words.first_pieces, is_image
        self._memory = memory_of(parser, words.embedded)
        self._logs: dict[GestureSteps, float] = {}

    def likeliest(self, n: int) -> list[GestureSteps]:
        """The likeliest answers, n at most, the likeliest first."""
        found = [steps_of(one.ids) for one in likeliest(self._parser, self._memory, n)]
        return [self._seen(steps) for steps in found if steps is not None]

    def log_likelihoods(self, answers: Sequence[GestureSteps]) -> list[float]:
        """The logarithm of the probability of each answer; of what is done at the same time, in the likeliest order.

        An answer that is longer than any that the parser has learnt from is impossible. Each answer is computed once.
        """
        new = [answer for answer in dict.fromkeys(answers) if answer not in self._logs]
        orders = {answer: self._token_ids(answer) for answer in new}
        fitting = [ids for some in orders.values() for ids in some]
        logs = iter(log_likelihoods(self._parser, self._memory, fitting) if fitting else ())
        self._logs |= {answer: max((next(logs) for _ in some), default=-math.inf) for answer, some in orders.items()}
        return [self._logs[answer] for answer in answers]

    def _token_ids(self, answer: GestureSteps) -> list[list[int]]:
        """The tokens of an answer in every order of what is done at the same time, without those that are too long."""
        ids = [token_ids(one) for one in in_every_order(self._seen(answer))]
        return [one for one in ids if len(one) <= self._parser.config.longest]

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


def seen_in_mirror(meant: Meant) -> Meant:
    """Mirror a meaning: a sentence that means `meant` has a mirror image with the returned meaning."""
    return meant._replace(name=mirror_words(meant.name))
