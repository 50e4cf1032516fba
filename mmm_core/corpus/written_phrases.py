"""Phrases by which people ask for the gestures of the corpus, beyond those of its captions: what the gesture classifier learns from.

The captions' phrases (`mmm_core/corpus/phrases`) are patterns with slots. These are single phrases of sixteen writers, about 130 for each
gesture, one a line: the gesture, " => ", the phrase. Each file of the folder has the phrases of several writers.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from mmm_core.corpus.withheld import is_withheld
from mmm_core.errors import TrainingDataError
from mmm_core.language.plain_gestures import gestures

WRITTEN_PHRASES = Path(__file__).parent / "prompts" / "gesture_phrases"


def load_written_phrases(folder: Path = WRITTEN_PHRASES) -> dict[str, tuple[str, ...]]:
    """The phrases of each gesture, without those that are withheld from training.

    Args:
        folder: its `.txt` files are read, in the order of their names; lines that begin with # are comments.

    Raises:
        TrainingDataError: a line names no gesture or has no phrase.
    """
    known, found = frozenset(gestures()), defaultdict[str, list[str]](list)
    for path in sorted(folder.glob("*.txt")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if not line.strip() or line.startswith("#"):
                continue
            gesture, _, phrase = (part.strip() for part in line.partition("=>"))
            if gesture not in known or not phrase:
                raise TrainingDataError(
                    path, f"line {number}", repr(line), "a gesture of plain_gestures.txt, => and a phrase"
                )
            if not is_withheld(phrase):
                found[gesture].append(phrase)
    return {gesture: tuple(phrases) for gesture, phrases in found.items()}
