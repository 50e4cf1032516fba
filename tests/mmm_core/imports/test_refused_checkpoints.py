"""Damaged and hostile checkpoints: each is refused with the tensor's name, quickly, and nothing is written.

A file with a block of the number 1000000000 kept `mmmd import-official` busy for ever, as it counted blocks by the
highest number; others ended as internal errors, and weights that are not numbers were taken.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor

from mmm_core.errors import CheckpointError
from mmm_core.imports.clip_weights import clip_from_openai
from tests.support.golden import GOLDEN, golden, needs_golden
from tests.support.sizes import few_and_long

pytestmark = needs_golden

State = dict[str, Tensor]
HEAD, COND = "trans_head.blocks.0.ln1.weight", "trans_base.cond_emb.weight"
BOOK = "vqvae.quantizer.codebook"
COPIED_BOOK = "trans_base.vqvae.vqvae.quantizer.codebook"


def put(key: str, tensor: Tensor) -> Callable[[State], None]:
    """A damage: the tensor under `key` is replaced or added."""

    def damage(state: State) -> None:
        state[key] = tensor

    return damage


def changed(key: str, change: Callable[[Tensor], Tensor]) -> Callable[[State], None]:
    """A damage: the tensor under `key` is changed."""

    def damage(state: State) -> None:
        state[key] = change(state[key])

    return damage


def with_nan(tensor: Tensor) -> Tensor:
    tensor = tensor.clone()
    tensor.view(-1)[-1] = float("nan")
    return tensor


TRANSFORMER: dict[str, tuple[Callable[[State], None], str]] = {
    "a block of a huge number": (
        put("trans_head.blocks.1000000000.ln1.weight", torch.ones(64)), r"trans_head\.blocks\.1000000000"),
    "a gap in the blocks": (put("trans_base.blocks.40.ln1.weight", torch.ones(64)), r"trans_base\.blocks\.40"),
    "a block that has no number": (put("trans_base.blocks.x.ln1.weight", torch.ones(64)), r"trans_base\.blocks\.x"),
    "a number written twice": (put("trans_base.blocks.00.ln1.weight", torch.ones(64)), r"trans_base\.blocks\.00"),
    "a negative number": (put("trans_base.cross_att.-1.ln1.weight", torch.ones(64)), r"trans_base\.cross_att\.-1"),
    "no number at all": (put("trans_base.blocks.", torch.ones(64)), r"trans_base\.blocks\."),
    "a one-dimensional cond_emb": (changed(COND, lambda t: t[0]), rf"{COND}'.*1 dimension"),
    "an empty cond_emb": (changed(COND, lambda t: t[:0]), COND),
    "a sparse tensor": (changed(HEAD, Tensor.to_sparse), rf"{HEAD}'.*sparse"),
    "a tensor without data": (changed(HEAD, lambda t: t.to("meta")), rf"{HEAD}'.*meta"),
    "more numbers than are stored": (changed(HEAD, lambda t: t[:1].expand(10**12)), rf"{HEAD}'.*holds 64"),
    "NaN": (changed("trans_head.head.weight", with_nan), r"trans_head\.head\.weight'.*not finite"),
    "infinity": (changed(HEAD, lambda t: t / 0), rf"{HEAD}'.*not finite"),
    "complex weights": (changed(HEAD, lambda t: t.to(torch.complex64)), rf"{HEAD}'.*complex"),
    "whole numbers": (changed(HEAD, lambda t: t.to(torch.int64)), rf"{HEAD}'.*int64"),
}  # fmt: skip
TOKENIZER: dict[str, tuple[Callable[[State], None], str]] = {
    "a codebook of no dimension": (put(BOOK, torch.tensor(1.0)), rf"{BOOK}'.*0 dimensions"),
    "an empty codebook": (changed(BOOK, lambda t: t[:0]), BOOK),
    "a one-dimensional stem": (changed("vqvae.encoder.model.0.weight", lambda t: t[0, 0]), r"encoder\.model\.0\.weight"),
    "NaN": (changed(BOOK, with_nan), rf"{BOOK}'.*not finite"),
    "complex codes": (changed(BOOK, lambda t: t.to(torch.complex64)), rf"{BOOK}'.*complex"),
}  # fmt: skip


def run_import(folder: Path, *more: str) -> int:
    from daemon.cli import main

    np.save(folder / "mean.npy", np.zeros(263))
    np.save(folder / "std.npy", np.ones(263))
    statistics = ["--mean", str(folder / "mean.npy"), "--std", str(folder / "std.npy"), "--any-statistics"]
    out = ["--out", str(folder / "official.safetensors"), "--heads", "4", "--json"]
    return main(["import-official", str(folder / "vq.pth"), str(folder / "trans.pth"), *statistics, *out, *more])


def write(folder: Path, vq: State, trans: State) -> None:
    torch.save({"net": vq}, folder / "vq.pth")
    torch.save({"trans": trans}, folder / "trans.pth")


def refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """The message of an import that is refused with nothing written."""
    assert run_import(folder) == 2
    message = capsys.readouterr().err
    assert "internal error" not in message
    assert not (folder / "official.safetensors").exists()
    return message.replace("\n", " ")


class TestImport:
    @pytest.mark.parametrize("name", few_and_long(list(TRANSFORMER)[::4], list(TRANSFORMER)))
    def test_a_damaged_transformer(self, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
        damage, message = TRANSFORMER[name]
        state = dict(golden("t2m_trans_tiny"))
        damage(state)
        write(tmp_path, golden("vqvae_tiny"), state)
        assert_matches(message, refused(tmp_path, capsys))

    @pytest.mark.parametrize("name", few_and_long(list(TOKENIZER)[::4], list(TOKENIZER)))
    def test_a_damaged_tokenizer(self, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
        damage, message = TOKENIZER[name]
        state = dict(golden("vqvae_tiny"))
        damage(state)
        write(tmp_path, state, golden("t2m_trans_tiny"))
        assert_matches(message, refused(tmp_path, capsys))

    def test_heads_that_do_not_divide_the_width(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        write(tmp_path, golden("vqvae_tiny"), golden("t2m_trans_tiny"))
        for heads in ("0", "7", "-4"):
            assert run_import(tmp_path, "--heads", heads) == 2
            assert "heads" in capsys.readouterr().err

    def test_double_precision_is_taken(self, tmp_path: Path) -> None:
        doubled = {k: v.double() for k, v in golden("t2m_trans_tiny").items()}
        write(tmp_path, golden("vqvae_tiny"), doubled)
        assert run_import(tmp_path) == 0


class TestDilationGrowth:
    """The file does not tell how the dilations grow; the training log that the released code leaves beside it does."""

    @staticmethod
    def log(folder: Path, growth: object) -> None:
        arguments = json.dumps({"depth": 3, "dilation_growth_rate": growth, "width": 512}, indent=4)
        (folder / "run.log").write_text(f"2024-06-03 20:22:10,123 INFO {arguments}\n2024 INFO Training on t2m\n")

    def growth(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
        from mmm_core.inference.checkpoint import load_model

        summary = json.loads(capsys.readouterr().out)
        model = load_model(folder / "official.safetensors")
        assert summary["dilation_growth"] == model.tokenizer.config.dilation_growth  # type: ignore[union-attr]
        return summary["dilation_growth"]

    def test_the_log_is_read(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        write(tmp_path, golden("vqvae_tiny"), golden("t2m_trans_tiny"))
        self.log(tmp_path, 2)
        assert run_import(tmp_path) == 0
        assert self.growth(tmp_path, capsys) == 2

    def test_without_a_log_it_is_the_released_one_and_said(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        write(tmp_path, golden("vqvae_tiny"), golden("t2m_trans_tiny"))
        assert run_import(tmp_path) == 0
        output = capsys.readouterr()
        assert json.loads(output.out)["dilation_growth"] == 3
        assert "--dilation-growth" in output.err

    def test_it_can_be_given_and_must_agree_with_the_log(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        write(tmp_path, golden("vqvae_tiny"), golden("t2m_trans_tiny"))
        assert run_import(tmp_path, "--dilation-growth", "2") == 0
        assert self.growth(tmp_path, capsys) == 2
        self.log(tmp_path, 3)
        assert run_import(tmp_path, "--dilation-growth", "2") == 2
        assert "run.log" in capsys.readouterr().err

    @pytest.mark.parametrize("growth", ["0", "-1", "1000000000"])
    def test_one_that_cannot_be(self, tmp_path: Path, capsys: pytest.CaptureFixture[str], growth: str) -> None:
        write(tmp_path, golden("vqvae_tiny"), golden("t2m_trans_tiny"))
        assert run_import(tmp_path, "--dilation-growth", growth) == 2
        assert "dilation" in capsys.readouterr().err


class TestClip:
    @pytest.mark.parametrize(
        ("damage", "message"),
        [
            (put("transformer.resblocks.1000000000.ln_1.weight", torch.ones(64)), r"resblocks\.1000000000"),
            (put("transformer.resblocks.x.ln_1.weight", torch.ones(64)), r"resblocks\.x"),
            (changed("token_embedding.weight", lambda t: t[0]), r"token_embedding\.weight"),
            (changed("text_projection", with_nan), "text_projection'.*not finite"),
            (changed("ln_final.weight", Tensor.to_sparse), r"ln_final\.weight'.*sparse"),
            (changed("ln_final.weight", lambda t: t[:3]), r"norm_out\.weight"),
        ],
    )
    def test_a_damaged_text_tower(self, damage: Callable[[State], None], message: str) -> None:
        state = dict(golden("clip_text_tiny"))
        damage(state)
        with pytest.raises(CheckpointError, match=message):
            clip_from_openai(state, GOLDEN, n_heads=4)


def assert_matches(pattern: str, text: str) -> None:
    import re

    assert re.search(pattern, text), text
