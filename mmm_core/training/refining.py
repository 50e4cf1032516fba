"""Gives a finished model more codes: each codebook is refined, and the transformer keeps its training.

Codes of a finished tokenizer are split where latents lie farthest from their code; encoders, codebooks and decoder are trained
further; then k-means on the latents of the final encoders settles the codes. At first a new code is predicted as often as it
replaces old codes: its row of the transformer's head is the mean of the rows of the codes that it replaces, shifted by the
logarithm of its share of their uses. The transformer reads code vectors, not ids, so no other weights depend on the number of
codes.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace

import torch
from torch import Tensor

from mmm_core.inference.checkpoint import Model
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.model.transformer import MotionTransformer
from mmm_core.training.batches import Clip
from mmm_core.training.run import Run, Schedule
from mmm_core.training.tokenizer_training import BATCH, WINDOW_FRAMES, go_on_with_tokenizer

log = logging.getLogger(__name__)
SETTLING = 6
"""Iterations of k-means at the end."""
_LEAST_LATENTS = 6
"""Latents of an old code that are needed for each code that it is split into."""
_ERROR_POWER = 0.6
"""Exponent of an old code's summed squared error, in proportion to which it is split into new codes."""
_SEEDED_MEANS = 8
"""Iterations of k-means within an old code."""
_SHARED = 1e-3
"""Uses added to every new code, spread over all old codes, so that codes that no motion shows replace something."""
_LEAST_LOG_SHARE = -7.0
"""Least logarithm of the share of a new code."""
_PROBED = 64
"""Motions over which the mean input of the transformer's head is taken."""


def refined(
    model: Model, clips: Sequence[Clip], n_codes: int, schedule: Schedule, run: Run, real_share: float
) -> Model:
    """A copy of `model` with `n_codes` codes in each codebook, whose tokenizer is trained on `clips`; `model` does not change.

    Args:
        model: a finished model whose tokenizer has a codebook for each body part.
        clips: motions that the codes have to tell apart.
        n_codes: codes of each codebook, more than the model has.
        schedule: schedule of the tokenizer's training after its codes were split.
        run: the run that keeps the training's state, as stage `refined`.
        real_share: share of windows from people.
    """
    old = model.tokenizer
    assert isinstance(old, Tokenizer)
    torch.manual_seed(schedule.seed)
    tokenizer = Tokenizer(replace(old.config, n_codes=n_codes))
    kept = {name: t for name, t in old.state_dict().items() if not name.startswith("quantizers.")}
    tokenizer.load_state_dict(kept, strict=False)
    for quantizer, before, z in zip(tokenizer.books, old.books, _latents(tokenizer, clips), strict=True):
        quantizer.codebook.copy_(split(z, before.codebook, n_codes))
        quantizer.take_uses(z, BATCH * WINDOW_FRAMES // FRAMES_PER_TOKEN)
    go_on_with_tokenizer(tokenizer, clips, schedule, run, "refined", real_share)
    for quantizer, z in zip(tokenizer.books, _latents(tokenizer, clips), strict=True):
        quantizer.codebook.copy_(settle(z, quantizer.codebook))
    return replace(model, tokenizer=tokenizer, transformer=grown(model, tokenizer, clips))


def split(latents: Tensor, codebook: Tensor, n_codes: int) -> Tensor:
    """(n_codes, D) codes: the codes of `codebook` (K, D), split into means of their `latents` (N, D) where errors are largest."""
    ids = torch.cdist(latents, codebook).argmin(1)
    errors = torch.zeros(len(codebook)).index_add_(0, ids, (latents - codebook[ids]).square().sum(1))
    most = (torch.bincount(ids, minlength=len(codebook)) // _LEAST_LATENTS).clamp_min(1)
    children = torch.ones_like(most)
    for _ in range(n_codes - len(codebook)):  # the next new code goes to the code with the largest error for each child
        pressing = errors**_ERROR_POWER / children
        children[int(torch.where(children < most, pressing, pressing * 1e-6).argmax())] += 1
    return torch.cat([_means(latents[ids == k], codebook[k], int(n)) for k, n in enumerate(children)])


def _means(latents: Tensor, code: Tensor, n: int) -> Tensor:
    """(n, D) means of `latents` by k-means, seeded as in k-means++; with too few latents, codes close to `code`."""
    if n == 1:
        return code[None]
    if len(latents) < n:
        return code + 1e-3 * torch.randn(n, len(code))
    means = latents[torch.randint(len(latents), (1,))]
    while len(means) < n:
        far = torch.cdist(latents, means).min(1).values.square() + 1e-9
        means = torch.cat([means, latents[torch.multinomial(far, 1)]])
    for _ in range(_SEEDED_MEANS):
        means = _moved(latents, means)[0]
    return means


def settle(latents: Tensor, codebook: Tensor, iterations: int = SETTLING) -> Tensor:
    """(K, D) codes after k-means on `latents` (N, D), from `codebook`; codes without latents move to latents with large errors."""
    for left in reversed(range(iterations)):
        codebook, uses, errors = _moved(latents, codebook)
        unused = (uses == 0).nonzero()[:, 0]
        if left and len(unused):
            codebook[unused] = latents[torch.multinomial(errors + 1e-9, len(unused), replacement=True)]
    return codebook


def _moved(latents: Tensor, codes: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Codes moved to the mean of their latents, the number of latents of each, and each latent's squared error before the move."""
    ids = (codes.square().sum(1) - 2 * latents @ codes.T).argmin(1)
    uses = torch.bincount(ids, minlength=len(codes))
    means = torch.zeros_like(codes).index_add_(0, ids, latents) / uses.clamp_min(1)[:, None]
    return torch.where(uses[:, None] > 0, means, codes), uses, (latents - codes[ids]).square().sum(1)


def grown(model: Model, tokenizer: Tokenizer, clips: Sequence[Clip]) -> MotionTransformer:
    """The transformer of `model` with a head for the codes of `tokenizer`, which has more of them."""
    old, K = model.transformer, tokenizer.config.n_codes
    made = MotionTransformer(replace(old.config, n_codes=K))
    state = old.state_dict()
    scale = torch.stack([q.codebook for q in model.tokenizer.books]).std((1, 2), keepdim=True)
    state["codebooks"] = torch.stack([q.codebook for q in tokenizer.books]) / scale
    mean = _mean_before_head(model, clips)
    head = state["head.weight"].reshape(old.config.n_out, old.config.n_codes, -1)
    rows: list[Tensor] = []
    for part in range(old.config.n_out):
        uses = torch.full((K, old.config.n_codes), _SHARED / old.config.n_codes)
        for clip in clips:
            before, after = (t.encode(_whole(clip))[0, :, part] for t in (model.tokenizer, tokenizer))
            uses.index_put_((after, before), torch.ones(len(after)), accumulate=True)
        replaces = uses / uses.sum(1, keepdim=True)  # p(old | new)
        taken = uses / uses.sum(0, keepdim=True)  # p(new | old)
        log_share = (replaces * taken.clamp_min(1e-4).log()).sum(1).clamp_min(_LEAST_LOG_SHARE)
        rows.append(replaces @ head[part] + log_share[:, None] * mean / mean.square().sum())
    state["head.weight"] = torch.cat(rows)
    made.load_state_dict(state)
    return made.eval()


@torch.no_grad()
def _mean_before_head(model: Model, clips: Sequence[Clip]) -> Tensor:
    """(W,) mean input of the transformer's head over partly masked motions, without text."""
    transformer, found = model.transformer, list[Tensor]()
    context = transformer.read_text(transformer.no_text(1))
    handle = transformer.norm_out.register_forward_hook(lambda _m, _i, out: found.append(out.flatten(0, -2).mean(0)))
    generator = torch.Generator().manual_seed(0)
    for clip in clips[:_PROBED]:
        ids = model.tokenizer.encode(_whole(clip))
        ids[:, torch.rand(ids.shape[1], generator=generator) < 0.7] = transformer.ids.mask
        transformer(ids, context)
    handle.remove()
    return torch.stack(found).mean(0)


@torch.no_grad()
def _latents(tokenizer: Tokenizer, clips: Sequence[Clip]) -> list[Tensor]:
    """(N, D) latents of each body part."""
    found = [tokenizer.latents(tokenizer.normalise(_whole(clip))) for clip in clips]
    return [torch.cat(part, 1)[0] for part in zip(*found, strict=True)]


def _whole(clip: Clip) -> Tensor:
    """(1, T, 263) features of whole tokens."""
    T = min(len(clip.features) // FRAMES_PER_TOKEN, MAX_TOKENS) * FRAMES_PER_TOKEN
    return torch.from_numpy(clip.features[None, :T])
