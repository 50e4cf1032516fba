"""Trains the tokenizer; its loss has terms for reconstruction, differences between frames, and commitment.

MMM (arXiv 2312.03596) eq. 1. The loss weighs channels by the robot's needs, since the mean joint error hides a lost head
turn or forearm twist, whose channels are few and small (docs/model.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor

from mmm_core import distributed
from mmm_core.errors import TrainingDataError
from mmm_core.model.low_rank import add_changes
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig, feature_std, rotation_channels
from mmm_core.model.vqvae import HEIGHT_CHANNELS, ROOT_HEIGHT, VqVae, VqVaeConfig
from mmm_core.motion.features import joints_of
from mmm_core.training.batches import Clip
from mmm_core.training.run import LossFn, Run, Schedule, train

WINDOW_FRAMES = 40
BATCH = 128
COMMITMENT = 0.05
LATENT_SQUARE = 0.001
"""Weight of the latents' mean square in steps without codes, which keeps latents of a size that codes can follow later."""
BETA = 0.3
"""Normalised error at which SmoothL1 turns linear; with 1, channels of small motion were lost."""
DIFFERENCE_GAIN, DIFFERENCE_WEIGHT = 5.0, 0.3
DECODER_DIFFERENCE_WEIGHT = 0.6
JERK_GAIN, JERK_WEIGHT = 10.0, 0.3
"""Factor on the second and third differences between frames, and the weight of their errors in the loss of the decoder for
people's motion."""
Draw = Callable[[torch.Generator], Tensor]
"""Draws (B, T, F) windows of motion."""


def channel_weights() -> Tensor:
    """(263,) weight of each feature in the loss, mean 1."""
    weight = torch.full((263,), 0.25)
    weight[:4] = 1.0
    weight[67:193] = 1.0
    weight[list(rotation_channels((13, 14, 16, 17, 18, 19, 20, 21)))] = 4.0  # collars, arms, forearm twist
    weight[list(rotation_channels((3, 6, 9, 12, 15)))] = (
        4.0  # spine, neck and head; with weight 1 the trunk lost all its roll
    )
    weight[list(rotation_channels((1, 2, 4, 5, 7, 8, 10, 11)))] = 0.3  # legs: the robot has none
    weight[193:] = 0.1
    return weight / weight.mean()


def even_weights() -> Tensor:
    """(263,) weight of each feature in the loss for people's motion, mean 1: all but foot contacts count nearly alike."""
    weight = torch.ones(263)
    weight[67:193] = 1.5  # rotations, from which joints are recovered
    weight[259:] = 0.1
    return weight / weight.mean()


@dataclass(frozen=True)
class PaperLoss:
    """Weights in MMM's tokenizer loss: SmoothL1 of all features, plus weighted SmoothL1 of positions, plus commitment."""

    positions: float = 0.5
    commitment: float = 0.02


def train_tokenizer(
    clips: Sequence[Clip],
    config: TokenizerConfig | VqVaeConfig,
    schedule: Schedule,
    run: Run,
    *,
    statistics: tuple[Tensor, Tensor] | None = None,
    batch: int = BATCH,
    window_frames: int = WINDOW_FRAMES,
    real_share: float = 0.12,
    plain_steps: int = 0,
) -> Tokenizer | VqVae:
    """A tokenizer trained on windows of `clips`, of which `real_share` come from real motion.

    Args:
        clips: motions; those shorter than a window are left out.
        config: layout by parts (trained with our loss), or one of the paper's layouts (trained with the paper's loss).
        schedule: steps and learning rate.
        run: folder and device.
        statistics: mean and standard deviation of the features; None takes them from the clips.
        batch: windows in a step, of all processes.
        window_frames: frames in a window.
        real_share: share of windows from people, where there are both kinds.
        plain_steps: number of first steps in which latents are not quantised (layout by parts). With codes from the start, the
            tokenizer learns one joint after another, and joints of small motion only after thousands of steps.
    """
    torch.manual_seed(schedule.seed)
    tokenizer = Tokenizer(config) if isinstance(config, TokenizerConfig) else VqVae(config)
    _set_statistics(tokenizer, clips, statistics)
    draw = _window_draw(clips, real_share, batch, window_frames)
    device = run.torch_device
    weights = channel_weights().to(device)

    def loss_fn(step: int, generator: torch.Generator) -> dict[str, Tensor]:
        x = tokenizer.normalise(draw(generator)[distributed.share(batch)].to(device))
        plain = step < plain_steps and isinstance(tokenizer, Tokenizer)
        reconstruction, commitment = tokenizer(x, quantise=False) if plain else tokenizer(x)
        reconstruction = reconstruction.float()
        if isinstance(tokenizer, VqVae):
            how, end = PaperLoss(), 4 + 3 * (joints_of(x.shape[-1]) - 1)
            frames = F.smooth_l1_loss(reconstruction, x)
            positions = F.smooth_l1_loss(reconstruction[..., 4:end], x[..., 4:end])
            loss = frames + how.positions * positions + how.commitment * commitment
            return {"loss": loss, "frames": frames, "positions": positions, "commitment": commitment}
        frames, differences = motion_errors(reconstruction, x, weights)
        loss = frames + DIFFERENCE_WEIGHT * differences + (LATENT_SQUARE if plain else COMMITMENT) * commitment
        return {"loss": loss, "frames": frames, "differences": differences, "commitment": commitment}

    train(tokenizer, loss_fn, schedule, run, "tokenizer")
    return tokenizer


def go_on_with_tokenizer(
    tokenizer: Tokenizer, clips: Sequence[Clip], schedule: Schedule, run: Run, name: str, real_share: float = 0.12
) -> None:
    """Train a tokenizer that has codes already further, in place; `name` names the stage in the run's folder."""
    draw = _window_draw(clips, real_share, BATCH, WINDOW_FRAMES)
    train(tokenizer, _reconstruction_loss(tokenizer, draw, channel_weights(), BATCH, run), schedule, run, name)


def change_for_people(
    tokenizer: Tokenizer,
    clips: Sequence[Clip],
    rank: int,
    schedule: Schedule,
    run: Run,
    batch: int = BATCH,
    window_frames: int = WINDOW_FRAMES,
) -> None:
    """Train low-rank changes of encoders and decoder on people's clips, in place; the codebooks stay as they are.

    All features count nearly alike, since people move their legs and walk, which `channel_weights` neglects.
    """
    add_changes(tokenizer, rank)
    draw = _window_draw([clip for clip in clips if clip.is_real], 1.0, batch, window_frames)
    loss_fn = _reconstruction_loss(tokenizer, draw, even_weights(), batch, run, moves_codes=False)
    train(tokenizer, loss_fn, schedule, run, "tokenizer")


def tune_decoder(
    tokenizer: Tokenizer, clips: Sequence[Clip], schedule: Schedule, run: Run, real_share: float = 0.12
) -> None:
    """Train the decoder alone, in place; encoders and codebooks stay, so existing ids stay valid."""
    tokenizer.decoder.requires_grad_(True)
    draw = _window_draw(clips, real_share, BATCH, WINDOW_FRAMES)
    _train_decoder(tokenizer, draw, channel_weights(), schedule, run)


def smooth_for_people(
    tokenizer: Tokenizer, clips: Sequence[Clip], schedule: Schedule, run: Run, window_frames: int = WINDOW_FRAMES
) -> None:
    """Train the decoder's changes further, in place, with the errors of acceleration and jerk in the loss; ids stay valid.

    Without these errors the arms' mean jerk is more than twice that of the recordings (docs/model_history.md).
    """
    draw = _window_draw([clip for clip in clips if clip.is_real], 1.0, BATCH, window_frames)
    _train_decoder(tokenizer, draw, even_weights(), schedule, run, JERK_WEIGHT)


def _reconstruction_loss(
    tokenizer: Tokenizer, draw: Draw, weights: Tensor, batch: int, run: Run, *, moves_codes: bool = True
) -> LossFn:
    """The loss of a tokenizer that has codes already; its training moves them where `moves_codes` is set."""
    device = run.torch_device
    weights = weights.to(device)

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        tokenizer.quantizers.train(moves_codes)
        x = tokenizer.normalise(draw(generator)[distributed.share(batch)].to(device))
        reconstruction, commitment = tokenizer(x)
        frames, differences = motion_errors(reconstruction.float(), x, weights)
        loss = frames + DECODER_DIFFERENCE_WEIGHT * differences + COMMITMENT * commitment
        return {"loss": loss, "frames": frames, "differences": differences, "commitment": commitment}

    return loss_fn


def _train_decoder(
    tokenizer: Tokenizer, draw: Draw, weights: Tensor, schedule: Schedule, run: Run, jerk_weight: float = 0.0
) -> None:
    """Train what needs a gradient in the decoder, on the ids that the encoders give."""
    device = run.torch_device
    weights = weights.to(device)
    tokenizer.to(device)

    def loss_fn(_step: int, generator: torch.Generator) -> dict[str, Tensor]:
        features = draw(generator)[distributed.share(BATCH)].to(device)
        with torch.no_grad():
            vectors = tokenizer.embed(tokenizer.encode(features))
        made, x = tokenizer.decoder(vectors).float(), tokenizer.normalise(features)
        frames, differences = motion_errors(made, x, weights)
        losses = {
            "loss": frames + DECODER_DIFFERENCE_WEIGHT * differences,
            "frames": frames,
            "differences": differences,
        }
        if jerk_weight:
            losses["jerks"] = sum(
                (_difference_error(made, x, weights, order, JERK_GAIN) for order in (2, 3)), start=torch.zeros(())
            )
            losses["loss"] = losses["loss"] + jerk_weight * losses["jerks"]
        return losses

    train(tokenizer.decoder, loss_fn, schedule, run, "decoder")
    tokenizer.cpu()


def _set_statistics(
    tokenizer: Tokenizer | VqVae, clips: Sequence[Clip], statistics: tuple[Tensor, Tensor] | None
) -> None:
    synth = [c.features for c in clips if not c.is_real][:3000]
    real = [c.features for c in clips if c.is_real][: 300 if synth else 3000]
    sample = torch.from_numpy(np.concatenate([*synth, *real]))
    mean, std = statistics or (sample.mean(0), feature_std(sample))
    tokenizer.mean.copy_(mean)
    tokenizer.std.copy_(std)
    if isinstance(tokenizer, VqVae) and tokenizer.config.layout == "halves":
        heights = sample[:, HEIGHT_CHANNELS] - sample[:, ROOT_HEIGHT, None]
        tokenizer.height_mean.copy_(heights.mean(0))
        tokenizer.height_std.copy_(heights.std(0).clamp_min(0.02))


def motion_errors(reconstruction: Tensor, x: Tensor, weights: Tensor) -> tuple[Tensor, Tensor]:
    """Weighted errors of frames and of differences between frames."""
    frames = (F.smooth_l1_loss(reconstruction, x, beta=BETA, reduction="none") * weights).mean()
    return frames, _difference_error(reconstruction, x, weights, 1, DIFFERENCE_GAIN)


def _difference_error(reconstruction: Tensor, x: Tensor, weights: Tensor, order: int, gain: float) -> Tensor:
    """Weighted error of the `order`-th differences between frames, enlarged by `gain`."""
    made, wanted = (one.diff(dim=1, n=order) * gain for one in (reconstruction, x))
    return (F.smooth_l1_loss(made, wanted, beta=BETA, reduction="none") * weights).mean()


def _window_draw(clips: Sequence[Clip], real_share: float, batch: int, window: int) -> Draw:
    """A function that draws (batch, window, F) windows, `real_share` of them from real motion where there are both kinds."""
    synth = [c.features for c in clips if not c.is_real and len(c.features) >= window]
    real = [c.features for c in clips if c.is_real and len(c.features) >= window]
    if not synth and not real:
        longest = max((len(c.features) for c in clips), default=0)
        raise TrainingDataError(Path(), "window_frames", f"{window}, the longest motion has {longest} frames",
                                "at most a motion's length")  # fmt: skip
    n_real = round(batch * real_share) if real and synth else batch * bool(real)

    def draw(generator: torch.Generator) -> Tensor:
        windows: list[NDArray[np.float32]] = []
        for source, count in ((synth, batch - n_real), (real, n_real)):
            for i in torch.randint(len(source), (count,), generator=generator).tolist() if count else []:
                start = int(torch.randint(len(source[i]) - window + 1, (1,), generator=generator))
                windows.append(source[i][start : start + window])
        return torch.from_numpy(np.stack(windows))

    return draw
