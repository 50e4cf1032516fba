"""Moods in which a gesture can be made (happily, tiredly, like a machine), their words and their effects on a motion."""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Mood:
    """A mood of gestures.

    Attributes:
        words: words for the mood in the corpus's sentences, which follow the gesture's.
        tempo, size: factors on the gesture's tempo and, where the corpus performs it, on its size.
        trunk_pitch_rad, head_pitch_rad: posture, forward and down positive.
        stiffness: 1 for movements without lag, sway or any added movement.
        also: further words that are read.
    """

    words: tuple[str, ...]
    tempo: float = 1.0
    size: float = 1.0
    trunk_pitch_rad: float = 0.0
    head_pitch_rad: float = 0.0
    stiffness: float = 0.0
    also: tuple[str, ...] = ()


MOODS: dict[str, Mood] = {
    "happy": Mood(
        ("happily", "cheerfully", "joyfully", "with joy", "in a good mood"), 1.15, 1.12, -0.035, -0.1,
        also=("merrily", "gleefully", "cheerily", "in a happy way", "joyously", "with delight"),
    ),
    "sad": Mood(
        ("sadly", "tiredly", "wearily", "without energy", "in a sad way", "listlessly"), 0.72, 0.78, 0.11, 0.2,
        also=("glumly", "gloomily", "mournfully", "dejectedly", "unhappily", "sorrowfully", "in a bad mood", "miserably"),
    ),
    "proud": Mood(
        ("proudly", "confidently", "with pride", "self-confidently"), 0.95, 1.05, -0.07, -0.08,
        also=("with confidence", "smugly"),
    ),
    "shy": Mood(
        ("shyly", "timidly", "nervously", "hesitantly"), 0.85, 0.72, 0.04, 0.14, also=("bashfully", "coyly", "sheepishly")
    ),
    "stiff": Mood(
        ("stiffly", "mechanically", "like a machine", "jerkily"), 1.1, 1.0, 0.0, 0.0, 1.0, also=("robotically", "woodenly")
    ),
}  # fmt: skip
_MOOD_OF = {word: name for name, mood in MOODS.items() for word in (*mood.words, *mood.also)}
_SAID = re.compile(
    r",?\s*\b(?:(?:very|so|really|rather|quite|a bit|a little|somewhat) )?"
    rf"({'|'.join(sorted(_MOOD_OF, key=len, reverse=True))})\b(?! like\b|-)"
)
_GESTURE_OF_ITS_OWN = re.compile(
    r"\b(?:danc\w+|moves?|moving|stands?|standing|slump\w*|posture|wait\w*|jerks?|"
    r"shout\w*|crazy|wild|yourself|himself|herself|overflow\w*|loose|jump\w*|leap\w*|burst\w*|cry|weep\w*)$"
)
"""Words that make a gesture of their own with a mood after them: "dance mechanically", "go crazy with joy"."""


def mood_of(clause: str) -> tuple[str, str]:
    """A clause in lower case without its words for a mood, and the mood's name; the clause and "" where there are none.

    >>> mood_of("wave twice, very sadly"), mood_of("dance mechanically")
    (('wave twice', 'sad'), ('dance mechanically', ''))
    """
    found = _SAID.search(clause)
    if found is None:
        return clause, ""
    before, after = clause[: found.start()], clause[found.end() :]
    first = not before.strip(" ,")
    rest = after.lstrip(" ,") if first else before + after
    if not rest or _GESTURE_OF_ITS_OWN.search(before) or (first and not found[1].endswith("ly") and after[:1] != ","):
        return clause, ""
    return rest, _MOOD_OF[found[1]]
