"""Whether a text may be the caption of a recording of a person: its subject is a person, and the gesture corpus does not have it.

"A person dribbles a basketball" may be one; "a person claps their hands" is not, because the corpus has the gesture. Whether the
text is one is decided by its meaning (`mmm_core.inference.people_weights`).
"""

from __future__ import annotations

import re

from mmm_core.language.known_phrases import BESIDE, CAPTION_SUBJECT, is_known_phrase, key_of
from mmm_core.language.limbs import begins_with_a_verb

_SUBJECT_AND_VERB = re.compile(
    rf"\s*(?:{CAPTION_SUBJECT}|(?:an? |the )?(?:(?:standing|young|old) )?(?:person|dancer)\b)"
    r"(?: that| who)?(?: is| \w+ly)* (\w+?)(?:s|ing)\b"
)
"""Pattern of a subject and its verb: "this person slowly shifts from foot to foot", "person is dancing"."""


def may_be_of_people(text: str) -> bool:
    """Whether a text may be a caption of a person.

    >>> may_be_of_people("a person dribbles a basketball"), may_be_of_people("a person claps their hands")
    (True, False)
    """
    said = text.lower()
    acts = _SUBJECT_AND_VERB.match(said)
    if acts is None or is_known_phrase(said) or is_known_phrase(BESIDE.sub("", said)):
        return False
    return key_of(said) is not None or not _is_gesture(acts[1])


def _is_gesture(verb: str) -> bool:
    """Whether a command may begin with a verb that has lost its ending: "punche", "wav", "clapp"."""
    return any(begins_with_a_verb(word) for word in (verb, f"{verb}e", verb[:-1]))
