"""The evaluator: published shapes load, neighbours change nothing, what does not fit is refused, every table is printed."""

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
from mmm_core.errors import CheckpointError, EvaluationError, TrainingDataError
from mmm_core.evaluation import paper, report
from mmm_core.evaluation.extractors import (
    OURS,
    Evaluator,
    EvaluatorConfig,
    load_evaluator,
    load_published,
    save_evaluator,
)
from mmm_core.evaluation.pairs import Pair, pairs_for, read_pairs, to_our_rest_pose
from mmm_core.evaluation.protocol import measure, measure_same, one_caption_each, text_states
from mmm_core.evaluation.reader import Reader
from mmm_core.evaluation.words import PARTS_OF_SPEECH, WordVectors, read_vectors
from mmm_core.generate.engine import Engine
from mmm_core.inference.checkpoint import EVALUATOR_FILE, Model, load_text_encoder, save_model
from mmm_core.model.tokenizer import Tokenizer, TokenizerConfig
from mmm_core.model.transformer import MotionTransformer, TransformerConfig
from mmm_core.model.vqvae import VqVae, VqVaeConfig
from mmm_core.motion.features import features_from_joints
from tests.support.motion_folders import make_folder, standing
from tests.support.shipped import shipped_engine

DATA = Path(__file__).parents[4] / "shared" / "data"

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
    """A short motion beside a long one once had another vector: its last convolution saw that padding followed."""
    torch.manual_seed(0)
    evaluator = Evaluator(OURS).eval()
    motions = [torch.randn(n, 263) for n in (40, 196, 24, 100)]
    together = evaluator.motions(motions)
    alone = torch.cat([evaluator.motions([m]) for m in motions])
    torch.testing.assert_close(together, alone, atol=1e-5, rtol=1e-4)
    words, lengths = torch.randn(2, 9, 384), torch.tensor([9, 4])
    texts = evaluator.texts(words, None, lengths)
    torch.testing.assert_close(texts[1:], evaluator.texts(words[1:, :4], None, lengths[1:]), atol=1e-5, rtol=1e-4)


def gru(state: dict[str, torch.Tensor], x: np.ndarray, hidden: np.ndarray, suffix: str) -> np.ndarray:
    """Last state of one direction over (N, D) vectors, by the equations of Cho et al. 2014, step by step."""
    weights = {k: state[f"gru.{k}_l0{suffix}"].numpy() for k in ("weight_ih", "weight_hh", "bias_ih", "bias_hh")}
    for row in x:
        reset_in, update_in, new_in = np.split(weights["weight_ih"] @ row + weights["bias_ih"], 3)
        reset_h, update_h, new_h = np.split(weights["weight_hh"] @ hidden + weights["bias_hh"], 3)
        reset, update = (1 / (1 + np.exp(-v)) for v in (reset_in + reset_h, update_in + update_h))
        hidden = (1 - update) * np.tanh(new_in + reset * new_h) + update * hidden
    return hidden


@torch.inference_mode()
def test_the_readers_are_the_equations_written_out() -> None:
    """Both directions from their learnt start, forward first, to the length given and no further; POS added to words."""
    torch.manual_seed(1)
    reader = Evaluator(EvaluatorConfig(text_hidden=8, embedding=6, word=5, movement=4, motion_hidden=4)).text_encoder
    state = reader.eval().state_dict()
    words, kinds = torch.randn(2, 7, 5), torch.nn.functional.one_hot(torch.randint(15, (2, 7)), 15).float()
    found = reader(words, kinds, torch.tensor([7, 4]))
    for row, n in enumerate((7, 4)):
        x = words[row, :n] + kinds[row, :n] @ state["pos_emb.weight"].T + state["pos_emb.bias"]
        x = (x @ state["input_emb.weight"].T + state["input_emb.bias"]).numpy()
        ends = [gru(state, x, state["hidden"][0, 0].numpy(), ""),
                gru(state, x[::-1], state["hidden"][1, 0].numpy(), "_reverse")]  # fmt: skip
        middle = state["output_net.0.weight"].numpy() @ np.concatenate(ends) + state["output_net.0.bias"].numpy()
        middle = (middle - middle.mean()) / np.sqrt(middle.var() + 1e-5)
        middle = middle * state["output_net.1.weight"].numpy() + state["output_net.1.bias"].numpy()
        middle = np.where(middle > 0, middle, 0.2 * middle)
        expected = state["output_net.3.weight"].numpy() @ middle + state["output_net.3.bias"].numpy()
        np.testing.assert_allclose(found[row].numpy(), expected, atol=1e-5)


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


def test_pairs_of_a_folder(tmp_path: Path) -> None:
    pairs = read_pairs(make_folder(tmp_path / "data"), ["test"])
    assert {p.text for p in pairs} == {"a person waves.", "he sways"}
    assert all(len(p.features) % 4 == 0 for p in pairs)
    with pytest.raises(TrainingDataError):
        read_pairs(tmp_path, ["test"])


def small_model(path: Path) -> Path:
    """A model by body parts with random weights."""
    torch.manual_seed(0)
    tokenizer = Tokenizer(TokenizerConfig(n_codes=16, code_dim=8, decoder_width=16))
    transformer = MotionTransformer(TransformerConfig(16, 3, 8, 32, 2, 1, 1))
    save_model(path, Model(tokenizer, transformer, None, None, {}))
    return path


def humanml3d_model(path: Path, n_features: int = 263) -> Engine:
    """The same with one codebook and HumanML3D's rest directions, as an import or a training on a folder has."""
    torch.manual_seed(0)
    tokenizer = VqVae(VqVaeConfig(n_codes=16, code_dim=8, width=16, depth=1, n_features=n_features))
    transformer = MotionTransformer(TransformerConfig(16, 1, 8, 32, 2, 1, 1))
    save_model(path, Model(tokenizer, transformer, None, None, {}, rest_pose="humanml3d"))
    return Engine.load(path, threads=None)


def test_a_split_that_a_folder_lacks_is_told_how_it_is_made(tmp_path: Path) -> None:
    """ "Expected a folder with this split" told nobody that a line of clips.jsonl decides."""
    np.save(tmp_path / "stand.npy", standing(40).astype(np.float32))
    (tmp_path / "clips.jsonl").write_text('{"trial": "stand", "captions": ["stand"]}')
    with pytest.raises(TrainingDataError, match=r'"split": "test" in lines of clips\.jsonl, or another --split'):
        read_pairs(tmp_path, ["val", "test"])


@pytest.mark.parametrize(("n", "missing"), [(31, True), (32, False)])
def test_few_motions_are_told_that_they_fill_no_pool(n: int, missing: bool) -> None:
    pairs = [Pair(np.zeros((4, 263), np.float32), f"text {i}", (), i) for i in range(n)]
    said = report.sizes(report.load_reader()[0], pairs)["caveat"]
    assert ("R-precision is not measured" in said) == missing


class TestWhatFits:
    def test_a_repeat_takes_each_motion_once_with_one_of_its_captions(self) -> None:
        pairs = [Pair(np.zeros((40, 263), np.float32), f"{m}{c}", (), m) for m in range(5) for c in range(3)]
        drawn = [one_caption_each(pairs, np.random.default_rng(seed)) for seed in range(40)]
        assert all([pairs[row].motion for row in rows] == [0, 1, 2, 3, 4] for rows in drawn)
        assert {row for rows in drawn for row in rows} == set(range(15))

    def test_a_caption_is_measured_whole_though_a_part_of_it_would_be_done(self) -> None:
        engine, text = shipped_engine(), "clap your hands, then run away"
        assert engine.understand(text)[1].kept == "clap your hands"
        states = text_states(engine, [Pair(np.zeros((40, 263), np.float32), text, (), 0)])
        assert torch.equal(states.words, engine.encoder.encode([text]).words)

    def test_motions_that_nothing_changes_are_measured_as_if_made_each_time(self) -> None:
        rng = np.random.default_rng(0)
        motions = [rng.normal(size=(40, 263)).astype(np.float32) for _ in range(33)]
        pairs = [Pair(m, f"text {i} {c}", (), i) for i, m in enumerate(motions) for c in range(2)]
        reader = report.load_reader()[0]
        again = measure(reader, pairs, lambda some, _seed: [p.features for p in some], 3)
        assert measure_same(reader, pairs, lambda some, _seed: [p.features for p in some], 3) == again
        assert again["FID"].mean == pytest.approx(0.0, abs=1e-4)
        assert again.keys() == {"R1", "R2", "R3", "FID", "MM-Dist", "Diversity"}

    def test_the_released_model_is_measured_at_temperature_one(self, tmp_path: Path) -> None:
        official, ours = humanml3d_model(tmp_path / "m.safetensors"), shipped_engine()
        assert official.settings.temperature == 0.0
        assert paper.for_evaluation(official).settings.temperature == 1.0
        assert paper.for_evaluation(ours).settings == ours.settings
        assert paper.for_evaluation(ours, 0.9).settings.temperature == 0.9

    def test_a_humanml3d_folder_is_brought_to_our_rest_directions(self, tmp_path: Path) -> None:
        folder = make_folder(tmp_path / "data")
        ours = features_from_joints(standing(60))
        turned = ours.copy()
        turned[:, 67:193] = np.random.default_rng(0).normal(size=126)  # somebody else's rest directions
        np.save(folder / "new_joint_vecs" / "000001.npy", turned)
        pair = next(p for p in pairs_for([shipped_engine()], folder, ["test"]) if p.text == "a person waves.")
        np.testing.assert_allclose(pair.features, ours, atol=1e-3)
        np.testing.assert_allclose(to_our_rest_pose(turned), ours, atol=1e-3)
        kept = pairs_for([humanml3d_model(tmp_path / "m.safetensors")], folder, ["test"])
        assert any(np.array_equal(p.features, turned) for p in kept)

    def test_what_does_not_fit_is_refused_by_name(self, tmp_path: Path) -> None:
        ours, theirs = shipped_engine(), humanml3d_model(tmp_path / "m.safetensors")
        folder = make_folder(tmp_path / "data")
        with pytest.raises(EvaluationError, match=r"models with 263 features \(humanml3d\) and 263 features \(mmmd\)"):
            pairs_for([ours, theirs], folder, ["test"])
        with pytest.raises(EvaluationError, match="251 features, the model 263"):
            pairs_for([ours], make_folder(tmp_path / "kit", "kit"), ["test"])
        small = EvaluatorConfig(word=384, part_of_speech=0, text_hidden=8, embedding=6, movement=4, motion_hidden=4)
        published = Reader(Evaluator(small).eval(), load_text_encoder())
        with pytest.raises(EvaluationError, match="rest directions"):
            published.fit(ours)
        kit = Reader(Evaluator(replace(small, n_features=251)).eval(), load_text_encoder())
        with pytest.raises(EvaluationError, match="motions of 263 features; expected 251"):
            kit.fit(theirs)
        with pytest.raises(EvaluationError, match="words of width 384; expected 300"):
            Reader(Evaluator(replace(small, word=300)), load_text_encoder())

    @pytest.mark.skipif(not DATA.is_dir(), reason="the data set is not beside the checkout")
    def test_our_clips_have_no_humanml3d_rotations(self, tmp_path: Path) -> None:
        with pytest.raises(EvaluationError, match="rest directions"):
            pairs_for([humanml3d_model(tmp_path / "m.safetensors")], DATA, ["val"])

    @pytest.mark.skipif(not DATA.is_dir(), reason="the data set is not beside the checkout")
    def test_the_shipped_evaluator_finds_real_motions_by_their_captions(self) -> None:
        """On held-out recordings: four times chance at least, or no figure made with it says anything."""
        pairs, reader = read_pairs(DATA, ["test"]), report.load_reader()[0]
        row = measure_same(reader, pairs, lambda some, _seed: [p.features for p in some], 5)
        assert row["R1"].mean > 4 / 32
        assert row["R3"].mean > 8 / 32


class TestCommand:
    """On a folder of four motions: too few for R-precision, enough to see every table."""

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
        assert main([*command, "--evaluator-std", str(tmp_path / "std.npy")]) == 1
        assert "std.npy" in capsys.readouterr().err

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
