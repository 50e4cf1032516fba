"""Divides a command that holds several gestures, by the gestures that its parts mean: "bow with your palms pressed in prayer".

Neither rules nor tags have divided it, yet the classifier takes it for several gestures. It is divided at a word that joins, where
both parts are most likely gestures.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

from mmm_core.language.commands import MOST_AT_ONCE, MOST_STEPS, PlainCommand, Reading, Steps
from mmm_core.language.plain_gestures import SEVERAL, Meant, is_gesture
from mmm_core.language.reading import command_of
from mmm_core.language.word_tables import any_of

SURE_OF_PART = 0.75
"""Least probability of the gesture that either part means."""
_JOINS = re.compile(
    r",? (?:(?P<turn>(?:and )?then|followed by|before|and after that)|"
    r"(?P<once>(?:and )?(?:while|whilst|meanwhile|as|with|plus|during|in sync with|together with|alongside|along with)"
    r"(?: also| you| your)?)|"
    r"(?P<and>and|but))(?: also)? |(?P<comma>[,;.:]+) "
)
_FRONTED = re.compile(r"(?:with|while|whilst|as) (?:you )?")
_AT_ONCE = re.compile(rf"\b(?:{any_of('at_once', 'said for all')}|together|combo)\b")
_NEXT = re.compile(r"^(?:and |then |next(?: up)?|after that|now)[,:]? ")
_FILLER = re.compile(
    r",? (?:(?:all |both )?(?:at|in) (?:the (?:very )?same|one|a single) (?:time|moment|instant|move|go|shot|motion)|"
    r"(?:all )?at once|together(?: like)?|in parallel|meanwhile|one combo move|thrown in)\b"
)

Classes = Callable[[Sequence[str]], Mapping[str, Meant]]


def with_parted_commands(reading: Reading, meant: Mapping[str, Meant], classes: Classes) -> Reading:
    """A reading whose commands that mean several gestures are divided where both parts are gestures.

    Args:
        reading: the reading.
        meant: what its commands mean that are no phrases of the corpus.
        classes: what other words mean.
    """
    steps: list[tuple[PlainCommand, ...]] = []
    for step in reading.steps:
        parts = [_parted(command, meant, classes) for command in step]
        if len(step) == 1:
            steps += parts[0]
        else:
            steps.append(tuple(c for one in parts for inner in one for c in inner))
    fits = len(steps) <= MOST_STEPS and all(len(step) <= MOST_AT_ONCE for step in steps)
    return replace(reading, steps=tuple(steps), plain=False) if fits and tuple(steps) != reading.steps else reading


def _parted(command: PlainCommand, meant: Mapping[str, Meant], classes: Classes) -> Steps:
    whole: Steps = ((command,),)
    if command.text not in meant or meant[command.text].name != SEVERAL:
        return whole
    said = _FILLER.sub("", command.text.lower().strip(" .!"))
    divisions = list(_divisions(said, _AT_ONCE.search(command.text.lower()) is not None))
    if not divisions:
        return whole
    found = classes(list(dict.fromkeys(words for first, second, _ in divisions for words in (first, second))))

    def likely(division: tuple[str, str, bool]) -> float:
        one, other = found[division[0]], found[division[1]]
        both = is_gesture(one.name) and is_gesture(other.name) and one.name != other.name
        return min(one.probability, other.probability) if both else 0.0

    best = max(divisions, key=likely)
    if likely(best) < SURE_OF_PART:
        return whole
    first, second = (replace(command_of(words), manner=command.manner) for words in best[:2])
    return ((first, second),) if best[2] else ((first,), (second,))


def _divisions(said: str, at_once: bool) -> Iterator[tuple[str, str, bool]]:
    """Both parts of a command at each word that joins, and whether they are done at once."""
    if fronted := _FRONTED.match(said):
        words = said[fronted.end() :].split()
        for i in range(2, len(words) - 1):
            yield " ".join(words[:i]), " ".join(words[i:]), True
    for join in _JOINS.finditer(said):
        first, second = said[: join.start()].strip(" ,"), _NEXT.sub("", said[join.end() :].strip(" ,"))
        if first and second and (not join["comma"] or (" " in first and " " in second)):
            if join["once"] and " your" in join[0]:
                second = f"your {second}"
            yield first, second, at_once or bool(join["once"])
