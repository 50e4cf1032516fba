"""Trains the gesture classifier on the corpus's phrases and those of writers, beside texts that are no gesture or several."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.corpus.forms import REQUESTS
from mmm_core.corpus.marked_sentences import load_marked_sentences
from mmm_core.corpus.outside import OUTSIDE as OUTSIDE_TEXTS
from mmm_core.corpus.outside import outside_texts
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.corpus.written_phrases import load_written_phrases
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.own_layers_file import save_classifier
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, gestures
from mmm_core.language.tagged_words import BEGINS, DENIED
from mmm_core.model.gesture_classifier import ClassifierConfig, GestureClassifier
from mmm_core.model.text import MiniLm
from mmm_core.training.own_layers import Rates, copy_layers, fit
from mmm_core.training.slips import slip

STEPS, BATCH, TOGETHER = 2000, 64, 8
"""Optimisation steps, texts of a batch, and batches that are drawn together, so that each holds texts of similar length."""
RATES = Rates(layers=2e-4, linear=2e-3, warm_up=50)
DROPOUT, SMOOTHING = 0.1, 0.05
SEED = 0
_SHARE_OUTSIDE, _SHARE_MARKED, _SHARE_JOINED = 0.14, 0.12, 0.06
"""Shares of texts that are no gesture, that are marked sentences of several commands, and that are joined from two gestures."""
_SHARE_WRITTEN = 0.5
"""Share of gestures in phrases of the writers; the others are in phrases of the corpus."""
_SHARE_REQUESTED, _SHARE_ENDED, _SHARE_SLIPS, _SHARE_LOWER, _SHARE_PUNCTUATED = 0.12, 0.12, 0.1, 0.12, 0.24
"""Shares of gestures in a request, with a courtesy at the end, with a slip, in lower case, and with capital and full stop."""
_N_OUTSIDE = 8000
_JOINS = (" and ", ", then ", " and then ", ", ", " while you ", " after that ", ", and finally ", " but first ")
_ENDS = (" please", " for me", " now", " for us")
_MARKS = (".", "!", "?")
_BEFORE_MARK = re.compile(r" (?=[,.;:!?])")

Draw = Callable[[], tuple[str, str]]


def train_classifier(
    out: Path, draw: Draw | None = None, *, classes: Sequence[str] = (), steps: int = STEPS
) -> GestureClassifier:
    """Train a classifier and write it; equal arguments give equal weights on one machine.

    Args:
        out: file of the classifier.
        draw: draws a text and its class; phrases of all gestures and other texts when None.
        classes: all classes that `draw` gives.
        steps: optimisation steps.
    """
    encoder = load_text_encoder()
    if draw is None:
        draw, classes = Texts(random.Random(SEED)).draw, (*gestures(), OUTSIDE, SEVERAL)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        classifier = GestureClassifier(ClassifierConfig(tuple(classes)), encoder.config)
        copy_layers(classifier.layers, encoder, classifier.config.n_shared)
        batches = _batches(draw)
        fit(classifier, classifier.layers, lambda _step: _loss(classifier, encoder, next(batches)), RATES, steps)
    save_classifier(out, classifier)
    return classifier


def _loss(classifier: GestureClassifier, encoder: MiniLm, batch: Sequence[tuple[str, str]]) -> Tensor:
    texts, names = zip(*batch, strict=True)
    ids, mask = encoder.piece_ids(list(texts))
    with torch.no_grad():
        states = encoder.lower_states(ids, mask, classifier.config.n_shared)
    classes = torch.tensor([classifier.config.classes.index(name) for name in names])
    return F.cross_entropy(classifier(states, mask, DROPOUT), classes, label_smoothing=SMOOTHING)


def _batches(draw: Draw) -> Iterator[list[tuple[str, str]]]:
    rng = random.Random(SEED)
    while True:
        drawn = sorted((draw() for _ in range(TOGETHER * BATCH)), key=lambda one: len(one[0]))
        batches = [drawn[at : at + BATCH] for at in range(0, len(drawn), BATCH)]
        rng.shuffle(batches)
        yield from batches


class Texts:
    """Draws texts of all classes, each gesture equally often."""

    def __init__(self, rng: random.Random) -> None:
        self._rng = rng
        self._written = load_written_phrases()
        self._corpus = {gesture: [p for _, p in plain_phrases(*_named(gesture))] for gesture in gestures()}
        self._outside = [*OUTSIDE_TEXTS, *outside_texts(_N_OUTSIDE, np.random.default_rng(SEED))]
        self._marked = [
            _BEFORE_MARK.sub("", " ".join(one.words))
            for one in load_marked_sentences()
            if sum(tag in BEGINS for tag in one.tags) > 1 or DENIED in one.tags
        ]

    def draw(self) -> tuple[str, str]:
        """A text and its class."""
        rng, share = self._rng, self._rng.random()
        if share < _SHARE_OUTSIDE:
            return rng.choice(self._outside), OUTSIDE
        if share < _SHARE_OUTSIDE + _SHARE_MARKED:
            return rng.choice(self._marked), SEVERAL
        said, gesture = self._gesture()
        if share > 1 - _SHARE_JOINED:
            other, another = self._gesture()
            if another != gesture:
                return said.rstrip("".join(_MARKS)) + rng.choice(_JOINS) + other[0].lower() + other[1:], SEVERAL
        return said, gesture

    def _gesture(self) -> tuple[str, str]:
        rng = self._rng
        gesture = rng.choice(gestures())
        written = self._written.get(gesture, ())
        said = rng.choice(written if written and rng.random() < _SHARE_WRITTEN else self._corpus[gesture])
        said = said.replace("{S}", rng.choice(("left", "right"))).replace("{D}", _named(gesture)[1])
        said = said.replace("{N}", rng.choice(("two", "three", "four")))
        said = " ".join(said.replace("{n}", rng.choice(("", "", "twice", "three times"))).split())
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
        return said, gesture


def _named(gesture: str) -> tuple[str, str]:
    """Family and direction of a gesture."""
    family, _, direction = gesture.partition("/")
    return family, direction
