"""Trains layers that begin as copies of the text encoder's upper layers, and the linear layers above them."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mmm_core.model.text import MiniLm

log = logging.getLogger(__name__)

WEIGHT_DECAY = 0.02
_LEAST_RATE, _LARGEST_GRADIENT = 0.02, 1.0
_LOG_EVERY = 50


@dataclass(frozen=True)
class Rates:
    """Learning rates of the copied layers and of the linear layers, and the steps in which they rise."""

    layers: float
    linear: float
    warm_up: int


def copy_layers(own: nn.ModuleList, encoder: MiniLm, n_shared: int) -> None:
    """Give layers the weights of the encoder's layers after the first `n_shared`."""
    for layer, of_encoder in zip(own, encoder.layers[n_shared:], strict=False):
        layer.load_state_dict(of_encoder.state_dict())


def fit(model: nn.Module, layers: nn.ModuleList, loss_of: Callable[[int], Tensor], rates: Rates, steps: int) -> None:
    """Train a model with AdamW; the rates rise, then fall linearly. Its parameters are frozen at the end.

    Args:
        model: the model.
        layers: its copied layers; all its other parameters count as linear layers.
        loss_of: the loss of the batch of a step.
        rates: learning rates.
        steps: optimisation steps.
    """
    copied = list(layers.parameters())
    known = {id(parameter) for parameter in copied}
    linear = [parameter for parameter in model.parameters() if id(parameter) not in known]
    optimiser = torch.optim.AdamW(
        [{"params": copied, "lr": rates.layers}, {"params": linear, "lr": rates.linear}], weight_decay=WEIGHT_DECAY
    )
    schedule = torch.optim.lr_scheduler.LambdaLR(
        optimiser, lambda step: min(1.0, (step + 1) / rates.warm_up) * max(_LEAST_RATE, 1 - step / steps)
    )
    model.requires_grad_(True).train()
    for step in range(steps):
        loss = loss_of(step)
        optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(model.parameters(), _LARGEST_GRADIENT)
        optimiser.step()
        schedule.step()
        if (step + 1) % _LOG_EVERY == 0:
            log.info("step %d of %d, loss %.3f", step + 1, steps, float(loss.detach()))
    model.eval().requires_grad_(False)
