"""Training of the tokenizer: reconstruction, differences between frames, commitment.

MMM (arXiv 2312.03596) eq. 1. The loss weighs channels by what the robot needs: the mean joint error hides a lost head
turn or forearm twist, whose channels are few and small (docs/model.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.tokenizer import Tokenizer, TokenizerConfig, feature_std, rotation_channels
from mmm_core.training.batches import Clip
from mmm_core.training.run import Schedule, train

WINDOW_FRAMES = 40
BATCH = 128
COMMITMENT = 0.05
BETA = 0.3
"""SmoothL1 turns linear here (in normalised units); 1 let small channels go."""
DIFFERENCE_GAIN, DIFFERENCE_WEIGHT = 5.0, 0.3
DECODER_DIFFERENCE_WEIGHT = 0.6


def channel_weights() -> Tensor:
    """(263,) weight of each feature in the loss, mean 1."""
    weight = torch.full((263,), 0.25)
    weight[:4] = 1.0
    weight[67:193] = 1.0
    weight[list(rotation_channels((13, 14, 16, 17, 18, 19, 20, 21)))] = 4.0  # collars, arms, forearm twist
    weight[list(rotation_channels((12, 15)))] = 4.0  # neck and head
    weight[list(rotation_channels((1, 2, 4, 5, 7, 8, 10, 11)))] = 0.3  # legs: the robot has none
    weight[193:] = 0.1
    return weight / weight.mean()


def train_tokenizer(
    clips: Sequence[Clip], config: TokenizerConfig, schedule: Schedule, run_dir: Path, real_share: float = 0.12
) -> Tokenizer:
    """A tokenizer trained on windows of `clips`, of which `real_share` come from real motion."""
    tokenizer = Tokenizer(config)
    synth = [c.features for c in clips if not c.is_real and len(c.features) >= WINDOW_FRAMES]
    real = [c.features for c in clips if c.is_real and len(c.features) >= WINDOW_FRAMES]
    sample = torch.from_numpy(np.concatenate([*synth[:3000], *real[:300]]))
    tokenizer.mean.copy_(sample.mean(0))
    tokenizer.std.copy_(feature_std(sample))
    weights, draw = channel_weights(), _window_draw(clips, real_share)

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        x = (draw(generator) - tokenizer.mean) / tokenizer.std
        reconstruction, commitment = tokenizer(x)
        frames, differences = _errors(reconstruction, x, weights)
        loss = frames + DIFFERENCE_WEIGHT * differences + COMMITMENT * commitment
        return {"loss": loss, "frames": frames, "differences": differences, "commitment": commitment}

    train(tokenizer, loss_fn, schedule, run_dir, "tokenizer")
    return tokenizer


def tune_decoder(
    tokenizer: Tokenizer, clips: Sequence[Clip], schedule: Schedule, run_dir: Path, real_share: float = 0.12
) -> None:
    """Train the decoder alone, in place: encoders and codebooks stay, so ids already made stay valid."""
    weights, draw = channel_weights(), _window_draw(clips, real_share)
    tokenizer.decoder.requires_grad_(True)

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        features = draw(generator)
        with torch.no_grad():
            vectors = tokenizer.embed(tokenizer.encode(features))
        x = (features - tokenizer.mean) / tokenizer.std
        frames, differences = _errors(tokenizer.decoder(vectors), x, weights)
        return {"loss": frames + DECODER_DIFFERENCE_WEIGHT * differences, "frames": frames, "differences": differences}

    train(tokenizer.decoder, loss_fn, schedule, run_dir, "decoder")


def _errors(reconstruction: Tensor, x: Tensor, weights: Tensor) -> tuple[Tensor, Tensor]:
    """Weighted errors of frames and of differences between frames."""
    frames = (F.smooth_l1_loss(reconstruction, x, beta=BETA, reduction="none") * weights).mean()
    gain = DIFFERENCE_GAIN
    steps = F.smooth_l1_loss(reconstruction.diff(dim=1) * gain, x.diff(dim=1) * gain, beta=BETA, reduction="none")
    return frames, (steps * weights).mean()


def _window_draw(clips: Sequence[Clip], real_share: float) -> Callable[[torch.Generator], Tensor]:
    """Draws (BATCH, WINDOW_FRAMES, 263) windows, `real_share` of them from real motion."""
    synth = [c.features for c in clips if not c.is_real and len(c.features) >= WINDOW_FRAMES]
    real = [c.features for c in clips if c.is_real and len(c.features) >= WINDOW_FRAMES]
    n_real = round(BATCH * real_share) if real else 0

    def draw(generator: torch.Generator) -> Tensor:
        windows: list[NDArray[np.float32]] = []
        for source, count in ((synth, BATCH - n_real), (real, n_real)):
            for i in torch.randint(len(source), (count,), generator=generator).tolist() if count else []:
                start = int(torch.randint(len(source[i]) - WINDOW_FRAMES + 1, (1,), generator=generator))
                windows.append(source[i][start : start + WINDOW_FRAMES])
        return torch.from_numpy(np.stack(windows))

    return draw
