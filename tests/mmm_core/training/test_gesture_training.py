"""Training of the gesture classifier, in small."""

from __future__ import annotations

import itertools
import random
import re
from collections import Counter
from pathlib import Path

import pytest
import torch

from daemon.cli.program import main
from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import load_text_encoder, save_tensors
from mmm_core.inference.own_layers_file import load_classifier
from mmm_core.language.plain_gestures import OUTSIDE, SEVERAL, gestures
from mmm_core.model.gesture_classifier import likeliest
from mmm_core.training.gesture_training import Draw, Texts, train_classifier

GIVEN = (("rap at the gate", "knock"), ("look skywards", "look/up"), ("do my taxes", OUTSIDE))
CLASSES = ("knock", "look/up", OUTSIDE)


def _draw() -> Draw:
    endless = itertools.cycle(GIVEN)
    return lambda: next(endless)


def test_it_learns_the_texts_it_is_given_and_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mmm_core.training.gesture_training.BATCH", 6)
    path = tmp_path / "classifier.safetensors"
    trained = train_classifier(path, _draw(), classes=CLASSES, steps=24)
    encoder, texts = load_text_encoder(), [text for text, _ in GIVEN]
    for classifier in (trained, load_classifier(path)):
        assert [name for name, _ in likeliest(classifier, encoder, texts)] == list(CLASSES)
    assert all(not p.requires_grad for p in trained.parameters())


def test_equal_arguments_give_equal_weights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mmm_core.training.gesture_training.BATCH", 3)
    a, b = (train_classifier(tmp_path / name, _draw(), classes=CLASSES, steps=2) for name in ("a", "b"))
    assert all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


def test_texts_of_every_class_are_drawn_and_none_keeps_a_slot() -> None:
    texts = Texts(random.Random(1))
    drawn = [texts.draw() for _ in range(6000)]
    n_each = Counter(name for _, name in drawn)
    assert set(n_each) == {*gestures(), OUTSIDE, SEVERAL}
    assert n_each[OUTSIDE] > 600 and n_each[SEVERAL] > 600
    assert not [text for text, _ in drawn if re.search(r"\{[SDNnv]\}", text) or not text.strip()]


def test_a_classifier_of_another_text_encoder_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.safetensors"
    save_tensors(path, {}, "mmmd-gesture-classifier", {"config": {}, "text_encoder": "0" * 64})
    with pytest.raises(CheckpointError, match="the packed text encoder"):
        load_classifier(path)


def test_the_command_wants_a_file_for_the_classifier(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "gestures"]) == 2
    assert "--out" in capsys.readouterr().err
