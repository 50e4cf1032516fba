"""Linear layers in eight-bit integers: about twice as fast where the processor multiplies them (VNNI).

A weight is an integer times the scale of its output row. A layer's inputs are integers of one range, which is measured once
when the model is loaded, by running some texts through it; inputs outside the range are clipped. A range taken from each batch
would be simpler, but a row of tokens would then depend on its neighbours.

Measured on an Intel Xeon with AVX-512 VNNI, one thread, against packed fp32: the released size takes 0.81 instead of 2.15 s
(`mmmd bench official`), the shipped model 43 instead of 60 ms with everything around it (`mmmd bench generate`).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable

import torch
from torch import Tensor, nn

from mmm_core.inference.onednn_linear import SMALLEST

MARGIN = 1.1
"""Factor by which the range of a layer's inputs is wider than the measured one."""


# PyTorch offers eight-bit layers with floats in and out under these names alone, and means to drop the first in a later
# release; without it mmmd takes fp32. PyTorch's other eight-bit layers leave the rounding of inputs to several operators,
# which costs half of the gain.
_ROUND = getattr(torch, "quantize_per_channel", None)
_PACK = getattr(torch.ops.quantized, "linear_prepack", None)
_APPLY = getattr(torch.ops.quantized, "linear_with_input_q_dq_qweight_dq_output_fp32", None)


def int8_is_supported() -> bool:
    """Whether this PyTorch has eight-bit layers and the processor multiplies eight-bit integers (VNNI)."""
    has_vnni = any(on and name in ("avx512_vnni", "avx_vnni") for name, on in torch.cpu.get_capabilities().items())
    return has_vnni and _ROUND is not None and _PACK is not None and _APPLY is not None


class Int8Linear(nn.Module):
    """A linear layer for inference.

    Args:
        linear: the layer.
        low, high: range of the layer's inputs.
    """

    def __init__(self, linear: nn.Linear, low: float, high: float) -> None:
        super().__init__()
        assert _ROUND is not None and _PACK is not None, "see int8_is_supported"
        low, high = min(low, 0.0), max(high, 0.0)  # nought is always an integer
        self._scale = max((high - low) / 255, 1e-8)
        self._zero = min(255, max(0, round(-low / self._scale)))
        weight = linear.weight.detach()
        scales = (weight.abs().amax(1) / 127).clamp_min(1e-8).double()
        zeros = torch.zeros(len(scales), dtype=torch.int64)
        with warnings.catch_warnings(action="ignore", category=UserWarning):
            integers = _ROUND(weight, scales, zeros, 0, torch.qint8)
        self._packed = _PACK(integers, None if linear.bias is None else linear.bias.detach())

    def forward(self, x: Tensor) -> Tensor:
        """(..., in) -> (..., out), float32 on both sides."""
        assert _APPLY is not None, "see int8_is_supported"
        return _APPLY(x, self._scale, self._zero, self._packed)


def convert_to_int8(module: nn.Module, run: Callable[[], object]) -> nn.Module:
    """Replace the linear layers of `module` in place, for inference only; returns it.

    Args:
        module: holds the layers.
        run: runs typical inputs through `module`; inputs outside their range are clipped later on. A layer that `run` does
            not reach stays as it is.
    """
    layers = {n: m for n, m in module.named_modules() if isinstance(m, nn.Linear) and min(m.weight.shape) >= SMALLEST}
    ranges = dict.fromkeys(layers, (math.inf, -math.inf))

    def watch(name: str) -> Callable[[nn.Module, tuple[Tensor]], None]:
        def note(_: nn.Module, inputs: tuple[Tensor]) -> None:
            low, high = (float(edge) for edge in inputs[0].detach().aminmax())
            ranges[name] = min(low, ranges[name][0]), max(high, ranges[name][1])

        return note

    hooks = [layer.register_forward_pre_hook(watch(name)) for name, layer in layers.items()]
    try:
        run()
    finally:
        for hook in hooks:
            hook.remove()
    for name, layer in layers.items():
        low, high = ranges[name]
        if low <= high:
            parent, _, child = name.rpartition(".")
            setattr(module.get_submodule(parent), child, Int8Linear(layer, MARGIN * low, MARGIN * high))
    return module
