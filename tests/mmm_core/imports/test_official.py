"""Parity with the released model: every block and every sampling trace of the golden vectors, ids and floats exact."""

from __future__ import annotations

import dataclasses
import json
import os
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError, GenerationError
from mmm_core.generate.transitions import transition_row
from mmm_core.imports.clip_weights import clip_from_openai
from mmm_core.imports.official import (
    read_pickle,
    read_statistics,
    tokenizer_from_official,
    transformer_from_official,
)
from mmm_core.imports.official_names import rename_tokenizer, rename_transformer
from mmm_core.model.clip_byte_pairs import byte_pairs, clean_text, read_vocabulary
from mmm_core.model.decode import NoiseFn
from mmm_core.model.quantizer import OfficialRuleQuantizer, perplexity
from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill
from mmm_core.model.schedule import official_counts
from mmm_core.model.streaming_decoder import StreamingDecoder
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import OFFICIAL, MotionTransformer
from mmm_core.model.vqvae import HEIGHT_CHANNELS, VqVae, VqVaeConfig
from mmm_core.motion.features import joints_from_positions, root_path
from tests.support.golden import GOLDEN, golden, needs_golden

pytestmark = needs_golden
TOLERANCE = {"atol": 2e-5, "rtol": 1e-4}


@pytest.fixture(scope="module")
def io() -> dict[str, Tensor]:
    return golden("io")


@pytest.fixture(scope="module")
def tokenizer() -> VqVae:
    return tokenizer_from_official(golden("vqvae_tiny"), GOLDEN)


@pytest.fixture(scope="module")
def transformer(tokenizer: VqVae) -> MotionTransformer:
    return transformer_from_official(golden("t2m_trans_tiny"), tokenizer, GOLDEN, n_heads=4)


@pytest.fixture(scope="module")
def halves(io: dict[str, Tensor]) -> VqVae:
    tokenizer = tokenizer_from_official(golden("vqvae_sep_tiny"), GOLDEN)
    tokenizer.mean.copy_(io["sep.in.moment_mean"])
    tokenizer.std.copy_(io["sep.in.moment_std"])
    return tokenizer


def text_of(io: dict[str, Tensor], batch: int, source: str = "tr") -> TextStates:
    words = io[f"{source}.in.word"][:batch]
    return TextStates(words, torch.ones(batch, 77, dtype=torch.bool), io[f"{source}.in.clip_sent"][:batch])


def recorded_noise(uniform: Tensor) -> NoiseFn:
    """Gumbel noise from the recorded uniforms (step, B, 50, K)."""

    def noise(step: int, asked: Tensor, shape: tuple[int, int]) -> Tensor:
        u = uniform[step, : asked.shape[0], : asked.shape[1]][asked].reshape(-1, *shape)
        return -torch.log((-torch.log(u.clamp_min(1e-20))).clamp_min(1e-20))

    return noise


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


SAMPLES = [
    "argmax_b1_f8", "argmax_b1_f20", "argmax_b1_f32", "argmax_b1_f40", "argmax_b1_f48", "argmax_b1_f52",
    "argmax_b1_f100", "argmax_b1_f196", "argmax_b3", "rand_b1_f40", "rand_b1_f100", "rand_b1_f196", "rand_b3",
    "inbetween", "transition",
]  # fmt: skip


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


def test_clip_text_tower(io: dict[str, Tensor]) -> None:
    tower = clip_from_openai(golden("clip_text_tiny"), GOLDEN, n_heads=4)
    states = tower.states(io["clip.in.tokens"])
    torch.testing.assert_close(states.words, io["clip.out.word"], **TOLERANCE)
    torch.testing.assert_close(states.sentence, io["clip.out.sent"], **TOLERANCE)


class TestFullSizeLayout:
    """The index of the released state dicts: every key and shape has its place in our modules."""

    @staticmethod
    def state(key: str) -> dict[str, Tensor]:
        index = json.loads((GOLDEN / "official_size_state_dict_index.json").read_text())
        return {name: torch.empty(shape, device="meta") for name, (shape, _) in index[key].items()}

    @pytest.mark.parametrize(
        ("key", "config"),
        [
            ("vqvae (ckpt key net)", VqVaeConfig()),
            ("vqvae_sep (ckpt key net)", VqVaeConfig("halves", code_dim=16)),
        ],
    )
    def test_tokenizer(self, key: str, config: VqVaeConfig) -> None:
        ours = rename_tokenizer(self.state(key), GOLDEN)
        with torch.device("meta"):
            wanted = VqVae(config).state_dict()
        kept = {"mean", "std", *(k for k in wanted if k.startswith("quantizers") and not k.endswith("codebook"))}
        kept |= {"height_mean", "height_std"} if config.layout == "whole" else set()
        assert {k: v.shape for k, v in ours.items()} == {k: v.shape for k, v in wanted.items() if k not in kept}

    @pytest.mark.parametrize(
        ("key", "n_codebooks"), [("t2m_trans (ckpt key trans)", 1), ("t2m_trans_uplow (ckpt key trans)", 2)]
    )
    def test_transformer(self, key: str, n_codebooks: int) -> None:
        config = dataclasses.replace(
            OFFICIAL, n_codebooks=n_codebooks, code_dim=32 // n_codebooks, n_predicted=None if n_codebooks == 1 else 1
        )
        ours = rename_transformer(self.state(key), GOLDEN)
        ours["specials"] = ours["specials"].repeat(1, n_codebooks)
        with torch.device("meta"):
            wanted = MotionTransformer(config).state_dict()
        assert {k: v.shape for k, v in ours.items()} == {
            k: v.shape for k, v in wanted.items() if k not in ("codebooks", "no_words")
        }


class TestRefusals:
    def test_an_unknown_tensor_is_named(self, tokenizer: VqVae) -> None:
        state = golden("t2m_trans_tiny") | {"trans_base.extra": torch.zeros(1)}
        with pytest.raises(CheckpointError, match=r"trans_base\.extra"):
            transformer_from_official(state, tokenizer, GOLDEN, n_heads=4)

    def test_a_missing_tensor_is_named(self) -> None:
        state = {k: v for k, v in golden("vqvae_tiny").items() if k != "vqvae.decoder.model.6.bias"}
        with pytest.raises(CheckpointError, match=r"decoders\.0\.out\.bias.*missing"):
            tokenizer_from_official(state, GOLDEN)

    def test_a_pair_that_does_not_belong_together(self, tokenizer: VqVae) -> None:
        state = dict(golden("t2m_trans_tiny"))
        key = "trans_base.vqvae.vqvae.quantizer.codebook"
        state[key] = state[key] + 1
        with pytest.raises(CheckpointError, match="differs from the tokenizer file"):
            transformer_from_official(state, tokenizer, GOLDEN, n_heads=4)

    def test_a_pickle_with_code_is_not_run(self, tmp_path: Path) -> None:
        class Trap:
            def __reduce__(self) -> tuple[object, tuple[str]]:
                return os.system, (f"touch {tmp_path}/run",)

        path = tmp_path / "trap.pth"
        torch.save({"net": Trap()}, path)
        with pytest.raises(CheckpointError, match="more than tensors"):
            read_pickle(path, "net")
        assert not (tmp_path / "run").exists()

    def test_humanml3ds_own_spread_is_refused(self, tmp_path: Path) -> None:

        folder, tokenizer = tmp_path, VqVae(VqVaeConfig(width=8, n_codes=8, code_dim=4))
        np.save(folder / "mean.npy", np.zeros(263))
        np.save(folder / "std.npy", np.full(263, 0.013))
        with pytest.raises(CheckpointError, match=r"\[0:4\]"):
            read_statistics(folder / "mean.npy", folder / "std.npy", tokenizer)
        read_statistics(folder / "mean.npy", folder / "std.npy", tokenizer, any_statistics=True)
        assert float(tokenizer.std[0]) == pytest.approx(0.013)


def test_long_range_with_generated_transitions(
    io: dict[str, Tensor], tokenizer: VqVae, transformer: MotionTransformer
) -> None:
    """Four prompts as a batch, two tokens between neighbours, one decoding; streamed, it gives the same motion."""
    lengths = [f // 4 for f in io["long.in.frames"].tolist()]
    text, uniform = text_of(io, 4, "long"), io["long.in.uniform_noise"]
    base = fill(
        transformer,
        text,
        [empty_row(transformer, n) for n in lengths],
        [0] * 4,
        OFFICIAL_SAMPLING,
        recorded_noise(uniform),
    )
    for row, expected in zip(base, io["long.out.base_ids"], strict=True):
        assert torch.equal(row[:, 0], expected[: len(row)])
    mask = transformer.ids.mask
    rows = [transition_row(a, b, mask) for a, b in pairwise(base)]
    for row, expected in zip(rows, io["long.out.transition_input_ids"], strict=True):
        assert torch.equal(row[:, 0], expected[: len(row)])
    left = TextStates(text.words[:3], text.word_mask[:3], text.sentence[:3])
    # The released code fills transitions in one step.
    settings = dataclasses.replace(OFFICIAL_SAMPLING, official=True, steps=1, temperature=1.0)
    filled = fill(transformer, left, rows, [0] * 3, settings, recorded_noise(uniform[10:, :3]))
    pieces = [base[0]]
    for row, masked, following in zip(filled, rows, base[1:], strict=True):
        pieces += [row[masked[:, 0] == mask], following]
    ids = torch.cat(pieces)
    assert torch.equal(ids[:, 0], io["long.out.all_tokens"][0])
    torch.testing.assert_close(tokenizer.decode(ids[None]), io["long.out.motion"], **TOLERANCE)
    decoder = StreamingDecoder(tokenizer)
    streamed = torch.cat([*(decoder.push(piece) for piece in pieces), decoder.finish()])
    torch.testing.assert_close(streamed, io["long.out.motion"][0], **TOLERANCE)


class TestImport:
    """The command on a pair of files, as a user who has the weights runs it."""

    @staticmethod
    def files(folder: Path) -> list[str]:
        torch.save({"net": golden("vqvae_tiny")}, folder / "vq.pth")
        torch.save({"trans": golden("t2m_trans_tiny")}, folder / "trans.pth")
        np.save(folder / "mean.npy", np.zeros(263))
        np.save(folder / "std.npy", np.ones(263))
        out = ["--out", str(folder / "official.safetensors"), "--heads", "4", "--json"]
        stats = ["--mean", str(folder / "mean.npy"), "--std", str(folder / "std.npy"), "--any-statistics"]
        return ["import-official", str(folder / "vq.pth"), str(folder / "trans.pth"), *stats, *out]

    def test_the_pair_becomes_one_file_that_decodes_the_same(
        self, tmp_path: Path, io: dict[str, Tensor], capsys: pytest.CaptureFixture[str]
    ) -> None:
        from daemon.cli import main
        from mmm_core.inference.checkpoint import load_model

        assert main(self.files(tmp_path)) == 0
        summary = json.loads(capsys.readouterr().out)
        assert summary["codebook"] == [64, 16]
        assert set(summary["files"]) == {"vq.pth", "trans.pth", "mean.npy", "std.npy"}
        model = load_model(tmp_path / "official.safetensors")
        decoded = model.tokenizer.decode(io["vq.in.decode_codes49"][..., None])
        torch.testing.assert_close(decoded, io["vq.out.decode49"], **TOLERANCE)
        noise = recorded_noise(io["smp.in.uniform_noise"])
        row = empty_row(model.transformer, 49)
        filled = fill(model.transformer, text_of(io, 1), [row], [0], OFFICIAL_SAMPLING, noise)[0]
        assert torch.equal(filled[:, 0], io["smp.argmax_b1_f196.out.ids"][0, :49])

    def test_other_statistics_need_the_option(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        from daemon.cli import main

        assert main([a for a in self.files(tmp_path) if a != "--any-statistics"]) == 1
        assert "--any-statistics" in capsys.readouterr().err
        assert not (tmp_path / "official.safetensors").exists()

    def test_a_file_of_the_wrong_kind_is_named(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        from daemon.cli import main

        arguments = self.files(tmp_path)
        arguments[1], arguments[2] = arguments[2], arguments[1]
        assert main(arguments) == 1
        assert "key 'net'" in capsys.readouterr().err

    def test_with_clip_the_file_answers_texts(
        self, tmp_path: Path, tokenizer: VqVae, transformer: MotionTransformer
    ) -> None:
        from mmm_core.generate.engine import Engine
        from mmm_core.inference.checkpoint import Model, save_model

        text = clip_from_openai(golden("clip_text_tiny"), GOLDEN, n_heads=4)
        text.word_pieces = _few_pieces()
        path = tmp_path / "with_clip.safetensors"
        save_model(path, Model(tokenizer, transformer, None, None, {}, text, "humanml3d"), half=False)
        engine = Engine.load(path, threads=None)
        motion = engine.generate("a man waves", seed=3, seconds=2.3).motion
        both = engine.read(["wave 👋", "wave"])
        assert not torch.equal(both.sentence[0], both.sentence[1]), "emoji are words to CLIP"
        assert motion.joints_m.shape == (46, 22, 3), "any length, not only whole tokens"
        with pytest.raises(GenerationError, match="not trained to choose a length"):
            engine.generate("a man waves")


def _few_pieces() -> object:
    """A vocabulary of 200 pieces, as many as the tiny tower has."""
    from tokenizers import Tokenizer, models, pre_tokenizers

    letters = [chr(c) for c in range(97, 123)]
    ids = {piece: i for i, piece in enumerate(["?", *letters, *(f"piece{n}" for n in range(171)), "<start>", "<end>"])}
    pieces = Tokenizer(models.BPE(ids, [], unk_token="?"))
    pieces.pre_tokenizer = pre_tokenizers.Whitespace()
    return pieces


class TestClipIds:
    """Ids of CLIP's own tokenizer, cut with a part of its byte pairs, for texts that it mends before it cuts them.

    Curly quotes and apostrophes, HTML's signs, wrongly decoded bytes, full-width letters and the like gave other ids.
    """

    DATA = Path(__file__).parent / "clip_ids.json"

    def test_ids_of_texts_that_are_mended(self) -> None:
        content = json.loads(self.DATA.read_text())
        pieces = byte_pairs([(a, b) for a, b in (merge.split() for merge in content["merges"])])
        assert len(content["texts"]) >= 40
        for text, ids in content["texts"].items():
            assert pieces.encode(clean_text(text), add_special_tokens=False).ids == ids, repr(text)

    def test_everyday_quotes_and_apostrophes(self) -> None:
        assert (
            clean_text("\u201cwave\u201d, she\u2019s   ready &amp; waiting\u2026")
            == '"wave", she\'s ready & waiting\u2026'
        )


class TestClipVocabulary:
    MERGES = (("w", "a"), ("v", "e</w>"), ("wa", "ve</w>"), ("t", "h"), ("th", "e</w>"))

    def test_pieces_by_hand(self) -> None:
        """Ids: 256 bytes, the same at a word's end, then the merges; case and spaces do not matter."""
        pieces = byte_pairs(list(self.MERGES))
        wave, the = 512 + 2, 512 + 4
        assert pieces.encode(clean_text("The   WAVE"), add_special_tokens=False).ids == [the, wave]
        comma = 256 + (ord(",") - ord("!"))
        assert pieces.encode("wave, the", add_special_tokens=False).ids == [wave, comma, the]
        assert pieces.get_vocab_size() == 512 + 5 + 2

    def test_the_published_files_form_is_read(self, tmp_path: Path) -> None:
        import gzip

        lines = ['"bpe_simple_vocab_16e6.txt#version: 0.2', *(f"{a} {b}" for a, b in self.MERGES)]
        (tmp_path / "v.txt.gz").write_bytes(gzip.compress("\n".join(lines).encode()))
        pieces = read_vocabulary(tmp_path / "v.txt.gz")
        assert pieces.encode("the wave", add_special_tokens=False).ids == [516, 514]

    def test_what_is_no_vocabulary_is_named(self, tmp_path: Path) -> None:
        (tmp_path / "v.txt.gz").write_bytes(b"no gzip")
        with pytest.raises(CheckpointError, match="not a vocabulary"):
            read_vocabulary(tmp_path / "v.txt.gz")
