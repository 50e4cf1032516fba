"""Fixtures of the released model at a small size (tests/support/golden.py)."""

from __future__ import annotations

import pytest
from torch import Tensor

from mmm_core.imports.official import tokenizer_from_official, transformer_from_official
from mmm_core.model.transformer import MotionTransformer
from mmm_core.model.vqvae import VqVae
from tests.support.golden import GOLDEN, golden


@pytest.fixture(scope="module")
def io() -> dict[str, Tensor]:
    return golden("io")


@pytest.fixture(scope="module")
def tokenizer() -> VqVae:
    return tokenizer_from_official(golden("vqvae_tiny"), GOLDEN)


@pytest.fixture(scope="module")
def transformer(tokenizer: VqVae) -> MotionTransformer:
    return transformer_from_official(golden("t2m_trans_tiny"), tokenizer, GOLDEN, n_heads=4)
