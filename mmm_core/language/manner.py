"""Tempo, size, hold and mood that a clause names: they are applied to the motion, and the model does not read them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

from mmm_core.language.count_words import NUMBERS
from mmm_core.language.moods import MOODS, mood_of
from mmm_core.language.multiples import multiples_in
from mmm_core.language.word_tables import RuleTable, lines

STRONGER = 1.25
"""Factor, on the logarithm, of "very" and the like before a word of manner."""
FASTEST, LARGEST = 2.0, 1.8
"""Largest factors of tempo and size; the smallest factors are their inverses."""
LONGEST_HOLD_S = 30.0
"""Longest hold that is made; a longer one is read as it is said (`impossible_counts`)."""
_GESTURES = (
    "(?:waves?|nods?|bows?|claps?|claps|shrugs?|hugs?|salutes?|leans?|tilts?|punch(?:es)?|stretch(?:es)?|circles?|shakes?|turns?|"
    "movements?|motions?|gestures?|steps?|kisses|kiss|pats?|taps?|knocks?|swings?|strokes?|bends?|twists?|sways?|beckons?|"
    "head ?shakes?|applause|greeting|handshakes?|throws?|jabs?|hooks?|pumps?|cheers?|yawns?|points?|dips?|flaps?|sweeps?|arcs?|"
    "glances?|looks?|rolls?|presses|press|push(?:es)?|pulls?|raises?|lifts?|stirs?|scratch(?:es)?|wipes?|chops?|flicks?|rubs?|"
    "squeezes?|peeks?|tugs?|heaves?|toss(?:es)?|swats?|slaps?|thumps?|spins?|wiggles?|waggles?|nudges?|grabs?)"
)
"""Nouns of gestures that an adjective of size may precede."""
_VERY = r"(?:(?:ever so|oh so|very|really|real|dead|proper|bloody|insanely|crazy|ridiculously|painfully|super|extremely|so|incredibly|ultra|extra|terribly|awfully|quite|pretty|rather|a bit|a little|as|nice and|oh so|much|(?<!the )(?<!your )(?<!this )(?<!that )way) )*"
_STRONG = re.compile(
    r"\b(?:ever so|very|really|dead|insanely|ridiculously|painfully|super|extremely|incredibly|ultra|extra|terribly|awfully|much|way|oh so)\b"
)
_SECONDS = {**NUMBERS, "a": 1, "a couple of": 2, "a few": 3, "several": 4, "half a": 0.5}
_NUMBER = (
    r"(a couple of|a few|several|half a|a|\d+(?:\.\d+)?|" + "|".join(word for word in NUMBERS if word.isalpha()) + ")"
)
_HOLD = re.compile(
    r",?\s*(?:\b(?:and |then )?(?:holds?|holding|keeps?|keeping|stays?|staying|remains?|freezes?|waits?|waiting|rests?|leaves?|pauses?)"
    r"(?: (?:it|them|that|this|there|still|so|like (?:that|this)|the (?:pose|position)|your (?:pose|position)|that (?:pose|position)|up|down|in place|"
    r"(?:your|the) (?:left |right )?(?:hand|arm|head)s?))*\s+)?"
    rf"(?:(?:for|about|exactly|at least|around|nearly|almost|all of|(?:a|the) (?:full|good|whole|solid)|another) )*(?<!\bin )(?<!\bwithin )(?<!\bafter )(?<!\bevery ){_NUMBER}(?: full| whole| more)? (?:seconds?|secs?|s)\b(?: long| straight)?"
)
_COUNT_OF = re.compile(
    r",?\s*(?:\b(?:and |then )?(?:holds?|holding|keeps?|keeping)(?: (?:it|them|that|this|there))*\s+)?"
    rf"for (?:a |the )?count of {_NUMBER}\b|,?\s*\bfor {_NUMBER} (?:counts|beats)\b|"
    rf",?\s*\b(?:till|until|while) i (?:have |will )?count(?:ed)?(?: up)? to {_NUMBER}\b"
)
"""Pattern of a hold with a counted number of seconds."""
_MINUTES = re.compile(
    rf",?\s*\bfor (?:(?:about|exactly|at least|around|nearly|almost) )*{_NUMBER}(?: full| whole| more)? "
    r"(?:(?<=half a )|(?<!\ba ))(?:minutes?|mins?)\b(?: long| straight)?"
)
"""Pattern of a counted number of minutes; "for a minute" only means briefly."""
_ONLY_SECONDS = re.compile(
    rf",?\s*\b(?:(?:for|about|exactly|at least|around|all of|a full) )+{_NUMBER}(?: full| whole| more)? (?:seconds?|secs?|s)\b(?: long| straight)?"
)
_SECOND = re.compile(r"\d ?s|sec")
"""Pattern that occurs in every text with a hold, for a quick test."""
_BEFORE_MARK = re.compile(r"\s+([,.])")
_AT_ENDS = re.compile(r"^(?:and|but)\s+|[\s,.]+(?:and|but)?[\s,.]*$|^[\s,.]+")
_TWICE_AND = re.compile(r"\s+(?:and|but)(?=,? (?:and|but)\b)")
_AFTER_ARTICLE = re.compile(r"\b(an?|the|one|your), +(?=\w)")
_A_VOWEL = re.compile(r"\ba (?=[aeiou])(?!u\w*[aeiou]|(?:u|eu\w+|ones?|once)\b)")
_A_CONSONANT = re.compile(r"\ban (?=[b-df-gj-np-tv-z])(?![flmnrsx]\b)")
_READS, _HIGH = re.compile(r"[a-z]{2,}"), re.compile(r"\b(?:up|high|in the air|overhead)\b")
_WAVE_NEXT, _NEXT_WORD = re.compile(r"\s*waves?\b"), re.compile(r"\s+(\w+)")
_ADJECTIVES = frozenset("fast quick slow gentle rapid brisk swift hasty hurried faster slower quicker".split())
_AFTER_ADJECTIVE = re.compile(
    _GESTURES
    + "|(?:clapp|wav|nodd|bow|shak|shrugg|punch|drumm|danc|point|salut|box|tapp|knock|flapp|sway)ing"
    + "|and|with|to|at|for|then|now|please|on|in|twice|once|thrice|your|three|two|four|five|the|times|"
    + "left|right|up|down|back|forward|from"
)
"""Words before which an adjective of tempo counts as manner."""
_KEEPS = re.compile(r"^(?:hold|keep|leave) (?=(?:your|the|both) )")


@dataclass(frozen=True)
class Manner:
    """Tempo, size, hold and mood of a command.

    Attributes:
        tempo: factor of the speed.
        size: factor of the amplitude.
        hold_s: seconds for which the pose is held; 0 where the clause names none.
        mood: mood of the posture, a key of `MOODS`; its tempo is part of `tempo`.
    """

    tempo: float = 1.0
    size: float = 1.0
    hold_s: float = 0.0
    mood: str = ""

    @property
    def plain(self) -> bool:
        """Whether tempo, size, hold and mood are the defaults."""
        return self == Manner()


def manner_of(clause: str) -> tuple[str, Manner]:
    """A clause in lower case without its words of manner, and the manner.

    >>> manner_of("nod very slowly"), manner_of("give a tiny bow")
    (('nod', Manner(tempo=0.55..., size=1.0, hold_s=0.0, mood='')), ('give a bow', Manner(tempo=1.0, size=0.55..., hold_s=0.0, mood='')))
    """
    rest, tempo, size = _factors(clause)
    rest, hold_s = _hold(rest)
    rest, mood = mood_of(rest)
    tempo = min(FASTEST, max(1 / FASTEST, tempo * MOODS[mood].tempo)) if mood else tempo
    rest = _BEFORE_MARK.sub(r"\1", " ".join(rest.split()))
    rest = _AT_ENDS.sub("", rest)
    rest = _TWICE_AND.sub("", rest)
    rest = _AFTER_ARTICLE.sub(r"\1 ", rest)
    rest = _A_CONSONANT.sub("a ", _A_VOWEL.sub("an ", rest))
    if not _READS.search(rest):
        return clause, Manner()
    return rest, Manner(tempo, size, hold_s, mood)


def _factors(clause: str) -> tuple[str, float, float]:
    """A clause without its words of tempo and size, and their factors: a multiple that it names, or what words are worth."""
    tempo = size = 1.0
    for multiple in reversed(multiples_in(clause)):
        clause = f"{clause[: multiple.start]} {clause[multiple.end :]}"
        tempo, size = tempo * multiple.tempo, size * multiple.size
    rest, in_words = _factor(clause, "tempo", FASTEST)
    rest, large = _factor(rest, "size", LARGEST)
    rest, again = _factor(
        rest, "tempo", FASTEST
    )  # "a slow deep bow": the noun stands beside "slow" now; "gently and slowly"
    tempo = tempo if tempo != 1 else max(in_words, again, key=lambda f: abs(f - 1))
    size = size if size != 1 else large
    return rest, min(FASTEST, max(1 / FASTEST, tempo)), min(LARGEST, max(1 / LARGEST, size))


def _factor(clause: str, table: str, most: float) -> tuple[str, float]:
    factor = 1.0
    rules = _rules(table)
    for number in rules.possible(clause):
        pattern, worth = rules.rules[number]
        while (found := pattern.search(clause)) is not None and _is_manner(clause, found):
            strength = float(worth) ** (STRONGER if _STRONG.search(found[0]) else 1.0)
            if abs(strength - 1) > abs(factor - 1) or factor == 1.0:
                factor = strength
            after = clause[found.end() :]
            if _WAVE_NEXT.match(after) and factor >= 1 and table != "tempo":  # "a big wave" is a gesture of its own
                break
            clause = " ".join(f"{clause[: found.start()]} {after}".split())
    return clause, min(most, max(1 / most, factor))


def _is_manner(clause: str, found: re.Match[str]) -> bool:
    """Whether a matched word is manner here: "slow" before a noun that is no gesture is not, nor is a whole clause."""
    word = found[0].strip()
    if clause.strip(" .,!") == word:
        return False
    if word.split()[-1] in _ADJECTIVES:
        following = _NEXT_WORD.match(clause[found.end() :])
        return not following or bool(_AFTER_ADJECTIVE.fullmatch(following[1]))
    return True


@cache
def _rules(table: str) -> RuleTable:
    """The rules of a table; the replacement text of each rule is its factor."""
    split = [line.partition(" ") for line in lines(table)]
    return RuleTable(
        (rf"\b{_VERY}(?:{pattern.replace('@NOUN', _GESTURES)})(?![\w-])", worth) for worth, _, pattern in split
    )


def _hold(clause: str) -> tuple[str, float]:
    found = _HOLD.search(clause) if _SECOND.search(clause) is not None else None
    found = found or _COUNT_OF.search(clause) or _MINUTES.search(clause)
    if found is None:
        return clause, 0.0
    if not _READS.search(clause[: found.start()] + clause[found.end() :]):
        found = _ONLY_SECONDS.search(clause) or found
    number = next(group for group in found.groups() if group)
    seconds = float(_SECONDS[number]) if number in _SECONDS else float(number)
    seconds *= 60 if found.re is _MINUTES else 1
    rest = clause[: found.start()] + " " + clause[found.end() :]
    rest = _KEEPS.sub("raise ", rest) if _HIGH.search(rest) else rest
    return rest, seconds
