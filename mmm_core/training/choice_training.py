"""Finds the weights with which one of the ways to read a sentence is chosen (`mmm_core.language.candidates`).

The sentences are those of the evaluation that were looked at; the labels of a sentence name the families of its commands, step by
step. The weights are those of a conditional logit: the probability of the right candidates is greatest.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import permutations
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from tqdm import tqdm

from mmm_core.corpus.heldout import Command, Sentence, read_sentences
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.generate.sentence_reader import SentenceReader
from mmm_core.language.candidates import EVIDENCE, Ways, evidence
from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.count_words import without_times
from mmm_core.language.known_phrases import significant_words
from mmm_core.language.plain_gestures import Meant, family_of, gesture_of, gestures, is_gesture, plain_command

SETS = (
    "words_dev",
    "words_dev_2",
    "words_dev_3",
    "words_dev_4",
    "words_dev_5",
)
"""Sets of sentences that were looked at and from which no network has learnt; `words_test` is none of them."""
SETTLING = 3e-3
"""Factor of the squared weights in the loss."""
_LIKELY = 0.4
"""Probability from which words are judged to be a gesture that no phrase of the corpus is."""


@dataclass(frozen=True)
class Labelled:
    """A sentence with its candidates.

    Attributes:
        of_set: name of its set.
        evidence: (N, F) what speaks for each candidate.
        right: (N,) bool, whether a candidate has the commands of the label.
    """

    of_set: str
    evidence: NDArray[np.float64]
    right: NDArray[np.bool_]


def train_choice(out: Path, reader: SentenceReader | None = None, sets: Sequence[str] = SETS) -> tuple[int, int, int]:
    """Find the weights and write them as a table of words, the file that `mmm_core/language/words/choice.txt` is.

    Args:
        out: file of the weights.
        reader: gives the candidates; the shipped one when None.
        sets: sets of sentences, two or more.

    Returns:
        Number of sentences with candidates, of those with a right one, and of those for which weights of the other sets choose one.
    """
    given = labelled(reader or SentenceReader.load(), sets)
    chosen = 0
    for name in sets:
        weights = fitted([one for one in given if one.of_set != name])
        chosen += sum(one.right[(one.evidence @ weights).argmax()] for one in given if one.of_set == name)
    rows = [f"{name} => {weight:.3f}" for name, weight in zip(EVIDENCE, fitted(given), strict=True)]
    comment = "# What each kind of evidence weighs for a reading: mmm_core/language/candidates.py; found by `mmmd train choice`."
    out.write_text("\n".join([comment, *rows, ""]), encoding="utf-8")
    return len(given), sum(bool(one.right.any()) for one in given), int(chosen)


def labelled(reader: SentenceReader, sets: Sequence[str] = SETS) -> list[Labelled]:
    """The sentences of sets that may be read in several ways."""
    found: list[Labelled] = []
    for of_set, sentence in tqdm(
        [(name, s) for name in sets for s in read_sentences(name)], desc="sentences", unit="sentence"
    ):
        if ways := reader.ways_to_read(sentence.text):
            right = np.array([is_right(one.reading, sentence, ways) for one in ways.candidates])
            found.append(Labelled(of_set, evidence(ways), right))
    return found


def fitted(given: Sequence[Labelled]) -> NDArray[np.float64]:
    """(F,) weights with which the right candidates of the sentences are likeliest."""
    telling = [one for one in given if one.right.any() and not one.right.all()]
    scale = np.concatenate([one.evidence for one in telling]).std(0) + 1e-6
    rows = torch.from_numpy(np.concatenate([one.evidence for one in telling]) / scale)
    right = torch.from_numpy(np.concatenate([one.right for one in telling])).to(rows)
    of_sentence = torch.tensor([i for i, one in enumerate(telling) for _ in one.right])
    weights = torch.zeros(len(scale), dtype=rows.dtype, requires_grad=True)
    optimiser = torch.optim.LBFGS([weights], max_iter=100, line_search_fn="strong_wolfe")

    def loss() -> torch.Tensor:
        optimiser.zero_grad()
        odds = (rows @ weights).exp()
        of_all, of_right = (
            torch.zeros(len(telling)).to(odds).index_add(0, of_sentence, o) for o in (odds, odds * right)
        )
        found = (of_all.log() - of_right.log()).mean() + SETTLING * weights.square().sum()
        found.backward()
        return found

    optimiser.step(loss)
    return weights.detach().numpy() / scale


def is_right(reading: Reading, sentence: Sentence, ways: Ways) -> bool:
    """Whether a reading has the commands of a sentence's label: their families, step by step, their arms and their directions.

    Arms are not judged where a family is asked for more than once, nor directions in words that are no plain command.
    """
    if list(map(len, reading.steps)) != list(map(len, sentence.commands)):
        return False
    families = [command.family for step in sentence.commands for command in step]
    judges_arms = len(set(families)) == len(families)
    return all(
        any(
            all(_agrees(c, label, ways.meant[c.text], judges_arms) for c, label in zip(said, step, strict=True))
            for said in permutations(read)
        )
        for read, step in zip(reading.steps, sentence.commands, strict=True)
    )


def _agrees(said: PlainCommand, label: Command, meant: Meant, judges_arms: bool) -> bool:
    has_arm = not judges_arms or label.side not in ("left", "right") or re.search(rf"\b{label.side}\b", said.text)
    has_way = f"{label.family}/{label.direction}" not in gestures() or gesture_of(said.text) in (
        "",
        f"{label.family}/{label.direction}",
    )
    return label.family in families_of(said.text, meant) and bool(has_arm) and has_way


def families_of(text: str, meant: Meant) -> frozenset[str]:
    """The families of the gestures that the words of a command are: by phrases of the corpus, else by what they likely mean."""
    if gesture := gesture_of(text):
        return frozenset({family_of(gesture)})
    if known := _families().get(_key(without_times(text))):
        return known
    is_likely = is_gesture(meant.name) and meant.probability >= _LIKELY
    return frozenset({family_of(meant.name)} if is_likely else ())


@cache
def _families() -> dict[str, frozenset[str]]:
    """The families that have a phrase with the same significant words; the plain command of a gesture is that gesture alone."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    plain: dict[str, frozenset[str]] = {}
    for gesture in gestures():
        family, _, direction = gesture.partition("/")
        for phrase in _phrases(family, direction):
            found[_key(phrase)].add(family)
        for said in ("", "left hand", "right hand", "both hands", "alternating hands"):
            plain.setdefault(_key(plain_command(gesture, said)), frozenset({family}))
    families = {key: frozenset(some) for key, some in found.items()} | plain
    families.pop("", None)
    return families


def _phrases(family: str, direction: str) -> Iterable[str]:
    return (phrase.replace(" {n}", "") for _, phrase in plain_phrases(family, direction))


def _key(text: str) -> str:
    return " ".join(significant_words(text))
