"""Words around a request, everyday phrases, and synonyms that the model knows: three tables and their use."""

from __future__ import annotations

import re
from functools import cache, lru_cache
from itertools import cycle

from mmm_core.language.clause_patterns import SPEAKS_OF_AN_ACT
from mmm_core.language.completed_at_once import base_of
from mmm_core.language.count_words import TIMES
from mmm_core.language.limbs import is_gesture_verb
from mmm_core.language.word_tables import LIMB, REMEMBERED, WAY, RuleTable, lines, pairs, replaced, substitutions

_ACT = (
    r"(?:also |just |please |can you |could you )*(?:wave|nod|bow|clap|shrug|salute|point|punch|shake|cross|fold|raise|lift|look|lean|beckon|hug|stretch|twist|tilt|cheer|pray|scratch|rub|pat|"
    r"knock|push|pull|throw|catch|flap|march|dance|drum|circle|spread|open|touch|cover|blow|wipe|stir|applaud|conduct|greet|swing|bend|turn|reach|make|give|take|do|"
    r"play|act|show|strike|flex|lower|put|hold|shade|celebrate|throw|welcome|thank|say|tell|hush|call|flex|pretend|move|bring|let us see you|sway|duck|facepalm|signal|hammer|paint|brush|drum|box|drink|eat|pour|kiss|listen|yawn|climb|swim|steer|type|juggle|flip|rotate|rock|slump|relax|drop|place|"
    r"extend|straighten|uncross|roll|bob|wag|tip|incline|motion|gesture|indicate|demonstrate|perform|imitate|mime|box|jab|row|saw|sow|stand)\b"
)
_MANNER = (
    "(?:slow|quick|fast|gentle|rapid|brisk|swift|hasty|small|little|tiny|slight|big|large|huge|wide|deep|short|brief|single|left|right|"
    "good|nice|proper|long|strong|\\w+est)"
)
"""Adjectives that stay what they are before a verb: "a slow shake of the head", but not "an incredulous" one."""
_STORY = (
    (
        r"(?!(?:please |now |and |then |ok(?:ay)?,? |robot,? |first,? |@ACT)*(?:@ACT|hands?\b|arms?\b|head\b|(?:your|both|left|right|the (?:left|right))\b|"
        r"(?:after|before|once|when|while|as|if|instead of|without|rather than|having)(?: you\b| \w+ing\b)|do not|never|not\b|no\b|stop|skip|forget|only (?!because|since)|neither))"
    )
    .replace("|@ACT)*", ")*")
    .replace("@ACT", _ACT)
)
"""Beginnings that a story before a request does not have: a command, an order of commands, a denial."""
_ASKS = (
    r"(?:(?:can|could|would|will|might) you|(?:might|may|could|can|must|should|would) (?:i|we) (?:please |just |kindly |also )*(?:trouble|ask|beg|request|invite|persuade|bother|get|have) you(?: please| kindly)? (?:to|that you)|"
    r"(?:i|we) (?:(?:would|do|really|just|only|simply|also|am|was|were) )*wonder(?:ing)?(?: if| whether) you (?:would|could|might|can|will)|"
    r"(?:i|we|they|he|she|everybody|everyone|the \w+|my \w+)(?: would| do| really| just| now| simply| only| all)* (?:like|love|want|need|wish|expect|ask|beg|prefer|ought|likes|loves|wants|needs)(?: to (?:see|have|watch))? you(?: to)?|"
    r"if you (?:could|would|might|were to)|(?:i|we) (?:am|was|are|were|have been) (?:just |only |really )*(?:hoping|thinking|wishing|counting on it)(?: that| if| whether)? you (?:could|might|would|can|will)|it would be (?:\w+ ){1,3}(?:if you (?:could|would)|to see you|to have you)|(?:perhaps|maybe) you (?:could|would|might|can|should)|(?:i|we|he|she|they|everyone|(?:the|my|our) \w+(?: \w+)?) (?:thinks?|believes?|guess|suggests?|proposes?|recommends?|insists?|says?|said|told (?:me|us))(?: that)? you (?:should|could|might|ought to|had better|must)?|"
    r"(?:so|therefore|and|now) (?:please|kindly|just|do)|(?:so|and) be (?:so )?(?:kind|good|nice|an? \w+)(?: enough)?(?: as)? (?:to|and)|do (?:just|please|kindly)|please|go ahead and|why do not you|how about you|"
    r"let (?:me|us) see you|the time has come (?:for you )?to|it is (?:now )?time (?:for you )?to|your (?:job|task|turn|part) (?:now )?is (?:simply |just )?to|what about|how about)[, ]+"
)
"""Words that begin a request in the middle of a sentence."""
_ALL = r"(?:,? (?:to )?(?:you|all|everyone|everybody|every one|guys|folks|people|kids|children|friends?|my friends?|ladies and gentlemen|team|class|lads|girls|boys|world|robot|there|again|now|then|for now|of you|too|sir|mister|grandma|grandpa|mum|dad|mom|me|us|please|very much|so much|today|tonight|right now))*"
"""Forms of address after an everyday phrase, for its table."""
_HERE = r"(?: (?:in here|out here|here|outside|inside|out there|in there|over there|today|tonight|this (?:morning|evening|afternoon)|now|in this (?:room|place|house|hall)))*"
_SO = r"(?:so |too |very |really |pretty |a bit |a little |quite |rather |awfully |terribly |getting |bloody |ever so |all |still )*"
MOST_WORDS_OF_TALK = 8
"""Largest number of words in a sentence whose beginning alone decides the gesture."""
_TALK = re.compile(
    r"(?![\w'-]| (?:is|are|was|were|what|how|why|when|where|can|could|would|will|do|does|did)\b)[^,.;:!?]*"
)
_GOES_ON = re.compile(
    r"(?:i|you|we|he|she|it|they|that|this|there|the|my|your|our|his|her|an?|what an?|so|very|not|everybody|everyone)\b|\w+$"
)
"""Beginnings of talk without a request: "quiet please, we are filming"."""
_NAMES_AN_ACT = re.compile(
    rf"\b(?:left|right|up|down|forwards?|backwards?|both|{LIMB}|head|eyes|shoulders?|body|then|but|not|never|while|before|after|\w+ly|twice|times)\b"
)
"""Words after which a request of its own follows."""
_END, _MARKS = re.compile(r"[\s,.!?;:]+$"), re.compile(r"\s*[,.!?;:]+\s*")
_WORD = re.compile(r"[a-z]{2,}")
_COURTESY = re.compile(
    r"(?:(?:many )?thanks|thank you|cheers|ta|please|much obliged)(?: (?:you|very|so|ever|much|kindly|indeed|a|lot|all|then|love|dear|sir))*"
)
"""Words after a request that are no request themselves: "a nod will do, thank you"."""
_JOINED_GERUND = re.compile(
    r"(\b(?:and|then|or) )((?:clapp|nodd|wav|bow|shrugg|salut|point|look|lean|shak|rais|lower|turn|touch)ing)\b"
)
_GERUND_FIRST = re.compile(
    r"^(?:you )?(\w+ing)\b(?= (?:your|the|to|at|with|me|us|him|her|them|down|up|and|goodbye|a|an|first|once|twice|then|before|left|right|forward|back|\w+ times)\b|$)"
)


@cache
def _frames() -> tuple[RuleTable, RuleTable]:
    """Patterns at the front and at the end of a request."""
    patterns = [
        line.replace("@STORY", _STORY).replace("@ASKS", _ASKS).replace("@ACT", _ACT) for line in lines("frames")
    ]
    front = RuleTable((p, "") for p in patterns if p.startswith("^"))
    return front, RuleTable((p, "") for p in patterns if not p.startswith("^"))


@lru_cache(maxsize=REMEMBERED)
def without_request(said: str) -> str:
    """A sentence in lower case without the words around its request; the sentence itself where no word would remain.

    >>> without_request("could you please wave for me"), without_request("i would love it if you could bow")
    ('wave', 'bow')
    """
    rest, unchanged = said.strip(), 0
    tables = cycle(_frames())
    while unchanged < len(_frames()):  # until no rule of either table matches
        shorter = _without(rest, next(tables))
        unchanged, rest = (unchanged + 1 if shorter == rest else 0), shorter
    return _gerund_request(rest)


def _without(rest: str, table: RuleTable) -> str:
    """A request after removal of the first match of each rule in turn."""
    numbers = iter(table.possible(rest))
    while (number := next(numbers, None)) is not None:
        found = table.rules[number].pattern.search(rest)
        if found is not None:
            rest = _kept(rest, rest[: found.start()] + rest[found.end() :])
            numbers = iter(table.possible(rest, number))
    return rest


def _kept(before: str, after: str) -> str:
    after = after.strip(" ,")
    return after if _WORD.search(after) and not _COURTESY.fullmatch(_END.sub("", after)) else before


def _gerund_request(rest: str) -> str:
    """A request whose verb is a gerund as a command: "shaking your head" -> "shake your head"."""
    found = _GERUND_FIRST.match(rest)
    _, comma, after = rest.partition(", ")
    if found is None or not _is_verb(base_of(found[1])) or (comma and SPEAKS_OF_AN_ACT.match(after)):
        return rest  # "looking left, wave" is at once
    return base_of(found[1]) + _JOINED_GERUND.sub(lambda m: f"{m[1]}{base_of(m[2])}", rest[found.end() :])


def _is_verb(word: str) -> bool:
    return bool(SPEAKS_OF_AN_ACT.match(word)) or is_gesture_verb(word)


@lru_cache(maxsize=REMEMBERED)
def everyday(said: str) -> str:
    """The plain command that an everyday phrase means; "" for any other text.

    >>> everyday("say hello"), everyday("say hello to my little friend")
    ('wave your right hand', 'wave your right hand')
    """
    bare = _END.sub("", said).strip()
    if parts := _said_again(bare):
        return parts
    bare = bare if "," in bare else _MARKS.sub(" ", bare)
    table = _everyday()
    possible = (table.rules[number] for number in table.possible(bare))
    return next((rule.words for rule in possible if rule.pattern.fullmatch(bare)), "")


def greeting(said: str) -> str:
    """The plain command that the beginning of a short sentence means, whatever follows; "" where it means none.

    >>> greeting("thank you for coming"), greeting("hello, raise your arm")
    ('bow politely', '')
    """
    bare = _END.sub("", said).strip()
    if len(bare.split(None, MOST_WORDS_OF_TALK)) > MOST_WORDS_OF_TALK:
        return ""
    for number in _openings().possible(bare):
        rule = _openings().rules[number]
        found = rule.pattern.match(bare)
        if found is not None and (talk := _TALK.match(bare, found.end())):
            others = [part for part in _MARKS.split(bare[talk.end() :]) if part]
            known = all(_GOES_ON.match(part) or everyday(part) or greeting(part) for part in others)
            return rule.words if known and not any(map(_names_an_act, (talk[0], *others))) else ""
    return ""


def _names_an_act(talk: str) -> bool:
    named = _NAMES_AN_ACT.search(talk) or SPEAKS_OF_AN_ACT.search(talk)
    return bool(named) or any(map(is_gesture_verb, _WORD.findall(talk)))


def _said_again(bare: str) -> str:
    """The common command of several everyday phrases: "shoo, go away"; "" where they mean different commands."""
    parts = [part for part in _MARKS.split(bare) if part] if _MARKS.search(bare) else []
    first = everyday(parts[0]) if len(parts) > 1 else ""
    return first if first and all(everyday(part) == first for part in parts[1:]) else ""


@cache
def _openings() -> RuleTable:
    """Beginnings of social sentences."""
    return RuleTable((pattern.replace("@SO", _SO), words) for pattern, words in pairs("openings"))


@cache
def _everyday() -> RuleTable:
    """Everyday phrases, one a line."""
    return RuleTable(
        (pattern.replace("@ALL", _ALL).replace("@HERE", _HERE).replace("@SO", _SO), words)
        for pattern, words in pairs("everyday")
    )


@cache
def _sentences() -> RuleTable:
    return RuleTable((_spelt_out(pattern), words) for pattern, words in pairs("sentences"))


def _spelt_out(pattern: str) -> str:
    for name, words in (("@ACT", _ACT), ("@WAY", f"({WAY})"), ("@MANNER", _MANNER), ("@TIMES", TIMES)):
        pattern = pattern.replace(name, words)
    return pattern


def restated(said: str) -> str:
    """A sentence with its commands in order of execution and its lists written out.

    >>> restated("look up and down"), restated("end with a bow but clap before that")
    ('look up, then down', 'clap, then end with a bow')
    """
    return replaced(said, _sentences())


def rewritten(clause: str) -> str:
    """A clause with synonyms replaced by words that the model knows."""
    return replaced(clause, substitutions("rewrites"))
