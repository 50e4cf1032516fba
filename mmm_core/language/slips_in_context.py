"""A word that the words beside it make unlikely, and one slip from it another that stands there in captions: "nod fat", "then don".

Two words stand beside each other where `words/word_pairs.txt` has them, pairs of words of the corpus's captions. A word that one
of its neighbours expects stays, and so do common words of English but for a slip of one letter from a common word of commands
that both neighbours expect. After an article stands whatever one can wave at, so that no common word is changed there.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache, lru_cache

from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.word_tables import REMEMBERED, lines, pairs

KEY_WORDS = 540
"""Commonest words of the corpus, for which other words of English are taken to be slips."""
EXPECTED = 0.35
"""Weighted distance that a candidate gains for each neighbour that expects it."""
_TOKEN = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)*")
_ARTICLES = frozenset("a an the my your this that these his her our their some any at".split())
_BEFORE_VERBS = frozenset(
    (
        "^ and then please to you robot now but or not just also next while can could would will first kindly i we they he she "
        "person man woman someone somebody character human figure humanoid lady boy girl child"
    ).split()
)
_STAYS = frozenset(
    (
        "nor when where while than that what who whom whose which why how if for from but because until unless since though about "
        "into she he we they it its is was were are be been being has have having does did will would should must may might much "
        "many more most very too yet "
        "one two three four five six seven eight nine ten eleven twelve"
    ).split()
)
"""Words that decide the sense of a sentence; they never count as misspellings."""
_WAYS = frozenset("left right up down back forward then".split())
"""Words that are taken to be meant even where a verb may stand, which can be any."""


def mended_in_context(
    said: str,
    is_right: Callable[[str], bool],
    is_rare: Callable[[str], bool],
    near: Callable[[str], list[tuple[float, str]]],
) -> str:
    """A text in lower case with its unlikely words replaced by the intended words.

    Args:
        said: the text.
        is_right: whether a word is spelled correctly.
        is_rare: whether a word is so rare that any corpus word that both neighbours expect may replace it.
        near: candidates for a word, each with its weighted distance.
    """
    found = list(_TOKEN.finditer(said))
    words = ["^", *(m[0] for m in found), "$"]
    for i in range(1, len(words) - 1):
        word, before, after = words[i], words[i - 1], words[i + 1]
        if len(word) < 2 or not word.isascii() or is_beside(before, word) or is_beside(word, after):
            continue
        if not is_right(word):
            words[i] = _expected(near(word), before, after, 1) or word
        elif before not in _ARTICLES and not _stays(word):
            meant = _expected(near(word) if is_rare(word) else _key_words_near(word), before, after, 2)
            if meant and (before not in _BEFORE_VERBS or (meant in _WAYS and before != "^")):
                words[i] = meant
    parts: list[str] = []
    end = 0
    for match, word in zip(found, words[1:-1], strict=True):
        parts += [said[end : match.start()], word]
        end = match.end()
    return "".join(parts) + said[end:]


def _stays(word: str) -> bool:
    return word in _key_words() or word in _STAYS or word in lines("stays") or is_gesture_verb(word)


def is_beside(first: str, second: str) -> bool:
    """Whether a word follows another in captions; "^" and "$" are their ends."""
    return second in _following().get(first, ())


def _expected(candidates: list[tuple[float, str]], before: str, after: str, least: int) -> str:
    """The nearest candidate, where being expected by a neighbour counts as `EXPECTED`; "" where fewer than `least` expect one."""
    found = [(cost, word, is_beside(before, word) + is_beside(word, after)) for cost, word in candidates]
    fitting = [(cost - EXPECTED * n, word) for cost, word, n in found if n >= least]
    return min(fitting)[1] if fitting else ""


@cache
def _following() -> dict[str, frozenset[str]]:
    return {first: frozenset(words.split()) for first, words in pairs("word_pairs")}


@cache
def _key_words() -> frozenset[str]:
    return frozenset(lines("corpus_words")[:KEY_WORDS])


@cache
def _by_shortened() -> dict[str, list[str]]:
    """Key words by what is left of them without one letter, and by themselves (symmetric deletion, as SymSpell has it)."""
    found: dict[str, list[str]] = {}
    for word in lines("corpus_words")[:KEY_WORDS]:
        for short in _shortened(word):
            found.setdefault(short, []).append(word)
    return found


def _shortened(word: str) -> set[str]:
    return {word, *(word[:i] + word[i + 1 :] for i in range(len(word)))}


@lru_cache(maxsize=REMEMBERED)
def _key_words_near(word: str) -> list[tuple[float, str]]:
    """Key words one slip from a word: a letter lost, added, doubled, changed, or two that change places; the commonest first."""
    near = dict.fromkeys(key for short in _shortened(word) for key in _by_shortened().get(short, ()))
    ranks = lines("corpus_words")[:KEY_WORDS]
    return [(ranks.index(key) / KEY_WORDS, key) for key in near if len(key) > 2 and _is_one_slip(word, key)]


def _is_one_slip(word: str, meant: str) -> bool:
    if len(word) != len(meant):
        return True  # one is the other without a letter, or both are without one: then the lengths are equal
    apart = [i for i, (a, b) in enumerate(zip(word, meant, strict=True)) if a != b]
    i, j = apart[0], apart[-1]
    return len(apart) == 1 or (len(apart) == 2 and j == i + 1 and word[i] == meant[j] and word[j] == meant[i])
