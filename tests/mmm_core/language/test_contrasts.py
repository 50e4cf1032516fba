"""One act is set against another, set aside or taken back, in words of all kinds."""

from __future__ import annotations

import pytest

from tests.support.readings import said


@pytest.mark.parametrize(
    ("text", "read_as"),
    [
        ("do not point up or down just clap", "clap | not: point up or down"),
        ("give yawning a rest and nod", "nod | not: yawning"), ("give the dab a miss, clap", "clap | not: the dab"),
        ("keep waving for another day and salute", "salute | not: waving"),
        ("save looking up to the right for later and clap", "clap | not: looking up to the right"),
        ("raise your right hand; as for bowing, forget it", "raise your right hand | not: bowing"),
        ("out with clapping, in with waving", "wave | not: clapping"),
        ("in with waving, out with clapping", "wave | not: clapping"),
        ("can we not bow and wave instead", "wave | not: bow"),
        ("prefer waving to clapping", "wave | not: clapping"), ("I'd prefer a hug to a handshake", "a hug | not: a handshake"),
        ("not so much clapping as waving", "wave | not: clapping"),
        ("bow minus waving", "bow | not: waving"), ("clap, and hold the waving", "clap | not: waving"),
        ("skip the part where you bow, and clap", "clap | not: bow"),
        ("clap please, and by no means bow", "clap | not: bow"),
        ("look around, I mean type on a keyboard", "type on a keyboard"), ("nod, then bow, I mean clap", "nod; clap"),
        ("never look left", " | not: look left"), ("can you not look left", " | not: look left"),
        ("don't let me see you wave", " | not: wave"), ("don't look back", " | not: look back"),
        # and what looks like it
        ("give your arms a rest", "lower both arms"), ("raise your left arm, I mean your right", "raise your right arm"),
        ("keep your arms up for another second", "keep your arms up for another second"), ("hold the box", "hold the box"),
        ("one curious look left", "look to the left"), ("don't look", "cover your eyes with both hands"),
    ],
)  # fmt: skip
def test_what_is_set_against_what(text: str, read_as: str) -> None:
    assert said(text) == read_as
