"""The sentence parser: its probabilities are those of a causal model, and its search finds the likeliest answers."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
import torch

from mmm_core.model.parsing import likeliest, log_likelihoods, memory_of, number_probabilities
from mmm_core.model.sentence_parser import END_ID, START_ID, Memory, ParserConfig, SentenceParser
from mmm_core.model.text import MiniLmConfig

TEXT = MiniLmConfig(vocabulary=10, width=32, n_heads=2, mlp_width=64)
CONFIG = ParserConfig(("start", "end", "a", "b", "c"), n_own=1, width=16, n_layers=2, n_heads=2, longest=6)


@pytest.fixture(scope="module")
def parser() -> SentenceParser:
    torch.manual_seed(0)
    made = SentenceParser(CONFIG, TEXT).eval().requires_grad_(False)
    made.out.weight.mul_(8)  # untrained probabilities are nearly equal
    return made


@pytest.fixture(scope="module")
def sentence(parser: SentenceParser) -> Memory:
    return memory_of(parser, torch.randn(7, TEXT.width))


def test_the_probabilities_of_all_answers_add_up_to_one(parser: SentenceParser, sentence: Memory) -> None:
    answers = [(START_ID, *middle, END_ID) for n in range(3) for middle in _sequences(n)]
    longer = [(START_ID, *middle) for middle in _sequences(3)]
    total = sum(
        map(math.exp, [*log_likelihoods(parser, sentence, answers), *log_likelihoods(parser, sentence, longer)])
    )
    assert total == pytest.approx(1, abs=1e-4)


def _sequences(n: int) -> list[tuple[int, ...]]:
    """All sequences of n tokens but END."""
    others = [i for i in range(len(CONFIG.tokens)) if i != END_ID]
    found: list[tuple[int, ...]] = [()]
    for _ in range(n):
        found = [(*one, i) for one in found for i in others]
    return found


def test_the_search_finds_the_likeliest_answers_with_their_probabilities(
    parser: SentenceParser, sentence: Memory
) -> None:
    every = [middle for n in range(5) for middle in _sequences(n)]
    logs = log_likelihoods(parser, sentence, [(START_ID, *middle, END_ID) for middle in every])
    best = sorted(zip(logs, every, strict=True), reverse=True)[:3]
    found = likeliest(parser, sentence, 200)
    assert [one.ids for one in found[:3]] == [ids for _, ids in best]
    assert [one.log_probability for one in found[:3]] == pytest.approx([log for log, _ in best], abs=1e-4)


def test_a_narrow_search_gives_answers_with_their_own_probabilities(parser: SentenceParser, sentence: Memory) -> None:
    found = likeliest(parser, sentence, 2)
    assert 1 <= len(found) <= 2
    logs = log_likelihoods(parser, sentence, [(START_ID, *one.ids, END_ID) for one in found])
    assert [one.log_probability for one in found] == pytest.approx(logs, abs=1e-4)


def test_other_lengths_beside_an_answer_and_padding_change_nothing(parser: SentenceParser) -> None:
    states = torch.randn(1, 5, TEXT.width)
    ids = torch.tensor([[START_ID, 2, 3]])
    mask = torch.ones(1, 5, dtype=torch.bool)
    plain = parser(parser.remember(states, mask), mask, ids)
    padded = torch.cat([states, torch.randn(1, 3, TEXT.width)], 1)
    wider = torch.cat([mask, torch.zeros(1, 3, dtype=torch.bool)], 1)
    assert torch.allclose(parser(parser.remember(padded, wider), wider, ids), plain, atol=1e-5)
    longer = torch.tensor([[START_ID, 2, 3, 4]])
    assert torch.allclose(parser(parser.remember(states, mask), mask, longer)[:, :3], plain, atol=1e-5)


def test_numbers_are_judged_for_each_gesture_by_itself(parser: SentenceParser) -> None:
    """The pointer scores a pair by the number's word and by the tokens up to the gesture, whatever comes after it."""
    ids = (START_ID, 2, 3, 4, 4, 3, 2)
    parser = SentenceParser(replace(CONFIG, longest=8), TEXT).eval().requires_grad_(False)
    memory = memory_of(parser, torch.randn(7, TEXT.width))
    one, both = (number_probabilities(parser, memory, (2, 5), (*ids[:end], END_ID)) for end in (4, 7))
    assert one.shape == (2, 1) and both.shape == (2, 2)
    assert torch.allclose(one, both[:, :1], atol=1e-6)
    assert len(set(both.flatten().tolist())) == 4 and ((both > 0) & (both < 1)).all()
