"""Low-rank changes: none at first, exactly W + B A when they are applied, and alone in what is trained."""

from __future__ import annotations

import pytest
import torch
from torch import nn

from mmm_core.model.low_rank import add_changes, apply_changes, changes_of


def small() -> nn.Sequential:
    """Two linear layers, the first with a bias."""
    torch.manual_seed(3)
    return nn.Sequential(nn.Linear(6, 5), nn.LayerNorm(5), nn.Linear(5, 4, bias=False))


def changed(rank: int) -> tuple[nn.Sequential, nn.Sequential]:
    """A module, and the same with a change that is not none."""
    plain, other = small(), small()
    add_changes(other, rank)
    return plain, other


def test_a_new_change_changes_nothing() -> None:
    plain, other = changed(2)
    x = torch.randn(7, 6)
    torch.testing.assert_close(other(x), plain(x), rtol=0, atol=0)


@pytest.mark.parametrize("rank", [1, 3, 8])
def test_applied_changes_are_those_that_were_trained(rank: int) -> None:
    plain, other = changed(rank)
    for parameter in other.parameters():
        if parameter.requires_grad:
            nn.init.normal_(parameter)
    factors = changes_of(other)
    assert {name: tuple(f.shape) for name, f in factors.items()} == {
        "0.up": (5, rank), "0.down": (rank, 6), "2.up": (4, rank), "2.down": (rank, 5),
    }  # fmt: skip
    expected = plain[0].weight + factors["0.up"] @ factors["0.down"]
    x = torch.randn(7, 6)
    wanted = other(x)
    assert not torch.allclose(plain(x), wanted)
    apply_changes(plain, factors)
    torch.testing.assert_close(plain[0].weight, expected)
    torch.testing.assert_close(plain(x), wanted)


def test_only_the_changes_are_trained() -> None:
    plain, other = changed(2)
    trained = [p for p in other.parameters() if p.requires_grad]
    optimiser = torch.optim.AdamW(trained, lr=0.1)
    for _ in range(3):
        optimiser.zero_grad()
        other(torch.randn(7, 6)).square().sum().backward()
        optimiser.step()
    assert len(trained) == 4 and all(p.grad is not None for p in trained)
    kept = {name.replace("parametrizations.weight.original", "weight"): t for name, t in other.state_dict().items()}
    for name, tensor in plain.state_dict().items():
        assert torch.equal(kept[name], tensor), name
    assert not torch.allclose(other[0].weight, plain[0].weight)
