"""Gestures on the beat: equal strokes that begin where tokens begin, and rounds of fresh clips to train on."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch

from mmm_core.corpus.beat import BEAT_S
from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.synthesis import ClipSpec, synthesise, synthesise_spec
from mmm_core.errors import TrainingDataError
from mmm_core.evaluation.reference import reference
from mmm_core.inference.checkpoint import load_model, load_text_encoder
from mmm_core.training.fresh import WEIGHTS_FILE, FreshClips, FreshRecipe, read_weights, usual_weights, weights_of
from mmm_core.training.run import Run, Schedule
from mmm_core.training.transformer_training import Batches, train_transformer
from tests.support.shipped import shipped_engine

REPEATED = (
    "row",
    "wave",
    "clap",
    "swim_crawl",
    "march_arms",
    "nod",
    "punch",
    "arm_circle",
    "drum",
    "fist_pump",
    "steer",
)


@pytest.mark.parametrize("family", REPEATED)
def test_a_stroke_on_the_beat_comes_again_as_it_was(family: str) -> None:
    """Uneven strokes are other ids each time; four equal ones, each of whole tokens, are the same ids four times."""
    sides = FAMILIES[family].sides
    side = "both" if "both" in sides and family not in ("punch", "wave") else sides[0] if sides else ""
    n = 4 if family == "swim_crawl" else 5
    g = Gesture(family, side, n, "forward" if FAMILIES[family].directions and family != "clap" else "")
    clip = synthesise_spec(ClipSpec((g,)), np.random.default_rng(2), BEAT_S)
    assert clip is not None
    core = reference(g).core
    joints = clip.body.joints_m[core.start : core.stop]

    def change_m(period: int) -> float:
        """How far the third stroke is from the second."""
        return float(np.abs(joints[2 * period : 3 * period] - joints[period : 2 * period]).max())

    period = min((p for p in range(12, 45, 4) if len(joints) > 3 * p), key=change_m)
    assert change_m(period) < 2e-3
    ids = shipped_engine().model.tokenizer.encode(torch.from_numpy(clip.features)[None])[0]
    first, tokens = core.start // 4 + (n - 3) * period // 4, period // 4
    assert (ids[first : first + tokens] == ids[first + tokens : first + 2 * tokens]).float().mean() > 0.85


def test_nothing_on_the_beat_is_left_to_chance_but_pauses() -> None:
    g = Gesture("row", "both", 3)
    clips = [synthesise_spec(ClipSpec((g,)), np.random.default_rng(seed), BEAT_S) for seed in range(4)]
    n = min(len(c.features) for c in clips if c is not None) - 16
    first = clips[0]
    assert first is not None
    assert all(c is not None and np.allclose(c.body.joints_m[:n], first.body.joints_m[:n]) for c in clips)
    assert not np.abs(first.body.joints_m[-4:, :13] - first.body.joints_m[-8:-4, :13]).max() > 1e-3  # no sway


def test_families_are_drawn_by_their_weights() -> None:
    drawn = [
        synthesise(np.random.default_rng((4, i)), BEAT_S, {"row": 3.0, "flap": 1.0}).spec.gestures[0].family
        for i in range(60)
    ]
    assert {"row", "flap"} >= {name for name in drawn if name in ("row", "flap")}
    assert drawn.count("row") > drawn.count("flap") > 2


def test_what_does_badly_is_drawn_more_often(tmp_path: Path) -> None:
    found = weights_of({"row": {"share": 0.0, "n": 10}, "flap": {"share": 1.0, "n": 10}})
    assert found["row"] > 5 * found["flap"]
    path = tmp_path / WEIGHTS_FILE
    assert read_weights(path) == usual_weights()
    path.write_text(json.dumps({"row": 9.5}))
    assert read_weights(path)["row"] == 9.5
    path.write_text(json.dumps({"rwo": 9.5}))
    with pytest.raises(TrainingDataError, match="rwo"):
        read_weights(path)


def test_rounds_are_made_when_their_step_comes_and_read_again(tmp_path: Path) -> None:
    model, encoder = load_model(), load_text_encoder()
    how = FreshRecipe(clips=3, first=6, every=2, rounds=2, captions=1)

    def fresh() -> FreshClips:
        return FreshClips(how, tmp_path, model.tokenizer, encoder, 3)

    clips = fresh()
    assert len(clips.corpus(0).ids) == 6
    assert clips.corpus(1) is clips.corpus(0)
    assert len(clips.corpus(2).ids) == 9
    assert len(clips.corpus(4).ids) == 6  # the two newest rounds
    again = fresh().corpus(4)
    assert all(torch.equal(a, b) for a, b in zip(again.ids, clips.corpus(4).ids, strict=True))
    ids, n_tokens, n_seen, text = Batches(again, 60, 0.0).draw(
        torch.Generator().manual_seed(1), model.transformer.config
    )
    assert len(ids) == len(n_tokens) == len(text.sentence) == len(n_seen)
    assert not n_seen.any()


@pytest.mark.long
def test_a_transformer_learns_from_fresh_clips_in_bf16_and_goes_on(tmp_path: Path) -> None:
    """Captions of a round are read inside a step; they were once read in the step's reduced precision, which failed."""
    model, encoder = load_model(), load_text_encoder()
    how = FreshRecipe(clips=2, first=4, every=2, rounds=4, captions=1)
    run = Run(tmp_path, precision="bf16")
    config = model.transformer.config

    def go(steps: int) -> torch.Tensor:
        clips = FreshClips(how, tmp_path, model.tokenizer, encoder, 3)
        schedule = Schedule(steps=steps, learning_rate=1e-4, save_every=1, shape="drop")
        made = train_transformer(
            clips, model.tokenizer, config, schedule, run, tokens_per_batch=40, start=model.transformer
        )
        return made.head.weight.detach()

    first = go(2)
    assert not torch.equal(first, model.transformer.head.weight)
    assert not torch.equal(go(3), first)
    assert (tmp_path / "round_0001.pt").is_file()
