"""Texts that mean stopping: they brake the robot at once and never reach the motion model, which would show a stop sign.

The rule errs on the side of braking. A text means stopping when it consists of words that stop, of courtesy, and of what is
to stop ("please stop waving your hand now"). A text that asks for anything else ("make a stop sign", "stop the traffic",
"stop waving and clap") is a command like any other. docs/wire/stop_words.md lists both kinds; a test reads that page.
"""

from __future__ import annotations

import re
import unicodedata

_COURTESY = frozenset(
    """
    a ah again all alright and already at away can could dear ever everybody everyone everything for goodness heavens
    hello here hey i immediately instantly it just kindly listen minute moment must need no now of oh ok okay once
    please pls plz quick quickly right robot said sake sec second should sir so thank thanks that the then there this to told
    uh um want will with would you your yourself s is are re am m ll d
    """.split()
)
"""Words that leave the meaning of a stop unchanged and have no meaning alone."""

_STOP_WORDS = frozenset(
    """
    stop halt freeze cancel abort cease desist pause quit whoa woah enough wait estop emergency stopp stpo sotp stp tsop
    hlat anhalten arrete alto basta fermati stoj stoi
    """.split()
)
"""Words that stop: the usual ones, their commonest misspellings, and calls in other languages."""

_STOP_PHRASES = tuple(
    " ".join(phrase.split())
    for phrase in """
    emergency stop, e stop, full stop, hold it, hold still, stand still, stay still, keep still, be still, sit still,
    stay put, stay where you are, where you are, what you are doing, what you re doing, whatever you are doing, whatever
    you re doing, what you do, do not move a muscle, dont move a muscle, do not move, dont move, never move, no more
    moving, no moving, no more movement, not another move, not a move, no further, knock it off, cut it out, give it a
    rest, do not do anything, dont do anything, do nothing, do not do that, dont do that, do not do it, dont do it, no more
    of that, never mind, nevermind, forget it, forget that, forget about it, scrap that
    """.split(",")
)
"""Phrases that stop, or that only name the motion that is to stop."""
_POWER_PHRASES = tuple(
    " ".join(phrase.split())
    for phrase in """
    torque off, power off, power down, motors off, motor off, servos off, servo off, switch off, turn off, shut off, shut down,
    shutdown, turn yourself off, switch yourself off, shut yourself off, shut yourself down, power yourself down, power yourself
    off, turn everything off, switch everything off, shut everything down, cut the power, cut power, cut the torque, cut torque,
    cut the motors, kill the power, kill the motors, kill the servos, deactivate, disarm
    """.split(",")
)
"""Phrases that ask for no power: no text cuts torque, since arms would drop; such a text stops the robot."""

_PHRASE = re.compile(rf"\b({'|'.join(sorted((*_STOP_PHRASES, *_POWER_PHRASES), key=len, reverse=True))})\b")
_POWER_PHRASE = re.compile(rf"\b({'|'.join(_POWER_PHRASES)})\b")

_MOTIONS = frozenset(
    """
    action actions arm arms body both command commands current dance demo gesture gestures hand hands head left machine
    motion motions motor motors move movement movements moves moving playback program servo servos show
    """.split()
)
"""Words for a motion or a part of the body, as objects of a stop word."""

_ACTIVITY = re.compile(
    r"\b(stop|stopp|cease|quit|halt|pause|cancel|enough|no more|dont keep|not keep) "
    r"(?:(?:it|with|of|the|that|all|your|now|please) )*([a-z]+ing)\b((?: (?!(?:stop|please|now|halt)\b)\w+)*)"
)
"""A word that stops, an activity, and its object: "stop waving your hand"."""
_NO_ACTIVITIES = frozenset(
    ("anything", "everything", "king", "nothing", "ring", "something", "string", "thing", "wing", "sling")
)
_NEEDED = {*_STOP_WORDS, *(max(phrase.split(), key=len) for phrase in (*_STOP_PHRASES, *_POWER_PHRASES)), "more"}
"""Words of which every text that stops has one: those that stop, the longest one of each phrase, and that of "no more waving"."""
_MAY_STOP = re.compile(
    "|".join(
        [r"[^\x00-\x7f]|\\u|don\W?t", *("".join(f"{letter}+" for letter in word) for word in sorted(_NEEDED))]
    ).encode(),
    re.IGNORECASE,
)
_STAYS = frozenset(("stay", "see", "rest", "there", "here"))
"""Words after a stop that are no command: "stop and stay"."""
_STOP_FIRST = re.compile(
    r"\W*(?P<stop>[\w' ]+?)(?:,? (?:and|then)(?: then| now)*|[,.;!]+ (?:now|then|and)) (?P<rest>\w.*)",
    re.IGNORECASE | re.DOTALL,
)
_NEXT = r"then|(?:right |straight )?after (?:that|this),?|afterwards,?|finally,?"
_STOP_LAST = re.compile(
    rf"(?<=\w)(?:[,;.]? (?:and )?(?:{_NEXT}) stop|(?:[,;.]| and|[,;.] and) stop(?= (?:there|then|after)))"
    r"(?: there| then| after (?:that|this|it))?[.!]*$",
    re.IGNORECASE,
)
_MOST_WORDS, _MOST_WORDS_OF_ACTIVITY = 14, 5
_GOES_ON = re.compile(r"\b(and|then|but|instead|start|begin|rather|let|while|before|after|until)\b")


def means_stop(text: str) -> bool:
    """Whether a text requests only a stop.

    >>> means_stop("Stop!!!"), means_stop("could you stop waving, please"), means_stop("make a stop sign")
    (True, True, False)
    """
    words = _words(text)
    if not 0 < len(words) <= _MOST_WORDS:
        return False
    said = _PHRASE.sub("stop", " ".join(words))
    rest = _ACTIVITY.sub(_stop_of, said).split()
    return any(word in _STOP_WORDS for word in rest) and all(
        word in _STOP_WORDS or word in _COURTESY or word in _MOTIONS for word in rest
    )


def asks_for_no_power(text: str) -> bool:
    """Whether a text that means to stop asks for the servos to lose their torque, which no text brings about.

    >>> asks_for_no_power("please turn off the motors"), asks_for_no_power("stop")
    (True, False)
    """
    return _POWER_PHRASE.search(" ".join(_words(text))) is not None


def may_stop(request: bytes) -> bool:
    """Whether a text in these bytes may mean stopping: false for most others, and much sooner than `means_stop`.

    >>> may_stop(b"STOOOP!"), may_stop(b"don't do that"), may_stop(b"wave your hand")
    (True, True, False)
    """
    return _MAY_STOP.search(request) is not None


def after_a_stop(text: str) -> str:
    """The command after a stop; a text without both stays as it is. A new command ends the one that is played anyway.

    >>> after_a_stop("stop and look left"), after_a_stop("stop waving and bow")
    ('look left', 'stop waving and bow')
    """
    found = _STOP_FIRST.fullmatch(text)
    if found is None or _ACTIVITY.search(found["stop"].lower()) or not means_stop(found["stop"]):
        return text
    stays = found["rest"].strip(" .!?").lower() in _STAYS or means_stop(found["rest"])
    return text if stays else found["rest"]


def before_a_stop(text: str) -> str:
    """The commands before a stop at the end of a text; a text without both stays as it is. Every motion stops at its end anyway.

    >>> before_a_stop("nod twice, after that stop"), before_a_stop("wave until i say stop")
    ('nod twice', 'wave until i say stop')
    """
    return _STOP_LAST.sub("", text)


def _stop_of(found: re.Match[str]) -> str:
    """The word "stop" for a stop with its activity; the matched text where another request follows."""
    activity, rest = found[2], found[3]
    if activity in _NO_ACTIVITIES or len(rest.split()) > _MOST_WORDS_OF_ACTIVITY or _GOES_ON.search(rest):
        return found[0]
    return "stop"


def _words(text: str) -> list[str]:
    """Lower-case words without accents and punctuation; letters that are drawn out ("stooop") are kept once."""
    plain = unicodedata.normalize("NFKD", text.replace("’", "'")).casefold()  # noqa: RUF001
    plain = "".join(c for c in plain if not unicodedata.combining(c))
    plain = re.sub(r"([a-z])\1{2,}", r"\1", plain).replace("don't", "dont").replace("don t", "dont")
    return re.sub(r"[^\w]+|_", " ", plain).split()
