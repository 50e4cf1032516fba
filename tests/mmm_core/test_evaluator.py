"""The evaluator: published shapes load, padding changes nothing, it learns, and the command prints every table."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
import torch

from daemon.cli import main
from mmm_core.checkpoint import EVALUATOR_FILE
from mmm_core.errors import CheckpointError, TrainingDataError
from mmm_core.evaluation.extractors import (
    OURS,
    Evaluator,
    EvaluatorConfig,
    load_evaluator,
    load_published,
    save_evaluator,
)
from mmm_core.evaluation.protocol import read_pairs
from mmm_core.evaluation.words import PARTS_OF_SPEECH, WordVectors, read_vectors
from tests.mmm_core.folders import make_folder

PUBLISHED = {
    "movement_encoder": {"main.0.weight": (512, 259, 4), "main.3.weight": (512, 512, 4), "out_net.weight": (512, 512)},
    "text_encoder": {"pos_emb.weight": (300, 15), "input_emb.weight": (512, 300), "gru.weight_hh_l0_reverse": (1536, 512),
                     "output_net.3.weight": (512, 512), "hidden": (2, 1, 512)},
    "motion_encoder": {"input_emb.weight": (1024, 512), "gru.weight_ih_l0": (3072, 1024),
                       "output_net.0.weight": (1024, 2048), "hidden": (2, 1, 1024)},
}  # fmt: skip
"""Shapes from the fact sheet sec. 8 and Guo et al.'s published file."""


@pytest.mark.parametrize("part", sorted(PUBLISHED))
def test_the_default_sizes_are_the_published_ones(part: str) -> None:
    state = getattr(Evaluator(EvaluatorConfig()), part).state_dict()
    for name, shape in PUBLISHED[part].items():
        assert tuple(state[name].shape) == shape, name


def test_a_published_file_loads_and_gives_the_same_vectors(tmp_path: Path) -> None:
    torch.manual_seed(0)
    made = Evaluator(EvaluatorConfig()).eval()
    parts = ("movement_encoder", "text_encoder", "motion_encoder")
    torch.save({p: getattr(made, p).state_dict() for p in parts} | {"epoch": 3}, tmp_path / "finest.tar")
    loaded = load_published(tmp_path / "finest.tar", torch.zeros(263), torch.ones(263))
    motion = torch.randn(60, 263)
    with torch.inference_mode():
        torch.testing.assert_close(loaded.motions([motion]), made.motions([motion]))


@pytest.mark.parametrize("content", [b"nothing", None])
def test_another_file_is_refused(tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "finest.tar"
    if content is None:
        torch.save({"net": {}}, path)
    else:
        path.write_bytes(content)
    with pytest.raises(CheckpointError, match=r"finest\.tar"):
        load_published(path, torch.zeros(263), torch.ones(263))


@torch.inference_mode()
def test_a_batch_gives_each_motion_and_text_what_it_gets_alone() -> None:
    """But for the last snippet's convolution, which sees the padding as the published one does: so lengths are equal there."""
    torch.manual_seed(0)
    evaluator = Evaluator(OURS).eval()
    motions = [torch.randn(40, 263), torch.randn(40, 263)]
    together = evaluator.motions(motions)
    alone = torch.cat([evaluator.motions([m]) for m in motions])
    torch.testing.assert_close(together, alone, atol=1e-5, rtol=1e-4)
    words, lengths = torch.randn(2, 9, 384), torch.tensor([9, 4])
    texts = evaluator.texts(words, None, lengths)
    torch.testing.assert_close(texts[1:], evaluator.texts(words[1:, :4], None, lengths[1:]), atol=1e-5, rtol=1e-4)


@torch.inference_mode()
def test_foot_contacts_are_not_seen() -> None:
    evaluator, motion = Evaluator(OURS).eval(), torch.randn(40, 263)
    other = motion.clone()
    other[:, 259:] = 5.0
    torch.testing.assert_close(evaluator.motions([motion]), evaluator.motions([other]))


def test_ours_is_saved_and_read_back(tmp_path: Path) -> None:
    torch.manual_seed(0)
    made = Evaluator(OURS).eval()
    made.mean.normal_()
    save_evaluator(tmp_path / "e.safetensors", made, {"data": "none"})
    read, provenance = load_evaluator(tmp_path / "e.safetensors")
    assert provenance == {"data": "none"}
    torch.testing.assert_close(read.mean, made.mean)
    with pytest.raises(CheckpointError, match="kind"):
        load_evaluator(Path(str(EVALUATOR_FILE)).with_name("mmm_compact.safetensors"))


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
    def files(folder: Path, words: object = ("unk", "a"), index: object = None) -> Path:
        np.save(folder / "our_vab_data.npy", np.arange(600, dtype=np.float32).reshape(2, 300))
        (folder / "our_vab_words.pkl").write_bytes(pickle.dumps(list(words)))  # type: ignore[call-overload]
        (folder / "our_vab_idx.pkl").write_bytes(pickle.dumps(index or {"unk": 0, "a": 1}))
        return folder

    def test_the_three_files(self, tmp_path: Path) -> None:
        assert read_vectors(self.files(tmp_path)).vectors["a"][0] == 300

    def test_a_pickle_with_code_is_refused(self, tmp_path: Path) -> None:
        (self.files(tmp_path) / "our_vab_words.pkl").write_bytes(pickle.dumps(Path("x")))
        with pytest.raises(CheckpointError, match="nothing was run"):
            read_vectors(tmp_path)

    def test_a_missing_file_is_named(self, tmp_path: Path) -> None:
        with pytest.raises(CheckpointError, match="our_vab_data"):
            read_vectors(tmp_path)


def test_pairs_of_a_folder(tmp_path: Path) -> None:
    pairs = read_pairs(make_folder(tmp_path / "data"), ["test"])
    assert {p.text for p in pairs} == {"a person waves.", "he sways"}
    assert all(len(p.features) % 4 == 0 for p in pairs)
    with pytest.raises(TrainingDataError):
        read_pairs(tmp_path, ["test"])


class TestCommand:
    """On a folder of two motions: too few for R-precision, enough to see every table."""

    def test_paper_prints_every_table(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        folder = make_folder(tmp_path / "data")
        assert main(["eval", "paper", "--data", str(folder), "--repeats", "2", "--json"]) == 0
        figures = json.loads(capsys.readouterr().out)
        assert [title[0] for title in figures["tables"]] == ["1", "3", "4", "5", "6"]
        assert set(figures["tables"]["1 (comparison)"]) == {"real motion", "tokenizer", "generated"}
        assert len(figures["tables"]["4 (editing in time)"]) == 4
        assert "left_arm and right_arm" in figures["tables"]["5 (editing the upper body)"]
        assert figures["tables"]["1 (comparison)"]["real motion"]["FID"][0] == pytest.approx(0.0, abs=1e-3)

    def test_real_gives_its_keys(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        folder = make_folder(tmp_path / "data")
        assert main(["eval", "real", "--data", str(folder), "--repeats", "1", "--json"]) == 0
        figures = json.loads(capsys.readouterr().out)
        wanted = ("r1_ratio", "fid_ratio", "r_precision", "fid", "mm_dist", "diversity", "mmodality", "n", "caveat")
        assert all(key in figures for key in wanted)
        assert figures["r1_ratio"] is None, "four pairs are no pool of 32"

    def test_without_data_it_says_what_is_missing(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["eval", "real"]) == 2
        assert "--data" in capsys.readouterr().err
