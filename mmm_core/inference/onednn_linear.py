"""Linear layers with their weights packed once for the matrix sizes of decoding.

A row of tokens makes thin matrices (at most 51 rows), for which a plain linear layer spends much of its time bringing
the weights into the order the processor wants. oneDNN can keep them in that order. Measured on an Intel Xeon with AVX-512,
one thread, width 1024, it is 1.4 times as fast with 51 rows and 2.4 times with 12 (`mmmd bench official`). The output is
that of the plain layer but for rounding. Where PyTorch has no oneDNN the layers stay as they are.
"""

from __future__ import annotations

import time
from typing import Literal

import torch
from torch import Tensor, nn

Packing = Literal["fp32", "bf16"]

PACKED_FOR_ROWS = 51
"""Rows of the matrix that the packing is optimised for; any number works."""
SMALLEST = 128
"""Width below which a layer gains nothing from packing."""


# PyTorch offers packing under these names alone; its own inference passes use them.
_PACK = getattr(torch.ops.mkldnn, "_reorder_linear_weight", None)
_APPLY = getattr(torch.ops.mkldnn, "_linear_pointwise", None)
_BF16 = getattr(torch.ops.mkldnn, "_is_mkldnn_bf16_supported", None)


class OneDnnLinear(nn.Module):
    """A linear layer for inference; `gelu` adds the activation that follows it.

    A bf16 layer's output stays bf16: the sum it is added to, or the next layer, converts it.
    """

    def __init__(self, linear: nn.Linear, precision: Packing, *, gelu: bool = False) -> None:
        super().__init__()
        self._activation = "gelu" if gelu else "none"
        self._dtype = torch.bfloat16 if precision == "bf16" else torch.float32
        weight = linear.weight.detach().to(self._dtype)
        assert _PACK is not None, "see can_pack"
        self._packed = _PACK(weight, PACKED_FOR_ROWS)
        self._bias = None if linear.bias is None else linear.bias.detach().to(self._dtype)

    def forward(self, x: Tensor) -> Tensor:
        """(..., in) -> (..., out) in the layer's precision, to which the input is converted."""
        assert _APPLY is not None, "see can_pack"
        return _APPLY(x.to(self._dtype), self._packed, self._bias, self._activation, [], "none")


def can_pack() -> bool:
    """Whether this PyTorch has oneDNN's packed layers."""
    return torch.backends.mkldnn.is_available() and _PACK is not None and _APPLY is not None


def can_pack_bf16() -> bool:
    """Whether oneDNN packs bf16 weights on this processor: with AVX-512 or AVX-NE-CONVERT, not with AVX2 alone."""
    return can_pack() and _BF16 is not None and bool(_BF16())


def has_bf16_matrix_units() -> bool:
    """Whether the processor has matrix units for bf16 (AMX), with which a bf16 layer takes less time than an fp32 one."""
    return can_pack_bf16() and bool(torch.cpu.get_capabilities().get("amx_bf16"))


def fastest_precision(width: int = 1024, n_calls: int = 8) -> Packing:
    """The faster precision on this machine, by timing a layer of `width` for about 20 ms; fp32 unless bf16 saves a quarter."""
    if not can_pack_bf16():
        return "fp32"
    x, linear, seconds = torch.zeros(PACKED_FOR_ROWS, width), nn.Linear(width, width), {}
    with torch.inference_mode():
        for precision in ("fp32", "bf16"):
            layer = OneDnnLinear(linear, precision)
            layer(x)
            start = time.perf_counter()
            for _ in range(n_calls):
                layer(x)
            seconds[precision] = time.perf_counter() - start
    return "bf16" if seconds["bf16"] < 0.75 * seconds["fp32"] else "fp32"


def pack(module: nn.Module, precision: Packing = "fp32") -> nn.Module:
    """Replace the linear layers of `module` in place, for inference only; returns it.

    bf16 halves the memory traffic and is faster where the processor has matrix units for it (AMX); it changes tokens.
    """
    if can_pack():
        _replace(module, precision)
    return module


def _replace(module: nn.Module, precision: Packing) -> None:
    children = list(module.named_children())
    for i, (name, child) in enumerate(children):
        if isinstance(child, nn.Linear) and min(child.weight.shape) >= SMALLEST:
            following = children[i + 1] if isinstance(module, nn.Sequential) and i + 1 < len(children) else None
            gelu = following is not None and isinstance(following[1], nn.GELU) and following[1].approximate == "none"
            setattr(module, name, OneDnnLinear(child, precision, gelu=gelu))
            if gelu and following is not None:
                setattr(module, following[0], nn.Identity())
        else:
            _replace(child, precision)
