"""The evaluator: published shapes load, neighbours change nothing, what does not fit is refused, every table is printed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch

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
from mmm_core.inference.checkpoint import EVALUATOR_FILE, load_text_encoder
from mmm_core.motion.features import features_from_joints
from tests.support.evaluator_models import humanml3d_model
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


def test_pairs_of_a_folder(tmp_path: Path) -> None:
    pairs = read_pairs(make_folder(tmp_path / "data"), ["test"])
    assert {p.text for p in pairs} == {"a person waves.", "he sways"}
    assert all(len(p.features) % 4 == 0 for p in pairs)
    with pytest.raises(TrainingDataError):
        read_pairs(tmp_path, ["test"])


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
        engine, text = shipped_engine(), "nod your head, then run away"
        assert engine.understand(text)[1].kept == "nod your head"
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
