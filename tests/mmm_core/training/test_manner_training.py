"""Training of the words that ask for a tempo or a size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mmm_core.errors import TrainingDataError
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.manner_words import ASKED, EVIDENCE, START
from mmm_core.language.word_tables import pairs
from mmm_core.training import manner_training
from mmm_core.training.manner_training import fitted, train_evidence, train_manner

NOTHING: frozenset[str] = frozenset()


def test_a_word_has_the_weight_of_the_manner_that_it_stands_for() -> None:
    texts = [
        ("nod at a crawl", frozenset({"slow"})),
        ("nod at a sprint", frozenset({"fast"})),
        ("nod at me", NOTHING),
    ] * 20
    weights = fitted(texts)
    assert set(weights) > {START, "crawl", "a sprint", "nod at a"}
    slow, fast, small, large = weights["crawl"]
    assert slow > 0 > fast
    assert max(small, large) <= 0
    assert abs(weights["nod"]).max() < slow


@pytest.mark.parametrize("line", ["quick => at a sprint", "slow =>", "at a crawl"])
def test_an_expression_without_manner_or_words_is_named(
    tmp_path: Path, line: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "expressions.txt"
    path.write_text(f"# comment\nslow => at a crawl\n{line}\n", "utf-8")
    monkeypatch.setattr(manner_training, "MANNER_EXPRESSIONS", path)
    with pytest.raises(TrainingDataError, match="line 3"):
        manner_training.training_texts()


@pytest.mark.long
@pytest.mark.timeout(900)  # three minutes by itself
def test_the_weights_of_words_are_those_that_ship(tmp_path: Path) -> None:
    n_texts, n_pieces = train_manner(tmp_path / "words.txt")
    found = dict(line.split(" => ") for line in (tmp_path / "words.txt").read_text("utf-8").splitlines()[1:])
    ship = dict(pairs("manner_words"))
    assert n_texts > 15_000
    assert n_pieces == len(found)
    same = [piece for piece in ship if piece in found]
    assert len(same) > 0.98 * max(len(ship), len(found))  # rounding differs from processor to processor
    apart = [np.abs(np.array(ship[p].split(), float) - np.array(found[p].split(), float)).max() for p in same]
    assert max(apart) <= 0.1 + 1e-6


@pytest.mark.long
def test_what_evidence_weighs_is_written_as_the_table_that_ships(tmp_path: Path) -> None:
    out = tmp_path / "choice.txt"
    n, n_manners, n_found = train_evidence(out, SentenceReader.load(), ("words_test_1", "words_test_2"))
    assert n > n_manners > 50
    assert n_found > 0.75 * n
    names = [line.partition(" => ")[0] for line in out.read_text().splitlines() if not line.startswith("#")]
    assert tuple(names) == (*EVIDENCE, *ASKED) == tuple(name for name, _ in pairs("manner_choice"))
