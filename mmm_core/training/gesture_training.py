"""Trains the gesture classifier on phrases of the corpus and of writers, beside texts that are no gesture, several, or denied."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.own_layers_file import save_classifier
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, gestures
from mmm_core.language.tagged_words import MANNERS
from mmm_core.model.gesture_classifier import ClassifierConfig, GestureClassifier
from mmm_core.model.text import MiniLm
from mmm_core.training.drawn_text import SETTLING_SHARES, Drawn, batches_of
from mmm_core.training.gesture_texts import Texts
from mmm_core.training.own_layers import Rates, copy_layers, fit

STEPS, BATCH = 3000, 64
"""Optimisation steps, and texts of a batch."""
SETTLING_STEPS = 500
"""Steps after `STEPS` at smaller rates, with the shares of texts of `SETTLING_SHARES`."""
RATES, SETTLING_RATES = Rates(layers=2e-4, linear=2e-3, warm_up=50), Rates(layers=1e-4, linear=1e-3, warm_up=20)
DROPOUT, SMOOTHING = 0.1, 0.05
SEED = 0

Draw = Callable[[], Drawn]


def train_classifier(
    out: Path, draw: Draw | None = None, *, classes: Sequence[str] = (), steps: int = STEPS
) -> GestureClassifier:
    """Train a classifier and write it; equal arguments give equal weights on one machine.

    Args:
        out: file of the classifier.
        draw: draws a text and its class; phrases of all gestures and other texts, which settle in the end, when None.
        classes: all classes that `draw` gives.
        steps: optimisation steps, without those of settling.
    """
    encoder = load_text_encoder()
    stages = [(draw, RATES, steps)] if draw is not None else _stages(steps)
    classes = classes or (*gestures(), OUTSIDE, SEVERAL)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        classifier = GestureClassifier(ClassifierConfig(tuple(classes), MANNERS[1:]), encoder.config)
        copy_layers(classifier.layers, encoder, classifier.config.n_shared)
        for draws, rates, n_steps in stages:
            batches = batches_of(draws, BATCH, SEED)
            fit(classifier, classifier.layers, partial(_next_loss, classifier, encoder, batches), rates, n_steps)
    save_classifier(out, classifier)
    return classifier


def _stages(steps: int) -> list[tuple[Draw, Rates, int]]:
    """Texts, rates and steps of the training, and of its end."""
    first, last = Texts(random.Random(SEED)), Texts(random.Random(SEED + 1), SETTLING_SHARES)
    return [(first.draw, RATES, steps), (last.draw, SETTLING_RATES, SETTLING_STEPS)]


def _next_loss(classifier: GestureClassifier, encoder: MiniLm, batches: Iterator[list[Drawn]], _step: int) -> Tensor:
    return _loss(classifier, encoder, next(batches))


def _loss(classifier: GestureClassifier, encoder: MiniLm, batch: Sequence[Drawn]) -> Tensor:
    ids, mask = encoder.piece_ids([one.text for one in batch])
    parts = _pieces_of_parts(encoder, batch, mask)
    with torch.no_grad():
        states = encoder.lower_states(ids, mask, classifier.config.n_shared)
    of_classes, of_manners, of_denial = classifier(states, mask, parts, DROPOUT)
    names = [-1 if one.name is None else classifier.config.classes.index(one.name) for one in batch]
    loss = F.cross_entropy(of_classes, torch.tensor(names), ignore_index=-1, label_smoothing=SMOOTHING)
    known = [i for i, one in enumerate(batch) if one.manners is not None]
    if known:
        wanted = [[float(manner in (batch[i].manners or ())) for manner in classifier.config.manners] for i in known]
        loss = loss + F.binary_cross_entropy_with_logits(of_manners[known], torch.tensor(wanted))
    known = [i for i, one in enumerate(batch) if one.is_denied is not None]
    if known:
        denied = torch.tensor([float(batch[i].is_denied or 0) for i in known])
        loss = loss + F.binary_cross_entropy_with_logits(of_denial[known], denied)
    return loss


def _pieces_of_parts(encoder: MiniLm, batch: Sequence[Drawn], mask: Tensor) -> Tensor:
    """(B, W) bool, the word pieces of each text's part; all where it has none, or where the text is cut before it."""
    parts = mask.clone()
    for row, (one, encoded) in enumerate(
        zip(batch, encoder.word_pieces.encode_batch([one.text for one in batch]), strict=True)
    ):
        if one.part is not None:
            start, end = one.part
            within = [a < b and start <= a and b <= end for a, b in encoded.offsets]
            if any(within):
                parts[row, : len(within)] = torch.tensor(within)
    return parts
