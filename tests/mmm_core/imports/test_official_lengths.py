"""Every length and every edit of the released model: the fast sampler gives the ids of the plain one.

The released sampler computes the numbers of masked positions in single precision. Ours took double precision, and texts of
14, 16, 28, 30, 42, 44 and 46 tokens (upper body: 8, 14, 22, 30, 36 and 44) and a sixth of all edits came out with other ids.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest
import torch
from torch import Tensor

from mmm_core.imports.official import tokenizer_from_official, transformer_from_official
from mmm_core.model.decode import NoiseFn
from mmm_core.model.released_sampler import masked_counts_by_torch, sample_plainly
from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill
from mmm_core.model.schedule import official_counts
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import MotionTransformer
from tests.support.golden import GOLDEN, golden, needs_golden
from tests.support.official import SAMPLES, recorded_noise, text_of
from tests.support.sizes import few_and_long, some_and_all

TABLE = Path(__file__).parent / "released_counts.txt"
LENGTHS = range(1, 50)
SOME_LENGTHS = (1, 2, 3, 8, 14, 15, 16, 22, 28, 29, 30, 36, 44, 46, 49)
"""The ends, and lengths that once came out with other ids."""
by_lengths = pytest.mark.parametrize("lengths", some_and_all(SOME_LENGTHS, LENGTHS))


def table() -> dict[tuple[int, int], list[int]]:
    """(steps, tokens) -> masked positions before each step, a batch of several."""
    lines = [line.split(":") for line in TABLE.read_text().splitlines() if line and not line.startswith("#")]
    return {(int(a.split()[0]), int(a.split()[1])): [int(n) for n in b.split()] for a, b in lines}


class TestCounts:
    @pytest.mark.parametrize("max_steps", [10, 20])
    def test_the_table_of_lengths(self, max_steps: int) -> None:
        rows = {n: counts for (steps, n), counts in table().items() if steps == max_steps}
        assert set(rows) == set(LENGTHS)
        for n_tokens, counts in rows.items():
            assert official_counts(n_tokens, n_tokens, max_steps=max_steps) == counts

    @pytest.mark.parametrize("max_steps", few_and_long([10], [10, 20]))
    @pytest.mark.parametrize("early_exit", [False, True])
    @by_lengths
    def test_every_number_of_open_positions(self, max_steps: int, early_exit: bool, lengths: tuple[int, ...]) -> None:
        """All 1,225 pairs of open positions and tokens in the soak run."""
        for n_tokens in lengths:
            for n_open in range(1, n_tokens + 1):
                how = {"max_steps": max_steps, "early_exit": early_exit}
                assert official_counts(n_open, n_tokens, **how) == masked_counts_by_torch(n_open, n_tokens, **how)

    def test_at_two_thirds_one_position_less_than_half(self) -> None:
        assert official_counts(14, 14, early_exit=True) == [14, 12, 6]
        assert official_counts(46, 46)[6] == 22
        assert official_counts(10, 30)[4] == 4


def holes(n: int) -> dict[str, Callable[[Tensor], None]]:
    """The edits: which positions of a row of `n` ids are masked."""
    quarter = round(n / 4)

    def mask(*spans: slice) -> Callable[[Tensor], None]:
        def put(row: Tensor) -> None:
            for span in spans:
                row[span, 0] = -1

        return put

    return {
        "middle": mask(slice(quarter, n - quarter)),
        "both_ends": mask(slice(0, quarter), slice(n - quarter, n)),
        "new_end": mask(slice(n // 2, n)),
        "new_beginning": mask(slice(0, n - n // 2)),
    }


@pytest.fixture(scope="module")
def model() -> MotionTransformer:
    tokenizer = tokenizer_from_official(golden("vqvae_tiny"), GOLDEN)
    return transformer_from_official(golden("t2m_trans_tiny"), tokenizer, GOLDEN, n_heads=4)


@pytest.fixture(scope="module")
def upper() -> MotionTransformer:
    tokenizer = tokenizer_from_official(golden("vqvae_sep_tiny"), GOLDEN)
    return transformer_from_official(golden("t2m_trans_uplow_tiny"), tokenizer, GOLDEN, n_heads=4)


@pytest.fixture(scope="module")
def text() -> TextStates:
    return text_of(golden("io"), 1)


@needs_golden
class TestIds:
    @staticmethod
    def noise() -> NoiseFn:
        return recorded_noise(golden("io")["uplow.in.uniform_noise"])

    @pytest.mark.parametrize("name", [n for n in SAMPLES if "_b1_" in n or n in ("inbetween", "transition")])
    def test_the_plain_sampler_is_the_released_one(self, model: MotionTransformer, text: TextStates, name: str) -> None:
        io = golden("io")
        n = int(io[f"smp.{name}.in.frames"][0]) // 4
        given = io.get(f"smp.{name}.in.token_cond")
        row = empty_row(model, n) if given is None else given[0, :n, None]
        ids = sample_plainly(
            model, text, row,
            max_steps=1 if name == "transition" else 10,
            temperature=0.0 if name.startswith("argmax") else 1.0,
            noise=recorded_noise(io["smp.in.uniform_noise"]),
        )  # fmt: skip
        assert torch.equal(ids[:, 0], io[f"smp.{name}.out.ids"][0, :n])

    @pytest.mark.parametrize(("max_steps", "temperature"), few_and_long([(10, 1.0)], [(10, 0.0), (20, 1.0)]))
    @by_lengths
    def test_texts_of_all_lengths(
        self, model: MotionTransformer, text: TextStates, max_steps: int, temperature: float, lengths: tuple[int, ...]
    ) -> None:
        how = dataclasses.replace(OFFICIAL_SAMPLING, steps=max_steps, temperature=temperature)
        for n in lengths:
            row = empty_row(model, n)
            expected = sample_plainly(
                model, text, row, max_steps=max_steps, temperature=temperature, noise=self.noise()
            )
            assert torch.equal(fill(model, text, [row], [0], how, self.noise())[0], expected), f"{n} tokens"

    @pytest.mark.long
    @by_lengths
    def test_all_lengths_in_one_batch(
        self, model: MotionTransformer, text: TextStates, lengths: tuple[int, ...]
    ) -> None:
        rows = [empty_row(model, n) for n in lengths]
        filled = fill(model, text.repeated(len(rows)), rows, [0] * len(rows), OFFICIAL_SAMPLING)
        for row, ids in zip(rows, filled, strict=True):
            assert torch.equal(ids, sample_plainly(model, text, row, early_exit=False)), f"{len(row)} tokens"

    @pytest.mark.parametrize("edit", few_and_long(["both_ends"], list(holes(8))))
    @by_lengths
    def test_edits_of_all_lengths(
        self, model: MotionTransformer, text: TextStates, edit: str, lengths: tuple[int, ...]
    ) -> None:
        codes = torch.randint(64, (49, 1), generator=torch.Generator().manual_seed(3))
        for n in lengths:
            row = codes[:n].clone()
            holes(n)[edit](row)
            row[row < 0] = model.ids.mask
            how = dataclasses.replace(OFFICIAL_SAMPLING, temperature=float(n % 2))
            expected = sample_plainly(model, text, row, temperature=how.temperature, noise=self.noise())
            ids = fill(model, text, [row], [0], how, self.noise())[0]
            assert torch.equal(ids, expected), f"{n} tokens"
            known = row != model.ids.mask
            assert torch.equal(ids[known], row[known])

    @pytest.mark.long
    @by_lengths
    def test_upper_bodies_of_all_lengths(
        self, upper: MotionTransformer, text: TextStates, lengths: tuple[int, ...]
    ) -> None:
        """Twenty steps, the lower body known; at every other length half of it is masked."""
        how = dataclasses.replace(OFFICIAL_SAMPLING, steps=20, temperature=1.0)
        lower = torch.randint(64, (49,), generator=torch.Generator().manual_seed(4))
        for n in lengths:
            row = empty_row(upper, n)
            row[:, 1] = lower[:n]
            if n % 4 < 2:
                row[n // 2 :, 1] = upper.ids.mask
            expected = sample_plainly(
                upper, text, row, max_steps=20, temperature=1.0, noise=self.noise(), early_exit=False
            )
            assert torch.equal(fill(upper, text, [row], [0], how, self.noise())[0], expected), f"{n} tokens"
