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
from mmm_core.model.gesture_classifier import meant_by, meant_by_parts, own_states
from mmm_core.model.sentence_tagger import pieces_of, word_states
from mmm_core.training.drawn_text import SETTLING_SHARES, SHARES, Drawn
from mmm_core.training.gesture_texts import Texts
from mmm_core.training.gesture_training import Draw, train_classifier

GIVEN = (
    Drawn("rap at the gate", "knock", frozenset({"fast"}), is_denied=False),
    Drawn("look skywards", "look/up", frozenset()),
    Drawn("do my taxes", OUTSIDE, None, is_denied=True),
    Drawn("as slow as syrup", None, frozenset({"slow", "small"})),
    Drawn("once you have knocked, look up", "knock", part=(14, 21)),
    Drawn("once you have knocked, look up", "look/up", part=(23, 30)),
)
CLASSES = ("knock", "look/up", OUTSIDE)


def _draw() -> Draw:
    endless = itertools.cycle(GIVEN)
    return lambda: next(endless)


@pytest.mark.long
def test_it_learns_the_texts_it_is_given_and_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mmm_core.training.gesture_training.BATCH", 12)
    path = tmp_path / "classifier.safetensors"
    trained = train_classifier(path, _draw(), classes=CLASSES, steps=48)
    encoder, texts = load_text_encoder(), [one.text for one in GIVEN]
    for classifier in (trained, load_classifier(path)):
        meant = meant_by(classifier, encoder, texts)
        assert [name for name, _, _, _ in meant[:3]] == list(CLASSES)
        found = [{manner for manner, p in manners.items() if p > 0.5} for _, _, manners, _ in meant]
        assert [found[i] for i in (0, 1, 3)] == [{"fast"}, set(), {"slow", "small"}]
        assert meant[0][3] < 0.5 < meant[2][3]
        words = word_states(
            encoder, classifier.config.n_shared, [["once", "you", "have", "knocked", ",", "look", "up"]]
        )[0]
        own = own_states(classifier, words.states[None], torch.ones(1, len(words.states), dtype=torch.bool))
        parts = meant_by_parts(classifier, own, pieces_of(words, [(3,), (5, 6)]))
        assert [name for name, _ in parts] == ["knock", "look/up"]
    assert all(not p.requires_grad for p in trained.parameters())


def test_equal_arguments_give_equal_weights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mmm_core.training.gesture_training.BATCH", 4)
    a, b = (train_classifier(tmp_path / name, _draw(), classes=CLASSES, steps=2) for name in ("a", "b"))
    assert all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


def test_texts_of_every_class_are_drawn_and_none_keeps_a_slot() -> None:
    texts = Texts(random.Random(1))
    drawn = [texts.draw() for _ in range(6000)]
    n_each = Counter(one.name for one in drawn)
    assert set(n_each) == {*gestures(), OUTSIDE, SEVERAL, None}
    assert n_each[OUTSIDE] > 600 and n_each[SEVERAL] > 600
    assert {manner for one in drawn for manner in one.manners or ()} == {"slow", "fast", "small", "large"}
    assert sum(bool(one.is_denied) for one in drawn) > 200
    assert not [one.text for one in drawn if re.search(r"\{[SDNnv]\}", one.text) or not one.text.strip()]


def test_parts_are_commands_and_denied_acts_are_no_gesture() -> None:
    texts = Texts(random.Random(2))
    parts = [one for one in (texts.draw() for _ in range(4000)) if one.part is not None]
    said = [one.text[slice(*one.part)] for one in parts if one.part is not None]
    assert len(parts) > 500 and all(words and words == words.strip() for words in said)
    assert sum(one.name == OUTSIDE for one in parts) > 100 and len({one.name for one in parts}) > 140


def test_shares_leave_single_gestures_room() -> None:
    for shares in (SHARES, SETTLING_SHARES):
        assert 0.3 < 1 - sum(shares[:-1]) < 0.6
    texts = Texts(random.Random(3), SETTLING_SHARES._replace(outside=1.0))
    assert {texts.draw().name for _ in range(20)} == {OUTSIDE}


def test_a_classifier_of_another_text_encoder_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.safetensors"
    save_tensors(path, {}, "mmmd-gesture-classifier", {"config": {}, "text_encoder": "0" * 64})
    with pytest.raises(CheckpointError, match="the packed text encoder"):
        load_classifier(path)


def test_the_command_wants_a_file_for_the_classifier(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "gestures"]) == 2
    assert "--out" in capsys.readouterr().err
