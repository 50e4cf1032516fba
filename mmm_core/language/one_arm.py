"""The arm of commands that name it once: "raise your left hand, salute, and lower it again", "wipe your brow, left hand".

A command without a side takes the side of the commands around it if they name only one side. The command must stand between two
commands of that arm, or name a part of an arm ("bend the elbow", "make a fist") after a command of that arm.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from mmm_core.language.limbs import SOME_ARM, limbs_of

_NAMED = re.compile(r"\b(left|right) (?:hand|arm|fist|palm|elbow|wrist|forearm|fingers?|fingertips|thumb)\b")
_ANY_SIDE = re.compile(r"\b(?:left|right|both|other|one (?:hand|arm)|hands|arms)\b")
_PART = re.compile(r"\b(?:the|your) (?=(?:elbow|wrist|palm|fist|forearm|fingers?|thumb|hand|arm)\b)")
_NAMED_AFTER = re.compile(
    r"^(?P<act>[^,.;:!]+)[,.;:!]+ (?:and )?(?!that is right\b)(?:only |just )?(?:(?:use|using|with|on|it is|that is) )?"
    r"(?:only |just )?(?:the |your )?(?P<side>left|right)(?: (?:hand|arm|fist|one))?"
    r"(?: only| please| this time)?(?P<rest>(?:[,.;:!].*)?)$"
)
_MAKES_A_FIST = re.compile(r"(?:make|form|clench|ball|close|open)\b.*\bfist\b(?: tight(?:ly)?)?$")


def of_one_arm(commands: Sequence[str]) -> list[str]:
    """Successive commands in lower case, each with the arm that the commands around it name.

    >>> of_one_arm(["raise your left hand", "salute", "lower your left hand"])[1]
    'salute with your left hand'
    >>> of_one_arm(["stretch out your right arm", "bend the elbow"])[1], of_one_arm(["raise your right arm", "clap"])[1]
    ('bend your right elbow', 'clap')
    """
    naming = [i for i, command in enumerate(commands) if _NAMED.search(command)]
    sides = {side for command in commands for side in re.findall(r"\b(?:left|right)\b", command)}
    if len(commands) < 2 or not naming or len(sides) != 1:
        return list(commands)
    side = sides.pop()
    found: list[str] = []
    for i, command in enumerate(commands):
        is_between = naming[0] < i < naming[-1]
        is_part = i > naming[0] and bool(_PART.search(command) or _MAKES_A_FIST.match(command))
        free = limbs_of(command) == SOME_ARM and not _ANY_SIDE.search(command)
        found.append(_with(command, side) if free and (is_between or is_part) else command)
    return found


def with_hand_named_after(text: str) -> str:
    """A text in lower case with a hand that stands after the only command, as words of that command.

    >>> with_hand_named_after("wipe your brow, left hand"), with_hand_named_after("wave, left hand up")
    ('wipe your brow with your left hand', 'wave, left hand up')
    """
    found = _NAMED_AFTER.match(text)
    if found is None or _ANY_SIDE.search(found["act"] + found["rest"]) or limbs_of(found["act"]) != SOME_ARM:
        return text
    return f"{found['act']} with your {found['side']} hand{found['rest']}"


def _with(command: str, side: str) -> str:
    named, n = _PART.subn(f"your {side} ", command, count=1)
    return named if n else f"{command} with your {side} hand"
