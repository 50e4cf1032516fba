"""A training run: a folder with its state, resumable at any step, a progress bar and a CSV log.

Every step draws from its own random seed, so a run that was cut and goes on gives the same result as one that was not.
"""

from __future__ import annotations

import csv
import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import torch
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from torch import Tensor, nn

LossFn = Callable[[int, torch.Generator], dict[str, Tensor]]
"""(step, generator) -> losses; the one called "loss" is minimised."""


@dataclass(frozen=True)
class Schedule:
    """How long and how fast to train."""

    steps: int
    learning_rate: float = 8e-4
    warmup_steps: int = 100
    final_share: float = 0.05
    weight_decay: float = 0.01
    betas: tuple[float, float] = (0.9, 0.98)
    clip_norm: float = 1.0
    ema_decay: float = 0.998
    save_every: int = 200
    seed: int = 0

    def rate(self, step: int) -> float:
        """Learning rate at `step`: linear warm-up, then a cosine down to `final_share`."""
        if step < self.warmup_steps:
            return self.learning_rate * (step + 1) / self.warmup_steps
        progress = min(1.0, (step - self.warmup_steps) / max(1, self.steps - self.warmup_steps))
        return self.learning_rate * (self.final_share + (1 - self.final_share) * (1 + math.cos(math.pi * progress)) / 2)


def train(module: nn.Module, loss_fn: LossFn, schedule: Schedule, run_dir: Path, name: str) -> nn.Module:
    """Train `module` in place and leave it with its averaged weights, in evaluation mode.

    State is kept in `run_dir/name.pt` (weights, averages, optimiser, step) and `run_dir/name.csv`; an interrupted run
    goes on from there, a finished one is only loaded.
    """
    run_dir.mkdir(parents=True, exist_ok=True)
    state_file = run_dir / f"{name}.pt"
    parameters = [p for p in module.parameters() if p.requires_grad]
    optimiser = torch.optim.AdamW(
        parameters, schedule.learning_rate, schedule.betas, weight_decay=schedule.weight_decay
    )
    averages = [p.detach().clone() for p in parameters]
    first = 0
    if state_file.is_file():
        state = torch.load(state_file, weights_only=True)
        module.load_state_dict(state["module"])
        optimiser.load_state_dict(state["optimiser"])
        averages, first = state["averages"], state["step"]

    def save(step: int) -> None:
        partial = state_file.with_suffix(".part")
        state = {"module": module.state_dict(), "optimiser": optimiser.state_dict(), "averages": averages, "step": step}
        torch.save(state, partial)
        os.replace(partial, state_file)

    module.train()
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns) as progress, (run_dir / f"{name}.csv").open("a", newline="") as log_file:
        log = csv.writer(log_file)
        task = progress.add_task(name, total=schedule.steps, completed=first)
        started = time.monotonic()
        for step in range(first, schedule.steps):
            torch.manual_seed(schedule.seed * 1_000_003 + step)
            generator = torch.Generator().manual_seed(schedule.seed * 1_000_003 + step + 1)
            for group in optimiser.param_groups:
                group["lr"] = schedule.rate(step)
            losses = loss_fn(step, generator)
            optimiser.zero_grad(set_to_none=True)
            losses["loss"].backward()  # type: ignore[no-untyped-call]
            nn.utils.clip_grad_norm_(parameters, schedule.clip_norm)
            optimiser.step()
            decay = min(schedule.ema_decay, (step + 1) / (step + 10))
            with torch.no_grad():
                for average, parameter in zip(averages, parameters, strict=True):
                    average.lerp_(parameter, 1 - decay)
            if step % 20 == 0 or step + 1 == schedule.steps:
                values = {key: float(value.detach()) for key, value in losses.items()}
                log.writerow([step, f"{time.monotonic() - started:.1f}", *(f"{v:.5f}" for v in values.values())])
                log_file.flush()
                text = " ".join(f"{key} {value:.3f}" for key, value in values.items())
                progress.update(task, description=f"{name} {text}")
            progress.update(task, advance=1)
            if (step + 1) % schedule.save_every == 0 or step + 1 == schedule.steps:
                save(step + 1)
    with torch.no_grad():
        for parameter, average in zip(parameters, averages, strict=True):
            parameter.copy_(average)
    return module.eval()
