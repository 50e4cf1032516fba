"""Golden inputs of the released model as this repository takes them."""

from __future__ import annotations

import torch
from torch import Tensor

from mmm_core.model.decode import NoiseFn
from mmm_core.model.text import TextStates

TOLERANCE = {"atol": 2e-5, "rtol": 1e-4}


def text_of(io: dict[str, Tensor], batch: int, source: str = "tr") -> TextStates:
    words = io[f"{source}.in.word"][:batch]
    return TextStates(words, torch.ones(batch, 77, dtype=torch.bool), io[f"{source}.in.clip_sent"][:batch])


def recorded_noise(uniform: Tensor) -> NoiseFn:
    """Gumbel noise from the recorded uniforms (step, B, 50, K)."""

    def noise(step: int, asked: Tensor, shape: tuple[int, int]) -> Tensor:
        u = uniform[step, : asked.shape[0], : asked.shape[1]][asked].reshape(-1, *shape)
        return -torch.log((-torch.log(u.clamp_min(1e-20))).clamp_min(1e-20))

    return noise


SAMPLES = [
    "argmax_b1_f8", "argmax_b1_f20", "argmax_b1_f32", "argmax_b1_f40", "argmax_b1_f48", "argmax_b1_f52",
    "argmax_b1_f100", "argmax_b1_f196", "argmax_b3", "rand_b1_f40", "rand_b1_f100", "rand_b1_f196", "rand_b3",
    "inbetween", "transition",
]  # fmt: skip
