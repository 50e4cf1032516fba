"""Low-rank changes of a module's matrices: a variant of its weights that takes a fraction of their size.

LoRA (arXiv 2106.09685, eq. 3): a matrix W (M, N) becomes W + B A with B (M, R) and A (R, N). All of them begin with B = 0, so
that a new change is none. The module's own weights stay as they are while A and B are trained.
"""

from __future__ import annotations

from collections.abc import Mapping

import torch
from torch import Tensor, nn
from torch.nn.utils import parametrize

_UP, _DOWN = ".up", ".down"
_PARAMETRIZATION = ".parametrizations.weight.0"


class LowRankChange(nn.Module):
    """W -> W + B A, as a parametrization of one matrix."""

    def __init__(self, matrix: Tensor, rank: int) -> None:
        super().__init__()
        self.up = nn.Parameter(matrix.new_zeros(matrix.shape[0], rank))
        self.down = nn.Parameter(torch.randn(rank, matrix.shape[1]) * matrix.shape[1] ** -0.5)

    def forward(self, matrix: Tensor) -> Tensor:
        """(M, N) -> (M, N)."""
        return matrix + self.up @ self.down


def add_changes(module: nn.Module, rank: int) -> None:
    """Give every linear layer in `module` a change of `rank`, and leave nothing else to be trained."""
    module.requires_grad_(False)
    for layer in list(module.modules()):
        if isinstance(layer, nn.Linear):
            parametrize.register_parametrization(layer, "weight", LowRankChange(layer.weight, rank))


def changes_of(module: nn.Module) -> dict[str, Tensor]:
    """The factors of all changes: NAME.up (M, R) and NAME.down (R, N) for the layer NAME."""
    found: dict[str, Tensor] = {}
    for name, change in module.named_modules():
        if isinstance(change, LowRankChange):
            layer = name.removesuffix(_PARAMETRIZATION)
            found |= {layer + _UP: change.up.detach(), layer + _DOWN: change.down.detach()}
    return found


def apply_changes(module: nn.Module, factors: Mapping[str, Tensor]) -> None:
    """Add the changes of `changes_of` to the weights of an unchanged module."""
    with torch.no_grad():
        for name, up in factors.items():
            if name.endswith(_UP):
                layer = name.removesuffix(_UP)
                module.get_submodule(layer).weight += up.float() @ factors[layer + _DOWN].float()  # type: ignore[operator]
