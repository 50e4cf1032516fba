"""Makes word tables from the corpus's phrases and captions.

The tables are `mmm_core/recognition/family_words.txt` (words of each family) and, in `mmm_core/language/words`, `corpus_words.txt`
(all words), `limb_words.txt` (words that name a limb), `word_pairs.txt` (pairs of words), `one_gesture.txt`, `known_phrases.bin`
and `phrase_gestures.bin`. Run `python -m mmm_core.corpus.family_words` after phrases have changed; a test fails when that is needed.
"""

from __future__ import annotations

import math
import re
from array import array
from collections import Counter, defaultdict
from itertools import pairwise
from pathlib import Path

import numpy as np

from mmm_core.corpus.families import FAMILIES
from mmm_core.corpus.outside import OUTSIDE
from mmm_core.corpus.plain_commands import manner_phrases, plain_phrases
from mmm_core.corpus.synthesis import draw_spec, words_for
from mmm_core.corpus.withheld import is_withheld
from mmm_core.language.inflection import NUMBERS, gerund
from mmm_core.language.known_phrases import key_of
from mmm_core.language.limbs import SAYS_NO_LIMB
from mmm_core.language.one_gesture import JOINING, stems_of
from mmm_core.language.phrase_gestures import PhraseMeaning, packed, phrase_key
from mmm_core.language.plain_gestures import gestures, sides_of
from mmm_core.language.reading import read
from mmm_core.language.spelling import mended
from mmm_core.language.word_tables import (
    CORPUS_WORDS_FILE,
    KNOWN_PHRASES_FILE,
    LIMB_WORDS_FILE,
    ONE_GESTURE_FILE,
    PHRASE_GESTURES_FILE,
    WORD_PAIRS_FILE,
)
from mmm_core.language.word_tables import lines as table_lines
from mmm_core.recognition.named import HIGHEST_LEVEL, WORDS_FILE, content_words


def family_phrases() -> dict[str, list[str]]:
    """The phrases of each family without their slots, families in alphabetical order."""
    return {
        name: [
            re.sub(r"\{.\}", " ", phrase)
            for direction in FAMILIES[name].directions or ("",)
            for _, phrase in plain_phrases(name, direction)
        ]
        for name in sorted(FAMILIES)
    }


def family_words() -> str:
    """The content of `family_words.txt`: a line for each family with its words, each with a digit for its frequency."""
    lines: list[str] = []
    for name, phrases in family_phrases().items():
        counts = Counter(word for phrase in phrases for word in content_words(phrase))
        levels = {w: HIGHEST_LEVEL + round(math.log2(n / len(phrases))) for w, n in counts.items()}
        lines.append(f"{name}: {' '.join(f'{w}{max(1, levels[w])}' for w in sorted(levels))}\n")
    return "".join(lines)


def corpus_words() -> str:
    """The content of `corpus_words.txt`: the words of phrases, manner, order and everyday requests, the commonest first."""
    phrases = [phrase for several in family_phrases().values() for phrase in several]
    counts = Counter(word for phrase in phrases for word in _words(phrase))
    often = max(counts.values()) // 40
    for phrase in (*manner_phrases(), *NUMBERS, *_ALSO):
        counts.update(dict.fromkeys(_words(phrase), often))
    counts.update(word for line in table_lines("everyday") for word in _words(line))
    return "".join(f"{word}\n" for word, _ in sorted(counts.items(), key=lambda item: (-item[1], item[0])))


def limb_words() -> str:
    """The content of `limb_words.txt`: verbs and nouns of gestures that nearly always move the same limb.

    A verb is the first word of a phrase; a noun stands in a phrase that begins with an article or another word of `SAYS_NO_LIMB`.
    """
    counts: dict[str, defaultdict[str, Counter[str]]] = {kind: defaultdict(Counter) for kind in ("verbs", "nouns")}
    for family, phrases in family_phrases().items():
        for phrase in phrases:
            first, *others = re.findall(r"[a-z]+", phrase.lower())
            if first in SAYS_NO_LIMB:
                for word in set(others) - SAYS_NO_LIMB:
                    counts["nouns"][word][FAMILIES[family].limb] += 1
            else:
                counts["verbs"][first][FAMILIES[family].limb] += 1
    lines: list[str] = []
    for kind, words in counts.items():
        of_limb: defaultdict[str, list[str]] = defaultdict(list)
        for word, limbs in words.items():
            (limb, n), *_ = limbs.most_common(1)
            if limb and n >= FEWEST_PHRASES and n >= SURE_SHARE * limbs.total():
                of_limb[limb].append(word)
        lines += [f"{kind} {limb} => {' '.join(sorted(of_limb[limb]))}\n" for limb in sorted(of_limb)]
    return "".join(lines)


def word_pairs() -> str:
    """The content of `word_pairs.txt`: for each word the words that follow it in captions; "^" and "$" mark a caption's ends."""
    known = set(table_lines("corpus_words")) | {"a", "i", "^", "$"}
    counts: Counter[tuple[str, str]] = Counter()
    rng = np.random.default_rng(CAPTION_SEED)
    captions = [text for _ in range(N_CLIPS) for text in words_for(draw_spec(rng), rng)]
    for text in captions:
        counts.update(pairwise(["^", *re.findall(r"[a-z]+", text.lower()), "$"]))
    following: defaultdict[str, list[str]] = defaultdict(list)
    for (first, second), n in sorted(counts.items()):
        if n >= FEWEST_CAPTIONS and {first, second} <= known:
            following[first].append(second)
    return "".join(f"{first} => {' '.join(words)}\n" for first, words in following.items())


def one_gesture() -> str:
    """The content of `one_gesture.txt`: phrases of one gesture that the reader's rules alone would divide or take as a denial.

    Phrases of standing still are left out, because "do not move" is a denial of everything else. So are phrases of one side after
    the other ("look left and right", "tilt your head one way, then the other"), because dividing them changes nothing.
    """
    parted: dict[tuple[str, ...], str] = {}
    joined = re.compile(rf"[,;:]|\b(?:{'|'.join(word for word in JOINING if word.isalpha())})\b")
    for name in sorted(FAMILIES.keys() - {"stand"}):
        phrases = [(d, p) for d in FAMILIES[name].directions or ("",) for _, p in plain_phrases(name, d)]
        for direction, phrase in phrases:
            if (
                re.match("pretend|.*[.!?]", phrase)
                or not joined.search(phrase)
                or {"left", "right"} <= set(phrase.split())
                or re.search(r"\bone (?:side|way|hand|arm|fist)\b.*\b(?:then|and)\b.*\bother\b|\bboth ways\b", phrase)
            ):
                continue
            said = phrase.replace("{n}", "").replace("{D}", direction).replace("{S}", "left").replace("{N}", "three")
            said = mended(said)
            stems = stems_of(said)
            forms = (said,) if said.startswith(("the ", "a ", "an ")) else (said, gerund(said, None))
            divided = next(filter(_is_parted, forms), "")
            if divided and stems not in parted:
                parted[stems] = divided
    return "".join(f"{said}\n" for said in parted.values())


def known_phrases() -> bytes:
    """The content of `known_phrases.bin`: hashes of the corpus's phrases without those in `OUTSIDE`, ascending, four bytes each."""
    keys: set[int | None] = set()
    for name in sorted(FAMILIES):
        for direction in FAMILIES[name].directions or ("",):
            keys |= {
                key_of(re.sub(r"\{[Sn]\}|\{N\}", "", p.replace("{D}", direction)))
                for _, p in plain_phrases(name, direction)
            }
    keys -= {None, *map(key_of, OUTSIDE)}
    return array("I", sorted(key for key in keys if key is not None)).tobytes()


def phrase_gestures() -> bytes:
    """The content of `phrase_gestures.bin`: phrases of one gesture alone, apart from its side, that no held-out text may use.

    A phrase stands there in its own words and in those in which the rules read it; where these are another phrase's own words,
    they mean what that one does.
    """
    meanings: defaultdict[int | None, set[tuple[str, str]]] = defaultdict(set)
    of_rules: defaultdict[int | None, set[tuple[str, str]]] = defaultdict(set)
    for gesture in gestures():
        if "right" in sides_of(gesture):
            continue  # its phrases are those of the mirror image
        family, _, direction = gesture.partition("/")
        for row, phrase in plain_phrases(family, direction):
            if is_withheld(phrase) or phrase.startswith("pretend"):
                continue
            said = phrase.replace("{D}", direction).replace("{N}", "three").replace("{S}", "left").replace("{n}", "")
            meanings[phrase_key(said)].add((gesture, row))
            of_rules[phrase_key(as_read(said))].add((gesture, row))
    outside = {None, *map(phrase_key, OUTSIDE)}
    of_one: dict[int, PhraseMeaning] = {}
    for key, found in (of_rules | meanings).items():
        if key is not None and key not in outside and len({gesture for gesture, _ in found}) == 1:
            of_one[key] = PhraseMeaning(min(found)[0], {row for _, row in found} == {"both"})
    return packed(of_one)


def as_read(phrase: str) -> str:
    """The command that the rules read in a phrase; empty where they read several or none."""
    steps = read(" ".join(phrase.split())).steps
    return steps[0][0].text if [len(step) for step in steps] == [1] else ""


def _is_parted(phrase: str) -> bool:
    reading = read(phrase, by_rules_alone=True)
    return len(reading.steps) != 1 or len(reading.steps[0]) != 1 or bool(reading.denied)


def _words(phrase: str) -> set[str]:
    return set(re.findall(r"[a-z]{2,}", phrase.lower()))


_ALSO = (
    "not never without instead rather except anything nothing but only just leave still again once twice thrice times more "
    "another other others same while during meanwhile together both then after before next first finally afterwards "
    "follow followed start finish begin end until seconds second minutes hold keep stay please could would can thanks want "
    "slowly slow quickly quick fast faster slower slightly little tiny huge big small large deeply hello goodbye"
).split()  # fmt: skip
"""Words of contrast, order, time and manner that are common in requests but rare in phrases."""

FEWEST_PHRASES, SURE_SHARE = 4, 0.96
"""Least number of phrases with a word of `limb_words.txt`, and least share of them that move the same limb."""

N_CLIPS, CAPTION_SEED, FEWEST_CAPTIONS = 20_000, 5, 5
"""Number and seed of the clips whose captions are counted for `word_pairs.txt`, and least count of a pair of words."""

if __name__ == "__main__":
    Path(str(WORDS_FILE)).write_text(family_words(), encoding="utf-8")
    Path(str(CORPUS_WORDS_FILE)).write_text(corpus_words(), encoding="utf-8")
    Path(str(WORD_PAIRS_FILE)).write_text(word_pairs(), encoding="utf-8")
    Path(str(LIMB_WORDS_FILE)).write_text(limb_words(), encoding="utf-8")
    Path(str(ONE_GESTURE_FILE)).write_text(one_gesture(), encoding="utf-8")
    Path(str(KNOWN_PHRASES_FILE)).write_bytes(known_phrases())
    Path(str(PHRASE_GESTURES_FILE)).write_bytes(phrase_gestures())
