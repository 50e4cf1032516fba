"""Numbers of strokes in other words than "three times", and numbers that are none of strokes."""

from __future__ import annotations

import pytest

from mmm_core.language.count_words import count_asked
from mmm_core.language.reading import read


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("give me five claps in a row", 5), ("4 fist bumps for the crew", 4), ("give me three firm nods", 3),
        ("two big slow nods", 2), ("one slow clap", 1), ("one fist bump for grandpa", 1), ("three high fives", 3),
        ("I'd like seven arm circles", 7), ("a couple of fist pumps", 2), ("clap half a dozen times", 6),
        ("clap over your head, two of them", 2), ("blow kisses for the night shift, make it three", 3),
        ("curl the dumbbell 8 reps", 8), ("knock, three times in all", 3), ("pat my back twice, not three times", 2),
        ("pat your head five times slowly, not three", 5), ("bow once, not twice", 1), ("nod four times, never five", 4),
        ("flap your elbows, not once but twice", 2), ("a double clap", 2), ("hook, hook, hook", 3),
        # and what is none
        ("give me five", None), ("raise one arm", None), ("one more bow", None), ("clap with one hand", None),
        ("look up for a couple of seconds", None), ("no, no, no", None), ("give me two hands", None),
    ],
)  # fmt: skip
def test_the_number_of_strokes_that_is_read(text: str, count: int | None) -> None:
    commands = [command.text for step in read(text).steps for command in step]
    assert len(commands) <= 1 and (count_asked(commands[0]) if commands else None) == count
