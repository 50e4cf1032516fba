"""Makes `mmm_core/language/words/hard_phrases.txt`: phrases of the corpus that the shipped model performs badly.

    python -m docs.tools.hard_phrases out/hard_phrases.jsonl [GESTURE ...]

The model makes a motion for each phrase of the corpus, and one for the plain command of the phrase's gesture. The strict checks of
`mmmd eval fidelity` judge both. A phrase is hard if its own motion fails and the plain command's passes. Of gestures to the left
and to the right only those to the left are measured. These 165 gestures have 51,000 phrases, each of which takes a core without
matrix units a tenth of a second. The file keeps a line for each gesture that was measured, so that a run goes on where another
was cut short. When the model was trained again, delete the file and make the table anew.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

from rich.progress import track

from mmm_core.corpus.families import FAMILIES, Gesture
from mmm_core.corpus.family_words import as_read
from mmm_core.corpus.outside import OUTSIDE
from mmm_core.corpus.plain_commands import plain_phrases
from mmm_core.corpus.withheld import is_withheld
from mmm_core.evaluation.fidelity import cases_of, counting_checks, faults_of
from mmm_core.generate.engine import Engine
from mmm_core.language.hard_phrases import said_of, to_said_side
from mmm_core.language.plain_gestures import gestures, plain_command, sides_of
from mmm_core.language.word_tables import HARD_PHRASES_FILE

SEED = 7
_HEAD = (
    "# Phrases of the corpus that the model performs badly; each is said in the plain command of its gesture (plain_gestures.txt).",
    "# gesture => phrase; made by `python -m docs.tools.hard_phrases`.",
)


class Said(NamedTuple):
    """A phrase of the corpus, and the gestures that it may mean: a phrase that names no arm leaves that open."""

    text: str
    meant: tuple[Gesture, ...]


def main(found: Path, wanted: Sequence[str]) -> None:
    """Measure the wanted gestures that are missing in a file, all when none is given; then write the table."""
    lines = found.read_text("utf-8").splitlines() if found.exists() else []
    done = {line["gesture"]: line["hard"] for line in map(json.loads, lines)}
    _write(())  # each phrase is measured in its own words
    performed = cache(partial(is_performed, Engine.load()))
    for gesture in track([name for name in wanted or measured() if name not in done], "phrases"):
        done[gesture] = [said.text for said in phrases_of(gesture) if _is_hard(performed, gesture, said)]
        with found.open("a", encoding="utf-8") as out:
            out.write(json.dumps({"gesture": gesture, "hard": done[gesture]}) + "\n")
    _write(_lines(done))


def measured() -> list[str]:
    """The gestures but those that go to the right."""
    return [gesture for gesture in gestures() if "right" not in sides_of(gesture)]


def phrases_of(gesture: str) -> Iterator[Said]:
    """The phrases of a gesture, with a left arm where they name one, and without the forms that begin with "pretend"."""
    family, _, direction = gesture.partition("/")
    sides = FAMILIES[family].sides
    seen: set[tuple[str, str]] = set()
    for row, phrase in plain_phrases(family, direction):
        filled = phrase.replace("{S}", "left").replace("{D}", direction).replace("{N}", "three").replace("{n}", "")
        text = " ".join(filled.split())
        side = {"one": "left", "both": "both", "alternating": "alternating"}.get(row, "")
        said = said_of(text)
        if not said or (said, side) in seen or is_withheld(phrase) or phrase.startswith("pretend"):
            continue
        seen.add((said, side))
        count = 3 if "{N}" in phrase else 2 if row == "alternating" else 1
        possible = (side,) if side or not sides else tuple(one for one in sides if one != "alternating")
        yield Said(text, tuple(Gesture(family, one, count, direction) for one in possible))


def is_performed(engine: Engine, text: str, meant: tuple[Gesture, ...]) -> bool:
    """Whether the motion for a text passes the checks of one of the gestures that it may mean."""
    motion = engine.generate(text, seed=SEED).motion
    return any(not faults_of(motion, gesture, text, _counting(gesture.family)) for gesture in meant)


def _is_hard(performed: Callable[[str, tuple[Gesture, ...]], bool], gesture: str, said: Said) -> bool:
    plain = plain_command(gesture, said.text)
    return bool(plain) and not performed(said.text, said.meant) and performed(plain, said.meant)


@cache
def _counting(family: str) -> list[str]:
    return counting_checks(cases_of(family))


def _write(lines: Sequence[str]) -> None:
    Path(str(HARD_PHRASES_FILE)).write_text("\n".join([*_HEAD, *lines]) + "\n", encoding="utf-8")


def _lines(hard: dict[str, list[str]]) -> list[str]:
    """The lines of the table; a phrase that two gestures share is left out, and of phrases that read alike one is kept."""
    meanings: dict[str, set[str]] = defaultdict(set)
    for gesture in gestures():
        for said in phrases_of(gesture):
            meanings[said_of(as_read(said.text))].add(gesture.replace("right", "left"))
    refused = {said_of(text) for text in OUTSIDE}
    kept: dict[str, str] = {}
    for gesture in sorted(hard.keys() & {*measured()}):
        for words in map(as_read, hard[gesture]):
            is_found = to_said_side(gesture, words) == gesture and plain_command(gesture, words)
            if len(meanings[said_of(words)]) == 1 and said_of(words) not in refused and is_found:
                kept[said_of(words)] = f"{gesture} => {words}"
    return [line for said, line in kept.items() if said]


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
