"""A small model with the features of HumanML3D."""

from __future__ import annotations

from pathlib import Path

import torch

from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import Model, save_model
from mmm_core.model.transformer import MotionTransformer, TransformerConfig
from mmm_core.model.vqvae import VqVae, VqVaeConfig


def humanml3d_model(path: Path, n_features: int = 263) -> Engine:
    """A model with one codebook and the rest directions of HumanML3D, as imports and trainings on a folder have."""
    torch.manual_seed(0)
    tokenizer = VqVae(VqVaeConfig(n_codes=16, code_dim=8, width=16, depth=1, n_features=n_features))
    transformer = MotionTransformer(TransformerConfig(16, 1, 8, 32, 2, 1, 1))
    save_model(path, Model(tokenizer, transformer, None, None, {}, rest_pose="humanml3d"))
    return Engine.load(path, threads=None)
