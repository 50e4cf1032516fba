"""Word vectors of the evaluator, and the command that prints its tables."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.errors import CheckpointError, EvaluationError
from mmm_core.evaluation import paper
from mmm_core.evaluation.extractors import (
    OURS,
    Evaluator,
    EvaluatorConfig,
    save_evaluator,
)
from mmm_core.evaluation.words import PARTS_OF_SPEECH, WordVectors, read_vectors
from mmm_core.inference.checkpoint import Model, save_model
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.model.transformer import MotionTransformer, TransformerConfig
from tests.support.evaluator_models import humanml3d_model
from tests.support.motion_folders import make_folder


class TestWords:
    VECTORS: ClassVar = {
        w: np.full(300, i, np.float32) for i, w in enumerate(("unk", "sos", "eos", "a", "wave", "left"))
    }

    def test_marks_parts_of_speech_and_unknown_words(self) -> None:
        words, kinds, lengths = WordVectors(self.VECTORS).read([("a/DET", "wave/VERB", "left/ADV", "qqq/NOUN")])
        assert lengths.tolist() == [6]
        assert words[0, :7, 0].tolist() == [1, 3, 4, 5, 0, 2, 0]
        shown = [PARTS_OF_SPEECH[i] for i in kinds[0, :7].argmax(-1)]
        assert shown == ["OTHER", "DET", "VERB", "Loc_VIP", "OTHER", "OTHER", "OTHER"]

    def test_a_long_caption_is_cut(self) -> None:
        assert WordVectors(self.VECTORS).read([("a/DET",) * 50])[2].tolist() == [22]

    @staticmethod
    def files(folder: Path, words: object = ("unk", "a", "sos", "eos"), index: object = None) -> Path:
        np.save(folder / "our_vab_data.npy", np.arange(1200, dtype=np.float32).reshape(4, 300))
        (folder / "our_vab_words.pkl").write_bytes(pickle.dumps(list(words)))  # type: ignore[call-overload]
        index = index or {word: row for row, word in enumerate(words)}  # type: ignore[arg-type]
        (folder / "our_vab_idx.pkl").write_bytes(pickle.dumps(index))
        return folder

    def test_the_three_files(self, tmp_path: Path) -> None:
        assert read_vectors(self.files(tmp_path)).vectors["a"][0] == 300

    def test_a_pickle_with_code_is_refused(self, tmp_path: Path) -> None:
        (self.files(tmp_path) / "our_vab_words.pkl").write_bytes(pickle.dumps(Path("x")))
        with pytest.raises(CheckpointError, match="nothing was run"):
            read_vectors(tmp_path)

    @pytest.mark.parametrize(
        ("words", "index", "message"),
        [
            (("unk", "a"), None, "'sos': missing"),
            (("unk", "sos", "eos"), {"unk": 0, "sos": 1}, "does not fit"),
            (("unk", "sos", "eos"), {"unk": 0, "sos": 1, "eos": 9}, "does not fit"),
        ],
    )
    def test_files_that_do_not_fit_each_other(self, tmp_path: Path, words: object, index: object, message: str) -> None:
        with pytest.raises(CheckpointError, match=message):
            read_vectors(self.files(tmp_path, words, index))

    @pytest.mark.parametrize("broken", [b"", b"no pickle", b"\x80\x04K", b"(dp0\nS'x"])
    def test_a_broken_pickle_is_named(self, tmp_path: Path, broken: bytes) -> None:
        (self.files(tmp_path) / "our_vab_idx.pkl").write_bytes(broken)
        with pytest.raises(CheckpointError, match="our_vab_idx"):
            read_vectors(tmp_path)

    def test_captions_without_tokens_are_refused(self) -> None:
        with pytest.raises(EvaluationError, match="tokens"):
            WordVectors(self.VECTORS).read([("a/DET",), ()])

    def test_a_missing_file_is_named(self, tmp_path: Path) -> None:
        with pytest.raises(CheckpointError, match="our_vab_data"):
            read_vectors(tmp_path)


def small_model(path: Path) -> Path:
    """A model by body parts with random weights."""
    torch.manual_seed(0)
    tokenizer = Tokenizer(TokenizerConfig(n_codes=16, code_dim=8, decoder_width=16))
    transformer = MotionTransformer(TransformerConfig(16, 3, 8, 32, 2, 1, 1))
    save_model(path, Model(tokenizer, transformer, None, None, {}))
    return path


class TestCommand:
    """On a folder of four motions: too few for R-precision, enough to see every table."""

    @pytest.mark.long
    def test_paper_prints_every_table(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(paper, "STEPS", (2, 4))
        folder = make_folder(tmp_path / "data")
        model = str(small_model(tmp_path / "m.safetensors"))
        command = [
            "eval",
            "paper",
            "--data",
            str(folder),
            "--model",
            model,
            "--repeats",
            "2",
            "--motions-per-text",
            "2",
        ]
        assert main([*command, "--json"]) == 0
        figures = json.loads(capsys.readouterr().out)
        assert [title[0] for title in figures["tables"]] == ["1", "3", "4", "5", "6"]
        lines = figures["tables"]["1 (comparison)"]
        assert list(lines) == ["real motion", "real motion, one half against the other", "tokenizer", "generated"]
        assert len(figures["tables"]["4 (editing in time)"]) == 4
        assert "left_arm and right_arm" in figures["tables"]["5 (editing the upper body)"]
        assert lines["real motion"]["FID"][0] == pytest.approx(0.0, abs=1e-3)
        assert figures["n"] == 4

    @pytest.mark.long
    def test_the_published_evaluator_with_its_words(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        """A user's files: finest.tar, GloVe, statistics, a HumanML3D folder and a model with its rest directions."""
        folder = make_folder(tmp_path / "data")
        humanml3d_model(tmp_path / "m.safetensors")
        made = Evaluator(EvaluatorConfig()).eval()
        parts = ("movement_encoder", "text_encoder", "motion_encoder")
        torch.save({p: getattr(made, p).state_dict() for p in parts}, tmp_path / "finest.tar")
        (tmp_path / "glove").mkdir()
        TestWords.files(tmp_path / "glove")
        command = [
            "eval", "paper", "--data", str(folder), "--model", str(tmp_path / "m.safetensors"), "--tables", "1",
            "--evaluator", str(tmp_path / "finest.tar"), "--glove", str(tmp_path / "glove"), "--repeats", "1",
            "--evaluator-mean", str(folder / "Mean.npy"), "--evaluator-std", str(folder / "Std.npy"),
            "--motions-per-text", "2",
        ]  # fmt: skip
        assert main(command) == 0
        shown = capsys.readouterr().out
        assert "Table 1 (comparison)" in shown
        assert "Table 3" not in shown
        (tmp_path / "std.npy").write_bytes(b"nothing")
        assert main([*command, "--evaluator-std", str(tmp_path / "std.npy")]) == 2
        assert "std.npy" in capsys.readouterr().err

    @pytest.mark.long
    def test_kits_comparison_is_table_two(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        folder = make_folder(tmp_path / "data", "kit")
        humanml3d_model(tmp_path / "m.safetensors", 251)
        torch.manual_seed(0)
        save_evaluator(tmp_path / "e.safetensors", Evaluator(replace(OURS, n_features=251, rest_pose="humanml3d")), {})
        command = ["eval", "paper", "--data", str(folder), "--model", str(tmp_path / "m.safetensors"), "--tables", "2", "5",
                   "--evaluator", str(tmp_path / "e.safetensors"), "--repeats", "1", "--motions-per-text", "2"]  # fmt: skip
        assert main([*command, "--json"]) == 0
        tables = json.loads(capsys.readouterr().out)["tables"]
        assert list(tables) == ["2 (comparison)", "5 (editing the upper body)"]
        assert tables["5 (editing the upper body)"] == {}, "one codebook for the whole body has no parts"
        assert main(command) == 0
        assert "no body parts" in capsys.readouterr().out

    def test_real_gives_its_keys(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        folder = make_folder(tmp_path / "data")
        command = ["eval", "real", "--data", str(folder), "--repeats", "1", "--motions-per-text", "2", "--json"]
        assert main(command) == 0
        figures = json.loads(capsys.readouterr().out)
        wanted = ("r1_ratio", "fid_ratio", "r_precision", "fid", "mm_dist", "diversity", "mmodality", "n", "caveat",
                  "machine", "versions", "seed", "method", "checkpoint", "evaluator")  # fmt: skip
        assert all(key in figures for key in wanted)
        assert figures["r1_ratio"] is None, "four motions are no pool of 32"
        assert figures["fid_ratio"] == pytest.approx(
            figures["fid"]["generated"] / figures["fid"]["tokenizer"], rel=1e-3
        )

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ([], "--data"),
            (["--data", "x", "--repeats", "0"], "1 to 1000"),
            (["--data", "x", "--motions-per-text", "1"], "2 to 1000"),
            (["--data", "x", "--tables", "7"], "1 to 6"),
            (["--data", "x", "--temperature", "-1"], "0 to 10"),
            (["--data", "x", "--glove", "g"], "--evaluator-mean"),
        ],
    )
    def test_bad_use_is_told(self, options: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["eval", "real", *options]) == 2
        assert message in capsys.readouterr().err

    def test_the_probes_are_shown_by_robots_that_there_are(self, capfd: pytest.CaptureFixture[str]) -> None:
        assert main(["eval", "probes", "--robots", "op3", "op9"]) == 2
        told = capfd.readouterr().err
        assert "op9" in told and "poppy_torso" in told
