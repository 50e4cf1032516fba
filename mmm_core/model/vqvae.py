"""The paper's tokenizer at its own shape: convolutions, one factorised codebook, or one for each half of the body.

MMM (arXiv 2312.03596) sec. 3.1, eq. 1, and sec. 3.4 for the halves. Encoder: stem, two halvings of the time step, each
with residual blocks of dilation 9, 3, 1, and a projection to the code's width; the decoder mirrors it with nearest
doubling. All convolutions pad with zeros, so a motion that is decoded as part of a longer row differs from the one decoded
alone: decode each motion by itself, or over a window with `halo_tokens` on both sides (`mmm_core.model.streaming_decoder`).

`tokenizer.py` has the compact tokenizer with three body parts; both classes offer the same methods.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core.model.quantizer import OfficialRuleQuantizer, Quantizer
from mmm_core.motion.motion import N_FEATURES

Layout = Literal["whole", "halves"]

LOWER_JOINTS = (0, 1, 2, 4, 5, 7, 8, 10, 11)
"""Joints of pelvis and legs; the other 13 joints are the upper body."""
UPPER_JOINTS = tuple(j for j in range(22) if j not in LOWER_JOINTS)
ROOT_HEIGHT = 3
"""Feature channel of the pelvis's height."""
HEIGHT_CHANNELS = tuple(4 + 3 * (j - 1) + 1 for j in UPPER_JOINTS)
"""Feature channels of the upper joints' heights; layout `halves` stores them relative to the pelvis, so that the upper half
does not depend on the legs."""


@dataclass(frozen=True)
class VqVaeConfig:
    """Sizes; the defaults are the released model's. `code_dim` is the width of one half's code in layout `halves`."""

    layout: Layout = "whole"
    n_codes: int = 8192
    code_dim: int = 32
    width: int = 512
    depth: int = 3
    dilation_growth: int = 3
    n_features: int = N_FEATURES
    reset_rule: Literal["for_good", "official"] = "for_good"

    @property
    def dilations(self) -> tuple[int, ...]:
        """Dilations of the residual blocks in the order they run."""
        return tuple(self.dilation_growth**i for i in reversed(range(self.depth)))


class ResidualBlock(nn.Module):
    """x + conv1(relu(conv3(relu(x)))), the first convolution dilated."""

    def __init__(self, width: int, dilation: int) -> None:
        super().__init__()
        self.dilated = nn.Conv1d(width, width, 3, padding=dilation, dilation=dilation)
        self.mix = nn.Conv1d(width, width, 1)

    def forward(self, x: Tensor) -> Tensor:
        """(B, W, T) -> (B, W, T)."""
        return x + self.mix(F.relu(self.dilated(F.relu(x))))


def _residual(config: VqVaeConfig) -> nn.Sequential:
    return nn.Sequential(*(ResidualBlock(config.width, d) for d in config.dilations))


class Encoder(nn.Module):
    """Normalised channels at 20 fps -> one latent for each four frames."""

    def __init__(self, config: VqVaeConfig, n_channels: int) -> None:
        super().__init__()
        W = config.width
        self.stem = nn.Conv1d(n_channels, W, 3, padding=1)
        self.halvings = nn.ModuleList(nn.Conv1d(W, W, 4, stride=2, padding=1) for _ in range(2))
        self.residuals = nn.ModuleList(_residual(config) for _ in range(2))
        self.out = nn.Conv1d(W, config.code_dim, 3, padding=1)

    def forward(self, x: Tensor) -> Tensor:
        """(B, T, channels) -> (B, T // 4, D)."""
        x = F.relu(self.stem(x.transpose(1, 2)))
        for halve, residual in zip(self.halvings, self.residuals, strict=True):
            x = residual(halve(x))
        return self.out(x).transpose(1, 2)


class Decoder(nn.Module):
    """Code vectors -> normalised channels, four frames for each."""

    def __init__(self, config: VqVaeConfig, n_channels: int) -> None:
        super().__init__()
        W = config.width
        self.stem = nn.Conv1d(config.code_dim, W, 3, padding=1)
        self.residuals = nn.ModuleList(_residual(config) for _ in range(2))
        self.doublings = nn.ModuleList(nn.Conv1d(W, W, 3, padding=1) for _ in range(2))
        self.mix = nn.Conv1d(W, W, 3, padding=1)
        self.out = nn.Conv1d(W, n_channels, 3, padding=1)

    def forward(self, codes: Tensor) -> Tensor:
        """(B, L, D) -> (B, 4 L, channels)."""
        x = F.relu(self.stem(codes.transpose(1, 2)))
        for residual, double in zip(self.residuals, self.doublings, strict=True):
            x = double(residual(x).repeat_interleave(2, dim=2))
        return self.out(F.relu(self.mix(x))).transpose(1, 2)


class VqVae(nn.Module):
    """Features <-> ids. Features are not normalised on either side, since the tokenizer holds their `mean` and `std`.

    Layout `halves` has two encoders, codebooks and decoders, upper body first; `height_mean` and `height_std` (13,)
    normalise the upper joints' heights above the pelvis.
    """

    mean: Tensor
    std: Tensor
    height_mean: Tensor
    height_std: Tensor

    def __init__(self, config: VqVaeConfig) -> None:
        super().__init__()
        if config.layout == "halves" and config.n_features != N_FEATURES:
            raise ValueError(f"layout 'halves' knows {N_FEATURES} features (22 joints), not {config.n_features}")
        self.config = config
        self.channels = _channels(config)
        self.encoders = nn.ModuleList(Encoder(config, len(c)) for c in self.channels)
        rule = OfficialRuleQuantizer if config.reset_rule == "official" else Quantizer
        self.quantizers = nn.ModuleList(rule(config.n_codes, config.code_dim) for _ in self.channels)
        self.decoders = nn.ModuleList(Decoder(config, len(c)) for c in self.channels)
        self.register_buffer("mean", torch.zeros(config.n_features))
        self.register_buffer("std", torch.ones(config.n_features))
        self.register_buffer("height_mean", torch.zeros(len(UPPER_JOINTS)))
        self.register_buffer("height_std", torch.ones(len(UPPER_JOINTS)))

    @property
    def n_codebooks(self) -> int:
        """Ids per position."""
        return len(self.channels)

    @property
    def part_names(self) -> tuple[str, ...]:
        """Body part of each codebook."""
        return ("whole",) if self.config.layout == "whole" else ("upper", "lower")

    def normalise(self, features: Tensor) -> Tensor:
        """Features -> normalised features, the encoders' input."""
        if self.config.layout == "whole":
            return (features - self.mean) / self.std
        heights = features[..., HEIGHT_CHANNELS] - features[..., ROOT_HEIGHT, None]
        x = (features - self.mean) / self.std
        x[..., HEIGHT_CHANNELS] = (heights - self.height_mean) / self.height_std
        return x

    def denormalise(self, x: Tensor) -> Tensor:
        features = x * self.std + self.mean
        if self.config.layout == "halves":
            heights = x[..., HEIGHT_CHANNELS] * self.height_std + self.height_mean
            features[..., HEIGHT_CHANNELS] = heights + features[..., ROOT_HEIGHT, None]
        return features

    def encode(self, features: Tensor) -> Tensor:
        """(B, T, F) features, T a multiple of four -> (B, T/4, C) ids."""
        latents = self.latents(self.normalise(features))
        return torch.stack([q.encode(z) for q, z in zip(self.books, latents, strict=True)], -1)

    def decode(self, ids: Tensor) -> Tensor:
        """(B, L, C) ids -> (B, 4 L, F) features."""
        return self.denormalise(self._decode_codes(self.embed(ids).split(self.config.code_dim, -1)))

    def embed(self, ids: Tensor) -> Tensor:
        """(B, L, C) ids -> (B, L, C * D) code vectors, side by side."""
        return torch.cat([F.embedding(ids[..., c], q.codebook) for c, q in enumerate(self.books)], -1)

    def latents(self, normalised: Tensor) -> list[Tensor]:
        """(B, T/4, D) inputs of the quantisers, one tensor for each codebook."""
        return [e(normalised[..., list(c)]) for e, c in zip(self.encoders, self.channels, strict=True)]

    def forward(self, normalised: Tensor) -> tuple[Tensor, Tensor]:
        """Training pass on normalised features: (reconstruction, commitment loss)."""
        quantised: list[Tensor] = []
        commitment = normalised.new_zeros(())
        for quantizer, z in zip(self.books, self.latents(normalised), strict=True):
            straight_through, loss = quantizer(z)
            quantised.append(straight_through)
            commitment = commitment + loss
        return self._decode_codes(quantised), commitment

    def halo_tokens(self) -> int:
        """Tokens on each side that can change a decoded frame: 22 at the released sizes.

        Three convolutions at 20 Hz reach 3 positions; one convolution and the residual blocks reach 1 + sum(dilations)
        positions at 10 Hz, and as many at 5 Hz.
        """
        reach = 1 + sum(self.config.dilations)
        at_10_hz = -(-3 // 2) + reach
        return -(-at_10_hz // 2) + reach

    @property
    def books(self) -> list[Quantizer]:
        """The quantisers, upper body first."""
        return [q for q in self.quantizers if isinstance(q, Quantizer)]

    def _decode_codes(self, codes: list[Tensor] | tuple[Tensor, ...]) -> Tensor:
        parts = [decoder(c) for decoder, c in zip(self.decoders, codes, strict=True)]
        if len(parts) == 1:
            return parts[0]
        x = parts[0].new_empty(*parts[0].shape[:2], self.config.n_features)
        for part, channels in zip(parts, self.channels, strict=True):
            x[..., list(channels)] = part
        return x


def _channels(config: VqVaeConfig) -> tuple[tuple[int, ...], ...]:
    """Feature channels of each encoder: all of them, or upper (156) and lower (107)."""
    if config.layout == "whole":
        return (tuple(range(config.n_features)),)
    upper = [False] * N_FEATURES
    for j in UPPER_JOINTS:
        for channel in (*range(4 + 3 * (j - 1), 4 + 3 * j), *range(67 + 6 * (j - 1), 67 + 6 * j)):
            upper[channel] = True
        upper[193 + 3 * j : 193 + 3 * j + 3] = [True] * 3
    return tuple(i for i, u in enumerate(upper) if u), tuple(i for i, u in enumerate(upper) if not u)
