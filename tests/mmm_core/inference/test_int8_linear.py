"""Eight-bit layers come near the plain ones, and give a row the same result whatever its neighbours are."""

from __future__ import annotations

import copy

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from torch import nn

import mmm_core.inference.int8_linear as eight_bit
from mmm_core.errors import GenerationError
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import MODEL_FILE
from mmm_core.inference.int8_linear import Int8Linear, convert_to_int8, int8_is_supported
from mmm_core.model.sampling import SamplingSettings, empty_row, fill
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import MotionTransformer, TransformerConfig

needs_vnni = pytest.mark.skipif(not int8_is_supported(), reason="this processor does not multiply eight-bit integers")
needs_model = pytest.mark.skipif(not MODEL_FILE.exists(), reason="no checkpoint in this checkout")


@needs_vnni
@pytest.mark.parametrize("bias", [True, False])
@given(seed=st.integers(0, 10_000), rows=st.integers(1, 60), low=st.floats(-9, 0), high=st.floats(0.1, 9))
@torch.inference_mode()
def test_the_error_is_that_of_rounding(bias: bool, seed: int, rows: int, low: float, high: float) -> None:
    torch.manual_seed(seed)
    linear, x = nn.Linear(256, 192, bias=bias), low + (high - low) * torch.rand(1, rows, 256)
    x_step, w_step = (high - low) / 255, linear.weight.abs().amax(1) / 127
    # half a step of each input times the weights, half a step of each weight times the inputs, and both
    most = 0.5 * (x_step * linear.weight.abs().sum(1) + w_step * (x.abs().sum(-1, keepdim=True) + 256 * x_step))
    assert ((Int8Linear(linear, low, high)(x) - linear(x)).abs() <= most + 1e-3).all()


@needs_vnni
@torch.inference_mode()
def test_what_lies_outside_the_range_is_clipped() -> None:
    linear = nn.Linear(128, 128)
    layer, x = Int8Linear(linear, -1.0, 1.0), 3 * torch.randn(5, 128)
    torch.testing.assert_close(layer(x), layer(x.clamp(-1.0, 1.0)), atol=0.05, rtol=0.05)


@needs_vnni
@torch.inference_mode()
def test_a_layer_takes_the_range_of_its_inputs_and_stays_without_any() -> None:
    model = nn.ModuleDict({"seen": nn.Linear(128, 256), "not_seen": nn.Linear(128, 256), "narrow": nn.Linear(8, 8)})
    x = torch.linspace(-0.5, 2.0, 256).reshape(2, 128)
    convert_to_int8(model, lambda: (model["seen"](x), model["narrow"](torch.ones(1, 8))))
    assert isinstance(model["seen"], Int8Linear)
    assert isinstance(model["not_seen"], nn.Linear) and isinstance(model["narrow"], nn.Linear)


@needs_vnni
def test_a_row_is_independent_of_others_and_close_to_the_plain_model() -> None:
    torch.manual_seed(1)
    plain = MotionTransformer(TransformerConfig(n_codes=64, width=256, n_self=3, text_dim=128)).eval()
    for parameter in plain.parameters():
        parameter.data.normal_(0, 0.05)
    words = torch.randn(2, 9, 128)
    text = TextStates(words, torch.ones(2, 9, dtype=torch.bool), words.mean(1))
    rows, seeds = [empty_row(plain, 20), empty_row(plain, 33)], [1, 2]
    model = copy.deepcopy(plain)
    convert_to_int8(model, lambda: fill(model, text, rows, seeds, SamplingSettings()))
    together = fill(model, text, rows, seeds, SamplingSettings())
    for i in range(2):
        alone = fill(model, text.part(slice(i, i + 1)), rows[i : i + 1], seeds[i : i + 1], SamplingSettings())
        assert torch.equal(alone[0], together[i])
    with torch.inference_mode():
        ids = torch.full((2, 21, 3), plain.ids.mask)
        a, b = (m(ids, m.read_text(text)).log_softmax(-1) for m in (plain, model))
    assert float((a.exp() * (a - b)).sum(-1).mean()) < 0.01


@needs_model
def test_int8_is_taken_for_the_shipped_model_where_it_can_be(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Engine.load(threads=None).precision == ("int8" if int8_is_supported() else "fp32")
    monkeypatch.setattr(eight_bit, "_PACK", None)  # a PyTorch without such layers
    assert Engine.load(threads=None).precision == "fp32"
    with pytest.raises(GenerationError, match="int8"):
        Engine.load(threads=None, precision="int8")
