"""Runs a training: keeps its state in a folder, from which it can be resumed, and shows a progress bar and a CSV log.

Every step draws from its own random seed, so a run that was interrupted, even killed, and resumed gives the result of an
uninterrupted one. On a GPU this holds up to the order of sums.
"""

from __future__ import annotations

import csv
import math
import os
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import torch
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from torch import Tensor, nn

from mmm_core import distributed
from mmm_core.errors import CheckpointError, TrainingDataError

LossFn = Callable[[int, torch.Generator], dict[str, Tensor]]
"""(step, generator) -> losses of this process's share, by name; "loss" is minimised, the others are logged."""
LOG_EVERY = 20
"""Steps between two lines of the log."""


@dataclass(frozen=True)
class Schedule:
    """Steps, learning rate and seed of a training.

    Attributes:
        steps: optimiser steps.
        learning_rate: highest learning rate.
        warmup_steps: steps in which the rate rises linearly.
        shape: "cosine" lets the rate fall to `final_share`; "drop" keeps it until two thirds of the steps and then drops it
            (MMM's own schedule).
        final_share: share of the learning rate at the end.
        weight_decay: weight decay of AdamW.
        betas: betas of AdamW.
        clip_norm: greatest norm of the gradient; 0 does not clip.
        ema_decay: decay of the averaged weights, which the model ends with; 0 keeps the last weights.
        save_every: steps between saved states.
        seed: seed of all randomness in this stage.
    """

    steps: int
    learning_rate: float = 8e-4
    warmup_steps: int = 100
    shape: Literal["cosine", "drop"] = "cosine"
    final_share: float = 0.05
    weight_decay: float = 0.01
    betas: tuple[float, float] = (0.9, 0.98)
    clip_norm: float = 1.0
    ema_decay: float = 0.998
    save_every: int = 200
    seed: int = 0

    def rate(self, step: int) -> float:
        """Learning rate at `step`."""
        if step < self.warmup_steps:
            return self.learning_rate * (step + 1) / self.warmup_steps
        if self.shape == "drop":
            return self.learning_rate * (self.final_share if 3 * step >= 2 * self.steps else 1.0)
        progress = min(1.0, (step - self.warmup_steps) / max(1, self.steps - self.warmup_steps))
        return self.learning_rate * (self.final_share + (1 - self.final_share) * (1 + math.cos(math.pi * progress)) / 2)


@dataclass(frozen=True)
class Run:
    """Folder, device and options of a run.

    Attributes:
        folder: folder of states, CSV logs and samples.
        device: "cpu", "cuda" or "cuda:N".
        precision: number format of matrix products; weights and averages stay fp32.
        sample_every: steps between samples; 0 for none.
        tensorboard: whether TensorBoard events are written beside the CSV (extra `train`).
        sampler: writes a sample of the model to a path; None writes none.
    """

    folder: Path
    device: str = "cpu"
    precision: Literal["fp32", "bf16"] = "fp32"
    sample_every: int = 0
    tensorboard: bool = False
    sampler: Callable[[nn.Module, Path], None] | None = field(default=None, compare=False)

    @property
    def torch_device(self) -> torch.device:
        """The device, checked.

        Raises:
            TrainingDataError: the device does not exist.
        """
        if self.device.startswith("cuda") and not torch.cuda.is_available():
            raise TrainingDataError(self.folder, "run.device", f"'{self.device}', but no CUDA device is here", "cpu")
        try:
            return torch.device(self.device)
        except RuntimeError:
            raise TrainingDataError(self.folder, "run.device", repr(self.device), "cpu, cuda, cuda:N") from None


def train(
    module: nn.Module,
    loss_fn: LossFn,
    schedule: Schedule,
    run: Run,
    name: str,
    slower: Mapping[str, float] | None = None,
) -> nn.Module:
    """Train `module` in place and leave it on the CPU with its averaged weights, in evaluation mode.

    State is kept in `folder/name.pt` (weights, averages, optimiser, step) and `folder/name.csv`; an interrupted run
    continues from there, a finished one is only loaded. `slower` gives a share of the learning rate for parameters whose names
    begin with a key.

    Raises:
        CheckpointError: the state cannot be read, or cannot be written (the older one stays whole).
    """
    run.folder.mkdir(parents=True, exist_ok=True)
    device = run.torch_device
    distributed.start(device)
    module.to(device)
    distributed.from_first(module.state_dict().values())
    state_file = run.folder / f"{name}.pt"
    by_share = _by_share(module, slower or {})
    parameters = [p for group in by_share.values() for p in group]
    groups = [{"params": group} for group in by_share.values()]
    optimiser = torch.optim.AdamW(groups, schedule.learning_rate, schedule.betas, weight_decay=schedule.weight_decay)
    averages = [p.detach().clone() for p in parameters]
    first = 0
    if state_file.is_file():
        state = _read(state_file, device)
        module.load_state_dict(state["module"])
        optimiser.load_state_dict(state["optimiser"])
        averages, first = state["averages"], state["step"]
    log = _Log(run, name, first, schedule.steps)
    module.train()
    with log:
        for step in range(first, schedule.steps):
            torch.manual_seed(schedule.seed * 1_000_003 + step)
            generator = torch.Generator().manual_seed(schedule.seed * 1_000_003 + step + 1)
            for share, group in zip(by_share, optimiser.param_groups, strict=True):
                group["lr"] = share * schedule.rate(step)
            with torch.autocast(device.type, torch.bfloat16, enabled=run.precision == "bf16"):
                losses = loss_fn(step, generator)
            optimiser.zero_grad(set_to_none=True)
            losses["loss"].backward()  # type: ignore[no-untyped-call]
            distributed.average(p.grad for p in parameters if p.grad is not None)
            if schedule.clip_norm:
                nn.utils.clip_grad_norm_(parameters, schedule.clip_norm)
            optimiser.step()
            decay = min(schedule.ema_decay, (step + 1) / (step + 10))
            with torch.no_grad():
                for average, parameter in zip(averages, parameters, strict=True):
                    average.lerp_(parameter, 1 - decay)
            last = step + 1 == schedule.steps
            log.step(step, losses, always=last)
            if (step + 1) % schedule.save_every == 0 or last:
                _save(state_file, {"module": module.state_dict(), "optimiser": optimiser.state_dict(),
                                   "averages": averages, "step": step + 1})  # fmt: skip
            if run.sampler and run.sample_every and (step + 1) % run.sample_every == 0 and distributed.rank() == 0:
                module.eval()
                run.sampler(module, run.folder / "samples" / f"{name}_{step + 1:06d}.png")
                module.train()
    with torch.no_grad():
        for parameter, average in zip(parameters, averages, strict=True):
            parameter.copy_(average)
    return module.cpu().eval()


def _by_share(module: nn.Module, slower: Mapping[str, float]) -> dict[float, list[nn.Parameter]]:
    """Parameters by their share of the learning rate; first come the ones with the whole rate."""
    by_share: dict[float, list[nn.Parameter]] = {1.0: []}
    for name, parameter in module.named_parameters():
        share = next((s for beginning, s in slower.items() if name.startswith(beginning)), 1.0)
        if parameter.requires_grad:
            by_share.setdefault(share, []).append(parameter)
    return by_share


class _Log:
    """Progress bar, CSV log and optional TensorBoard events; only the first process writes them."""

    def __init__(self, run: Run, name: str, first: int, steps: int) -> None:
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self._quiet = distributed.rank() != 0
        self._progress = Progress(*columns, disable=self._quiet)
        self._task = self._progress.add_task(name, total=steps, completed=first)
        self._name, self._path, self._first = name, run.folder / f"{name}.csv", first
        self._board = _board(run, name) if run.tensorboard and not self._quiet else None
        self._started = time.monotonic()

    def __enter__(self) -> _Log:
        self._progress.start()
        self._file = Path(os.devnull if self._quiet else self._path).open("a", newline="")
        self._csv = csv.writer(self._file)
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()
        self._file.close()
        if self._board is not None:
            self._board.close()

    def step(self, step: int, losses: dict[str, Tensor], *, always: bool) -> None:
        """Count a step; every `LOG_EVERY` steps, and if `always`, write the mean values over all processes."""
        if step % LOG_EVERY == 0 or always:
            means = torch.stack([v.detach().float() for v in losses.values()])
            distributed.average([means])
            values = dict(zip(losses, means.tolist(), strict=True))
            seconds = time.monotonic() - self._started
            if step == 0:
                self._csv.writerow(["step", "seconds", *values])
            self._csv.writerow([step, f"{seconds:.1f}", *(f"{v:.6f}" for v in values.values())])
            self._file.flush()
            for key, value in values.items() if self._board is not None else ():
                self._board.add_scalar(f"{self._name}/{key}", value, step)  # type: ignore[union-attr]
            speed = (step + 1 - self._first) / max(seconds, 1e-9)
            text = " ".join(f"{key} {value:.3f}" for key, value in values.items())
            self._progress.update(self._task, description=f"{self._name} {text}, {speed:.1f} steps/s")
        self._progress.update(self._task, advance=1)


def _board(run: Run, name: str) -> Any:
    try:
        from torch.utils.tensorboard import SummaryWriter
    except ImportError:
        found = "tensorboard is not installed"
        raise TrainingDataError(run.folder, "run.tensorboard", found, "pip install '.[train]', or false") from None
    return SummaryWriter(str(run.folder / "tensorboard" / name))  # type: ignore[no-untyped-call]


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Context with a temporary path; when it ends without an error, the file there replaces `path` at once.

    Raises:
        CheckpointError: the file could not be written; an older one is whole.
    """
    partial = path.with_name(f"partial_{path.name}")
    try:
        yield partial
        os.replace(partial, path)
    except (OSError, RuntimeError) as error:
        partial.unlink(missing_ok=True)
        kept = "the state of an earlier step is whole" if path.is_file() else "there is no earlier state"
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(path, "", f"could not be written ({first}); {kept}", "room on the disk") from error


def _save(path: Path, state: dict[str, Any]) -> None:
    if distributed.rank() == 0:
        with written_whole(path) as partial:
            torch.save(state, partial)
    distributed.wait()


def _read(path: Path, device: torch.device) -> dict[str, Any]:
    try:
        return torch.load(path, map_location=device, weights_only=True)
    except Exception as error:
        first = str(error).split("\n", 1)[0]
        raise CheckpointError(
            path, "", f"not a readable state ({first})", "a run's own; delete it to begin anew"
        ) from error
