"""Where the golden vectors are: the released code at a small size, random weights, inputs and outputs recorded."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import pytest
from safetensors.torch import load_file
from torch import Tensor

SHARED = Path(os.environ.get("MMMD_SHARED", Path(__file__).parents[3] / "shared"))
GOLDEN = SHARED / "golden" / "mmm_official"

needs_golden = pytest.mark.skipif(not GOLDEN.is_dir(), reason=f"no golden vectors at {GOLDEN}")


@cache
def golden(name: str) -> dict[str, Tensor]:
    """Tensors of one golden file."""
    return load_file(GOLDEN / f"{name}.safetensors")
