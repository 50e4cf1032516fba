"""Sentences of a writer who saw neither rules nor marked sentences, read by rules alone and with the tagger."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from mmm_core.corpus.heldout import PROBES, read_sentences
from mmm_core.generate.encoded_sentence import Encoded
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.commands import Reading
from mmm_core.language.gesture_steps import ANY_ARM, ArmGesture, GestureSteps
from mmm_core.language.mirroring import mirror_words
from mmm_core.language.plain_gestures import OUTSIDE
from mmm_core.language.reading import read
from mmm_core.language.sure_reading import needs_networks
from tests.support.sizes import few_and_long

SENTENCES = Path(__file__).parent / "divided_sentences.jsonl"
"""120 sentences with the number of commands of each step, and whether something is denied."""


@pytest.fixture(scope="module")
def reader() -> SentenceReader:
    return SentenceReader.load()


def _division(reading: Reading) -> tuple[list[int], bool]:
    return [len(step) for step in reading.steps], bool(reading.denied)


@pytest.mark.long
def test_it_divides_more_sentences_as_meant_than_the_rules_alone(reader: SentenceReader) -> None:
    given = [json.loads(line) for line in SENTENCES.read_text("utf-8").splitlines()]
    meant = [(one["steps"], one["denied"]) for one in given]
    by_rules = sum(_division(read(one["text"])) == m for one, m in zip(given, meant, strict=True))
    by_reader = sum(_division(reader.read(one["text"])) == m for one, m in zip(given, meant, strict=True))
    assert len(given) == 120
    assert by_reader >= by_rules + 5
    assert by_reader >= 96


def _manners(reading: Reading) -> set[str]:
    """The tempos and sizes that a reading has, as sentences of the development set name them."""
    found: set[str] = set()
    for manner in (command.manner for step in reading.steps for command in step):
        found |= {"slow" if manner.tempo < 1 else "fast"} if manner.tempo != 1 else set()
        found |= {"small" if manner.size < 1 else "large"} if manner.size != 1 else set()
    return found


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("do not strike a dab, sulk instead", "slump down"),  # the classifier takes it for a shrug
        ("do not wave off the flies, some grooving instead", "pump both arms to the beat"),
        ("jive exactly 3 times", "pump both arms to the beat 3 times"),
    ],
)
def test_a_phrase_of_the_corpus_means_its_own_gesture(reader: SentenceReader, text: str, command: str) -> None:
    assert [c.text for step in reader.read(text).steps for c in step] == [command]


@pytest.mark.long
def test_it_finds_more_tempos_and_sizes_than_the_rules_alone(reader: SentenceReader) -> None:
    given = [s for s in read_sentences("words_dev") if s.kind == "manner" and len(s.commands) == 1]
    meant = [{c.tempo, c.size} - {""} for c in (s.commands[0][0] for s in given)]
    by_rules = sum(_manners(read(s.text)) == m for s, m in zip(given, meant, strict=True))
    by_reader = sum(_manners(reader.read(s.text)) == m for s, m in zip(given, meant, strict=True))
    assert len(given) > 100
    assert by_reader >= by_rules + 25
    assert by_reader >= 0.85 * len(given)


@pytest.mark.parametrize("every", few_and_long([12], [1]))
def test_words_of_the_act_are_not_taken_for_its_manner(reader: SentenceReader, every: int) -> None:
    """In every twelfth sentence, and at length in all."""
    given = [s for s in read_sentences("words_dev") if not any(c.tempo or c.size for step in s.commands for c in step)]
    assert len(given) > 300
    given = given[::every]
    wrong = [s.text for s in given if _manners(reader.read(s.text))]
    assert len(wrong) <= 0.03 * len(given), wrong


@pytest.mark.parametrize(
    ("sentence", "steps"),
    [
        ("Stretch upward and when you're done let your arms fall",
         [["stretch your arms up"], ["lower both arms"]]),
        ("Circle your right arm forwards and the left backwards.",
         [["circle your right arm forwards", "circle your left arm backwards"]]),
        ("Blow a kiss, but put your hand on your heart beforehand", [["put your hand on your heart"], ["blow a kiss"]]),
        ("wave", [["wave"]]), ("do anything but nod", [["wave your right hand"]]),
        ("Draw that bow, no haste at all.", [["shoot an arrow"]]),
        ("Let's seal the deal with your right hand.", [["hold out your right hand for a handshake"]]),
        ("My son plays the fiddle back in Cape Breton, can you do that?", [["play the violin"]]),
        ("Break this board with a karate chop!", [["do a karate chop"]]),
        ("Rap on the hatch twice with your left hand, then tell these noisy kids to be quiet",
         [["knock on the door with your left hand 2 times"], ["put your finger to your lips"]]),
        ("do a somersault", [["do a somersault"]]),
        ("party with your arms 2x left and right in turn", [["party with your arms 2 times left and right in turn"]]),
        ("Sparring time! A jab, then an uppercut with the left.",
         [["punch forward"], ["throw a left uppercut"]]),
        ("Have yourself a good stretch, and as you do, yawn.", [["stretch your arms up", "yawn"]]),
        ("The soup wants stirring; once it has been stirred, taste it.",
         [["stir the soup"], ["bring food to your mouth"]]),
    ],
)  # fmt: skip
def test_a_sentence_is_divided_and_completed(reader: SentenceReader, sentence: str, steps: list[list[str]]) -> None:
    assert [[command.text for command in step] for step in reader.read(sentence).steps] == steps


@pytest.mark.parametrize(
    "text", ["wave with your right hand", "exactly: nod (0.62 times as fast) + clap", "", "!?", "x " * 500]
)
def test_what_the_rules_are_sure_of_or_cannot_be_tagged_is_read_as_before(reader: SentenceReader, text: str) -> None:
    assert replace(reader.read(text), outside=0.0) == read(text)


@pytest.mark.parametrize("every", few_and_long([16], [1]))
def test_what_the_rules_deny_stays_denied(reader: SentenceReader, every: int) -> None:
    given = [s.text for name in ("words_dev", "words_dev_2") for s in read_sentences(name) if read(s.text).denied]
    assert len(given) > 150
    found = [(text, reader.read(text)) for text in given[::every]]
    assert [text for text, one in found if not one.denied and not _manners(one)] == [], "what is denied may be a manner"
    done = [(text, {c.text for step in one.steps for c in step} & {*read(text).denied}) for text, one in found]
    assert [one for one in done if one[1]] == []


@pytest.mark.parametrize(
    "sentence", ["my old boss used to nod at everything I said", "My wife once did the superhero pose on a cliff."]
)
def test_a_report_asks_for_nothing(reader: SentenceReader, sentence: str) -> None:
    assert reader.read(sentence).steps == ()


@pytest.mark.parametrize(
    "sentence", ["people bow here, so bow", "it would be lovely if you nodded", "the robot nods twice, then bows"]
)
def test_a_request_that_looks_like_a_report_is_one(reader: SentenceReader, sentence: str) -> None:
    assert reader.read(sentence).steps


class _Answers:
    """A parser that asks for a clap and a wave whatever is said."""

    def __init__(self, steps: GestureSteps) -> None:
        self._steps = steps

    def likeliest(self, _n: int) -> list[GestureSteps]:
        return [self._steps]

    def log_likelihoods(self, answers: Sequence[GestureSteps]) -> list[float]:
        return [0.0 if answer == self._steps else -99.0 for answer in answers]


@pytest.mark.parametrize(
    ("text", "gestures", "is_proposed"),
    [
        (
            "have a good old clap for the lads at the back there, everybody is looking forward to it",
            ("clap", "wave"),
            True,
        ),
        ("have a good old clap for the lads at the back there, but do not wave at anybody", ("clap", "wave"), False),
        ("have a good old clap for the lads at the back there, then run away", ("clap", "wave"), False),
        (
            "have a good old clap for the lads at the back there, everybody is looking forward to it",
            ("clap", OUTSIDE),
            False,
        ),
    ],
)
def test_the_parser_proposes_nothing_that_is_denied_or_must_be_refused(
    reader: SentenceReader, monkeypatch: pytest.MonkeyPatch, text: str, gestures: tuple[str, ...], is_proposed: bool
) -> None:
    steps = tuple((ArmGesture(ANY_ARM, gesture),) for gesture in gestures)
    monkeypatch.setattr(reader._models, "_encoded", {})
    monkeypatch.setattr(Encoded, "parse", _Answers(steps))
    ways = reader.ways_to_read(text)
    assert ways is not None
    assert any(one.by_parser for one in ways.candidates) is is_proposed


def test_capitals_change_nothing_and_are_not_encoded_anew(reader: SentenceReader) -> None:
    models, text = reader._models, "Once you have Nodded to the King, give us a Wave, but no Bow"
    assert models.encode(text) is models.encode(text.lower())
    assert models.encode(text) is not models.encode("bow to the king, then wave")
    assert needs_networks(read(text))
    assert reader.read(text).words == reader.read(text.upper()).words


@pytest.mark.parametrize(
    "text",
    [
        "Under no circumstances make the zombie arms when the visitors come in.",
        "On no account may your left arm go up while the door is open.",
        "Nobody's asked for a bow, so not one out of you.",
    ],
)
def test_words_that_deny_all_that_follows_are_believed(reader: SentenceReader, text: str) -> None:
    found = reader.read(text)
    assert found.denied
    assert not found.steps


def test_words_of_a_hold_say_no_tempo(reader: SentenceReader) -> None:
    ((command,),) = reader.read("fight off a punch with your guard and wait like that for two seconds").steps
    assert (command.manner.tempo, command.manner.hold_s) == (1.0, 2.0)


def test_what_cannot_be_done_is_not_left_out(reader: SentenceReader) -> None:
    assert [c.text for step in reader.read("clap your hands, then run away").steps for c in step][-1] == "run away"


@pytest.mark.parametrize("every", few_and_long([8], [1]))
def test_a_mirrored_sentence_is_read_as_the_mirror_image(reader: SentenceReader, every: int) -> None:
    """Tags and gestures were once those of the sentence itself, so that "left" was understood where "right" was not."""
    given = [*(probe.text for probe in PROBES), *(s.text for s in read_sentences("words_phrases_dev"))]
    images = [(text, mirror_words(text)) for text in given if mirror_words(text) != text]
    assert len(images) > 180
    wrong = [
        text for text, image in images[::every] if mirror_words(reader.read(text).words) != reader.read(image).words
    ]
    assert len(wrong) <= 1, wrong  # "Up top, slap my hand with your left": a rule chooses the right hand for "up top"


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("I said wave, not salute, you daft robot.", "wave your hand"),
        ("Knock three times, it's rude to push so don't", "knock on the door 3 times"),
    ],
)
def test_what_the_parser_is_sure_of_is_not_taken_for_denied(reader: SentenceReader, text: str, asked: str) -> None:
    assert [command.text for step in reader.read(text).steps for command in step] == [asked]


@pytest.mark.parametrize(
    "text", ["do not bow", "no clapping please", "don't you dare wave at him", "nobody is to salute today"]
)
def test_what_is_denied_alone_stays_denied(reader: SentenceReader, text: str) -> None:
    found = reader.read(text)
    assert not found.steps and found.denied


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("clap three times, after that stop", ("clap three times",)),
        ("nod 0 times and clap", ("clap",)),
        ("wave with your right hand twice as fast, then back", ("wave your right hand (2 times as fast)",)),
        ("wave and nod, twice as fast", ("wave your hand (2 times as fast)", "nod your head (2 times as fast)")),
        ("wave, nod and bow twice each", ("wave your hand 2 times", "nod your head 2 times", "bow politely 2 times")),
    ],
)  # fmt: skip
def test_numbers_and_ends_that_the_networks_would_read_otherwise(
    reader: SentenceReader, text: str, sentences: tuple[str, ...]
) -> None:
    assert reader.read(text).sentences == sentences
