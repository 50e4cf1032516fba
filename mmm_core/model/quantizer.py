"""Vector quantisation with a codebook kept by moving averages.

MMM (arXiv 2312.03596) eq. 1; EMA update of VQ-VAE (arXiv 1711.00937) appendix A.1; "factorised" means that the code
dimension is small (16 or 32), so that few codes stay unused.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from mmm_core import distributed

DECAY = 0.99
"""Share of a moving average that stays in each update."""
DEAD_BELOW = 0.3
"""Uses per batch, as a moving average, below which a code is dead and is moved to a random latent of the batch."""
RESET_EVERY = 20
"""Updates between two resets of dead codes."""


class Quantizer(nn.Module):
    """(N, D) latents to the nearest of K codes.

    The buffers `uses` (K,) and `sums` (K, D) are the moving averages that define the buffer `codebook` (K, D).
    """

    codebook: Tensor
    uses: Tensor
    sums: Tensor
    n_updates: Tensor

    def __init__(self, n_codes: int, code_dim: int) -> None:
        super().__init__()
        self.register_buffer("codebook", torch.randn(n_codes, code_dim))
        self.register_buffer("uses", torch.zeros(n_codes))
        self.register_buffer("sums", torch.zeros(n_codes, code_dim))
        self.register_buffer("n_updates", torch.zeros((), dtype=torch.int64))

    def encode(self, latents: Tensor) -> Tensor:
        """Nearest code of each latent: (..., D) -> (...) int64."""
        flat = latents.reshape(-1, latents.shape[-1]).float()
        with torch.autocast(flat.device.type, enabled=False):
            distance = self.codebook.square().sum(1) - 2 * flat @ self.codebook.T  # |x|^2 is equal for all codes
        return distance.argmin(1).reshape(latents.shape[:-1])

    def forward(self, latents: Tensor) -> tuple[Tensor, Tensor]:
        """Quantised latents with straight-through gradient, and the commitment loss.

        In training mode the codebook is first updated from this batch, as all processes have it.
        """
        latents = latents.float()
        if self.training:
            self._update(distributed.gathered(latents.detach()).flatten(0, -2))
        quantised = F.embedding(self.encode(latents.detach()), self.codebook)
        commitment = F.mse_loss(latents, quantised)
        return latents + (quantised - latents).detach(), commitment

    @torch.no_grad()
    def take_uses(self, latents: Tensor, n_each: int) -> None:
        """Set the moving averages to the values that batches of `n_each` latents, distributed like `latents` (N, D), lead to."""
        uses = torch.bincount(self.encode(latents), minlength=len(self.codebook)).float()
        self.uses.copy_(uses * n_each / len(latents))
        self.sums.copy_(self.uses[:, None] * self.codebook)
        self.n_updates.fill_(1)

    @torch.no_grad()
    def _update(self, flat: Tensor) -> None:
        """Update the codebook by one EMA step; the first call takes codes from the batch; dead codes are reset each time."""
        n_codes = len(self.codebook)
        if int(self.n_updates) == 0:
            self.codebook.copy_(_pick(flat, n_codes))
            self.sums.copy_(self.codebook)
            self.uses.fill_(1.0)
        ids = self.encode(flat)
        uses = torch.bincount(ids, minlength=n_codes).to(flat.dtype)
        sums = torch.zeros_like(self.sums).index_add_(0, ids, flat)
        self.uses.mul_(DECAY).add_(uses, alpha=1 - DECAY)
        self.sums.mul_(DECAY).add_(sums, alpha=1 - DECAY)
        self.n_updates += 1
        if int(self.n_updates) % RESET_EVERY == 0:
            dead = self.uses < DEAD_BELOW
            replacement = _pick(flat, int(dead.sum()))
            self.uses[dead] = 1.0
            self.sums[dead] = replacement
        self.codebook.copy_(self.sums / self.uses.clamp_min(1e-6)[:, None])
        distributed.from_first([self.codebook, self.uses, self.sums])


class OfficialRuleQuantizer(Quantizer):
    """The released training's rule, kept for comparison (an option of `VqVaeConfig`).

    It differs in three ways: codes are chosen before the codebook moves; the first batch's rows become the first codes
    in their order; and a code that was used once (`ever_used`) is never reset again, however dead it is.
    """

    ever_used: Tensor

    def __init__(self, n_codes: int, code_dim: int) -> None:
        super().__init__(n_codes, code_dim)
        self.register_buffer("ever_used", torch.zeros(n_codes, dtype=torch.bool))

    def forward(self, latents: Tensor) -> tuple[Tensor, Tensor]:
        """Quantised latents and commitment loss, as `Quantizer.forward`; the codebook is updated after the codes are chosen."""
        latents = latents.float()
        whole = distributed.gathered(latents.detach()).flatten(0, -2) if self.training else latents
        if self.training and int(self.n_updates) == 0:
            self.codebook.copy_(_fill(whole, len(self.codebook)))
            self.sums.copy_(self.codebook)
            self.uses.fill_(1.0)
        quantised = F.embedding(self.encode(latents.detach()), self.codebook)
        if self.training:
            self._move(whole, self.encode(whole))
        return latents + (quantised - latents).detach(), F.mse_loss(latents, quantised)

    @torch.no_grad()
    def _move(self, flat: Tensor, ids: Tensor) -> None:
        n_codes = len(self.codebook)
        self.uses.mul_(DECAY).add_(torch.bincount(ids, minlength=n_codes).to(flat.dtype), alpha=1 - DECAY)
        self.sums.mul_(DECAY).add_(torch.zeros_like(self.sums).index_add_(0, ids, flat), alpha=1 - DECAY)
        used = self.uses >= 1
        candidate = self.sums / self.uses[:, None]
        self.n_updates += 1
        if int(self.n_updates) % (RESET_EVERY + 1) == 0:
            dead = ~(self.ever_used | used)
            shuffled = flat[torch.randperm(len(flat)).to(flat.device)]
            candidate = torch.where(dead[:, None], _fill(shuffled, n_codes), candidate)
        else:
            self.ever_used |= used
        self.codebook.copy_(candidate)
        distributed.from_first([self.codebook, self.uses, self.sums])


def perplexity(ids: Tensor, n_codes: int) -> Tensor:
    """Effective number of codes that a batch uses: exp of the entropy of the code frequencies."""
    share = torch.bincount(ids.reshape(-1), minlength=n_codes).float()
    share = share / share.sum()
    return torch.exp(-(share * (share + 1e-7).log()).sum())


def _fill(flat: Tensor, n: int) -> Tensor:
    """The first n rows of `flat`; too few rows are tiled with a little noise."""
    if len(flat) >= n:
        return flat[:n]
    tiled = flat.repeat(-(-n // len(flat)), 1)[:n]
    return tiled + 0.01 / flat.shape[1] ** 0.5 * torch.randn(tiled.shape).to(tiled)


def _pick(flat: Tensor, n: int) -> Tensor:
    """N random rows of `flat`, drawn with replacement, with a little noise."""
    index = torch.randint(len(flat), (n,)).to(flat.device)
    return flat[index] + 1e-3 * torch.randn(n, flat.shape[1]).to(flat)
