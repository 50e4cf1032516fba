"""Rows that are filled twice: the logits of the first step are computed once, and the ids are those of two fillings."""

from __future__ import annotations

from dataclasses import replace

import pytest
import torch

from mmm_core.model.sampling import FirstStep, SamplingSettings, empty_row, fill
from tests.support.shipped import shipped_engine

SETTINGS = SamplingSettings(steps=4, opening=2)


@pytest.mark.parametrize("steps", [(1, 4), (4, 1)])
def test_a_row_filled_twice_has_its_first_step_computed_once(
    steps: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = shipped_engine()
    transformer, states = engine.model.transformer, engine.read(["wave with your right hand"])
    row, calls, forward = empty_row(transformer, 18), [0], transformer.forward

    def counted(*arguments: object) -> torch.Tensor:
        calls[0] += 1
        return forward(*arguments)  # type: ignore[arg-type]

    apart = [fill(transformer, states, [row], [5], replace(SETTINGS, steps=n))[0] for n in steps]
    monkeypatch.setattr(transformer, "forward", counted)
    first = FirstStep()
    together = [fill(transformer, states, [row], [5], replace(SETTINGS, steps=n), first=first)[0] for n in steps]
    assert all(torch.equal(a, b) for a, b in zip(apart, together, strict=True))
    assert calls[0] == sum(steps) - 1
