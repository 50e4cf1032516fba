"""Phrases of writers, which the gesture classifier learns from."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mmm_core.corpus.heldout import read_sentences
from mmm_core.corpus.labelled_sentences import LABELLED_SENTENCES
from mmm_core.corpus.written_phrases import load_written_phrases
from mmm_core.errors import TrainingDataError
from mmm_core.language.plain_gestures import gestures


def _letters(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()


def test_each_gesture_has_phrases_and_no_phrase_has_two_gestures() -> None:
    found = load_written_phrases()
    assert set(found) == set(gestures())
    assert min(map(len, found.values())) >= 110
    every = [_letters(phrase) for phrases in found.values() for phrase in phrases]
    assert len(every) - len(set(every)) < 0.01 * len(every)


@pytest.mark.parametrize("name", sorted(path.stem for path in LABELLED_SENTENCES.parent.glob("words_*.jsonl")))
def test_no_phrase_is_a_sentence_of_a_set_that_measures(name: str) -> None:
    every = {_letters(phrase) for phrases in load_written_phrases().values() for phrase in phrases}
    assert not every & {_letters(sentence.text) for sentence in read_sentences(name)}


@pytest.mark.parametrize("line", ["knok => rap at the gate", "knock", "knock =>", "rap at the gate"])
def test_a_line_without_gesture_or_phrase_is_named(tmp_path: Path, line: str) -> None:
    path = tmp_path / "phrases.txt"
    path.write_text(f"# comment\n\nknock => rap at the gate\n{line}\n", "utf-8")
    with pytest.raises(TrainingDataError, match="line 4"):
        load_written_phrases(tmp_path)
