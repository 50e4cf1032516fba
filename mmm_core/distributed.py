"""Trains with several processes: each takes its share of every batch, and gradients are averaged.

torchrun starts the processes and sets RANK, WORLD_SIZE and the address of the first process. All processes draw the same
whole batch from the same seed and keep every n-th row, so n processes take the steps that one would take with the whole
batch. Without torchrun the functions of this module do nothing.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

import torch
from torch import Tensor
from torch import distributed as dist


def start(device: torch.device) -> None:
    """Join the other processes, if torchrun started this one."""
    if int(os.environ.get("WORLD_SIZE", "1")) > 1 and not dist.is_initialized():
        dist.init_process_group("nccl" if device.type == "cuda" else "gloo")


def rank() -> int:
    """Number of this process; 0 saves and logs."""
    return dist.get_rank() if dist.is_initialized() else 0


def world() -> int:
    """Number of processes."""
    return dist.get_world_size() if dist.is_initialized() else 1


def share(rows: int) -> slice:
    """Rows of a batch that belong to this process; a remainder that does not divide evenly is left out."""
    return slice(rank(), rows // world() * world(), world())


def average(tensors: Iterable[Tensor]) -> None:
    """Replace tensors by their mean over all processes, in place."""
    if world() == 1:
        return
    several = list(tensors)
    flat = torch.cat([t.reshape(-1) for t in several])
    dist.all_reduce(flat)
    flat /= world()
    for tensor, part in zip(several, flat.split([t.numel() for t in several]), strict=True):
        tensor.copy_(part.reshape(tensor.shape))


def gathered(rows: Tensor) -> Tensor:
    """(world * N, ...) rows of all processes in the order of the whole batch, from each one's (N, ...) rows."""
    if world() == 1:
        return rows
    parts = [torch.empty_like(rows) for _ in range(world())]
    dist.all_gather(parts, rows.contiguous())
    return torch.stack(parts, 1).flatten(0, 1)


def from_first(tensors: Iterable[Tensor]) -> None:
    """Replace tensors by those of the first process, in place."""
    if world() > 1:
        for tensor in tensors:
            dist.broadcast(tensor, 0)


def wait() -> None:
    """Wait until all processes have called this function."""
    if world() > 1:
        dist.barrier()
