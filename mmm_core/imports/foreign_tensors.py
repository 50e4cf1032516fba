"""Checks tensors from files of other programs, before anything is computed or allocated from them.

A state dict can hold tensors that no layer can use (sparse, without data, complex, not finite), and shapes or block
numbers that ask for more memory than a machine has. Each is refused with the tensor's name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import torch
from torch import Tensor, nn

from mmm_core.errors import CheckpointError

State = dict[str, Tensor]


def check_tensors(state: Mapping[str, object], path: Path) -> State:
    """The tensors of `state`, each of them dense, real, finite and held in memory.

    Raises:
        CheckpointError: an entry is not such a tensor; the first one is named.
    """
    checked: State = {}
    for key, tensor in state.items():
        name = str(key)
        if not isinstance(tensor, Tensor):
            raise CheckpointError(path, name, f"a {type(tensor).__name__}", "a tensor")
        if found := _unusable(tensor):
            raise CheckpointError(path, name, found, "a dense tensor of finite real numbers")
        checked[name] = tensor
    return checked


def shape_of(state: State, key: str, n_dimensions: int, path: Path) -> torch.Size:
    """Shape of the tensor under `key`, from which sizes of a model are taken.

    Raises:
        CheckpointError: the tensor is missing, has another number of dimensions, or is empty.
    """
    if key not in state:
        raise CheckpointError(path, key, f"missing among {len(state)} tensors", "a checkpoint of the released model")
    shape = state[key].shape
    if len(shape) != n_dimensions:
        plural = "" if len(shape) == 1 else "s"
        raise CheckpointError(path, key, f"{len(shape)} dimension{plural}: {tuple(shape)}", f"{n_dimensions}")
    if 0 in shape:
        raise CheckpointError(path, key, f"empty: {tuple(shape)}", "at least one number")
    return shape


def n_blocks(state: State, prefix: str, path: Path) -> int:
    """Number of blocks in the keys below `prefix`, which must be numbered from 0 on without a gap.

    Raises:
        CheckpointError: a block has no plain decimal number, or there is a gap.
    """
    numbers: dict[str, str] = {}
    for key in state:
        if key.startswith(prefix):
            number = key.removeprefix(prefix).split(".")[0]
            if not re.fullmatch("0|[1-9][0-9]*", number):
                raise CheckpointError(path, key, f"block number {number!r}", f"{prefix}0, {prefix}1 and so on")
            numbers.setdefault(number, key)
    count = len(numbers)
    for number, key in numbers.items():
        if len(number) > len(str(count)) or int(number) >= count:
            raise CheckpointError(path, key, f"block {number[:20]} of {count}", f"blocks numbered 0 to {count - 1}")
    return count


def load_exactly(module: nn.Module, state: State, path: Path) -> None:
    """Fill `module` with `state`, which must hold each of its tensors in the module's shape and no other.

    Raises:
        CheckpointError: a tensor is missing, unknown to the module or of another shape.
    """
    wanted = module.state_dict()
    for name, tensor in wanted.items():
        if name not in state:
            raise CheckpointError(path, name, "missing", f"a tensor {tuple(tensor.shape)}")
        if state[name].shape != tensor.shape:
            raise CheckpointError(path, name, f"shape {tuple(state[name].shape)}", str(tuple(tensor.shape)))
    for name in state.keys() - wanted.keys():
        raise CheckpointError(path, name, "a tensor too many", f"{len(wanted)} tensors")
    module.load_state_dict(state)
    module.eval().requires_grad_(False)


def _unusable(tensor: Tensor) -> str:
    """The reason why no layer can use `tensor`; empty for a usable one."""
    if tensor.layout != torch.strided or tensor.is_nested or tensor.is_quantized:
        return f"stored as {'nested' if tensor.is_nested else tensor.dtype if tensor.is_quantized else tensor.layout}"
    if tensor.is_meta:
        return "on the meta device, without its numbers"
    if tensor.dtype not in (torch.float64, torch.float32, torch.float16, torch.bfloat16):
        return f"numbers of the type {str(tensor.dtype).removeprefix('torch.')}"
    n_stored = tensor.untyped_storage().nbytes() // tensor.element_size()
    if tensor.numel() > n_stored:
        return f"shape {tuple(tensor.shape)}, but the file holds {n_stored} numbers of it"
    if not torch.isfinite(tensor).all():
        return "not finite (NaN or infinity)"
    return ""
