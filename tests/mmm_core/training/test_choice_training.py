"""Training of the choice among ways to read a sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.corpus.heldout import Command, Sentence
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.candidates import EVIDENCE, Candidate, Ways
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.plain_gestures import Meant
from mmm_core.language.word_tables import pairs
from mmm_core.training.choice_training import Labelled, families_of, fitted, is_right, train_choice

NO_MEANING = Meant("several", 0.9)


@pytest.mark.parametrize(
    ("text", "meant", "families"),
    [
        ("clap", NO_MEANING, {"clap"}),
        ("knock on the door with your left hand 2 times", NO_MEANING, {"knock"}),
        ("rap on the hatch", Meant("knock", 0.6), {"knock"}),
        ("rap on the hatch", Meant("knock", 0.3), set()),
        ("rap on the hatch", NO_MEANING, set()),
        ("do the robot", NO_MEANING, {"robot"}),  # a plain command without any significant word
        ("give me five with your left hand", NO_MEANING, {"high_five"}),
        ("robot", NO_MEANING, set()),
    ],
)
def test_the_families_of_a_command(text: str, meant: Meant, families: set[str]) -> None:
    assert families_of(text, meant) == families


@pytest.mark.parametrize(
    ("steps", "right"),
    [
        ([["wave your left hand", "nod your head"], ["clap"]], True),
        ([["nod your head", "wave your left hand"], ["clap"]], True),
        ([["wave your right hand", "nod your head"], ["clap"]], False),
        ([["clap"], ["wave your left hand", "nod your head"]], False),
        ([["wave your left hand"], ["nod your head"], ["clap"]], False),
        ([["wave your left hand", "nod your head"]], False),
        ([], False),
    ],
)
def test_a_reading_is_right_with_the_families_and_arms_of_the_label(steps: list[list[str]], right: bool) -> None:
    label = Sentence(
        "said", "at_once", ((Command("wave", "arm", side="left"), Command("nod", "head")), (Command("clap", "arms"),))
    )  # fmt: skip
    reading = Reading("said", tuple(tuple(map(PlainCommand, step)) for step in steps))
    meant = {text: NO_MEANING for step in steps for text in step}
    assert is_right(reading, label, Ways([Candidate(reading)], meant, NO_MEANING)) is right


def test_weights_prefer_what_speaks_for_the_right_candidates() -> None:
    rng = np.random.default_rng(0)
    truth = rng.normal(size=4)
    given: list[Labelled] = []
    for _ in range(400):
        evidence = rng.normal(size=(5, 4))
        right = np.zeros(5, bool)
        right[(evidence @ truth).argmax()] = True
        given.append(Labelled("set", evidence, right))
    weights = fitted(given)
    assert np.corrcoef(weights, truth)[0, 1] > 0.99
    assert np.mean([one.right[(one.evidence @ weights).argmax()] for one in given]) > 0.95


@pytest.mark.long
def test_weights_are_written_as_the_table_that_ships(tmp_path: Path) -> None:
    out = tmp_path / "choice.txt"
    n, n_possible, n_chosen = train_choice(out, SentenceReader.load(), ("words_test_1", "words_test_2"))
    assert n > 200
    assert 0.75 * n < n_chosen <= n_possible <= n
    names = [line.partition(" => ")[0] for line in out.read_text().splitlines() if not line.startswith("#")]
    assert tuple(names) == EVIDENCE == tuple(name for name, _ in pairs("choice"))
