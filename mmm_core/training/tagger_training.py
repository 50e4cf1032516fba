"""Trains the sentence tagger on sentences with marked commands or marked manner, each also with slips and without punctuation."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.corpus.marked_sentences import TaggedSentence, load_manner_sentences, load_marked_sentences
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.own_layers_file import save_tagger
from mmm_core.language.reading import read
from mmm_core.language.tagged_words import INSIDE, MANNERS, NO_MANNER, TAGS, THEN, words_of
from mmm_core.language.word_tables import lines
from mmm_core.model.sentence_tagger import SentenceTagger, TaggerConfig, WordStates, word_states
from mmm_core.model.text import MiniLm
from mmm_core.training.own_layers import Rates, copy_layers, fit
from mmm_core.training.slips import slip

STEPS, BATCH = 4000, 32
COPIES = 5
"""Copies of each sentence: one as it is, the others with random slips or without punctuation."""
RATES = Rates(layers=3e-4, linear=2e-3, warm_up=40)
DROPOUT, SMOOTHING = 0.15, 0.05
SEED = 0
_SHARE_WITHOUT_MARKS = _SHARE_WITH_SLIPS = 0.3
_NOT_GIVEN = -100


def train_tagger(out: Path, sentences: Sequence[TaggedSentence] | None = None, *, steps: int = STEPS) -> SentenceTagger:
    """Train a tagger and write it; equal arguments give equal weights on one machine.

    Args:
        out: file of the tagger.
        sentences: marked sentences; those that ship, and phrases that are one gesture, when None.
        steps: optimisation steps.
    """
    encoder = load_text_encoder()
    rng = random.Random(SEED)
    given = list(sentences) if sentences is not None else shipped_sentences()
    copies = [given, *([_spoilt(one, rng) for one in given] for _ in range(COPIES - 1))]
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        tagger = _copied(encoder, TaggerConfig(n_tags=len(TAGS), n_manners=len(MANNERS)))
        _fit(tagger, encoder, [one for copy in copies for one in copy], steps, rng)
    save_tagger(out, tagger)
    return tagger


def shipped_sentences() -> list[TaggedSentence]:
    """The marked sentences that ship, and phrases that are one gesture.

    Most sentences with marked commands name neither tempo nor size. Where the rules find neither, "none" is given for all words.
    """
    commands = [
        replace(one, manners=(NO_MANNER,) * len(one.words)) if _has_no_manner(" ".join(one.words)) else one
        for one in load_marked_sentences()
    ]
    return [*commands, *_one_gesture(), *load_manner_sentences()]


def _has_no_manner(sentence: str) -> bool:
    return all(command.manner.tempo == command.manner.size == 1 for step in read(sentence).steps for command in step)


def _one_gesture() -> list[TaggedSentence]:
    """Phrases with a conjunction that are one gesture: "bow in one hand, the other pulls the string"."""
    spoken = [tuple(phrase[a:b] for a, b in words_of(phrase)) for phrase in lines("one_gesture")]
    return [
        TaggedSentence(words, (THEN, *([INSIDE] * (len(words) - 1))), (NO_MANNER,) * len(words))
        for words in spoken
        if words
    ]


def _copied(encoder: MiniLm, config: TaggerConfig) -> SentenceTagger:
    """A tagger that begins with copies of the encoder's next layers."""
    tagger = SentenceTagger(config, encoder.config)
    copy_layers(tagger.layers, encoder, config.n_shared)
    return tagger


def _fit(tagger: SentenceTagger, encoder: MiniLm, given: list[TaggedSentence], steps: int, rng: random.Random) -> None:
    batches = _batches(encoder, tagger.config.n_shared, given, rng)

    def loss_of(step: int) -> Tensor:
        if step % len(batches) == 0:
            rng.shuffle(batches)
        states, mask, first_pieces, *marks = batches[step % len(batches)]
        scores = tagger(states, mask, first_pieces, DROPOUT)
        return torch.stack([_loss(*pair) for pair in zip(scores, marks, strict=True)]).sum()

    fit(tagger, tagger.layers, loss_of, RATES, steps)


def _loss(scores: Tensor, marks: Tensor) -> Tensor:
    """Cross entropy of the words whose marks are given, over the number of all words of the batch; 0 where none are given."""
    total = F.cross_entropy(
        scores.transpose(1, 2), marks, ignore_index=_NOT_GIVEN, label_smoothing=SMOOTHING, reduction="sum"
    )
    return total / marks.numel()


_Batch = tuple[Tensor, Tensor, Tensor, Tensor, Tensor]


def _batches(encoder: MiniLm, n_shared: int, given: list[TaggedSentence], rng: random.Random) -> list[_Batch]:
    """Batches of sentences of similar length: states, mask, first pieces, tags, manners."""
    order = sorted(range(len(given)), key=lambda i: len(given[i].words) + 4 * rng.random())
    found: list[_Batch] = []
    for at in range(0, len(order), BATCH):
        chosen = [given[i] for i in order[at : at + BATCH]]
        found.append(_padded(word_states(encoder, n_shared, [one.words for one in chosen]), chosen))
    return found


def _padded(states: list[WordStates], sentences: list[TaggedSentence]) -> _Batch:
    pad = nn.utils.rnn.pad_sequence
    tags = [_indices(one.tags, TAGS, len(one.words)) for one in sentences]
    manners = [_indices(one.manners, MANNERS, len(one.words)) for one in sentences]
    mask = [torch.ones(len(one.states), dtype=torch.bool) for one in states]
    return (
        pad([one.states for one in states], batch_first=True),
        pad(mask, batch_first=True),
        pad([one.first_pieces for one in states], batch_first=True),
        pad(tags, batch_first=True, padding_value=_NOT_GIVEN),
        pad(manners, batch_first=True, padding_value=_NOT_GIVEN),
    )


def _indices(marks: Sequence[str], names: Sequence[str], n_words: int) -> Tensor:
    return torch.tensor([names.index(mark) for mark in marks] or [_NOT_GIVEN] * n_words)


def _spoilt(one: TaggedSentence, rng: random.Random) -> TaggedSentence:
    """A sentence as people type or a recogniser hears it: a share without punctuation, a share with one or two slips."""
    kept = list(range(len(one.words)))
    if rng.random() < _SHARE_WITHOUT_MARKS:
        kept = [i for i in kept if re.search(r"\w", one.words[i])]
    if not kept:
        return one
    words = [one.words[i] for i in kept]
    if rng.random() < _SHARE_WITH_SLIPS:
        for _ in range(rng.choice((1, 1, 2))):
            i = rng.randrange(len(words))
            words[i] = slip(words[i], rng)
    tags, manners = (tuple(marks[i] for i in kept) if marks else () for marks in (one.tags, one.manners))
    return TaggedSentence(tuple(words), tags, manners)
