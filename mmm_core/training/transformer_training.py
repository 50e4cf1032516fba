"""Trains the masked transformer and the length predictor.

MMM (arXiv 2312.03596) sec. 3.2, eq. 2: visible ids are corrupted, a share of the positions is masked, and the loss is
the cross-entropy at every motion position. Text dropout (ours) makes guidance possible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core import distributed
from mmm_core.model.length import LengthClassifier
from mmm_core.model.low_rank import add_changes
from mmm_core.model.text import TextStates
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.transformer import MotionTransformer, TransformerConfig
from mmm_core.model.vqvae import VqVae
from mmm_core.training.batches import TokenCorpus, length_buckets
from mmm_core.training.fresh import FreshClips
from mmm_core.training.motion_loss import MotionLoss, error_measure
from mmm_core.training.run import Run, Schedule, train

TOKENS_PER_BATCH = 1100
"""Tokens of a batch; the number of rows follows from their length, so that every step costs about as much."""
LENGTH_BATCH = 128


@dataclass(frozen=True)
class Corruption:
    """Shares of a training motion that are masked, replaced or left out.

    Attributes:
        masked_share: least share of masked positions; the share is drawn from U(masked_share, 1) for each motion.
        full_share: share of motions that are masked as a whole, as at the beginning of a generation, where the text is all that
            the model has.
        kept_share: least probability that a visible id is kept and not replaced, drawn from U(kept_share, 1) for each motion.
        no_text_share: share of motions trained without their text.
        real_share: share of motions made by a person, where there are both kinds.
        part_share: share of motions in which only some body parts are masked, so that parts can be edited alone.
        cell_share: share of motions in which each body part of a position is masked independently.
        context_share: share of replaced ids in codebooks that are not predicted (the lower body of eq. 3).
    """

    masked_share: float = 0.4
    full_share: float = 0.0
    kept_share: float = 0.5
    no_text_share: float = 0.1
    real_share: float = 0.12
    part_share: float = 0.0
    cell_share: float = 0.0
    context_share: float = 0.1


def corrupt(
    ids: Tensor,
    n_tokens: Tensor,
    n_codes: int,
    how: Corruption,
    generator: torch.Generator,
    n_predicted: int | None = None,
    n_seen: Tensor | None = None,
) -> Tensor:
    """Replace some visible ids by random ones, then mask positions; (B, L, C) -> (B, L, C), [END] and [PAD] untouched.

    Ids of codebooks from `n_predicted` on are never masked, and only some are replaced (MMM eq. 3). The first `n_seen` (B,)
    positions of a motion do not change.
    """
    B, L, C = ids.shape
    P = C if n_predicted is None else n_predicted
    motion = learnt(L, n_tokens, n_seen)
    if n_seen is not None:
        n_tokens = n_tokens - n_seen
    keep = how.kept_share + (1 - how.kept_share) * torch.rand(B, 1, generator=generator)
    replaced = motion & (torch.rand(B, L, generator=generator) > keep)
    random_ids = torch.randint(n_codes, ids.shape, generator=generator)
    share = how.masked_share + (1 - how.masked_share) * torch.rand(B, generator=generator)
    if how.full_share:
        share[torch.rand(B, generator=generator) < how.full_share] = 1.0
    n_masked = (share * n_tokens).round().clamp_min(1)
    order = torch.rand(B, L, generator=generator).masked_fill(~motion, 2.0).argsort(dim=1).argsort(dim=1)
    masked = (order < n_masked[:, None])[..., None].expand(B, L, P)
    if how.cell_share and P > 1:
        chance = torch.rand(B, L, P, generator=generator).masked_fill(~motion[..., None], 2.0)
        rank = chance.reshape(B, -1).argsort(dim=1).argsort(dim=1).reshape(B, L, P)
        by_cell = torch.rand(B, 1, 1, generator=generator) < how.cell_share
        masked = torch.where(by_cell, rank < P * n_masked[:, None, None], masked)
    hidden = replaced[..., None].expand(B, L, P)
    if how.part_share and P > 1:
        parts = torch.rand(B, 1, P, generator=generator) < 0.5
        parts[:, :, 0] |= ~parts.any(-1)  # at least one
        by_part = torch.rand(B, 1, 1, generator=generator) < how.part_share
        masked = masked & (parts | ~by_part)
    if P < C:
        context = motion & (torch.rand(B, L, generator=generator) < how.context_share)
        never = torch.zeros(B, L, C - P, dtype=torch.bool)
        hidden, masked = torch.cat([hidden, context[..., None] | never], -1), torch.cat([masked, never], -1)
    ids = torch.where(hidden, random_ids, ids)
    return torch.where(masked, torch.full_like(ids, n_codes + 2), ids)


def learnt(length: int, n_tokens: Tensor, n_seen: Tensor | None = None) -> Tensor:
    """(B, L) bool: positions that count in the loss, from `n_seen` (B,) up to the motion's length `n_tokens` (B,)."""
    position = torch.arange(length, device=n_tokens.device)[None]
    motion = position < n_tokens[:, None]
    return motion if n_seen is None else motion & (position >= n_seen[:, None])


class Batches:
    """Draws the rows of a step from a corpus: clips of similar length, a given share of them from people."""

    def __init__(self, corpus: TokenCorpus, tokens_per_batch: int, real_share: float) -> None:
        self._corpus, self._tokens, self._real_share = corpus, tokens_per_batch, real_share
        self._buckets = length_buckets(corpus.ids)
        weight = np.array([_drawing_weight(rows, corpus.is_real, real_share) for rows in self._buckets.values()])
        self._lengths, self._p = list(self._buckets), weight / weight.sum()

    def draw(self, generator: torch.Generator, config: TransformerConfig) -> tuple[Tensor, Tensor, Tensor, TextStates]:
        """Ids (B, L, C) with [END] and [PAD], lengths (B,), seen tokens at the beginning (B,), and a caption's states for each."""
        corpus, K = self._corpus, config.n_codes
        rng = np.random.default_rng(int(torch.randint(2**62, (1,), generator=generator)))
        length = self._lengths[rng.choice(len(self._lengths), p=self._p)]
        rows, B = self._buckets[length], max(8, self._tokens // length)
        p = np.where(corpus.is_real[rows], *_shares(corpus.is_real[rows], self._real_share))
        picked = rng.choice(rows, B, p=p / p.sum())
        ids = torch.full((B, length + 1, config.n_codebooks), K + 1)
        n_tokens = torch.tensor([len(corpus.ids[i]) for i in picked])
        for row, i in enumerate(picked):
            n = len(corpus.ids[i])
            ids[row, :n] = corpus.ids[i]
            ids[row, n] = K
        captions = [int(rng.choice(corpus.caption_rows[i])) for i in picked]
        return ids, n_tokens, torch.from_numpy(corpus.seen(picked)), corpus.captions.gather(captions)


def train_transformer(
    corpus: TokenCorpus | FreshClips,
    tokenizer: Tokenizer | VqVae,
    config: TransformerConfig,
    schedule: Schedule,
    run: Run,
    how: Corruption | None = None,
    tokens_per_batch: int = TOKENS_PER_BATCH,
    start: MotionTransformer | None = None,
    words: nn.ModuleList | None = None,
    words_rate: float = 1.0,
    rank: int = 0,
    motion_loss: MotionLoss | None = None,
) -> MotionTransformer:
    """A transformer trained by eq. 2, or by eq. 3 if `config` predicts only the first codebooks.

    Args:
        corpus: fixed clips, or clips that are made while it trains.
        tokenizer: gives the code vectors.
        config: sizes.
        schedule: steps and learning rate.
        run: folder and device.
        how: corruption of the training motions; None takes the usual one.
        tokens_per_batch: as `TOKENS_PER_BATCH`.
        start: model of these sizes whose weights are trained further; None begins with new weights.
        words: layers of the text encoder; the last ones are copied into the word layers of `config`, unless `start` has them.
        words_rate: learning rate of the word layers, as a share of the schedule's.
        rank: rank of the changes of the start's matrices that are trained alone (`mmm_core.model.low_rank`); 0 trains all weights.
        motion_loss: how much the decoded motion counts beside the ids; None leaves it out.
    """
    how = how or Corruption()
    torch.manual_seed(schedule.seed)
    model = MotionTransformer(config)
    model.set_codebooks([q.codebook for q in tokenizer.books])
    if words is not None and config.n_words:
        model.set_words(words)
    if start is not None:
        mine = model.state_dict()
        model.load_state_dict(mine | {name: t for name, t in start.state_dict().items() if name in mine})
    if rank:
        add_changes(model, rank)
    K, P = config.n_codes, config.n_out
    device = run.torch_device
    motion_loss = motion_loss or MotionLoss()
    error_of = error_measure(motion_loss, tokenizer, run)

    @lru_cache(maxsize=1)
    def batches(corpus: TokenCorpus) -> Batches:
        return Batches(corpus, tokens_per_batch, how.real_share)

    def loss_fn(step: int, generator: torch.Generator) -> dict[str, Tensor]:
        now = corpus if isinstance(corpus, TokenCorpus) else corpus.corpus(step)
        ids, n_tokens, n_seen, text = batches(now).draw(generator, config)
        dropped = torch.rand(len(ids), generator=generator) < how.no_text_share
        seen = corrupt(ids, n_tokens, K, how, generator, P, n_seen)
        mine = distributed.share(len(ids))
        ids, seen, n_tokens, n_seen, dropped = (t[mine].to(device) for t in (ids, seen, n_tokens, n_seen, dropped))
        context = model.read_text(_drop(text.part(mine).to(device), dropped, model))
        B, L = ids.shape[:2]
        logits = model(seen, context).float()
        motion = learnt(L, n_tokens, n_seen)
        target = ids[motion][:, :P]  # (N, P)
        entropy = F.cross_entropy(logits[motion].reshape(-1, K), target.reshape(-1), reduction="none")
        share = (1.0 / (n_tokens - n_seen))[:, None].expand(B, L)[motion]
        loss = (entropy.reshape(target.shape).mean(1) * share).sum() / B
        right = (logits[motion].argmax(-1) == target).float().mean()
        if error_of is None:
            return {"loss": loss, "right": right}
        if not motion_loss.counts_at(step, schedule.steps):
            return {"loss": loss, "right": right, "motion": loss.new_full((), math.nan)}
        error = error_of(logits, ids, motion)
        return {"loss": loss + motion_loss.weight * error, "right": right, "motion": error}

    train(model, loss_fn, schedule, run, "transformer", slower={"word_layers.": words_rate})
    return model


def train_length(
    corpus: TokenCorpus, schedule: Schedule, run: Run, start: LengthClassifier | None = None
) -> LengthClassifier:
    """A length predictor trained by cross-entropy on each caption and its clip's tokens, from `start` or with new weights.

    Neither the tokens of another motion at a clip's beginning nor the rest added after it count. People's clips are cut from
    recordings, so their length says little; they are used only where there are no other clips.
    """
    torch.manual_seed(schedule.seed)
    predictor = LengthClassifier(corpus.captions.words.shape[1])
    if start is not None:
        predictor.load_state_dict(start.state_dict())
    taken = corpus.is_real if corpus.is_real.all() else ~corpus.is_real
    n_tokens = corpus.own_lengths().tolist()
    pairs = [(row, n_tokens[i]) for i, rows in enumerate(corpus.caption_rows) if taken[i] for row in rows]
    device = run.torch_device

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        drawn = torch.randint(len(pairs), (LENGTH_BATCH,), generator=generator)[distributed.share(LENGTH_BATCH)]
        picked = [pairs[i] for i in drawn.tolist()]
        logits = predictor(corpus.captions.gather([row for row, _ in picked]).to(device))
        asked = torch.tensor([n for _, n in picked], device=device)
        right = (logits.argmax(-1) == asked).float().mean()
        return {"loss": F.cross_entropy(logits, asked), "right": right}

    train(predictor, loss_fn, schedule, run, "length")
    return predictor


def _shares(is_real: np.ndarray, real_share: float) -> tuple[float, float]:
    """Weights by which a real and a synthesised clip are drawn."""
    n_real = max(1, int(is_real.sum()))
    n_synth = max(1, len(is_real) - int(is_real.sum()))
    return real_share / n_real, (1 - real_share) / n_synth


def _drawing_weight(rows: np.ndarray, is_real: np.ndarray, real_share: float) -> float:
    """Weight by which a bucket of clips is drawn: the sum of its clips' weights."""
    real, synth = _shares(is_real, real_share)
    return float(np.where(is_real[rows], real, synth).sum())


def _drop(text: TextStates, dropped: Tensor, model: MotionTransformer) -> TextStates:
    """Replace the text of the rows in `dropped` by "no text"."""
    empty = model.no_text(len(dropped))  # on the model's device
    words = torch.where(dropped[:, None, None], empty.words, text.words)
    only_first = torch.zeros_like(text.word_mask)
    only_first[:, 0] = True
    mask = torch.where(dropped[:, None], only_first, text.word_mask)
    return TextStates(words, mask, torch.where(dropped[:, None], empty.sentence, text.sentence))
