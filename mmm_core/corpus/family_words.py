"""The words by which phrases name each gesture family, for `mmm_core/recognition/family_words.txt`.

Run `python -m mmm_core.corpus.family_words` after phrases have changed; a test says when that is needed.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.grammar import plain_phrases
from mmm_core.recognition.named import HIGHEST_LEVEL, WORDS_FILE, content_words


def family_phrases() -> dict[str, list[str]]:
    """The phrases of each family with their slots left out, families in the order of their names."""
    return {
        name: [
            re.sub(r"\{.\}", " ", phrase)
            for direction in FAMILIES[name].directions or ("",)
            for _, phrase in plain_phrases(name, direction)
        ]
        for name in sorted(FAMILIES)
    }


def family_words() -> str:
    """The content of `family_words.txt`: a line for each family, its words each with a digit that tells how common it is."""
    lines: list[str] = []
    for name, phrases in family_phrases().items():
        counts = Counter(word for phrase in phrases for word in content_words(phrase))
        levels = {w: HIGHEST_LEVEL + round(math.log2(n / len(phrases))) for w, n in counts.items()}
        lines.append(f"{name}: {' '.join(f'{w}{max(1, levels[w])}' for w in sorted(levels))}\n")
    return "".join(lines)


if __name__ == "__main__":
    Path(str(WORDS_FILE)).write_text(family_words(), encoding="utf-8")
