"""Sentences with marked commands and with marked manner, which the sentence tagger learns from."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from mmm_core.corpus.heldout import read_sentences
from mmm_core.corpus.marked_sentences import (
    MANNER_SENTENCES,
    MARKED_SENTENCES,
    TaggedSentence,
    asked_in,
    load_manner_sentences,
    load_marked_sentences,
    read_commands,
    read_manner,
    read_marked,
)
from mmm_core.errors import TrainingDataError
from mmm_core.language.plain_gestures import OUTSIDE, gestures
from mmm_core.language.tagged_words import marked_commands, words_of

PROMPTS = MARKED_SENTENCES.parent


def _letters(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()


def _lines(path: Path = MARKED_SENTENCES) -> list[str]:
    return [line for line in path.read_text("utf-8").splitlines() if line and not line.startswith("#")]


def test_marks_become_tags_that_mark_the_same_commands() -> None:
    n_commands = 0
    for line in _lines():
        marked = marked_commands(*read_marked(line))
        labels = re.findall(r"\[(\d[a-z]?)(?::[a-z_/-]+)? ", line)
        assert sum(map(len, marked.steps)) == len(set(labels)), line
        assert len(marked.steps) == len({label[0] for label in labels}), line
        assert bool(marked.denied) == ("[- " in line), line
        n_commands += len(set(labels))
    assert n_commands > 5000


def test_a_command_may_name_its_gesture_and_a_denied_act_is_none() -> None:
    sentence, tags, asked = read_commands("[1:look/up-left Up and left], don't [- nod], [2 clap].")
    assert (sentence, asked) == ("Up and left, don't nod, clap.", [(0, 3, "look/up left")])
    one = TaggedSentence(tuple(sentence[a:b] for a, b in words_of(sentence)), tuple(tags), (), tuple(asked))
    found = [(said[slice(*part)], name) for said, name, part in asked_in(one)]
    assert found == [("Up and left", "look/up left"), ("nod", OUTSIDE)]


def test_every_gesture_that_a_command_names_is_one_of_the_corpus() -> None:
    named = {name for one in load_marked_sentences() for _, _, name in one.gestures}
    assert named <= {*gestures(), OUTSIDE} and len(named) > 150


def test_no_marked_sentence_is_one_of_the_sentences_that_measure_it() -> None:
    measured: set[str] = set()
    for path in PROMPTS.glob("words_*.jsonl"):
        measured |= {_letters(json.loads(line)["text"]) for line in path.read_text("utf-8").splitlines()}
    assert len(measured) > 500
    assert not measured & {_letters(read_marked(line)[0]) for line in _lines()}
    measured -= {_letters(s.text) for s in read_sentences("words_seen")}  # the rules were written by these
    assert not measured & {_letters(read_manner(line)[0]) for line in _lines(MANNER_SENTENCES)}


def test_braces_become_manners_of_the_same_words() -> None:
    sentences = load_manner_sentences()
    assert len(sentences) == len(_lines(MANNER_SENTENCES)) > 3000
    for line, one in zip(_lines(MANNER_SENTENCES), sentences, strict=True):
        assert set(one.manners) - {"none"} == set(re.findall(r"{(\w+):", line)), line
        assert len(one.manners) == len(one.words) and not one.tags, line


@pytest.mark.parametrize("line", ["[1 nod", "nod]", "[nod]", "[1 nod [2 bow]]", "[10 nod]"])
def test_a_bracket_that_is_no_mark_is_refused_by_file_and_line(line: str, tmp_path: Path) -> None:
    path = tmp_path / "sentences.txt"
    path.write_text(f"# a comment\n[1 clap]\n{line}\n", "utf-8")
    with pytest.raises(TrainingDataError, match=re.escape(repr(line))):
        load_marked_sentences(path)


@pytest.mark.parametrize("line", ["nod {slow: at a crawl", "nod}", "nod {calm: x}", "nod {slow: a {fast: b}}"])
def test_a_brace_that_is_no_mark_is_refused_by_file_and_line(line: str, tmp_path: Path) -> None:
    path = tmp_path / "sentences.txt"
    path.write_text(f"nod {{slow: slowly}}\n{line}\n", "utf-8")
    with pytest.raises(TrainingDataError, match=re.escape(repr(line))):
        load_manner_sentences(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TrainingDataError, match="nowhere"):
        load_marked_sentences(tmp_path / "nowhere.txt")
