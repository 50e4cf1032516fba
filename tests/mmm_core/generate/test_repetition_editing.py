"""A gesture is done as often as the text says: the number is read, strokes are counted, one is repeated or left out."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.corpus.heldout import PROBES
from mmm_core.generate.engine import Engine
from mmm_core.generate.repetition_editing import with_count
from mmm_core.language.count_words import count_asked
from mmm_core.model.tokens import FRAMES_PER_TOKEN, MAX_TOKENS
from mmm_core.motion.motion import Motion
from mmm_core.motion.repetitions import Strokes, peaks_beyond, strokes_of
from tests.support.shipped import shipped_engine

MASK = -1


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("clap three times", 3), ("Clap 3 times.", 3), ("wave twice", 2), ("nod once", 1), ("bow thrice", 3), ("clap 3x", 3),
        ("two quick nods", 2), ("do four waves using the right hand", 4), ("left fist forward, three hits", 3),
        ("just one clap", 1), ("a single nod", 1), ("tug at the rope four times with one hand", 4), ("clap ten times", 10),
    ],
)  # fmt: skip
def test_a_number_of_strokes_is_read(text: str, count: int) -> None:
    assert count_asked(text) == count


@pytest.mark.parametrize(
    "text",
    [
        "", "wave", "raise two arms", "hold both hands up for three seconds", "give me five", "at once, wave", "turn 90 degrees",
        "once you are done, bow", "bow once more", "wave twice and nod three times", "clap 100 times", "point at the two cars",
        "point at 3 o'clock", "raise one hand", "wave to two people", "show two fingers", "raise your left arm for four beats",
        "stretch like you're six years old", "hold your arms up for three breaths", "cross your arms for five heartbeats",
        "do the one two punches",
    ],
)  # fmt: skip
def test_what_is_no_number_of_strokes_is_not(text: str) -> None:
    assert count_asked(text) is None


def test_the_probes_numbers_are_read_and_hardly_any_others() -> None:
    wrong = [p.text for p in PROBES if p.then is None and p.count is not None and count_asked(p.text) != p.count]
    more = [p.text for p in PROBES if p.then is None and p.count is None and count_asked(p.text) is not None]
    assert wrong == [] and more == ["three cheers for the winner, arms up"]


@given(st.text(max_size=80))
def test_any_text_has_a_number_or_none(text: str) -> None:
    assert count_asked(text) in (None, *range(1, 13))


@cache
def nodding() -> Motion:
    return shipped_engine().generate("nod", seed=0).motion


def swinging(n: int, period: int = 12, rest: int = 8) -> Motion:
    """A body that stands still, its head nodding so often."""
    T = 2 * rest + n * period
    pitch = np.zeros(T)
    pitch[rest : rest + n * period] = 0.2 * (1 - np.cos(2 * np.pi * np.arange(n * period) / period))
    head = np.stack([np.cos(pitch / 2), np.sin(pitch / 2), 0 * pitch, 0 * pitch], -1).astype(np.float32)
    still = np.repeat(nodding().joints_m[:1], T, axis=0)
    return replace(
        nodding(), joints_m=still, head_quat_wxyz=head, forearm_twist_rad=np.zeros((T, 2), np.float32),
        features=np.zeros((T, nodding().features.shape[1]), np.float32), tokens=np.zeros(0, np.int64),
    )  # fmt: skip


@pytest.mark.parametrize("n", [2, 3, 4, 5, 8])
@pytest.mark.parametrize("period", [8, 12, 17])
def test_strokes_are_counted_whatever_moves(n: int, period: int) -> None:
    found = strokes_of(swinging(n, period))
    assert found is not None and found.sure and len(found.frames) == n
    assert all(abs(b - a - period) <= 1 for a, b in pairwise(found.frames))
    assert found.misfit < 0.1


def test_nothing_moves_nothing_is_counted() -> None:
    assert strokes_of(swinging(0, rest=20)) is None


def known(n: int, period: int) -> tuple[torch.Tensor, Strokes]:
    """A row of ids that are their positions, and its strokes."""
    T = period * n
    along = 0.1 * (1 - np.cos(2 * np.pi * np.arange(T) / period))[:, None]
    frames = peaks_beyond(along[:, 0], 0.1)
    return torch.arange(T // FRAMES_PER_TOKEN)[:, None], Strokes(along, frames, True, 0.2, 0.0)


@given(have=st.integers(2, 6), wanted=st.integers(1, 8), tokens=st.integers(2, 4))
def test_strokes_are_repeated_or_left_out_in_whole_tokens(have: int, wanted: int, tokens: int) -> None:
    ids, strokes = known(have, tokens * FRAMES_PER_TOKEN)
    row = with_count(ids, strokes, wanted, MASK)
    if have == wanted:
        assert row is None
        return
    assert row is not None
    room = (MAX_TOKENS - len(ids)) // tokens
    assert len(row) == len(ids) + tokens * min(wanted - have, room)
    kept = row[row[:, 0] != MASK, 0].tolist()
    assert set(kept) <= set(ids[:, 0].tolist()), "nothing is made up"
    assert int((row == MASK).sum()) == (min(wanted - have, room) + 1 if wanted > have else 1), "a seam is open"
    assert row[0] == 0 and row[-1] in (MASK, len(ids) - 1), "it begins and ends as before"


def test_a_motion_as_long_as_can_be_gets_no_more() -> None:
    ids, strokes = known(6, 32)
    assert len(ids) == MAX_TOKENS - 1
    assert with_count(ids, strokes, 8, MASK) is None


def test_strokes_that_are_not_clear_are_not_left_out() -> None:
    ids, strokes = known(4, 12)
    assert with_count(ids, replace(strokes, sure=False), 2, MASK) is None
    assert with_count(ids, replace(strokes, misfit=0.4), 2, MASK) is None


@pytest.mark.parametrize("count", [2, 4, 6])
def test_the_model_nods_nearly_as_often_as_it_is_told(engine: Engine, count: int) -> None:
    found = [strokes_of(engine.generate(f"nod {count} times", seed=seed).motion) for seed in range(3)]
    assert sorted(abs(len(s.frames) - count) for s in found if s is not None)[1] <= 1


def test_a_number_not_learnt_is_made_unless_one_candidate_is_wanted(engine: Engine) -> None:
    a, b, plain = (engine.generate("clap twelve times", seed=3, candidates=n).motion for n in (None, 2, 1))
    assert np.array_equal(a.tokens, b.tokens) and not np.array_equal(a.tokens, plain.tokens)
    for n in (None, 2):
        assert len(engine.generate("clap five times", seed=3, seconds=4.0, candidates=n).motion.joints_m) == 80
    for text in ("clap your hands", "clap five times"):
        a, b = (engine.generate(text, seed=3, candidates=n).motion for n in (None, 1))
        assert np.array_equal(a.tokens, b.tokens), "the model counts up to eight itself"
