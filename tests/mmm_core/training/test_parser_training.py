"""Training of the sentence parser, in small."""

from __future__ import annotations

import itertools
import os
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
import torch

from daemon.cli.program import main
from mmm_core.corpus.labelled_sentences import LabelledSentence, read_labelled
from mmm_core.corpus.marked_sentences import TaggedSentence, read_commands
from mmm_core.errors import CheckpointError
from mmm_core.inference.checkpoint import TEXT_FILE, file_hash, load_text_encoder, save_tensors
from mmm_core.inference.own_layers_file import load_parser, save_parser
from mmm_core.language.gesture_steps import plainly, steps_of, token_ids, tokens
from mmm_core.language.plain_gestures import OUTSIDE, gestures
from mmm_core.language.tagged_words import words_of
from mmm_core.model.parsing import likeliest, memory_of, number_probabilities
from mmm_core.model.sentence_parser import ParserConfig, SentenceParser
from mmm_core.model.sentence_tagger import word_states
from mmm_core.training import parser_training
from mmm_core.training.parser_texts import ParserTexts
from mmm_core.training.parser_training import Draw, train_parser

GIVEN = [
    read_labelled(line)
    for line in (
        "rap at the gate => knock",
        "look up after you bow => bow; look/up",
        "do not clap => | not clap",
        "right hand on your heart while you nod => right heart + nod",
        "clap twice before the three of you bow => clap x2; bow",
    )
]


def _draw_with(rng: random.Random) -> Draw:
    return lambda: rng.choice(GIVEN)


@pytest.mark.long
def test_it_learns_the_sentences_it_is_given_and_is_read_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parser_training, "BATCH", 8)
    path = tmp_path / "parser.safetensors"
    trained, encoder = train_parser(path, tmp_path / "run", _draw_with, steps=160), load_text_encoder()
    for parser in (trained, load_parser(path)):
        for one in GIVEN:
            (words,) = word_states(encoder, 0, [one.text.split()])
            memory = memory_of(parser, words.embedded)
            assert steps_of(likeliest(parser, memory, 2)[0].ids) == one.steps
        pieces = words.first_pieces[[1, 4]].tolist()  # of the last sentence: "twice" and "three"
        ((of_clap, of_bow), of_people) = number_probabilities(parser, memory, pieces, token_ids(one.steps)).tolist()
        assert of_clap > 0.5 > max(of_bow, *of_people)
    assert all(not p.requires_grad for p in trained.parameters())


@pytest.mark.long
def test_an_interrupted_run_gives_the_weights_of_one_that_was_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Batches are drawn two at a time, and the interrupt comes within the fourth step, whose batch was drawn with the third's."""
    for name, value in (("BATCH", 4), ("SAVE_EVERY", 1), ("TOGETHER", 2)):
        monkeypatch.setattr(parser_training, name, value)
    whole = train_parser(tmp_path / "whole", tmp_path / "run", _draw_with, steps=5)
    n_learnt, as_read = itertools.count(), parser_training._canonical

    def interrupted(one: LabelledSentence) -> LabelledSentence:
        if next(n_learnt) == 3 * 4 + 1:
            raise KeyboardInterrupt
        return as_read(one)

    with monkeypatch.context() as patched:
        patched.setattr(parser_training, "_canonical", interrupted)
        with pytest.raises(KeyboardInterrupt):
            train_parser(tmp_path / "parts", tmp_path / "again", _draw_with, steps=5)
    parts = train_parser(tmp_path / "parts", tmp_path / "again", _draw_with, steps=5)
    assert all(torch.equal(x, y) for x, y in zip(whole.state_dict().values(), parts.state_dict().values(), strict=True))


@pytest.mark.long
def test_a_parser_that_learns_further_starts_from_the_given_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parser_training, "BATCH", 4)
    start = tmp_path / "start"
    given = train_parser(start, tmp_path / "run", _draw_with, steps=1)
    with torch.no_grad():
        for weights in given.parameters():
            weights.mul_(1.5)
    save_parser(start, given)
    further = train_parser(tmp_path / "further", tmp_path / "run", _draw_with, start=start, steps=1)
    for name, weights in further.state_dict().items():
        step = given.state_dict()[name].abs().max().item() / 127
        torch.testing.assert_close(weights, given.state_dict()[name], rtol=0, atol=step / 2 + 2 * parser_training.RATE)


@pytest.mark.long
def test_the_batches_of_a_step_do_not_depend_on_what_was_drawn_before() -> None:
    rng = random.Random(5)
    draw = ParserTexts(rng).draw
    again = random.Random()
    assert parser_training._batches(draw, rng, 8) == parser_training._batches(ParserTexts(again).draw, again, 8)


@pytest.mark.long
def test_another_process_goes_on_with_the_same_run() -> None:
    """The order of sets, and with it their text, differs from process to process."""
    said = "from mmm_core.training.parser_training import Shares, _data_key; print(_data_key(5, Shares(), None))"
    names = {
        subprocess.run(
            [sys.executable, "-c", said], env={**os.environ, "PYTHONHASHSEED": seed}, capture_output=True, text=True,
            timeout=120, check=True,
        ).stdout
        for seed in ("1", "2", "3")
    }  # fmt: skip
    assert len(names) == 1


def test_sentences_of_every_kind_are_drawn_and_none_keeps_a_slot() -> None:
    texts = ParserTexts(random.Random(1))
    drawn = [texts.draw() for _ in range(4000)]
    assert {one.gesture for sentence in drawn for step in sentence.steps for one in step} == {*gestures(), OUTSIDE}
    assert not [one.text for one in drawn if any(slot in one.text for slot in ("{v}", "{w}", "{S}", "{n}", "{D}"))]
    n_steps = Counter(len(one.steps) for one in drawn)
    assert all(n_steps[n] > 50 for n in range(4))
    assert sum(len(step) > 1 for one in drawn for step in one.steps) > 100


def test_gestures_put_into_a_marked_sentence_are_its_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """The commands of this sentence are said in the other order than they are done in."""
    marked = load_marked(["before you [2:clap clap], [1:shrug shrug now]"])
    monkeypatch.setattr("mmm_core.training.parser_texts.load_marked_sentences", lambda: marked)
    for share in ("_SHARE_WITHOUT_MARKS", "_SHARE_LOWER", "_SHARE_WITH_SLIPS", "_SHARE_OF_CORPUS"):
        monkeypatch.setattr(f"mmm_core.training.parser_texts.{share}", 0.0)
    texts = ParserTexts(random.Random(2))
    for text, ((first,), (second,)), *_ in (texts.refilled() for _ in range(50)):
        said = [plainly(one) for one in (second, first)]
        assert text == "before you {}, {}".format(*said)


def load_marked(lines: list[str]) -> list[TaggedSentence]:
    found = [read_commands(line) for line in lines]
    return [TaggedSentence(tuple(text[a:b] for a, b in words_of(text)), tuple(tags)) for text, tags, _ in found]


def test_a_parser_of_another_text_encoder_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.safetensors"
    save_tensors(path, {}, "mmmd-sentence-parser", {"config": {}, "text_encoder": "0" * 64})
    with pytest.raises(CheckpointError, match="the packed text encoder"):
        load_parser(path)


def test_a_file_keeps_weights_within_half_a_step_of_their_row(tmp_path: Path) -> None:
    encoder, path = load_text_encoder(), tmp_path / "parser.safetensors"
    torch.manual_seed(0)
    parser = SentenceParser(ParserConfig(tokens()), encoder.config)
    with torch.no_grad():
        parser.token.weight[3].zero_()
    save_parser(path, parser)
    for name, read in load_parser(path).state_dict().items():
        written = parser.state_dict()[name]
        step = written.abs().amax(-1, keepdim=True) / 127
        assert ((read - written).abs() <= step * 0.501).all(), name


def test_a_parser_of_the_encoders_lower_layers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "older.safetensors"
    save_tensors(path, {}, "mmmd-sentence-parser", {"config": {"n_shared": 3}, "text_encoder": file_hash(TEXT_FILE)})
    with pytest.raises(CheckpointError, match="mmmd train parser"):
        load_parser(path)


def test_the_command_wants_a_file_for_the_parser(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "parser"]) == 2
    assert "--out" in capsys.readouterr().err
