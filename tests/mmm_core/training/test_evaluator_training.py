"""Training of the evaluator: texts and their motions come together, captions that are shared are not pushed apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from mmm_core.errors import TrainingDataError
from mmm_core.evaluation import metrics
from mmm_core.evaluation.extractors import Evaluator, EvaluatorConfig
from mmm_core.training.batches import CaptionStates, Clip
from mmm_core.training.evaluator_training import MARGIN, train_evaluator
from mmm_core.training.run import Run, Schedule

SMALL = EvaluatorConfig(
    movement=24, text_hidden=24, motion_hidden=24, embedding=8, word=12, part_of_speech=0, rest_pose="mmmd"
)
N = 8


def corpus(n_captions: int) -> tuple[list[Clip], CaptionStates, list[list[int]]]:
    """N motions that differ in where they stand and sway; motion i has caption i modulo `n_captions`."""
    rng = np.random.default_rng(0)
    places = rng.normal(size=(N, 263))
    sway = np.sin(np.arange(60) / 4)[:, None] * rng.normal(size=263)
    clips = [Clip((place + 0.3 * sway).astype(np.float32), ["x"], True) for place in places]
    words = torch.from_numpy(rng.normal(size=(n_captions * 3, 12))).half()
    states = CaptionStates(words, np.full(n_captions, 3), words[::3])
    return clips, states, [[i % n_captions] for i in range(N)]


def trained(n_captions: int, steps: int, folder: Path) -> tuple[Evaluator, list[Clip], CaptionStates]:
    clips, states, rows = corpus(n_captions)
    schedule = Schedule(steps, learning_rate=5e-3, warmup_steps=5, ema_decay=0.9, seed=1)
    return train_evaluator(clips, states, rows, schedule, Run(folder), SMALL), clips, states


@torch.inference_mode()
def vectors(evaluator: Evaluator, clips: list[Clip], states: CaptionStates, n: int) -> tuple[np.ndarray, np.ndarray]:
    text = states.gather(range(n))
    texts = evaluator.texts(text.words, None, text.word_mask.sum(1)).numpy()
    return texts, evaluator.motions([torch.from_numpy(c.features) for c in clips]).numpy()


@pytest.mark.long
def test_texts_find_their_motions_and_others_move_away(tmp_path: Path) -> None:
    """Far from done after so few steps, and far from chance (1 in 8)."""
    texts, motions = vectors(*trained(N, 100, tmp_path), N)
    gap = metrics.distances(texts, motions)
    others = ~np.eye(N, dtype=bool)
    assert metrics.r_precision(texts, motions, np.random.default_rng(0), pool=N)[1] >= 3 / N
    assert metrics.mm_dist(texts, motions) < 0.6 * np.median(gap[others])
    assert np.median(gap[others]) > 0.3 * MARGIN


@pytest.mark.long
def test_captions_that_several_motions_share_are_not_pushed_apart(tmp_path: Path) -> None:
    """Salsa has many recordings and one sentence: all of them lie near it, none is a wrong answer to it."""
    texts, motions = vectors(*trained(4, 80, tmp_path), 4)
    gap = metrics.distances(texts, motions)
    own = np.arange(N) % 4 == np.arange(4)[:, None]
    assert gap[own].max() < np.median(gap[~own])
    assert gap[own].mean() < 0.3 * MARGIN


def test_the_statistics_are_those_of_the_clips(tmp_path: Path) -> None:
    evaluator, clips, _ = trained(N, 2, tmp_path)
    features = np.concatenate([c.features for c in clips])
    np.testing.assert_allclose(evaluator.mean.numpy(), features.mean(0), atol=1e-4)
    assert (evaluator.std > 0).all()


def test_clips_that_are_all_too_short_are_refused(tmp_path: Path) -> None:
    _, states, rows = corpus(N)
    short = [Clip(np.zeros((20, 263), np.float32), ["x"], True) for _ in range(N)]
    with pytest.raises(TrainingDataError, match="at least 24 frames"):
        train_evaluator(short, states, rows, Schedule(2), Run(tmp_path), SMALL)
