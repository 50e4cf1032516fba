"""Laws of the tokenizer, the transformer and the text encoder, on small random weights or the packed encoder."""

from __future__ import annotations

import pytest
import torch

from mmm_core.inference.checkpoint import TEXT_FILE, load_text_encoder
from mmm_core.model.quantizer import Quantizer
from mmm_core.model.text import TextStates
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.model.transformer import MotionTransformer, StepMemory, TransformerConfig


@pytest.fixture(scope="module")
def tokenizer() -> Tokenizer:
    torch.manual_seed(0)
    return Tokenizer(TokenizerConfig(n_codes=32, code_dim=8, decoder_width=64)).eval()


def small_transformer() -> MotionTransformer:
    torch.manual_seed(0)
    config = TransformerConfig(
        n_codes=32, n_codebooks=3, code_dim=8, width=32, n_heads=4, n_cross=1, n_self=2, text_dim=16
    )
    model = MotionTransformer(config).eval()
    model.set_codebooks([torch.randn(32, 8) for _ in range(3)])
    return model


def text_states(B: int, W: int = 5, D: int = 16) -> TextStates:
    generator = torch.Generator().manual_seed(3)
    words = torch.randn(B, W, D, generator=generator)
    return TextStates(words, torch.ones(B, W, dtype=torch.bool), words.mean(1))


@torch.inference_mode()
def test_an_arm_token_does_not_see_the_other_parts(tokenizer: Tokenizer) -> None:
    features = torch.randn(1, 40, 263)
    changed = features.clone()
    arm = list(tokenizer.config.parts[0].channels)
    others = [c for c in range(263) if c not in arm]
    changed[..., others] += 1.0
    assert torch.equal(tokenizer.encode(features)[..., 0], tokenizer.encode(changed)[..., 0])
    assert not torch.equal(tokenizer.encode(features)[..., 2], tokenizer.encode(changed)[..., 2])


@torch.inference_mode()
def test_a_window_with_its_halo_decodes_to_the_same_frames(tokenizer: Tokenizer) -> None:
    ids = torch.randint(0, 32, (1, 40, 3))
    whole = tokenizer.decode(ids)
    halo, lo, hi = tokenizer.halo_tokens(), 15, 22
    window = tokenizer.decode(ids[:, lo - halo : hi + halo])[:, 4 * halo : 4 * (halo + hi - lo)]
    assert torch.allclose(whole[:, 4 * lo : 4 * hi], window, atol=1e-5)
    short = tokenizer.decode(ids[:, lo - halo + 4 : hi + halo - 4])[:, 4 * (halo - 4) : 4 * (halo - 4 + hi - lo)]
    assert not torch.allclose(whole[:, 4 * lo : 4 * hi], short, atol=1e-5), "a shorter halo must show"


def test_dead_codes_come_back_to_life() -> None:
    """All latents lie at one point for a while; when they spread, the codes must follow."""
    torch.manual_seed(0)
    centres = 3 * torch.randn(12, 4)
    quantizer = Quantizer(16, 4).train()
    for step in range(400):
        spread = centres if step > 50 else torch.zeros(12, 4)
        quantizer(spread.repeat(20, 1) + 0.05 * torch.randn(240, 4))
    assert len(quantizer.encode(centres).unique()) >= 11, "two centres may share a code, not more"


@torch.inference_mode()
def test_padding_does_not_change_a_motions_logits() -> None:
    model = small_transformer()
    ids = torch.randint(0, 32, (1, 9, 3))
    ids[0, 8] = model.ids.end
    padded = torch.cat([ids, torch.full((1, 6, 3), model.ids.pad)], 1)
    context = model.read_text(text_states(1))
    assert torch.allclose(model(ids, context), model(padded, context)[:, :9], atol=1e-5)


@torch.inference_mode()
def test_padded_words_do_not_change_the_logits_and_real_words_do() -> None:
    model = small_transformer()
    ids = torch.full((1, 7, 3), model.ids.mask)
    text = text_states(1)
    longer = TextStates(
        torch.cat([text.words, torch.randn(1, 3, 16)], 1),
        torch.tensor([[True] * 5 + [False] * 3]),
        text.sentence,
    )
    plain = model(ids, model.read_text(text))
    assert torch.allclose(plain, model(ids, model.read_text(longer)), atol=1e-5)
    swapped = TextStates(text.words.flip(-1), text.word_mask, text.sentence)
    assert not torch.allclose(plain, model(ids, model.read_text(swapped)), atol=1e-3)


@pytest.mark.skipif(not TEXT_FILE.is_file(), reason="the packed text encoder is not in this checkout")
def test_the_packed_encoder_keeps_its_known_geometry() -> None:
    """0.976 is all-MiniLM-L6-v2's own cosine of left against right; far apart sentences stay far apart."""
    encoder = load_text_encoder()
    states = encoder.encode(["wave with your right hand", "wave with your left hand", "eat a sandwich"])
    cosine = states.sentence @ states.sentence.T
    assert abs(float(cosine[0, 1]) - 0.976) < 0.003
    assert float(cosine[0, 2]) < 0.4
    alone = encoder.encode(["eat a sandwich"])
    assert torch.allclose(alone.sentence[0], states.sentence[2], atol=1e-5), "padding does not change a text"


@torch.inference_mode()
def test_remembering_the_step_before_changes_no_logit() -> None:
    """Ids change at random, are masked again, and are kept: the logits are those of a pass without memory."""
    model = small_transformer()
    for parameter in model.parameters():
        parameter.normal_(0, 0.3)
    words = torch.randn(1, 5, 16)
    context = model.read_text(TextStates(words, torch.ones(1, 5, dtype=torch.bool), words.mean(1)))
    generator, memory = torch.Generator().manual_seed(1), StepMemory()
    ids = torch.full((1, 12, 3), model.ids.mask)
    ids[:, 3:5] = 7  # known from the beginning: an edit
    for _ in range(8):
        asked = torch.rand(1, 12, generator=generator) < 0.5
        torch.testing.assert_close(model(ids, context, asked, memory), model(ids, context, asked), atol=1e-5, rtol=1e-4)
        ids = torch.where(
            torch.rand(1, 12, 1, generator=generator) < 0.4, torch.randint(0, 32, (1, 12, 3), generator=generator), ids
        )
        ids = torch.where(torch.rand(1, 12, 1, generator=generator) < 0.3, model.ids.mask, ids)
