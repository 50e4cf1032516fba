"""Motion tokenizer: 263 features at 20 fps <-> ids at 5 per second, one id for each body part.

MMM (arXiv 2312.03596) sec. 3.1. A body part has its own encoder and codebook and sees its own channels only, so that the
trunk's motion does not change the ids of an arm; one decoder reads all parts. The paper's tokenizer has one part with all
channels, and two parts for upper-body editing. Convolutions over time are written as shifted copies and a linear layer,
which a CPU runs faster than conv1d.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.quantizer import Quantizer
from mmm_core.model.tokens import FRAMES_PER_TOKEN
from mmm_core.motion.features import joints_of
from mmm_core.motion.motion import N_FEATURES

TIME_DILATIONS = (3, 1)
"""Dilations of each pair of residual blocks."""


def rotation_channels(joints: tuple[int, ...]) -> tuple[int, ...]:
    """Feature channels of the 6-D rotations of `joints` (1..21), HumanML3D layout."""
    return tuple(67 + 6 * (j - 1) + k for j in joints for k in range(6))


_LEFT_ARM, _RIGHT_ARM = (13, 16, 18, 20), (14, 17, 19, 21)
_REST = tuple(j for j in range(1, 22) if j not in _LEFT_ARM + _RIGHT_ARM)


@dataclass(frozen=True)
class PartConfig:
    """A body part: its name, the feature channels that its encoder sees, and the encoder's width."""

    name: str
    channels: tuple[int, ...]
    width: int


def default_parts() -> tuple[PartConfig, ...]:
    """Left arm, right arm, and everything else (root, trunk, head, legs, foot contacts)."""
    return (
        PartConfig("left_arm", rotation_channels(_LEFT_ARM), 128),
        PartConfig("right_arm", rotation_channels(_RIGHT_ARM), 128),
        PartConfig("rest", (0, 1, 2, 3, *rotation_channels(_REST), 259, 260, 261, 262), 192),
    )


@dataclass(frozen=True)
class TokenizerConfig:
    """Sizes of a tokenizer; travels inside the checkpoint."""

    n_codes: int = 512
    code_dim: int = 16
    decoder_width: int = 256
    parts: tuple[PartConfig, ...] = field(default_factory=default_parts)


class TimeBlock(nn.Module):
    """Residual block: mixes frames i - d, i, i + d (zero outside), then channels."""

    def __init__(self, width: int, dilation: int) -> None:
        super().__init__()
        self.dilation = dilation
        self.mix = nn.Linear(3 * width, width)
        self.out = nn.Linear(width, width)

    def forward(self, x: Tensor) -> Tensor:
        """(B, L, W) -> (B, L, W)."""
        d, length = self.dilation, x.shape[1]
        padded = F.pad(F.silu(x), (0, 0, d, d))
        neighbours = torch.cat([padded[:, :length], padded[:, d : d + length], padded[:, 2 * d :]], -1)
        return x + self.out(F.silu(self.mix(neighbours)))


class PartEncoder(nn.Module):
    """Channels of one part at 20 fps -> one latent for each token."""

    def __init__(self, part: PartConfig, code_dim: int) -> None:
        super().__init__()
        self.stem = nn.Linear(FRAMES_PER_TOKEN * len(part.channels), part.width)
        self.blocks = nn.Sequential(*(TimeBlock(part.width, d) for d in TIME_DILATIONS))
        self.out = nn.Linear(part.width, code_dim)

    def forward(self, x: Tensor) -> Tensor:
        """(B, T, channels) -> (B, T/4, D)."""
        return self.out(self.blocks(self.stem(x.reshape(x.shape[0], -1, FRAMES_PER_TOKEN * x.shape[2]))))


class Decoder(nn.Module):
    """Latents of all parts -> features: two halvings of the time step, as in the paper, by reshaping."""

    def __init__(self, latent_dim: int, width: int) -> None:
        super().__init__()
        fine = width * 3 // 4
        self.stem = nn.Linear(latent_dim, width)
        self.coarse = nn.Sequential(*(TimeBlock(width, d) for d in TIME_DILATIONS))
        self.up = nn.Linear(width, 2 * fine)
        self.fine = nn.Sequential(*(TimeBlock(fine, d) for d in TIME_DILATIONS))
        self.out = nn.Linear(fine, 2 * N_FEATURES)

    def forward(self, latents: Tensor) -> Tensor:
        """(B, L, D) -> (B, 4 L, 263)."""
        B, L = latents.shape[:2]
        x = self.up(self.coarse(self.stem(latents))).reshape(B, 2 * L, -1)
        return self.out(self.fine(x)).reshape(B, 4 * L, N_FEATURES)


class Tokenizer(nn.Module):
    """Features <-> ids. Features are not normalised on either side, since the tokenizer holds their `mean` and `std`."""

    mean: Tensor
    std: Tensor

    def __init__(self, config: TokenizerConfig) -> None:
        super().__init__()
        self.config = config
        self.encoders = nn.ModuleList(PartEncoder(p, config.code_dim) for p in config.parts)
        self.quantizers = nn.ModuleList(Quantizer(config.n_codes, config.code_dim) for _ in config.parts)
        self.decoder = Decoder(config.code_dim * len(config.parts), config.decoder_width)
        self.register_buffer("mean", torch.zeros(N_FEATURES))
        self.register_buffer("std", torch.ones(N_FEATURES))

    @property
    def n_codebooks(self) -> int:
        """Ids per position."""
        return len(self.config.parts)

    @property
    def part_names(self) -> tuple[str, ...]:
        """Body part of each codebook."""
        return tuple(p.name for p in self.config.parts)

    def normalise(self, features: Tensor) -> Tensor:
        """Features -> normalised features, the encoders' input."""
        return (features - self.mean) / self.std

    def latents(self, normalised: Tensor) -> list[Tensor]:
        """(B, T, 263) normalised features -> (B, T/4, D) latents of each part, before they become codes."""
        return [
            encoder(normalised[..., list(part.channels)])
            for encoder, part in zip(self.encoders, self.config.parts, strict=True)
        ]

    def encode(self, features: Tensor) -> Tensor:
        """(B, T, 263) features, T a multiple of four -> (B, T/4, C) ids."""
        latents = self.latents(self.normalise(features))
        return torch.stack([q.encode(z) for q, z in zip(self.books, latents, strict=True)], -1)

    def decode(self, ids: Tensor) -> Tensor:
        """(B, L, C) ids -> (B, 4 L, 263) features."""
        return self.decoder(self.embed(ids)) * self.std + self.mean

    def embed(self, ids: Tensor) -> Tensor:
        """(B, L, C) ids -> (B, L, C * D) code vectors, side by side."""
        return torch.cat([F.embedding(ids[..., c], q.codebook) for c, q in enumerate(self.books)], -1)

    def forward(self, normalised: Tensor, *, quantise: bool = True) -> tuple[Tensor, Tensor]:
        """Training pass on normalised features: (reconstruction, commitment loss).

        Without `quantise` the latents go to the decoder unquantised, and the second value is their mean square.
        """
        if not quantise:
            latents = torch.cat(self.latents(normalised), -1)
            return self.decoder(latents), latents.float().square().mean()
        quantised: list[Tensor] = []
        commitment = normalised.new_zeros(())
        for quantizer, z in zip(self.books, self.latents(normalised), strict=True):
            straight_through, loss = quantizer(z)
            quantised.append(straight_through)
            commitment = commitment + loss
        return self.decoder(torch.cat(quantised, -1)), commitment

    def halo_tokens(self) -> int:
        """Tokens on each side that can change a decoded frame: 4 by the blocks at 5 Hz and 2 by those at 10 Hz."""
        reach = sum(TIME_DILATIONS)
        return reach + -(-reach // 2)

    @property
    def books(self) -> list[Quantizer]:
        """The quantisers, in the order of the parts."""
        return [q for q in self.quantizers if isinstance(q, Quantizer)]


def feature_std(features: Tensor) -> Tensor:
    """Standard deviation for normalising, equal within a joint's six rotation channels.

    A joint with little motion (head, spine) must count as much as an arm, but noise on a still channel must not be
    amplified, so each group of channels has a floor.
    """
    std = features.std(0)
    n_joints = joints_of(len(std))
    rotations = 4 + 3 * (n_joints - 1)
    velocities = rotations + 6 * (n_joints - 1)
    contacts = velocities + 3 * n_joints
    groups = [(0, 1, 2e-3), (1, 3, 3e-3), (3, 4, 2e-2), (4, rotations, 5e-2), (velocities, contacts, 8e-3),
              (contacts, contacts + 4, 0.3), *((j, j + 6, 0.06) for j in range(rotations, velocities, 6))]  # fmt: skip
    out = std.clone()
    for lo, hi, floor in groups:
        out[lo:hi] = max(float(std[lo:hi].square().mean().sqrt()), floor)
    return out
