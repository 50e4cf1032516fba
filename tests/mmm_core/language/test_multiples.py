"""A number beside a comparison is a factor of tempo or size, and no number of strokes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mmm_core.language.context import InContext, conversation
from mmm_core.language.count_words import count_asked
from mmm_core.language.manner import FASTEST, LARGEST
from mmm_core.language.multiples import multiple_in, multiples_in
from mmm_core.language.number_words import number_words
from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("words", "tempo", "size"),
    [
        ("half as big", 1, 0.5), ("half as deep as before", 1, 0.5), ("twice as wide", 1, 2), ("three times as far", 1, 3),
        ("half as fast", 0.5, 1), ("twice as fast", 2, 1), ("twice as slowly", 0.5, 1), ("3x as quick", 3, 1),
        ("half as slow", 2, 1),
        ("2x faster", 2, 1), ("3 times slower", 1 / 3, 1), ("50 percent slower", 0.5, 1), ("by 20% faster", 1.2, 1),
        ("a third smaller", 1, 2 / 3), ("one and a half times as fast as usual", 1.5, 1), ("a quarter as large", 1, 0.25),
        ("at half speed", 0.5, 1), ("at half your usual speed", 0.5, 1), ("at 150 percent of the speed", 1.5, 1),
        ("at double the pace", 2, 1), ("at 0.5 speed", 0.5, 1), ("at 2x speed", 2, 1), ("twice the size", 1, 2), ("at 2x", 2, 1),
        ("at 200 percent", 2, 1), ("at about 80%", 0.8, 1), ("at three quarters of the speed", 0.75, 1), ("at .5 times", 0.5, 1),
    ],
)  # fmt: skip
def test_a_multiple_is_a_factor(words: str, tempo: float, size: float) -> None:
    found = multiple_in(f"wave {words}")
    assert found is not None and (found.start, found.end) == (5, 5 + len(words))
    assert (found.tempo, found.size) == pytest.approx((tempo, size))


@pytest.mark.parametrize(
    "text",
    [
        "wave three times as big as you can", "nod twice as fast as you can", "wave twice", "bow three times, slower", "clap 3x",
        "wave to half the crowd", "raise your arm halfway", "nod twice and faster", "half the people wave", "at two, wave",
        "100 percent slower", "wave at 2 people", "wave at 50 percent of the crowd", "point at 3",
    ],
)  # fmt: skip
def test_what_compares_nothing_is_no_multiple(text: str) -> None:
    assert multiple_in(text) is None


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("wave half as big, three times", ("wave three times (0.56 times as large)",)),
        ("wave three times half as big", ("wave three times (0.56 times as large)",)),
        ("wave twice as fast, half as big", ("wave (2 times as fast, 0.56 times as large)",)),
        ("nod twice, half as fast", ("nod twice (0.5 times as fast)",)),
        ("clap twice as fast, then bow half as deep", ("clap (2 times as fast)", "bow (0.56 times as large)")),
    ],
)  # fmt: skip
def test_commands_take_multiples(text: str, sentences: tuple[str, ...]) -> None:
    """Half as big was read as large, and twice as big as two strokes."""
    assert read(text).sentences == sentences


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("again, half as big", "nod (0.56 times as large)"), ("make it twice as big", "nod (1.8 times as large)"),
        ("do that 2x faster", "nod (2 times as fast)"), ("20 percent slower please", "nod (0.8 times as fast)"),
        ("three times, half as fast", "nod three times (0.5 times as fast)"),
    ],
)  # fmt: skip
def test_a_later_text_changes_by_a_multiple(text: str, sentence: str) -> None:
    _, found = conversation(["nod", text])
    assert isinstance(found, InContext) and found.reading.sentences == (sentence,)


@given(
    st.integers(2, 30), st.sampled_from(["as fast", "as big", "faster", "as slow"]), st.sampled_from([" times", "x"])
)
def test_the_number_of_a_multiple_counts_no_strokes(number: int, compared: str, times: str) -> None:
    text = f"wave {number}{times} {compared}"
    (command,) = (command for step in read(text).steps for command in step)
    assert count_asked(command.text) is None and command.manner.hold_s == 0
    assert 1 / FASTEST <= command.manner.tempo <= FASTEST and 1 / LARGEST <= command.manner.size <= LARGEST
    assert (command.manner.tempo, command.manner.size) != (1, 1)
    assert number_words(f"wave {number} times {compared}".split()) == []


@given(st.text(st.sampled_from("0123456789.%x abehiklmnorstuw "), max_size=40))
def test_any_text_can_be_searched(text: str) -> None:
    for found in multiples_in(text):
        assert 0 <= found.start < found.end <= len(text) and found.tempo > 0 and found.size > 0
