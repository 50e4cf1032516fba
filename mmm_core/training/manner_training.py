"""Finds the weights of words that ask for a tempo or a size, and what they weigh beside classifier and tagger.

The words are learnt from the sentences with marked manner, from the marked words by themselves, from expressions and sentences of
further writers, from labelled sentences, and from phrases that name a gesture and no manner: one logistic regression for each
manner, of few steps, which keep the weights of rare pieces small. Tables and their use: `mmm_core.language.manner_words`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor

from mmm_core.corpus.heldout import read_sentences
from mmm_core.corpus.labelled_sentences import load_labelled_sentences
from mmm_core.corpus.marked_sentences import MANNER_SENTENCES, lines_of, marked_manners
from mmm_core.corpus.written_phrases import load_written_phrases
from mmm_core.errors import TrainingDataError
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.manner_words import ASKED, EVIDENCE, START, evidence, pieces_of
from mmm_core.language.reading import read
from mmm_core.training.choice_training import SETS

LOOKED_AT = (*SETS, *(f"words_test_{n}" for n in range(1, 6)))
"""Sets of sentences that were looked at and from which neither words, nor classifier, nor tagger have learnt."""
_LEARNT = "[mw]*.txt"
"""Files of labelled sentences that the words are learnt from: all but `looked_at_sets.txt`."""
MANNER_EXPRESSIONS = MANNER_SENTENCES.with_name("manner_expressions.txt")
"""Expressions that ship, `manner => expression`, one a line; lines that begin with # are comments."""
Texts = list[tuple[str, frozenset[str]]]
"""Texts, each with the manners that it asks for."""
_N_PLAIN = 8000
"""Phrases without a manner."""
_STEPS, _RATE, _SETTLING = 60, 0.02, 1e-5
_LEAST = 0.2
"""A piece whose weights are all smaller is left out, and weights are rounded to a tenth: 0.7 megabytes instead of three."""


def train_manner(out: Path, seed: int = 0) -> tuple[int, int]:
    """Find the weights and write them as a table of words, the file that `mmm_core/language/words/manner_words.txt` is.

    Args:
        out: file of the weights.
        seed: chooses the phrases without a manner.

    Returns:
        Number of texts that it learnt from, and of pieces in the table.
    """
    texts = training_texts(seed)
    weights = {piece: row for piece, row in fitted(texts).items() if piece == START or abs(row).max() >= _LEAST}
    rows = [f"{piece} => {' '.join(f'{w:.1f}' for w in row)}" for piece, row in sorted(weights.items())]
    comment = "# Weights of words for slow, fast, small, large: mmm_core/language/manner_words.py; found by `mmmd train manner`."
    out.write_text("\n".join([comment, *rows, ""]), encoding="utf-8")
    return len(texts), len(rows)


def train_evidence(
    out: Path, reader: SentenceReader | None = None, sets: Sequence[str] = LOOKED_AT
) -> tuple[int, int, int]:
    """Find what words, classifier and tagger weigh, and write the table that `mmm_core/language/words/manner_choice.txt` is.

    They are those of a logistic regression over none and the four manners, for sentences of one command in which rules find none.

    Args:
        out: file of the weights.
        reader: gives what classifier and tagger say; the shipped one when None.
        sets: sets of sentences, two or more.

    Returns:
        Number of sentences, of those with a manner, and of those that are read right with weights of the other sets.
    """
    reader = reader or SentenceReader.load()
    given: list[tuple[str, NDArray[np.float64], int]] = []
    for of_set in sets:
        for sentence in read_sentences(of_set):
            one = len(sentence.commands) == 1 and len(sentence.commands[0]) == 1
            if not one or not all(c.manner.plain for step in read(sentence.text).steps for c in step):
                continue
            command = sentence.commands[0][0]
            manner = command.tempo or command.size
            number = 1 + ASKED.index(manner) if manner else 0
            given.append((of_set, evidence(sentence.text, *reader.manner_evidence(sentence.text)), number))
    found = 0
    for name in sets:
        weights, start = _fitted_evidence([one for one in given if one[0] != name])
        scores = [np.concatenate([[0.0], some @ weights + start]).argmax() for of, some, _ in given if of == name]
        found += sum(
            int(k) == number for k, number in zip(scores, (n for of, _, n in given if of == name), strict=True)
        )
    weights, start = _fitted_evidence(given)
    rows = [f"{name} => {w:.2f}" for name, w in zip((*EVIDENCE, *ASKED), (*weights, *start), strict=True)]
    comment = "# What each kind of evidence weighs for a tempo or a size: mmm_core/language/manner_words.py; `mmmd train manner`."
    out.write_text("\n".join([comment, *rows, ""]), encoding="utf-8")
    return len(given), sum(number > 0 for *_, number in given), found


def _fitted_evidence(
    given: Sequence[tuple[str, NDArray[np.float64], int]],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(3,) weights of the kinds of evidence, and (4,) what each manner has beforehand."""
    rows = torch.from_numpy(np.stack([some for _, some, _ in given]))
    number = torch.tensor([number for *_, number in given])
    weights = torch.zeros(len(EVIDENCE), dtype=rows.dtype, requires_grad=True)
    start = torch.zeros(len(ASKED), dtype=rows.dtype, requires_grad=True)
    optimiser = torch.optim.LBFGS([weights, start], max_iter=200, line_search_fn="strong_wolfe")

    def loss() -> Tensor:
        optimiser.zero_grad()
        scores = torch.cat([torch.zeros(len(rows), 1).to(rows), rows @ weights + start], 1)
        found = F.cross_entropy(scores, number) + 1e-3 * weights.square().sum()
        found.backward()
        return found

    optimiser.step(loss)
    return weights.detach().numpy(), start.detach().numpy()


def training_texts(seed: int = 0) -> Texts:
    """All that the weights are learnt from.

    Raises:
        TrainingDataError: a line of a file cannot be read.
    """
    texts: Texts = []
    for line in lines_of(MANNER_SENTENCES):
        sentence, marks = marked_manners(line)
        texts.append((sentence, frozenset(manner for manner, _ in marks)))
        texts += [(words, frozenset({manner})) for manner, words in marks]
    for number, line in enumerate(MANNER_EXPRESSIONS.read_text("utf-8").splitlines(), 1):
        manner, _, words = (part.strip() for part in line.partition("=>"))
        if line.startswith("#"):
            continue
        if manner not in ASKED or not words:
            raise TrainingDataError(MANNER_EXPRESSIONS, f"line {number}", line, f"{' | '.join(ASKED)} => an expression")
        texts.append((words, frozenset({manner})))
    texts += _labelled(known={text for text, _ in texts})
    plain = [phrase for some in load_written_phrases().values() for phrase in some]
    chosen = np.random.default_rng(seed).permutation(len(plain))[:_N_PLAIN]
    return texts + [(plain[i], frozenset()) for i in chosen]


def _labelled(known: Collection[str]) -> Texts:
    """The labelled sentences but known ones, and those without a manner in which the rules find one: a label may leave it out."""
    return [
        (one.text, one.manners)
        for one in load_labelled_sentences(files=_LEARNT)
        if one.text not in known
        and (one.manners or all(command.manner.plain for step in read(one.text).steps for command in step))
    ]


def fitted(texts: Sequence[tuple[str, frozenset[str]]]) -> dict[str, NDArray[np.float32]]:
    """(4,) weights of each piece of the texts, and of `START`, which every text has."""
    pieces = [sorted(pieces_of(text)) for text, _ in texts]
    number = {piece: i for i, piece in enumerate(Counter(piece for some in pieces for piece in some))}
    ids = torch.tensor([number[piece] for some in pieces for piece in some])
    begins = torch.tensor([0, *np.cumsum([len(some) for some in pieces])[:-1]])
    wanted = torch.tensor([[float(manner in asked) for manner in ASKED] for _, asked in texts])
    weights = torch.zeros(len(number), len(ASKED), requires_grad=True)
    start = torch.full((len(ASKED),), -2.0, requires_grad=True)
    optimiser = torch.optim.Adam([weights, start], _RATE)
    for _ in range(_STEPS):
        scores = F.embedding_bag(ids, weights, begins, mode="sum") + start
        loss = F.binary_cross_entropy_with_logits(scores, wanted) + _SETTLING * weights.square().sum()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    found = weights.detach().numpy()
    return {START: start.detach().numpy()} | {piece: found[i] for piece, i in number.items()}
