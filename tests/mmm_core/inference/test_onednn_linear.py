"""Packed layers give what plain ones give."""

from __future__ import annotations

import copy

import pytest
import torch
from torch import nn

from mmm_core.errors import GenerationError
from mmm_core.generate.engine import Engine
from mmm_core.inference.int8_linear import int8_is_supported
from mmm_core.inference.onednn_linear import OneDnnLinear, can_pack, can_pack_bf16, fastest_precision, pack
from mmm_core.model.sampling import SamplingSettings, empty_row, fill
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import MotionTransformer, TransformerConfig

pytestmark = pytest.mark.skipif(not can_pack(), reason="this PyTorch has no oneDNN")
needs_bf16 = pytest.mark.skipif(not can_pack_bf16(), reason="this processor packs no bf16 weights")


@pytest.mark.parametrize("rows", [1, 7, 51, 200])
@pytest.mark.parametrize("bias", [True, False])
@torch.inference_mode()
def test_a_packed_layer_equals_the_plain_one(rows: int, bias: bool) -> None:
    torch.manual_seed(rows)
    linear, x = nn.Linear(256, 512, bias=bias), torch.randn(2, rows, 256)
    torch.testing.assert_close(OneDnnLinear(linear, "fp32")(x), linear(x), atol=1e-5, rtol=1e-5)


@needs_bf16
@torch.inference_mode()
def test_a_packed_layer_in_bf16_stays_bf16_and_near_the_plain_one() -> None:
    torch.manual_seed(7)
    linear, x = nn.Linear(256, 512), torch.randn(2, 7, 256)
    half = OneDnnLinear(linear, "bf16")(x)
    assert half.dtype == torch.bfloat16  # nobody widens it but who needs it wide
    torch.testing.assert_close(half.float(), linear(x), atol=0.05, rtol=0.05)


@torch.inference_mode()
def test_an_activation_that_follows_is_taken_over() -> None:
    torch.manual_seed(0)
    plain = nn.Sequential(nn.Linear(128, 512), nn.GELU(), nn.Linear(512, 128)).eval()
    packed = pack(copy.deepcopy(plain))
    assert isinstance(packed[1], nn.Identity)  # type: ignore[index]
    x = torch.randn(3, 128)
    torch.testing.assert_close(packed(x), plain(x), atol=1e-4, rtol=1e-4)


def test_a_packed_transformer_chooses_the_same_tokens() -> None:
    torch.manual_seed(1)
    plain = MotionTransformer(TransformerConfig(n_codes=64, width=256, n_self=3, text_dim=128)).eval()
    for parameter in plain.parameters():
        parameter.data.normal_(0, 0.05)
    packed = pack(copy.deepcopy(plain))
    words = torch.randn(2, 9, 128)
    text = TextStates(words, torch.ones(2, 9, dtype=torch.bool), words.mean(1))
    rows = [empty_row(plain, 20), empty_row(plain, 33)]
    a, b = (fill(m, text, rows, [1, 2], SamplingSettings()) for m in (plain, packed))  # type: ignore[arg-type]
    assert all(torch.equal(x, y) for x, y in zip(a, b, strict=True))


@needs_bf16
@pytest.mark.parametrize("width", [128, 256])
@torch.inference_mode()
def test_a_transformer_in_bf16_answers_in_fp32_and_nearly_the_same(width: int) -> None:
    torch.manual_seed(2)
    plain = MotionTransformer(TransformerConfig(n_codes=64, width=width, n_self=3, text_dim=128)).eval()
    packed = pack(copy.deepcopy(plain), "bf16")
    words = torch.randn(2, 9, 128)
    text = TextStates(words, torch.ones(2, 9, dtype=torch.bool), words.mean(1))
    ids = torch.randint(0, 64, (2, 20, plain.config.n_codebooks))
    exact, near = (m(ids, m.read_text(text)) for m in (plain, packed))
    assert near.dtype == torch.float32
    assert float((near - exact).norm() / exact.norm()) < 0.02


def test_a_precision_is_chosen_that_the_processor_has() -> None:
    """On a processor with AVX2 alone the choice ended in a RuntimeError of PyTorch."""
    assert fastest_precision(128, 2) in (("fp32", "bf16") if can_pack_bf16() else ("fp32",))


@pytest.mark.skipif(can_pack_bf16(), reason="this processor packs bf16 weights")
def test_bf16_is_refused_by_name_where_the_processor_lacks_it() -> None:
    with pytest.raises(GenerationError, match=r"bf16 was asked for.*AVX-512"):
        Engine.load(precision="bf16", threads=None)


@needs_bf16
@pytest.mark.skipif(not int8_is_supported(), reason="this processor multiplies no eight-bit integers")
@pytest.mark.parametrize("has_units", [False, True])
def test_words_are_bf16_beside_int8_where_there_are_matrix_units(
    has_units: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    texts = ["wave with your left hand"]
    exact = Engine.load(precision="fp32", threads=None).read(texts)
    monkeypatch.setattr("mmm_core.generate.engine.has_bf16_matrix_units", lambda: has_units)
    states = Engine.load(precision="int8", threads=None).read(texts)
    error = float((states.words - exact.words).norm() / exact.words.norm())
    assert states.words.dtype == torch.float32
    assert 0.0 < error < 0.02 if has_units else error == 0.0
