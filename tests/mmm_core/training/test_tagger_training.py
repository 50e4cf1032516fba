"""Training of the sentence tagger, in small."""

from __future__ import annotations

from pathlib import Path

import pytest
import torch

from daemon.cli.program import main
from mmm_core.corpus.marked_sentences import TaggedSentence, load_manner_sentences, load_marked_sentences
from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import load_text_encoder, save_tensors
from mmm_core.inference.own_layers_file import load_tagger
from mmm_core.language.tagged_words import MANNERS, TAGS
from mmm_core.model.sentence_tagger import SentenceTagger, log_probability, word_states
from mmm_core.training.tagger_training import train_tagger


def _share_right(tagger: SentenceTagger, sentences: list[TaggedSentence]) -> float:
    encoder = load_text_encoder()
    right: list[bool] = []
    for one in sentences:
        (states,) = word_states(encoder, tagger.config.n_shared, [one.words])
        for scores, names, marks in zip(
            log_probability(tagger, states), (TAGS, MANNERS), (one.tags, one.manners), strict=True
        ):
            right += [names[int(row.argmax())] == mark for row, mark in zip(scores, marks, strict=False)]
    return sum(right) / len(right)


@pytest.mark.long
def test_it_learns_the_sentences_it_is_given_and_is_read_back(tmp_path: Path) -> None:
    given = [*load_marked_sentences()[:6], *load_manner_sentences()[:4]]
    tagger = train_tagger(tmp_path / "tagger.safetensors", given, steps=45)
    assert _share_right(tagger, given) > 0.85
    again = load_tagger(tmp_path / "tagger.safetensors")
    assert _share_right(again, given) > 0.85
    assert all(not p.requires_grad for p in again.parameters())


@pytest.mark.long
def test_equal_arguments_give_equal_weights(tmp_path: Path) -> None:
    given = [*load_marked_sentences()[:2], *load_manner_sentences()[:2]]
    a, b = (train_tagger(tmp_path / name, given, steps=2) for name in ("a", "b"))
    assert all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


def test_a_tagger_of_another_text_encoder_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.safetensors"
    save_tensors(path, {}, "mmmd-sentence-tagger", {"config": {}, "text_encoder": "0" * 64})
    with pytest.raises(CheckpointError, match="the packed text encoder"):
        load_tagger(path)


def test_the_command_wants_a_file_for_the_tagger(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "tagger"]) == 2
    assert "--out" in capsys.readouterr().err
