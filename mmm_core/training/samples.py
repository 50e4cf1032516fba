"""Draws pictures while a model trains: a row of small figures for each motion that the model decodes or samples."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.imports.kit import joints_from_kit
from mmm_core.model.sampling import SamplingSettings, empty_row, fill
from mmm_core.model.text import TextStates
from mmm_core.model.tokenizer import Tokenizer
from mmm_core.model.transformer import MotionTransformer
from mmm_core.model.vqvae import VqVae
from mmm_core.motion.features import joints_from_positions, recover
from mmm_core.motion.skeleton import JOINT_NAMES, PARENTS

INSTANTS = 8
"""Figures in a row."""
SAMPLE_TEXTS = ("wave with your right hand", "raise your left arm", "clap your hands", "bow")
SAMPLE_TOKENS = 15
"""Tokens (3 s) of a sampled motion."""
_COLOURS = {"left": "#c0392b", "right": "#2471a3"}


@torch.no_grad()
def draw_reconstruction(path: Path, tokenizer: Tokenizer | VqVae, shown: Tensor, ours: bool) -> None:
    """Draw a clip (T, D) before and after encoding and decoding; `ours` as in `draw_samples`."""
    features = shown.to(tokenizer.mean.device)
    again = tokenizer.decode(tokenizer.encode(features[None]))[0].cpu().numpy()
    draw_rows(path, {"a clip": _joints(shown.numpy(), ours), "through the tokenizer": _joints(again, ours)})


@torch.no_grad()
def draw_samples(
    path: Path,
    transformer: MotionTransformer,
    texts: TextStates,
    known: Sequence[Tensor],
    tokenizer: Tokenizer | VqVae,
    ours: bool,
) -> None:
    """Draw a motion for each of `SAMPLE_TEXTS`.

    Args:
        path: file of the picture.
        transformer: the model at this step; it is moved to the CPU and back to its device.
        texts: states of `SAMPLE_TEXTS`.
        known: (L, C) ids of a clip for each text; a model that predicts the upper body takes their lower body as context.
        tokenizer: decodes the ids.
        ours: whether the tokenizer's features are those of `Motion`, not those of a data set.
    """
    device = transformer.codebooks.device
    transformer.cpu()
    rows = [empty_row(transformer, SAMPLE_TOKENS) for _ in SAMPLE_TEXTS]
    if transformer.config.n_predicted is not None:
        for row, ids in zip(rows, known, strict=False):
            row[:, 1:] = ids[torch.arange(SAMPLE_TOKENS) % len(ids), 1:]
    filled = fill(transformer, texts, rows, list(range(len(rows))), SamplingSettings())
    transformer.to(device)
    motions = [tokenizer.decode(ids[None])[0].numpy() for ids in filled]
    draw_rows(path, {t: _joints(m, ours) for t, m in zip(SAMPLE_TEXTS, motions, strict=True)})


def _joints(features: NDArray[np.float32], ours: bool) -> NDArray[np.floating]:
    """(T, 22, 3) joints in metres."""
    if ours:
        return recover(features).joints_m
    joints = joints_from_positions(features)
    return joints if joints.shape[1] == 22 else joints_from_kit(joints)


def draw_rows(path: Path, motions: dict[str, NDArray[np.floating]]) -> None:
    """Draw each motion (T, 22, 3) at eight instants under its title, from the front, with the person's left on the right."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(1.5 * INSTANTS, 1.75 * len(motions)))
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.01, top=1 - 0.15 / len(motions), wspace=0, hspace=0.12)
    axes = figure.subplots(len(motions), INSTANTS, squeeze=False)
    for row, (title, joints) in zip(axes, motions.items(), strict=True):
        for axis, t in zip(row, np.linspace(0, len(joints) - 1, INSTANTS).round().astype(int), strict=True):
            pose = joints[t] - joints[t, 0] * np.array([1, 0, 1])
            for joint, parent in enumerate(PARENTS[1:], 1):
                colour = _COLOURS.get(JOINT_NAMES[joint].partition("_")[0], "#444444")
                axis.plot(pose[[parent, joint], 0], pose[[parent, joint], 1], color=colour, linewidth=1.2)
            axis.set(xlim=(-1, 1), ylim=(-0.1, 2.1), aspect="equal")
            axis.axis("off")
        row[0].set_title(title[:60], fontsize=7, loc="left")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80)
