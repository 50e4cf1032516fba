"""Files of the released model: full-size layouts, refusals, `mmmd import-official`, and a long motion of the imported pair."""

from __future__ import annotations

import dataclasses
import json
import os
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
from mmm_core.model.sampling import OFFICIAL_SAMPLING, empty_row, fill
from mmm_core.model.streaming_decoder import StreamingDecoder
from mmm_core.model.text import TextStates
from mmm_core.model.transformer import OFFICIAL, MotionTransformer
from mmm_core.model.vqvae import VqVae, VqVaeConfig
from tests.support.golden import GOLDEN, golden, needs_golden
from tests.support.official import TOLERANCE, recorded_noise, text_of
from tests.support.sizes import few_and_long

pytestmark = needs_golden


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
        ("key", "n_codebooks"),
        few_and_long([("t2m_trans_uplow (ckpt key trans)", 2)], [("t2m_trans (ckpt key trans)", 1)]),
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

        assert main([a for a in self.files(tmp_path) if a != "--any-statistics"]) == 2
        assert "--any-statistics" in capsys.readouterr().err
        assert not (tmp_path / "official.safetensors").exists()

    def test_a_file_of_the_wrong_kind_is_named(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        from daemon.cli import main

        arguments = self.files(tmp_path)
        arguments[1], arguments[2] = arguments[2], arguments[1]
        assert main(arguments) == 2
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
