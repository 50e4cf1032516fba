"""Parallel decoding against a fake model whose answer is known, and against its plain version."""

from __future__ import annotations

from itertools import pairwise

import torch
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.model.decode import DecodeSettings, decode, decode_plain
from mmm_core.model.schedule import masked_counts

K = 11
MASK = K + 2


def fixed_logits(ids: torch.Tensor, asked: torch.Tensor) -> torch.Tensor:
    """Logits that depend on position, codebook and on what is visible, the same for every row length."""
    _, L, C = ids.shape
    position = torch.arange(L).view(1, L, 1, 1)
    book = torch.arange(C).view(1, 1, C, 1)
    code = torch.arange(K).view(1, 1, 1, K)
    visible = torch.where(ids >= K, 0, ids)[..., None]
    left = torch.roll(visible, 1, 1)
    left[:, 0] = 0
    return (torch.sin(1.7 * position + 0.9 * book + 2.3 * code + 0.31 * left).float() * 3)[asked]


@given(st.integers(1, 30), st.integers(1, 12), st.sampled_from(["cosine", "linear"]))
def test_every_step_masks_fewer_and_the_first_masks_all(n: int, steps: int, schedule: str) -> None:
    counts = masked_counts(n, steps, schedule)
    assert counts[0] == n
    assert all(a > b >= 1 for a, b in pairwise(counts))
    assert len(counts) <= steps


def test_the_cosine_counts_are_the_papers() -> None:
    assert masked_counts(49, 10) == [49, 48, 46, 43, 39, 34, 28, 22, 15, 7]


@given(st.integers(1, 20), st.integers(1, 3), st.integers(0, 99), st.floats(0, 1), st.integers(0, 6), st.data())
def test_the_fast_decoder_equals_the_plain_one(
    L: int, C: int, seed: int, temperature: float, opening: int, data: st.DataObject
) -> None:
    ids = torch.randint(0, K, (2, L, C), generator=torch.Generator().manual_seed(seed))
    n = 2 * L * C
    hidden = torch.tensor(data.draw(st.lists(st.booleans(), min_size=n, max_size=n))).reshape(2, L, C)
    ids[hidden] = MASK
    settings = DecodeSettings(6, "cosine", temperature, opening)
    fast = decode(ids, fixed_logits, MASK, settings, [seed, seed + 1])
    assert torch.equal(fast, decode_plain(ids, fixed_logits, MASK, settings, [seed, seed + 1]))
    assert torch.equal(fast[~hidden], ids[~hidden]), "known tokens survive decoding"
    assert (fast < K).all(), "nothing stays masked"


@given(st.integers(1, 20), st.integers(0, 25), st.integers(0, 99))
def test_the_opening_is_what_is_likeliest_in_the_first_step(L: int, opening: int, seed: int) -> None:
    ids = torch.full((1, L, 2), MASK)
    likeliest = decode(ids, fixed_logits, MASK, DecodeSettings(1, "cosine", 0.0), [seed])
    for steps in (1, 6):
        made = decode(ids, fixed_logits, MASK, DecodeSettings(steps, "cosine", 1.0, opening), [seed])
        assert torch.equal(made[:, :opening], likeliest[:, :opening])


def test_a_batch_gives_each_row_what_it_gets_alone() -> None:
    ids = torch.full((3, 17, 2), MASK)
    settings = DecodeSettings(8, "cosine", 1.0)
    together = decode(ids, fixed_logits, MASK, settings, [5, 6, 7])
    alone = torch.cat([decode(ids[:1], fixed_logits, MASK, settings, [seed]) for seed in (5, 6, 7)])
    assert torch.equal(together, alone)


def test_exactly_the_scheduled_number_is_masked_at_each_step() -> None:
    seen: list[int] = []

    def logits_fn(ids: torch.Tensor, asked: torch.Tensor) -> torch.Tensor:
        seen.append(int((ids[..., 0] == MASK).sum()))
        return fixed_logits(ids, asked)

    decode(torch.full((1, 40, 3), MASK), logits_fn, MASK, DecodeSettings(10), [0])
    assert seen == masked_counts(40, 10)


def test_the_same_seed_gives_the_same_tokens_and_another_seed_others() -> None:
    ids = torch.full((1, 30, 3), MASK)
    settings = DecodeSettings(10, "cosine", 1.0)
    first, again, other = (decode(ids, fixed_logits, MASK, settings, [seed]) for seed in (1, 1, 2))
    assert torch.equal(first, again)
    assert not torch.equal(first, other)
