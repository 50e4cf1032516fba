"""The ways to read one sentence, and which of them is meant.

Rules read a sentence in one way, a tagger divides it in several, some more likely than others. A candidate is one of these readings
with what speaks for it. The weights of the evidence are in `words/choice.txt`; `mmmd train choice` finds them.
"""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mmm_core.language.commands import PlainCommand, Reading
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.phrase_gestures import gesture_of_phrase, is_for_both_arms
from mmm_core.language.plain_gestures import OUTSIDE, SURE, Meant, family_of, is_gesture, plainly_said
from mmm_core.language.said_at_once import asks_again
from mmm_core.language.sure_reading import unknown_commands
from mmm_core.language.word_tables import lines, pairs

EVIDENCE = (
    "by rules",  # the rules read the sentence so
    "by rules, surely",  # and are sure of it
    "likeliest tags",  # the tagger's likeliest division
    "sum",  # sum, mean and least of the logarithms of the probabilities that its commands are gestures
    "mean",
    "least",
    "least in sentence",  # the same least one, of the words within their sentence
    "unsure",  # number of commands that are probably no gesture
    "unlikely",  # sum over its gestures of the probability of the divisions that lack them
    "left out",  # sum over the gestures that it lacks of the probability of the divisions that have them
    "verbs left",  # number of verbs of gestures that the sentence has and no command
    "repeated",  # number of gestures that it has more than once, though the sentence has no word for that
    "said once",  # number of commands that it has more than once, though the sentence has their longest word once
    "against one",  # probability that the sentence is one gesture, if the reading has several
    "at once",  # whether it has several commands in one step only
    "at once, said",  # and the sentence has words for that
    "one limb twice",  # and these have fewer limbs than commands
    "in turn, said",  # whether it has several steps, and the sentence has words for that
    "nothing",  # whether it has no command
    "parsed",  # logarithm of the parser's probability of its gestures, and that probability
    "parsed, surely",
    "by parser",  # whether only the parser reads the sentence so
    "phrases",  # share of its commands that are phrases of one gesture, in the sentence's own words
)
"""The kinds of evidence for or against a candidate, in the order of the columns of `evidence`."""
_AT_ONCE = re.compile(
    r"\b(?:at once|at the (?:very )?same (?:time|moment|instant)|same time|simultaneous\w*|together|concurrent\w*|meanwhile|while|"
    r"whilst|as you|in (?:the )?one (?:go|move|shot)|all in one|both|in a single \w+|during)\b"
)
_IN_TURN = re.compile(
    r"\b(?:then|after\w*|next|followed|before|afore|prior|preced\w*|first|second|third|last|finally|finish\w*|end|now|later|"
    r"once (?:you|the|they|it|he|she|that)|subsequently|upon|when|as soon as|the (?:moment|minute|second|instant)|until|done|"
    r"having|sooner)\b"
)
_WORD = re.compile(r"[a-z']+")
_STEM = 4
"""Letters with which a word and its forms begin."""
_LEAST = 0.01
"""Probability of a command that is no gesture, so that its logarithm is bounded."""
_OF_A_PHRASE = math.log(0.97)
"""Logarithm of the least probability of a phrase of the corpus, and of a task that is no gesture: it is refused, not left out."""
_NO_TAGS = -9.0
_LOG_LIKELY = math.log(0.4)
"""Logarithm of the least probability of a reading's gestures by the parser for them to be its own answer in all likelihood."""
_LEAST_PARSED = -15.0
"""Logarithm of the probability of gestures that are as good as impossible."""


@dataclass(frozen=True)
class Candidate:
    """One way to read a sentence.

    Attributes:
        reading: the reading.
        by_rules: whether the rules read it so.
        sure_rules: whether these are sure of the division.
        in_sentence: logarithm of the least probability of a gesture among the marked commands, in their sentence.
        log_share: logarithm of the probability of its division, relative to the likeliest one, for which it is 0.
        by_parser: whether only the parser reads it so.
        log_parsed: logarithm of the parser's probability of its gestures.
        phrases: share of its commands that are phrases of one gesture, in the sentence's own words (`share_of_phrases`).
    """

    reading: Reading
    by_rules: bool = False
    sure_rules: bool = False
    in_sentence: float = 0.0
    log_share: float = _NO_TAGS
    by_parser: bool = False
    log_parsed: float = -math.inf
    phrases: float = 0.0


class Ways(NamedTuple):
    """The ways to read a sentence.

    Attributes:
        candidates: no two have the same commands in the same steps.
        meant: the gesture that each of their commands (`commands_of`) means by itself.
        whole: what the whole sentence means.
        outside: probability that the sentence asks for no gesture, by the parser.
    """

    candidates: Sequence[Candidate]
    meant: Mapping[str, Meant]
    whole: Meant
    outside: float = 0.0


def in_sentence(meant: Sequence[Meant]) -> float:
    """`Candidate.in_sentence` of marked commands that mean the given gestures."""
    return min((_log(one) for one in meant), default=0.0)


def share_of_phrases(reading: Reading) -> float:
    """The share of the commands of a reading that are phrases of one gesture of the corpus and stand in its text."""
    said = reading.text.lower()
    commands = [command.text.lower() for step in reading.steps for command in step]
    return sum(c in said and gesture_of_phrase(c) != "" for c in commands) / max(len(commands), 1)


def merged(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Candidates of which no two have the same commands in the same steps; one has what speaks for any of these.

    The first of them gives the manner of the commands, and the likeliest one what they mean in their sentence.
    """
    found: dict[tuple[tuple[str, ...], ...], Candidate] = {}
    for one in candidates:
        key = tuple(tuple(sorted(command.text for command in step)) for step in one.reading.steps)
        if (same := found.get(key)) is None:
            found[key] = one
            continue
        likelier = max(same, one, key=lambda candidate: candidate.log_share)
        found[key] = Candidate(
            replace(same.reading, denied=same.reading.denied or one.reading.denied),
            same.by_rules or one.by_rules,
            same.sure_rules or one.sure_rules,
            likelier.in_sentence,
            likelier.log_share,
            same.by_parser and one.by_parser,
            max(same.log_parsed, one.log_parsed),
            max(same.phrases, one.phrases),
        )
    return list(found.values())


def commands_of(candidates: Iterable[Candidate]) -> list[str]:
    """The words of all commands of candidates, each once."""
    return list(dict.fromkeys(c.text for one in candidates for step in one.reading.steps for c in step))


def evidence(ways: Ways) -> NDArray[np.float64]:
    """The evidence for each of N candidates, an array (N, len(EVIDENCE))."""
    in_divisions = _in_divisions(ways)
    return np.array([_evidence(one, ways, in_divisions) for one in ways.candidates])


def chosen(ways: Ways) -> Reading:
    """The reading of the candidate for which most speaks.

    If it has one command without tempo, size and hold, this takes the manner of another candidate of one command. Where the parser
    finds its gestures likely, too, its commands are said in plain words: "clap your left hand over your gob" covers the mouth.
    So are phrases of the corpus, since the model performs some of them badly with certain hands and numbers.
    """
    first, *rest = (ways.candidates[i] for i in np.argsort(-(evidence(ways) @ _weights()), kind="stable"))
    best, others = _in_plain_words(first, ways.meant), (one.reading for one in rest)
    if not _is_one_command(best) or not best.steps[0][0].manner.plain:
        return best
    manners = (one.steps[0][0].manner for one in others if _is_one_command(one))
    manner = next((manner for manner in manners if not manner.plain), best.steps[0][0].manner)
    return replace(best, steps=((replace(best.steps[0][0], manner=manner),),))


def _in_plain_words(one: Candidate, meant: Mapping[str, Meant]) -> Reading:
    if one.log_parsed < _LOG_LIKELY:
        return one.reading

    def plain(c: PlainCommand) -> PlainCommand:
        return plainly_said(c, meant[c.text], least=0.0, both_arms=is_for_both_arms(c.text))

    return replace(one.reading, steps=tuple(tuple(map(plain, step)) for step in one.reading.steps))


def _is_one_command(reading: Reading) -> bool:
    return [len(step) for step in reading.steps] == [1]


def _evidence(one: Candidate, ways: Ways, in_divisions: Mapping[str, float]) -> list[float]:
    meant, whole = ways.meant, ways.whole
    said = one.reading.text.lower()
    commands = [command.text for step in one.reading.steps for command in step]
    unknown = set(unknown_commands(one.reading))
    logs = [
        _log(meant[c]) if c in unknown and not is_task(c, meant[c]) else max(_log(meant[c]), _OF_A_PHRASE)
        for c in commands
    ]
    names = [meant[command].name for command in commands]
    families = {family_of(name) for name in names if is_gesture(name)}
    several = len(commands) > 1
    one_step = several and len(one.reading.steps) == 1
    return [
        one.by_rules,
        one.sure_rules,
        one.log_share == 0,
        sum(logs),
        sum(logs) / max(len(logs), 1),
        min(logs, default=0.0),
        one.in_sentence,
        sum(log < math.log(SURE) for log in logs),
        sum(1 - in_divisions.get(family, 0.0) for family in families),
        sum(share for family, share in in_divisions.items() if family not in families),
        len(
            {word for word in _WORD.findall(said) if is_gesture_verb(word)}
            - set(_WORD.findall(" ".join(commands).lower()))
        ),
        0 if asks_again(said) else len(names) - len(set(names)),
        _said_once(commands, said),
        whole.probability if several and is_gesture(whole.name) else 0.0,
        one_step,
        one_step and _AT_ONCE.search(said) is not None,
        one_step and len(frozenset[str]().union(*(c.limbs for c in one.reading.steps[0]))) < len(commands),
        len(one.reading.steps) > 1 and _IN_TURN.search(said) is not None,
        not commands,
        max(one.log_parsed, _LEAST_PARSED),
        math.exp(one.log_parsed),
        one.by_parser,
        one.phrases,
    ]


def _said_once(commands: Sequence[str], said: str) -> int:
    """How many times commands are repeated of whose longest word the sentence has the beginning only once."""
    repeated = Counter(command.lower() for command in commands)
    stems = {command: max(_WORD.findall(command) or [command], key=len)[:_STEM] for command in repeated}
    return sum(max(0, n - max(1, said.count(stems[command]))) for command, n in repeated.items())


def _in_divisions(ways: Ways) -> dict[str, float]:
    """For each family of gestures, the share of the tagger's divisions, by their probability, in which it surely is."""
    meant = ways.meant
    share: defaultdict[str, float] = defaultdict(float)
    total = 0.0
    for one in ways.candidates:
        probability = math.exp(one.log_share)
        total += probability
        unknown = set(unknown_commands(one.reading))
        said = [command.text for step in one.reading.steps for command in step]
        for family in {
            family_of(meant[c].name)
            for c in said
            if is_gesture(meant[c].name) and (c not in unknown or meant[c].probability >= SURE)
        }:
            share[family] += probability
    return {family: some / total for family, some in share.items()}


def is_task(command: str, meant: Meant) -> bool:
    """Whether words ask for something that is surely no gesture and has to be refused: "run away"."""
    is_no_gesture = meant.name == OUTSIDE and meant.probability >= SURE
    return is_no_gesture and command.lower().partition(" ")[0] in lines("task_verbs")


def _log(meant: Meant) -> float:
    """Logarithm of the probability of a gesture."""
    return math.log(max(meant.probability if is_gesture(meant.name) else 0.0, _LEAST))


@cache
def _weights() -> NDArray[np.float64]:
    weights = dict(pairs("choice"))
    # A new kind of evidence has no weight before `mmmd train choice`.
    return np.array([float(weights.get(name, 0)) for name in EVIDENCE])
