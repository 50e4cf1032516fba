"""Trains the evaluator: vectors of a text and its motion come near each other, those of a text and another motion apart.

Guo et al. 2022 sec. 6.1: contrastive loss with a margin of 10 on Euclidean distances. Here all pairs of a batch count,
and pairs that share a caption are not pushed apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from mmm_core import distributed
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation.extractors import OURS, Evaluator, EvaluatorConfig
from mmm_core.model.tokenizer import feature_std
from mmm_core.training.batches import CaptionStates, Clip
from mmm_core.training.run import Run, Schedule, train

MARGIN = 10.0
"""Distance beyond which a text and another motion are far enough apart."""
BATCH = 32
SHORTEST_FRAMES = 24
NOISE = 0.05
"""Standard deviation of noise on normalised features, without which a few hundred clips would be learnt by heart."""


def train_evaluator(
    clips: Sequence[Clip], captions: CaptionStates, rows: list[list[int]], schedule: Schedule, run: Run,
    config: EvaluatorConfig = OURS, real_share: float = 0.5,
) -> Evaluator:  # fmt: skip
    """An evaluator trained on `clips` and the states of their captions.

    Args:
        clips: motions; those shorter than 24 frames are left out.
        captions: text states.
        rows: for each clip the rows of its captions in `captions`.
        schedule: steps and learning rate.
        run: folder and device.
        config: sizes.
        real_share: share of a batch that comes from people, where there are both kinds.

    Raises:
        TrainingDataError: no clip is long enough.
    """
    torch.manual_seed(schedule.seed)
    evaluator = Evaluator(config)
    sample = torch.from_numpy(np.concatenate([c.features for c in clips[:: max(1, len(clips) // 1500)]]))
    evaluator.mean.copy_(sample.mean(0))
    evaluator.std.copy_(feature_std(sample))
    usable = [i for i, c in enumerate(clips) if len(c.features) >= SHORTEST_FRAMES and rows[i]]
    if not usable:
        raise TrainingDataError(run.folder, "clips", f"{len(clips)}, none of them long enough",
                                f"clips of at least {SHORTEST_FRAMES} frames with a caption")  # fmt: skip
    people = np.array([i for i in usable if clips[i].is_real])
    others = np.array([i for i in usable if not clips[i].is_real])
    n_people = round(BATCH * real_share) if len(people) and len(others) else BATCH * bool(len(people))
    device = run.torch_device

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        rng = np.random.default_rng(int(torch.randint(2**62, (1,), generator=generator)))
        picked = [
            int(i) for kind, n in ((people, n_people), (others, BATCH - n_people)) if n for i in rng.choice(kind, n)
        ]
        chosen = [int(rng.choice(rows[i])) for i in picked]
        motions = [_crop(clips[i].features, rng) for i in picked]
        mine = range(BATCH)[distributed.share(BATCH)]
        states = captions.gather([chosen[i] for i in mine]).to(device)
        noisy = [torch.from_numpy(motions[i]).to(device) for i in mine]
        noisy = [x + NOISE * evaluator.std * torch.randn(x.shape, generator=generator).to(device) for x in noisy]
        texts = evaluator.texts(states.words, None, states.word_mask.sum(1))
        gap = torch.cdist(texts, evaluator.motions(noisy))
        same = torch.tensor(
            [[bool(set(rows[picked[a]]) & set(rows[picked[b]])) for b in mine] for a in mine], device=device
        )
        together = gap.diagonal().square().mean()
        apart = F.relu(MARGIN - gap)[~same].square()
        loss = together + (apart.mean() if len(apart) else 0.0)
        right = (gap.argmin(1) == torch.arange(len(gap), device=device)).float().mean()
        return {"loss": loss, "together": together, "right": right}

    train(evaluator, loss_fn, schedule, run, "evaluator")
    return evaluator


def _crop(features: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """70 to 100 % of a motion's frames, from a random start."""
    n = int(len(features) * rng.uniform(0.7, 1.0))
    n = max(SHORTEST_FRAMES, n)
    start = int(rng.integers(0, len(features) - n + 1))
    return features[start : start + n]
