"""Tags of words: the likeliest ones, and the commands that they mark."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.tagged_words import BEGINS, INSIDE, OUTSIDE, TAGS, likely_tags, marked_commands, words_of


def _score(tags: tuple[str, ...], scores: np.ndarray) -> float:
    return float(sum(scores[i, TAGS.index(tag)] for i, tag in enumerate(tags)))


def _allowed(tags: tuple[str, ...]) -> bool:
    return all(
        tag != INSIDE or (i > 0 and (tags[i - 1] in BEGINS or tags[i - 1] == INSIDE)) for i, tag in enumerate(tags)
    )


@given(
    st.lists(st.lists(st.floats(-5, 0, width=32), min_size=8, max_size=8), min_size=1, max_size=3), st.integers(1, 20)
)
def test_the_likely_tags_are_the_best_of_all_allowed_ones(rows: list[list[float]], n: int) -> None:
    scores = np.array(rows, np.float32)
    found = likely_tags(scores, n)
    assert all(_allowed(tuple(tags)) for tags, _ in found)
    assert len({tuple(tags) for tags, _ in found}) == len(found)
    best = sorted((_score(t, scores) for t in itertools.product(TAGS, repeat=len(rows)) if _allowed(t)), reverse=True)
    assert [log for _, log in found] == pytest.approx(best[:n], abs=1e-4)
    assert [log for _, log in found] == pytest.approx([_score(tuple(tags), scores) for tags, _ in found], abs=1e-4)


@given(st.text(st.characters(codec="utf-8"), max_size=30), st.data())
def test_any_tags_mark_commands_of_the_sentence_s_own_words(sentence: str, data: st.DataObject) -> None:
    spans = words_of(sentence)
    tags = data.draw(st.lists(st.sampled_from(TAGS), min_size=len(spans), max_size=len(spans)))
    marked = marked_commands(sentence, tags)
    assert all(step for step in marked.steps)
    found = [*itertools.chain.from_iterable(marked.steps), *marked.denied, *marked.for_all]
    letters = sorted(c for words in found for c in words if not c.isspace())
    chosen = sorted(
        c
        for (start, end), tag, before in zip(spans, tags, range(len(spans)), strict=True)
        if tag != OUTSIDE and not (tag == INSIDE and not any(t in BEGINS for t in tags[:before]))
        for c in sentence[start:end]
    )
    assert letters == chosen


@pytest.mark.parametrize(
    ("sentence", "tags", "steps"),
    [
        ("nod then bow", "then outside then", (("nod",), ("bow",))),
        ("before you clap nod", "outside outside then before", (("nod",), ("clap",))),
        ("nod while you wave", "then outside outside with", (("nod", "wave"),)),
        ("bow , but first clap , nod", "then outside outside outside before outside then", (("clap",), ("nod",), ("bow",))),
        ("wave uh slowly", "then outside again", (("wave slowly",),)),
    ],
)  # fmt: skip
def test_relations_between_commands_give_their_order(
    sentence: str, tags: str, steps: tuple[tuple[str, ...], ...]
) -> None:
    assert marked_commands(sentence, tags.split()).steps == steps


def test_denied_words_and_words_for_all_stand_beside_the_commands() -> None:
    marked = marked_commands(
        "slowly nod and clap, don't bow", "for_all then outside then outside outside denied".split()
    )
    assert (marked.steps, marked.denied, marked.for_all) == ((("nod",), ("clap",)), ("bow",), ("slowly",))
