"""The phrases of each family: read by section and direction, many ways to say each gesture, no file left over."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.families.gesture import Words
from mmm_core.corpus.families.phrases import parse_phrases
from mmm_core.corpus.grammar import caption
from mmm_core.corpus.plain_commands import plain_phrases


def test_a_phrase_without_a_verb_is_never_bent() -> None:
    """A noun is asked for, not done by somebody: no "a person a bows"."""
    nouns = {p for _, p in plain_phrases("bow") if p.startswith(("a ", "one "))}
    assert nouns
    for seed in range(300):
        said = caption([Gesture("bow")], False, np.random.default_rng(seed)).lower()
        assert not re.search(r"\b(aing|as bow|someone a |person a |is a )", said), said


@pytest.mark.parametrize("name", sorted(FAMILIES))
def test_each_family_can_be_said_in_twenty_ways_and_for_every_side(name: str) -> None:
    family = FAMILIES[name]
    phrases = {(row, p) for where in family.directions or ("",) for row, p in plain_phrases(name, where)}
    assert len({p for _, p in phrases}) >= 20
    rows = {row for row, _ in phrases}
    wanted = {"both": "both", "left": "one", "right": "one", "alternating": "alternating", "": "none"}
    assert {wanted[s] for s in family.sides or ("",)} <= rows


def test_phrases_are_read_by_section_and_direction() -> None:
    words, directed = parse_phrases("[bare]\nnod {n}\n\n[one]\nnod left\n[up: bare]\nlook up\n", "nod.txt")
    assert words == Words(("nod {n}",), one=("nod left",))
    assert directed == {"up": Words(("look up",))}


@pytest.mark.parametrize(
    ("text", "message"), [("[bear]\nnod\n", "nod.txt:1: section '[bear]'"), ("\nnod\n[bare]\n", "nod.txt:2: a phrase")]
)
def test_a_phrase_without_a_known_section_is_named(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=re.escape(message)):
        parse_phrases(text, "nod.txt")


def test_each_family_has_its_phrase_file_and_no_file_is_left_over() -> None:
    folder = Path(__file__).parents[3] / "mmm_core" / "corpus" / "phrases"
    assert {path.stem for path in folder.glob("*.txt")} == set(FAMILIES)
