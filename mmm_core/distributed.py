"""Several processes, one training: each takes its share of every batch, and gradients are averaged.

Started by torchrun, which sets RANK, WORLD_SIZE and where the first process is. All processes draw the same whole batch
from the same seed and keep every n-th row, so n processes take the steps that one would take with the whole batch.
Without torchrun everything here does nothing.
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
    """Rows of a batch that are this process's; what does not divide evenly is left out."""
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
    """(N, ...) rows of all processes in the order of the whole batch: (world * N, ...)."""
    if world() == 1:
        return rows
    parts = [torch.empty_like(rows) for _ in range(world())]
    dist.all_gather(parts, rows.contiguous())
    return torch.stack(parts, 1).flatten(0, 1)


def from_first(tensors: Iterable[Tensor]) -> None:
    """Take the first process's values, in place."""
    if world() > 1:
        for tensor in tensors:
            dist.broadcast(tensor, 0)


def wait() -> None:
    """Wait until all processes are here."""
    if world() > 1:
        dist.barrier()
