"""Commands in place of denied ones: any act but the denied one, another greeting than a wave, the opposite of a direction."""

from __future__ import annotations

import re

from mmm_core.language.completed_at_once import base_of
from mmm_core.language.ellipsis import OTHER
from mmm_core.language.limbs import ARMS, HEAD, SOME_ARM, limbs_of

_ANYTHING = (
    "wave your right hand", "clap your hands", "nod your head", "bow politely", "shrug your shoulders", "salute", "stand upright"
)  # fmt: skip
"""Commands for a request of anything except a denied command; the last one also where all others are denied."""
_SAME_MEANING = {
    "wave your right hand": ("bow politely", "nod your head", "salute"),
    "clap your hands": ("give a thumbs up with your right hand", "cheer with both arms", "nod your head"),
    "shake your head": ("wag your right index finger", "wobble your head"),
    "nod your head": ("give a thumbs up with your right hand", "bow politely"),
    "bow politely": ("put your right hand on your heart", "nod your head"),
    "put your right hand on your heart": ("bow politely", "nod your head"),
}
"""Other gestures for what an everyday phrase means, by the gesture that the phrase is answered with."""
_NOT_BY = re.compile(r"(?:(?:using|moving|with|by) )?(?:your |the )?(?:(?P<arms>hands?|arms?)|head)")
"""A part of the body that a denial is about: "greet me without using your hands"."""
_WORD = re.compile(r"[a-z]+")
_OPPOSITE = re.compile(
    r"^\W*(?:(?P<before>\w[^,;.!]*?),? (?:but )?)??(?:(?:please|no),? )*not (?P<what>[^,;.!]+?)"
    r"(?:[,;.!]+ (?:but )?|,? but )(?:(?:do|make|give me|just|exactly|quite) )*"
    r"(?:the )?(?:very )?(?:opposite|reverse|contrary|other way(?: round| around| about)?|(?:other|opposite) direction)\W*$"
)
_WAY = re.compile(rf"\b(?:{'|'.join(OTHER)})\b")
_NODS = re.compile(r"^(?:(?:do )?(?:an? )?nod|yes)\b[^,]*$")


def anything_but(denied: tuple[str, ...]) -> str:
    """A command for a request of anything except the denied acts.

    >>> anything_but(("wave",)), anything_but(("bow",))
    ('clap your hands', 'wave your right hand')
    """
    verbs = _verbs(denied)
    return next((command for command in _ANYTHING if command.partition(" ")[0] not in verbs), _ANYTHING[-1])


def is_for_any_other(command: str) -> bool:
    """Whether a command is one that a request of any other act gets."""
    return command in _ANYTHING


def otherwise(command: str, said: str, denied: tuple[str, ...]) -> str:
    """A command, or another gesture of the same meaning where the speaker denies the one that the meaning is usually shown with.

    Args:
        command: plain command.
        said: requested part of the sentence. A gesture that it names itself is kept.
        denied: denied acts of the sentence.

    >>> otherwise("wave your right hand", "say hello", ("waving",))
    'bow politely'
    >>> otherwise("wave your right hand", "wave your right hand", ("wave your left hand",))
    'wave your right hand'
    """
    verbs, verb = _verbs(denied), command.partition(" ")[0]
    parts = [part for part in map(_NOT_BY.fullmatch, denied) if part]
    if command not in _SAME_MEANING or not (verb in verbs or parts) or verb in _verbs((said,)):
        return command
    limbs = frozenset().union(*(ARMS | SOME_ARM if part["arms"] else HEAD for part in parts))
    allowed = (c for c in (command, *_SAME_MEANING[command]) if c.split()[0] not in verbs)
    return next((c for c in allowed if not limbs_of(c) & limbs), command)


def opposite(said: str) -> tuple[str, str]:
    """The command that "not ..., the opposite" requests, and what it denies; two empty texts for any other sentence.

    >>> opposite("not thumbs up, the opposite"), opposite("lean, but not forward, the other way")
    (('thumbs down', 'thumbs up'), ('lean back', 'forward'))
    """
    found = _OPPOSITE.match(said) if "not " in said else None
    if found is None:
        return "", ""
    turned, n = _WAY.subn(lambda way: OTHER[way[0]], found["what"])
    if not n:
        return ("shake your head", found["what"]) if _NODS.match(found["what"]) else ("", "")
    return f"{found['before'] or ''} {turned}".strip(), found["what"]


def _verbs(said: tuple[str, ...]) -> set[str]:
    """The words of texts, each as it is and as the verb of a gerund: "waving" -> "wave"."""
    words = _WORD.findall(" ".join(said))
    return {*words, *(base_of(word) for word in words if word.endswith("ing"))}
