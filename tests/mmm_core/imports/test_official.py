"""Parity with the released model: every block and every sampling trace of the golden vectors, ids and floats exact."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pytest
import torch
from torch import Tensor

from mmm_core.imports.official import (
    tokenizer_from_official,
    transformer_from_official,
)
from mmm_core.model.quantizer import OfficialRuleQuantizer, perplexity
from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill
from mmm_core.model.schedule import official_counts
from mmm_core.model.transformer import MotionTransformer
from mmm_core.model.vqvae import HEIGHT_CHANNELS, VqVae
from mmm_core.motion.features import joints_from_positions, root_path
from tests.support.golden import GOLDEN, golden, needs_golden
from tests.support.official import SAMPLES, TOLERANCE, recorded_noise, text_of

pytestmark = needs_golden


@pytest.fixture(scope="module")
def halves(io: dict[str, Tensor]) -> VqVae:
    tokenizer = tokenizer_from_official(golden("vqvae_sep_tiny"), GOLDEN)
    tokenizer.mean.copy_(io["sep.in.moment_mean"])
    tokenizer.std.copy_(io["sep.in.moment_std"])
    return tokenizer


class TestTokenizer:
    @pytest.mark.parametrize(
        ("motion", "codes"), [("vq.in.motion", "vq.out.codes"), ("vq.in.motion196", "vq.out.codes196")]
    )
    def test_codes(self, io: dict[str, Tensor], tokenizer: VqVae, motion: str, codes: str) -> None:
        assert torch.equal(tokenizer.encode(io[motion])[..., 0], io[codes])

    def test_latents(self, io: dict[str, Tensor], tokenizer: VqVae) -> None:
        with torch.inference_mode():
            for motion, latent in (("vq.in.motion", "vq.out.latent_bct"), ("vq.in.motion196", "vq.out.latent196_bct")):
                ours = tokenizer.latents(io[motion])[0].transpose(1, 2)
                torch.testing.assert_close(ours, io[latent], **TOLERANCE)

    @pytest.mark.parametrize("n", [1, 7, 49])
    def test_decoding(self, io: dict[str, Tensor], tokenizer: VqVae, n: int) -> None:
        decoded = tokenizer.decode(io[f"vq.in.decode_codes{n}"][..., None])
        torch.testing.assert_close(decoded, io[f"vq.out.decode{n}"], **TOLERANCE)

    def test_reconstruction_and_its_losses(self, io: dict[str, Tensor], tokenizer: VqVae) -> None:
        motion = io["vq.in.motion"]
        with torch.inference_mode():
            reconstruction, commitment = tokenizer(motion)
        torch.testing.assert_close(reconstruction, io["vq.out.recon"], **TOLERANCE)
        torch.testing.assert_close(commitment, io["vq.out.commit_loss"][0], **TOLERANCE)
        smooth_l1 = torch.nn.functional.smooth_l1_loss
        torch.testing.assert_close(smooth_l1(reconstruction, motion), io["vq.out.loss_recons"][0], **TOLERANCE)
        positions = smooth_l1(reconstruction[..., 4:67], motion[..., 4:67])
        torch.testing.assert_close(positions, io["vq.out.loss_pos"][0], **TOLERANCE)
        torch.testing.assert_close(perplexity(tokenizer.encode(motion), 64), io["vq.out.perplexity"][0], **TOLERANCE)

    def test_moving_averages_follow_the_released_rule(self, io: dict[str, Tensor]) -> None:
        quantizer = OfficialRuleQuantizer(64, 16).train()
        for step, x in enumerate(io["ema.in.x"]):
            latents = x.transpose(1, 2)
            _, loss = quantizer(latents)
            torch.testing.assert_close(loss, io["ema.out.loss"][step], **TOLERANCE)
            torch.testing.assert_close(quantizer.codebook, io["ema.out.codebook"][step], **TOLERANCE)
        torch.testing.assert_close(quantizer.uses, io["ema.out.code_count"], **TOLERANCE)
        torch.testing.assert_close(quantizer.sums, io["ema.out.code_sum"], **TOLERANCE)

    def test_a_window_with_its_halo_decodes_as_the_whole(self, tokenizer: VqVae) -> None:
        """The released sizes: frame 4k sees 22 tokens back."""
        assert tokenizer.halo_tokens() == 22


class TestHalves:
    def test_channels(self, io: dict[str, Tensor], halves: VqVae) -> None:
        for mask, channels in zip(("mask.upper", "mask.lower"), halves.channels, strict=True):
            assert io[mask].nonzero()[:, 0].tolist() == list(channels)
        assert io["mask.upper_joint_y"].nonzero()[:, 0].tolist() == list(HEIGHT_CHANNELS)

    def test_height_shift_codes_and_decoding(self, io: dict[str, Tensor], halves: VqVae) -> None:
        features = io["sep.in.motion"] * halves.std + halves.mean
        torch.testing.assert_close(halves.normalise(features), io["sep.out.shifted"], **TOLERANCE)
        torch.testing.assert_close(halves.denormalise(halves.normalise(features)), features, **TOLERANCE)
        assert torch.equal(halves.encode(features), io["sep.out.codes"])
        decoded = (halves.decode(io["sep.out.codes"]) - halves.mean) / halves.std
        torch.testing.assert_close(decoded, io["sep.out.decode"], **TOLERANCE)
        torch.testing.assert_close(decoded, io["sep.out.recon"], **TOLERANCE)

    def test_upper_ids_given_the_lower(self, io: dict[str, Tensor], halves: VqVae) -> None:
        model = transformer_from_official(golden("t2m_trans_uplow_tiny"), halves, GOLDEN, n_heads=4)
        text = text_of(io, 1)
        ids = torch.stack([io["uplow.in.ids_upper"], io["uplow.in.ids_lower"]], -1)
        seen = io["uplow.in.src_mask"]
        logits = model(ids, model.read_text(text))[:, :, 0]
        torch.testing.assert_close(logits[seen], io["uplow.out.logits"][:, 1:][seen], **TOLERANCE)
        row = ids[0, :25].clone()
        row[:, 0] = model.ids.mask
        settings = dataclasses.replace(OFFICIAL_SAMPLING, temperature=1.0, steps=20)
        filled = fill(model, text, [row], [0], settings, recorded_noise(io["uplow.in.uniform_noise"]))[0]
        assert torch.equal(filled[:, 0], io["uplow.out.sample_f100"][0, :25])
        assert torch.equal(filled[:, 1], row[:, 1]), "the lower body stays"


class TestTransformer:
    def test_logits(self, io: dict[str, Tensor], transformer: MotionTransformer) -> None:
        context, seen = transformer.read_text(text_of(io, 3)), io["tr.in.src_mask"]
        ids = io["tr.in.ids"][..., None]
        logits = transformer(ids, context)
        torch.testing.assert_close(logits[:, :, 0][seen], io["tr.out.logits_masked"][:, 1:][seen], **TOLERANCE)
        torch.testing.assert_close(transformer(ids, context, seen), logits[seen], **TOLERANCE)

    def test_the_training_loss(self, io: dict[str, Tensor], transformer: MotionTransformer) -> None:
        logits = transformer(io["tr.in.ids"][..., None], transformer.read_text(text_of(io, 3)))[:, :, 0]
        per_row = [
            torch.nn.functional.cross_entropy(logits[b, :n], io["tr.in.target"][b, :n])
            for b, n in enumerate(io["tr.in.len"].tolist())
        ]
        torch.testing.assert_close(torch.stack(per_row).mean(), io["tr.out.train_loss"][0], **TOLERANCE)

    def test_cropping_to_the_motion_changes_nothing(
        self, io: dict[str, Tensor], transformer: MotionTransformer
    ) -> None:
        text, n = text_of(io, 1), int(io["tr.in.len"][0])
        whole = transformer(io["tr.in.ids"][:1, :, None], transformer.read_text(text))
        cropped = transformer(io["tr.in.ids"][:1, : n + 1, None], transformer.read_text(text))
        torch.testing.assert_close(cropped, whole[:, : n + 1], **TOLERANCE)


class TestSampling:
    def test_every_recorded_trace_is_here(self, io: dict[str, Tensor]) -> None:
        names = {m[1] for key in io if (m := re.fullmatch(r"smp\.(.*)\.out\.ids", key))}
        assert names == set(SAMPLES)

    @pytest.mark.parametrize("name", SAMPLES)
    def test_ids_and_inputs_of_every_step(
        self, io: dict[str, Tensor], transformer: MotionTransformer, name: str, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        frames = io[f"smp.{name}.in.frames"].tolist()
        given = io.get(f"smp.{name}.in.token_cond")
        rows = [empty_row(transformer, f // 4) for f in frames] if given is None else [given[0, : frames[0] // 4, None]]
        temperature = 0.0 if name.startswith("argmax") else 1.0
        max_steps = 1 if name == "transition" else 10
        settings = dataclasses.replace(OFFICIAL_SAMPLING, temperature=temperature, steps=max_steps)
        inputs: list[Tensor] = []
        transformer.register_forward_pre_hook(lambda _m, args: inputs.append(args[0].clone()))
        text, noise = text_of(io, len(frames)), recorded_noise(io["smp.in.uniform_noise"])
        filled = fill(transformer, text, rows, [0] * len(rows), settings, noise)
        transformer._forward_pre_hooks.clear()
        for i, row in enumerate(filled):
            assert torch.equal(row[:, 0], io[f"smp.{name}.out.ids"][i, : len(row)])
        expected = io[f"smp.{name}.out.inputs_per_step"]
        assert len(inputs) == len(expected)
        for ours, theirs in zip(inputs, expected, strict=True):
            for i, row in enumerate(rows):
                assert torch.equal(ours[i, : len(row) + 1, 0], theirs[i, : len(row) + 1])

    @pytest.mark.parametrize(
        ("n_tokens", "counts"),
        [(2, [2] + 9 * [1]), (7, [7, 1]), (8, [8]), (12, [12]), (13, [13, 11, 6]), (25, [25, 23, 20, 14, 7])],
    )
    def test_early_exit_of_a_batch_of_one(self, n_tokens: int, counts: list[int]) -> None:
        assert official_counts(n_tokens, n_tokens, early_exit=True) == counts

    def test_without_early_exit_there_are_ten_passes(self) -> None:
        assert len(official_counts(8, 8)) == 10


def test_joints_from_features(io: dict[str, Tensor]) -> None:
    features = io["ric.in.features"][0].double().numpy()
    np.testing.assert_allclose(joints_from_positions(features), io["ric.out.joints"][0].numpy(), atol=2e-5)
    yaw, root = root_path(features)
    np.testing.assert_allclose(root, io["ric.out.root_pos"][0].numpy(), atol=2e-5)
    half = -0.5 * yaw  # the released code keeps the inverse half turn
    quat = io["ric.out.root_quat_wxyz"][0].numpy()
    np.testing.assert_allclose(np.stack([np.cos(half), np.sin(half)], -1), quat[:, [0, 2]], atol=2e-5)
