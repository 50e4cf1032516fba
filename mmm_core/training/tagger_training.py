"""Trains the sentence tagger on marked sentences, each also with slips and without punctuation."""

from __future__ import annotations

import logging
import random
import re
from collections.abc import Sequence
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.corpus.marked_sentences import TaggedSentence, load_marked_sentences
from mmm_core.inference.checkpoint import load_text_encoder
from mmm_core.inference.tagger_file import save_tagger
from mmm_core.language.tagged_words import INSIDE, TAGS, THEN, words_of
from mmm_core.language.word_tables import lines
from mmm_core.model.sentence_tagger import SentenceTagger, TaggerConfig, WordStates, word_states
from mmm_core.model.text import MiniLm

log = logging.getLogger(__name__)

STEPS, BATCH = 3000, 32
COPIES = 5
"""Copies of each sentence: one as it is, the others with random slips or without punctuation."""
LAYER_RATE, TAG_RATE, WARM_UP = 3e-4, 2e-3, 40
"""Learning rates of the copied layers and of the linear layer above them, and steps in which they rise."""
DROPOUT, SMOOTHING = 0.15, 0.05
SEED = 0
_LOG_EVERY = 100
_SHARE_WITHOUT_MARKS = _SHARE_WITH_SLIPS = 0.3
_LETTERS = "qwertyuiopasdfghjklzxcvbnm"
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
    given = list(sentences) if sentences is not None else [*load_marked_sentences(), *_one_gesture()]
    copies = [given, *([_spoilt(one, rng) for one in given] for _ in range(COPIES - 1))]
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(SEED)
        tagger = _copied(encoder, TaggerConfig(n_tags=len(TAGS)))
        _fit(tagger, encoder, [one for copy in copies for one in copy], steps, rng)
    save_tagger(out, tagger)
    return tagger


def _one_gesture() -> list[TaggedSentence]:
    """Phrases with a conjunction that are one gesture: "bow in one hand, the other pulls the string"."""
    spoken = [tuple(phrase[a:b] for a, b in words_of(phrase)) for phrase in lines("one_gesture")]
    return [TaggedSentence(words, (THEN, *([INSIDE] * (len(words) - 1)))) for words in spoken if words]


def _copied(encoder: MiniLm, config: TaggerConfig) -> SentenceTagger:
    """A tagger that begins with copies of the encoder's next layers."""
    tagger = SentenceTagger(config, encoder.config)
    for own, layer in zip(tagger.layers, encoder.layers[config.n_shared :], strict=False):
        own.load_state_dict(layer.state_dict())
    return tagger.requires_grad_(True)


def _fit(tagger: SentenceTagger, encoder: MiniLm, given: list[TaggedSentence], steps: int, rng: random.Random) -> None:
    batches = _batches(encoder, tagger.config.n_shared, given, rng)
    optimiser = torch.optim.AdamW(
        [{"params": tagger.layers.parameters(), "lr": LAYER_RATE}, {"params": tagger.tag.parameters(), "lr": TAG_RATE}],
        weight_decay=0.02,
    )
    rate = torch.optim.lr_scheduler.LambdaLR(
        optimiser, lambda step: min(1.0, (step + 1) / WARM_UP) * max(0.02, 1 - step / steps)
    )
    tagger.train()
    for step in range(steps):
        if step % len(batches) == 0:
            rng.shuffle(batches)
        states, mask, first_pieces, tags = batches[step % len(batches)]
        scores = tagger(states, mask, first_pieces, DROPOUT)
        loss = F.cross_entropy(scores.transpose(1, 2), tags, ignore_index=_NOT_GIVEN, label_smoothing=SMOOTHING)
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(tagger.parameters(), 1.0)
        optimiser.step()
        rate.step()
        if (step + 1) % _LOG_EVERY == 0:
            log.info("tagger: step %d of %d, loss %.3f", step + 1, steps, float(loss.detach()))
    tagger.eval().requires_grad_(False)


_Batch = tuple[Tensor, Tensor, Tensor, Tensor]


def _batches(encoder: MiniLm, n_shared: int, given: list[TaggedSentence], rng: random.Random) -> list[_Batch]:
    """Batches of sentences of similar length: states, mask, first pieces, tags."""
    order = sorted(range(len(given)), key=lambda i: len(given[i].words) + 4 * rng.random())
    found: list[_Batch] = []
    for at in range(0, len(order), BATCH):
        chosen = [given[i] for i in order[at : at + BATCH]]
        found.append(_padded(word_states(encoder, n_shared, [one.words for one in chosen]), chosen))
    return found


def _padded(states: list[WordStates], sentences: list[TaggedSentence]) -> _Batch:
    pad = nn.utils.rnn.pad_sequence
    tags = [torch.tensor([TAGS.index(tag) for tag in one.tags]) for one in sentences]
    mask = [torch.ones(len(one.states), dtype=torch.bool) for one in states]
    return (
        pad([one.states for one in states], batch_first=True),
        pad(mask, batch_first=True),
        pad([one.first_pieces for one in states], batch_first=True),
        pad(tags, batch_first=True, padding_value=_NOT_GIVEN),
    )


def _spoilt(one: TaggedSentence, rng: random.Random) -> TaggedSentence:
    """A sentence as people type or a recogniser hears it: a share without punctuation, a share with one or two slips."""
    pairs = list(zip(one.words, one.tags, strict=True))
    if rng.random() < _SHARE_WITHOUT_MARKS:
        pairs = [(word, tag) for word, tag in pairs if re.search(r"\w", word)]
    if rng.random() < _SHARE_WITH_SLIPS and pairs:
        for _ in range(rng.choice((1, 1, 2))):
            i = rng.randrange(len(pairs))
            pairs[i] = (_slip(pairs[i][0], rng), pairs[i][1])
    return TaggedSentence(*map(tuple, zip(*pairs, strict=True))) if pairs else one


def _slip(word: str, rng: random.Random) -> str:
    """A word with two letters swapped, one lost or one replaced; a short word stays."""
    if len(word) < 4:
        return word
    i = rng.randrange(1, len(word) - 1)
    before, after = word[:i], word[i + 1 :]
    return rng.choice((before + after[0] + word[i] + after[1:], before + after, before + rng.choice(_LETTERS) + after))
