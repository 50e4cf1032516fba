"""What a text is said to mean: words that the sentence vector hardly tells apart are read from the text itself."""

from __future__ import annotations

import pytest
import torch

from mmm_core.language.meaning import Meanings

COMMANDS = (
    "lower both arms", "both arms up", "raise your left arm", "raise your right arm", "clap three times", "clap like a seal",
    "nod", "3 blown kisses with both hands", "shrug your shoulders",
)  # fmt: skip


def nearest(text: str, **cosines: float) -> str:
    """The meaning where these commands, by their first words with `_`, lie so near; the others at 0.1."""
    near = torch.full((len(COMMANDS),), 0.1)
    for begin, cosine in cosines.items():
        (i,) = [i for i, c in enumerate(COMMANDS) if c.startswith(begin.replace("_", " "))]
        near[i] = cosine
    return Meanings(COMMANDS).nearest(text, near)


@pytest.mark.parametrize(
    ("text", "cosines", "expected"),
    [
        ("raise both arms", {"lower_both": 0.85, "both_arms": 0.8}, "both arms up"),
        ("put both arms down", {"both_arms": 0.9, "lower_both": 0.5}, "lower both arms"),
        ("raise the right arm", {"raise_your_left": 0.95, "raise_your_right": 0.9}, "raise your right arm"),
        ("clap twice", {"clap_three": 0.88, "clap_like": 0.6}, "clap"),
        ("clap three times", {"clap_three": 0.99}, "clap three times"),
        ("clap", {"clap_three": 0.9, "clap_like": 0.85}, "clap"),
        ("nod three times", {"nod": 0.9}, "nod"),
        ("nod three times", {"nod": 0.7, "clap_three": 0.69}, "clap three times"),
        ("shrug", {"shrug": 0.7, "lower_both": 0.9}, "shrug your shoulders"),
        ("blow kisses with both hands", {"3_blown": 0.9, "both_arms": 0.4}, "both arms up"),
        ("bend the left knee to the right", {"nod": 0.8}, "nod"),
    ],
)
def test_the_nearest_that_says_nothing_else_about_side_way_and_number(
    text: str, cosines: dict[str, float], expected: str
) -> None:
    assert nearest(text, **cosines) == expected


def test_a_way_that_only_one_of_them_names_contradicts_nothing() -> None:
    assert nearest("raise a hand to your shoulders", shrug=0.8) == "shrug your shoulders"
